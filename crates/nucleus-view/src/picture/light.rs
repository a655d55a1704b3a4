//! What the lights see: a key light with a shadow, and a dome of many weak ones for soft shade.

use super::camera::Lens;
use super::depth_map::DepthMap;
use super::mesh::Mesh;
use super::{Vec3, normals};

/// Directions of the dome; each is a depth map of its own.
const DOME: usize = 40;
const DOME_SIDE: u32 = 192;
const KEY_SIDE: u32 = 1536;

/// The lights of a picture. The dome is why folds read: a crease sees little of the sky.
pub(super) struct Light {
    key: DepthMap,
    dome: Vec<DepthMap>,
}

impl Light {
    /// Toward the key light, from over the left shoulder of the eye.
    pub fn key_direction(lens: &Lens) -> Vec3 {
        // Turned with the camera sideways only, so that light always falls from above.
        let level = normals::unit(&lens.right.cross(&Vec3::y()));
        normals::unit(&(Vec3::y() * 1.0 - lens.right * 0.62 + level * 0.38))
    }

    /// Lights what is seen round the camera's target.
    pub fn around(mesh: &Mesh, lens: &Lens) -> Self {
        let reach = lens.reach() * 1.3;
        let map = |toward: Vec3, side: u32| DepthMap::of(mesh, toward, lens.target, reach, side);
        Self {
            key: map(Self::key_direction(lens), KEY_SIDE),
            dome: dome_directions().map(|toward| map(toward, DOME_SIDE)).collect(),
        }
    }

    /// The share of the key light that reaches a point of a surface with this normal, 0 to 1.
    pub fn key_reaches(&self, position: &Vec3, normal: &Vec3) -> f32 {
        self.key.lit(position, normal, 2)
    }

    /// The share of the sky that is seen from a point of a surface with this normal, 0 to 1.
    pub fn openness(&self, position: &Vec3, normal: &Vec3) -> f32 {
        let (mut seen, mut all) = (0.0, 0.0);
        for map in &self.dome {
            let weight = map.toward.dot(normal);
            if weight > 0.0 {
                all += weight;
                seen += weight * map.lit(position, normal, 0);
            }
        }
        // Facing straight down: no light of the dome is on that side.
        if all > 0.0 { seen / all } else { 1.0 }
    }
}

/// Evenly spread directions on the upper half sphere: equal steps of height, and the golden angle
/// between neighbours, turned by a constant rotation because sine and cosine differ between machines.
fn dome_directions() -> impl Iterator<Item = Vec3> {
    const TURN: [f32; 2] = [-0.737_368_9, 0.675_490_3];
    let mut around = [1.0f32, 0.0];
    (0..DOME).map(move |k| {
        let height = (k as f32 + 0.5) / DOME as f32;
        let flat = (1.0 - height * height).sqrt();
        let direction = Vec3::new(around[0] * flat, height, around[1] * flat);
        around = [around[0] * TURN[0] - around[1] * TURN[1], around[0] * TURN[1] + around[1] * TURN[0]];
        direction
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_dome_is_even_round_the_vertical() {
        let sum = dome_directions().fold(Vec3::zeros(), |sum, direction| sum + direction) / DOME as f32;
        assert!(sum.x.abs() < 0.03 && sum.z.abs() < 0.03, "{sum}");
        assert!((sum.y - 0.5).abs() < 1e-5, "{sum}");
        assert!(dome_directions().all(|direction| (direction.norm() - 1.0).abs() < 1e-4));
    }
}
