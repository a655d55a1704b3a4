//! The active set: the contacts of a cloth and a collider that can touch within the next few time steps.

use crate::contact::collider::contact::ColliderContact;
use crate::contact::collider::motion_bounds::MotionBounds;
use crate::contact::collider::plane_columns::{FourPlanes, PlaneColumns};
use crate::contact::colouring::{Colouring, Place, SERIAL, task_key};
use crate::contact::depenetration::Depenetration;
use crate::math::Real;
use crate::model::blocks::Blocks;
use crate::parallel::disjoint::DisjointSlice;
use crate::parallel::thread_pool::ThreadPool;

/// Contacts per selection task.
const CONTACTS_PER_TASK: usize = 1024;

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

    /// Selects the active contacts of all kinds. `by_point` holds the indices of point-face contacts, by point, in its lower
    /// halves.
    pub(super) fn select(
        &mut self,
        selection: &Selection<'_, R>,
        (point_face, by_point): (&mut [ColliderContact<R, 1, 3>], &[u64]),
        edge_edge: &mut [ColliderContact<R, 2, 2>],
        face_point: &mut [ColliderContact<R, 3, 1>],
        pool: &ThreadPool,
    ) {
        let [of_points, of_edges, of_faces] = [by_point.len(), edge_edge.len(), face_point.len()]
            .map(|contacts| contacts.div_ceil(CONTACTS_PER_TASK));
        let points = self.points.begin_selection(of_points);
        let edges = self.edges.begin_selection(of_edges);
        let faces = self.faces.begin_selection(of_faces);
        let own = |task: usize, contacts: usize| {
            (task * CONTACTS_PER_TASK) as u32..((task + 1) * CONTACTS_PER_TASK).min(contacts) as u32
        };
        let (all_edges, all_faces) = (edge_edge.len(), face_point.len());
        let lists =
            (DisjointSlice::new(point_face), DisjointSlice::new(edge_edge), DisjointSlice::new(face_point));
        pool.parallel_for(of_points + of_edges + of_faces, |task| {
            if let Some(task) = task.checked_sub(of_points + of_edges) {
                selection.select(lists.2, own(task, all_faces), (faces, task));
            } else if let Some(task) = task.checked_sub(of_points) {
                selection.select(lists.1, own(task, all_edges), (edges, task));
            } else {
                let run = own(task, by_point.len());
                let among = by_point[run.start as usize..run.end as usize].iter().map(|&key| key as u32);
                selection.select(lists.0, among, (points, task));
            }
        });
        self.points.sort_by_task(ActiveContacts::<R, 1>::runs(selection.blocks));
        self.edges.sort_by_task(ActiveContacts::<R, 2>::runs(selection.blocks));
        self.faces.sort_by_task(ActiveContacts::<R, 3>::runs(selection.blocks));
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
    /// Scratch memory of the sort by task: the number of contacts within each run of points, and contacts between runs.
    counts: Vec<u32>,
    between: Vec<Place>,
}

/// The active contacts among those of a selection task: their places in the order of tasks, and the indices of uncertified
/// ones.
#[derive(Debug, Default)]
pub(super) struct Selected {
    places: Vec<Place>,
    uncertified: Vec<u32>,
}

impl Selected {
    fn clear(&mut self) {
        self.places.clear();
        self.uncertified.clear();
    }
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
            counts: Vec::new(),
            between: Vec::new(),
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

    /// Puts the selected contacts in the order of their tasks: those within each run of points, then those between runs.
    /// Contacts of one task keep their order.
    fn sort_by_task(&mut self, runs: u32) {
        let Self { indices, colouring, uncertified, selected, counts, between, .. } = self;
        counts.clear();
        counts.resize(runs as usize + 1, 0);
        between.clear();
        uncertified.clear();
        for found in &*selected {
            uncertified.extend_from_slice(&found.uncertified);
            for &(key, index) in &found.places {
                match is_within(key) {
                    true => counts[key[0] as usize + 1] += 1,
                    false => between.push((key, index)),
                }
            }
        }
        between.sort_unstable();
        for run in 1..counts.len() {
            counts[run] += counts[run - 1];
        }
        let within = counts[runs as usize];
        let keys = (0..runs)
            .zip(counts.windows(2))
            .flat_map(|(run, ends)| (ends[0]..ends[1]).map(move |_| [run; 2]));
        colouring.assign(keys.chain(between.iter().map(|&(key, _)| key)), runs);
        indices.clear();
        indices.resize(within as usize, 0);
        for &(key, index) in
            selected.iter().flat_map(|found| &found.places).filter(|(key, _)| is_within(*key))
        {
            let to = &mut counts[key[0] as usize];
            indices[*to as usize] = index;
            *to += 1;
        }
        indices.extend(between.iter().map(|&(_, index)| index));
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

/// Whether a task is that of the contacts within one run of points.
fn is_within(key: [u32; 2]) -> bool {
    key[0] == key[1] && key != SERIAL
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
        contacts: DisjointSlice<'_, ColliderContact<R, N, M>>,
        among: impl Iterator<Item = u32>,
        (results, task): (DisjointSlice<'_, Selected>, usize),
    ) {
        // SAFETY: every task has a result of its own.
        #[allow(unsafe_code)]
        let [Selected { places, uncertified }] = (unsafe { results.run(task as u32..task as u32 + 1) })
        else {
            return;
        };
        places.clear();
        uncertified.clear();
        let [range, certified] = self.range;
        for index in among {
            // SAFETY: a contact belongs to one task.
            #[allow(unsafe_code)]
            let [contact] = (unsafe { contacts.run(index..index + 1) }) else { continue };
            if self.growth.is_some_and(|growth| contact.is_idle(growth)) {
                continue;
            }
            let gap = self.min_gap(contact);
            if gap < range && self.is_acting(contact) {
                places.push((ActiveContacts::<R, N>::task_of(contact.points, self.blocks), index));
                if gap <= certified {
                    uncertified.push(index);
                }
            }
        }
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
