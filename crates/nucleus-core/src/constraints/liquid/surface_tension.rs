//! Surface tension: all particles within four rest distances of each other attract.
//!
//! A force f(r) per mass between all pairs of particles of a uniform liquid gives a tension over density of pi/8 times the
//! integral of r⁴ f(r), per cubed rest distance (Kirkwood & Buff 1949, for a sharp surface). The potential is wide and
//! smooth, -(1 - r²/16)³, so its sum over the neighbours hardly depends on how they are arranged. A force that reaches two
//! rest distances only and peaks at one (Akinci et al. 2013, eq. 2) feels the order of the particles more than the shape of
//! the surface: a drop with axes of 1.5 to 1 came to rest at 1.3 to 1.

use std::f32::consts::PI;

use crate::math::kernel::{self, KernelOfEight};
use crate::math::{Lanes, dot, sub};
use crate::parallel::disjoint::DisjointSlice;
use crate::parallel::thread_pool::ThreadPool;

use super::grid::CellGrid;
use super::near::{CellBlocks, LANES, fill_columns, lane_numbers, load, total};
use super::neighbours::{CHUNK, chunk_range};

/// Reach of the force in rest distances.
const REACH: f32 = 4.0;
/// The integral of q⁴ times [`attraction`] over the reach.
const FOURTH_MOMENT: f32 = 2048.0 / 30.0;

/// The force between two particles over their distance q in rest distances, by q²: q times this is the force.
#[inline(always)]
fn attraction<W: Lanes<f32>>(square: W) -> W {
    let inside = (W::splat(1.0) - square * W::splat(1.0 / (REACH * REACH))).most(W::splat(0.0));
    inside * inside
}

/// Acceleration of a unit of attraction in rest distances per squared second: `tension` is surface tension over density, in
/// cubed rest distances per squared second.
pub fn strength(tension: f32) -> f32 {
    8.0 * tension / (PI * FOURTH_MOMENT)
}

/// The pull of surface tension on each particle of a liquid.
#[derive(Debug, Default)]
pub struct SurfaceTension {
    /// Acceleration by particle for a strength of one, and a zero.
    pub pull: Vec<[f32; 4]>,
    grid: CellGrid,
    /// Positions by axis, in the order of the grid, with eight far ones at the end.
    columns: [Vec<f32>; 3],
    /// Half of the factor on each particle, in that order, and eight more.
    halves: Vec<f32>,
    /// The surroundings of each task.
    tasks: Vec<CellBlocks>,
}

impl SurfaceTension {
    /// Computes the pull on all particles, from their positions in rest distances. The factors are by particle, and empty
    /// where they are 1; a pair has the mean of its two.
    pub fn find(&mut self, positions: &[[f32; 3]], factors: &[f32], pool: &ThreadPool) {
        let Self { pull, grid, columns, halves, tasks } = self;
        grid.sort(positions, REACH);
        fill_columns(columns, grid.order().iter().map(|&particle| positions[particle as usize]));
        let half = |&particle: &u32| 0.5 * factors.get(particle as usize).copied().unwrap_or(1.0);
        halves.clear();
        halves.extend(grid.order().iter().map(half));
        halves.extend([0.0; LANES]);
        pull.clear();
        pull.resize(positions.len(), [0.0; 4]);
        let count = positions.len().div_ceil(CHUNK as usize);
        tasks.resize_with(count, CellBlocks::default);
        let (pull, grid, columns, halves) = (DisjointSlice::new(pull), &*grid, &*columns, &halves[..]);
        pool.for_each_mut(tasks, |task, about| {
            about.clear();
            let order = grid.order();
            let range = chunk_range(task, order.len());
            // SAFETY: the sum has no condition, and the order holds each particle once.
            #[allow(unsafe_code)]
            unsafe {
                let set = |at: usize, sum: [f32; 4]| pull.set(order[at], sum);
                let range = range.start as usize..range.end as usize;
                kernel::run(SumPulls { about, grid, columns, halves, range, set });
            }
        });
    }
}

/// Sums the attraction of all particles on those of a range, in the order of a grid.
struct SumPulls<'a, F> {
    about: &'a mut CellBlocks,
    grid: &'a CellGrid,
    columns: &'a [Vec<f32>; 3],
    halves: &'a [f32],
    range: std::ops::Range<usize>,
    set: F,
}

impl<F: Fn(usize, [f32; 4])> KernelOfEight<f32> for SumPulls<'_, F> {
    /// # Safety
    /// The machine has the lanes.
    #[inline(always)]
    #[allow(unsafe_code)]
    unsafe fn run_eight<W: Lanes<f32, Array = [[f32; 4]; 2]>>(self) {
        let Self { about, grid, columns: [xs, ys, zs], halves, range, set } = self;
        for at in range {
            let place = [xs[at], ys[at], zs[at]];
            about.enter(grid, grid.cell(place));
            let (centre, own) = (place.map(W::splat), W::splat(halves[at]));
            let mut sums = [W::splat(0.0); 3];
            for &[first, count] in about.blocks() {
                let first = first as usize;
                let apart = sub([load::<W>(xs, first), load(ys, first), load(zs, first)], centre);
                let pull = attraction(dot(apart, apart)) * (own + load(halves, first));
                let is_listed = W::splat(count as f32) - lane_numbers::<W>();
                let pull = is_listed.choose_by_sign(pull, W::splat(0.0));
                sums = [sums[0] + pull * apart[0], sums[1] + pull * apart[1], sums[2] + pull * apart[2]];
            }
            set(at, [total(sums[0]), total(sums[1]), total(sums[2]), 0.0]);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::grid::tests::spread;
    use super::*;
    use crate::math::Real;

    fn attraction_at(square: f32) -> f32 {
        attraction(<f32 as Real>::Lanes::splat(square)).to_array()[0]
    }

    #[test]
    fn the_fourth_moment_is_that_of_the_force() {
        let width = REACH / 20_000.0;
        let part = |k: u32| {
            let q = (k as f32 + 0.5) * width;
            f64::from(q.powi(5) * attraction_at(q * q) * width)
        };
        let sum: f64 = (0..20_000).map(part).sum();
        assert!((sum / f64::from(FOURTH_MOMENT) - 1.0).abs() < 1e-3, "{sum}");
    }

    #[test]
    fn the_pull_is_that_of_all_particles_within_reach() {
        let places = spread(700, 9.0);
        let factors: Vec<f32> = (0..700).map(|k| 0.5 + (k % 7) as f32 * 0.1).collect();
        let mut tension = SurfaceTension::default();
        tension.find(&places, &factors, &ThreadPool::new(2));
        for (at, place) in places.iter().enumerate() {
            let mut expected = [0.0f32; 3];
            for (other, near) in places.iter().enumerate() {
                let apart: [f32; 3] = std::array::from_fn(|axis| near[axis] - place[axis]);
                let factor = (factors[at] + factors[other]) * 0.5;
                let pull = factor * attraction_at(apart.iter().map(|x| x * x).sum());
                (0..3).for_each(|axis| expected[axis] += pull * apart[axis]);
            }
            let error =
                (0..3).map(|axis| (tension.pull[at][axis] - expected[axis]).abs()).fold(0.0, f32::max);
            assert!(error < 1e-3, "{at}: {:?} instead of {expected:?}", tension.pull[at]);
        }
    }
}
