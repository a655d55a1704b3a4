//! One contact between two elements that can both be moved.
//!
//! It carries a direction along which the two were apart at the start of the time step. As long as they are
//! apart along it at the end too, they have not passed; otherwise another direction is looked for.

use super::swept::{first_touch, passes_beside};
use super::ways::Points;
use crate::checkpoint::{Item, Reader, item};
use crate::collision::friction::{Push, rub};
use crate::collision::maps::Maps;
use crate::collision::narrow::{Places, across, gap_along, shortest, weigh};
use crate::collision::terms::{Sides, Terms};
use crate::columns::Shared;
use crate::scalar::{Real, Row4, add, dot, scale, sub, unit};

/// Parts in a million of the thickness that count as touching: without it a contact at rest would push
/// for ever at its last bit.
const TOUCH: f64 = 1e-6;
/// Share of the way to a plane that a point is let go: the rest is the gap that the next step starts with.
const ROOM_USED: f64 = 0.9;
/// Share of the grain by which two have to be apart at the start of a step: what was proven at the end of one has to be
/// apart at the start of the next, though the grain grows with the way that points have come.
const AT_START: f64 = 0.25;
/// Least and most share of a gap that one side may use up when both come nearer.
const LEAST_SHARE: f64 = 0.05;

/// What a contact needs of the time step.
#[derive(Clone, Copy)]
pub struct Motion<'a, R> {
    /// Displacements from the anchors, with the inverse mass.
    pub displacement: Shared<'a, Row4<R>>,
    /// Where the points would be had nothing held them.
    pub predicted: Shared<'a, Row4<R>>,
    /// Displacements at the start of the step.
    pub start: &'a [Row4<R>],
    /// How cloths meet, by cloth and cloth.
    pub terms: &'a [Option<Terms<R>>],
    /// What points bring into a contact beyond their cloth.
    pub maps: &'a Maps<R>,
    /// Length of the step in seconds.
    pub h: R,
    /// The share of every thickness that is kept: less than one where there is no room for all of it.
    pub squeeze: R,
}

impl<R: Real> Motion<'_, R> {
    #[allow(unsafe_code)]
    #[inline(always)]
    pub(super) fn row(&self, point: u32) -> Row4<R> {
        // SAFETY: tasks of a phase share no block, and a contact's points are in its task's blocks.
        unsafe { self.displacement.get(point) }
    }

    #[inline(always)]
    fn start(&self, point: u32) -> [R; 3] {
        self.start[point as usize].xyz()
    }

    /// Moves a point; `led` is the part of it that is not to become velocity.
    #[allow(unsafe_code)]
    #[inline(always)]
    pub(super) fn write(&self, point: u32, row: Row4<R>, led: [R; 3]) {
        // SAFETY: as above.
        unsafe {
            self.displacement.set(point, row);
            let mut predicted = self.predicted.get(point);
            for axis in 0..3 {
                predicted.0[axis] += led[axis];
            }
            self.predicted.set(point, predicted);
        }
    }
}

/// On which terms two elements meet.
#[derive(Debug, Clone, Copy)]
pub struct Meeting<R> {
    /// The distance to keep, in metres; the most that maps make of it.
    pub thickness: R,
    /// The terms of the two cloths, by their place among all.
    pub terms: u32,
    /// Whether the distance is less than the cloth's, because the two are neighbours at rest.
    pub limited: bool,
    /// Whether one side is a free point, which can go farther in a step than anything is large.
    pub is_swept: bool,
}

/// A contact: `N` points of one element, `M` of the other.
#[derive(Debug, Clone, Copy)]
pub struct Near<R, const N: usize, const M: usize> {
    /// Points of the one element, in the solver's places.
    pub ours: [u32; N],
    /// Points of the other.
    pub theirs: [u32; M],
    /// Their anchors, in metres from the first of ours.
    places: ([[R; 3]; N], [[R; 3]; M]),
    /// Points from theirs to ours; the two were apart along it at the start of the step.
    normal: [R; 3],
    meeting: Meeting<R>,
}

item!([R: Real] Meeting<R> { thickness: R, terms: u32, limited: bool, is_swept: bool });

