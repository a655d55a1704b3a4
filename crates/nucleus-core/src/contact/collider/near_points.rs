//! Free points near colliders: their contacts live for one time step, within one task.
//!
//! A point without faces and links that touches no other cloth depends on nothing but its own contacts. They are searched
//! when it has moved, resolved and certified before the task goes on to the next points, so no list of them is kept.

use std::ops::Range;

use crate::contact::collider::contact::ColliderContact;
use crate::contact::collider::motion_bounds::{MotionBounds, MotionBox, box_contains};
use crate::contact::collider::near_collider::{NearCollider, place_box};
use crate::contact::collider::near_search::{Search, search_bound};
use crate::contact::time_step::{ColliderStep, ContactCounters};
use crate::math::Real;

/// A point near a collider.
#[derive(Debug, Clone, Copy)]
pub struct NearPoint<R> {
    pub(super) point: u32,
    /// The collider, by its place in the pass.
    collider: usize,
    /// Displacements for which its contacts are complete, in metres.
    bound: MotionBox<R>,
    /// Its contacts.
    pub(super) contacts: [u32; 2],
    /// Whether it passes the face of the first of them.
    pub(super) passes: bool,
    /// The exit face of a point inside.
    pub(super) exit: Option<u32>,
}

impl<R: Real> NearPoint<R> {
    fn new(point: u32, collider: usize, bound: MotionBox<R>) -> Self {
        Self { point, collider, bound, contacts: [0; 2], passes: false, exit: None }
    }
}

/// The points of a task that are near colliders, and what it counts.
#[derive(Debug)]
pub struct NearPoints<R> {
    /// Of a run of points, by collider.
    pub(super) near: Vec<NearPoint<R>>,
    pub(super) contacts: Vec<ColliderContact<R, 1, 3>>,
    /// Points of the run with a contact without certificate.
    pub(super) unproven: Vec<u32>,
    /// Those that wait for fallbacks, the first last.
    pub(super) waiting: Vec<u32>,
    search: Search<R>,
    /// Colliders without fitted boxes that points have come near.
    pub approached: Vec<usize>,
    /// Collider, point and exit face of all points inside.
    pub inside: Vec<(usize, u32, u32)>,
    /// Points that contact has displaced without velocity, and their motion in the time step in m/s.
    pub displaced: Vec<(u32, [R; 3])>,
    /// The smallest gap of a contact over its thickness.
    pub min_gap: f64,
    /// Counters of the task.
    pub counters: ContactCounters,
}

impl<R> Default for NearPoints<R> {
    fn default() -> Self {
        Self {
            near: Vec::new(),
            contacts: Vec::new(),
            unproven: Vec::new(),
            waiting: Vec::new(),
            search: Search::default(),
            displaced: Vec::new(),
            approached: Vec::new(),
            inside: Vec::new(),
            min_gap: f64::INFINITY,
            counters: ContactCounters::default(),
        }
    }
}

impl<R: Real> NearPoints<R> {
    /// Begins a time step.
    pub fn begin(&mut self) {
        self.inside.clear();
        self.displaced.clear();
        self.approached.clear();
        self.min_gap = f64::INFINITY;
        self.counters = ContactCounters::default();
    }

    /// Begins a run of points.
    pub fn begin_run(&mut self) {
        self.near.clear();
        self.contacts.clear();
        self.unproven.clear();
    }

    /// Whether no point of the run is near a collider.
    pub fn is_empty(&self) -> bool {
        self.near.is_empty()
    }

    /// The number of points of the run near colliders; one near two colliders counts twice.
    pub fn len(&self) -> usize {
        self.near.len()
    }

    /// The point at a place in the list.
    pub fn point(&self, place: usize) -> u32 {
        self.near[place].point
    }

    /// Finds the points of a run that come near a collider, and their contacts.
    pub fn find(
        &mut self,
        at: usize,
        collider: &NearCollider<'_, R>,
        step: &ColliderStep<'_, R>,
        rows: Range<u32>,
    ) {
        self.search.begin(collider, step, rows);
        for place in 0..self.search.len() {
            let (point, bound) = self.search.point(place);
            let mut near = NearPoint::new(point, at, bound);
            match collider.is_fitted() {
                true => self.add_contacts(&mut near, place, collider, step),
                false => self.search(&mut near, collider, step),
            }
            if collider.depenetrates() {
                near.exit = self.exit_of(&near, collider, step);
                self.inside.extend(near.exit.map(|face| (collider.args.at, near.point, face)));
            }
            if near.exit.is_some() || near.contacts[0] < near.contacts[1] {
                self.near.push(near);
            }
        }
    }

    /// Adds the contacts of the point at a place of the search.
    fn add_contacts(
        &mut self,
        near: &mut NearPoint<R>,
        place: usize,
        collider: &NearCollider<'_, R>,
        step: &ColliderStep<'_, R>,
    ) {
        near.contacts = [self.contacts.len() as u32; 2];
        for &face in self.search.faces(place) {
            add_contact(&mut self.contacts, near, face, collider, step);
        }
        self.end_search(near);
    }

