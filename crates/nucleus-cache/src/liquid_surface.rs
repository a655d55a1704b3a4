//! The surface of particles as a mesh of quads.
//!
//! The signed distance is that of Zhu & Bridson (2005, "Animating sand as a fluid", §5): from a place to the weighted mean of
//! the particles around it, less the radius that a particle has on its own. Surface nets (Gibson 1998, "Constrained elastic
//! surface nets") make the mesh: a point in each cell of a grid that the surface passes, at the mean of where it crosses the
//! edges of the cell, and a quad across each edge that it crosses. The grid is stored in blocks about the particles, so its
//! memory grows with the space that is near any: a particle far from all others takes about 16 kB, and one of many close
//! together about 200 bytes.

use std::collections::{BTreeMap, BTreeSet};
use std::io::{Read, Seek};

use crate::error::ReadError;
use crate::read::playback::Playback;
use crate::run::{ObjectInfo, ObjectKind, SurfaceShape};

/// The reach of a particle in its spacings.
const REACH: f32 = 2.0;
/// The radius of a particle on its own, in spacings.
const RADIUS: f32 = 0.55;
/// Cells of the grid along a spacing.
const CELLS: f32 = 2.0;
/// Scale of the radius, at most: the reach grows with it.
const MAX_RADIUS_SCALE: f32 = 4.0;
/// Cells from the origin, at most: particles beyond, as of a broken run, have no surface.
const MAX_CELLS: f32 = 1e9;
/// Cells along the side of a block, a quarter of the diameter that a particle reaches: larger blocks store more that none
/// reaches, smaller ones are more to look up.
const SIDE: i32 = 4;
/// Recorded times at which the spacing of particles is measured, about.
const PROBES: usize = 8;
/// Corners of a block.
const CORNERS: usize = (SIDE * SIDE * SIDE) as usize;
/// A cell that the surface does not pass.
const NO_POINT: u32 = u32::MAX;

/// A place in blocks.
type Key = [i32; 3];

/// A surface.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct LiquidSurface {
    /// Its points, in the units of the particles.
    pub positions: Vec<[f32; 3]>,
    /// Its faces, counterclockwise seen from outside.
    pub quads: Vec<[u32; 4]>,
}

impl<R: Read + Seek> Playback<R> {
    /// The shape of the surface of an object's particles.
    ///
    /// # Errors
    /// If there is no such object.
    pub fn surface_shape(&self, object: usize) -> Result<SurfaceShape, ReadError> {
        let stated = self.run().surfaces.get(&self.object(object)?.name);
        Ok(stated.copied().unwrap_or(SurfaceShape::DEFAULT))
    }

    fn object(&self, object: usize) -> Result<&ObjectInfo, ReadError> {
        let objects = self.objects().len();
        self.objects().get(object).ok_or(ReadError::NoObject { object, objects })
    }

    /// The spacing of an object's particles in scene units: the recorded rest distance of a liquid, else the median distance
    /// to the nearest other where they are most, among some recorded times. `None` for other objects.
    ///
    /// # Errors
    /// If there is no such object, or a frame is damaged.
    pub fn particle_spacing(&mut self, object: usize) -> Result<Option<f32>, ReadError> {
        let ObjectInfo { kind, name, .. } = self.object(object)?;
        if *kind != ObjectKind::Particles {
            return Ok(None);
        }
        if let Some(&distance) = self.run().rest_distances.get(name).filter(|distance| **distance > 0.0) {
            return Ok(Some(distance as f32));
        }
        // The first particles of an emitter are few and overlap, so their distance says nothing.
        let samples = self.time_samples().len();
        let (mut most, mut found) = (0, None);
        for sample in (0..samples).step_by((samples / PROBES).max(1)) {
            let particles = self.positions(object, sample)?;
            if particles.len() > most
                && let Some(spacing) = spacing(&particles)
            {
                (most, found) = (particles.len(), Some(spacing));
            }
        }
        Ok(found)
    }
}

/// The median distance of particles to the nearest other; `None` for fewer than two.
fn spacing(particles: &[[f32; 3]]) -> Option<f32> {
    // Sorted along x, the nearest one is soon found; of many, some are enough.
    let mut sorted = particles.to_vec();
    sorted.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let every = (sorted.len() / 1000).max(1);
    let nearest = |at: usize| {
        let mut best = f32::INFINITY;
        let mut consider = |other: &[f32; 3]| {
            let apart: [f32; 3] = std::array::from_fn(|k| other[k] - sorted[at][k]);
            best = best.min(apart.iter().map(|x| x * x).sum::<f32>());
            apart[0] * apart[0] < best
        };
        let _ = sorted[..at].iter().rev().all(&mut consider);
        let _ = sorted[at + 1..].iter().all(&mut consider);
        best
    };
    let mut all: Vec<f32> = (0..sorted.len()).step_by(every).map(nearest).filter(|x| x.is_finite()).collect();
    all.sort_by(f32::total_cmp);
    all.get(all.len() / 2).map(|square| square.sqrt()).filter(|spacing| *spacing > 0.0)
}

