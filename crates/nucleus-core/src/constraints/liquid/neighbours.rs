//! Neighbour lists of the predicted positions, with the gradients of all pairs.

use std::ops::Range;

use crate::math::{Lanes, Real};
use crate::parallel::disjoint::DisjointSlice;
use crate::parallel::thread_pool::ThreadPool;

use super::grid::{CellGrid, Pair};
use super::kernel::{REACH, slope, weight};
use super::walls::Walls;

/// Particles of a task.
pub const CHUNK: u32 = 256;

/// The pairs of some particles that follow each other.
#[derive(Debug, Default)]
pub struct Chunk {
    pairs: Vec<Pair>,
    /// End of each particle's pairs.
    ends: Vec<u32>,
    /// Pairs with walls that can move, and the end of each particle's.
    wall_pairs: Vec<Pair>,
    wall_ends: Vec<u32>,
    /// Particles within reach of one, itself among them, by their places in the sorted order.
    near: Vec<u32>,
}

/// Four distances of a particle.
type Four = <f32 as Real>::Lanes;
/// The lanes of each mask of four, in order; what follows them is overwritten.
const LANES: [[u32; 4]; 16] = lanes_of_masks();

/// The number of lanes of each mask.
const COUNTS: [usize; 16] = [0, 1, 1, 2, 1, 2, 2, 3, 1, 2, 2, 3, 2, 3, 3, 4];

const fn lanes_of_masks() -> [[u32; 4]; 16] {
    let mut table = [[0; 4]; 16];
    let mut mask = 0;
    while mask < 16 {
        let (mut lane, mut count) = (0, 0);
        while lane < 4 {
            if mask >> lane & 1 == 1 {
                table[mask][count] = lane;
                count += 1;
            }
            lane += 1;
        }
        mask += 1;
    }
    table
}

/// The neighbours of all particles; lengths in rest distances.
#[derive(Debug, Default)]
pub struct Neighbours {
    /// Particles by cell.
    pub grid: CellGrid,
    /// Positions in the sorted order.
    pub positions: Vec<[f32; 4]>,
    /// The same by axis, with three more places at the end.
    columns: [Vec<f32>; 3],
    /// Pairs by task.
    pub chunks: Vec<Chunk>,
    /// Density of each particle, and the sum of the gradients of its pairs and walls.
    pub sums: Vec<[f32; 4]>,
}

/// The particles of a task.
pub fn chunk_range(chunk: usize, count: usize) -> Range<u32> {
    let first = chunk as u32 * CHUNK;
    first..(first + CHUNK).min(count as u32)
}

impl Neighbours {
    /// Sorts the particles and finds all pairs nearer than the reach of the kernel, and what walls add.
    pub fn find(&mut self, positions: &[[f32; 3]], walls: &Walls, pool: &ThreadPool) {
        self.grid.sort(positions, REACH);
        self.positions.clear();
        let sorted = self.grid.order().iter().map(|&particle| positions[particle as usize]);
        self.positions.extend(sorted.map(|[x, y, z]| [x, y, z, 0.0]));
        for (axis, column) in self.columns.iter_mut().enumerate() {
            column.clear();
            column.extend(self.positions.iter().map(|place| place[axis]));
            column.resize(positions.len() + 3, 0.0);
        }
        let count = positions.len();
        self.chunks.resize_with(count.div_ceil(CHUNK as usize), Chunk::default);
        self.sums.clear();
        self.sums.resize(count, [0.0; 4]);
        let (chunks, sums) = (DisjointSlice::new(&mut self.chunks), DisjointSlice::new(&mut self.sums));
        let (grid, positions, columns) = (&self.grid, &self.positions, &self.columns);
        pool.parallel_for(count.div_ceil(CHUNK as usize), |task| {
            let range = chunk_range(task, count);
            // SAFETY: chunks do not overlap.
            #[allow(unsafe_code)]
            let (chunk, sums) =
                unsafe { (&mut chunks.run(task as u32..task as u32 + 1)[0], sums.run(range.clone())) };
            chunk.find(grid, (positions, columns), range.clone(), sums);
            chunk.find_walls(walls, &positions[range.start as usize..range.end as usize], sums);
        });
    }

    /// The pairs of a particle: the `k`th of a chunk.
    #[inline(always)]
    pub fn of(&self, chunk: usize, k: usize) -> &[Pair] {
        &self.chunks[chunk].pairs[self.range(chunk, k)]
    }

