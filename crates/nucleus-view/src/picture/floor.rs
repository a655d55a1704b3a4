//! The floor: a plane with a grid, level or tilted, which receives shadows and fades into the background.

use super::camera::View;
use super::light::{Light, diffuse, on_all_cores, smoothstep};
use super::scene::{Vec3, unit};

/// Points along a side of the grid on which the visible fraction of the sky is sampled; it varies slowly between them.
const SIDE: usize = 80;

/// Linear colour.
const FLOOR: [f32; 3] = [0.545, 0.54, 0.53];
/// Factor on the colour of grid lines.
const LINE_DARKER: f32 = 0.86;

/// The plane of a floor, in scene units.
#[derive(Debug, Clone, Copy)]
pub(super) struct FloorPlane {
    pub origin: Vec3,
    /// Unit vector to the side of the objects.
    pub normal: Vec3,
}

impl FloorPlane {
    /// A level plane at a height.
    pub fn level(height: f32) -> Self {
        Self { origin: Vec3::new(0.0, height, 0.0), normal: Vec3::y() }
    }

    /// How far a point is above the plane.
    pub fn height_of(&self, point: &Vec3) -> f32 {
        (point - self.origin).dot(&self.normal)
    }
}

/// A floor, prepared for one view from above.
pub(super) struct Floor {
    plane: FloorPlane,
    /// Directions of the grid lines in the plane: X and Z where it is level.
    across: Vec3,
    along: Vec3,
    centre: Vec3,
    half_extent: f32,
    /// Distance between grid lines, in scene units.
    spacing: f32,
    /// Visible fraction of the sky at the sampled points.
    sky: Vec<f32>,
    /// Direction to the key light.
    key: Vec3,
}

impl Floor {
    /// A floor that is shaded by the objects around the target of the camera.
    pub fn new(plane: FloorPlane, view: &View, light: &Light) -> Self {
        let half_extent = view.half_extent() * 1.3;
        let normal = plane.normal;
        let centre = view.target - normal * plane.height_of(&view.target);
        let toward = if normal.x.abs() < 0.9 { Vec3::x() } else { Vec3::z() };
        let across = unit(&(toward - normal * toward.dot(&normal)));
        let along = across.cross(&normal);
        let at = |cell: usize| (cell as f32 / (SIDE - 1) as f32 * 2.0 - 1.0) * half_extent;
        let places: Vec<Vec3> =
            (0..SIDE * SIDE).map(|k| centre + across * at(k % SIDE) + along * at(k / SIDE)).collect();
        let sky = on_all_cores(&places, |place| light.sky_visibility(place, &normal));
        Self {
            plane,
            across,
            along,
            centre,
            half_extent,
            spacing: round_length(view.half_extent() / 6.0),
            sky,
            key: Light::key_direction(view),
        }
    }

    /// Whether the floor hides a point that is more than `slack` below it.
    pub fn hides(&self, point: &Vec3, slack: f32) -> bool {
        self.plane.height_of(point) < -slack
    }

    /// The linear colour of the floor along a ray from the eye, and its opacity, 0 to 1; `None` where the ray misses it.
    /// Lines are filtered over a square of `samples` samples of the view to each side.
    pub fn shade(&self, view: &View, ray: &Vec3, samples: f32, light: &Light) -> Option<(Vec3, f32)> {
        let normal = &self.plane.normal;
        let depth = -self.plane.height_of(&view.eye) / ray.dot(normal);
        if !depth.is_finite() || depth <= 0.0 {
            return None;
        }
        let point = view.eye + ray * depth;
        let far = (point - self.centre).norm() / self.half_extent;
        let opacity = 1.0 - smoothstep(0.7, 3.2, far);
        if opacity <= 0.0 {
            return None;
        }
        let near = 1.0 - smoothstep(0.75, 1.0, far); // shading fades out before the shadow maps end
        let key = 1.0 - near * (1.0 - light.key_visibility(&point, normal));
        let sky = 1.0 - near * (1.0 - self.sky_visibility(&point));
        let length = ray.norm();
        let width = samples * depth / view.scale * length / (ray.dot(normal).abs() / length).max(0.05);
        let lines = self.lines(&point, width) * (1.0 - smoothstep(0.4, 1.6, far));
        let colour = Vec3::from(FLOOR) * (1.0 - lines * (1.0 - LINE_DARKER));
        Some((diffuse(&colour, normal, key, sky, &self.key), opacity))
    }

    fn sky_visibility(&self, point: &Vec3) -> f32 {
        let at = |x: f32| (x / self.half_extent * 0.5 + 0.5).clamp(0.0, 1.0) * (SIDE - 1) as f32;
        let offset = point - self.centre;
        let (x, z) = (at(offset.dot(&self.across)), at(offset.dot(&self.along)));
        let (column, row) = ((x as usize).min(SIDE - 2), (z as usize).min(SIDE - 2));
        let (right, down) = (x - column as f32, z - row as f32);
        let cell = |across: usize, below: usize| self.sky[(row + below) * SIDE + column + across];
        let above = cell(0, 0) * (1.0 - right) + cell(1, 0) * right;
        let below = cell(0, 1) * (1.0 - right) + cell(1, 1) * right;
        above * (1.0 - down) + below * down
    }

    /// The fraction of a sample that grid lines cover; the sample is `width` scene units wide on the floor.
    fn lines(&self, point: &Vec3, width: f32) -> f32 {
        let thick = (self.spacing * 0.012).max(width);
        let cover = |x: f32| {
            let from_line = (x / self.spacing - (x / self.spacing).round()).abs() * self.spacing;
            (1.0 - from_line / thick).clamp(0.0, 1.0)
        };
        cover(point.dot(&self.across)).max(cover(point.dot(&self.along)))
            * (self.spacing / (width * 12.0)).min(1.0)
    }
}

/// The smallest of 1, 2, 5, 10 ... that is not below a length.
fn round_length(length: f32) -> f32 {
    if !(1e-9..1e9).contains(&length) {
        return 1.0;
    }
    let mut power = 1.0f32;
    while power > length {
        power /= 10.0;
    }
    while power * 10.0 < length {
        power *= 10.0;
    }
    [1.0, 2.0, 5.0, 10.0].map(|step| step * power).into_iter().find(|step| *step >= length).unwrap_or(power)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn grid_lines_have_round_distances() {
        for (length, expected) in [(0.7, 1.0), (1.4, 2.0), (23.0, 50.0), (0.06, 0.1), (0.013, 0.02)] {
            assert!((round_length(length) / expected - 1.0).abs() < 1e-5, "{length}");
        }
        assert_eq!(round_length(f32::NAN), 1.0);
    }
}
