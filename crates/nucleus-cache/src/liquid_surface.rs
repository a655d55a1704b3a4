//! The surface of particles as a mesh of quads.
//!
//! The signed distance is that of Zhu & Bridson (2005, "Animating sand as a fluid", §5): from a place to the weighted mean of
//! the particles around it, less a radius. The radius follows from the density there, so that the surface encloses the volume of
//! the particles: 0.62 spacings for a particle on its own, which is a ball of its volume, and 0.51 for the flat surface of a
//! block, where the mean is further below.
//!
//! Surface nets (Gibson 1998, "Constrained elastic surface nets") make the mesh: a point in each cell of a grid for each sheet of
//! the surface that passes it, and a quad across each edge that the surface crosses. Each edge of the mesh has two faces. The
//! points are moved onto the surface, and beyond it where it is curved, because the quads between them cut corners.
//!
//! The grid is stored in blocks about the particles, so its memory grows with the space that is near any: a particle far from
//! all others takes about 16 kB, and one of many close together about 200 bytes.
//!
//! | You want to know… | Read |
//! |---|---|
//! | the signed distance | `grid.rs` |
//! | which edges of a cell one sheet crosses | `cell.rs` |
//! | pieces without a particle inside | `pieces.rs` |
//! | values of particles on their surface | `values.rs` |

mod cell;
mod grid;
mod pieces;
mod values;

use std::collections::BTreeMap;
use std::io::{Read, Seek};

use crate::error::ReadError;
use crate::read::playback::Playback;
use crate::run::{ObjectInfo, ObjectKind, SurfaceShape};
use cell::{Inside, Sheets, corner, crossed, repeated_face};
use grid::{CORNERS, Grid, Key, RADIUS, SIDE, corners, index};

/// Recorded times at which the spacing of particles is measured, about.
const PROBES: usize = 8;

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

    /// The spacing of an object's particles in scene units: the recorded rest distance of a liquid; else the edge of a cube with
    /// the volume of a particle of the recorded radius; else, in caches without radii, the median distance to the nearest other
    /// where they are most, among some recorded times. `None` for other objects, and for particles that are no liquid in a run
    /// with a liquid: only that has a surface.
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
        if self.run().rest_distances.values().any(|distance| *distance > 0.0) {
            return Ok(None);
        }
        if let Some(&radius) = self.run().radii.get(name).filter(|radius| **radius > 0.0) {
            return Ok(Some(radius as f32 / RADIUS));
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
        let grid = Grid::of(particles, spacing, shape);
        let mut net = Net { cells: BTreeMap::new(), surface: Self::default() };
        let blocks: Vec<_> = grid.keys().into_iter().map(|key| (key, grid.distances(key))).collect();
        blocks.iter().for_each(|(key, distances)| net.add_points(&grid, *key, distances));
        blocks.iter().for_each(|(key, distances)| net.add_quads(*key, distances));
        let mut surface = net.surface;
        surface.bulge();
        surface.positions.iter_mut().flatten().for_each(|x| *x *= grid.width);
        surface.remove_empty_pieces(particles, spacing);
        surface
    }

    /// Moves each point away from the mean of its neighbours by a third of its distance to it. Quads whose points are on a curved
    /// surface lie inside of it: by κh²/6 in the mean, at a mean curvature κ and a side h, and the neighbours by κh²/2.
    fn bulge(&mut self) {
        let mut around = vec![([0.0f32; 3], 0.0f32); self.positions.len()];
        for quad in &self.quads {
            for k in 0..4 {
                let (sum, count) = &mut around[quad[k] as usize];
                let next = self.positions[quad[(k + 1) % 4] as usize];
                (0..3).for_each(|axis| sum[axis] += next[axis]);
                *count += 1.0;
            }
        }
        for (position, (sum, count)) in
            self.positions.iter_mut().zip(around).filter(|(_, (_, count))| *count > 0.0)
        {
            (0..3).for_each(|axis| position[axis] += (position[axis] - sum[axis] / count) / 3.0);
        }
    }
}

