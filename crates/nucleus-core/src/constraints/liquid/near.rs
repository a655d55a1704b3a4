//! The neighbours of the particles of a cell, and the kernel over eight of them at a time.
//!
//! All particles of a cell have the same 27 cells about them, whose particles are listed once, in blocks of eight that follow
//! each other in memory. A particle tests a block at a time and lists those within reach; the kernel takes the list eight at
//! a time, of which the last are filled up with a far particle, whose kernel is 0.

use crate::math::{Lanes, dot, sub};

use super::grid::CellGrid;
use super::kernel::{REACH, weights_and_slopes};
use super::pair::Pair;

/// Lanes of a register.
pub const LANES: usize = 8;
/// Coordinate of a particle out of reach of all others, in rest distances: its square is finite.
const FAR: f32 = 1e15;
/// The pairs of a particle are a multiple of so many; the last are those with itself, which have no gradient.
const PAIRS: usize = 4;
/// Distance below which two particles have no direction: they part along that of the others.
const MIN_DISTANCE: f32 = 1e-6;

/// The lanes of each mask of eight, in order; what follows them is overwritten.
const LANES_OF_MASKS: [[u8; LANES]; 256] = lanes_of_masks();

const fn lanes_of_masks() -> [[u8; LANES]; 256] {
    let mut table = [[0; LANES]; 256];
    let mut mask = 0;
    while mask < 256 {
        let (mut lane, mut count) = (0, 0);
        while lane < LANES {
            if mask >> lane & 1 == 1 {
                table[mask][count] = lane as u8;
                count += 1;
            }
            lane += 1;
        }
        mask += 1;
    }
    table
}

/// The number of lanes of each mask: a table, because machines without POPCNT count as well.
const COUNTS: [u8; 256] = counts_of_masks();

const fn counts_of_masks() -> [u8; 256] {
    let mut table = [0; 256];
    let mut mask = 0;
    while mask < 256 {
        table[mask] = mask.count_ones() as u8;
        mask += 1;
    }
    table
}

/// Sums over the pairs of a particle.
#[derive(Debug, Clone, Copy)]
pub struct PairSums {
    /// Density, and the sum of the gradients.
    pub density: [f32; 4],
    /// The sum of the squared gradients.
    pub squares: f32,
}

/// Particles in the order of cells.
#[derive(Debug, Clone, Copy)]
pub struct Sorted<'a> {
    /// Their cells.
    pub grid: &'a CellGrid,
    /// Positions, with the tag of the particle's own number as the fourth, and a far one at the end.
    pub positions: &'a [[f32; 4]],
    /// Positions by axis, with eight far ones at the end.
    pub columns: &'a [Vec<f32>; 3],
}

/// A position out of reach of all others.
pub fn far_position() -> [f32; 4] {
    [FAR, FAR, FAR, Pair::tag(0)]
}

/// Takes up positions in the sorted order by axis, with eight far ones at the end.
pub fn fill_columns(columns: &mut [Vec<f32>; 3], places: impl Iterator<Item = [f32; 3]> + Clone) {
    for (axis, column) in columns.iter_mut().enumerate() {
        column.clear();
        column.extend(places.clone().map(|place| place[axis]));
        column.extend([FAR; LANES]);
    }
}

/// What is about a cell, in blocks of up to eight that follow each other in the sorted order.
#[derive(Debug, Default)]
pub struct CellBlocks {
    cell: Option<[u32; 3]>,
    /// The first of each block, and how many there are.
    blocks: Vec<[u32; 2]>,
}

impl CellBlocks {
    /// Forgets the cell, before the grid changes.
    pub fn clear(&mut self) {
        self.cell = None;
    }

    /// Lists what is about a cell; of the same cell it is known.
    #[inline(always)]
    pub fn enter(&mut self, grid: &CellGrid, cell: [u32; 3]) {
        if self.cell != Some(cell) {
            self.list(grid, cell);
        }
    }

    fn list(&mut self, grid: &CellGrid, cell: [u32; 3]) {
        self.cell = Some(cell);
        self.blocks.clear();
        grid.visit_runs(cell, |run| {
            for first in run.clone().step_by(LANES) {
                self.blocks.push([first as u32, (run.end - first).min(LANES) as u32]);
            }
        });
    }

    /// The density at a place in the cell, by the positions of particles by axis, with eight far ones at the end.
    #[inline(always)]
    pub fn density<W: Lanes<f32, Array = [[f32; 4]; 2]>>(
        &self,
        [xs, ys, zs]: &[Vec<f32>; 3],
        [x, y, z]: [f32; 3],
    ) -> f32 {
        let centre = [W::splat(x), W::splat(y), W::splat(z)];
        let mut sum = W::splat(0.0);
        for &[first, count] in &self.blocks {
            let first = first as usize;
            let apart = sub(centre, [load::<W>(xs, first), load(ys, first), load(zs, first)]);
            let [weight, _] = weights_and_slopes(dot(apart, apart).sqrt());
            let is_listed = W::splat(count as f32) - lane_numbers::<W>();
            sum = sum + is_listed.choose_by_sign(weight, W::splat(0.0));
        }
        total(sum)
    }

    /// The first of each block, and how many there are.
    #[inline(always)]
    pub fn blocks(&self) -> &[[u32; 2]] {
        &self.blocks
    }
}

/// The particles about a cell.
#[derive(Debug, Default)]
pub struct Surroundings {
    about: CellBlocks,
    /// Particles within reach of one.
    near: Vec<u32>,
}

