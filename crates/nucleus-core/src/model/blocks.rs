//! Blocks of a cloth's points: about a thousand each, small enough for a core's nearest cache. One task sweeps a block.

use std::ops::Range;

use crate::model::surface::Surface;

/// Points per block, about.
const POINTS_PER_BLOCK: usize = 1024;
/// Points above which a cloth has at least two blocks.
const MIN_SHARED_POINTS: usize = 512;

/// The blocks of one cloth: runs of rows in the columns.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Blocks {
    first: u32,
    /// Points in use, and the blocks that they are cut into.
    points: u32,
    count: u32,
    /// Points of the capacity, and the blocks of as many.
    capacity: u32,
    max_count: u32,
}

impl Blocks {
    /// Cuts the points from `first` on into blocks.
    pub fn new(first: u32, points: usize) -> Self {
        let (points, count) = (points as u32, block_count(points));
        Self { first, points, count, capacity: points, max_count: count }
    }

    /// With all points of the capacity.
    fn filled(self) -> Self {
        Self { points: self.capacity, count: self.max_count, ..self }
    }

    /// Cuts only the first `points` into blocks; the rows behind them stay unused.
    pub fn resize(&mut self, points: usize) {
        debug_assert!(points as u32 <= self.capacity, "{points} of {}", self.capacity);
        (self.points, self.count) = (points as u32, block_count(points));
    }

    /// The rows of all points of the capacity.
    pub fn rows(&self) -> Range<u32> {
        self.first..self.first + self.capacity
    }

    /// The largest number of blocks.
    pub fn max_len(&self) -> usize {
        self.max_count as usize
    }

    /// The number of blocks.
    pub fn len(&self) -> usize {
        self.count as usize
    }

    /// The points of a block.
    pub fn range(&self, block: usize) -> Range<u32> {
        let cut = |block: u64| self.first + (u64::from(self.points) * block / u64::from(self.count)) as u32;
        cut(block as u64)..cut(block as u64 + 1)
    }

    /// The block of a point.
    pub fn of(&self, point: u32) -> u32 {
        let at = u64::from(point - self.first);
        // The inverse of the cut above, exact for every point.
        (((at + 1) * u64::from(self.count) - 1) / u64::from(self.points)) as u32
    }

    /// A padding point without mass, for missing rows of a lane group: one per block, and one (`block` = `len()`) for
    /// interface rows. It never moves, and no two tasks of a loop share it.
    pub fn padding_point(&self, block: usize) -> u32 {
        self.first + self.capacity + block as u32
    }

    /// The number of rows: one per point of the capacity, and the padding points.
    pub fn row_count(&self) -> u32 {
        self.capacity + self.max_count + 1
    }

    /// The row behind the last.
    pub fn end(&self) -> u32 {
        self.first + self.row_count()
    }
}

/// A division of rows of the columns into blocks, each swept by one task.
pub trait Partition {
    /// The number of blocks.
    fn len(&self) -> usize;
    /// The block of a point.
    fn of(&self, point: u32) -> u32;
    /// A padding point without mass for a block, or (`block` = `len()`) for interface rows; see
    /// [`Blocks::padding_point`].
    fn padding_point(&self, block: usize) -> u32;
    /// All rows, padding among them.
    fn span(&self) -> Range<u32>;
}

impl Partition for Blocks {
    fn len(&self) -> usize {
        self.len()
    }
    fn of(&self, point: u32) -> u32 {
        self.of(point)
    }
    fn padding_point(&self, block: usize) -> u32 {
        self.padding_point(block)
    }
    fn span(&self) -> Range<u32> {
        self.rows()
    }
}

/// The blocks of several cloths, whose rows follow each other in the columns.
#[derive(Debug, Clone, Default)]
pub struct AllBlocks {
    cloths: Vec<Blocks>,
    /// Number of blocks before each cloth.
    before: Vec<usize>,
}

impl AllBlocks {
    /// The blocks of these cloths with all points of the capacity, counted through: particles that are not born yet
    /// can have rows too.
    pub fn new(cloths: impl Iterator<Item = Blocks>) -> Self {
        let cloths: Vec<Blocks> = cloths.map(Blocks::filled).collect();
        let count = |sum: &mut usize, blocks: &Blocks| Some(std::mem::replace(sum, *sum + blocks.len()));
        let before = cloths.iter().scan(0, count).collect();
        Self { cloths, before }
    }
}

impl Partition for AllBlocks {
    fn len(&self) -> usize {
        self.before.last().zip(self.cloths.last()).map_or(0, |(before, last)| before + last.len())
    }
    fn of(&self, point: u32) -> u32 {
        let cloth = self.cloths.partition_point(|blocks| blocks.first <= point) - 1;
        self.before[cloth] as u32 + self.cloths[cloth].of(point)
    }
    fn padding_point(&self, block: usize) -> u32 {
        let cloth = self.before.partition_point(|&before| before <= block) - 1;
        self.cloths[cloth].padding_point(block - self.before[cloth])
    }
    fn span(&self) -> Range<u32> {
        0..self.cloths.last().map_or(0, Blocks::end)
    }
}

fn block_count(points: usize) -> u32 {
    // Two threads share a cloth that is smaller than two blocks, unless the loops would be longer than their work.
    let least = points.div_ceil(MIN_SHARED_POINTS).clamp(1, 2);
    (points / POINTS_PER_BLOCK).max(least) as u32
}

/// The triangles of each block: all with a point in it, so that the normals of a block need no other block.
pub fn triangles_by_block(
    surface: &Surface,
    place: impl Fn(u32) -> u32,
    blocks: &Blocks,
) -> Vec<Vec<[u32; 3]>> {
    let mut by_block = vec![Vec::new(); blocks.max_len()];
    for triangle in surface.faces.triangles() {
        let triangle = triangle.map(&place);
        let [a, b, c] = triangle.map(|point| blocks.of(point));
        by_block[a as usize].push(triangle);
        if b != a {
            by_block[b as usize].push(triangle);
        }
        if c != a && c != b {
            by_block[c as usize].push(triangle);
        }
    }
    for triangles in &mut by_block {
        triangles.sort_unstable();
        triangles.shrink_to_fit();
    }
    by_block
}