/// A cell that the surface passes.
#[derive(Debug, Clone, Copy)]
struct SurfaceCell {
    /// The point of its first sheet; those of the others follow.
    first: u32,
    sheets: Sheets,
}

/// The mesh as it grows, in cells.
struct Net {
    /// In each block that the surface passes, by the lowest corner of a cell.
    cells: BTreeMap<Key, Vec<Option<SurfaceCell>>>,
    surface: LiquidSurface,
}

/// The place of a corner among the distances of a block.
fn at(corner: [i32; 3], key: Key) -> usize {
    let [x, y, z]: [i32; 3] = std::array::from_fn(|axis| corner[axis] - key[axis] * SIDE);
    ((z * (SIDE + 1) + y) * (SIDE + 1) + x) as usize
}

fn added(a: [i32; 3], b: [i32; 3]) -> [i32; 3] {
    std::array::from_fn(|axis| a[axis] + b[axis])
}

/// Which corners of a cell are inside.
fn inside(distance: impl Fn(usize) -> f32) -> Inside {
    (0..8).map(|k| Inside::from(distance(k) < 0.0) << k).sum()
}

/// Whether a face that is crossed four times is resolved by joining the corners inside: where it would otherwise belong to one
/// sheet in both of its cells.
fn is_joined(grid: &Grid, cell: [i32; 3], own: Inside) -> bool {
    repeated_face(own).is_some_and(|(axis, side)| {
        let mut other = cell;
        other[axis] += 2 * side as i32 - 1;
        let across = inside(|k| grid.distance(added(other, corner(k))));
        repeated_face(across) == Some((axis, 1 - side))
    })
}

impl Net {
    /// Adds a point for each sheet in each cell of a block that the surface passes.
    fn add_points(&mut self, grid: &Grid, key: Key, distances: &[f32]) {
        let first = distances[0] < 0.0;
        if distances.iter().all(|distance| (*distance < 0.0) == first) {
            return;
        }
        for cell in corners(key) {
            let of = |k: usize| distances[at(added(cell, corner(k)), key)];
            let inside = inside(of);
            if inside == 0 || inside == Inside::MAX {
                continue;
            }
            let sheets = Sheets::of(inside, is_joined(grid, cell, inside));
            let (block, place) = index(cell);
            let first = self.surface.positions.len() as u32;
            self.cells.entry(block).or_insert_with(|| vec![None; CORNERS])[place] =
                Some(SurfaceCell { first, sheets });
            for sheet in 0..sheets.count {
                let (mut sum, mut count) = ([0.0f32; 3], 0.0f32);
                for (a, axis) in crossed(inside).filter(|(a, axis)| sheets.at(*a, *axis) == sheet) {
                    let share = of(a) / (of(a) - of(a | 1 << axis));
                    (0..3).for_each(|k| sum[k] += corner(a)[k] as f32 + if k == axis { share } else { 0.0 });
                    count += 1.0;
                }
                let point = grid.project(cell, sum.map(|x| x / count));
                self.surface.positions.push(std::array::from_fn(|k| cell[k] as f32 + point[k]));
            }
        }
    }

    /// The point of the sheet that crosses the edge along an axis at a corner of a cell.
    fn point(&self, cell: [i32; 3], corner: usize, axis: usize) -> Option<u32> {
        let (block, at) = index(cell);
        let SurfaceCell { first, sheets } = self.cells.get(&block)?[at]?;
        Some(first + u32::from(sheets.at(corner, axis)))
    }

