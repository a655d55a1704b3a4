//! The contacts of one cloth and one collider: all candidates of a candidate interval, the active set of the next
//! few time steps, and one Gauss-Seidel sweep over them.

use std::ops::Range;
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};

use crate::contact::collider::Boxes;
use crate::contact::collider::contact::{Certificate, ColliderContact, Outcome};
use crate::contact::collider::motion_bounds::MotionBounds;
use crate::contact::depenetration::Depenetration;
use crate::contact::material::ContactMaterial;
use crate::contact::time_step::{ColliderStep, ContactCounters};
use crate::math::{Real, Row4};
use crate::model::rows::Blocks;
use crate::parallel::disjoint::DisjointSlice;
use crate::parallel::thread_pool::ThreadPool;

/// The contacts of one cloth and one collider over a candidate interval.
#[derive(Debug)]
pub struct ColliderContacts<R> {
    /// The cloth, by its index.
    pub cloth: usize,
    /// The collider, by its index.
    pub collider: usize,
    /// Whether the two can touch in this frame. A collider that cannot has no contacts, and no influence on the cloth.
    pub is_near: bool,
    /// The candidate interval, as shares of the frame.
    pub interval: [f64; 2],
    /// Points of the cloth near faces of the collider.
    pub point_face: Vec<ColliderContact<R, 1, 3>>,
    /// Edges near edges.
    pub edge_edge: Vec<ColliderContact<R, 2, 2>>,
    /// Faces of the cloth near points of the collider.
    pub face_point: Vec<ColliderContact<R, 3, 1>>,
    /// `point_face` sorted by point: the point in the upper half, the index in the lower.
    pub by_point: Vec<u64>,
    /// The contacts that can touch within the next few time steps.
    pub active: ActiveSet,
    /// Whether each group was part of the last search.
    pub is_searched: Vec<bool>,
    /// The groups of the last search.
    pub searched_groups: Vec<u32>,
    /// The results of search tasks.
    pub tasks: Vec<Mutex<FoundContacts<R>>>,
    /// Points of the cloth that are inside the collider.
    pub depenetration: Depenetration,
}

/// Indices into the columns of a [`ColliderContacts`].
#[derive(Debug, Clone, Default)]
pub struct ActiveSet {
    /// Of `point_face`, sorted by point.
    pub point_face: Vec<u32>,
    /// The run of `point_face` that belongs to each block of the cloth.
    pub runs: Vec<Range<u32>>,
    /// Of `edge_edge`.
    pub edge_edge: Vec<u32>,
    /// Of `face_point`.
    pub face_point: Vec<u32>,
    /// Indices of `point_face`, `edge_edge` and `face_point` that motion bounds do not certify over the window:
    /// they need a certificate at the end of each time step.
    pub uncertified: [Vec<u32>; 3],
}

/// The contacts that a task finds, and its buffers.
#[derive(Debug)]
pub struct FoundContacts<R> {
    pub(super) point_face: Vec<ColliderContact<R, 1, 3>>,
    pub(super) edge_edge: Vec<ColliderContact<R, 2, 2>>,
    pub(super) face_point: Vec<ColliderContact<R, 3, 1>>,
    /// Points found behind a face.
    pub(super) suspects: Vec<u32>,
    /// Boxes of the current group.
    pub(super) boxes: Boxes,
}

impl<R> Default for FoundContacts<R> {
    fn default() -> Self {
        let boxes = Boxes::default();
        let (point_face, edge_edge, face_point) = (Vec::new(), Vec::new(), Vec::new());
        Self { point_face, edge_edge, face_point, suspects: Vec::new(), boxes }
    }
}

/// Share of the interaction range by which the gap of an idle contact must exceed it.
const IDLE_MARGIN: f64 = 1e-3;
/// Share of the thickness above which a gap over the whole window is a certificate: far above rounding error.
const CERTIFIED_GAP: f64 = 0.02;

impl<R: Real> ColliderContacts<R> {
    /// No contacts yet.
    pub fn new(cloth: usize, collider: usize) -> Self {
        let interval = [0.0, 0.0];
        Self {
            cloth,
            collider,
            is_near: true,
            interval,
            point_face: Vec::new(),
            edge_edge: Vec::new(),
            face_point: Vec::new(),
            by_point: Vec::new(),
            active: ActiveSet::default(),
            is_searched: Vec::new(),
            searched_groups: Vec::new(),
            tasks: Vec::new(),
            depenetration: Depenetration::default(),
        }
    }

