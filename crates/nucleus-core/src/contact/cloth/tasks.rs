//! Which contacts may be worked on side by side: those between the same blocks of points make a task, and
//! tasks of one phase share no block.
//!
//! The layout depends on the contacts and the mesh alone, so that any number of threads does the same sums in
//! the same order.

use std::ops::Range;

/// Tasks in phases. Every task is a run of the contacts, once they are put in [`order`](Tasks::order).
#[derive(Debug, Clone, Default)]
pub struct Tasks {
    /// The contacts in the order of the tasks, by their former index; the key is what they are sorted by.
    pub order: Vec<(u64, u32)>,
    /// The run of each task.
    pub runs: Vec<Range<u32>>,
    /// The tasks of each phase.
    pub phases: Vec<Range<u32>>,
    /// The phase of each task, while phases are found.
    phase_of: Vec<u32>,
    /// Which blocks are taken, a row of bits per phase.
    taken: Vec<u64>,
    sorted: Vec<(u32, u32)>,
}

/// Contacts between more than two blocks come last, one after the other.
const SPREAD: u64 = u64::MAX;

impl Tasks {
    /// No tasks.
    pub fn clear(&mut self) {
        self.order.clear();
        self.runs.clear();
        self.phases.clear();
    }

    /// Lays out contacts, each given by the blocks of its points, of which there are `blocks`.
    pub fn lay_out(&mut self, contacts: impl Iterator<Item = [u32; 4]>, blocks: u32) {
        self.order.clear();
        self.order.extend(contacts.map(key).zip(0..));
        self.order.sort_unstable();
        self.runs.clear();
        let mut from = 0;
        for run in self.order.chunk_by(|a, b| a.0 == b.0) {
            self.runs.push(from..from + run.len() as u32);
            from += run.len() as u32;
        }
        self.find_phases(blocks);
        self.sort_by_phase();
    }

    /// Gives each task the first phase in which neither of its blocks is taken.
    fn find_phases(&mut self, blocks: u32) {
        let words = blocks.div_ceil(64) as usize;
        self.taken.clear();
        self.phase_of.clear();
        let mut last = 0;
        for run in &self.runs {
            let key = self.order[run.start as usize].0;
            if key == SPREAD {
                self.phase_of.push(last);
                continue;
            }
            let ends = [(key >> 32) as usize, (key & u64::from(u32::MAX)) as usize];
            let is_free = |row: &[u64]| ends.iter().all(|&block| row[block / 64] & (1 << (block % 64)) == 0);
            let free = self.taken.chunks(words).position(is_free);
            let phase = free.unwrap_or(self.taken.len() / words);
            self.taken.resize(self.taken.len().max((phase + 1) * words), 0);
            ends.iter().for_each(|&block| self.taken[phase * words + block / 64] |= 1 << (block % 64));
            self.phase_of.push(phase as u32);
            last = last.max(phase as u32 + 1);
        }
    }

    fn sort_by_phase(&mut self) {
        self.sorted.clear();
        self.sorted.extend(self.phase_of.iter().copied().zip(0..));
        self.sorted.sort_unstable();
        self.phases.clear();
        let mut from = 0;
        for phase in self.sorted.chunk_by(|a, b| a.0 == b.0) {
            self.phases.push(from..from + phase.len() as u32);
            from += phase.len() as u32;
        }
    }

    /// The run of a task of a phase.
    pub fn run(&self, phase: &Range<u32>, task: usize) -> Range<u32> {
        self.runs[self.sorted[phase.start as usize + task].1 as usize].clone()
    }
}

/// The one or two blocks of a contact, as a number.
fn key(blocks: [u32; 4]) -> u64 {
    let low = blocks.into_iter().min().unwrap_or(0);
    let high = blocks.into_iter().max().unwrap_or(0);
    let between = blocks.into_iter().any(|block| block != low && block != high);
    if between { SPREAD } else { u64::from(low) << 32 | u64::from(high) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn tasks_of_one_phase_share_no_block_and_every_contact_has_its_place(
            contacts in proptest::collection::vec(proptest::array::uniform4(0u32..70), 0..200)
        ) {
            let mut tasks = Tasks::default();
            tasks.lay_out(contacts.iter().copied(), 70);
            let mut places = 0;
            for phase in &tasks.phases {
                let mut taken = std::collections::HashMap::new();
                for task in 0..phase.len() {
                    for &(_, contact) in &tasks.order[tasks.run(phase, task).start as usize..tasks.run(phase, task).end as usize] {
                        places += 1;
                        for block in contacts[contact as usize] {
                            prop_assert_eq!(*taken.entry(block).or_insert(task), task);
                        }
                    }
                }
            }
            prop_assert_eq!(places, contacts.len());
        }
    }
}
