//! The camera: its placement, and the perspective projection of points.

use nucleus_cache::{CameraView, FilmFit};

use super::scene::{Bounds, Vec3, is_drawable};

/// A perspective camera that looks at a target.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Camera {
    /// Position of the eye, in scene units.
    pub eye: [f32; 3],
    /// The point at the centre of the picture, in scene units.
    pub target: [f32; 3],
    /// Vertical field of view, in degrees; kept between 1 and 150.
    pub field_of_view: f32,
    /// The direction that points up in the picture, as far as the view direction allows.
    pub up: [f32; 3],
}

impl Default for Camera {
    /// At (0, 0, 5), looking at the origin.
    fn default() -> Self {
        Self { eye: [0.0, 0.0, 5.0], target: [0.0; 3], field_of_view: 30.0, up: [0.0, 1.0, 0.0] }
    }
}

impl Camera {
    /// A camera of the scene, for a picture of `size` pixels. Its target is as far away as the centre of `stage`.
    pub fn of_scene(recorded: &CameraView, fit: FilmFit, size: [u32; 2], stage: &Bounds) -> Self {
        let aspect = size[0].max(1) as f32 / size[1].max(1) as f32;
        let [_, upward] = recorded.tangents(fit, aspect);
        let (eye, forward) = (Vec3::from(recorded.eye), Vec3::from(recorded.forward));
        let distance = if stage.is_empty() { 0.0 } else { (stage.centre() - eye).dot(&forward) };
        let target = eye + forward * if distance > 0.0 { distance } else { recorded.interest };
        Self { eye: recorded.eye, target: target.into(), field_of_view: angle_of(upward), up: recorded.up }
    }

    /// A three-quarter view from above that contains all of `bounds` in a picture of `size` pixels.
    pub fn framing(bounds: &Bounds, size: [u32; 2]) -> Self {
        const FIELD_OF_VIEW: f32 = 30.0;
        const FILLED: f32 = 0.94; // the fraction of the picture that the box may fill
        if bounds.is_empty() {
            return Self::framing(&Bounds { low: [-1.0; 3], high: [1.0; 3] }, size);
        }
        let toward_eye = Vec3::new(0.52, 0.46, 0.82).normalize();
        let (right, up) = axes(&toward_eye, &Vec3::y());
        let tall = half_angle_tangent(FIELD_OF_VIEW) * FILLED;
        let wide = tall * size[0].max(1) as f32 / size[1].max(1) as f32;
        let centre = bounds.centre();
        let distance = bounds.corners().iter().fold(1e-3, |distance: f32, corner| {
            let offset = corner - centre;
            let side = (offset.dot(&right).abs() / wide).max(offset.dot(&up).abs() / tall);
            distance.max(side + offset.dot(&toward_eye))
        });
        let eye = centre + toward_eye * distance;
        Self { eye: eye.into(), target: centre.into(), field_of_view: FIELD_OF_VIEW, ..Self::default() }
    }
}

/// A camera with its axes and projection, for a picture of a certain size.
#[derive(Debug, Clone)]
pub(super) struct View {
    pub eye: Vec3,
    pub target: Vec3,
    pub right: Vec3,
    pub up: Vec3,
    pub forward: Vec3,
    /// Distance from the eye to the target, in scene units.
    pub distance: f32,
    /// Width and height in samples.
    pub size: [u32; 2],
    /// Samples per unit of (offset / depth).
    pub scale: f32,
}

impl View {
    pub fn new(camera: &Camera, size: [u32; 2]) -> Self {
        let target = if is_drawable(&camera.target) { camera.target } else { [0.0; 3] };
        let target = Vec3::from(target);
        let offset = Vec3::from(camera.eye) - target;
        let usable = is_drawable(&offset.into()) && offset.norm() > 1e-9;
        let offset = if usable { offset } else { Vec3::new(2.0, 2.0, 3.0) };
        let toward_eye = offset.normalize();
        let upward = if is_drawable(&camera.up) { Vec3::from(camera.up) } else { Vec3::y() };
        let (right, up) = axes(&toward_eye, &upward);
        Self {
            eye: target + offset,
            target,
            right,
            up,
            forward: -toward_eye,
            distance: offset.norm(),
            size,
            scale: 0.5 * size[1] as f32 / half_angle_tangent(camera.field_of_view),
        }
    }

    /// A point relative to the eye, along right, up and forward.
    pub fn to_view_space(&self, point: &Vec3) -> Vec3 {
        let offset = point - self.eye;
        Vec3::new(offset.dot(&self.right), offset.dot(&self.up), offset.dot(&self.forward))
    }

    /// The projection of a point in view space, in samples from the upper left corner.
    pub fn project(&self, point: &Vec3) -> [f32; 2] {
        let per_depth = self.scale / point.z;
        [0.5 * self.size[0] as f32 + point.x * per_depth, 0.5 * self.size[1] as f32 - point.y * per_depth]
    }

