//! Neighbour lists of the predicted positions, with the gradients of all pairs.

use std::ops::Range;

use crate::math::Lanes;
use crate::math::kernel::{self, KernelOfEight};
use crate::parallel::disjoint::DisjointSlice;
use crate::parallel::thread_pool::ThreadPool;

use super::grid::CellGrid;
use super::kernel::{REACH, weight};
use super::near::{Sorted, Surroundings, far_position, fill_columns};
use super::pair::Pair;
use super::walls::{NearWalls, Walls};

/// Particles of a task.
pub const CHUNK: u32 = 256;

/// The pairs of some particles that follow each other.
#[derive(Debug, Default)]
pub struct Chunk {
    pairs: Vec<Pair>,
    /// End of each particle's pairs.
    ends: Vec<u32>,
    walls: NearWalls,
    surroundings: Surroundings,
}

/// The neighbours of all particles; lengths in rest distances.
#[derive(Debug, Default)]
pub struct Neighbours {
    /// Particles by cell.
    pub grid: CellGrid,
    /// Positions in the sorted order; the fourth is the tag of the particle's own number. One more is far from all.
    pub positions: Vec<[f32; 4]>,
    /// The same by axis, with seven more.
    columns: [Vec<f32>; 3],
    /// Pairs by task.
    pub chunks: Vec<Chunk>,
    /// Density of each particle, and the sum of the gradients of its pairs and walls.
    pub sums: Vec<[f32; 4]>,
    /// The sum of the squared gradients of its pairs.
    pub squares: Vec<f32>,
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
        self.positions.extend(self.grid.order().iter().zip(0..).map(|(&particle, at)| {
            let [x, y, z] = positions[particle as usize];
            [x, y, z, Pair::tag(at)]
        }));
        fill_columns(&mut self.columns, self.positions.iter().map(|&[x, y, z, _]| [x, y, z]));
        self.positions.push(far_position());
        let count = positions.len();
        self.chunks.resize_with(count.div_ceil(CHUNK as usize), Chunk::default);
        self.sums.resize(count, [0.0; 4]);
        self.squares.resize(count, 0.0);
        let (chunks, sums) = (DisjointSlice::new(&mut self.chunks), DisjointSlice::new(&mut self.sums));
        let squares = DisjointSlice::new(&mut self.squares);
        let positions = &self.positions[..];
        let sorted = Sorted { grid: &self.grid, positions, columns: &self.columns };
        pool.parallel_for(count.div_ceil(CHUNK as usize), |task| {
            let range = chunk_range(task, count);
            // SAFETY: chunks do not overlap.
            #[allow(unsafe_code)]
            let (chunk, sums, squares) = unsafe {
                let chunk = &mut chunks.run(task as u32..task as u32 + 1)[0];
                (chunk, sums.run(range.clone()), squares.run(range.clone()))
            };
            chunk.find(sorted, range.clone(), (sums, squares));
            chunk.walls.find(walls, &positions[range.start as usize..range.end as usize], sums);
        });
    }

    /// The pairs of a particle: the `k`th of a chunk. Their number is a multiple of four.
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

    /// The end of the pairs of each particle of a chunk.
    pub fn ends(&self, chunk: usize) -> &[u32] {
        &self.chunks[chunk].ends
    }

    /// The pairs of a particle with walls that can move.
    #[inline(always)]
    pub fn walls_of(&self, chunk: usize, k: usize) -> &[Pair] {
        self.chunks[chunk].walls.pairs_of(k)
    }

    /// A value of each particle, with its pairs with walls that can move.
    pub fn pushes<'p>(&'p self, values: &'p [f32]) -> impl Iterator<Item = (f32, &'p [Pair])> {
        let chunk = CHUNK as usize;
        values.iter().enumerate().map(move |(at, &value)| (value, self.walls_of(at / chunk, at % chunk)))
    }

    /// The number of particles.
    pub fn len(&self) -> usize {
        self.sums.len()
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
        sorted: Sorted<'_>,
        range: Range<u32>,
        (sums, squares): (&mut [[f32; 4]], &mut [f32]),
    ) {
        self.pairs.clear();
        self.ends.clear();
        self.surroundings.clear();
        // SAFETY: the search has no condition.
        #[allow(unsafe_code)]
        unsafe {
            kernel::run(FindPairs { chunk: self, sorted, range, sums, squares });
        }
    }

    /// For every particle of the chunk, the sum over its pairs of the gradient times what belongs to the neighbour, axis by
    /// axis.
    #[inline(always)]
    pub fn sum_pairs(&self, of: impl Fn(usize) -> [f32; 4], out: &mut [[f32; 4]]) {
        // SAFETY: the sum has no condition.
        #[allow(unsafe_code)]
        unsafe {
            kernel::run(SumPairs { chunk: self, of, out });
        }
    }
}

/// The search for the pairs of a chunk.
struct FindPairs<'a> {
    chunk: &'a mut Chunk,
    sorted: Sorted<'a>,
    range: Range<u32>,
    sums: &'a mut [[f32; 4]],
    squares: &'a mut [f32],
}

