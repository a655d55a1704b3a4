//! Contacts of one kind in batches, in the order of their tasks.

use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

use crate::bytes::checkpoint_struct;
use crate::contact::cloth::contact::{Candidate, ClothContact, ClothStep};
use crate::contact::cloth::search::RefreshKind;
use crate::contact::colouring::{Colouring, Place, permute, task_key};
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
}

/// Contacts in the order of their tasks.
#[derive(Debug)]
struct ContactBatch<R, const N: usize, const M: usize> {
    list: Vec<ClothContact<R, N, M>>,
    /// How many of them are disabled.
    disabled: usize,
    colouring: Colouring,
    /// Those that motion bounds do not certify: they need a certificate at the end of each time step.
    uncertified: Vec<u32>,
    /// Contacts that are being merged.
    incoming: Vec<ClothContact<R, N, M>>,
}

checkpoint_struct!([R: Real, const N: usize, const M: usize] ContactList<R, N, M> {
    columns: [], values: [], parts: [free_points, initial, incremental], rebuilt: [],
});

// Colouring and count are rebuilt when the next candidate interval begins.
checkpoint_struct!([R: Real, const N: usize, const M: usize] ContactBatch<R, N, M> {
    columns: [], values: [list], parts: [], rebuilt: [disabled, colouring, uncertified, incoming],
});

impl<R, const N: usize, const M: usize> Default for ContactList<R, N, M> {
    fn default() -> Self {
        let (initial, incremental) = (ContactBatch::default(), ContactBatch::default());
        Self { free_points: ContactBatch::default(), initial, incremental }
    }
}

impl<R, const N: usize, const M: usize> Default for ContactBatch<R, N, M> {
    fn default() -> Self {
        Self {
            list: Vec::new(),
            disabled: 0,
            colouring: Colouring::default(),
            uncertified: Vec::new(),
            incoming: Vec::new(),
        }
    }
}

/// Part of a list that stays spare when it grows.
const SPARE: usize = 8;

/// Contacts per certification task.
const CERTIFICATES_PER_TASK: usize = 512;

/// The block of each point, and the number of blocks.
pub type Blocks<'a> = (&'a [u32], u32);

/// What the lists are updated by, besides the candidates that a search has found.
#[derive(Clone, Copy)]
pub struct ListUpdate<'a> {
    /// Points whose contacts are replaced.
    pub bounds_violated: &'a [bool],
    /// Which contacts the search has replaced.
    pub refresh: RefreshKind,
    /// The block of each point.
    pub blocks: Blocks<'a>,
    /// Whether a point of each block violated its bound.
    pub has_violations: &'a [bool],
}

