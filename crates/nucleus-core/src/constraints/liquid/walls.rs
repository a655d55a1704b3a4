//! Walls: the density that the ground plane, colliders and cloth add to particles near them, and the reaction on cloth.
//!
//! Near a wall a particle lacks neighbours. The plane counts as a half-space full of liquid that begins at half a rest
//! distance. Surfaces of meshes are covered with samples, each of which counts as much as its area (as the boundary
//! particles of Akinci et al. 2012, "Versatile rigid-fluid coupling"). A sample at distance r weighs S(r) / 2 pi r, with the
//! weight S of a sheet of liquid, so that a flat surface weighs as much as the plane. Contact thickness moves both outwards.
//!
//! The samples of cloth move with the corners of their triangle, and take up the pressure on them: momentum is kept.

use std::f32::consts::PI;

use super::grid::{CellGrid, Pair};
use super::kernel::{REACH, half_space, weight};

/// How far behind a surface the liquid begins that it counts as: the layers of particles beside it weigh as much as a
/// half-space that begins there.
const GAP: f32 = 0.03;
/// Distance of samples in rest distances, at most.
const SAMPLE_DISTANCE: f32 = 0.5;
/// Distance from a sample below which its weight no longer grows.
const NEAREST: f32 = 0.2;
/// Distance of particles from the surface that they rest on.
const TOUCHING: f32 = 0.5;
/// Rows of samples along the longest edge of a triangle, at most: beyond, samples weigh more.
const MAX_ROWS: u32 = 2048;

/// The walls of one liquid; lengths in rest distances, from the liquid's origin.
#[derive(Debug, Default)]
pub struct Walls {
    /// The plane: its unit normal, the height of the origin above it, and how far contact keeps particles from it
    /// beyond [`TOUCHING`].
    pub plane: Option<Plane>,
    places: Vec<[f32; 3]>,
    samples: Vec<Sample>,
    grid: CellGrid,
    max_offset: f32,
    /// Corners of the triangles of cloth that has samples.
    corners: Vec<Corner>,
    /// Displacement of each sample of cloth.
    moved: Vec<[f32; 3]>,
}

/// The ground plane.
#[derive(Debug, Clone, Copy)]
pub struct Plane {
    /// Of unit length.
    pub normal: [f32; 3],
    /// Height of the origin above it.
    pub height: f32,
    /// Distance at which particles rest on it, less half a rest distance.
    pub offset: f32,
}

/// A point of cloth, and how far the pressure moves it.
#[derive(Debug, Clone, Copy)]
pub struct Corner {
    /// Its row in the columns of the state.
    pub row: u32,
    /// Inverse mass, in inverse masses of a particle.
    pub inverse_mass: f32,
    /// Displacement.
    pub moved: [f32; 3],
}

#[derive(Debug, Clone, Copy)]
struct Sample {
    area: f32,
    offset: f32,
    /// Places in `corners`, and weights; none for colliders.
    corners: Option<[u32; 3]>,
    shares: [f32; 3],
}

/// A surface that is covered with samples.
#[derive(Debug, Clone, Copy)]
pub struct Material {
    /// Distance at which particles rest on it.
    pub distance: f32,
}

impl Walls {
    /// Forgets all walls.
    pub fn clear(&mut self) {
        self.plane = None;
        self.places.clear();
        self.samples.clear();
        self.corners.clear();
        self.max_offset = 0.0;
    }

    /// Adds a point of cloth; returns its number.
    pub fn corner(&mut self, corner: Corner) -> u32 {
        self.corners.push(corner);
        self.corners.len() as u32 - 1
    }

    /// The points of cloth, with their displacements.
    pub fn corners(&self) -> &[Corner] {
        &self.corners
    }

    /// Covers a triangle with samples, where it is near a box.
    pub fn cover(
        &mut self,
        triangle: [[f32; 3]; 3],
        corners: Option<[u32; 3]>,
        material: Material,
        [low, high]: [[f32; 3]; 2],
    ) {
        let offset = (material.distance - TOUCHING).max(0.0);
        let reach = REACH + offset;
        let is_near =
            |place: &[f32; 3]| (0..3).all(|k| low[k] - reach <= place[k] && place[k] <= high[k] + reach);
        let beyond = |k: usize| {
            let of = |corner: &[f32; 3]| corner[k];
            triangle.iter().all(|corner| of(corner) < low[k] - reach)
                || triangle.iter().all(|corner| of(corner) > high[k] + reach)
        };
        if (0..3).any(beyond) {
            return;
        }
        let edge = |a: usize, b: usize| length(minus(triangle[a], triangle[b]));
        let longest = edge(0, 1).max(edge(1, 2)).max(edge(2, 0));
        let rows = ((longest / SAMPLE_DISTANCE).ceil().min(MAX_ROWS as f32) as u32).max(1);
        let area = length(cross(minus(triangle[1], triangle[0]), minus(triangle[2], triangle[0]))) / 2.0;
        let each = area / (rows * rows) as f32;
        self.max_offset = self.max_offset.max(offset);
        // The centres of the triangles that the rows cut: upright ones, and turned ones between them.
        for a in 0..rows {
            for b in 0..rows - a {
                for turned in [0.0, 1.0] {
                    if turned > 0.0 && a + b + 1 >= rows {
                        continue;
                    }
                    let part = |k: u32| (k as f32 + (1.0 + turned) / 3.0) / rows as f32;
                    let [s, t] = [part(a), part(b)];
                    let shares = [1.0 - s - t, s, t];
                    let place = std::array::from_fn(|k| (0..3).map(|c| triangle[c][k] * shares[c]).sum());
                    if is_near(&place) {
                        self.places.push(place);
                        self.samples.push(Sample { area: each, offset, corners, shares });
                    }
                }
            }
        }
    }