    /// Adds a quad across each edge of a block that the surface crosses.
    fn add_quads(&mut self, key: Key, distances: &[f32]) {
        for from in corners(key) {
            let own = distances[at(from, key)] < 0.0;
            for axis in 0..3 {
                let mut next = from;
                next[axis] += 1;
                if own == (distances[at(next, key)] < 0.0) {
                    continue;
                }
                let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
                let around = [[0, 0], [1, 0], [1, 1], [0, 1]].map(|[a, b]| {
                    let mut cell = from;
                    (cell[u], cell[v]) = (cell[u] - a, cell[v] - b);
                    self.point(cell, (a as usize) << u | (b as usize) << v, axis)
                });
                if let [Some(a), Some(b), Some(c), Some(d)] = around {
                    self.surface.quads.push(if own { [a, b, c, d] } else { [d, c, b, a] });
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

    /// The enclosed volume in those of the cubes of the particles.
    fn share(particles: &[[f32; 3]], spacing: f32) -> f32 {
        let surface = LiquidSurface::of(particles, spacing, SurfaceShape::DEFAULT);
        volume(&surface) / (particles.len() as f32 * spacing.powi(3))
    }

    /// Numbers from 0 to 1 of a linear congruential generator.
    fn random(seed: u32) -> impl FnMut() -> f32 {
        let mut state = seed;
        move || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (state >> 8) as f32 / (1 << 24) as f32
        }
    }

    #[test]
    fn the_surface_encloses_the_volume_of_its_particles() {
        let block = |[x, y, z]: [i32; 3]| -> Vec<[f32; 3]> {
            let all = (0..x * y * z).map(|k| [k % x, k / x % y, k / (x * y)]);
            all.map(|place| place.map(|k| 0.02 * (k as f32 + 0.27))).collect()
        };
        let cases = [
            ("a block", block([17; 3]), 0.03),
            ("a block of few", block([7; 3]), 0.08),
            ("a sheet", block([30, 1, 30]), 0.06),
            ("a row", block([1, 50, 1]), 0.1),
            ("a ball", ball(8.3 * 0.02, 0.02), 0.03),
            ("a drop", ball(2.3 * 0.02, 0.02), 0.1),
        ];
        for (name, particles, bound) in cases {
            let share = share(&particles, 0.02);
            assert!((share - 1.0).abs() < bound, "{name}: {share}");
        }
        // The grid is two cells a spacing, so the ball of one depends on its place in the cell.
        let mut random = random(7);
        let spray: Vec<_> = (0..200u8).map(|k| [f32::from(k), random(), random()]).collect();
        let share = share(&spray, 0.25);
        assert!((share - 1.0).abs() < 0.1, "spray: {share}");
    }

    /// Edges without exactly two faces of opposite directions, and points whose faces are no single fan.
    fn defects(surface: &LiquidSurface) -> [usize; 2] {
        let mut edges = BTreeMap::new();
        let mut fans: BTreeMap<u32, BTreeMap<u32, u32>> = BTreeMap::new();
        let mut faces = BTreeMap::new();
        for quad in &surface.quads {
            for k in 0..4 {
                let [before, a, b] = [quad[(k + 3) % 4], quad[k], quad[(k + 1) % 4]];
                let [count, sum] = edges.entry([a.min(b), a.max(b)]).or_insert([0, 0]);
                (*count, *sum) = (*count + 1, *sum + if a < b { 1 } else { -1 });
                fans.entry(a).or_default().insert(before, b);
                *faces.entry(a).or_insert(0) += 1;
            }
        }
        let is_fan = |(point, next): (&u32, &BTreeMap<u32, u32>)| {
            let start = next.keys().next().copied();
            let step = |at: &u32| next.get(at).copied().filter(|at| Some(*at) != start);
            std::iter::successors(start, step).take(100).count() == faces[point]
        };
        let open = edges.values().filter(|edge| **edge != [2, 0]).count();
        [open, fans.iter().filter(|fan| !is_fan(*fan)).count()]
    }

    #[test]
    fn each_edge_of_the_surface_has_two_faces_and_each_point_a_single_fan() {
        for seed in 0..20 {
            let mut random = random(seed);
            // From spray to a volume that is nearly filled.
            let count = 40 * (seed as usize + 1);
            let particles: Vec<_> = (0..count).map(|_| [0; 3].map(|_| 9.0 * random())).collect();
            let surface = LiquidSurface::of(&particles, 1.0, SurfaceShape::DEFAULT);
            assert_eq!(defects(&surface), [0, 0], "seed {seed}");
        }
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
            // The ball is as wide as two and a half cells: its points are outside of it, and its faces cut it.
            assert!((0.9..1.3).contains(&nearest), "{nearest}");
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
        let bytes = size_of::<[f32; 4]>() * grid.sums.len();
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
