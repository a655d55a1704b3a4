//! The active set: the contacts of a cloth and a collider that can touch within the next few time steps.

use crate::contact::collider::contact::ColliderContact;
use crate::contact::collider::motion_bounds::MotionBounds;
use crate::contact::collider::plane_columns::{FourPlanes, PlaneColumns};
use crate::contact::colouring::{Colouring, Place, task_key};
use crate::contact::depenetration::Depenetration;
use crate::math::Real;
use crate::model::blocks::Blocks;
use crate::parallel::disjoint::DisjointSlice;
use crate::parallel::thread_pool::ThreadPool;

/// The active contacts of a [`ColliderContacts`](crate::contact::collider::contacts::ColliderContacts), by kind.
#[derive(Debug, Default)]
pub struct ActiveSet<R> {
    /// Of `point_face`, sorted by point.
    pub points: ActiveContacts<R, 1>,
    /// Of `edge_edge`.
    pub edges: ActiveContacts<R, 2>,
    /// Of `face_point`.
    pub faces: ActiveContacts<R, 3>,
}

impl<R: Real> ActiveSet<R> {
    pub(super) fn clear(&mut self) {
        self.points.clear();
        self.edges.clear();
        self.faces.clear();
    }
}

/// Active contacts of one kind, in the order of their tasks: the contacts of one or two blocks of the cloth.
#[derive(Debug)]
pub struct ActiveContacts<R, const N: usize> {
    /// Indices into the list of contacts.
    pub indices: Vec<u32>,
    /// Tasks of one colour share no block, and run in parallel.
    pub(super) colouring: Colouring,
    /// The planes of the contacts, a run for each task; `first_fours` holds the first four of each.
    planes: PlaneColumns<R, N>,
    first_fours: Vec<u32>,
    /// Indices of those that motion bounds do not certify over the window: they need a certificate at the end of each time
    /// step.
    pub uncertified: Vec<u32>,
    /// Scratch memory of the sort by task: contacts within each block, and between blocks.
    within: Vec<Vec<u32>>,
    between: Vec<Place>,
}

impl<R, const N: usize> Default for ActiveContacts<R, N> {
    fn default() -> Self {
        Self {
            indices: Vec::new(),
            colouring: Colouring::default(),
            planes: PlaneColumns::default(),
            first_fours: Vec::new(),
            uncertified: Vec::new(),
            within: Vec::new(),
            between: Vec::new(),
        }
    }
}

impl<R: Real, const N: usize> ActiveContacts<R, N> {
    fn clear(&mut self) {
        self.indices.clear();
        self.colouring.clear();
        self.planes.clear();
        self.first_fours.clear();
        self.uncertified.clear();
    }

    /// Lists a contact for its task.
    #[inline(always)]
    fn add<const M: usize>(&mut self, index: u32, contact: &ColliderContact<R, N, M>, blocks: &Blocks) {
        let of = contact.points.map(|point| blocks.of(point));
        let key @ [low, high] = task_key([of[0], of[1 % N], of[2 % N], of[0]]);
        match self.within.get_mut(low as usize) {
            Some(within) if low == high => within.push(index),
            _ => self.between.push((key, index)),
        }
    }

    /// Puts the listed contacts in the order of their tasks: those within each block, then those between blocks. Contacts of
    /// one task keep their order.
    fn sort_by_task(&mut self, blocks: u32) {
        let Self { indices, colouring, within, between, .. } = self;
        between.sort_unstable();
        indices.clear();
        within.iter().for_each(|within| indices.extend_from_slice(within));
        indices.extend(between.iter().map(|&(_, index)| index));
        let keys = (0..).zip(&*within).flat_map(|(block, within)| within.iter().map(move |_| [block; 2]));
        colouring.assign(keys.chain(between.iter().map(|&(key, _)| key)), blocks);
    }

    /// Copies the planes of all contacts to their columns.
    pub(super) fn copy_planes<const M: usize>(&mut self, contacts: &[ColliderContact<R, N, M>]) {
        let Self { indices, colouring, planes, first_fours, .. } = self;
        planes.clear();
        first_fours.clear();
        for task in &colouring.tasks {
            first_fours.push(planes.fours_mut().len() as u32);
            planes.add_run(contacts, &indices[task.start as usize..task.end as usize]);
        }
    }

