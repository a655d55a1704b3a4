//! The signed distance to the surface of particles, on a grid in blocks.

use std::collections::{BTreeMap, BTreeSet};

use super::cell::corner;
use crate::run::SurfaceShape;

/// The reach of a particle in its spacings.
const REACH: f32 = 1.75;
/// The radius of a particle on its own, in spacings: that of a ball with the volume of its cube.
pub(super) const RADIUS: f32 = 0.620_350_5;
/// The distance in spacings from the flat surface of a block of particles to the weighted mean of the particles round a place on
/// it: half a spacing to the particles of the first layer, and a share of the ones below.
const FLAT_RADIUS: f32 = 0.508;
/// The density there; a particle on its own has a density of 1 at its surface.
const FLAT_DENSITY: f32 = 2.57;
/// The density below which there is no surface. It is below 1, because weights are interpolated between corners, and those of a
/// particle on its own are lower there.
const LEAST_DENSITY: f32 = 0.85;
/// Cells of the grid along a spacing.
const CELLS: f32 = 2.0;
/// Scale of the radius, at most: the reach grows with it.
const MAX_RADIUS_SCALE: f32 = 4.0;
/// Cells from the origin, at most: particles beyond, as of a broken run, have no surface.
const MAX_CELLS: f32 = 1e9;
/// Cells along the side of a block, about half of the diameter that a particle reaches: larger blocks store more that none
/// reaches, smaller ones are more to look up.
pub(super) const SIDE: i32 = 4;
/// Corners of a block.
pub(super) const CORNERS: usize = (SIDE * SIDE * SIDE) as usize;

/// A place in blocks.
pub(super) type Key = [i32; 3];

/// The block of a corner, and its index in it.
pub(super) fn index([x, y, z]: [i32; 3]) -> (Key, usize) {
    let block = [x, y, z].map(|k| k.div_euclid(SIDE));
    let [x, y, z] = [x, y, z].map(|k| k.rem_euclid(SIDE));
    (block, ((z * SIDE + y) * SIDE + x) as usize)
}

/// The corners of a block.
pub(super) fn corners([x, y, z]: Key) -> impl Iterator<Item = [i32; 3]> {
    (0..CORNERS as i32)
        .map(move |k| [x * SIDE + k % SIDE, y * SIDE + k / SIDE % SIDE, z * SIDE + k / (SIDE * SIDE)])
}

/// The weighted sum of the particles relative to a place, in spacings, and of the weights.
type Sums = [f32; 4];

pub(super) struct Grid {
    /// The side of a cell, in the units of the particles.
    pub width: f32,
    /// The reach of a particle in spacings.
    reach: f32,
    radius_scale: f32,
    /// The weight at the surface of a particle on its own.
    own_weight: f32,
    least_weight: f32,
    /// In each block that a particle reaches, by corner.
    pub sums: BTreeMap<Key, Vec<Sums>>,
}

impl Grid {
    /// The grid of particles of this spacing, in their units.
    pub fn of(particles: &[[f32; 3]], spacing: f32, shape: SurfaceShape) -> Self {
        let radius_scale = shape.radius_scale.min(MAX_RADIUS_SCALE);
        let reach = REACH.max(1.5 * RADIUS * radius_scale);
        let mut grid = Grid {
            width: spacing / CELLS,
            reach,
            radius_scale,
            own_weight: (1.0 - (RADIUS * radius_scale / reach).powi(2)).powi(3),
            least_weight: shape.threshold.max(1e-6),
            sums: BTreeMap::new(),
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
    pub fn keys(&self) -> BTreeSet<Key> {
        let below = |key: &Key| {
            let key = *key;
            (0..8).map(move |k: usize| std::array::from_fn(|axis| key[axis] - corner(k)[axis]))
        };
        self.sums.keys().flat_map(below).collect()
    }

    fn sums_at(&self, corner: [i32; 3]) -> Sums {
        let (block, at) = index(corner);
        self.sums.get(&block).map_or([0.0; 4], |sums| sums[at])
    }

    /// The signed distance of a corner in spacings.
    pub fn distance(&self, corner: [i32; 3]) -> f32 {
        self.distance_of(&self.sums_at(corner))
    }

    /// The signed distances of the corners of a block's cells in spacings, `SIDE + 1` along each axis.
    pub fn distances(&self, key: Key) -> Vec<f32> {
        let blocks: [_; 8] =
            std::array::from_fn(|k| self.sums.get(&std::array::from_fn(|axis| key[axis] + corner(k)[axis])));
        let outside = self.distance_of(&[0.0; 4]);
        let line = || 0..=SIDE;
        let all = line().flat_map(|z| line().flat_map(move |y| line().map(move |x| [x, y, z])));
        let of = |place: [i32; 3]| {
            let block = (0..3).map(|axis| usize::from(place[axis] == SIDE) << axis).sum::<usize>();
            blocks[block].map_or(outside, |sums| self.distance_of(&sums[index(place).1]))
        };
        all.map(of).collect()
    }

    /// The signed distance of a place in spacings: the distance to the weighted mean of the particles, less a radius that is
    /// smaller where they are denser. Where even a particle on its own would have no surface the distance grows, because the mean
    /// of particles that are far apart is no surface.
    fn distance_of(&self, [x, y, z, weight]: &Sums) -> f32 {
        let density = weight / self.own_weight;
        let share = ((density - 1.0) / (FLAT_DENSITY - 1.0)).clamp(0.0, 1.0);
        let radius = self.radius_scale * (RADIUS + (FLAT_RADIUS - RADIUS) * share);
        let length = (x * x + y * y + z * z).sqrt() / weight.max(1e-9);
        let sparse = (1.0 - density / LEAST_DENSITY).max(0.0)
            + 2.0 * (1.0 - weight / self.least_weight).max(0.0) * self.reach;
        length.min(self.reach) - radius + sparse
    }

    /// Moves a place in a cell to the surface, in cells from its lowest corner: one secant step along the line to the mean of the
    /// particles. The sums at a place are interpolated between the corners, which is exact for one particle.
    pub fn project(&self, cell: [i32; 3], place: [f32; 3]) -> [f32; 3] {
        let corners: [Sums; 8] =
            std::array::from_fn(|k| self.sums_at(std::array::from_fn(|axis| cell[axis] + corner(k)[axis])));
        let sums = |place: [f32; 3]| interpolated(&corners, place);
        let start = sums(place);
        let distance = self.distance_of(&start);
        let length = (0..3).map(|axis| start[axis] * start[axis]).sum::<f32>().sqrt();
        if length < 1e-3 * start[3] || start[3] == 0.0 {
            return place;
        }
        let moved = |share: f32| -> [f32; 3] {
            std::array::from_fn(|axis| {
                (place[axis] + share * start[axis] / length * distance * CELLS).clamp(0.0, 1.0)
            })
        };
        let change = distance - self.distance_of(&sums(moved(1.0)));
        let share = distance / change;
        if share.is_finite() { moved(share.clamp(0.0, 2.0)) } else { place }
    }
}

/// The sums at a place in a cell, from those at its corners.
fn interpolated(corners: &[Sums; 8], place: [f32; 3]) -> Sums {
    let mut sums = [0.0; 4];
    for (k, of) in corners.iter().enumerate() {
        let offset = corner(k).map(|x| x as f32);
        let share: f32 = (0..3).map(|axis| 1.0 - (place[axis] - offset[axis]).abs()).product();
        (0..3).for_each(|axis| {
            sums[axis] += share * (of[axis] + of[3] * (offset[axis] - place[axis]) / CELLS);
        });
        sums[3] += share * of[3];
    }
    sums
}
