//! The contacts of one cloth and one collider: all candidates of a candidate interval; and their certificates.

use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

use crate::contact::ccd::CERTIFIED_GAP;
use crate::contact::collider::Boxes;
use crate::contact::collider::active_set::{ActiveSet, Selection};
use crate::contact::collider::candidates::OverlappingPair;
use crate::contact::collider::contact::{Certificate, ColliderContact, Outcome};
use crate::contact::collider::contact_list::ContactList;
use crate::contact::collider::motion_bounds::MotionBounds;
use crate::contact::depenetration::Depenetration;
use crate::contact::material::ContactMaterial;
use crate::contact::time_step::{ColliderStep, ContactCounters};
use crate::math::{Real, Row4};
use crate::model::blocks::Blocks;
use crate::parallel::disjoint::DisjointSlice;
use crate::parallel::thread_pool::ThreadPool;
use crate::schedule::TimeInterval;

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
    pub interval: TimeInterval,
    /// Points of the cloth near faces of the collider.
    pub point_face: ContactList<R, 1, 3>,
    /// Edges near edges.
    pub edge_edge: ContactList<R, 2, 2>,
    /// Faces of the cloth near points of the collider.
    pub face_point: ContactList<R, 3, 1>,
    /// The contacts that can touch within the next few time steps.
    pub active: ActiveSet<R>,
    /// The results of search tasks.
    pub tasks: Vec<FoundContacts<R>>,
    /// Points of the cloth that are inside the collider.
    pub depenetration: Depenetration,
    /// Points with a contact without certificate, at the last certification.
    pub unproven: Vec<u32>,
}

/// The contacts that a task finds, and its buffers.
#[derive(Debug)]
pub struct FoundContacts<R> {
    pub(super) point_face: FoundPairs<R, 1, 3>,
    pub(super) edge_edge: FoundPairs<R, 2, 2>,
    pub(super) face_point: FoundPairs<R, 3, 1>,
    /// Points found behind a face.
    pub(super) suspects: Vec<u32>,
    /// Boxes of the current group.
    pub(super) boxes: Boxes,
}

/// Pairs of elements of one kind.
#[derive(Debug)]
pub struct FoundPairs<R, const N: usize, const M: usize> {
    /// Those that can touch.
    pub(super) contacts: Vec<ColliderContact<R, N, M>>,
    /// Those whose boxes overlap.
    pub(super) overlapping: Vec<OverlappingPair<N, M>>,
}

impl<R, const N: usize, const M: usize> Default for FoundPairs<R, N, M> {
    fn default() -> Self {
        Self { contacts: Vec::new(), overlapping: Vec::new() }
    }
}

impl<R> Default for FoundContacts<R> {
    fn default() -> Self {
        let (point_face, edge_edge, face_point) = Default::default();
        Self { point_face, edge_edge, face_point, suspects: Vec::new(), boxes: Boxes::default() }
    }
}

impl<R> FoundContacts<R> {
    /// Removes all, keeps the capacity.
    pub(super) fn clear(&mut self) {
        self.point_face.contacts.clear();
        self.edge_edge.contacts.clear();
        self.face_point.contacts.clear();
        self.suspects.clear();
    }
}

impl<R: Real> ColliderContacts<R> {
    /// No contacts yet.
    pub fn new(cloth: usize, collider: usize) -> Self {
        let interval = TimeInterval::EXPIRED;
        Self {
            cloth,
            collider,
            is_near: true,
            interval,
            point_face: ContactList::default(),
            edge_edge: ContactList::default(),
            face_point: ContactList::default(),
            active: ActiveSet::default(),
            tasks: Vec::new(),
            depenetration: Depenetration::default(),
            unproven: Vec::new(),
        }
    }

    /// The number of contacts.
    pub fn len(&self) -> usize {
        self.point_face.count() + self.edge_edge.count() + self.face_point.count()
    }

    /// Removes all contacts, keeps the capacity.
    pub fn clear(&mut self) {
        self.point_face.clear();
        self.edge_edge.clear();
        self.face_point.clear();
        self.active.clear();
    }

    /// Rebases all planes on anchors that move to the points' positions.
    pub fn shift_anchors(&mut self, moved: &[Row4<R>]) {
        self.point_face.shift_anchors(moved);
        self.edge_edge.shift_anchors(moved);
        self.face_point.shift_anchors(moved);
    }

    /// Selects the contacts whose gap can fall below the interaction range of the material within a window of the candidate
    /// interval, by the motion bounds. Marks those that the bounds do not certify. `growth` is that of the points' window
    /// bounds in this frame, around a collider at rest and in a moving frame at rest.
    pub fn activate(
        &mut self,
        bounds: &MotionBounds<'_, R>,
        window: TimeInterval,
        material: &ContactMaterial<R>,
        growth: Option<&[R]>,
        blocks: &Blocks,
        pool: &ThreadPool,
    ) {
        let Self { interval, point_face, edge_edge, face_point, active, depenetration, .. } = self;
        let window = window.ends().map(|time| (R::from_f64(interval.share_of(time)), bounds.travel_at(time)));
        let thickness = R::from_f64(material.thickness);
        let range = [material.adhesion_range, CERTIFIED_GAP].map(|range| thickness * R::from_f64(range));
        let selection = Selection { bounds, window, range, growth, depenetration, blocks };
        active.select(&selection, point_face, edge_edge, face_point, pool);
        self.copy_planes(pool);
    }