    /// Calls `work` with the contacts of each task and their planes; tasks of one colour in parallel.
    pub(super) fn for_tasks<const M: usize>(
        &mut self,
        contacts: &mut [ColliderContact<R, N, M>],
        pool: &ThreadPool,
        work: impl Fn(DisjointSlice<'_, ColliderContact<R, N, M>>, &[u32], &mut [FourPlanes<R, N>]) + Sync,
    ) {
        let Self { indices, colouring, planes, first_fours, .. } = self;
        let (pairs, planes) = (DisjointSlice::new(contacts), DisjointSlice::new(planes.fours_mut()));
        for colour in &colouring.colours {
            pool.parallel_for(colour.len(), |at| {
                let task = colouring.task(colour, at);
                let run = colouring.tasks[task].clone();
                let run = &indices[run.start as usize..run.end as usize];
                let fours = first_fours[task]..first_fours[task] + run.len().div_ceil(4) as u32;
                // SAFETY: the runs of two tasks share no contact and no four, and those of one colour no point.
                #[allow(unsafe_code)]
                let planes = unsafe { planes.run(fours) };
                work(pairs, run, planes);
            });
        }
    }
}

/// Share of the interaction range by which the gap of an idle contact must exceed it.
const IDLE_MARGIN: f64 = 1e-3;
/// Share of the thickness above which a gap over the whole window is a certificate: far above rounding error.
pub(super) const CERTIFIED_GAP: f64 = 0.02;

/// How contacts are selected for the active set.
pub(super) struct Selection<'a, R> {
    pub(super) bounds: &'a MotionBounds<'a, R>,
    pub(super) window: [(R, [R; 3]); 2],
    /// Gaps in metres below which a contact is active, and up to which it is uncertified.
    pub(super) range: [R; 2],
    pub(super) growth: Option<&'a [R]>,
    pub(super) depenetration: &'a Depenetration,
    /// The blocks of the cloth.
    pub(super) blocks: &'a Blocks,
}

impl<R: Real> Selection<'_, R> {
    /// Selects the contacts that are active, task by task; within a task they keep this order.
    pub(super) fn select<const N: usize, const M: usize>(
        &self,
        contacts: &mut [ColliderContact<R, N, M>],
        order: impl Iterator<Item = u32>,
        active: &mut ActiveContacts<R, N>,
    ) {
        active.within.resize_with(self.blocks.len(), Vec::new);
        active.within.iter_mut().for_each(Vec::clear);
        active.between.clear();
        active.uncertified.clear();
        let [range, certified] = self.range;
        for index in order {
            let contact = &mut contacts[index as usize];
            if self.growth.is_some_and(|growth| contact.is_idle(growth)) {
                continue;
            }
            let gap = self.min_gap(contact);
            if gap < range && self.is_acting(contact) {
                active.add(index, contact, self.blocks);
                if gap <= certified {
                    active.uncertified.push(index);
                }
            }
        }
        active.sort_by_task(self.blocks.len() as u32);
        active.copy_planes(contacts);
    }

    /// The smallest gap of a contact over the window; notes until when the contact is idle.
    #[inline(always)]
    fn min_gap<const N: usize, const M: usize>(&self, contact: &mut ColliderContact<R, N, M>) -> R {
        let Some(growth) = self.growth else { return contact.min_gap(self.window, self.bounds) };
        // Around a collider at rest the gap is the same at both ends of the window.
        let gap = contact.min_gap([self.window[0]], self.bounds);
        let rounding = R::EPSILON * R::from_f64(16.0) * (gap + R::ONE);
        contact.set_idle(gap - self.range[0] * R::from_f64(1.0 + IDLE_MARGIN) - rounding, growth);
        gap
    }

    fn is_acting<const N: usize, const M: usize>(&self, contact: &ColliderContact<R, N, M>) -> bool {
        let Depenetration { points, .. } = self.depenetration;
        points.is_empty() || !contact.points.iter().any(|&point| self.depenetration.contains(point))
    }
}
