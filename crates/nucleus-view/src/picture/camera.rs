//! Where the eye is, and how a point in space becomes a point in the picture.

use nucleus_cache::{CameraView, FilmFit};

use super::{Bounds, Vec3, is_drawable};

/// An eye that looks at a target, with up as near +Y as it can be.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Camera {
    /// Position of the eye, in scene units.
    pub eye: [f32; 3],
    /// The point in the middle of the picture, in scene units.
    pub target: [f32; 3],
    /// Vertical field of view, in degrees; kept between 1 and 150.
    pub field_of_view: f32,
    /// What is up in the picture, as near as can be.
    pub up: [f32; 3],
}

impl Default for Camera {
    /// Before the origin.
    fn default() -> Self {
        Self { eye: [0.0, 0.0, 5.0], target: [0.0; 3], field_of_view: 30.0, up: [0.0, 1.0, 0.0] }
    }
}

impl Camera {
    /// What a camera of a scene sees in a picture of `size` pixels; its target is beside the middle of `stage`.
    pub fn of_scene(view: &CameraView, fit: FilmFit, size: [u32; 2], stage: &Bounds) -> Self {
        let aspect = size[0].max(1) as f32 / size[1].max(1) as f32;
        let [_, upward] = view.tangents(fit, aspect);
        let (eye, forward) = (Vec3::from(view.eye), Vec3::from(view.forward));
        let ahead = if stage.is_empty() { 0.0 } else { (stage.centre() - eye).dot(&forward) };
        let target = eye + forward * if ahead > 0.0 { ahead } else { view.interest };
        Self { eye: view.eye, target: target.into(), field_of_view: angle_of(upward), up: view.up }
    }

    /// A three-quarter view from above that holds the whole of `bounds` in a picture of `size` pixels.
    pub fn framing(bounds: &Bounds, size: [u32; 2]) -> Self {
        const FIELD_OF_VIEW: f32 = 30.0;
        const FILLED: f32 = 0.94; // the share of the picture that the box may fill
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

/// A camera made ready for a picture of a certain size.
#[derive(Debug, Clone)]
pub(super) struct Lens {
    pub eye: Vec3,
    pub target: Vec3,
    pub right: Vec3,
    pub up: Vec3,
    pub forward: Vec3,
    /// Distance from the eye to the target.
    pub distance: f32,
    /// Width and height in samples.
    pub size: [u32; 2],
    /// Samples per unit of (offset / depth).
    pub scale: f32,
}

impl Lens {
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

    /// Sideways, up and forward distance from the eye.
    pub fn to_view(&self, point: &Vec3) -> Vec3 {
        let offset = point - self.eye;
        Vec3::new(offset.dot(&self.right), offset.dot(&self.up), offset.dot(&self.forward))
    }

    /// Where a point in view space falls, in samples from the upper left corner.
    pub fn project(&self, view: &Vec3) -> [f32; 2] {
        let per_depth = self.scale / view.z;
        [0.5 * self.size[0] as f32 + view.x * per_depth, 0.5 * self.size[1] as f32 - view.y * per_depth]
    }

    /// The direction, of any length, in which a sample is seen; its depth is 1.
    pub fn ray(&self, at: [f32; 2]) -> Vec3 {
        let across = (at[0] - 0.5 * self.size[0] as f32) / self.scale;
        let upward = (0.5 * self.size[1] as f32 - at[1]) / self.scale;
        self.forward + self.right * across + self.up * upward
    }

    /// Half the longer side of what is seen round the target, in scene units.
    pub fn reach(&self) -> f32 {
        0.5 * self.size[0].max(self.size[1]) as f32 / self.scale * self.distance
    }
}

/// Right and up of an eye that looks against `toward_eye`.
fn axes(toward_eye: &Vec3, up: &Vec3) -> (Vec3, Vec3) {
    let right = up.cross(toward_eye);
    // Straight from above or below there is no horizon: the picture's up is then -Z.
    let right = if right.norm() > 1e-4 { right.normalize() } else { Vec3::x() };
    (right, toward_eye.cross(&right))
}

/// tan(angle / 2) of an angle in degrees, by Lambert's continued fraction: the system's own tangent
/// differs in the last bit from one machine to the next.
fn half_angle_tangent(degrees: f32) -> f32 {
    let degrees = if degrees.is_finite() { degrees.clamp(1.0, 150.0) } else { 30.0 };
    let x = degrees * (std::f32::consts::PI / 360.0);
    let square = x * x;
    x / (1.0 - square / (3.0 - square / (5.0 - square / (7.0 - square / (9.0 - square / 11.0)))))
}

/// The angle in degrees of which half has this tangent: the inverse of [`half_angle_tangent`], by halving, for the
/// same reason.
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
    fn the_tangent_is_that_of_the_system_to_seven_digits() {
        for degrees in 1..=150 {
            let exact = (f64::from(degrees).to_radians() / 2.0).tan();
            let ours = f64::from(half_angle_tangent(degrees as f32));
            assert!((ours / exact - 1.0).abs() < 1e-6, "{degrees} degrees: {ours} for {exact}");
        }
    }

    #[test]
    fn an_angle_is_found_again_from_its_tangent() {
        for degrees in [1.5, 30.0, 54.432, 149.0] {
            let found = angle_of(half_angle_tangent(degrees));
            assert!((found - degrees).abs() < 1e-4 * degrees, "{degrees} degrees: {found}");
        }
    }

    #[test]
    fn a_camera_of_a_scene_looks_where_it_looks_with_its_own_up() {
        let (eye, forward, up) = ([0.0, 2.0, 10.0], [0.0, 0.0, -1.0], [1.0, 0.0, 0.0]);
        let view = CameraView { eye, forward, up, focal_length: 12.7, film: [1.0, 1.0], interest: 5.0 };
        let stage = Bounds { low: [-1.0; 3], high: [1.0; 3] };
        let lens = Lens::new(&Camera::of_scene(&view, FilmFit::Fill, [200, 200], &stage), [200, 200]);
        // A right angle of view, lying on its side: what is 10 to the right is at the upper rim.
        let [x, y] = lens.project(&lens.to_view(&Vec3::new(10.0, 2.0, 0.0)));
        assert!((x - 100.0).abs() < 0.1 && y.abs() < 0.1, "{x}, {y}");
        assert!((lens.distance - 10.0).abs() < 1e-4);
    }

    #[test]
    fn framing_holds_every_corner_of_the_box() {
        let bounds = Bounds { low: [-3.0, 0.0, 1.0], high: [5.0, 0.5, 2.0] };
        for size in [[640, 360], [360, 640], [100, 100]] {
            let lens = Lens::new(&Camera::framing(&bounds, size), size);
            for corner in bounds.corners() {
                let [x, y] = lens.project(&lens.to_view(&corner));
                assert!(
                    x > 0.0 && x < size[0] as f32 && y > 0.0 && y < size[1] as f32,
                    "{corner} at {x}, {y}"
                );
            }
        }
    }

    #[test]
    fn a_ray_comes_back_to_the_sample_it_left_from() {
        let camera = Camera {
            eye: [3.0, 4.0, 5.0],
            target: [0.5, 0.0, -1.0],
            field_of_view: 50.0,
            ..Camera::default()
        };
        let lens = Lens::new(&camera, [200, 100]);
        let [x, y] = lens.project(&lens.to_view(&(lens.eye + lens.ray([37.5, 81.5]) * 4.0)));
        assert!((x - 37.5).abs() < 1e-2 && (y - 81.5).abs() < 1e-2, "{x}, {y}");
    }
}