impl ListUpdate<'_> {
    fn keeps<R: Real, const N: usize, const M: usize>(&self, contact: &ClothContact<R, N, M>) -> bool {
        !contact.is_disabled() && !contact.points().iter().any(|&point| self.bounds_violated[point as usize])
    }
}

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

    /// The smallest ratio of distance to contact thickness; infinite without contacts.
    pub fn min_gap_ratio(&self, step: &ClothStep<'_, R>, pool: &ThreadPool) -> f64 {
        let ratio = |contact: &ClothContact<R, N, M>| match contact.is_disabled() {
            true => f64::INFINITY,
            false => contact.gap_ratio(step).to_f64(),
        };
        let batches = [&self.free_points, &self.initial, &self.incremental];
        batches.map(|batch| pool.least(&batch.list, ratio)).into_iter().fold(f64::INFINITY, f64::min)
    }

    /// The number of enabled contacts after an update.
    pub fn len(&self) -> usize {
        let batches = [&self.free_points, &self.initial, &self.incremental];
        batches.iter().map(|batch| batch.list.len() - batch.disabled).sum()
    }

    /// Renumbers the rows of points; removes contacts of a point without a number.
    pub fn renumber(
        &mut self,
        number: &impl Fn(u32) -> Option<u32>,
        blocks: Blocks<'_>,
        order: &mut Vec<Place>,
    ) {
        self.iter_mut().for_each(|contact| contact.renumber(number));
        let Self { free_points, initial, incremental } = self;
        // Tasks change with the blocks of points, and the order in a task is that of points.
        free_points.list.sort_unstable_by_key(ClothContact::points);
        for batch in [free_points, initial, incremental] {
            batch.list.retain(|contact| !contact.is_disabled());
            batch.sort_by_task(blocks, order);
        }
    }

    /// Before an incremental update: disables the contacts of points that violated their bounds where they are to stay in
    /// place.
    pub fn disable_violated(&mut self, update: &ListUpdate<'_>, pool: &ThreadPool) {
        self.initial.disable_violated(update, pool);
    }

    /// Removes the contacts of points that violated their bounds, and adds the candidates that a search has `found`. An
    /// incremental update leaves the initial batch in place.
    pub fn update<'a>(
        &mut self,
        found: impl Iterator<Item = &'a Candidate<R, N, M>> + Clone,
        update: &ListUpdate<'_>,
        order: &mut Vec<Place>,
    ) {
        let Self { free_points, initial, incremental } = self;
        let of =
            |is_free: bool| found.clone().filter(move |candidate| candidate.params.has_free_point == is_free);
        free_points.list.retain(|contact| update.keeps(contact));
        // By their points, so that the order of free points does not depend on that of earlier searches.
        free_points.merge(of(true), update, ClothContact::points);
        if update.refresh.is_incremental() {
            incremental.list.retain(|contact| update.keeps(contact));
            incremental.merge(of(false), update, |_| ());
        } else {
            initial.list.retain(|contact| update.keeps(contact));
            initial.list.extend(incremental.list.iter().filter(|contact| update.keeps(contact)));
            incremental.clear();
            initial.add(of(false));
            initial.sort_by_task(update.blocks, order);
        }
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

    /// One sweep. Returns the number of contacts that pushed; marks their cloths.
    pub fn sweep(&mut self, step: &ClothStep<'_, R>, has_touched: &[AtomicBool], pool: &ThreadPool) -> u64 {
        self.count(pool, |contact| {
            let has_pushed = contact.is_resolved(step) && contact.resolve(step);
            if has_pushed {
                contact.mark_cloths(has_touched);
            }
            has_pushed
        })
    }

    /// The number of contacts without certificate. Marks their cloths.
    pub fn certify(&mut self, step: &ClothStep<'_, R>, unproven: &[AtomicBool], pool: &ThreadPool) -> u64 {
        let batches = [&mut self.free_points, &mut self.initial, &mut self.incremental];
        batches.into_iter().map(|batch| batch.certify(step, unproven, pool)).sum()
    }
}

impl<R: Real, const N: usize, const M: usize> ContactBatch<R, N, M> {
    fn clear(&mut self) {
        self.list.clear();
        self.disabled = 0;
        self.colouring.clear();
        self.uncertified.clear();
    }

    /// Disables contacts of points that violated their bounds. Skips tasks between blocks without such points.
    fn disable_violated(&mut self, update: &ListUpdate<'_>, pool: &ThreadPool) {
        let Self { list, disabled, colouring: Colouring { tasks, task_blocks, .. }, .. } = self;
        let (list, count) = (DisjointSlice::new(list), AtomicU64::new(0));
        pool.parallel_for(tasks.len(), |task| {
            if task_blocks[task]
                .iter()
                .all(|&block| update.has_violations.get(block as usize) == Some(&false))
            {
                return;
            }
            // SAFETY: the runs of two tasks do not overlap.
            #[allow(unsafe_code)]
            let contacts = unsafe { list.run(tasks[task].clone()) };
            let mut disabled = 0;
            for contact in contacts {
                if !contact.is_disabled() && !update.keeps(contact) {
                    contact.disable();
                    disabled += 1;
                }
            }
            count.fetch_add(disabled, Ordering::Relaxed);
        });
        *disabled += count.into_inner() as usize;
    }

