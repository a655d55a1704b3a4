//! Contacts of one kind, by task: those between the same blocks of points.
//!
//! A search removes the contacts of points with new bounds from the tasks of their blocks, and appends those that it has
//! found. All other tasks stay as they are.

use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

use crate::bytes::checkpoint_struct;
use crate::contact::cloth::contact::{ClothContact, ClothStep};
use crate::contact::cloth::contact_task::ContactTask;
use crate::contact::cloth::found_contacts::{FoundContacts, FoundPairs};
use crate::contact::colouring::{Colouring, SERIAL};
use crate::contact::pair_table::ContactMaterials;
use crate::math::Real;
use crate::parallel::disjoint::DisjointSlice;
use crate::parallel::thread_pool::ThreadPool;

/// Contacts of one kind.
#[derive(Debug)]
pub struct ContactList<R, const N: usize, const M: usize> {
    /// Contacts of free points. Their order matters most, so they are sorted by point in each task.
    free_points: ContactTasks<R, N, M>,
    /// Contacts of cloth, in the order in which they were found.
    cloth: ContactTasks<R, N, M>,
}

/// Contacts by task; tasks of one colour share no block.
#[derive(Debug)]
struct ContactTasks<R, const N: usize, const M: usize> {
    /// Sorted by their blocks. A task without contacts keeps its buffers.
    tasks: Vec<ContactTask<R, N, M>>,
    /// The tasks that have contacts, and their colours.
    filled: Vec<u32>,
    colouring: Colouring,
}

checkpoint_struct!([R: Real, const N: usize, const M: usize] ContactList<R, N, M> {
    columns: [], values: [], parts: [free_points, cloth], rebuilt: [],
});

// The rest is rebuilt when the next candidate interval begins.
checkpoint_struct!([R: Real, const N: usize, const M: usize] ContactTasks<R, N, M> {
    columns: [], values: [tasks], parts: [], rebuilt: [filled, colouring],
});

impl<R, const N: usize, const M: usize> Default for ContactList<R, N, M> {
    fn default() -> Self {
        Self { free_points: ContactTasks::default(), cloth: ContactTasks::default() }
    }
}

impl<R, const N: usize, const M: usize> Default for ContactTasks<R, N, M> {
    fn default() -> Self {
        Self { tasks: Vec::new(), filled: Vec::new(), colouring: Colouring::default() }
    }
}

/// Pairs of neighbours for each of many blocks in a space: itself, and half of 26. Empty tasks beyond them are of blocks that
/// have moved apart.
const NEIGHBOURS: usize = 14;

/// The block of each point, and the number of blocks.
pub type Blocks<'a> = (&'a [u32], u32);

/// The contacts that a search replaces.
#[derive(Clone, Copy)]
pub struct Replaced<'a> {
    /// Points with new bounds.
    pub bounds_violated: &'a [bool],
    /// Whether each block has any.
    pub has_violations: &'a [AtomicBool],
}

impl Replaced<'_> {
    fn keeps<R: Real, const N: usize, const M: usize>(&self, contact: &ClothContact<R, N, M>) -> bool {
        !contact.points().iter().any(|&point| self.bounds_violated[point as usize])
    }

    /// Whether all contacts between some blocks stay. Those between more than two are looked at one by one.
    fn keeps_all(&self, blocks: [u32; 2]) -> bool {
        let keeps = |block: u32| {
            self.has_violations.get(block as usize).is_some_and(|any| !any.load(Ordering::Relaxed))
        };
        blocks.into_iter().all(keeps)
    }
}

impl<R: Real, const N: usize, const M: usize> ContactList<R, N, M> {
    /// All contacts.
    pub fn iter(&self) -> impl Iterator<Item = &ClothContact<R, N, M>> {
        [&self.free_points, &self.cloth]
            .into_iter()
            .flat_map(|all| &all.tasks)
            .flat_map(ContactTask::contacts)
    }

    /// One contact of each task, and all between more than two blocks. A block is of one cloth, so these are of all pairs of
    /// cloths in contact.
    pub fn of_each_task(&self) -> impl Iterator<Item = &ClothContact<R, N, M>> {
        let tasks = [&self.free_points, &self.cloth].into_iter().flat_map(|all| &all.tasks);
        tasks.flat_map(|task| match (task.blocks, task.contacts()) {
            (SERIAL, all) => all,
            (_, all) => &all[..all.len().min(1)],
        })
    }

    /// The same as [`iter`](Self::iter), to work on.
    pub fn iter_mut(&mut self) -> impl Iterator<Item = &mut ClothContact<R, N, M>> {
        let both = [&mut self.free_points, &mut self.cloth];
        both.into_iter().flat_map(|all| &mut all.tasks).flat_map(ContactTask::contacts_mut)
    }