impl<R: Real, const N: usize, const M: usize> Item for Near<R, N, M> {
    const SIZE: usize = <Points<N, M>>::SIZE + <[R; 3]>::SIZE + Meeting::<R>::SIZE;
    fn put(&self, out: &mut Vec<u8>) {
        // Places are those of the next frame's anchors.
        let Self { ours, theirs, places: _, normal, meeting } = self;
        (*ours, *theirs).put(out);
        normal.put(out);
        meeting.put(out);
    }
    fn take(from: &mut Reader<'_>) -> Option<Self> {
        let (ours, theirs) = Item::take(from)?;
        let places = ([[R::ZERO; 3]; N], [[R::ZERO; 3]; M]);
        Some(Self { ours, theirs, places, normal: Item::take(from)?, meeting: Item::take(from)? })
    }
}

impl<R: Real, const N: usize, const M: usize> Near<R, N, M> {
    /// A contact along the shortest line between the two at the start of a time step, of which `start` has the
    /// displacements.
    #[inline]
    pub fn new(
        (ours, theirs): Points<N, M>,
        meeting: Meeting<R>,
        anchors: &[[f64; 3]],
        start: &[Row4<R>],
    ) -> Self {
        let places = places((ours, theirs), anchors);
        let mut near = Self { ours, theirs, places, normal: [R::ZERO; 3], meeting };
        near.normal = shortest(near.at(|point| start[point as usize].xyz())).0;
        near
    }

    #[inline(always)]
    fn at(&self, displacement: impl Fn(u32) -> [R; 3]) -> Places<R, N, M> {
        let ours = std::array::from_fn(|k| add(self.places.0[k], displacement(self.ours[k])));
        (ours, std::array::from_fn(|k| add(self.places.1[k], displacement(self.theirs[k]))))
    }

    #[inline(always)]
    pub(super) fn now(&self, step: &Motion<'_, R>) -> Places<R, N, M> {
        self.at(|point| step.row(point).xyz())
    }

    #[inline(always)]
    pub(super) fn before(&self, step: &Motion<'_, R>) -> Places<R, N, M> {
        self.at(|point| step.start(point))
    }