impl LiquidSurface {
    /// The surface of particles of this spacing, in their units.
    pub fn of(particles: &[[f32; 3]], spacing: f32, shape: SurfaceShape) -> Self {
        let mut grid = Grid::of(particles, spacing, shape);
        let mut surface = Self::default();
        let keys = grid.keys();
        for &key in &keys {
            grid.add_points(key, &mut surface.positions);
        }
        for &key in &keys {
            grid.add_quads(key, &mut surface.quads);
        }
        surface
    }
}

struct Grid {
    width: f32,
    /// The reach of a particle, and the radius that it has on its own, in spacings.
    reach: f32,
    radius: f32,
    least_weight: f32,
    /// In each block that a particle reaches, by corner: the weighted sum of the particles relative to the corner, in
    /// spacings, and of the weights.
    sums: BTreeMap<Key, Vec<[f32; 4]>>,
    /// In each block that the surface passes, by the lowest corner of a cell: its point.
    points: BTreeMap<Key, Vec<u32>>,
}

/// The block of a corner, and its index in it.
fn index([x, y, z]: [i32; 3]) -> (Key, usize) {
    let block = [x, y, z].map(|k| k.div_euclid(SIDE));
    let [x, y, z] = [x, y, z].map(|k| k.rem_euclid(SIDE));
    (block, ((z * SIDE + y) * SIDE + x) as usize)
}

/// The corners of a block.
fn corners([x, y, z]: Key) -> impl Iterator<Item = [i32; 3]> {
    (0..CORNERS as i32)
        .map(move |k| [x * SIDE + k % SIDE, y * SIDE + k / SIDE % SIDE, z * SIDE + k / (SIDE * SIDE)])
}

impl Grid {
    /// The grid of particles of this spacing, in their units.
    fn of(particles: &[[f32; 3]], spacing: f32, shape: SurfaceShape) -> Self {
        let scale = shape.radius_scale.min(MAX_RADIUS_SCALE);
        let mut grid = Grid {
            width: spacing / CELLS,
            reach: REACH.max(1.5 * RADIUS * scale),
            radius: RADIUS * scale,
            // Weight below which the distance grows: between particles that are far apart their mean is no surface.
            least_weight: shape.threshold.max(1e-6),
            sums: BTreeMap::new(),
            points: BTreeMap::new(),
        };
        let is_in_reach = |place: &&[f32; 3]| place.iter().all(|x| (x / grid.width).abs() < MAX_CELLS);
        let reached: Vec<_> = particles.iter().filter(is_in_reach).collect();
        reached.into_iter().for_each(|place| grid.add(*place));
        grid
    }

    /// Adds a particle to the corners in its reach.
    fn add(&mut self, place: [f32; 3]) {
        let place = place.map(|x| x / self.width);
        let reach = self.reach * CELLS;
        let [low, high] = [-1.0f32, 1.0].map(|side| place.map(|x| (x + side * reach).floor() as i32));
        let blocks = [low, high].map(|corner| index(corner).0);
        for x in blocks[0][0]..=blocks[1][0] {
            for y in blocks[0][1]..=blocks[1][1] {
                for z in blocks[0][2]..=blocks[1][2] {
                    self.add_to_block(place, [x, y, z], [low, high]);
                }
            }
        }
    }

    /// Adds a particle to those corners of a block that are between `low` and `high` and in its reach; `place` in cells.
    fn add_to_block(&mut self, place: [f32; 3], key: Key, [low, high]: [[i32; 3]; 2]) {
        let range = |k: usize| [low[k].max(key[k] * SIDE), high[k].min(key[k] * SIDE + SIDE - 1)];
        let apart =
            |corner: [i32; 3]| -> [f32; 3] { std::array::from_fn(|k| (place[k] - corner[k] as f32) / CELLS) };
        let left = |apart: [f32; 3]| {
            let square = apart.iter().map(|x| x * x).sum::<f32>() / (self.reach * self.reach);
            (1.0 - square).max(0.0)
        };
        let nearest = std::array::from_fn(|k| {
            let [low, high] = range(k);
            (place[k].round() as i32).max(low).min(high)
        });
        if left(apart(nearest)) == 0.0 {
            return;
        }
        let sums = self.sums.entry(key).or_insert_with(|| vec![[0.0; 4]; CORNERS]);
        let along = |k: usize| range(k)[0]..=range(k)[1];
        for [i, j, k] in along(2).flat_map(|k| along(1).flat_map(move |j| along(0).map(move |i| [i, j, k]))) {
            let apart = apart([i, j, k]);
            let left = left(apart);
            let weight = left * left * left;
            let sum = &mut sums[index([i, j, k]).1];
            (0..3).for_each(|axis| sum[axis] += weight * apart[axis]);
            sum[3] += weight;
        }
    }

