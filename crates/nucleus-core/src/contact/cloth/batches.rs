//! Contacts of one kind in batches, and the colouring that lets threads share a batch.
//!
//! Contacts between the same blocks of points form a task. Tasks of one colour share no block and run in
//! parallel. The colouring depends on the contacts and the mesh alone, so the order of all sums is the same on
//! any number of threads.

use std::ops::Range;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

use crate::bytes::checkpoint_struct;
use crate::contact::cloth::contact::{ClothContact, ClothStep};
use crate::contact::cloth::search::RefreshKind;
use crate::math::Real;
use crate::parallel::disjoint::DisjointSlice;
use crate::parallel::thread_pool::ThreadPool;

/// Contacts of one kind, in batches that are swept one after the other.
#[derive(Debug)]
pub struct ContactList<R, const N: usize, const M: usize> {
    /// Contacts of free points. Their order matters most, so they are sorted by point: a search far away does not
    /// change it.
    free_points: ContactBatch<R, N, M>,
    /// Contacts of cloth found at the start of the candidate interval, in the order in which they were found.
    initial: ContactBatch<R, N, M>,
    /// Contacts of cloth found later.
    incremental: ContactBatch<R, N, M>,
    /// Contacts of free points, and of cloth, that await their batch.
    pending: [Vec<ClothContact<R, N, M>>; 2],
}

/// Contacts in the order of their tasks.
#[derive(Debug)]
struct ContactBatch<R, const N: usize, const M: usize> {
    list: Vec<ClothContact<R, N, M>>,
    colouring: Colouring,
}

checkpoint_struct!([R: Real, const N: usize, const M: usize] ContactList<R, N, M> {
    columns: [], values: [], parts: [free_points, initial, incremental], rebuilt: [pending],
});

// The colouring is rebuilt when the next candidate interval begins.
checkpoint_struct!([R: Real, const N: usize, const M: usize] ContactBatch<R, N, M> {
    columns: [], values: [list], parts: [], rebuilt: [colouring],
});

impl<R, const N: usize, const M: usize> Default for ContactList<R, N, M> {
    fn default() -> Self {
        Self {
            free_points: ContactBatch::default(),
            initial: ContactBatch::default(),
            incremental: ContactBatch::default(),
            pending: Default::default(),
        }
    }
}

impl<R, const N: usize, const M: usize> Default for ContactBatch<R, N, M> {
    fn default() -> Self {
        Self { list: Vec::new(), colouring: Colouring::default() }
    }
}

/// The block of each point, and the number of blocks.
pub type Blocks<'a> = (&'a [u32], u32);

impl<R: Real, const N: usize, const M: usize> ContactList<R, N, M> {
    /// All enabled contacts.
    pub fn iter(&self) -> impl Iterator<Item = &ClothContact<R, N, M>> {
        let batches = [&self.free_points, &self.initial, &self.incremental];
        batches.into_iter().flat_map(|batch| &batch.list).filter(|contact| !contact.is_disabled())
    }

    /// The same, to work on.
    pub fn iter_mut(&mut self) -> impl Iterator<Item = &mut ClothContact<R, N, M>> {
        let batches = [&mut self.free_points, &mut self.initial, &mut self.incremental];
        batches.into_iter().flat_map(|batch| &mut batch.list).filter(|contact| !contact.is_disabled())
    }

    /// Updates the local anchors of all contacts to these anchors.
    pub fn update_anchors(&mut self, anchors: &[[f64; 3]]) {
        self.iter_mut().for_each(|contact| contact.update_anchors(anchors));
    }

    /// Removes the contacts of points that violated their bounds. A full refresh moves all others to `pending`;
    /// an incremental one leaves the initial batch in place.
    pub fn remove_violated(&mut self, bounds_violated: &[bool], refresh: RefreshKind) {
        let Self { free_points, initial, incremental, pending } = self;
        let is_kept = |contact: &ClothContact<R, N, M>| {
            !contact.is_disabled() && !contact.points().iter().any(|&point| bounds_violated[point as usize])
        };
        let [of_points, of_cloth] = pending;
        of_points.clear();
        of_points.extend(free_points.list.iter().filter(|contact| is_kept(contact)));
        of_cloth.clear();
        if refresh.is_incremental() {
            initial.list.iter_mut().filter(|contact| !is_kept(contact)).for_each(ClothContact::disable);
        } else {
            of_cloth.extend(initial.list.iter().filter(|contact| is_kept(contact)));
            initial.clear();
        }
        of_cloth.extend(incremental.list.iter().filter(|contact| is_kept(contact)));
        incremental.clear();
    }

    /// Renumbers the rows of points; disables contacts of a point without a number.
    pub fn renumber(&mut self, number: &impl Fn(u32) -> Option<u32>) {
        self.iter_mut().for_each(|contact| contact.renumber(number));
    }

    /// Adds contacts that a search found.
    pub fn add(&mut self, more: &[ClothContact<R, N, M>]) {
        let [of_points, of_cloth] = &mut self.pending;
        of_points.extend(more.iter().filter(|contact| contact.has_free_point()));
        of_cloth.extend(more.iter().filter(|contact| !contact.has_free_point()));
    }

    /// Assigns all pending contacts to batches.
    pub fn assign_batches(&mut self, refresh: RefreshKind, blocks: Blocks<'_>) {
        let Self { free_points, initial, incremental, pending: [of_points, of_cloth] } = self;
        of_points.sort_by_key(ClothContact::points);
        free_points.assign_batches(of_points, blocks);
        if refresh.is_incremental() { incremental } else { initial }.assign_batches(of_cloth, blocks);
    }