    /// Appends the contacts of candidates.
    fn add<'a>(&mut self, candidates: impl Iterator<Item = &'a Candidate<R, N, M>> + Clone) {
        self.reserve(candidates.clone().count());
        self.list.extend(candidates.map(ClothContact::new));
    }

    fn reserve(&mut self, count: usize) {
        let list = &mut self.list;
        if list.capacity() - list.len() < count {
            // A list of millions must not double.
            list.reserve_exact(count + (list.len() + count) / SPARE);
        }
    }

    /// Sorts the contacts by task.
    fn sort_by_task(&mut self, (block, blocks): Blocks<'_>, order: &mut Vec<Place>) {
        let Self { list, disabled, colouring, .. } = self;
        *disabled = 0; // retained contacts are enabled
        order.clear();
        let keys = list.iter().map(|contact| task_key(contact.points().map(|point| block[point as usize])));
        order.extend(keys.zip(0..));
        order.sort_unstable();
        permute(list, order);
        colouring.assign(order.iter().map(|place| place.0), blocks);
        self.list_uncertified();
    }

    fn list_uncertified(&mut self) {
        let Self { list, uncertified, .. } = self;
        uncertified.clear();
        uncertified
            .extend((0..).zip(&*list).filter(|(_, contact)| !contact.params.certified).map(|(at, _)| at));
    }

    /// Adds the contacts of candidates to contacts that are sorted by task, and in a task by `order`: behind those that are
    /// equal in both.
    fn merge<'a, K: Ord>(
        &mut self,
        candidates: impl Iterator<Item = &'a Candidate<R, N, M>> + Clone,
        &ListUpdate { blocks: (block, blocks), .. }: &ListUpdate<'_>,
        order: impl Fn(&ClothContact<R, N, M>) -> K,
    ) {
        let task =
            |contact: &ClothContact<R, N, M>| task_key(contact.points().map(|point| block[point as usize]));
        let key = |contact: &ClothContact<R, N, M>| (task(contact), order(contact));
        let mut incoming = std::mem::take(&mut self.incoming);
        incoming.clear();
        incoming.extend(candidates.map(ClothContact::new));
        incoming.sort_by_key(key);
        self.reserve(incoming.len());
        let Self { list, colouring, .. } = self;
        let mut sorted = list.len();
        list.extend_from_slice(&incoming);
        // From the back, so that every contact moves once.
        let mut to = list.len();
        for contact in incoming.iter().rev() {
            let own = key(contact);
            while sorted > 0 && key(&list[sorted - 1]) > own {
                (sorted, to) = (sorted - 1, to - 1);
                list[to] = list[sorted];
            }
            to -= 1;
            list[to] = *contact;
        }
        colouring.assign(list.iter().map(task), blocks);
        self.incoming = incoming;
        self.list_uncertified();
    }

    /// The number of contacts without certificate. Marks their cloths. Needs no colours, because it moves no point.
    fn certify(&mut self, step: &ClothStep<'_, R>, unproven: &[AtomicBool], pool: &ThreadPool) -> u64 {
        let count = AtomicU64::new(0);
        let Self { list, uncertified, .. } = self;
        let list = DisjointSlice::new(list);
        pool.parallel_for(uncertified.len().div_ceil(CERTIFICATES_PER_TASK), |task| {
            let own = uncertified.chunks(CERTIFICATES_PER_TASK).nth(task).unwrap_or_default();
            let mut unproven_here = 0;
            for &at in own {
                // SAFETY: every contact is listed once.
                #[allow(unsafe_code)]
                let [contact] = (unsafe { list.run(at..at + 1) }) else { continue };
                if !contact.certify(step) {
                    contact.mark_cloths(unproven);
                    unproven_here += 1;
                }
            }
            if unproven_here > 0 {
                count.fetch_add(unproven_here, Ordering::Relaxed);
            }
        });
        count.into_inner()
    }

    fn count(&mut self, pool: &ThreadPool, work: impl Fn(&mut ClothContact<R, N, M>) -> bool + Sync) -> u64 {
        let count = AtomicU64::new(0);
        let Self { list, colouring, .. } = self;
        let list = DisjointSlice::new(list);
        for colour in &colouring.colours {
            pool.parallel_for(colour.len(), |task| {
                // SAFETY: the runs of two tasks do not overlap.
                #[allow(unsafe_code)]
                let run = unsafe { list.run(colouring.tasks[colouring.task(colour, task)].clone()) };
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