    /// Sorts the samples, once all are there.
    pub fn sort(&mut self) {
        if !self.samples.is_empty() {
            self.grid.sort(&self.places, REACH + self.max_offset);
        }
        self.moved.clear();
        self.moved.resize(if self.corners.is_empty() { 0 } else { self.samples.len() }, [0.0; 3]);
    }

    /// Calls `add` with the density of each wall near a place, its gradient, and the sample if it can move.
    #[inline]
    pub fn near(&self, place: [f32; 3], mut add: impl FnMut(f32, [f32; 3], Option<u32>)) {
        if let Some(Plane { normal, height, offset }) = self.plane {
            let distance =
                height + normal[0] * place[0] + normal[1] * place[1] + normal[2] * place[2] + GAP - offset;
            if distance < REACH {
                let [density, slope] = half_space(distance.max(0.0));
                add(density, normal.map(|x| x * slope), None);
            }
        }
        if self.samples.is_empty() {
            return;
        }
        for &at in self.grid.runs(place).flat_map(|run| &self.grid.order()[run]) {
            let (from, sample) = (self.places[at as usize], &self.samples[at as usize]);
            let apart = minus(place, from);
            let distance = length(apart).max(NEAREST);
            let q = (distance + GAP - sample.offset).max(0.0);
            if q < REACH {
                let part = sample.area / (2.0 * PI * distance);
                let sheet = -half_space(q)[1];
                let slope = -part * (2.0 * PI * q * weight(q) + sheet / distance) / distance;
                add(part * sheet, apart.map(|x| x * slope), sample.corners.map(|_| at));
            }
        }
    }

    /// Term of the mobility of cloth in the diagonal entry of a particle.
    #[inline]
    pub fn mobility(&self, pairs: &[Pair]) -> f32 {
        let of = |pair: &Pair| {
            let [x, y, z] = pair.gradient;
            let sample = &self.samples[pair.other as usize];
            let masses = sample.corners.into_iter().flatten().zip(sample.shares);
            let mobility: f32 = masses
                .map(|(corner, share)| share * share * self.corners[corner as usize].inverse_mass)
                .sum();
            mobility * (x * x + y * y + z * z)
        };
        pairs.iter().map(of).sum()
    }

    /// How much of a particle's density goes where the samples move.
    #[inline]
    pub fn change(&self, pairs: &[Pair]) -> f32 {
        let of = |pair: &Pair| {
            let ([x, y, z], [a, b, c]) = (self.moved[pair.other as usize], pair.gradient);
            x * a + y * b + z * c
        };
        pairs.iter().map(of).sum()
    }

    /// Displacements of cloth by the multipliers of particles, each with its pairs.
    pub fn displace<'p>(&mut self, pushes: impl Iterator<Item = (f32, &'p [Pair])>) {
        if self.corners.is_empty() {
            return;
        }
        self.corners.iter_mut().for_each(|corner| corner.moved = [0.0; 3]);
        for (lambda, pairs) in pushes {
            for pair in pairs {
                let sample = self.samples[pair.other as usize];
                for (corner, share) in sample.corners.into_iter().flatten().zip(sample.shares) {
                    let corner = &mut self.corners[corner as usize];
                    let push = lambda * share * corner.inverse_mass;
                    (0..3).for_each(|axis| corner.moved[axis] += push * pair.gradient[axis]);
                }
            }
        }
        for (moved, sample) in self.moved.iter_mut().zip(&self.samples) {
            let Some(corners) = sample.corners else { continue };
            let corners = corners.map(|corner| self.corners[corner as usize].moved);
            *moved = std::array::from_fn(|axis| (0..3).map(|k| corners[k][axis] * sample.shares[k]).sum());
        }
    }
}

fn minus(a: [f32; 3], b: [f32; 3]) -> [f32; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn cross(a: [f32; 3], b: [f32; 3]) -> [f32; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn length(a: [f32; 3]) -> f32 {
    (a[0] * a[0] + a[1] * a[1] + a[2] * a[2]).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_particle_that_touches_a_mesh_feels_it_like_the_plane() {
        for distance in [0.5f32, 1.3] {
            let mut walls = Walls::default();
            let bounds = [[-1.0, 0.0, -1.0], [1.0, 2.0, 1.0]];
            let triangle = [[-9.0, 0.0, -9.0], [0.0, 0.0, 18.0], [9.0, 0.0, -9.0]];
            walls.cover(triangle, None, Material { distance }, bounds);
            walls.sort();
            let mut sum = [0.0f32; 2];
            walls.near([0.1, distance, 0.05], |density, [_, y, _], _| sum = [sum[0] + density, sum[1] + y]);
            let expected = half_space(TOUCHING)[0];
            // Measured: 7.7 % too little at 0.5.
            assert!((sum[0] / expected - 1.0).abs() < 0.1, "{sum:?} of {expected} at {distance}");
            assert!(sum[1] < 0.0, "it pushes away");
        }
    }
}