    /// The blocks whose cells have a corner that a particle reaches.
    fn keys(&self) -> BTreeSet<Key> {
        let below = |key: &Key| {
            let key = *key;
            (0..8).map(move |k: usize| std::array::from_fn(|axis| key[axis] - (k >> axis & 1) as i32))
        };
        self.sums.keys().flat_map(below).collect()
    }

    /// The signed distance of a corner in spacings.
    fn distance(&self, corner: [i32; 3]) -> f32 {
        let (block, at) = index(corner);
        let [x, y, z, weight] = self.sums.get(&block).map_or([0.0; 4], |sums| sums[at]);
        let sparse = (1.0 - weight / self.least_weight).max(0.0) * self.reach;
        let length = (x * x + y * y + z * z).sqrt() / weight.max(1e-9);
        length.min(self.reach) - self.radius + sparse
    }

    /// Adds a point in each cell of a block that the surface passes.
    fn add_points(&mut self, key: Key, positions: &mut Vec<[f32; 3]>) {
        for cell in corners(key) {
            let corner = |k: usize| std::array::from_fn(|axis| cell[axis] + (k >> axis & 1) as i32);
            let distances: [f32; 8] = std::array::from_fn(|k| self.distance(corner(k)));
            let (mut sum, mut count) = ([0.0f32; 3], 0.0f32);
            for (a, axis) in (0..8usize).flat_map(|a| (0..3).map(move |axis| (a, axis))) {
                let b = a | 1 << axis;
                if b != a && (distances[a] < 0.0) != (distances[b] < 0.0) {
                    let share = distances[a] / (distances[a] - distances[b]);
                    let from: [i32; 3] = corner(a);
                    (0..3).for_each(|k| sum[k] += from[k] as f32 + if k == axis { share } else { 0.0 });
                    count += 1.0;
                }
            }
            if count > 0.0 {
                let (block, at) = index(cell);
                let point = positions.len() as u32;
                self.points.entry(block).or_insert_with(|| vec![NO_POINT; CORNERS])[at] = point;
                positions.push(sum.map(|x| x / count * self.width));
            }
        }
    }

    fn point(&self, cell: [i32; 3]) -> Option<u32> {
        let (block, at) = index(cell);
        self.points.get(&block).map(|points| points[at]).filter(|point| *point != NO_POINT)
    }

