//! Lights: a key light with a shadow, a dome of directional lights for the sky, and diffuse reflection.

use std::collections::BTreeMap;
use std::num::NonZero;
use std::thread;

use super::camera::View;
use super::mesh::{Mesh, Vertex};
use super::scene::{Vec3, unit};
use super::shadow_map::ShadowMap;

/// Directions of the dome; each has a shadow map.
const DOME: usize = 48;
/// Filter radius of their shadow maps, in cells: without it edges of the cells show as blotches.
const DOME_RADIUS: i32 = 1;
/// Sides of the shadow maps, in cells.
const DOME_SIDE: u32 = 224;
const KEY_SIDE: u32 = 1536;

// Linear colours of the light.
const KEY: [f32; 3] = [0.98, 0.94, 0.88];
const SKY: [f32; 3] = [0.36, 0.39, 0.43];
const BOUNCE: [f32; 3] = [0.13, 0.125, 0.115];
/// Light from the eye, without a shadow: the inside of folds and the back of a cloth are never black.
const FILL: f32 = 0.16;

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
            dome: on_all_cores(&dome_directions().collect::<Vec<_>>(), |to_light| map(*to_light, DOME_SIDE)),
        }
    }

    /// Computes the visible fraction of the sky for both sides of each vertex.
    pub fn find_sky_visibility(&self, mesh: &mut Mesh) {
        let of_vertex = |vertex: &Vertex| {
            [vertex.normal, -vertex.normal].map(|side| self.sky_visibility(&vertex.position, &side))
        };
        let found = on_all_cores(&mesh.vertices, of_vertex);
        let smooth = smoothed(mesh, &found);
        mesh.vertices.iter_mut().zip(smooth).for_each(|(vertex, sky)| vertex.sky = sky);
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
                visible += weight * map.visibility(position, normal, DOME_RADIUS);
            }
        }
        // A surface that faces straight down is lit by no light of the dome.
        if all > 0.0 { visible / all } else { 1.0 }
    }
}

/// The mean over each vertex and its neighbours: the vertices of a coarse mesh sample the sky unevenly. Vertices of one
/// position and normal count as one, so that faces that meet smoothly stay smooth.
fn smoothed(mesh: &Mesh, sky: &[[f32; 2]]) -> Vec<[f32; 2]> {
    let mut groups: BTreeMap<[u32; 6], usize> = BTreeMap::new();
    let group = |vertex: &Vertex| {
        let ([a, b, c], [d, e, f]) = (vertex.position.into(), vertex.normal.into());
        let next = groups.len();
        *groups.entry([a, b, c, d, e, f].map(f32::to_bits)).or_insert(next)
    };
    let group_of: Vec<usize> = mesh.vertices.iter().map(group).collect();
    let mut sums: Vec<([f32; 2], f32)> = vec![([0.0; 2], 0.0); groups.len()];
    let mut add = |to: usize, from: usize, weight: f32| {
        let (sum, total) = &mut sums[group_of[to]];
        (0..2).for_each(|side| sum[side] += weight * sky[from][side]);
        *total += weight;
    };
    (0..sky.len()).for_each(|vertex| add(vertex, vertex, 2.0));
    for triangle in &mesh.triangles {
        for k in 0..3 {
            let [at, next] = [k, (k + 1) % 3].map(|corner| triangle.corners[corner] as usize);
            add(at, next, 1.0);
            add(next, at, 1.0);
        }
    }
    group_of.iter().map(|group| sums[*group].0.map(|x| x / sums[*group].1)).collect()
}

/// The values of a function, in order; the items are divided among all cores.
pub(super) fn on_all_cores<T: Sync, U: Send>(items: &[T], value: impl Fn(&T) -> U + Sync) -> Vec<U> {
    let cores = thread::available_parallelism().map_or(1, NonZero::get);
    let value = &value;
    thread::scope(|scope| {
        let parts: Vec<_> = items
            .chunks(items.len().div_ceil(cores).max(1))
            .map(|part| scope.spawn(move || part.iter().map(value).collect::<Vec<U>>()))
            .collect();
        // A panic of a part is a panic of the whole.
        parts.into_iter().flat_map(|part| part.join().expect("a part does not panic")).collect()
    })
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

/// Linear colour that the light from the eye adds to a diffuse surface; `cosine` is that of the angle between the two.
pub(super) fn fill(colour: &Vec3, cosine: f32, sky: f32) -> Vec3 {
    colour * (FILL * cosine * (1.0 - 0.6 * sky))
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
