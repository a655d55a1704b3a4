//! Free points near colliders: their contacts live for one time step, within one task.
//!
//! A point without faces and links that touches no other cloth depends on nothing but its own contacts. They are searched
//! when it has moved, resolved and certified before the task goes on to the next points, so no list of them is kept.

use std::ops::Range;

use nalgebra::Vector3;

use crate::contact::bvh::Aabb;
use crate::contact::collider::ColliderState;
use crate::contact::collider::contact::{Certificate, ColliderContact, Outcome};
use crate::contact::collider::motion_bounds::{MotionBounds, MotionBox, box_contains};
use crate::contact::collider::sweep::resolve_contacts;
use crate::contact::depenetration::{Depenetration, exit_face, push_outward};
use crate::contact::response::{Impact, Restitution};
use crate::contact::time_step::{ColliderStep, ColliderStepArgs, ContactCounters};
use crate::math::{Real, Row4};
use crate::model::ColliderModel;
use crate::parallel::disjoint::DisjointSlice;

/// Margin of a search around the motion of a point, as a share of the interaction range: contacts push by about as much.
const MARGIN: f64 = 0.125;

/// A collider that the points of a pass can touch.
pub struct NearCollider<'a, R> {
    /// The parameters of its steps.
    pub args: ColliderStepArgs<'a, R>,
    model: &'a ColliderModel,
    state: &'a ColliderState,
    /// The points that were inside it at the end of the last time step.
    inside: &'a Depenetration,
    /// Whether its boxes are fitted to the time step; without them every face is tested.
    is_fitted: bool,
}

impl<'a, R: Real> NearCollider<'a, R> {
    /// A collider with its motion in this frame, and the points that were inside it; `is_fitted` if its boxes are fitted to
    /// the time step.
    pub fn new(
        args: ColliderStepArgs<'a, R>,
        model: &'a ColliderModel,
        state: &'a ColliderState,
        inside: &'a Depenetration,
        is_fitted: bool,
    ) -> Self {
        Self { args, model, state, inside, is_fitted }
    }

    /// The collider's positions in this frame.
    pub fn state(&self) -> &'a ColliderState {
        self.state
    }

    /// The box in world space outside of which nothing touches it in the time step.
    fn reach(&self) -> [Vector3<f64>; 2] {
        let [from, to] = self.args.time.map(|time| self.state.bounds(time));
        let range = self.args.material.thickness * self.args.material.adhesion_range;
        let margin = range * (1.0 + 2.0 * MARGIN);
        [from[0].inf(&to[0]).add_scalar(-margin), from[1].sup(&to[1]).add_scalar(margin)]
    }

    /// Whether anything in a box in world space can touch it in the time step.
    pub fn reaches(&self, [low, high]: [[f64; 3]; 2]) -> bool {
        let reach = self.reach();
        (0..3).all(|axis| low[axis] <= reach[1][axis] && reach[0][axis] <= high[axis])
    }

    /// Calls `found` with the faces that a box may touch, given in world space relative to an anchor.
    fn for_faces(&self, anchor: Vector3<f64>, bound: &MotionBox<R>, range: f32, mut found: impl FnMut(u32)) {
        if !self.is_fitted {
            return (0..self.model.boundary.triangles.len() as u32).for_each(found);
        }
        let [low, high] = bound.map(|corner| anchor + Vector3::from(corner.xyz().map(R::to_f64)));
        let at = |time: f64| {
            let origin = self.state.origin(time);
            Aabb::new(low - origin, high - origin)
        };
        let [from, to] = self.args.time;
        let around = if self.state.moves { at(from).union(at(to)) } else { at(from) };
        let around = around.inflate(range * (1.0 + 1e-6));
        let boxes = &self.state.boxes.triangles;
        self.state.bvh.query(&around, |face| {
            if boxes[face as usize].overlaps(&around) {
                found(face);
            }
        });
    }
}

/// A point near a collider.
#[derive(Debug, Clone, Copy)]
struct NearPoint<R> {
    point: u32,
    /// The collider, by its place in the pass.
    collider: usize,
    /// Displacements for which its contacts are complete, in metres.
    bound: MotionBox<R>,
    /// Its contacts.
    contacts: [u32; 2],
    /// Whether it passes the face of the first of them.
    passes: bool,
    /// The exit face of a point inside.
    exit: Option<u32>,
}

impl<R: Real> NearPoint<R> {
    fn new(point: u32, collider: usize) -> Self {
        let (bound, contacts) = ([Row4::ZERO; 2], [0; 2]);
        Self { point, collider, bound, contacts, passes: false, exit: None }
    }
}

