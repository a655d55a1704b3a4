//! The active set: the contacts of a cloth and a collider that can touch within the next few time steps.

use std::ops::Range;

use crate::contact::collider::contact::ColliderContact;
use crate::contact::collider::contact_list::{ContactList, IdleUntil, PLACES_PER_TASK};
use crate::contact::collider::motion_bounds::MotionBounds;
use crate::contact::collider::plane_columns::{FourPlanes, PlaneColumns};
use crate::contact::collider::selected::{Ranks, Selected, merge};
use crate::contact::colouring::{Colouring, task_key};
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

    /// Selects the active contacts of all kinds.
    pub(super) fn select(
        &mut self,
        selection: &Selection<'_, R>,
        point_face: &mut ContactList<R, 1, 3>,
        edge_edge: &mut ContactList<R, 2, 2>,
        face_point: &mut ContactList<R, 3, 1>,
        pool: &ThreadPool,
    ) {
        let counts @ [all_points, all_edges, all_faces] =
            [point_face.len(), edge_edge.len(), face_point.len()];
        let [of_points, of_edges, of_faces] = counts.map(|contacts| contacts.div_ceil(PLACES_PER_TASK));
        let points = self.points.begin_selection(of_points);
        let edges = self.edges.begin_selection(of_edges);
        let faces = self.faces.begin_selection(of_faces);
        let own = |task: usize, contacts: usize| {
            (task * PLACES_PER_TASK) as u32..((task + 1) * PLACES_PER_TASK).min(contacts) as u32
        };
        let lists = (shared(point_face), shared(edge_edge), shared(face_point));
        pool.parallel_for(of_points + of_edges + of_faces, |task| {
            if let Some(task) = task.checked_sub(of_points + of_edges) {
                selection.select(lists.2, own(task, all_faces), (faces, task));
            } else if let Some(task) = task.checked_sub(of_points) {
                selection.select(lists.1, own(task, all_edges), (edges, task));
            } else {
                selection.select(lists.0, own(task, all_points), (points, task));
            }
        });
        self.points.merge(selection.blocks, pool);
        self.points.sort_by_point(point_face, pool);
        self.edges.merge(selection.blocks, pool);
        self.faces.merge(selection.blocks, pool);
    }
}

/// Active contacts of one kind, in the order of their tasks.
#[derive(Debug)]
pub struct ActiveContacts<R, const N: usize> {
    /// Indices into the list of contacts.
    pub indices: Vec<u32>,
    /// Tasks of one colour share no point, and run in parallel.
    pub(super) colouring: Colouring,
    /// The planes of the contacts, a run for each task; `first_fours` holds the first four of each.
    planes: PlaneColumns<R, N>,
    first_fours: Vec<u32>,
    /// Indices of those that motion bounds do not certify over the window: they need a certificate at the end of each time
    /// step.
    pub uncertified: Vec<u32>,
    /// What the tasks of a selection have found.
    selected: Vec<Selected>,
    /// Scratch memory.
    ranks: Ranks,
}

impl<R, const N: usize> Default for ActiveContacts<R, N> {
    fn default() -> Self {
        Self {
            indices: Vec::new(),
            colouring: Colouring::default(),
            planes: PlaneColumns::default(),
            first_fours: Vec::new(),
            uncertified: Vec::new(),
            selected: Vec::new(),
            ranks: Ranks::default(),
        }
    }
}

/// Points in a run, where contacts move a single point and need not keep to the blocks of the cloth.
const POINTS_PER_RUN: u32 = 128;

impl<R: Real, const N: usize> ActiveContacts<R, N> {
    fn clear(&mut self) {
        self.indices.clear();
        self.colouring.clear();
        self.planes.clear();
        self.first_fours.clear();
        self.uncertified.clear();
    }

    /// The runs of points whose contacts form tasks.
    fn runs(blocks: &Blocks) -> u32 {
        if N == 1 { blocks.rows().len() as u32 / POINTS_PER_RUN + 1 } else { blocks.len() as u32 }
    }

    /// The task of a contact, by the runs of its points.
    #[inline(always)]
    fn task_of(points: [u32; N], blocks: &Blocks) -> [u32; 2] {
        if N == 1 {
            return [(points[0] - blocks.rows().start) / POINTS_PER_RUN; 2];
        }
        let of = points.map(|point| blocks.of(point));
        task_key([of[0], of[1 % N], of[2 % N], of[0]])
    }

