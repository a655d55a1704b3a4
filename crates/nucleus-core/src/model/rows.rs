//! Lists of constraint rows, laid out for parallel Gauss-Seidel sweeps: by block, by colour, four at a time.
//!
//! Points are cut into blocks of about a thousand, small enough for a core's nearest cache. A row whose points are all
//! in one block is an *interior* row of that block, swept by one task. The others are *interface* rows, swept after
//! them colour by colour. Inside a block rows are in colour order too: rows of one colour share no point, so four of
//! them are computed side by side. A fixed coloured order also keeps a single sweep per time step from creating energy;
//! the order of indices does not.

use std::ops::Range;

use crate::model::blocks::Partition;

/// Lane groups per task of interface rows; a multiple of [`Row::GROUPS`].
const GROUPS_PER_TASK: u32 = 32;

/// A row before it is laid out; its points determine its block and colour.
pub trait Row: Copy {
    /// Four rows side by side.
    type Group;
    /// Points per row.
    const POINTS: usize;
    /// Groups that are swept side by side: each colour has a multiple of them, so that they share no point.
    const GROUPS: usize = 1;
    /// The `k`th point.
    fn point(&self, k: usize) -> u32;
    /// A row of the padding point only, which does nothing.
    fn idle(padding_point: u32) -> Self;
    /// Puts four rows side by side.
    fn group(rows: [Self; 4]) -> Self::Group;
}

/// The rows of one kind in one cloth, laid out in lane groups.
#[derive(Debug, Clone)]
pub struct RowList<G> {
    groups: Vec<G>,
    interior: Vec<Range<u32>>,
    interface: Vec<Range<u32>>,
    rows: usize,
}

/// The rows that one task sweeps.
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
    /// Lays out rows; within a colour they keep their order.
    pub fn new<T: Row<Group = G>>(rows: &[T], blocks: &impl Partition) -> Self {
        Self::in_levels(rows, &[], blocks)
    }

    /// Lays out rows level by level, each of which is coloured for itself: in a block, and among the interface rows,
    /// rows of a lower level come first. `levels` has one entry per row, or is empty for a single level.
    pub fn in_levels<T: Row<Group = G>>(rows: &[T], levels: &[u32], blocks: &impl Partition) -> Self {
        let mut list = Self { rows: rows.len(), ..Self::default() };
        if rows.is_empty() {
            return list;
        }
        let mut by_block: Vec<Vec<(u32, T)>> = (0..blocks.len()).map(|_| Vec::new()).collect();
        let mut interface = Vec::new();
        for (k, row) in rows.iter().enumerate() {
            let levelled = (levels.get(k).copied().unwrap_or(0), *row);
            let block = blocks.of(row.point(0));
            let inside = (1..T::POINTS).all(|k| blocks.of(row.point(k)) == block);
            if inside { by_block[block as usize].push(levelled) } else { interface.push(levelled) }
        }
        let mut colours = Colours::new(blocks);
        for (block, rows) in by_block.into_iter().enumerate() {
            let start = list.groups.len() as u32;
            for of_colour in colours.sort_levels(rows) {
                list.push_groups(&of_colour, blocks.padding_point(block));
            }
            list.interior.push(start..list.groups.len() as u32);
        }
        for of_colour in colours.sort_levels(interface) {
            let start = list.groups.len() as u32;
            list.push_groups(&of_colour, blocks.padding_point(blocks.len()));
            list.interface.push(start..list.groups.len() as u32);
        }
        list.groups.shrink_to_fit();
        list
    }

    fn push_groups<T: Row<Group = G>>(&mut self, rows: &[T], padding_point: u32) {
        let idle = T::idle(padding_point);
        for side_by_side in rows.chunks(4 * T::GROUPS) {
            let row = |k: usize| side_by_side.get(k).copied().unwrap_or(idle);
            let group = |k: usize| T::group([row(4 * k), row(4 * k + 1), row(4 * k + 2), row(4 * k + 3)]);
            self.groups.extend((0..T::GROUPS).map(group));
        }
    }

    /// The number of rows, without padding.
    pub fn len(&self) -> usize {
        self.rows
    }

    /// All lane groups.
    pub fn groups(&self) -> &[G] {
        &self.groups
    }

    /// All lane groups, to be updated.
    pub fn groups_mut(&mut self) -> &mut [G] {
        &mut self.groups
    }

    /// The interior rows of a block; empty for a list without rows.
    pub fn interior(&self, block: usize) -> &[G] {
        self.interior.get(block).map_or(&[], |range| &self.groups[range.start as usize..range.end as usize])
    }

    /// The number of colours of the interface rows.
    pub fn interface_colours(&self) -> usize {
        self.interface.len()
    }

    /// The number of tasks for the interface rows of a colour.
    pub fn interface_tasks(&self, colour: usize) -> usize {
        self.interface[colour].len().div_ceil(GROUPS_PER_TASK as usize)
    }

    /// The rows of a batch; empty for a list without rows.
    pub fn batch(&self, batch: RowBatch) -> &[G] {
        match batch {
            RowBatch::Interior(block) => self.interior(block),
            RowBatch::Interface(..) if self.rows == 0 => &[],
            RowBatch::Interface(colour, task) => self.interface(colour, task),
        }
    }

    /// The index of the first lane group of a batch, for columns beside the groups.
    pub fn first_group(&self, batch: RowBatch) -> usize {
        match batch {
            RowBatch::Interior(block) => self.interior.get(block).map_or(0, |range| range.start as usize),
            RowBatch::Interface(..) if self.rows == 0 => 0,
            RowBatch::Interface(colour, task) => {
                self.interface[colour].start as usize + task * GROUPS_PER_TASK as usize
            }
        }
    }

    /// The interface rows of one task.
    pub fn interface(&self, colour: usize, task: usize) -> &[G] {
        let Range { start, end } = self.interface[colour].clone();
        let from = start + task as u32 * GROUPS_PER_TASK;
        &self.groups[from as usize..end.min(from + GROUPS_PER_TASK) as usize]
    }
}

