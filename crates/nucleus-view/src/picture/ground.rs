//! The floor: a plane without end, with a grid, the shadow of things on it, and no horizon.

use super::Vec3;
use super::camera::Lens;
use super::light::Light;
use super::shade;

/// Soft shade varies slowly: it is worked out on a grid of points and blended between them.
const SIDE: usize = 128;

const FLOOR: [f32; 3] = [0.545, 0.54, 0.53];
const LINE_DARKER: f32 = 0.86;

/// A floor ready to be looked at.
pub(super) struct Ground {
    height: f32,
    centre: Vec3,
    reach: f32,
    /// Distance between two lines of the grid, in scene units.
    spacing: f32,
    open: Vec<f32>,
    /// Toward the key light.
    key: Vec3,
}

impl Ground {
    /// A floor at `height`, shaded by what stands near the camera's target.
    pub fn new(height: f32, lens: &Lens, light: &Light) -> Self {
        let reach = lens.reach() * 1.3;
        let centre = Vec3::new(lens.target.x, height, lens.target.z);
        let at = |cell: usize| (cell as f32 / (SIDE - 1) as f32 * 2.0 - 1.0) * reach;
        let open = (0..SIDE * SIDE)
            .map(|k| light.openness(&(centre + Vec3::new(at(k % SIDE), 0.0, at(k / SIDE))), &Vec3::y()))
            .collect();
        Self {
            height,
            centre,
            reach,
            spacing: round_length(lens.reach() / 6.0),
            open,
            key: Light::key_direction(lens),
        }
    }

    /// Whether the floor is between the eye and a point that is more than `slack` behind it.
    pub fn hides(&self, lens: &Lens, point: &Vec3, slack: f32) -> bool {
        if lens.eye.y >= self.height { point.y < self.height - slack } else { point.y > self.height + slack }
    }

    /// The floor's linear colour where a ray from the eye meets it, and how much it hides the
    /// background; `None` where the ray goes past it.
    pub fn seen(&self, lens: &Lens, ray: &Vec3, light: &Light) -> Option<(Vec3, f32)> {
        let depth = (self.height - lens.eye.y) / ray.y;
        if !depth.is_finite() || depth <= 0.0 {
            return None;
        }
        let point = lens.eye + ray * depth;
        let far = (point - self.centre).norm() / self.reach;
        let solid = 1.0 - shade::ramp(0.7, 3.2, far);
        if solid <= 0.0 {
            return None;
        }
        let near = 1.0 - shade::ramp(0.75, 1.0, far); // shade fades out before its maps end
        let key = 1.0 - near * (1.0 - light.key_reaches(&point, &Vec3::y()));
        let open = 1.0 - near * (1.0 - self.openness(&point));
        let length = ray.norm();
        let width = depth / lens.scale * length / (ray.y.abs() / length).max(0.05);
        let lines = self.lines(&point, width) * (1.0 - shade::ramp(0.4, 1.6, far));
        let colour = Vec3::from(FLOOR) * (1.0 - lines * (1.0 - LINE_DARKER));
        Some((shade::matt(&colour, &Vec3::y(), key, open, &self.key), solid))
    }

    fn openness(&self, point: &Vec3) -> f32 {
        let at = |x: f32| (x / self.reach * 0.5 + 0.5).clamp(0.0, 1.0) * (SIDE - 1) as f32;
        let offset = point - self.centre;
        let (x, z) = (at(offset.x), at(offset.z));
        let (column, row) = ((x as usize).min(SIDE - 2), (z as usize).min(SIDE - 2));
        let (right, down) = (x - column as f32, z - row as f32);
        let cell = |across: usize, below: usize| self.open[(row + below) * SIDE + column + across];
        let above = cell(0, 0) * (1.0 - right) + cell(1, 0) * right;
        let below = cell(0, 1) * (1.0 - right) + cell(1, 1) * right;
        above * (1.0 - down) + below * down
    }

    /// How much of a sample, `width` scene units across on the floor, lines cover.
    fn lines(&self, point: &Vec3, width: f32) -> f32 {
        let thick = (self.spacing * 0.012).max(width);
        let cover = |x: f32| {
            let from_line = (x / self.spacing - (x / self.spacing).round()).abs() * self.spacing;
            (1.0 - from_line / thick).clamp(0.0, 1.0)
        };
        cover(point.x).max(cover(point.z)) * (self.spacing / (width * 12.0)).min(1.0)
    }
}

/// The nearest of 1, 2, 5, 10 ... that is not below a length.
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
    fn grid_lines_stand_at_round_distances() {
        for (length, expected) in [(0.7, 1.0), (1.4, 2.0), (23.0, 50.0), (0.06, 0.1), (0.013, 0.02)] {
            assert!((round_length(length) / expected - 1.0).abs() < 1e-5, "{length}");
        }
        assert_eq!(round_length(f32::NAN), 1.0);
    }
}