/// The points of a task that are near colliders, and what it counts.
#[derive(Debug)]
pub struct NearPoints<R> {
    /// Of a run of points, by collider.
    near: Vec<NearPoint<R>>,
    contacts: Vec<ColliderContact<R, 1, 3>>,
    /// Points of the run with a contact without certificate.
    unproven: Vec<u32>,
    /// Those that wait for fallbacks, the first last.
    waiting: Vec<u32>,
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
        let [low, high] = collider.reach();
        for point in rows {
            let (anchor, from, to) = (step.anchors[point as usize], step.start(point), step.row(point).xyz());
            let is_outside = (0..3).any(|axis| {
                let [from, to] = [from, to].map(|x| anchor[axis] + x[axis].to_f64());
                ((from > high[axis]) & (to > high[axis])) | ((from < low[axis]) & (to < low[axis]))
            });
            if is_outside {
                continue;
            }
            let mut near = NearPoint::new(point, at);
            self.search(&mut near, collider, step);
            let is_closed = collider.model.pseudonormals.is_some() && collider.is_fitted;
            if collider.args.material.depenetrates && is_closed {
                near.exit = self.exit_of(&near, collider, step);
                self.inside.extend(near.exit.map(|face| (collider.args.at, point, face)));
            }
            if near.exit.is_some() || near.contacts[0] < near.contacts[1] {
                self.near.push(near);
            }
        }
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
        let point = near.point;
        let range = step.interaction_range();
        let margin = range * R::from_f64(MARGIN);
        let (from, to) = (step.start(point), step.row(point).xyz());
        let (mut low, mut high) = (Row4::ZERO, Row4::ZERO);
        for axis in 0..3 {
            let [least, most] = if from[axis] < to[axis] { [from, to] } else { [to, from] };
            (low.0[axis], high.0[axis]) = (least[axis] - margin, most[axis] + margin);
        }
        near.bound = [low, high];
        near.contacts[0] = self.contacts.len() as u32;
        near.passes = false;
        let bounds = MotionBounds {
            boxes: std::slice::from_ref(&near.bound),
            first: point,
            frame_travel: [R::ZERO; 3],
        };
        let anchor = Vector3::from(step.anchors[point as usize]);
        near.contacts[1] = near.contacts[0];
        let around = near.bound.map(|corner| (anchor + Vector3::from(corner.xyz().map(R::to_f64))).into());
        if !collider.reaches(around) {
            return;
        }
        if !collider.is_fitted && self.approached.last() != Some(&collider.args.at) {
            self.approached.push(collider.args.at);
        }
        let (contacts, first) = (&mut self.contacts, near.contacts[0] as usize);
        collider.for_faces(anchor, &near.bound, range.to_f64() as f32, |face| {
            let corners = collider.model.boundary.triangles[face as usize];
            let Some((contact, passes)) = ColliderContact::of_free_point(point, corners, step, &bounds)
            else {
                return;
            };
            contacts.push(contact);
            near.passes |= passes;
            if passes {
                // Pushed off the face that it would pass, the point comes near few others.
                let last = contacts.len() - 1;
                contacts.swap(first, last);
            }
        });
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
        let is_tested = !collider.inside.has_begun() || collider.inside.contains(near.point) || is_suspect();
        (is_tested && step.has_full_strength(near.point)).then(|| {
            exit_face(step.start_position(near.point), collider.model, collider.state, step.time[0])
        })?
    }

    /// The places of the points near one collider; of one of them only, if it is given.
    fn places(&self, at: usize, only: Option<u32>) -> Range<usize> {
        let place = |key: (usize, u32)| self.near.partition_point(|near| (near.collider, near.point) < key);
        match only {
            None => place((at, 0))..place((at + 1, 0)),
            Some(point) => place((at, point))..place((at, point + 1)),
        }
    }

    /// Searches the contacts of a point again where it has left the bound of its last search.
    fn update(&mut self, place: usize, collider: &NearCollider<'_, R>, step: &ColliderStep<'_, R>) {
        let mut near = self.near[place];
        if !box_contains(&near.bound, step.row(near.point).xyz(), [R::ZERO; 3]) {
            self.search(&mut near, collider, step);
            self.near[place] = near;
        }
    }

    /// One sweep over the contacts of the points near a collider; of one of them only, if it is given.
    pub fn resolve(
        &mut self,
        at: usize,
        only: Option<u32>,
        collider: &NearCollider<'_, R>,
        step: &ColliderStep<'_, R>,
    ) {
        for place in self.places(at, only) {
            let NearPoint { point, exit, .. } = self.near[place];
            if let Some(face) = exit {
                push_outward(point, face, collider.model, step);
                continue;
            }
            self.update(place, collider, step);
            let NearPoint { contacts: [first, _], passes, .. } = self.near[place];
            if passes {
                // Pushed off the face that it would pass, it comes near few of the others.
                self.contacts[first as usize].resolve(step).count(&self.counters);
                self.near[place].passes = false;
                self.update(place, collider, step);
            }
            let [first, end] = self.near[place].contacts;
            resolve_contacts(DisjointSlice::new(&mut self.contacts), first..end, step, &self.counters);
        }
    }

    /// Applies adhesion between every point near a collider and its nearest face.
    pub fn adhere(&mut self, at: usize, collider: &NearCollider<'_, R>, step: &ColliderStep<'_, R>) {
        for place in self.places(at, None).filter(|_| step.material.has_adhesion()) {
            self.update(place, collider, step);
            let gaps = self.contacts_of(place).iter().map(|contact| (contact.gap(step), contact));
            let nearest = gaps.reduce(|least, next| if next.0 < least.0 { next } else { least });
            nearest.into_iter().for_each(|(_, contact)| contact.adhere(step));
        }
    }

    fn contacts_of(&self, place: usize) -> &[ColliderContact<R, 1, 3>] {
        let [first, end] = self.near[place].contacts;
        &self.contacts[first as usize..end as usize]
    }

    /// Certifies the contacts of the points near a collider; of one of them only, if it is given. Lists the points with a
    /// contact without certificate, and returns the number of these contacts and of inseparable ones.
    pub fn certify(
        &mut self,
        at: usize,
        only: Option<u32>,
        collider: &NearCollider<'_, R>,
        step: &ColliderStep<'_, R>,
    ) -> [u64; 2] {
        let mut counts = [0; 2];
        for place in self.places(at, only) {
            if self.near[place].exit.is_some() {
                continue;
            }
            self.update(place, collider, step);
            let [first, end] = self.near[place].contacts.map(|at| at as usize);
            let before = counts[0];
            for contact in &mut self.contacts[first..end] {
                let certificate = contact.certify(step);
                counts[0] += u64::from(certificate == Certificate::Unproven);
                counts[1] += u64::from(certificate == Certificate::Inseparable);
            }
            if counts[0] > before {
                self.unproven.push(self.near[place].point);
            }
        }
        counts
    }

    /// The points that [`certify`](Self::certify) has listed wait for fallbacks, once each.
    pub fn begin_fallbacks(&mut self) {
        std::mem::swap(&mut self.unproven, &mut self.waiting);
        self.unproven.clear();
        self.waiting.sort_unstable_by(|a, b| b.cmp(a));
        self.waiting.dedup();
    }

    /// The next point that waits for fallbacks.
    pub fn next_unproven(&mut self) -> Option<u32> {
        self.unproven.clear();
        self.waiting.pop()
    }

    /// Moves a point with the surfaces of its contacts without certificate.
    pub fn revert(&mut self, at: usize, point: u32, step: &ColliderStep<'_, R>) {
        for place in self.places(at, Some(point)) {
            let [first, end] = self.near[place].contacts.map(|at| at as usize);
            for contact in &mut self.contacts[first..end] {
                if contact.certify(step) == Certificate::Unproven {
                    contact.move_with_surface(step);
                    Outcome::Reverted.count(&self.counters);
                }
            }
        }
    }

    /// Applies restitution to the velocities of the points that touch a collider at the end of the step; `frame` is the
    /// length of the frame in seconds.
    pub fn rebound(
        &self,
        at: usize,
        step: &ColliderStep<'_, R>,
        restitution: Restitution<R>,
        velocity: DisjointSlice<'_, Row4<R>>,
        frame: f64,
    ) {
        let contacts = self.places(at, None).flat_map(|place| self.contacts_of(place));
        for contact in contacts {
            let coefficient = contact.bounce(step);
            let Some((normal, surface)) = contact.touching_surface(step, frame) else { continue };
            let ([point], row) = (contact.points, step.row(contact.points[0]));
            if coefficient <= R::ZERO || row.0[3] <= R::ZERO {
                continue;
            }
            // SAFETY: the point belongs to this task.
            #[allow(unsafe_code)]
            unsafe {
                let impact = Impact {
                    predicted: step.writer.predicted(point),
                    displacement: row.xyz(),
                    velocity: velocity.get(point).xyz(),
                };
                let [x, y, z] =
                    Restitution { coefficient, ..restitution }.velocity_after(&impact, normal, surface);
                velocity.set(point, Row4([x, y, z, R::ZERO]));
            }
        }
    }

    /// Takes up the smallest gap of the points near a collider at the end of a frame.
    pub fn measure(&mut self, at: usize, step: &ColliderStep<'_, R>) {
        let ratios = self.places(at, None).flat_map(|place| self.contacts_of(place)).map(|contact| {
            // The gap along the plane is no larger than the distance.
            let along = contact.gap(step).to_f64() / step.material.thickness;
            if along < 1.0 { contact.gap_ratio(step) } else { along }
        });
        self.min_gap = ratios.fold(self.min_gap, f64::min);
    }
}

/// Whether a point is behind the plane of a face at the start of the step.
fn is_behind<R: Real>(point: u32, corners: [u32; 3], step: &ColliderStep<'_, R>) -> bool {
    let [from, _] = step.collider_positions(corners);
    let outward = (from[1] - from[0]).cross(&(from[2] - from[0]));
    outward.dot(&(step.start_position(point) - from[0])) < 0.0
}
