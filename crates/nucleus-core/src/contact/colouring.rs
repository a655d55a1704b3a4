//! The order of contacts, and the colouring that lets threads share a batch.
//!
//! Contacts between the same blocks of points form a task. Tasks of one colour share no block and run in
//! parallel. The colouring depends on the contacts and the mesh alone, so the order of all sums is the same on
//! any number of threads.

use std::ops::Range;

/// Moves the contact of each place to it. The keys stay, the indices are lost.
pub fn permute<T: Copy, K>(list: &mut [T], order: &mut [(K, u32)]) {
    for first in 0..list.len() {
        let (held, mut to) = (list[first], first);
        loop {
            let from = std::mem::replace(&mut order[to].1, to as u32) as usize;
            if from == first {
                break;
            }
            list[to] = list[from];
            to = from;
        }
        list[to] = held;
    }
}

/// Tasks by colour. Every task is a run of the contacts.
#[derive(Debug, Clone, Default)]
pub struct Colouring {
    /// The run of each task.
    pub tasks: Vec<Range<u32>>,
    /// The blocks of each task; [`SERIAL`] for contacts between more than two.
    pub task_blocks: Vec<[u32; 2]>,
    /// The tasks of each colour.
    pub colours: Vec<Range<u32>>,
    /// The colour of each task, while colours are found.
    colour_of: Vec<u32>,
    /// The occupied blocks, a row of bits for each colour.
    taken: Vec<u64>,
    sorted: Vec<(u32, u32)>,
}

/// Blocks of contacts between more than two, which run last, one after the other.
pub const SERIAL: [u32; 2] = [u32::MAX; 2];

impl Colouring {
    /// No tasks.
    pub fn clear(&mut self) {
        self.tasks.clear();
        self.task_blocks.clear();
        self.colours.clear();
    }

    /// Colours contacts that are sorted by task, given as pieces: the [`task_key`] and the number of contacts of each. There
    /// are `blocks` blocks.
    pub fn assign(&mut self, sorted_pieces: impl Iterator<Item = ([u32; 2], u32)>, blocks: u32) {
        self.tasks.clear();
        self.task_blocks.clear();
        let mut from = 0;
        for (key, contacts) in sorted_pieces {
            let end = from + contacts;
            if self.task_blocks.last() == Some(&key)
                && let Some(run) = self.tasks.last_mut()
            {
                run.end = end;
            } else {
                self.tasks.push(from..end);
                self.task_blocks.push(key);
            }
            from = end;
        }
        self.assign_colours(blocks);
        self.sort_by_colour();
    }

    /// Greedy colouring: each task takes the first colour in which both of its blocks are free.
    fn assign_colours(&mut self, blocks: u32) {
        let words = blocks.div_ceil(64) as usize;
        self.taken.clear();
        self.colour_of.clear();
        let mut last = 0;
        for &key in &self.task_blocks {
            if key == SERIAL {
                self.colour_of.push(last);
                continue;
            }
            let ends = key.map(|block| block as usize);
            let is_free = |row: &[u64]| ends.iter().all(|&block| row[block / 64] & (1 << (block % 64)) == 0);
            let free = self.taken.chunks(words).position(is_free);
            let colour = free.unwrap_or(self.taken.len() / words);
            self.taken.resize(self.taken.len().max((colour + 1) * words), 0);
            ends.iter().for_each(|&block| self.taken[colour * words + block / 64] |= 1 << (block % 64));
            self.colour_of.push(colour as u32);
            last = last.max(colour as u32 + 1);
        }
    }

    fn sort_by_colour(&mut self) {
        self.sorted.clear();
        self.sorted.extend(self.colour_of.iter().copied().zip(0..));
        self.sorted.sort_unstable();
        self.colours.clear();
        let mut from = 0;
        for colour in self.sorted.chunk_by(|a, b| a.0 == b.0) {
            self.colours.push(from..from + colour.len() as u32);
            from += colour.len() as u32;
        }
    }

    /// The index of a task of a colour.
    pub fn task(&self, colour: &Range<u32>, task: usize) -> usize {
        self.sorted[colour.start as usize + task].1 as usize
    }
}

/// The one or two blocks of a contact, the lower first: contacts of one key form a task.
pub fn task_key(blocks: [u32; 4]) -> [u32; 2] {
    let low = blocks.into_iter().min().unwrap_or(0);
    let high = blocks.into_iter().max().unwrap_or(0);
    let between = blocks.into_iter().any(|block| block != low && block != high);
    if between { SERIAL } else { [low, high] }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    /// A contact: its blocks, and its index.
    type Place = ([u32; 2], u32);

    proptest! {
        #[test]
        fn tasks_of_one_colour_share_no_block_and_every_contact_has_a_task(
            contacts in proptest::collection::vec(proptest::array::uniform4(0u32..70), 0..200)
        ) {
            let (mut colouring, mut order) = (Colouring::default(), Vec::<Place>::new());
            order.extend(contacts.iter().copied().map(task_key).zip(0..));
            order.sort_unstable();
            colouring.assign(order.iter().map(|place| (place.0, 1)), 70);
            let mut places = 0;
            for colour in &colouring.colours {
                let mut taken = std::collections::HashMap::new();
                for task in 0..colour.len() {
                    let run = &colouring.tasks[colouring.task(colour, task)];
                    for &(_, contact) in &order[run.start as usize..run.end as usize] {
                        places += 1;
                        for block in contacts[contact as usize] {
                            prop_assert_eq!(*taken.entry(block).or_insert(task), task);
                        }
                    }
                }
            }
            prop_assert_eq!(places, contacts.len());
        }

        #[test]
        fn a_list_is_permuted_in_place(order in proptest::sample::subsequence((0..50u32).collect::<Vec<_>>(), 50).prop_shuffle()) {
            let mut list: Vec<u32> = (100..150).collect();
            let mut places: Vec<Place> = order.iter().map(|&from| ([0; 2], from)).collect();
            permute(&mut list, &mut places);
            prop_assert_eq!(list, order.iter().map(|from| 100 + from).collect::<Vec<_>>());
        }
    }
}