    /// The number of contacts.
    pub fn len(&self) -> usize {
        self.point_face.len() + self.edge_edge.len() + self.face_point.len()
    }

    /// Removes all contacts, keeps the capacity.
    pub fn clear(&mut self) {
        self.point_face.clear();
        self.by_point.clear();
        self.edge_edge.clear();
        self.face_point.clear();
        self.active.point_face.clear();
        self.active.runs.clear();
        self.active.edge_edge.clear();
        self.active.face_point.clear();
        self.active.uncertified.iter_mut().for_each(Vec::clear);
    }

    /// Rebases all planes on anchors that move to the points' positions.
    pub fn shift_anchors(&mut self, moved: &[Row4<R>]) {
        self.point_face.iter_mut().for_each(|contact| contact.shift_anchors(moved));
        self.edge_edge.iter_mut().for_each(|contact| contact.shift_anchors(moved));
        self.face_point.iter_mut().for_each(|contact| contact.shift_anchors(moved));
    }

    /// Selects the contacts whose gap can fall below the interaction range of the material within a window of the candidate
    /// interval, by the motion bounds. Marks those that the bounds do not certify. `growth` is that of the points' window
    /// bounds in this frame, around a collider at rest and in a moving frame at rest.
    pub fn activate(
        &mut self,
        bounds: &MotionBounds<'_, R>,
        window: [f64; 2],
        material: &ContactMaterial<R>,
        growth: Option<&[R]>,
        blocks: &Blocks,
        pool: &ThreadPool,
    ) {
        let Self { interval, point_face, edge_edge, face_point, by_point, active, depenetration, .. } = self;
        let share = |time: f64| {
            if interval[1] > interval[0] { (time - interval[0]) / (interval[1] - interval[0]) } else { 0.0 }
        };
        let window = window.map(|time| (R::from_f64(share(time)), bounds.travel_at(time)));
        let all = |pairs: usize| 0..pairs as u32;
        // Two tasks of about the same length, with separate lists.
        let ActiveSet { point_face: of_points, edge_edge: of_edges, face_point: of_faces, runs, uncertified } =
            active;
        let [points_uncertified, edges_uncertified, faces_uncertified] = uncertified;
        let thickness = R::from_f64(material.thickness);
        let range = [material.adhesion_range, CERTIFIED_GAP].map(|range| thickness * R::from_f64(range));
        let selection = Selection { bounds, window, range, growth, depenetration };
        let points = Mutex::new((&mut *point_face, [&mut *of_points, points_uncertified]));
        let edges = (edge_edge, [of_edges, edges_uncertified]);
        let elements = Mutex::new((edges, (face_point, [of_faces, faces_uncertified])));
        pool.parallel_for(2, |task| match task {
            0 => {
                let Ok(mut lists) = points.lock() else { return };
                let (contacts, found) = &mut *lists;
                selection.select(contacts, by_point.iter().map(|&key| key as u32), found);
            }
            _ => {
                let Ok(mut lists) = elements.lock() else { return };
                let ((edges, of_edges), (faces, of_faces)) = &mut *lists;
                let (all_edges, all_faces) = (all(edges.len()), all(faces.len()));
                selection.select(edges, all_edges, of_edges);
                selection.select(faces, all_faces, of_faces);
            }
        });
        let place = |end: u32| {
            of_points.partition_point(|&contact| point_face[contact as usize].points[0] < end) as u32
        };
        let run = |block: usize| place(blocks.range(block).start)..place(blocks.range(block).end);
        runs.clear();
        runs.extend((0..blocks.len()).map(run));
    }
}

/// How contacts are selected for the active set.
struct Selection<'a, R> {
    bounds: &'a MotionBounds<'a, R>,
    window: [(R, [R; 3]); 2],
    /// Gaps in metres below which a contact is active, and up to which it is uncertified.
    range: [R; 2],
    growth: Option<&'a [R]>,
    depenetration: &'a Depenetration,
}