    /// The number of contacts.
    pub fn len(&self) -> usize {
        [&self.free_points, &self.cloth]
            .into_iter()
            .flat_map(|all| &all.tasks)
            .map(|task| task.contacts().len())
            .sum()
    }

    /// Whether every contact stands in the task of its blocks.
    pub fn is_sorted(&self, (block, _): Blocks<'_>) -> bool {
        [&self.free_points, &self.cloth].into_iter().all(|all| {
            all.tasks.is_sorted_by(|a, b| a.blocks < b.blocks)
                && all.tasks.iter().all(|task| task.is_sorted(block))
        })
    }

    /// The smallest ratio of distance to contact thickness; infinite without contacts.
    pub fn min_gap_ratio(&self, step: &ClothStep<'_, R>, pool: &ThreadPool) -> f64 {
        let ratio = |contact: &ClothContact<R, N, M>| contact.gap_ratio(step).to_f64();
        let tasks = [&self.free_points, &self.cloth].into_iter().flat_map(|all| &all.tasks);
        tasks
            .map(|task| task.contacts())
            .map(|all| pool.least(all.len(), |at| ratio(&all[at])))
            .fold(f64::INFINITY, f64::min)
    }

    /// The pair of cloths of each contact that overlaps.
    pub fn overlapping_pairs(&self, materials: &ContactMaterials<R>) -> impl Iterator<Item = [usize; 2]> {
        self.iter().filter(|contact| contact.overlaps()).map(move |contact| contact.cloths(materials))
    }

    /// Renumbers the rows of points; removes contacts of a point without a number.
    pub fn renumber(&mut self, number: &impl Fn(u32) -> Option<u32>, blocks: Blocks<'_>) {
        for (all, is_free) in [(&mut self.free_points, true), (&mut self.cloth, false)] {
            let renumbered = all
                .tasks
                .iter()
                .flat_map(ContactTask::contacts)
                .filter_map(|contact| contact.renumbered(number));
            let renumbered: Vec<_> = renumbered.collect();
            all.tasks.iter_mut().for_each(ContactTask::clear);
            for contact in renumbered {
                all.task_of(contact.blocks(blocks.0)).push(contact);
            }
            if is_free {
                all.tasks.iter_mut().for_each(ContactTask::sort_by_points);
            }
            all.finish(blocks.1);
        }
    }

    /// Removes the contacts that a search replaces.
    pub fn remove(&mut self, replaced: &Replaced<'_>, pool: &ThreadPool) {
        for all in [&mut self.free_points, &mut self.cloth] {
            all.for_tasks(pool, |task| {
                if !replaced.keeps_all(task.blocks) {
                    task.retain(|contact| replaced.keeps(contact));
                }
            });
        }
    }

    /// Appends the candidates `of` this kind that search tasks have found, in the order of the tasks.
    pub fn add(
        &mut self,
        found: &[FoundContacts<R>],
        of: fn(&FoundContacts<R>) -> &FoundPairs<R, N, M>,
        pool: &ThreadPool,
    ) {
        for (all, is_free) in [(&mut self.free_points, true), (&mut self.cloth, false)] {
            let mut any = false;
            for (at, found) in (0..).zip(found) {
                for run in of(found).runs().iter().filter(|run| run.of_free_points == is_free) {
                    all.task_of(run.blocks).incoming.push((at, run.candidates.clone()));
                    any = true;
                }
            }
            if any {
                all.for_tasks(pool, |task| {
                    task.take_incoming(|at| of(&found[at as usize]).candidates());
                    if is_free {
                        task.sort_by_points();
                    }
                });
            }
        }
    }

    /// Colours the tasks, after contacts were removed or added.
    pub fn finish(&mut self, blocks: u32) {
        self.free_points.finish(blocks);
        self.cloth.finish(blocks);
    }

    /// Calls `work` with each contact, all tasks in parallel: it may move no point.
    pub fn for_each(&mut self, pool: &ThreadPool, work: impl Fn(&mut ClothContact<R, N, M>) + Sync) {
        self.free_points.for_tasks(pool, |task| task.contacts_mut().iter_mut().for_each(&work));
        self.cloth.for_tasks(pool, |task| task.contacts_mut().iter_mut().for_each(&work));
    }

    /// Calls `work` with each contact, tasks in parallel. Returns how often it answered `true`.
    pub fn count(
        &mut self,
        pool: &ThreadPool,
        work: impl Fn(&mut ClothContact<R, N, M>) -> bool + Sync,
    ) -> u64 {
        self.free_points.count(pool, &work) + self.cloth.count(pool, &work)
    }