/// Greedy colouring: each row gets the lowest colour that none of its points has.
struct Colours {
    first: u32,
    /// The colours of each point's rows, as bits, 64 colours at a time.
    taken: Vec<u64>,
}

impl Colours {
    fn new(blocks: &impl Partition) -> Self {
        let span = blocks.span();
        Self { first: span.start, taken: vec![0; span.len()] }
    }

    /// The rows by level, and in each by colour.
    fn sort_levels<T: Row>(&mut self, mut rows: Vec<(u32, T)>) -> Vec<Vec<T>> {
        rows.sort_by_key(|&(level, _)| level);
        let of_level = |rows: &[(u32, T)]| rows.iter().map(|&(_, row)| row).collect();
        rows.chunk_by(|a, b| a.0 == b.0).flat_map(|rows| self.sort(of_level(rows))).collect()
    }

    /// The rows by colour. A fan of many rows round one point needs as many colours as it has rows, so colours are
    /// assigned 64 at a time.
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
    use crate::model::blocks::Blocks;
    use proptest::prelude::*;
    use std::collections::HashSet;

    #[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
    struct Pair(u32, u32);

    impl Row for Pair {
        type Group = [Pair; 4];
        const POINTS: usize = 2;
        const GROUPS: usize = 2;
        fn point(&self, k: usize) -> u32 {
            if k == 0 { self.0 } else { self.1 }
        }
        fn idle(padding_point: u32) -> Self {
            Pair(padding_point, padding_point)
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
        fn the_block_of_a_point_is_the_one_whose_range_contains_it(points in 1usize..10_000, first in 0u32..100) {
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
                prop_assert!(list.interior(block).chunks(2).all(|groups| !shares_a_point(groups, points as u32)));
                prop_assert!(list.interior(block).iter().flatten().filter(|p| p.0 < points as u32)
                    .all(|p| blocks.of(p.0) == block as u32 && blocks.of(p.1) == block as u32));
            }
            let mut stored: Vec<_> = list.groups().iter().flatten().filter(|p| p.0 < points as u32).map(|p| (p.0, p.1)).collect();
            let mut given: Vec<_> = rows.iter().map(|p| (p.0, p.1)).collect();
            stored.sort_unstable();
            given.sort_unstable();
            prop_assert_eq!(stored, given);
        }

        #[test]
        fn rows_of_a_lower_level_come_first_in_their_block((points, rows) in pairs()) {
            let blocks = Blocks::new(0, points);
            let levels: Vec<u32> = rows.iter().map(|pair| pair.0 % 3).collect();
            let list = RowList::in_levels(&rows, &levels, &blocks);
            prop_assert_eq!(list.groups().iter().flatten().filter(|p| p.0 < points as u32).count(), rows.len());
            for block in 0..blocks.len() {
                let real = list.interior(block).iter().flatten().filter(|p| p.0 < points as u32);
                let order: Vec<u32> = real.map(|pair| pair.0 % 3).collect();
                prop_assert!(order.is_sorted(), "{:?}", order);
                prop_assert!(list.interior(block).chunks(2).all(|groups| !shares_a_point(groups, points as u32)));
            }
        }
    }
}