impl KernelOfEight<f32> for FindPairs<'_> {
    /// # Safety
    /// The machine has the lanes.
    #[inline(always)]
    #[allow(unsafe_code)]
    unsafe fn run_eight<W: Lanes<f32, Array = [[f32; 4]; 2]>>(self) {
        let Self { chunk, sorted, range, sums, squares } = self;
        for (at, (out, square)) in range.zip(sums.iter_mut().zip(squares)) {
            let found = chunk.surroundings.find::<W>(sorted, at, &mut chunk.pairs);
            chunk.ends.push(chunk.pairs.len() as u32);
            *out = found.density;
            out[0] += weight(0.0);
            *square = found.squares;
        }
    }
}

/// Sums over the pairs of a chunk.
struct SumPairs<'a, F> {
    chunk: &'a Chunk,
    of: F,
    out: &'a mut [[f32; 4]],
}

impl<F: Fn(usize) -> [f32; 4]> KernelOfEight<f32> for SumPairs<'_, F> {
    /// # Safety
    /// The machine has the lanes.
    #[inline(always)]
    #[allow(unsafe_code)]
    unsafe fn run_eight<W: Lanes<f32, Array = [[f32; 4]; 2]>>(self) {
        let Self { chunk, of, out } = self;
        let mut first = 0;
        for (&end, out) in chunk.ends.iter().zip(out) {
            let (fours, rest) = chunk.pairs[first..end as usize].as_chunks::<4>();
            debug_assert!(rest.is_empty(), "pairs are a multiple of four");
            first = end as usize;
            // Two sums of two pairs at once: each addition would wait for the one before.
            let mut sums = [W::splat(0.0); 2];
            for [a, b, c, d] in fours {
                let term = |[a, b]: [&Pair; 2]| {
                    W::from_array([a.row(), b.row()]) * W::from_array([of(a.other()), of(b.other())])
                };
                sums = [sums[0] + term([a, b]), sums[1] + term([c, d])];
            }
            let ([a, b], [c, d]) = (sums[0].to_array(), sums[1].to_array());
            for axis in 0..4 {
                out[axis] = (a[axis] + b[axis]) + (c[axis] + d[axis]);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::grid::tests::spread;
    use super::*;
    use crate::math::{Real, Two};

    type Four = Two<<f32 as Real>::Lanes>;

    /// Places without a pattern in a box, two of them equal.
    fn scattered(count: usize, size: f32) -> Vec<[f32; 3]> {
        let mut places = spread(count, size);
        places[count - 1] = places[0];
        places
    }

    fn found(positions: &[[f32; 3]]) -> Neighbours {
        let mut neighbours = Neighbours::default();
        neighbours.find(positions, &Walls::default(), &ThreadPool::new(1));
        neighbours
    }

    #[test]
    fn pairs_and_densities_are_those_of_all_particles_within_reach() {
        for (count, size) in [(2, 0.1), (700, 5.0), (300, 40.0), (300, 1e5)] {
            let neighbours = found(&scattered(count, size));
            for (at, place) in neighbours.positions[..count].iter().enumerate() {
                let distance = |other: usize| {
                    let other = neighbours.positions[other];
                    (0..3).map(|k| (place[k] - other[k]).powi(2)).sum::<f32>().sqrt()
                };
                let all = neighbours.of(at / CHUNK as usize, at % CHUNK as usize);
                assert_eq!(all.len() % 4, 0);
                assert!(all.iter().flat_map(Pair::row).all(f32::is_finite));
                let mut others: Vec<_> = all.iter().map(Pair::other).filter(|&other| other != at).collect();
                others.sort_unstable();
                let near = |other: &usize| *other != at && distance(*other) < REACH;
                assert_eq!(others, (0..count).filter(near).collect::<Vec<_>>(), "{at} of {count} in {size}");
                let density = weight(0.0) + others.iter().map(|&other| weight(distance(other))).sum::<f32>();
                assert!((neighbours.sums[at][0] / density - 1.0).abs() < 1e-4, "{at} of {count} in {size}");
            }
        }
    }

    #[test]
    fn eight_lanes_give_the_bits_of_four() {
        let neighbours = found(&scattered(700, 5.0));
        let (positions, columns) = (&neighbours.positions[..], &neighbours.columns);
        let sorted = Sorted { grid: &neighbours.grid, positions, columns };
        let mut chunk = Chunk::default();
        let (mut sums, mut squares) = (vec![[0.0; 4]; 256], vec![0.0; 256]);
        let find =
            FindPairs { chunk: &mut chunk, sorted, range: 256..512, sums: &mut sums, squares: &mut squares };
        // SAFETY: every machine has four lanes.
        #[allow(unsafe_code)]
        unsafe {
            find.run_eight::<Four>();
        }
        assert_eq!((&sums[..], &squares[..]), (&neighbours.sums[256..512], &neighbours.squares[256..512]));
        let [mut four, mut eight] = [vec![[0.0; 4]; 256], vec![[0.0; 4]; 256]];
        let sum = SumPairs { chunk: &chunk, of: |other: usize| positions[other], out: &mut four };
        // SAFETY: every machine has four lanes.
        #[allow(unsafe_code)]
        unsafe {
            sum.run_eight::<Four>();
        }
        neighbours.chunks[1].sum_pairs(|other| positions[other], &mut eight);
        assert!(four.iter().zip(&eight).all(|(a, b)| a[..3] == b[..3]));
    }
}
