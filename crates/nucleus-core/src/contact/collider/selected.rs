//! What the tasks of a selection find, and the order in which sweeps take it: contacts within each run of points, then those
//! between runs.
//!
//! A selection task counts what it finds by contact task. Only these counts are merged serially.

use crate::contact::colouring::{Colouring, SERIAL};
use crate::parallel::disjoint::DisjointSlice;
use crate::parallel::thread_pool::ThreadPool;

/// The active contacts among those of a selection task.
#[derive(Debug, Default)]
pub struct Selected {
    /// Each contact: its piece, and its index.
    contacts: Vec<(u32, u32)>,
    pieces: Vec<Piece>,
    /// The piece of the last contact.
    last: u32,
    /// Indices of those that motion bounds do not certify.
    uncertified: Vec<u32>,
}

/// Those of one contact task: its key, their number, and where they go.
#[derive(Debug)]
struct Piece {
    key: [u32; 2],
    count: u32,
    to: u32,
}

/// Scratch memory of a merge: the rank of each piece, the selection task that found it, and its index there.
pub type Ranks = Vec<((bool, [u32; 2]), [u32; 2])>;

/// The order of a contact task: those within a run of points are first, those between more than two last.
fn rank(key: [u32; 2]) -> (bool, [u32; 2]) {
    (key[0] != key[1] || key == SERIAL, key)
}

impl Selected {
    /// Removes all, keeps the capacity.
    pub fn clear(&mut self) {
        self.contacts.clear();
        self.pieces.clear();
        self.last = 0;
        self.uncertified.clear();
    }

    /// Adds a contact of a contact task.
    #[inline(always)]
    pub fn push(&mut self, key: [u32; 2], index: u32, is_certified: bool) {
        // Contacts of one contact task mostly follow each other.
        if self.pieces.get(self.last as usize).is_none_or(|piece| piece.key != key) {
            self.last = self.piece_of(key);
        }
        self.pieces[self.last as usize].count += 1;
        self.contacts.push((self.last, index));
        if !is_certified {
            self.uncertified.push(index);
        }
    }

    fn piece_of(&mut self, key: [u32; 2]) -> u32 {
        let known = self.pieces.iter().position(|piece| piece.key == key);
        let at = known.unwrap_or(self.pieces.len());
        if known.is_none() {
            self.pieces.push(Piece { key, count: 0, to: 0 });
        }
        at as u32
    }
}

/// Puts what selection tasks have found into the order of contact tasks, which it colours; within a contact task in the order
/// of selection tasks. There are `runs` runs of points.
pub fn merge(
    selected: &mut [Selected],
    ranks: &mut Ranks,
    (indices, uncertified): (&mut Vec<u32>, &mut Vec<u32>),
    (colouring, runs): (&mut Colouring, u32),
    pool: &ThreadPool,
) {
    ranks.clear();
    uncertified.clear();
    for (found_by, found) in (0..).zip(&*selected) {
        let pieces = (0..).zip(&found.pieces);
        ranks.extend(pieces.map(|(at, piece)| (rank(piece.key), [found_by, at])));
        uncertified.extend_from_slice(&found.uncertified);
    }
    ranks.sort_unstable();
    let mut end = 0;
    let in_order = ranks.iter().map(|&((_, key), [found_by, at])| {
        let piece = &mut selected[found_by as usize].pieces[at as usize];
        piece.to = end;
        end += piece.count;
        (key, piece.count)
    });
    colouring.assign(in_order, runs);
    indices.resize(end as usize, 0);
    let indices = DisjointSlice::new(indices);
    pool.for_each_mut(selected, |_, found| {
        for &(piece, index) in &found.contacts {
            let to = &mut found.pieces[piece as usize].to;
            // SAFETY: the rows of its pieces belong to one task.
            #[allow(unsafe_code)]
            unsafe {
                indices.set(*to, index);
            }
            *to += 1;
        }
    });
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::contact::colouring::task_key;

    proptest! {
        #[test]
        fn contacts_are_in_the_order_of_their_tasks_and_in_each_as_they_were_found(
            found in proptest::collection::vec(proptest::collection::vec(proptest::array::uniform3(0u32..6), 0..50), 0..9),
        ) {
            let mut selected: Vec<Selected> = Vec::new();
            let mut expected = Vec::new();
            let mut uncertified_expected = Vec::new();
            for contacts in &found {
                let mut own = Selected::default();
                for &[a, b, c] in contacts {
                    let (key, index) = (task_key([a, b, c, a]), expected.len() as u32);
                    own.push(key, index, index % 3 == 0);
                    expected.push((rank(key), index));
                    uncertified_expected.extend((index % 3 != 0).then_some(index));
                }
                selected.push(own);
            }
            expected.sort_unstable();
            let (mut indices, mut uncertified, mut colouring) = (Vec::new(), Vec::new(), Colouring::default());
            let pool = ThreadPool::new(2);
            merge(&mut selected, &mut Ranks::new(), (&mut indices, &mut uncertified), (&mut colouring, 6), &pool);
            prop_assert_eq!(&indices, &expected.iter().map(|&(_, index)| index).collect::<Vec<_>>());
            prop_assert_eq!(uncertified, uncertified_expected);
            for (task, key) in colouring.tasks.iter().zip(&colouring.task_blocks) {
                let own = &expected[task.start as usize..task.end as usize];
                prop_assert!(!own.is_empty() && own.iter().all(|&(of, _)| of == rank(*key)));
            }
            prop_assert_eq!(colouring.tasks.iter().map(|task| task.len()).sum::<usize>(), expected.len());
        }
    }
}