    /// The terms of the two cloths.
    #[inline(always)]
    pub(super) fn terms<'a>(&self, step: &Motion<'a, R>) -> Option<&'a Terms<R>> {
        step.terms.get(self.meeting.terms as usize)?.as_ref()
    }

    /// The points of the two, with how near each of them is.
    #[inline(always)]
    pub(super) fn sides<'a>(&self, weights: &'a ([R; N], [R; M])) -> Sides<'a, R, N, M> {
        (self.ours, self.theirs, weights)
    }

    /// The distance to keep where the contact is.
    #[inline(always)]
    fn kept(&self, step: &Motion<'_, R>, weights: &([R; N], [R; M])) -> R {
        self.thickness_at(step.terms, step.maps, weights) * step.squeeze
    }

    /// The distance to keep where the two are nearest to each other.
    fn kept_at(&self, step: &Motion<'_, R>, at: &Places<R, N, M>) -> R {
        self.kept(step, &shortest(*at).1)
    }

    /// The thickness of both where the contact is, in metres.
    #[inline(always)]
    pub fn thickness_at(&self, terms: &[Option<Terms<R>>], maps: &Maps<R>, weights: &([R; N], [R; M])) -> R {
        let most = self.meeting.thickness;
        let there = |terms: &Terms<R>| terms.thickness_at(maps, self.sides(weights), most);
        if maps.thickness.is_empty() {
            return most;
        }
        terms[self.meeting.terms as usize].as_ref().map_or(most, there)
    }

    /// The gap along the contact's direction.
    #[inline(always)]
    fn gap(&self, at: &Places<R, N, M>) -> R {
        gap_along(self.normal, at)
    }

    /// Pushes the two apart if they are nearer than their thickness; whether they were.
    #[inline]
    pub fn resolve(&mut self, step: &Motion<'_, R>) -> bool {
        let now = self.now(step);
        let touching = R::from_f64(1.0 - TOUCH);
        let gap = self.gap(&now);
        if gap >= self.meeting.thickness * step.squeeze * touching {
            return false;
        }
        let before = self.before(step);
        if self.meeting.is_swept
            && let Some(normal) = first_touch(&before, &now, self.kept_at(step, &before))
        {
            self.normal = normal;
            self.push_back(step, &before, &now);
            return true;
        }
        let (normal, weights, distance) = shortest(now);
        if distance > R::ZERO && gap_along(normal, &before) > grain(&now) * R::from_f64(AT_START) {
            // Apart along this line at both ends of the step: it is theirs from now on.
            self.normal = normal;
            let kept = self.kept(step, &weights);
            if distance >= kept * touching {
                return false;
            }
            self.push(step, &weights, &before, [kept, kept - distance]);
            return true;
        }
        if self.meeting.is_swept
            && let Some(normal) = passes_beside(&before, &now, self.kept_at(step, &before))
        {
            self.normal = normal;
            return false;
        }
        if self.may_pass(step) {
            // They are on the other side from now on.
            self.normal = normal;
            let kept = self.kept(step, &weights);
            self.push(step, &weights, &before, [kept, larger(kept - distance, R::ZERO)]);
            return true;
        }
        // They may have passed. Back to the side that they were on.
        self.push_back(step, &before, &now);
        true
    }

    /// Pushes the two apart along the contact's direction, where they were nearest when the step began.
    fn push_back(&self, step: &Motion<'_, R>, before: &Places<R, N, M>, now: &Places<R, N, M>) {
        let (_, weights, _) = shortest(*before);
        let kept = self.kept(step, &weights);
        let depth = kept - dot(self.normal, self.line(now, &weights));
        if depth > R::ZERO {
            self.push(step, &weights, before, [kept, depth]);
        }
    }

    /// Moves both sides by `depth` in all, where `kept` is to be kept, each by its mobility, with friction.
    fn push(
        &self,
        step: &Motion<'_, R>,
        weights: &([R; N], [R; M]),
        before: &Places<R, N, M>,
        [kept, depth]: [R; 2],
    ) {
        let Some(terms) = self.terms(step) else { return };
        let line_before = self.line(before, weights);
        let mut push = Push::new(depth, kept - dot(self.normal, line_before), step.h);
        if terms.is_weak(step.maps) {
            push = push.times(terms.strength_at(step.maps, self.sides(weights)));
        }
        let along = scale(self.normal, push.length());
        let rub = self.rub(step, terms, weights, line_before, along, push.pressed);
        self.part(step, terms, weights, add(along, rub), scale(self.normal, push.led));
    }

    /// Moves the two by `moved` from each other, each side by its mobility; `led` is the part of it that is not to
    /// become velocity.
    pub(super) fn part(
        &self,
        step: &Motion<'_, R>,
        terms: &Terms<R>,
        (b, c): &([R; N], [R; M]),
        moved: [R; 3],
        led: [R; 3],
    ) {
        let mobile =
            |point: u32, weight: R, side: usize| step.row(point).0[3] * weight * terms.mobility[side];
        let ours: [R; N] = std::array::from_fn(|k| mobile(self.ours[k], b[k], 0));
        let theirs: [R; M] = std::array::from_fn(|k| mobile(self.theirs[k], c[k], 1));
        let all = (0..N).map(|k| ours[k] * b[k]).sum::<R>() + (0..M).map(|k| theirs[k] * c[k]).sum::<R>();
        if all <= R::TINY {
            return;
        }
        let part = R::ONE / all;
        for k in 0..N {
            self.shift(step, self.ours[k], ours[k] * part, moved, led);
        }
        for k in 0..M {
            self.shift(step, self.theirs[k], -(theirs[k] * part), moved, led);
        }
    }

    #[inline(always)]
    fn shift(&self, step: &Motion<'_, R>, point: u32, part: R, moved: [R; 3], led: [R; 3]) {
        let mut row = step.row(point);
        for axis in 0..3 {
            row.0[axis] += moved[axis] * part;
        }
        step.write(point, row, scale(led, part));
    }

    /// The correction along the surfaces, against the motion of one over the other within the step.
    fn rub(
        &self,
        step: &Motion<'_, R>,
        terms: &Terms<R>,
        weights: &([R; N], [R; M]),
        line_before: [R; 3],
        along: [R; 3],
        pressed: R,
    ) -> [R; 3] {
        let limit = terms.friction_at(step.maps, self.sides(weights)) * pressed;
        if limit <= R::ZERO {
            return [R::ZERO; 3];
        }
        let line = self.line(&self.now(step), weights);
        rub(add(sub(line, line_before), along), self.normal, limit)
    }

    /// The line from the contact on theirs to the contact on ours.
    #[inline(always)]
    pub(super) fn line(&self, at: &Places<R, N, M>, (b, c): &([R; N], [R; M])) -> [R; 3] {
        sub(weigh(at.0, *b), weigh(at.1, *c))
    }

    /// Whether it is certain that the two did not pass each other in this step. Takes up another direction
    /// if that proves it. What was not apart when the step began has nothing to lose.
    #[inline]
    pub fn prove(&mut self, step: &Motion<'_, R>) -> bool {
        let now = self.now(step);
        self.gap(&now) > grain(&now) || self.may_pass(step) || self.prove_otherwise(step, now)
    }

    /// Whether the scene lets the two pass through each other: a collision that is carried out in part is none that holds.
    #[cold]
    fn may_pass(&self, step: &Motion<'_, R>) -> bool {
        let Some(terms) = self.terms(step) else { return true };
        let map = &step.maps.strength;
        let mut points = self.ours.iter().chain(&self.theirs);
        let all = terms.strength.iter().any(|&side| side < R::ONE);
        terms.is_weak(step.maps) && (all || points.any(|&point| map[point as usize] < R::ONE))
    }

    #[cold]
    fn prove_otherwise(&mut self, step: &Motion<'_, R>, now: Places<R, N, M>) -> bool {
        let before = self.before(step);
        let (first, _, distance) = shortest(before);
        let grain = grain(&now);
        let at_start = grain * R::from_f64(AT_START);
        if distance <= at_start {
            return true;
        }
        let candidates = [shortest(now).0, across(now.0, now.1), across(before.0, before.1), first];
        let units = candidates.into_iter().filter_map(|line| unit(line, R::TINY));
        let both = units.flat_map(|n| [n, n.map(|x| -x)]);
        let mut proofs = both.filter(|&n| gap_along(n, &before) > at_start && gap_along(n, &now) > grain);
        match proofs.next() {
            Some(normal) => self.normal = normal,
            None => return false,
        }
        true
    }

    /// Stops the points that would pass a plane between the two, before it: each is taken back along its own
    /// way of this step. Both sides then stay on theirs, whatever else takes their points back farther.
    pub fn clip(&mut self, step: &Motion<'_, R>) {
        let (before, now) = (self.before(step), self.now(step));
        let (normal, _, _) = shortest(before);
        self.normal = normal;
        let most = |x: R, y: R| if y > x { y } else { x };
        let rear = before.1.iter().map(|&q| dot(normal, q)).fold(-R::ONE / R::TINY, most);
        let front = -before.0.iter().map(|&x| -dot(normal, x)).fold(-R::ONE / R::TINY, most);
        let came = |from: &[[R; 3]], to: &[[R; 3]], sign: R| {
            let each = from.iter().zip(to).map(|(&from, &to)| dot(normal, sub(to, from)) * sign);
            each.fold(R::ZERO, most)
        };
        let (ours, theirs) = (came(&before.0, &now.0, -R::ONE), came(&before.1, &now.1, R::ONE));
        let sum = ours + theirs;
        let share = if sum > R::ZERO { theirs / sum } else { R::from_f64(0.5) };
        let share = most(R::from_f64(LEAST_SHARE), share);
        let share = -most(-share, -R::from_f64(1.0 - LEAST_SHARE));
        let plane = rear + (front - rear) * share;
        let grain = grain(&now);
        for k in 0..N {
            let heights = [dot(normal, before.0[k]) - plane, dot(normal, now.0[k]) - plane];
            self.stop_before(step, self.ours[k], heights, grain);
        }
        for k in 0..M {
            let heights = [plane - dot(normal, before.1[k]), plane - dot(normal, now.1[k])];
            self.stop_before(step, self.theirs[k], heights, grain);
        }
    }

    /// Takes a point back to before a plane, given its height above it at both ends of the step; no nearer than what
    /// can be told from touching.
    fn stop_before(&self, step: &Motion<'_, R>, point: u32, [before, now]: [R; 2], grain: R) {
        let mut row = step.row(point);
        let room = larger(before * R::from_f64(1.0 - ROOM_USED), grain);
        if now >= room || before - now <= R::TINY || row.0[3] <= R::ZERO {
            return;
        }
        let share = larger((before - room) / (before - now), R::ZERO);
        let start = step.start(point);
        for axis in 0..3 {
            row.0[axis] = start[axis] + (row.0[axis] - start[axis]) * share;
        }
        step.write(point, row, [R::ZERO; 3]);
    }

    /// Lets all points of the two go nowhere in this step, or all along with one that is `held`: what moves as one
    /// passes no part of itself.
    pub fn stop(&mut self, step: &Motion<'_, R>, held: &mut [bool]) {
        let points = || self.ours.iter().chain(&self.theirs).copied();
        let carrier = points().find(|&point| held[point as usize]);
        let motion = carrier.map_or([R::ZERO; 3], |point| sub(step.row(point).xyz(), step.start(point)));
        for point in points() {
            let mut row = step.row(point);
            if row.0[3] > R::ZERO {
                let [x, y, z] = add(step.start(point), motion);
                row = Row4([x, y, z, row.0[3]]);
                step.write(point, row, [R::ZERO; 3]);
            }
            held[point as usize] = true;
        }
    }

    /// Whether one side is a free point.
    pub fn is_swept(&self) -> bool {
        self.meeting.is_swept
    }

    /// Its points, first ours, then theirs; what is left over repeats the first.
    pub fn points(&self) -> [u32; 4] {
        let mut points = [self.ours[0]; 4];
        points.iter_mut().zip(self.ours.iter().chain(&self.theirs)).for_each(|(at, point)| *at = *point);
        points
    }

    /// Reckons from anchors where they are now.
    pub fn follow(&mut self, anchors: &[[f64; 3]]) {
        self.places = places((self.ours, self.theirs), anchors);
    }

    /// Whether the distance that is kept is less than the cloth's, because the two are neighbours at rest.
    pub fn is_limited(&self) -> bool {
        self.meeting.limited
    }

    /// Lets it act no more.
    pub fn switch_off(&mut self) {
        // Nothing is that near, and there are no terms on which to meet.
        self.meeting.thickness = -R::ONE / R::TINY;
        self.meeting.terms = u32::MAX;
    }

    /// Whether it is between points that there are, on terms that there are.
    pub fn fits(&self, are_points: impl Fn(&[u32]) -> bool, terms: usize) -> bool {
        are_points(&self.ours)
            && are_points(&self.theirs)
            && (self.is_off() || (self.meeting.terms as usize) < terms)
    }

    /// Whether it acts no more.
    pub fn is_off(&self) -> bool {
        self.meeting.terms == u32::MAX
    }

    /// The distance between the two, over the thickness kept between them.
    pub fn closeness(&self, step: &Motion<'_, R>) -> R {
        let (_, weights, distance) = shortest(self.now(step));
        distance / self.kept(step, &weights)
    }
}

/// Where the anchors of some points are, in metres from the first of ours.
#[inline(always)]
fn places<R: Real, const N: usize, const M: usize>(
    (ours, theirs): Points<N, M>,
    anchors: &[[f64; 3]],
) -> Places<R, N, M> {
    let origin = anchors[ours[0] as usize];
    let place = |point: u32| {
        let anchor = anchors[point as usize];
        std::array::from_fn(|axis| R::from_f64(anchor[axis] - origin[axis]))
    };
    (ours.map(place), theirs.map(place))
}

/// What a gap may be off by, by rounding, in metres: places are reckoned from anchors, so it goes by how far the points
/// are from there, and by how large the elements are.
#[inline(always)]
fn grain<R: Real, const N: usize, const M: usize>(at: &Places<R, N, M>) -> R {
    let size = |[x, y, z]: [R; 3]| larger(x, -x) + larger(y, -y) + larger(z, -z);
    (size(at.0[0]) + size(at.1[0])) * (R::EPSILON * R::from_f64(4.0))
}

#[inline(always)]
fn larger<R: Real>(x: R, y: R) -> R {
    if y > x { y } else { x }
}
