//! Lights: a key light with a shadow, a dome of directional lights for the sky, and diffuse reflection.

use super::camera::View;
use super::mesh::Mesh;
use super::scene::{Vec3, unit};
use super::shadow_map::ShadowMap;

/// Directions of the dome; each has a shadow map.
const DOME: usize = 40;
/// Sides of the shadow maps, in cells.
const DOME_SIDE: u32 = 192;
const KEY_SIDE: u32 = 1536;

// Linear colours of the light.
const KEY: [f32; 3] = [0.98, 0.94, 0.88];
const SKY: [f32; 3] = [0.36, 0.39, 0.43];
const BOUNCE: [f32; 3] = [0.13, 0.125, 0.115];

/// The lights of a picture. The dome makes folds visible: little of the sky is visible from a crease.
pub(super) struct Light {
    key: ShadowMap,
    dome: Vec<ShadowMap>,
}

impl Light {
    /// Direction to the key light, above and to the left of the eye.
    pub fn key_direction(view: &View) -> Vec3 {
        // It follows the azimuth of the camera only, so the light always falls from above.
        let level = unit(&view.right.cross(&Vec3::y()));
        unit(&(Vec3::y() * 1.0 - view.right * 0.62 + level * 0.38))
    }

    /// Lights for a mesh, around the target of the camera.
    pub fn of(mesh: &Mesh, view: &View) -> Self {
        let half_extent = view.half_extent() * 1.3;
        let map = |to_light: Vec3, side: u32| ShadowMap::of(mesh, to_light, view.target, half_extent, side);
        Self {
            key: map(Self::key_direction(view), KEY_SIDE),
            dome: dome_directions().map(|to_light| map(to_light, DOME_SIDE)).collect(),
        }
    }

    /// Computes the visible fraction of the sky for both sides of each vertex.
    pub fn find_sky_visibility(&self, mesh: &mut Mesh) {
        for vertex in &mut mesh.vertices {
            let (position, normal) = (vertex.position, vertex.normal);
            vertex.sky = [normal, -normal].map(|side| self.sky_visibility(&position, &side));
        }
    }

    /// The fraction of the key light that reaches a point of a surface with this normal, 0 to 1.
    pub fn key_visibility(&self, position: &Vec3, normal: &Vec3) -> f32 {
        self.key.visibility(position, normal, 2)
    }

    /// The fraction of the sky that is visible from a point of a surface with this normal, 0 to 1.
    pub fn sky_visibility(&self, position: &Vec3, normal: &Vec3) -> f32 {
        let (mut visible, mut all) = (0.0, 0.0);
        for map in &self.dome {
            let weight = map.to_light.dot(normal);
            if weight > 0.0 {
                all += weight;
                visible += weight * map.visibility(position, normal, 0);
            }
        }
        // A surface that faces straight down is lit by no light of the dome.
        if all > 0.0 { visible / all } else { 1.0 }
    }
}

/// Evenly distributed directions on the upper hemisphere: equal steps of height, and the golden angle between
/// neighbours. A constant rotation takes the place of sine and cosine, whose last bits differ between machines.
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

/// Linear colour of a diffuse surface, of which `key` and `sky` are the visible fractions of the key light and the sky.
pub(super) fn diffuse(colour: &Vec3, normal: &Vec3, key: f32, sky: f32, key_direction: &Vec3) -> Vec3 {
    let facing = normal.dot(key_direction).max(0.0) * key;
    let from_below = (0.5 - 0.5 * normal.y) * (0.35 + 0.65 * sky);
    let light = Vec3::from(KEY) * facing
        + Vec3::from(SKY) * (sky * (0.35 + 0.65 * sky))
        + Vec3::from(BOUNCE) * from_below;
    colour.component_mul(&light)
}

/// 0 below `low`, 1 above `high`, a smooth cubic between.
pub(super) fn smoothstep(low: f32, high: f32, x: f32) -> f32 {
    let t = ((x - low) / (high - low)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_dome_is_symmetric_about_the_vertical() {
        let sum = dome_directions().fold(Vec3::zeros(), |sum, direction| sum + direction) / DOME as f32;
        assert!(sum.x.abs() < 0.03 && sum.z.abs() < 0.03, "{sum}");
        assert!((sum.y - 0.5).abs() < 1e-5, "{sum}");
        assert!(dome_directions().all(|direction| (direction.norm() - 1.0).abs() < 1e-4));
    }
}