    /// Lists the points near any collider, for [`follow`](Self::follow).
    pub fn begin_following(&mut self) {
        self.waiting.clear();
        self.waiting.extend(self.near.iter().map(|near| near.point));
        self.waiting.sort_unstable();
        self.waiting.dedup();
    }

    /// Follows all listed points at a collider that they are not near: another may push them into it.
    pub fn follow(&mut self, at: usize, collider: &NearCollider<'_, R>, step: &ColliderStep<'_, R>) {
        let key = |near: &NearPoint<R>| (near.collider, near.point);
        let found = self.near.len();
        for k in 0..self.waiting.len() {
            let point = self.waiting[k];
            if self.near[..found].binary_search_by_key(&(at, point), key).is_err() {
                let mut near = NearPoint::new(point, at, search_bound(point, step));
                self.search(&mut near, collider, step);
                self.near.push(near);
            }
        }
        self.near.sort_unstable_by_key(key);
    }

    /// Finds all contacts of a point for its motion in this step.
    fn search(
        &mut self,
        near: &mut NearPoint<R>,
        collider: &NearCollider<'_, R>,
        step: &ColliderStep<'_, R>,
    ) {
        near.bound = search_bound(near.point, step);
        near.contacts = [self.contacts.len() as u32; 2];
        near.passes = false;
        let (anchor, bound) = (step.anchors[near.point as usize], near.bound);
        if !collider.reaches(place_box(anchor, &bound)) {
            return;
        }
        if !collider.is_fitted() && self.approached.last() != Some(&collider.args.at) {
            self.approached.push(collider.args.at);
        }
        let range = step.interaction_range().to_f64() as f32;
        let contacts = &mut self.contacts;
        collider.for_faces(anchor, &bound, range, |face| add_contact(contacts, near, face, collider, step));
        self.end_search(near);
    }

    /// Ends the contacts of a point, and counts them.
    fn end_search(&mut self, near: &mut NearPoint<R>) {
        near.contacts[1] = self.contacts.len() as u32;
        *self.counters.candidate_pairs.get_mut() += u64::from(near.contacts[1] - near.contacts[0]);
    }

    /// The exit face of a point that is inside a closed collider at the start of the step.
    fn exit_of(
        &self,
        near: &NearPoint<R>,
        collider: &NearCollider<'_, R>,
        step: &ColliderStep<'_, R>,
    ) -> Option<u32> {
        let [first, end] = near.contacts.map(|at| at as usize);
        let is_suspect = || {
            let nearest = self.contacts[first..end]
                .iter()
                .min_by(|a, b| a.gap_at_start(step).to_f64().total_cmp(&b.gap_at_start(step).to_f64()));
            nearest.is_some_and(|contact| is_behind(near.point, contact.collider_points, step))
        };
        let is_tested = collider.was_inside(near.point) || is_suspect();
        (is_tested && step.has_full_strength(near.point))
            .then(|| collider.exit_face(step.start_position(near.point), step.time[0]))?
    }

    /// The places of the points near one collider; of one of them only, if it is given.
    pub(super) fn places(&self, at: usize, only: Option<u32>) -> Range<usize> {
        let place = |key: (usize, u32)| self.near.partition_point(|near| (near.collider, near.point) < key);
        match only {
            None => place((at, 0))..place((at + 1, 0)),
            Some(point) => place((at, point))..place((at, point + 1)),
        }
    }

    /// Searches the contacts of a point again where it has left the bound of its last search.
    pub(super) fn update(
        &mut self,
        place: usize,
        collider: &NearCollider<'_, R>,
        step: &ColliderStep<'_, R>,
    ) {
        let mut near = self.near[place];
        if !box_contains(&near.bound, step.row(near.point).xyz(), [R::ZERO; 3]) {
            self.search(&mut near, collider, step);
            self.near[place] = near;
        }
    }
}

/// Adds the contact of a point with a face, if its motion comes near; first in its list if it passes the face, because it
/// comes near few others once it is pushed off.
fn add_contact<R: Real>(
    contacts: &mut Vec<ColliderContact<R, 1, 3>>,
    near: &mut NearPoint<R>,
    face: u32,
    collider: &NearCollider<'_, R>,
    step: &ColliderStep<'_, R>,
) {
    let bounds = MotionBounds {
        boxes: std::slice::from_ref(&near.bound),
        first: near.point,
        frame_travel: [R::ZERO; 3],
    };
    let found = ColliderContact::of_free_point(near.point, collider.corners(face), step, &bounds);
    let Some((contact, passes)) = found else { return };
    contacts.push(contact);
    near.passes |= passes;
    if passes {
        let last = contacts.len() - 1;
        contacts.swap(near.contacts[0] as usize, last);
    }
}

/// Whether a point is behind the plane of a face at the start of the step.
fn is_behind<R: Real>(point: u32, corners: [u32; 3], step: &ColliderStep<'_, R>) -> bool {
    let [from, _] = step.collider_positions(corners);
    let outward = (from[1] - from[0]).cross(&(from[2] - from[0]));
    outward.dot(&(step.start_position(point) - from[0])) < 0.0
}
