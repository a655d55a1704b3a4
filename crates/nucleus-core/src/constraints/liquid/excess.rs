//! The excess of density that a time step of a liquid finds at its start, and how much of that it corrects.
//!
//! A correction becomes velocity, so an excess that no motion of the step has made goes at a limited rate. The solver knows
//! what it has left itself; but the constraint is linear, so a step ends with more, most where walls move or leave no room.
//! Where a step would correct more than may go of it, the excess at its start is therefore measured. Corrected as if the
//! step had made it, it let a liquid leave a floor that starts at 8 m/s with 29 m/s, and one that a piston left no room
//! reached 37 km/s.

use crate::math::{dot, sub};
use crate::parallel::disjoint::DisjointSlice;
use crate::parallel::thread_pool::ThreadPool;

use super::grid::CellGrid;
use super::kernel::{REACH, weight};
use super::neighbours::{CHUNK, Neighbours, chunk_range};
use super::walls::Walls;

/// Rate at which an excess of density that the solver has left goes, in 1/s.
const RECOVERY: f32 = 10.0;
/// Largest share of it that goes in a time step.
const MAX_RECOVERY: f32 = 0.5;
/// Speed in m/s at which particles would make the excess that a time step corrects of that from before it, at most. A floor
/// that starts at 8 m/s throws a liquid off at 9.
const RECOVERY_SPEED: f64 = 0.6;

/// How much of an excess from before it a time step corrects.
#[derive(Debug, Clone, Copy)]
pub struct Recovery {
    /// Share of what the solver has left.
    share: f32,
    /// At most, where all is measured.
    most: f32,
}

impl Recovery {
    /// For a time step in seconds, and a rest distance in metres.
    pub fn new(h: f64, spacing: f64) -> Self {
        Self { share: (RECOVERY * h as f32).min(MAX_RECOVERY), most: (RECOVERY_SPEED * h / spacing) as f32 }
    }

    /// What a time step keeps of the excess `now` at its end, by what earlier ones have left and what was measured.
    pub fn kept(&self, now: f32, left: f32, before: f32) -> f32 {
        (left * (1.0 - self.share)).max(before - self.most).min(now).max(0.0)
    }
}

/// The excess of each particle of a liquid.
#[derive(Debug, Default)]
pub struct Excess {
    /// What the solver has left.
    pub left: Vec<f32>,
    /// All before the time step; 0 where it is not measured.
    pub before: Vec<f32>,
    measured: Vec<u32>,
    densities: Vec<f32>,
    grid: CellGrid,
    sorted: Vec<[f32; 3]>,
}

impl Excess {
    /// Chooses the particles to measure, by their neighbours at the end of the time step: all with an excess where the frame
    /// begins, then those of which more would go than may. Returns whether there are any.
    pub fn choose(&mut self, neighbours: &Neighbours, recovery: Recovery, begins: bool) -> bool {
        self.before.clear();
        self.before.resize(neighbours.len(), 0.0);
        let limit = 1.0 + if begins { 0.0 } else { recovery.most };
        self.measured.clear();
        let by_particle = neighbours.grid.order().iter().zip(&neighbours.sums);
        self.measured.extend(by_particle.filter(|(_, sums)| sums[0] > limit).map(|(&particle, _)| particle));
        !self.measured.is_empty()
    }

    /// Measures the chosen particles in positions and walls at the start of the time step, in rest distances.
    pub fn measure(&mut self, positions: &[[f32; 3]], walls: &Walls, pool: &ThreadPool) {
        self.grid.sort(positions, REACH);
        self.sorted.clear();
        self.sorted.extend(self.grid.order().iter().map(|&particle| positions[particle as usize]));
        let Self { measured, densities, grid, sorted, .. } = self;
        densities.clear();
        densities.resize(measured.len(), 0.0);
        let out = DisjointSlice::new(densities);
        pool.parallel_for(measured.len().div_ceil(CHUNK as usize), |chunk| {
            let range = chunk_range(chunk, measured.len());
            // SAFETY: chunks do not overlap.
            #[allow(unsafe_code)]
            let out = unsafe { out.run(range.clone()) };
            for (out, at) in out.iter_mut().zip(range) {
                let place = positions[measured[at as usize] as usize];
                grid.visit_runs(grid.cell(place), |run| {
                    let apart = sorted[run].iter().map(|&other| sub(place, other));
                    *out += apart.map(|apart| weight(dot(apart, apart).sqrt())).sum::<f32>();
                });
                walls.near(place, |density, _, _| *out += density);
            }
        });
        for (&particle, &density) in self.measured.iter().zip(&self.densities) {
            self.before[particle as usize] = (density - 1.0).max(0.0);
        }
    }

    /// Begins a frame with what was measured: the solver has left all of it.
    pub fn begin(&mut self) {
        self.left.clone_from(&self.before);
    }
}

#[cfg(test)]
mod tests {
    use super::super::grid::tests::spread;
    use super::*;

    #[test]
    fn the_excess_is_that_of_the_neighbours_there() {
        let (places, pool) = (spread(900, 8.0), ThreadPool::new(2));
        let mut neighbours = Neighbours::default();
        neighbours.find(&places, &Walls::default(), &pool);
        let mut excess = Excess::default();
        assert!(excess.choose(&neighbours, Recovery::new(0.01, 0.1), true));
        excess.measure(&places, &Walls::default(), &pool);
        for (&particle, sums) in neighbours.grid.order().iter().zip(&neighbours.sums) {
            let expected = (sums[0] - 1.0).max(0.0);
            assert!((excess.before[particle as usize] - expected).abs() < 1e-4, "{particle}");
        }
    }

    #[test]
    fn more_goes_than_the_rate_allows_only_where_the_step_has_made_it() {
        let recovery = Recovery::new(0.01, 0.1);
        // 0.6 m/s over 0.01 s are 0.06 rest distances.
        for (now, left, before, corrected) in
            [(0.5, 0.0, 0.0, 0.5), (0.5, 0.0, 0.5, 0.06), (0.5, 0.5, 0.0, 0.05), (0.9, 0.0, 0.5, 0.46)]
        {
            let kept = recovery.kept(now, left, before);
            assert!(
                (now - kept - corrected).abs() < 1e-6,
                "{now} with {left} left and {before} before: {kept}"
            );
        }
    }
}