    /// Copies the planes of all active contacts to their columns.
    pub(super) fn copy_planes(&mut self, pool: &ThreadPool) {
        let Self { point_face, edge_edge, face_point, active, .. } = self;
        active.points.copy_planes(point_face, pool);
        active.edges.copy_planes(edge_edge, pool);
        active.faces.copy_planes(face_point, pool);
    }
}

/// Contacts per certification task.
const CERTIFICATES_PER_TASK: usize = 1024;

/// Counts the active contacts without certificate and the inseparable ones at the end of the step. Skips contacts
/// that motion bounds certify.
pub fn certify<R: Real>(
    list: &mut ColliderContacts<R>,
    step: &ColliderStep<'_, R>,
    pool: &ThreadPool,
) -> [u64; 2] {
    let ColliderContacts { point_face, edge_edge, face_point, active, .. } = list;
    let certification = Certification::default();
    certification.certify_all(point_face, &active.points.uncertified, step, pool);
    certification.certify_all(edge_edge, &active.edges.uncertified, step, pool);
    certification.certify_all(face_point, &active.faces.uncertified, step, pool);
    let Certification { counts, has_new_plane, unproven } = certification;
    list.unproven.clear();
    list.unproven.extend(unproven.into_inner().unwrap_or_default());
    if has_new_plane.into_inner() {
        list.copy_planes(pool);
    }
    counts.map(AtomicU64::into_inner)
}

/// The results of certification.
#[derive(Default)]
struct Certification {
    /// Contacts without certificate, and inseparable ones.
    counts: [AtomicU64; 2],
    /// Whether any contact was certified along a plane that it did not have.
    has_new_plane: AtomicBool,
    /// Points with a contact without certificate, in any order.
    unproven: Mutex<Vec<u32>>,
}

impl Certification {
    fn certify_all<R: Real, const N: usize, const M: usize>(
        &self,
        pairs: &mut [ColliderContact<R, N, M>],
        active: &[u32],
        step: &ColliderStep<'_, R>,
        pool: &ThreadPool,
    ) {
        let pairs = DisjointSlice::new(pairs);
        pool.parallel_for(active.len().div_ceil(CERTIFICATES_PER_TASK), |task| {
            let end = active.len().min((task + 1) * CERTIFICATES_PER_TASK);
            let (mut counts_here, mut has_new_plane, mut unproven) = ([0; 2], false, Vec::new());
            for &index in &active[task * CERTIFICATES_PER_TASK..end] {
                // SAFETY: a contact is active once, and certification moves no point.
                #[allow(unsafe_code)]
                let [contact] = (unsafe { pairs.run(index..index + 1) }) else { continue };
                let normal = contact.normal;
                let certificate = contact.certify(step);
                counts_here[0] += u64::from(certificate == Certificate::Unproven);
                if N == 1 && certificate == Certificate::Unproven {
                    unproven.push(contact.points[0]);
                }
                counts_here[1] += u64::from(certificate == Certificate::Inseparable);
                has_new_plane |= contact.normal != normal;
            }
            // Added once per task, to avoid contention.
            (0..2).for_each(|k| _ = self.counts[k].fetch_add(counts_here[k], Ordering::Relaxed));
            self.has_new_plane.fetch_or(has_new_plane, Ordering::Relaxed);
            if !unproven.is_empty()
                && let Ok(mut all) = self.unproven.lock()
            {
                all.append(&mut unproven);
            }
        });
    }
}

/// Reverts every cloth element without certificate to its position at the start of the step, moved with the
/// surface. Calls `freeze` with its points.
pub fn revert_to_start<R: Real>(
    list: &mut ColliderContacts<R>,
    step: &ColliderStep<'_, R>,
    pool: &ThreadPool,
    counters: &ContactCounters,
    freeze: &mut impl FnMut(u32),
) {
    let ColliderContacts { point_face, edge_edge, face_point, active, .. } = list;
    revert_all(point_face, &active.points.indices, step, counters, freeze);
    revert_all(edge_edge, &active.edges.indices, step, counters, freeze);
    revert_all(face_point, &active.faces.indices, step, counters, freeze);
    list.copy_planes(pool);
}

/// Calls `mark` with the points of all active contacts without certificate.
pub fn for_unproven_points<R: Real>(
    list: &mut ColliderContacts<R>,
    step: &ColliderStep<'_, R>,
    pool: &ThreadPool,
    mark: &mut impl FnMut(u32),
) {
    let ColliderContacts { point_face, edge_edge, face_point, active, .. } = list;
    for_unproven_points_of(point_face, &active.points.indices, step, mark);
    for_unproven_points_of(edge_edge, &active.edges.indices, step, mark);
    for_unproven_points_of(face_point, &active.faces.indices, step, mark);
    list.copy_planes(pool);
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
            Outcome::Reverted.count(counters);
        }
    }
}