    /// One sweep. Returns the number of contacts that pushed; marks their cloths.
    pub fn sweep(&mut self, step: &ClothStep<'_, R>, has_touched: &[AtomicBool], pool: &ThreadPool) -> u64 {
        self.count(pool, |contact| {
            let has_pushed = contact.is_resolved(step) && contact.resolve(step);
            if has_pushed {
                contact.mark_cloths(step.materials, has_touched);
            }
            has_pushed
        })
    }

    /// The number of contacts without certificate. Marks their cloths.
    pub fn certify(&mut self, step: &ClothStep<'_, R>, unproven: &[AtomicBool], pool: &ThreadPool) -> u64 {
        self.free_points.certify(step, unproven, pool) + self.cloth.certify(step, unproven, pool)
    }
}

impl<R: Real, const N: usize, const M: usize> ContactTasks<R, N, M> {
    /// The task between some blocks.
    fn task_of(&mut self, blocks: [u32; 2]) -> &mut ContactTask<R, N, M> {
        let at = match self.tasks.binary_search_by_key(&blocks, |task| task.blocks) {
            Ok(at) => at,
            Err(at) => {
                self.tasks.insert(at, ContactTask::new(blocks));
                at
            }
        };
        &mut self.tasks[at]
    }

    fn for_tasks(&mut self, pool: &ThreadPool, work: impl Fn(&mut ContactTask<R, N, M>) + Sync) {
        pool.for_each_mut(&mut self.tasks, |_, task| work(task));
    }

    /// Colours the tasks with contacts. Those without are dropped once they are more than blocks in space have neighbours.
    fn finish(&mut self, blocks: u32) {
        let Self { tasks, filled, colouring } = self;
        let count = tasks.iter().filter(|task| !task.contacts().is_empty()).count();
        if tasks.len() - count > NEIGHBOURS * blocks as usize {
            tasks.retain(|task| !task.contacts().is_empty());
        }
        filled.clear();
        filled.extend((0..).zip(&*tasks).filter(|(_, task)| !task.contacts().is_empty()).map(|(at, _)| at));
        colouring.assign(filled.iter().map(|&at| (tasks[at as usize].blocks, 1)), blocks);
    }

    /// The number of contacts without certificate. Marks their cloths. Needs no colours, because it moves no point.
    fn certify(&mut self, step: &ClothStep<'_, R>, unproven: &[AtomicBool], pool: &ThreadPool) -> u64 {
        let count = AtomicU64::new(0);
        let Self { tasks, filled, .. } = self;
        let tasks = DisjointSlice::new(tasks);
        pool.parallel_for(filled.len(), |task| {
            let at = filled[task];
            // SAFETY: every task is run once.
            #[allow(unsafe_code)]
            let [task] = (unsafe { tasks.run(at..at + 1) }) else { return };
            let unproven_here = task.certify(step, unproven);
            if unproven_here > 0 {
                count.fetch_add(unproven_here, Ordering::Relaxed);
            }
        });
        count.into_inner()
    }

