//! The excess of density that a time step of a liquid finds at its start, and how much of that it corrects.
//!
//! A correction becomes velocity, so an excess that no motion of the step has made goes at a limited rate. The solver knows
//! what it has left itself; but the constraint is linear, so a step ends with more, most where walls move or leave no room.
//! Where a step would correct more than may go of it, the excess at its start is therefore measured. Corrected as if the
//! step had made it, it let a liquid leave a floor that starts at 8 m/s with 29 m/s, and one that a piston left no room
//! reached 37 km/s.

use crate::math::Lanes;
use crate::math::kernel::{self, KernelOfEight};
use crate::parallel::thread_pool::ThreadPool;

use super::grid::CellGrid;
use super::kernel::REACH;
use super::near::{CellBlocks, fill_columns};
use super::neighbours::{CHUNK, Neighbours, chunk_range};
use super::walls::{NearWalls, Walls};

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
    grid: CellGrid,
    /// Positions by axis, in the order of the grid, with eight far ones at the end.
    columns: [Vec<f32>; 3],
    tasks: Vec<Measurement>,
}

/// The densities of the particles of a task.
#[derive(Debug, Default)]
struct Measurement {
    about: CellBlocks,
    walls: NearWalls,
    places: Vec<[f32; 4]>,
    /// Density; what follows is not used.
    sums: Vec<[f32; 4]>,
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
        let Self { measured, grid, columns, tasks, before, .. } = self;
        grid.sort(positions, REACH);
        fill_columns(columns, grid.order().iter().map(|&particle| positions[particle as usize]));
        let count = measured.len().div_ceil(CHUNK as usize);
        tasks.resize_with(tasks.len().max(count), Measurement::default);
        pool.for_each_mut(&mut tasks[..count], |task, found| {
            let range = chunk_range(task, measured.len());
            found.places.clear();
            found.places.extend(measured[range.start as usize..range.end as usize].iter().map(|&at| {
                let [x, y, z] = positions[at as usize];
                [x, y, z, 0.0]
            }));
            found.measure((grid, columns), walls);
        });
        let sums = tasks[..count].iter().flat_map(|task| &task.sums);
        for (&particle, sum) in measured.iter().zip(sums) {
            before[particle as usize] = (sum[0] - 1.0).max(0.0);
        }
    }

    /// Begins a frame with what was measured: the solver has left all of it.
    pub fn begin(&mut self) {
        self.left.clone_from(&self.before);
    }
}

impl Measurement {
    /// Sums over all particles, in the order of a grid, and over walls.
    fn measure(&mut self, particles: (&CellGrid, &[Vec<f32>; 3]), walls: &Walls) {
        self.about.clear();
        self.sums.clear();
        let (grid, columns) = particles;
        // SAFETY: the sum has no condition.
        #[allow(unsafe_code)]
        unsafe {
            kernel::run(SumDensities { measurement: self, grid, columns });
        }
        self.walls.find(walls, &self.places, &mut self.sums);
    }
}

/// Sums the kernel over all particles, by axis in the order of a grid.
struct SumDensities<'a> {
    measurement: &'a mut Measurement,
    grid: &'a CellGrid,
    columns: &'a [Vec<f32>; 3],
}

impl KernelOfEight<f32> for SumDensities<'_> {
    /// # Safety
    /// The machine has the lanes.
    #[inline(always)]
    #[allow(unsafe_code)]
    unsafe fn run_eight<W: Lanes<f32, Array = [[f32; 4]; 2]>>(self) {
        let Self { measurement: Measurement { about, places, sums, .. }, grid, columns } = self;
        for &[x, y, z, _] in &*places {
            about.enter(grid, grid.cell([x, y, z]));
            sums.push([about.density::<W>(columns, [x, y, z]), 0.0, 0.0, 0.0]);
        }
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
