//! What the lists of links have in common: loops over their batches, and their loads.

use nalgebra::Vector3;

use crate::math::Real;
use crate::model::rows::{RowBatch, RowList};
use crate::parallel::disjoint::DisjointSlice;
use crate::parallel::thread_pool::ThreadPool;

use super::rows::{NO_LINK, VectorGroup};

/// Does `work` on all batches of a list that spans several cloths, in order or backward.
pub(super) fn for_batches<G: Sync>(
    list: &RowList<G>,
    blocks: usize,
    backward: bool,
    pool: &ThreadPool,
    work: impl Fn(RowBatch) + Sync,
) {
    let colours = list.interface_colours();
    if !backward {
        pool.parallel_for(blocks, |block| work(RowBatch::Interior(block)));
    }
    for k in 0..colours {
        let colour = if backward { colours - 1 - k } else { k };
        pool.parallel_for(list.interface_tasks(colour), |task| work(RowBatch::Interface(colour, task)));
    }
    if backward {
        pool.parallel_for(blocks, |block| work(RowBatch::Interior(block)));
    }
}

/// Impulses of links since the start of the substep in N·s, an entry per lane group; empty where nothing can break.
#[derive(Debug, Clone)]
pub(super) struct Loads<R>(Vec<VectorGroup<R>>);

impl<R> Default for Loads<R> {
    fn default() -> Self {
        Self(Vec::new())
    }
}

impl<R: Real> Loads<R> {
    pub(super) fn new(can_break: bool, groups: usize) -> Self {
        Self(vec![[[R::ZERO; 4]; 3]; if can_break { groups } else { 0 }])
    }

    /// Calls `each` with every link and the impulse that it carried, and starts anew.
    pub(super) fn take<'a>(
        &mut self,
        links: impl Iterator<Item = &'a [u32; 4]>,
        mut each: impl FnMut(u32, Vector3<f64>),
    ) {
        for (links, impulse) in links.zip(&mut self.0) {
            for lane in (0..4).filter(|&lane| links[lane] != NO_LINK) {
                each(links[lane], Vector3::from([0, 1, 2].map(|axis| impulse[axis][lane].to_f64())));
            }
            *impulse = [[R::ZERO; 4]; 3];
        }
    }

    /// For the tasks of a loop.
    pub(super) fn share(&mut self) -> SharedLoads<'_, R> {
        SharedLoads { exist: !self.0.is_empty(), all: DisjointSlice::new(&mut self.0) }
    }
}

/// Loads that tasks write disjointly.
#[derive(Clone, Copy)]
pub(super) struct SharedLoads<'a, R> {
    exist: bool,
    all: DisjointSlice<'a, VectorGroup<R>>,
}

impl<R> SharedLoads<'_, R> {
    /// The loads of `count` lane groups from `first` on; `None` where nothing can break.
    ///
    /// # Safety
    /// No other task has the same lane groups.
    #[allow(unsafe_code, clippy::mut_from_ref)]
    pub(super) unsafe fn of(&self, first: usize, count: usize) -> Option<&mut [VectorGroup<R>]> {
        // SAFETY: the caller's promise.
        self.exist.then(|| unsafe { self.all.run(first as u32..(first + count) as u32) })
    }
}
