//! Contacts of one kind, laid out in tasks.

use std::sync::atomic::{AtomicU64, Ordering};

use super::near::{Motion, Near};
use super::tasks::Tasks;
use crate::bytes::checkpoint_struct;
use crate::math::Real;
use crate::parallel::disjoint::DisjointSlice;
use crate::parallel::thread_pool::ThreadPool;

/// Contacts of one kind, in batches that are worked on one after the other.
#[derive(Debug)]
pub struct Contacts<R, const N: usize, const M: usize> {
    /// Those of free points. They come together in any order, and much comes of it: they meet in the order of their numbers,
    /// so that what is far away has no say in it.
    free: Batch<R, N, M>,
    /// Cloth that was near as the span began, in the order in which it was found.
    early: Batch<R, N, M>,
    /// Cloth that came near later.
    late: Batch<R, N, M>,
    /// Those of free points, and those of cloth, that are to be laid out.
    found: [Vec<Near<R, N, M>>; 2],
}

/// Contacts in the order of their tasks.
#[derive(Debug)]
struct Batch<R, const N: usize, const M: usize> {
    list: Vec<Near<R, N, M>>,
    tasks: Tasks,
}

checkpoint_struct!([R: Real, const N: usize, const M: usize] Contacts<R, N, M> {
    columns: [], values: [], parts: [free, early, late], rebuilt: [found],
});

// Tasks are laid out anew as the next span begins.
checkpoint_struct!([R: Real, const N: usize, const M: usize] Batch<R, N, M> {
    columns: [], values: [list], parts: [], rebuilt: [tasks],
});

impl<R, const N: usize, const M: usize> Default for Contacts<R, N, M> {
    fn default() -> Self {
        Self {
            free: Batch::default(),
            early: Batch::default(),
            late: Batch::default(),
            found: Default::default(),
        }
    }
}

impl<R, const N: usize, const M: usize> Default for Batch<R, N, M> {
    fn default() -> Self {
        Self { list: Vec::new(), tasks: Tasks::default() }
    }
}

/// The block that each point is in, and how many there are.
pub type Blocks<'a> = (&'a [u32], u32);

impl<R: Real, const N: usize, const M: usize> Contacts<R, N, M> {
    /// All contacts.
    pub fn iter(&self) -> impl Iterator<Item = &Near<R, N, M>> {
        let batches = [&self.free, &self.early, &self.late];
        batches.into_iter().flat_map(|batch| &batch.list).filter(|near| !near.is_off())
    }

    /// The same, to work on.
    pub fn iter_mut(&mut self) -> impl Iterator<Item = &mut Near<R, N, M>> {
        let batches = [&mut self.free, &mut self.early, &mut self.late];
        batches.into_iter().flat_map(|batch| &mut batch.list).filter(|near| !near.is_off())
    }

    /// Reckons from anchors where they are now.
    pub fn follow(&mut self, anchors: &[[f64; 3]]) {
        self.iter_mut().for_each(|near| near.follow(anchors));
    }

    /// Lets go of what points had that `strayed`. As a span begins, all others are to be laid out anew; later those that are
    /// there already stay where they are.
    pub fn begin(&mut self, strayed: &[bool], is_late: bool) {
        let Self { free, early, late, found } = self;
        let stays = |near: &Near<R, N, M>| {
            !near.is_off() && !near.points().iter().any(|&point| strayed[point as usize])
        };
        let [of_points, of_cloth] = found;
        of_points.clear();
        of_points.extend(free.list.iter().filter(|near| stays(near)));
        of_cloth.clear();
        if is_late {
            early.list.iter_mut().filter(|near| !stays(near)).for_each(Near::switch_off);
        } else {
            of_cloth.extend(early.list.iter().filter(|near| stays(near)));
            early.clear();
        }
        of_cloth.extend(late.list.iter().filter(|near| stays(near)));
        late.clear();
    }

    /// Takes up what was found.
    pub fn take(&mut self, more: &[Near<R, N, M>]) {
        let [of_points, of_cloth] = &mut self.found;
        of_points.extend(more.iter().filter(|near| near.is_swept()));
        of_cloth.extend(more.iter().filter(|near| !near.is_swept()));
    }

    /// Lays out what there is now.
    pub fn lay_out(&mut self, is_late: bool, blocks: Blocks<'_>) {
        let Self { free, early, late, found: [of_points, of_cloth] } = self;
        of_points.sort_by_key(Near::points);
        free.lay_out(of_points, blocks);
        if is_late { late } else { early }.lay_out(of_cloth, blocks);
    }

    /// Calls `work` with each contact, tasks side by side; how often it said yes.
    pub fn count(&mut self, pool: &ThreadPool, work: impl Fn(&mut Near<R, N, M>) -> bool + Sync) -> u64 {
        let batches = [&mut self.free, &mut self.early, &mut self.late];
        batches.into_iter().map(|batch| batch.count(pool, &work)).sum()
    }

    /// Pushes apart what is too near, once; how many were.
    pub fn sweep(&mut self, step: &Motion<'_, R>, pool: &ThreadPool) -> u64 {
        self.count(pool, |near| near.resolve(step))
    }

    /// How many contacts are not proven.
    pub fn prove(&mut self, step: &Motion<'_, R>, pool: &ThreadPool) -> u64 {
        self.count(pool, |near| !near.prove(step))
    }
}

impl<R: Real, const N: usize, const M: usize> Batch<R, N, M> {
    fn clear(&mut self) {
        self.list.clear();
        self.tasks.clear();
    }

    /// Puts what was found in the order of its tasks.
    fn lay_out(&mut self, found: &[Near<R, N, M>], (block, blocks): Blocks<'_>) {
        let of_points = found.iter().map(|near| near.points().map(|point| block[point as usize]));
        self.tasks.lay_out(of_points, blocks);
        self.list.clear();
        self.list.extend(self.tasks.order.iter().map(|&(_, at)| found[at as usize]));
    }

    fn count(&mut self, pool: &ThreadPool, work: impl Fn(&mut Near<R, N, M>) -> bool + Sync) -> u64 {
        let count = AtomicU64::new(0);
        let Self { list, tasks } = self;
        let list = DisjointSlice::new(list);
        for phase in &tasks.phases {
            pool.parallel_for(phase.len(), |task| {
                // SAFETY: runs of two tasks do not overlap.
                #[allow(unsafe_code)]
                let run = unsafe { list.run(tasks.run(phase, task)) };
                let mut yes = 0;
                for near in run {
                    yes += u64::from(work(near));
                }
                if yes > 0 {
                    count.fetch_add(yes, Ordering::Relaxed);
                }
            });
        }
        count.into_inner()
    }
}