    fn count(&mut self, pool: &ThreadPool, work: impl Fn(&mut ClothContact<R, N, M>) -> bool + Sync) -> u64 {
        let count = AtomicU64::new(0);
        let Self { tasks, filled, colouring, .. } = self;
        let tasks = DisjointSlice::new(tasks);
        for colour in &colouring.colours {
            pool.parallel_for(colour.len(), |task| {
                let at = filled[colouring.task(colour, task)];
                // SAFETY: every task is run once, and those of a colour share no point.
                #[allow(unsafe_code)]
                let [task] = (unsafe { tasks.run(at..at + 1) }) else { return };
                let mut yes = 0;
                for contact in task.contacts_mut() {
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

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::contact::cloth::contact::{Candidate, ContactKind, ContactParams};

    /// Candidates of points of a cloth, and of free points where the first is odd.
    fn found(pairs: &[[u32; 2]], blocks: Blocks<'_>) -> FoundContacts<f32> {
        let mut found = FoundContacts::default();
        for &[ours, theirs] in pairs {
            let kind = ContactKind::of_material(0)
                .with(ContactKind::CERTIFIED, theirs % 3 == 0)
                .with(ContactKind::HAS_FREE_POINT, ours % 2 == 1);
            let params = ContactParams { thickness: 1.0, kind };
            found.point_point.candidates.push(Candidate {
                points: ([ours], [theirs]),
                normal: [0.0; 3],
                params,
            });
        }
        found.sort_by_task(blocks.0);
        found
    }

    fn points_of(list: &ContactList<f32, 1, 1>) -> Vec<[u32; 2]> {
        list.iter().map(|contact| [contact.ours[0], contact.theirs[0]]).collect()
    }

    proptest! {
        #[test]
        fn the_order_of_contacts_depends_on_that_of_searches_and_not_on_their_tasks(
            pairs in proptest::collection::vec(proptest::array::uniform2(0..40u32), 0..60),
            cuts in proptest::array::uniform2(0..60usize),
            violated in proptest::collection::vec(any::<bool>(), 40),
        ) {
            let block: Vec<u32> = (0..40).map(|point| point / 8).collect();
            let blocks = (&block[..], 5);
            let pool = ThreadPool::new(2);
            let (low, high) = (cuts[0].min(cuts[1]).min(pairs.len()), cuts[0].max(cuts[1]).min(pairs.len()));
            let [whole, cut] = [vec![&pairs[..]], vec![&pairs[..low], &pairs[low..high], &pairs[high..]]].map(|tasks| {
                let tasks: Vec<_> = tasks.into_iter().map(|pairs| found(pairs, blocks)).collect();
                let mut list = ContactList::<f32, 1, 1>::default();
                list.add(&tasks, |found| &found.point_point, &pool);
                list.finish(blocks.1);
                assert!(list.is_sorted(blocks));
                list
            });
            prop_assert_eq!(points_of(&whole), points_of(&cut));
            let blocks_of = |contacts: Vec<&ClothContact<f32, 1, 1>>| -> std::collections::BTreeSet<[u32; 2]> {
                contacts.into_iter().map(|contact| contact.blocks(&block)).collect()
            };
            prop_assert_eq!(blocks_of(whole.of_each_task().collect()), blocks_of(whole.iter().collect()));

            // Contacts of cloth keep the order in which they were found, those of free points have that of their points.
            for tasks in [&whole.cloth.tasks, &whole.free_points.tasks] {
                for task in tasks {
                    let own: Vec<[u32; 2]> = task.contacts().iter().map(|contact| [contact.ours[0], contact.theirs[0]]).collect();
                    let is_free = std::ptr::eq(tasks, &whole.free_points.tasks);
                    let mut expected: Vec<[u32; 2]> = pairs.iter().copied().filter(|pair| {
                        let ends = pair.map(|point| point / 8);
                        (pair[0] % 2 == 1) == is_free && [ends[0].min(ends[1]), ends[0].max(ends[1])] == task.blocks
                    }).collect();
                    if is_free {
                        expected.sort_unstable();
                    }
                    prop_assert_eq!(own, expected);
                }
            }

            // A search replaces the contacts of the points with new bounds, and no others.
            let has_violations: Vec<AtomicBool> = violated.chunks(8).map(|block| block.contains(&true).into()).collect();
            let mut left = whole;
            let before = points_of(&left);
            left.remove(&Replaced { bounds_violated: &violated, has_violations: &has_violations }, &pool);
            let kept = before.into_iter().filter(|pair| !pair.iter().any(|&point| violated[point as usize]));
            prop_assert_eq!(points_of(&left), kept.collect::<Vec<_>>());
        }
    }

    #[test]
    fn tasks_of_blocks_that_have_moved_apart_are_dropped() {
        let block: Vec<u32> = (0..200).collect();
        let (blocks, pool) = ((&block[..], 200), ThreadPool::new(1));
        let mut list = ContactList::<f32, 1, 1>::default();
        for other in (1..199).step_by(2) {
            let met: Vec<[u32; 2]> =
                (0..200).filter(|&point| point != other).map(|point| [2 * (point / 2), other]).collect();
            list.add(&[found(&met, blocks)], |found| &found.point_point, &pool);
            list.finish(200);
            assert_eq!(list.len(), 199);
            let has_violations = std::array::from_fn::<_, 200, _>(|_| AtomicBool::new(true));
            let all = Replaced { bounds_violated: &[true; 200], has_violations: &has_violations };
            list.remove(&all, &pool);
        }
        list.finish(200);
        assert!(list.cloth.tasks.len() <= NEIGHBOURS * 200, "{}", list.cloth.tasks.len());
    }

    #[test]
    fn a_contact_in_the_task_of_other_blocks_is_noticed() {
        let block: Vec<u32> = (0..40).map(|point| point / 8).collect();
        let mut list = ContactList::<f32, 1, 1>::default();
        list.add(&[found(&[[2, 9]], (&block, 5))], |found| &found.point_point, &ThreadPool::new(1));
        assert!(list.is_sorted((&block, 5)));
        list.cloth.tasks[0].blocks = [0, 2];
        assert!(!list.is_sorted((&block, 5)));
    }
}
