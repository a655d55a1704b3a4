//! The neighbours of the particles of a cell, and the kernel over eight of them at a time.
//!
//! All particles of a cell have the same 27 cells about them, whose particles are listed once, in blocks of eight that follow
//! each other in memory. A particle tests a block at a time and lists those within reach; the kernel takes the list eight at
//! a time, of which the last are filled up with a far particle, whose kernel is 0.

use crate::math::Lanes;

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

/// The particles about a cell.
#[derive(Debug, Default)]
pub struct Surroundings {
    cell: Option<[u32; 3]>,
    /// The first of each block of eight, and the mask of those that are about the cell.
    blocks: Vec<[u32; 2]>,
    /// Particles within reach of one.
    near: Vec<u32>,
}

impl Surroundings {
    /// Forgets the cell, before a new search.
    pub fn clear(&mut self) {
        self.cell = None;
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
        let cell = sorted.grid.cell([x, y, z]);
        if self.cell != Some(cell) {
            self.enter(sorted.grid, cell);
        }
        let place = [x, y, z].map(W::splat);
        let count = self.list_near(sorted, place, at);
        let first = pairs.len();
        let sums = self.evaluate(sorted.positions, place, count, pairs);
        pairs.truncate(first + count);
        pairs.resize(first + count.next_multiple_of(PAIRS), Pair::new([0.0; 3], at));
        sums
    }

    /// Lists the particles about a cell.
    fn enter(&mut self, grid: &CellGrid, cell: [u32; 3]) {
        self.cell = Some(cell);
        self.blocks.clear();
        grid.visit_runs(cell, |run| {
            for first in run.clone().step_by(LANES) {
                let lanes = (run.end - first).min(LANES);
                self.blocks.push([first as u32, 0xff >> (LANES - lanes)]);
            }
        });
        self.near.resize((self.blocks.len() + 1) * LANES, 0);
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
        for &[first, lanes] in &self.blocks {
            let block = first as usize..first as usize + LANES;
            let x = place[0] - W::from_array(eight(&xs[block.clone()]));
            let y = place[1] - W::from_array(eight(&ys[block.clone()]));
            let z = place[2] - W::from_array(eight(&zs[block]));
            let own = 1u32.checked_shl(at.wrapping_sub(first)).unwrap_or(0);
            let mask = (reach - (x * x + y * y + z * z)).above_zero() & lanes & !own;
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
            let rows = [0, 1, 2, 3].map(|k: usize| W::from_array([row(k), row(k + 4)]));
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
        let [weight, x, y, z, squares] = sums.map(|sum| {
            let [low, high] = sum.to_array();
            let [a, b, c, d] = [0, 1, 2, 3].map(|k: usize| low[k] + high[k]);
            (a + b) + (c + d)
        });
        PairSums { density: [weight, x, y, z], squares }
    }
}

/// Eight numbers as two times four.
#[inline(always)]
fn eight(numbers: &[f32]) -> [[f32; 4]; 2] {
    let (fours, _) = numbers.as_chunks::<4>();
    [fours[0], fours[1]]
}