impl<R: Real> Selection<'_, R> {
    fn select<const N: usize, const M: usize>(
        &self,
        contacts: &mut [ColliderContact<R, N, M>],
        order: impl Iterator<Item = u32>,
        [active, uncertified]: &mut [&mut Vec<u32>; 2],
    ) {
        active.clear();
        uncertified.clear();
        let [range, certified] = self.range;
        for index in order {
            let contact = &mut contacts[index as usize];
            if self.growth.is_some_and(|growth| contact.is_idle(growth)) {
                continue;
            }
            let gap = self.min_gap(contact);
            if gap < range && self.is_acting(contact) {
                active.push(index);
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

/// Contacts per certification task.
const CERTIFICATES_PER_TASK: usize = 1024;
/// Rounds over the contacts of one point while they still push.
const MAX_ROUNDS: usize = 4;

/// Counts an outcome. Returns whether the contact moved anything.
fn count(counters: &ContactCounters, outcome: Outcome) -> bool {
    match outcome {
        Outcome::Separated | Outcome::Inseparable => return false,
        Outcome::Pushed => counters.contacts.fetch_add(1, Ordering::Relaxed),
        Outcome::Reverted => counters.pairs_reverted.fetch_add(1, Ordering::Relaxed),
    };
    true
}

/// One sweep over the active contacts. Points go first: on a smooth surface they carry the cloth, and edges and
/// faces, which would lift one end when the other is low, then have nothing to push. Where edges or faces push,
/// points are swept again.
pub fn resolve<R: Real>(
    list: &mut ColliderContacts<R>,
    step: &ColliderStep<'_, R>,
    pool: &ThreadPool,
    counters: &ContactCounters,
) {
    resolve_points(list, step, pool, counters);
    let ColliderContacts { edge_edge, face_point, active, .. } = list;
    let mut pushed = 0;
    for &contact in &active.edge_edge {
        pushed += usize::from(count(counters, edge_edge[contact as usize].resolve(step)));
    }
    for &contact in &active.face_point {
        pushed += usize::from(count(counters, face_point[contact as usize].resolve(step)));
    }
    if pushed > 0 {
        resolve_points(list, step, pool, counters);
    }
}

/// Counts the active contacts without certificate and the inseparable ones at the end of the step. Skips contacts
/// that motion bounds certify.
pub fn certify<R: Real>(
    list: &mut ColliderContacts<R>,
    step: &ColliderStep<'_, R>,
    pool: &ThreadPool,
) -> [u64; 2] {
    let ColliderContacts { point_face, edge_edge, face_point, active, .. } = list;
    let [points, edges, faces] = &active.uncertified;
    let of_points = certify_all(point_face, points, step, pool);
    let of_edges = certify_all(edge_edge, edges, step, pool);
    let of_faces = certify_all(face_point, faces, step, pool);
    [0, 1].map(|k| of_points[k] + of_edges[k] + of_faces[k])
}

fn certify_all<R: Real, const N: usize, const M: usize>(
    pairs: &mut [ColliderContact<R, N, M>],
    active: &[u32],
    step: &ColliderStep<'_, R>,
    pool: &ThreadPool,
) -> [u64; 2] {
    let (pairs, counts) = (DisjointSlice::new(pairs), [AtomicU64::new(0), AtomicU64::new(0)]);
    pool.parallel_for(active.len().div_ceil(CERTIFICATES_PER_TASK), |task| {
        let end = active.len().min((task + 1) * CERTIFICATES_PER_TASK);
        let mut counts_here = [0; 2];
        for &index in &active[task * CERTIFICATES_PER_TASK..end] {
            // SAFETY: a contact is active once, and certification moves no point.
            #[allow(unsafe_code)]
            let [contact] = (unsafe { pairs.run(index..index + 1) }) else { continue };
            let certificate = contact.certify(step);
            counts_here[0] += u64::from(certificate == Certificate::Unproven);
            counts_here[1] += u64::from(certificate == Certificate::Inseparable);
        }
        // Added once per task, to avoid contention.
        (0..2).for_each(|k| _ = counts[k].fetch_add(counts_here[k], Ordering::Relaxed));
    });
    counts.map(AtomicU64::into_inner)
}

/// Reverts every cloth element without certificate to its position at the start of the step, moved with the
/// surface. Calls `freeze` with its points.
pub fn revert_to_start<R: Real>(
    list: &mut ColliderContacts<R>,
    step: &ColliderStep<'_, R>,
    counters: &ContactCounters,
    freeze: &mut impl FnMut(u32),
) {
    let ColliderContacts { point_face, edge_edge, face_point, active, .. } = list;
    revert_all(point_face, &active.point_face, step, counters, freeze);
    revert_all(edge_edge, &active.edge_edge, step, counters, freeze);
    revert_all(face_point, &active.face_point, step, counters, freeze);
}

/// Calls `mark` with the points of all active contacts without certificate.
pub fn for_unproven_points<R: Real>(
    list: &mut ColliderContacts<R>,
    step: &ColliderStep<'_, R>,
    mark: &mut impl FnMut(u32),
) {
    let ColliderContacts { point_face, edge_edge, face_point, active, .. } = list;
    for_unproven_points_of(point_face, &active.point_face, step, mark);
    for_unproven_points_of(edge_edge, &active.edge_edge, step, mark);
    for_unproven_points_of(face_point, &active.face_point, step, mark);
}

fn for_unproven_points_of<R: Real, const N: usize, const M: usize>(
    pairs: &mut [ColliderContact<R, N, M>],
    active: &[u32],
    step: &ColliderStep<'_, R>,
    mark: &mut impl FnMut(u32),
) {
    for &index in active {
        let contact = &mut pairs[index as usize];
        if contact.certify(step) == Certificate::Unproven {
            contact.points.into_iter().for_each(&mut *mark);
        }
    }
}

fn revert_all<R: Real, const N: usize, const M: usize>(
    pairs: &mut [ColliderContact<R, N, M>],
    active: &[u32],
    step: &ColliderStep<'_, R>,
    counters: &ContactCounters,
    freeze: &mut impl FnMut(u32),
) {
    for &index in active {
        let contact = &mut pairs[index as usize];
        if contact.certify(step) == Certificate::Unproven {
            contact.move_with_surface(step);
            contact.points.into_iter().for_each(&mut *freeze);
            count(counters, Outcome::Reverted);
        }
    }
}

/// Sweeps point-face contacts, block by block.
fn resolve_points<R: Real>(
    list: &mut ColliderContacts<R>,
    step: &ColliderStep<'_, R>,
    pool: &ThreadPool,
    counters: &ContactCounters,
) {
    let ColliderContacts { point_face, active, .. } = list;
    let pairs = DisjointSlice::new(point_face);
    pool.parallel_for(active.runs.len(), |block| {
        let run = &active.point_face[active.runs[block].start as usize..active.runs[block].end as usize];
        // SAFETY: the runs of two blocks share no contact, and no point.
        #[allow(unsafe_code)]
        let point = |contact: u32| unsafe { pairs.get(contact).points };
        for of_point in run.chunk_by(|&a, &b| point(a) == point(b)) {
            resolve_point(pairs, of_point, step, counters);
        }
    });
}

/// Applies adhesion between every point and its nearest face.
pub fn adhere<R: Real>(list: &mut ColliderContacts<R>, step: &ColliderStep<'_, R>, pool: &ThreadPool) {
    let ColliderContacts { point_face, active, .. } = list;
    let pairs = &*point_face;
    pool.parallel_for(active.runs.len(), |block| {
        let run = &active.point_face[active.runs[block].start as usize..active.runs[block].end as usize];
        for of_point in run.chunk_by(|&a, &b| pairs[a as usize].points == pairs[b as usize].points) {
            let gaps = of_point.iter().map(|&contact| (pairs[contact as usize].gap(step), contact));
            let nearest = gaps.reduce(|least, next| if next.0 < least.0 { next } else { least });
            nearest.into_iter().for_each(|(_, contact)| pairs[contact as usize].adhere(step));
        }
    });
}

/// Repeats the contacts of one point until none pushes. A point that is still reverted in the last round moves
/// with the face that it would pass: points that move with a rigid surface pass no part of it.
fn resolve_point<R: Real>(
    pairs: DisjointSlice<'_, ColliderContact<R, 1, 3>>,
    of_point: &[u32],
    step: &ColliderStep<'_, R>,
    counters: &ContactCounters,
) {
    for round in 1..=MAX_ROUNDS {
        let (mut pushed, mut reverted) = (0, false);
        for &index in of_point {
            // SAFETY: the contacts of a point belong to the task of its block.
            #[allow(unsafe_code)]
            let [contact] = (unsafe { pairs.run(index..index + 1) }) else { continue };
            let outcome = contact.resolve(step);
            pushed += usize::from(count(counters, outcome));
            reverted |= outcome == Outcome::Reverted;
            if round == MAX_ROUNDS && outcome == Outcome::Reverted {
                return contact.move_with_surface(step);
            }
        }
        if pushed == 0 || (of_point.len() == 1 && !reverted) {
            return;
        }
    }
}