    /// Adds a quad across each edge of a block that the surface crosses.
    fn add_quads(&self, key: Key, quads: &mut Vec<[u32; 4]>) {
        for corner in corners(key) {
            let own = self.distance(corner) < 0.0;
            for axis in 0..3 {
                let mut next = corner;
                next[axis] += 1;
                if own == (self.distance(next) < 0.0) {
                    continue;
                }
                let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
                let around = [[0, 0], [1, 0], [1, 1], [0, 1]].map(|[a, b]| {
                    let mut cell = corner;
                    (cell[u], cell[v]) = (cell[u] - a, cell[v] - b);
                    self.point(cell)
                });
                if let [Some(a), Some(b), Some(c), Some(d)] = around {
                    quads.push(if own { [a, b, c, d] } else { [d, c, b, a] });
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Particles of a ball on a grid of this spacing.
    fn ball(radius: f32, spacing: f32) -> Vec<[f32; 3]> {
        let side = (radius / spacing).ceil() as i32;
        let line = || -side..=side;
        let all = line().flat_map(|x| line().flat_map(move |y| line().map(move |z| [x, y, z])));
        let places = all.map(|place| place.map(|k| k as f32 * spacing));
        places.filter(|place| place.iter().map(|x| x * x).sum::<f32>() <= radius * radius).collect()
    }

    fn volume(surface: &LiquidSurface) -> f32 {
        let triangles = surface.quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]);
        let of = |[a, b, c]: [[f32; 3]; 3]| {
            let cross = [b[1] * c[2] - b[2] * c[1], b[2] * c[0] - b[0] * c[2], b[0] * c[1] - b[1] * c[0]];
            (a[0] * cross[0] + a[1] * cross[1] + a[2] * cross[2]) / 6.0
        };
        triangles.map(|points| of(points.map(|point| surface.positions[point as usize]))).sum()
    }

    #[test]
    fn the_surface_is_closed_and_holds_the_volume_of_its_particles() {
        let spacing = 0.02;
        let particles = ball(0.2, spacing);
        let surface = LiquidSurface::of(&particles, spacing, SurfaceShape::DEFAULT);
        let mut edges = BTreeMap::new();
        for quad in &surface.quads {
            for k in 0..4 {
                let [a, b] = [quad[k], quad[(k + 1) % 4]];
                *edges.entry([a.min(b), a.max(b)]).or_insert(0) += if a < b { 1 } else { -1 };
            }
        }
        assert!(edges.values().all(|sum| *sum == 0), "each edge has a face on both sides");
        let own = particles.len() as f32 * spacing.powi(3);
        let share = volume(&surface) / own;
        assert!((share - 1.0).abs() < 0.1, "{share}");
    }

    #[test]
    fn a_single_particle_is_a_ball_and_particles_far_apart_are_not_joined() {
        let particles = [[1.0, 2.0, 3.0], [1.36, 2.0, 3.0]];
        let found = LiquidSurface::of(&particles, 0.1, SurfaceShape::DEFAULT);
        assert!(!found.quads.is_empty());
        for place in &found.positions {
            let distance = |particle: &[f32; 3]| {
                (0..3).map(|k| (place[k] - particle[k]).powi(2)).sum::<f32>().sqrt() / (RADIUS * 0.1)
            };
            let nearest = particles.iter().map(distance).fold(f32::INFINITY, f32::min);
            // The ball is as wide as two cells: means of crossings are inside of it.
            assert!((0.5..1.05).contains(&nearest), "{nearest}");
        }
    }

    #[test]
    fn a_higher_threshold_leaves_out_single_particles_and_a_larger_radius_widens_the_surface() {
        let spacing = 0.02;
        let mut particles = ball(0.1, spacing);
        particles.push([0.3, 0.0, 0.0]);
        let of = |threshold: f32, radius_scale: f32| {
            LiquidSurface::of(&particles, spacing, SurfaceShape { threshold, radius_scale })
        };
        let has_single = |surface: &LiquidSurface| surface.positions.iter().any(|place| place[0] > 0.2);
        let [plain, dense, wide] = [of(0.1, 1.0), of(1.5, 1.0), of(0.1, 2.0)];
        assert!(has_single(&plain) && !has_single(&dense) && has_single(&wide));
        // The ball loses less than a spacing all around, and gains the growth of a radius.
        let radius = |surface: &LiquidSurface| (volume(surface) * 0.75 / std::f32::consts::PI).cbrt();
        let own = radius(&LiquidSurface::of(&ball(0.1, spacing), spacing, SurfaceShape::DEFAULT));
        assert!(radius(&dense) < own && radius(&dense) > own - spacing, "{} of {own}", radius(&dense));
        let most = own + 2.0 * RADIUS * spacing;
        assert!(
            radius(&wide) > own + 0.3 * RADIUS * spacing && radius(&wide) < most,
            "{} of {own}",
            radius(&wide)
        );
    }

    #[test]
    fn particles_that_are_nowhere_change_no_surface() {
        let mut particles = ball(0.1, 0.02);
        let alone = LiquidSurface::of(&particles, 0.02, SurfaceShape::DEFAULT);
        particles.extend([[f32::NAN, 0.0, 0.0], [0.0, f32::INFINITY, 0.0], [0.0, 0.0, -f32::MAX]]);
        assert_eq!(LiquidSurface::of(&particles, 0.02, SurfaceShape::DEFAULT), alone);
    }

    #[test]
    fn a_particle_far_from_all_others_takes_little_memory() {
        let shape = SurfaceShape::DEFAULT;
        let apart: Vec<[f32; 3]> = (0..64).map(|k| [1.037, 0.413, 0.271].map(|x| x * k as f32)).collect();
        let grid = Grid::of(&apart, 0.1, shape);
        let bytes = size_of::<[f32; 4]>() * grid.sums.len() + size_of::<u32>() * grid.points.len();
        let each = bytes * CORNERS / apart.len();
        assert!(each < 20_000, "{each} bytes");
    }

    #[test]
    fn the_spacing_is_that_of_the_grid() {
        let found = spacing(&ball(0.2, 0.02)).expect("many particles");
        assert!((found / 0.02 - 1.0).abs() < 1e-3, "{found}");
        assert_eq!(spacing(&[[0.0; 3]]), None);
    }
}