    /// Calls `work` with each contact, tasks in parallel. Returns how often it answered `true`.
    pub fn count(
        &mut self,
        pool: &ThreadPool,
        work: impl Fn(&mut ClothContact<R, N, M>) -> bool + Sync,
    ) -> u64 {
        let batches = [&mut self.free_points, &mut self.initial, &mut self.incremental];
        batches.into_iter().map(|batch| batch.count(pool, &work)).sum()
    }

    /// One sweep. Returns the number of contacts that pushed.
    pub fn sweep(&mut self, step: &ClothStep<'_, R>, pool: &ThreadPool) -> u64 {
        self.count(pool, |contact| contact.is_resolved(step) && contact.resolve(step))
    }

    /// The number of contacts without certificate. Marks their cloths.
    pub fn certify(&mut self, step: &ClothStep<'_, R>, unproven: &[AtomicBool], pool: &ThreadPool) -> u64 {
        self.count(pool, |contact| {
            let is_unproven = !contact.certify(step);
            if is_unproven {
                let cloths = contact.cloths(step.materials.len());
                cloths.into_iter().for_each(|cloth| unproven[cloth].store(true, Ordering::Relaxed));
            }
            is_unproven
        })
    }
}

impl<R: Real, const N: usize, const M: usize> ContactBatch<R, N, M> {
    fn clear(&mut self) {
        self.list.clear();
        self.colouring.clear();
    }

    /// Sorts the pending contacts by task.
    fn assign_batches(&mut self, pending: &[ClothContact<R, N, M>], (block, blocks): Blocks<'_>) {
        let of_points = pending.iter().map(|contact| contact.points().map(|point| block[point as usize]));
        self.colouring.assign(of_points, blocks);
        self.list.clear();
        self.list.extend(self.colouring.order.iter().map(|&(_, at)| pending[at as usize]));
    }

    fn count(&mut self, pool: &ThreadPool, work: impl Fn(&mut ClothContact<R, N, M>) -> bool + Sync) -> u64 {
        let count = AtomicU64::new(0);
        let Self { list, colouring } = self;
        let list = DisjointSlice::new(list);
        for colour in &colouring.colours {
            pool.parallel_for(colour.len(), |task| {
                // SAFETY: the runs of two tasks do not overlap.
                #[allow(unsafe_code)]
                let run = unsafe { list.run(colouring.task(colour, task)) };
                let mut yes = 0;
                for contact in run {
                    yes += u64::from(work(contact));
                }
                if yes > 0 {
                    count.fetch_add(yes, Ordering::Relaxed);
                }
            });
        }
        count.into_inner()
    }
}

/// Tasks by colour. Every task is a run of the contacts in [`order`](Colouring::order).
#[derive(Debug, Clone, Default)]
pub struct Colouring {
    /// The contacts in the order of the tasks: sort key, and former index.
    pub order: Vec<(u64, u32)>,
    /// The run of each task.
    pub tasks: Vec<Range<u32>>,
    /// The tasks of each colour.
    pub colours: Vec<Range<u32>>,
    /// The colour of each task, while colours are found.
    colour_of: Vec<u32>,
    /// The occupied blocks, a row of bits for each colour.
    taken: Vec<u64>,
    sorted: Vec<(u32, u32)>,
}

/// Key of contacts between more than two blocks, which run last, one after the other.
const SERIAL: u64 = u64::MAX;

impl Colouring {
    /// No tasks.
    pub fn clear(&mut self) {
        self.order.clear();
        self.tasks.clear();
        self.colours.clear();
    }

    /// Colours contacts, each given by the blocks of its points. There are `blocks` blocks.
    pub fn assign(&mut self, contacts: impl Iterator<Item = [u32; 4]>, blocks: u32) {
        self.order.clear();
        self.order.extend(contacts.map(key).zip(0..));
        self.order.sort_unstable();
        self.tasks.clear();
        let mut from = 0;
        for run in self.order.chunk_by(|a, b| a.0 == b.0) {
            self.tasks.push(from..from + run.len() as u32);
            from += run.len() as u32;
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
        for run in &self.tasks {
            let key = self.order[run.start as usize].0;
            if key == SERIAL {
                self.colour_of.push(last);
                continue;
            }
            let ends = [(key >> 32) as usize, (key & u64::from(u32::MAX)) as usize];
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

    /// The run of a task of a colour.
    pub fn task(&self, colour: &Range<u32>, task: usize) -> Range<u32> {
        self.tasks[self.sorted[colour.start as usize + task].1 as usize].clone()
    }
}

/// The one or two blocks of a contact, as a sort key.
fn key(blocks: [u32; 4]) -> u64 {
    let low = blocks.into_iter().min().unwrap_or(0);
    let high = blocks.into_iter().max().unwrap_or(0);
    let between = blocks.into_iter().any(|block| block != low && block != high);
    if between { SERIAL } else { u64::from(low) << 32 | u64::from(high) }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn tasks_of_one_colour_share_no_block_and_every_contact_has_a_task(
            contacts in proptest::collection::vec(proptest::array::uniform4(0u32..70), 0..200)
        ) {
            let mut colouring = Colouring::default();
            colouring.assign(contacts.iter().copied(), 70);
            let mut places = 0;
            for colour in &colouring.colours {
                let mut taken = std::collections::HashMap::new();
                for task in 0..colour.len() {
                    for &(_, contact) in &colouring.order[colouring.task(colour, task).start as usize..colouring.task(colour, task).end as usize] {
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