    /// Where these are among the pairs of the chunk.
    #[inline(always)]
    pub fn range(&self, chunk: usize, k: usize) -> Range<usize> {
        let ends = &self.chunks[chunk].ends;
        let first = if k == 0 { 0 } else { ends[k - 1] };
        first as usize..ends[k] as usize
    }

    /// The pairs of a particle with walls that can move.
    #[inline(always)]
    pub fn walls_of(&self, chunk: usize, k: usize) -> &[Pair] {
        let chunk = &self.chunks[chunk];
        let first = if k == 0 { 0 } else { chunk.wall_ends[k - 1] };
        &chunk.wall_pairs[first as usize..chunk.wall_ends[k] as usize]
    }

    /// A value of each particle, with its pairs with walls that can move.
    pub fn pushes<'p>(&'p self, values: &'p [f32]) -> impl Iterator<Item = (f32, &'p [Pair])> {
        let chunk = CHUNK as usize;
        values.iter().enumerate().map(move |(at, &value)| (value, self.walls_of(at / chunk, at % chunk)))
    }

    /// The number of particles.
    pub fn len(&self) -> usize {
        self.positions.len()
    }

    /// The sum of the gradients of a particle.
    #[inline(always)]
    pub fn sum(&self, particle: usize) -> [f32; 3] {
        let [_, x, y, z] = self.sums[particle];
        [x, y, z]
    }
}

impl Chunk {
    fn find(
        &mut self,
        grid: &CellGrid,
        (positions, columns): (&[[f32; 4]], &[Vec<f32>; 3]),
        range: Range<u32>,
        sums: &mut [[f32; 4]],
    ) {
        self.pairs.clear();
        self.ends.clear();
        for (at, out) in range.zip(sums) {
            let [x, y, z, _] = positions[at as usize];
            let near = self.find_near(grid, columns, [x, y, z]);
            let mut sum = [weight(0.0), 0.0, 0.0, 0.0];
            let others = self.near[..near].iter().filter(|&&other| other != at);
            self.pairs.extend(others.map(|&other| {
                let place = positions[other as usize];
                let apart = [x - place[0], y - place[1], z - place[2]];
                let distance = (apart[0] * apart[0] + apart[1] * apart[1] + apart[2] * apart[2]).sqrt();
                // Two particles in one place have no direction: they part along that of the others.
                let scale = if distance > 1e-6 { slope(distance) / distance } else { 0.0 };
                let gradient = [apart[0] * scale, apart[1] * scale, apart[2] * scale];
                sum[0] += weight(distance);
                (0..3).for_each(|axis| sum[axis + 1] += gradient[axis]);
                Pair { gradient, other }
            }));
            self.ends.push(self.pairs.len() as u32);
            *out = sum;
        }
    }

    /// Lists the particles within reach of a place, four at a time. Returns their number.
    fn find_near(&mut self, grid: &CellGrid, columns: &[Vec<f32>; 3], place: [f32; 3]) -> usize {
        let (at, reach) = (place.map(Four::splat), Four::splat(REACH * REACH));
        let mut near = 0;
        for run in grid.runs(place) {
            // Four are written at a time, and those that are too far overwritten: this needs no branch.
            if self.near.len() < near + run.len() + 4 {
                self.near.resize(near + run.len() + 4, 0);
            }
            for first in run.clone().step_by(4) {
                let apart = |axis: usize| at[axis] - four(&columns[axis], first);
                let [x, y, z] = [apart(0), apart(1), apart(2)];
                let within = (reach - (x * x + y * y + z * z)).above_zero();
                let mask = within & (0xf >> 4usize.saturating_sub(run.end - first));
                let lanes = &LANES[mask as usize];
                for (slot, lane) in self.near[near..near + 4].iter_mut().zip(lanes) {
                    *slot = first as u32 + lane;
                }
                near += COUNTS[mask as usize];
            }
        }
        near
    }

    fn find_walls(&mut self, walls: &Walls, positions: &[[f32; 4]], sums: &mut [[f32; 4]]) {
        self.wall_pairs.clear();
        self.wall_ends.clear();
        for ([x, y, z, _], sum) in positions.iter().zip(sums) {
            walls.near([*x, *y, *z], |density, gradient, sample| {
                sum[0] += density;
                (0..3).for_each(|axis| sum[axis + 1] += gradient[axis]);
                self.wall_pairs.extend(sample.map(|other| Pair { gradient, other }));
            });
            self.wall_ends.push(self.wall_pairs.len() as u32);
        }
    }
}

/// Four numbers of a column from a place on.
#[inline(always)]
fn four(column: &[f32], first: usize) -> Four {
    let four = &column[first..first + 4];
    Four::from_array([four[0], four[1], four[2], four[3]])
}
