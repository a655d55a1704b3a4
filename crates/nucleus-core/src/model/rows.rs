//! Lists of rows, laid out to be swept: by block, by colour, four at a time.
//!
//! Points are cut into blocks of about a thousand, small enough for a core's nearest cache. Rows whose points
//! all lie in one block are that block's *interior* rows, swept by one task; the others are *interface* rows, swept
//! after them colour by colour. Inside a block rows are in colour order too: rows of one colour share no
//! point, so four can be computed side by side. A fixed coloured order is also what keeps a single sweep per
//! time step from creating energy; the order of indices does not.

use std::ops::Range;

/// Points per block, about.
const BLOCK: usize = 1024;
/// Lane groups that a task of interface rows sweeps.
const CHUNK: u32 = 32;

/// The blocks of one cloth: runs of the solver's points.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Blocks {
    first: u32,
    points: u32,
    count: u32,
}

impl Blocks {
    /// Cuts the points from `first` on into blocks.
    pub fn new(first: u32, points: usize) -> Self {
        Self { first, points: points as u32, count: (points / BLOCK).max(1) as u32 }
    }

    /// How many.
    pub fn len(&self) -> usize {
        self.count as usize
    }

    /// The points of a block.
    pub fn range(&self, block: usize) -> Range<u32> {
        let cut = |block: u64| self.first + (u64::from(self.points) * block / u64::from(self.count)) as u32;
        cut(block as u64)..cut(block as u64 + 1)
    }

    /// The block a point lies in.
    pub fn of(&self, point: u32) -> u32 {
        let at = u64::from(point - self.first);
        // The inverse of the cut above, exact for every point.
        (((at + 1) * u64::from(self.count) - 1) / u64::from(self.points)) as u32
    }

    /// A point of no mass that stands in for missing rows of a lane group: one per block, and one (`block` =
    /// `len()`) for interface rows. It is never moved, and no two tasks of a phase share it.
    pub fn stand_in(&self, block: usize) -> u32 {
        self.first + self.points + block as u32
    }

    /// Points and stand-ins together.
    pub fn columns(&self) -> u32 {
        self.points + self.count + 1
    }
}

/// A row before it is laid out: the points it joins decide where it goes.
pub trait Row: Copy {
    /// Four of them side by side.
    type Group;
    /// How many points a row joins.
    const POINTS: usize;
    /// The `k`th of its points.
    fn point(&self, k: usize) -> u32;
    /// A row that joins only `stand_in` and does nothing.
    fn idle(stand_in: u32) -> Self;
    /// Four side by side.
    fn group(rows: [Self; 4]) -> Self::Group;
}

/// A list of rows of one kind and one cloth, ready to be swept.
#[derive(Debug, Clone)]
pub struct RowList<G> {
    groups: Vec<G>,
    interior: Vec<Range<u32>>,
    interface: Vec<Range<u32>>,
    rows: usize,
}

/// Rows that are swept by one task.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RowBatch {
    /// The interior rows of a block.
    Interior(usize),
    /// The interface rows of a colour, and which task of it.
    Interface(usize, usize),
}

impl<G> Default for RowList<G> {
    fn default() -> Self {
        Self { groups: Vec::new(), interior: Vec::new(), interface: Vec::new(), rows: 0 }
    }
}

impl<G> RowList<G> {
    /// Lays out rows. Their order within a colour is the given one.
    pub fn new<T: Row<Group = G>>(rows: &[T], blocks: &Blocks) -> Self {
        let mut list = Self { rows: rows.len(), ..Self::default() };
        if rows.is_empty() {
            return list;
        }
        let mut by_block: Vec<Vec<T>> = (0..blocks.len()).map(|_| Vec::new()).collect();
        let mut interface = Vec::new();
        for row in rows {
            let block = blocks.of(row.point(0));
            let inside = (1..T::POINTS).all(|k| blocks.of(row.point(k)) == block);
            if inside { by_block[block as usize].push(*row) } else { interface.push(*row) }
        }
        let mut colours = Colours::new(blocks);
        for (block, rows) in by_block.into_iter().enumerate() {
            let start = list.groups.len() as u32;
            colours.sort(rows).for_each(|of_colour| list.push_groups(&of_colour, blocks.stand_in(block)));
            list.interior.push(start..list.groups.len() as u32);
        }
        for of_colour in colours.sort(interface) {
            let start = list.groups.len() as u32;
            list.push_groups(&of_colour, blocks.stand_in(blocks.len()));
            list.interface.push(start..list.groups.len() as u32);
        }
        list.groups.shrink_to_fit();
        list
    }

    fn push_groups<T: Row<Group = G>>(&mut self, rows: &[T], stand_in: u32) {
        for four in rows.chunks(4) {
            let row = |k: usize| four.get(k).copied().unwrap_or_else(|| T::idle(stand_in));
            self.groups.push(T::group([row(0), row(1), row(2), row(3)]));
        }
    }

    /// Rows, stand-ins not counted.
    pub fn len(&self) -> usize {
        self.rows
    }

    /// All lane groups.
    pub fn groups(&self) -> &[G] {
        &self.groups
    }

    /// All lane groups, to be refreshed.
    pub fn groups_mut(&mut self) -> &mut [G] {
        &mut self.groups
    }