    /// Room for the results of `tasks` selection tasks.
    fn begin_selection(&mut self, tasks: usize) -> DisjointSlice<'_, Selected> {
        self.selected.resize_with(self.selected.len().max(tasks), Selected::default);
        self.selected[tasks..].iter_mut().for_each(Selected::clear);
        DisjointSlice::new(&mut self.selected)
    }

    /// Puts the selected contacts in the order of their tasks.
    fn merge(&mut self, blocks: &Blocks, pool: &ThreadPool) {
        let runs = Self::runs(blocks);
        let Self { indices, colouring, uncertified, selected, ranks, .. } = self;
        merge(selected, ranks, (indices, uncertified), (colouring, runs), pool);
    }

    /// Sorts the contacts of each task by point.
    fn sort_by_point<const M: usize>(&mut self, contacts: &[ColliderContact<R, N, M>], pool: &ThreadPool) {
        let (tasks, indices) = (&self.colouring.tasks, DisjointSlice::new(&mut self.indices));
        pool.parallel_for(tasks.len(), |at| {
            // SAFETY: tasks share no contact.
            #[allow(unsafe_code)]
            let run = unsafe { indices.run(tasks[at].clone()) };
            run.sort_unstable_by_key(|&index| (contacts[index as usize].points, index));
        });
    }

    /// Copies the planes of all contacts to their columns.
    pub(super) fn copy_planes<const M: usize>(
        &mut self,
        contacts: &[ColliderContact<R, N, M>],
        pool: &ThreadPool,
    ) {
        let Self { indices, colouring: Colouring { tasks, .. }, planes, first_fours, .. } = self;
        first_fours.clear();
        let mut fours = 0;
        for task in &*tasks {
            first_fours.push(fours);
            fours += task.len().div_ceil(4) as u32;
        }
        planes.resize(fours as usize);
        let columns = DisjointSlice::new(planes.fours_mut());
        pool.parallel_for(tasks.len(), |at| {
            let run = &indices[tasks[at].start as usize..tasks[at].end as usize];
            let fours = first_fours[at]..first_fours[at] + run.len().div_ceil(4) as u32;
            // SAFETY: the runs of two tasks share no four.
            #[allow(unsafe_code)]
            FourPlanes::copy_run(unsafe { columns.run(fours) }, contacts, run);
        });
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

/// The columns of a list of contacts, which tasks share.
type Columns<'a, R, const N: usize, const M: usize> =
    (DisjointSlice<'a, ColliderContact<R, N, M>>, DisjointSlice<'a, IdleUntil<R, N>>);

fn shared<R: Real, const N: usize, const M: usize>(
    contacts: &mut ContactList<R, N, M>,
) -> Columns<'_, R, N, M> {
    let (places, idle) = contacts.columns_mut();
    (DisjointSlice::new(places), DisjointSlice::new(idle))
}

/// Share of the interaction range by which the gap of an idle contact must exceed it.
const IDLE_MARGIN: f64 = 1e-3;

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
    /// Selects the contacts that are active, among those whose indices are given, for a task.
    pub(super) fn select<const N: usize, const M: usize>(
        &self,
        (contacts, idle): Columns<'_, R, N, M>,
        among: Range<u32>,
        (results, task): (DisjointSlice<'_, Selected>, usize),
    ) {
        // SAFETY: every task has a result of its own.
        #[allow(unsafe_code)]
        let [found] = (unsafe { results.run(task as u32..task as u32 + 1) }) else { return };
        found.clear();
        let [range, certified] = self.range;
        // SAFETY: a contact belongs to one task.
        #[allow(unsafe_code)]
        let (contacts, idle) = unsafe { (contacts.run(among.clone()), idle.run(among.clone())) };
        for ((index, contact), idle) in among.zip(contacts).zip(idle) {
            if idle.is_vacant() || self.growth.is_some_and(|growth| idle.is_idle(growth)) {
                continue;
            }
            let gap = self.min_gap(contact, idle);
            if gap < range && self.is_acting(contact) {
                let task = ActiveContacts::<R, N>::task_of(contact.points, self.blocks);
                found.push(task, index, gap > certified);
            }
        }
    }

    /// The smallest gap of a contact over the window; notes until when the contact is idle.
    #[inline(always)]
    fn min_gap<const N: usize, const M: usize>(
        &self,
        contact: &ColliderContact<R, N, M>,
        idle: &mut IdleUntil<R, N>,
    ) -> R {
        let Some(growth) = self.growth else { return contact.min_gap(self.window, self.bounds) };
        // Around a collider at rest the gap is the same at both ends of the window.
        let gap = contact.min_gap([self.window[0]], self.bounds);
        let rounding = R::EPSILON * R::from_f64(16.0) * (gap + R::ONE);
        idle.set(gap - self.range[0] * R::from_f64(1.0 + IDLE_MARGIN) - rounding, growth);
        gap
    }

    fn is_acting<const N: usize, const M: usize>(&self, contact: &ColliderContact<R, N, M>) -> bool {
        let Depenetration { points, .. } = self.depenetration;
        points.is_empty() || !contact.points.iter().any(|&point| self.depenetration.contains(point))
    }
}