    /// The ray from the eye through a sample, with depth 1.
    pub fn ray(&self, at: [f32; 2]) -> Vec3 {
        let across = (at[0] - 0.5 * self.size[0] as f32) / self.scale;
        let upward = (0.5 * self.size[1] as f32 - at[1]) / self.scale;
        self.forward + self.right * across + self.up * upward
    }

    /// Half the longer side of the visible rectangle at the target, in scene units.
    pub fn half_extent(&self) -> f32 {
        0.5 * self.size[0].max(self.size[1]) as f32 / self.scale * self.distance
    }
}

/// Right and up vectors of a camera that looks along `-toward_eye`.
fn axes(toward_eye: &Vec3, up: &Vec3) -> (Vec3, Vec3) {
    let right = up.cross(toward_eye);
    // Seen straight along `up`, the picture's up is -Z.
    let right = if right.norm() > 1e-4 { right.normalize() } else { Vec3::x() };
    (right, toward_eye.cross(&right))
}

/// tan(angle / 2) of an angle in degrees, by Lambert's continued fraction, because the last bit of the system's tangent
/// depends on the machine.
fn half_angle_tangent(degrees: f32) -> f32 {
    let degrees = if degrees.is_finite() { degrees.clamp(1.0, 150.0) } else { 30.0 };
    let x = degrees * (std::f32::consts::PI / 360.0);
    let square = x * x;
    x / (1.0 - square / (3.0 - square / (5.0 - square / (7.0 - square / (9.0 - square / 11.0)))))
}

/// The inverse of [`half_angle_tangent`], by bisection for the same reason.
fn angle_of(tangent: f32) -> f32 {
    let [mut low, mut high] = [1.0_f32, 150.0];
    for _ in 0..30 {
        let middle = 0.5 * (low + high);
        if half_angle_tangent(middle) < tangent { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_tangent_agrees_with_the_system_to_six_digits() {
        for degrees in 1..=150 {
            let exact = (f64::from(degrees).to_radians() / 2.0).tan();
            let ours = f64::from(half_angle_tangent(degrees as f32));
            assert!((ours / exact - 1.0).abs() < 1e-6, "{degrees} degrees: {ours} for {exact}");
        }
    }

    #[test]
    fn an_angle_is_recovered_from_its_tangent() {
        for degrees in [1.5, 30.0, 54.432, 149.0] {
            let found = angle_of(half_angle_tangent(degrees));
            assert!((found - degrees).abs() < 1e-4 * degrees, "{degrees} degrees: {found}");
        }
    }

    #[test]
    fn a_camera_of_the_scene_keeps_its_direction_and_its_up_vector() {
        let (eye, forward, up) = ([0.0, 2.0, 10.0], [0.0, 0.0, -1.0], [1.0, 0.0, 0.0]);
        let recorded = CameraView { eye, forward, up, focal_length: 12.7, film: [1.0, 1.0], interest: 5.0 };
        let stage = Bounds { low: [-1.0; 3], high: [1.0; 3] };
        let view = View::new(&Camera::of_scene(&recorded, FilmFit::Fill, [200, 200], &stage), [200, 200]);
        // A right angle of view, rolled by 90 degrees: a point 10 to the right is at the upper edge.
        let [x, y] = view.project(&view.to_view_space(&Vec3::new(10.0, 2.0, 0.0)));
        assert!((x - 100.0).abs() < 0.1 && y.abs() < 0.1, "{x}, {y}");
        assert!((view.distance - 10.0).abs() < 1e-4);
    }

    #[test]
    fn framing_contains_every_corner_of_the_box() {
        let bounds = Bounds { low: [-3.0, 0.0, 1.0], high: [5.0, 0.5, 2.0] };
        for size in [[640, 360], [360, 640], [100, 100]] {
            let view = View::new(&Camera::framing(&bounds, size), size);
            for corner in bounds.corners() {
                let [x, y] = view.project(&view.to_view_space(&corner));
                assert!(
                    x > 0.0 && x < size[0] as f32 && y > 0.0 && y < size[1] as f32,
                    "{corner} at {x}, {y}"
                );
            }
        }
    }

    #[test]
    fn a_point_on_a_ray_projects_to_the_sample_of_the_ray() {
        let camera = Camera {
            eye: [3.0, 4.0, 5.0],
            target: [0.5, 0.0, -1.0],
            field_of_view: 50.0,
            ..Camera::default()
        };
        let view = View::new(&camera, [200, 100]);
        let [x, y] = view.project(&view.to_view_space(&(view.eye + view.ray([37.5, 81.5]) * 4.0)));
        assert!((x - 37.5).abs() < 1e-2 && (y - 81.5).abs() < 1e-2, "{x}, {y}");
    }
}