    /// The interior rows of a block. Nothing for a list without rows.
    pub fn interior(&self, block: usize) -> &[G] {
        self.interior.get(block).map_or(&[], |range| &self.groups[range.start as usize..range.end as usize])
    }

    /// How many colours the interface rows have.
    pub fn interface_colours(&self) -> usize {
        self.interface.len()
    }

    /// How many tasks the interface rows of a colour are.
    pub fn interface_tasks(&self, colour: usize) -> usize {
        self.interface[colour].len().div_ceil(CHUNK as usize)
    }

    /// The rows of a task. Nothing for a list without rows.
    pub fn part(&self, part: RowBatch) -> &[G] {
        match part {
            RowBatch::Interior(block) => self.interior(block),
            RowBatch::Interface(..) if self.rows == 0 => &[],
            RowBatch::Interface(colour, task) => self.interface(colour, task),
        }
    }

    /// The interface rows of one task.
    pub fn interface(&self, colour: usize, task: usize) -> &[G] {
        let Range { start, end } = self.interface[colour].clone();
        let from = start + task as u32 * CHUNK;
        &self.groups[from as usize..end.min(from + CHUNK) as usize]
    }
}

/// Gives each row the lowest colour that none of its points has had.
struct Colours {
    first: u32,
    /// Colours taken, per point, 64 at a time.
    taken: Vec<u64>,
}

impl Colours {
    fn new(blocks: &Blocks) -> Self {
        Self { first: blocks.first, taken: vec![0; blocks.points as usize] }
    }

    /// The rows by colour. A fan of many rows round one point needs as many colours as it has rows: they are
    /// given out 64 at a time.
    fn sort<T: Row>(&mut self, rows: Vec<T>) -> std::vec::IntoIter<Vec<T>> {
        let mut colours: Vec<Vec<T>> = Vec::new();
        let mut left = rows;
        while !left.is_empty() {
            let base = colours.len();
            for row in &left {
                (0..T::POINTS).for_each(|k| self.taken[(row.point(k) - self.first) as usize] = 0);
            }
            let mut later = Vec::new();
            for row in left {
                let points = (0..T::POINTS).map(|k| (row.point(k) - self.first) as usize);
                let taken = points.clone().fold(0, |taken, point| taken | self.taken[point]);
                let colour = taken.trailing_ones() as usize;
                if colour == 64 {
                    later.push(row);
                    continue;
                }
                points.for_each(|point| self.taken[point] |= 1 << colour);
                if colours.len() <= base + colour {
                    colours.resize_with(base + colour + 1, Vec::new);
                }
                colours[base + colour].push(row);
            }
            left = later;
        }
        colours.into_iter()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use std::collections::HashSet;

    #[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
    struct Pair(u32, u32);

    impl Row for Pair {
        type Group = [Pair; 4];
        const POINTS: usize = 2;
        fn point(&self, k: usize) -> u32 {
            if k == 0 { self.0 } else { self.1 }
        }
        fn idle(stand_in: u32) -> Self {
            Pair(stand_in, stand_in)
        }
        fn group(rows: [Self; 4]) -> [Pair; 4] {
            rows
        }
    }

    fn pairs() -> impl Strategy<Value = (usize, Vec<Pair>)> {
        (2usize..5000).prop_flat_map(|points| {
            let end = 0..points as u32;
            let pair =
                (end.clone(), end).prop_filter_map("one point", |(a, b)| (a != b).then_some(Pair(a, b)));
            (Just(points), proptest::collection::vec(pair, 0..400))
        })
    }

    fn shares_a_point(groups: &[[Pair; 4]], real: u32) -> bool {
        let points = groups.iter().flatten().filter(|pair| pair.0 < real);
        let mut seen = HashSet::new();
        points.flat_map(|pair| [pair.0, pair.1]).any(|point| !seen.insert(point))
    }

    proptest! {
        #[test]
        fn every_point_lies_in_the_block_that_says_so(points in 1usize..10_000, first in 0u32..100) {
            let blocks = Blocks::new(first, points);
            for block in 0..blocks.len() {
                prop_assert!(blocks.range(block).all(|point| blocks.of(point) == block as u32));
            }
        }

        // EVIDENCE: N2.2-7  rows side by side share no point, and none is lost
        #[test]
        fn rows_swept_side_by_side_share_no_point((points, rows) in pairs()) {
            let blocks = Blocks::new(0, points);
            let list = RowList::new(&rows, &blocks);
            for colour in 0..list.interface_colours() {
                let of_colour: Vec<_> = (0..list.interface_tasks(colour)).flat_map(|t| list.interface(colour, t)).copied().collect();
                prop_assert!(!shares_a_point(&of_colour, points as u32));
            }
            for block in 0..blocks.len() {
                prop_assert!(list.interior(block).iter().all(|group| !shares_a_point(&[*group], points as u32)));
                prop_assert!(list.interior(block).iter().flatten().filter(|p| p.0 < points as u32)
                    .all(|p| blocks.of(p.0) == block as u32 && blocks.of(p.1) == block as u32));
            }
            let mut kept: Vec<_> = list.groups().iter().flatten().filter(|p| p.0 < points as u32).map(|p| (p.0, p.1)).collect();
            let mut given: Vec<_> = rows.iter().map(|p| (p.0, p.1)).collect();
            kept.sort_unstable();
            given.sort_unstable();
            prop_assert_eq!(kept, given);
        }
    }
}