impl Surroundings {
    /// Forgets the cell, before a new search.
    pub fn clear(&mut self) {
        self.about.clear();
    }

    /// Adds the pairs of a particle, which is `at` in the sorted order, to a list.
    #[inline(always)]
    pub fn find<W: Lanes<f32, Array = [[f32; 4]; 2]>>(
        &mut self,
        sorted: Sorted<'_>,
        at: u32,
        pairs: &mut Vec<Pair>,
    ) -> PairSums {
        let [x, y, z, _] = sorted.positions[at as usize];
        self.about.enter(sorted.grid, sorted.grid.cell([x, y, z]));
        self.near.resize((self.about.blocks.len() + 1) * LANES, 0);
        let place = [x, y, z].map(W::splat);
        let count = self.list_near(sorted, place, at);
        let first = pairs.len();
        let sums = self.evaluate(sorted.positions, place, count, pairs);
        pairs.truncate(first + count);
        pairs.resize(first + count.next_multiple_of(PAIRS), Pair::new([0.0; 3], at));
        sums
    }

    /// Lists the particles within reach, but for the particle itself, and far ones up to a full eight. Returns their number.
    #[inline(always)]
    fn list_near<W: Lanes<f32, Array = [[f32; 4]; 2]>>(
        &mut self,
        sorted: Sorted<'_>,
        place: [W; 3],
        at: u32,
    ) -> usize {
        let reach = W::splat(REACH * REACH);
        let [xs, ys, zs] = sorted.columns.each_ref().map(|column| &column[..sorted.columns[0].len()]);
        let mut count = 0;
        for &[first, listed] in &self.about.blocks {
            let x = place[0] - load::<W>(xs, first as usize);
            let y = place[1] - load::<W>(ys, first as usize);
            let z = place[2] - load::<W>(zs, first as usize);
            let own = 1u32.checked_shl(at.wrapping_sub(first)).unwrap_or(0);
            let mask =
                (reach - (x * x + y * y + z * z)).above_zero() & (0xff >> (LANES as u32 - listed)) & !own;
            // Eight are written at a time, and those that are too far overwritten: this needs no branch.
            let lanes = &LANES_OF_MASKS[mask as usize & 0xff];
            let out = &mut self.near[count..count + LANES];
            (0..LANES).for_each(|k| out[k] = first + u32::from(lanes[k]));
            count += usize::from(COUNTS[mask as usize & 0xff]);
        }
        let far = sorted.positions.len() as u32 - 1;
        self.near[count..count + LANES].fill(far);
        count
    }

    /// The kernel over the first `count` of the list. Pairs of far particles follow.
    #[inline(always)]
    fn evaluate<W: Lanes<f32, Array = [[f32; 4]; 2]>>(
        &self,
        positions: &[[f32; 4]],
        place: [W; 3],
        count: usize,
        pairs: &mut Vec<Pair>,
    ) -> PairSums {
        let zero = W::splat(0.0);
        let mut sums = [zero; 5];
        let (eights, _) = self.near[..count.next_multiple_of(LANES)].as_chunks::<LANES>();
        for near in eights {
            let row = |k: usize| positions[near[k] as usize];
            // A loop, because maps over arrays are not inlined.
            let mut rows = [zero; 4];
            for k in 0..4 {
                rows[k] = W::from_array([row(k), row(k + 4)]);
            }
            let [x, y, z, tags] = W::transpose(rows);
            let [x, y, z] = [place[0] - x, place[1] - y, place[2] - z];
            let distance = (x * x + y * y + z * z).sqrt();
            let [weight, slope] = weights_and_slopes(distance);
            let scale = (distance - W::splat(MIN_DISTANCE)).choose_by_sign(slope / distance, zero);
            let gradient = [x * scale, y * scale, z * scale];
            let square = gradient[0] * gradient[0] + gradient[1] * gradient[1] + gradient[2] * gradient[2];
            sums[0] = sums[0] + weight;
            (0..3).for_each(|axis| sums[axis + 1] = sums[axis + 1] + gradient[axis]);
            sums[4] = sums[4] + square;
            let rows = W::transpose([gradient[0], gradient[1], gradient[2], tags]).map(W::to_array);
            let eight: [Pair; LANES] = std::array::from_fn(|k| Pair::from_row(rows[k % 4][k / 4]));
            pairs.extend_from_slice(&eight);
        }
        let [weight, x, y, z, squares] = sums.map(total);
        PairSums { density: [weight, x, y, z], squares }
    }
}

/// Eight numbers of a column from one on.
#[inline(always)]
pub fn load<W: Lanes<f32, Array = [[f32; 4]; 2]>>(column: &[f32], first: usize) -> W {
    let (fours, _) = column[first..first + LANES].as_chunks::<4>();
    W::from_array([fours[0], fours[1]])
}

/// The sum of all lanes.
#[inline(always)]
pub fn total<W: Lanes<f32, Array = [[f32; 4]; 2]>>(lanes: W) -> f32 {
    let [low, high] = lanes.to_array();
    let [a, b, c, d] = [0, 1, 2, 3].map(|k: usize| low[k] + high[k]);
    (a + b) + (c + d)
}

/// The number of each lane.
#[inline(always)]
pub fn lane_numbers<W: Lanes<f32, Array = [[f32; 4]; 2]>>() -> W {
    W::from_array([[0.0, 1.0, 2.0, 3.0], [4.0, 5.0, 6.0, 7.0]])
}
