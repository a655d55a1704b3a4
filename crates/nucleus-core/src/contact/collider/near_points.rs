//! Free points near colliders: their contacts live for one time step, within one task.
//!
//! A point without faces and links that touches no other cloth depends on nothing but its own contacts. They are searched
//! when it has moved, resolved and certified before the task goes on to the next points, so no list of them is kept.

use std::ops::Range;

use nalgebra::Vector3;

use crate::contact::collider::contact::ColliderContact;
use crate::contact::collider::motion_bounds::{MotionBox, box_contains};
use crate::contact::collider::near_collider::{MARGIN, NearCollider, place_box};
use crate::contact::collider::near_face::{Facing, PointPath, facing};
use crate::contact::collider::near_search::{Search, search_bound};
use crate::contact::time_step::{ColliderStep, ContactCounters};
use crate::math::{Lanes, Real, Row4};

/// A point near a collider.
#[derive(Debug, Clone, Copy)]
pub struct NearPoint<R> {
    pub(super) point: u32,
    /// The collider, by its place in the pass.
    collider: usize,
    /// Displacements at the end of the step for which its contacts are complete, in metres.
    bound: MotionBox<R>,
    /// Its contacts.
    pub(super) contacts: [u32; 2],
    /// Whether it passes the face of the first of them; all others may be missing then.
    pub(super) passes: bool,
    /// Whether it starts behind the face whose plane is nearest.
    is_behind: bool,
    /// The exit face of a point inside.
    pub(super) exit: Option<u32>,
}

impl<R: Real> NearPoint<R> {
    fn new(point: u32, collider: usize) -> Self {
        let bound = NO_BOUND.map(|corner| Row4([R::from_f64(corner); 4]));
        Self { point, collider, bound, contacts: [0; 2], passes: false, is_behind: false, exit: None }
    }
}

/// The corners of a bound that contains nothing.
const NO_BOUND: [f64; 2] = [1.0, -1.0];

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
    /// The number of these in the runs before this one.
    inside_before: usize,
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
            inside_before: 0,
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
        self.unproven.clear();
        self.inside_before = self.inside.len();
        self.begin_search();
    }

    /// Begins a search of the run: no point is near.
    pub fn begin_search(&mut self) {
        self.near.clear();
        self.contacts.clear();
        self.inside.truncate(self.inside_before);
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
            let mut near = NearPoint::new(self.search.point(place), at);
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

    /// Adds the contacts of the point at a place of the search. Where it passes a face, only the first on its path: pushed off
    /// that, it comes near few of the others.
    fn add_contacts(
        &mut self,
        near: &mut NearPoint<R>,
        place: usize,
        collider: &NearCollider<'_, R>,
        step: &ColliderStep<'_, R>,
    ) {
        let mut listing = Listing::new(&mut self.contacts, near, collider, step);
        self.search.faces(place).iter().for_each(|&face| listing.add(face, collider, step));
        if listing.passed_at < f64::INFINITY {
            let first = near.contacts[0] as usize;
            self.contacts.truncate(first + 1);
        } else {
            near.bound = end_bound(near.point, step);
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
                let mut near = NearPoint::new(point, at);
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
        near.bound = end_bound(near.point, step);
        let (anchor, motion) = (step.anchors[near.point as usize], search_bound(near.point, step));
        let mut listing = Listing::new(&mut self.contacts, near, collider, step);
        if !collider.reaches(place_box(anchor, &motion)) {
            return;
        }
        if !collider.is_fitted() && self.approached.last() != Some(&collider.args.at) {
            self.approached.push(collider.args.at);
        }
        let range = step.interaction_range().to_f64() as f32;
        collider.for_faces(anchor, &motion, range, |face| listing.add(face, collider, step));
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
        let is_tested = collider.was_inside(near.point) || near.is_behind;
        (is_tested && step.has_full_strength(near.point))
            .then(|| collider.exit_face(near.point, step.start_position(near.point), step.time.start))?
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
        if !box_contains(&near.bound, step.row(near.point), Row4::ZERO) {
            self.search(&mut near, collider, step);
            self.near[place] = near;
        }
    }
}

/// The contacts of one point, while they are listed.
struct Listing<'a, R> {
    contacts: &'a mut Vec<ColliderContact<R, 1, 3>>,
    near: &'a mut NearPoint<R>,
    path: PointPath,
    /// The same in the frame of the collider's boxes.
    among_boxes: [Vector3<f64>; 2],
    /// Share of the path at which it passes the face of the first contact; infinite if it passes none.
    passed_at: f64,
    /// Height at the start above the face whose plane is nearest, in metres.
    height: f64,
}

impl<'a, R: Real> Listing<'a, R> {
    /// No contacts, for the motion of a point in this step.
    fn new(
        contacts: &'a mut Vec<ColliderContact<R, 1, 3>>,
        near: &'a mut NearPoint<R>,
        collider: &NearCollider<'_, R>,
        step: &ColliderStep<'_, R>,
    ) -> Self {
        near.contacts = [contacts.len() as u32; 2];
        (near.passes, near.is_behind) = (false, false);
        let ends = [step.start_position(near.point), step.end_position(near.point)];
        let range = step.interaction_range().to_f64();
        let path = PointPath::new(ends, range, MARGIN * DIAGONAL * range);
        let path = if step.material.has_adhesion() { path.with_adhesion() } else { path };
        let among_boxes = collider.path_among_boxes(ends);
        Self { contacts, near, path, among_boxes, passed_at: f64::INFINITY, height: f64::INFINITY }
    }

    /// Adds the contact with a face, unless a plane excludes it. The first face that the point passes comes first.
    fn add(&mut self, face: u32, collider: &NearCollider<'_, R>, step: &ColliderStep<'_, R>) {
        if !collider.comes_near(&self.among_boxes, face, self.path.range + self.path.margin) {
            return;
        }
        let (point, corners) = (self.near.point, collider.corners(face));
        let (facing, height) = facing(&self.path, step.collider_positions(corners));
        if height.abs() < self.height.abs() {
            (self.height, self.near.is_behind) = (height, height < 0.0);
        }
        let (normal, weights) = match facing {
            Facing::Apart => return,
            Facing::Close(normal, weights) => (normal, Some(weights)),
            Facing::Near(normal) | Facing::Passes(normal, _) => (normal, None),
        };
        self.contacts.push(ColliderContact::of_free_point(point, corners, normal, weights, step));
        if let Facing::Passes(_, share) = facing
            && share < self.passed_at
        {
            (self.passed_at, self.near.passes) = (share, true);
            let last = self.contacts.len() - 1;
            self.contacts.swap(self.near.contacts[0] as usize, last);
        }
    }
}

/// The diagonal of a cube over its side, and a little more for rounding.
const DIAGONAL: f64 = 1.75;

/// The box around the end of a point's motion for which a search is complete, in metres from its anchor.
fn end_bound<R: Real>(point: u32, step: &ColliderStep<'_, R>) -> MotionBox<R> {
    let margin = R::Lanes::splat(step.interaction_range() * R::from_f64(MARGIN));
    let end = step.row(point).lanes();
    [end - margin, end + margin].map(|corner| Row4(corner.to_array()))
}
