//! Neighbour lists of the predicted positions, with the gradients of all pairs.

use std::ops::Range;

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
    /// Candidates of one particle.
    near: Vec<Near>,
}

/// A candidate: from it to the particle, the squared length of that, and its place in the sorted order.
#[derive(Debug, Clone, Copy, Default)]
struct Near {
    apart: [f32; 3],
    square: f32,
    other: u32,
}

/// The neighbours of all particles; lengths in rest distances.
#[derive(Debug, Default)]
pub struct Neighbours {
    /// Particles by cell.
    pub grid: CellGrid,
    /// Positions in the sorted order.
    pub positions: Vec<[f32; 4]>,
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
        let count = positions.len();
        self.chunks.resize_with(count.div_ceil(CHUNK as usize), Chunk::default);
        self.sums.clear();
        self.sums.resize(count, [0.0; 4]);
        let (chunks, sums) = (DisjointSlice::new(&mut self.chunks), DisjointSlice::new(&mut self.sums));
        let (grid, positions) = (&self.grid, &self.positions);
        pool.parallel_for(count.div_ceil(CHUNK as usize), |task| {
            let range = chunk_range(task, count);
            // SAFETY: chunks do not overlap.
            #[allow(unsafe_code)]
            let (chunk, sums) =
                unsafe { (&mut chunks.run(task as u32..task as u32 + 1)[0], sums.run(range.clone())) };
            chunk.find(grid, positions, range.clone(), sums);
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
    fn find(&mut self, grid: &CellGrid, positions: &[[f32; 4]], range: Range<u32>, sums: &mut [[f32; 4]]) {
        self.pairs.clear();
        self.ends.clear();
        for (at, out) in range.zip(sums) {
            let [x, y, z, _] = positions[at as usize];
            // Candidates are written all, and those that are too far overwritten: this needs no branch.
            let mut near = 0;
            for run in grid.runs([x, y, z]) {
                if self.near.len() < near + run.len() {
                    self.near.resize(near + run.len(), Near::default());
                }
                for (other, place) in (run.start as u32..).zip(&positions[run]) {
                    let apart = [x - place[0], y - place[1], z - place[2]];
                    let square = apart[0] * apart[0] + apart[1] * apart[1] + apart[2] * apart[2];
                    self.near[near] = Near { apart, square, other };
                    near += usize::from((square < REACH * REACH) & (other != at));
                }
            }
            let mut sum = [weight(0.0), 0.0, 0.0, 0.0];
            self.pairs.extend(self.near[..near].iter().map(|&Near { apart, square, other }| {
                let distance = square.sqrt();
                // Two particles in one place have no direction: they part along that of the others.
                let scale = if distance > 1e-6 { slope(distance) / distance } else { 0.0 };
                let gradient = apart.map(|x| x * scale);
                sum[0] += weight(distance);
                (0..3).for_each(|axis| sum[axis + 1] += gradient[axis]);
                Pair { gradient, other }
            }));
            self.ends.push(self.pairs.len() as u32);
            *out = sum;
        }
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
