//! Contacts: a pair of elements, one of a cloth and one of a collider, kept apart by its thickness.
//!
//! A pair carries a separating plane: a direction `n`, and for each cloth point the gap n·x - max n·q over
//! the collider's points. Both sides move along straight lines within a step, so a positive gap at both ends
//! of the step, for one `n`, *proves* that nothing passed in between (the maximum of linear functions stays
//! below its chord). Where the pair's own plane proves nothing any more, others are tried; where none does,
//! the cloth would pass, and is pushed back to its side by the plane that held at the start of the step.

mod bounce;
mod stick;

use nalgebra::Vector3;

use super::foresee::{Foreseen, spread};
use super::friction::{Push, rub};
use super::maps::Maps;
use super::narrow;
use super::terms::{Sides, Terms};
use crate::checkpoint::item;
use crate::columns::Shared;
use crate::scalar::{Real, Row4, dot};

type Point = Vector3<f64>;

/// Parts in a million of the thickness that count as touching: without it a contact at rest would push
/// for ever at its last bit.
const TOUCH: f64 = 1e-6;
/// Least mobility of an element, in that of its most mobile point: no point moves farther than 1 / this times
/// the depth of a contact.
const LEAST_ARM: f64 = 0.25;
/// A contact's plane is good for motion along it up to this share of the thickness: round an edge or a corner
/// it is then off by less than 1e-5 of the thickness, and on a face not at all.
const PLANE_REACH: f64 = 1.0 / 256.0;

/// One element of a cloth, of `N` points, near one element of a collider, of `M` points.
/// Point and face: 1 and 3; edge and edge: 2 and 2; face and point: 3 and 1.
#[derive(Debug, Clone, Copy)]
pub struct Pair<R, const N: usize, const M: usize> {
    /// The cloth's points, in the solver's places.
    pub points: [u32; N],
    /// The collider's points.
    pub collider_points: [u32; M],
    /// The group of the cloth's skin that the pair was found for.
    pub group: u32,
    normal: [R; 3],
    /// n·q less n·anchor for each cloth point, at the start and at the end of the span the pair was found for.
    plane: [[R; N]; 2],
    /// Where on the cloth element the contact is.
    weights: [R; N],
    /// How the collider moves there in the whole frame.
    surface_motion: [R; 3],
    /// Displacement of the contact when the plane was found.
    found_at: [R; 3],
}

item!([R: Real, const N: usize, const M: usize] Pair<R, N, M> {
    points: [u32; N], collider_points: [u32; M], group: u32, normal: [R; 3], plane: [[R; N]; 2], weights: [R; N],
    surface_motion: [R; 3], found_at: [R; 3],
});

/// How a step went for a pair.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Outcome {
    /// Apart.
    Apart,
    /// Touched, and pushed to the thickness.
    Pushed,
    /// Would have passed; pushed back to its side.
    Caught,
    /// No plane holds: the two are tangled, and are left alone.
    Tangled,
}

/// All that resolving a pair needs to know of the step.
pub struct Step<'a, R> {
    /// Displacements from the anchors, with the inverse mass.
    pub displacement: Shared<'a, Row4<R>>,
    /// Where the points would be had nothing held them; less the start of the step, this is velocity.
    pub predicted: Shared<'a, Row4<R>>,
    /// Displacements at the start of the step.
    pub start: &'a [Row4<R>],
    /// Anchors in metres.
    pub anchors: &'a [[f64; 3]],
    /// The collider's points at the start and at the end of the frame.
    pub collider: [&'a [Point]; 2],
    /// Start and end of the step, as shares of the frame.
    pub time: [f64; 2],
    /// The span the pairs were found for, as shares of the frame.
    pub span: [f64; 2],
    /// Length of the step in seconds.
    pub h: R,
    /// The distance to keep, in metres; the most that maps make of it.
    pub thickness: R,
    /// The share of every thickness that is kept: less than one where there is no room for all of it.
    pub squeeze: R,
    /// How the two meet.
    pub terms: Terms<R>,
    /// What the cloth's points bring into a contact beyond their cloth.
    pub maps: &'a Maps<R>,
}

impl<R: Real> Step<'_, R> {
    /// The same where only a share of every thickness is kept.
    pub fn squeezed(self, share: f64) -> Self {
        let share = R::from_f64(share);
        Self { thickness: self.thickness * share, squeeze: self.squeeze * share, ..self }
    }

    /// The distance in metres up to which anything acts.
    pub fn reach(&self) -> R {
        R::from_f64(self.terms.thickness * self.terms.reach)
    }

    /// The distance to keep where a contact is.
    #[inline(always)]
    fn kept<const N: usize>(&self, points: [u32; N], weights: [R; N]) -> R {
        if self.maps.thickness.is_empty() {
            return self.thickness;
        }
        let most = R::from_f64(self.terms.thickness);
        self.terms.thickness_at(self.maps, (points, [], &(weights, [])), most) * self.squeeze
    }

    /// The cloth's points at the start and at the end of the step.
    #[inline]
    fn cloth<const N: usize>(&self, points: [u32; N]) -> [[Point; N]; 2] {
        let end = std::array::from_fn(|k| self.place(points[k], self.moved(points[k]).xyz()));
        [self.cloth_at_start(points), end]
    }

    #[inline]
    fn cloth_at_start<const N: usize>(&self, points: [u32; N]) -> [Point; N] {
        std::array::from_fn(|k| self.place(points[k], self.start(points[k])))
    }

    /// Whether a collision of a point is carried out in full.
    pub fn is_full(&self, point: u32) -> bool {
        self.terms.strength_at(self.maps, ([point], [], &([R::ONE], []))) >= R::ONE
    }

    /// Where a point is at the start of the step, in metres.
    pub fn place_at_start(&self, point: u32) -> Point {
        self.place(point, self.start(point))
    }

    /// Where a point is at the end of the step, in metres.
    pub fn place_at_end(&self, point: u32) -> Point {
        self.place(point, self.moved(point).xyz())
    }

    /// Pushes a point, unless it is pinned; `led` is the part of it that is not to become velocity.
    #[allow(unsafe_code)]
    pub fn push(&self, point: u32, push: Point, led: Point) {
        let mut row = self.moved(point);
        if row.0[3] <= R::ZERO {
            return;
        }
        // SAFETY: as for `moved`.
        unsafe {
            let mut predicted = self.predicted.get(point);
            for axis in 0..3 {
                row.0[axis] += R::from_f64(push[axis]);
                predicted.0[axis] += R::from_f64(led[axis]);
            }
            self.displacement.set(point, row);
            self.predicted.set(point, predicted);
        }
    }

    #[inline(always)]
    fn place(&self, point: u32, [x, y, z]: [R; 3]) -> Point {
        Point::from(self.anchors[point as usize]) + Point::new(x.to_f64(), y.to_f64(), z.to_f64())
    }

    /// How far a point of the collider goes in the span, beside the drift of so many metres in a frame.
    #[inline]
    fn way(&self, point: u32, drift: [R; 3]) -> f64 {
        let [start, end] = self.collider.map(|points| points[point as usize]);
        (end - start - Point::from(drift.map(R::to_f64))).norm() * (self.span[1] - self.span[0])
    }

    #[allow(unsafe_code)]
    #[inline(always)]
    fn moved(&self, point: u32) -> Row4<R> {
        // SAFETY: the phase hands every task points of its own.
        unsafe { self.displacement.get(point) }
    }

    #[inline(always)]
    fn start(&self, point: u32) -> [R; 3] {
        self.start[point as usize].xyz()
    }

    /// The collider's points at the start and at the end of the step.
    #[inline]
    pub fn surface<const M: usize>(&self, points: [u32; M]) -> [[Point; M]; 2] {
        std::array::from_fn(|end| std::array::from_fn(|k| self.surface_point(points[k], self.time[end])))
    }

    /// A point of the collider at a time of the frame.
    #[inline]
    fn surface_point(&self, point: u32, time: f64) -> Point {
        let [start, end] = self.collider.map(|points| points[point as usize]);
        start + (end - start) * time
    }

    /// A time as a share of the span the pairs were found for.
    fn share(&self, time: f64) -> R {
        let [from, to] = self.span;
        R::from_f64(if to > from { (time - from) / (to - from) } else { 0.0 })
    }
}

impl<R: Real, const N: usize, const M: usize> Pair<R, N, M> {
    /// A pair whose plane stands across the shortest line between the two where they are at the start of the
    /// step; nothing if they cannot touch within the span, by what is foreseen for the cloth's points.
    #[inline]
    pub fn find(
        points: [u32; N],
        collider_points: [u32; M],
        group: u32,
        step: &Step<'_, R>,
        foreseen: &Foreseen<'_, R>,
    ) -> Option<Self> {
        let (x, q) = (step.cloth_at_start(points), step.surface(collider_points)[0]);
        let (b, c) = closest(x, q);
        let line = weigh(x, b) - weigh(q, c);
        // Neither side can come nearer than its longest way allows.
        let ours = points.map(|point| spread(&foreseen.of(point)).to_f64()).into_iter().fold(0.0, f64::max);
        let theirs = collider_points.map(|q| step.way(q, foreseen.drift)).into_iter().fold(0.0, f64::max);
        let reach = step.reach();
        if line.norm() > reach.to_f64() + ours + theirs {
            return None;
        }
        let touching = || across(x, q).try_normalize(0.0).unwrap_or_else(Point::y);
        let normal = line.try_normalize(1e-12).unwrap_or_else(touching);
        let zero = [R::ZERO; 3];
        let mut pair = Self {
            points,
            collider_points,
            group,
            normal: zero,
            plane: [[R::ZERO; N]; 2],
            weights: [R::ZERO; N],
            surface_motion: zero,
            found_at: zero,
        };
        pair.turn_to(normal, (b, c), step);
        let ends = [(R::ZERO, step.span[0]), (R::ONE, step.span[1])];
        let gap = pair.least_gap(ends.map(|(share, time)| (share, foreseen.gone(time))), foreseen);
        (gap < reach).then_some(pair)
    }

    /// Whether the cloth's element, in its midst, is on the far side of the collider's, given the way out there.
    pub fn is_within(&self, outward: Point) -> bool {
        let amid = R::from_f64(1e-4);
        let normal = Point::from(self.normal.map(R::to_f64));
        self.weights.iter().all(|&weight| weight > amid) && normal.dot(&outward) < 0.0
    }

    /// The smallest gap of the pair's plane over all that is foreseen for the cloth's points, over a window given by
    /// shares of the span and how far the drift has gone then: where it is above the thickness the pair cannot touch.
    #[inline(always)]
    pub fn least_gap(&self, window: [(R, [R; 3]); 2], foreseen: &Foreseen<'_, R>) -> R {
        let window = window.map(|(share, gone)| (share, dot(self.normal, gone)));
        let mut least = R::from_f64(f64::from(f32::MAX));
        for k in 0..N {
            let [low, high] = foreseen.of(self.points[k]);
            let corner = |axis: usize| if self.normal[axis] > R::ZERO { low.0[axis] } else { high.0[axis] };
            let reach = dot(self.normal, [corner(0), corner(1), corner(2)]);
            for (share, gone) in window {
                let gap = reach + gone - self.plane_at(k, share);
                least = if gap < least { gap } else { least };
            }
        }
        least
    }

    /// Follows anchors that move to where the points are; the collider is at rest.
    pub fn move_anchors(&mut self, moved: &[Row4<R>]) {
        for k in 0..N {
            let by = moved[self.points[k] as usize].xyz();
            let along = dot(self.normal, by);
            self.plane[0][k] -= along;
            self.plane[1][k] -= along;
            for axis in 0..3 {
                self.found_at[axis] -= self.weights[k] * by[axis];
            }
        }
    }

    /// The plane's offset for a point, at a share of the span.
    #[inline(always)]
    fn plane_at(&self, k: usize, share: R) -> R {
        self.plane[0][k] + (self.plane[1][k] - self.plane[0][k]) * share
    }

    /// The distance between the two elements at the end of the step, over the thickness kept between them.
    pub fn closeness(&self, step: &Step<'_, R>) -> f64 {
        let (x, q) = (step.cloth(self.points)[1], step.surface(self.collider_points)[1]);
        let (b, c) = closest(x, q);
        (weigh(x, b) - weigh(q, c)).norm() / step.kept(self.points, b.map(R::from_f64)).to_f64()
    }

    /// Keeps the two apart. The caller hands in points that no other task of the phase touches.
    #[inline]
    pub fn resolve(&mut self, step: &Step<'_, R>) -> Outcome {
        let moved = self.points.map(|point| step.moved(point).xyz());
        let touching = R::from_f64(1.0 - TOUCH);
        let (gap, least) = self.gaps(moved, step.share(step.time[1]));
        if least >= step.thickness * touching {
            return Outcome::Apart;
        }
        if least < R::ZERO || !self.plane_reaches(moved, step) {
            return self.look_closer(step, least);
        }
        let kept = step.kept(self.points, self.weights);
        if gap >= kept * touching {
            return Outcome::Apart;
        }
        let start = self.points.map(|point| step.start(point));
        let (gap_at_start, _) = self.gaps(start, step.share(step.time[0]));
        self.push(step, kept - gap, kept - gap_at_start);
        Outcome::Pushed
    }

    /// The gap at the contact and the smallest gap of any point, at a share of the span.
    #[inline(always)]
    fn gaps(&self, displacement: [[R; 3]; N], share: R) -> (R, R) {
        let mut at_contact = R::ZERO;
        let mut least = R::ZERO;
        for k in 0..N {
            let gap = dot(self.normal, displacement[k]) - self.plane_at(k, share);
            at_contact += self.weights[k] * gap;
            least = if k == 0 || gap < least { gap } else { least };
        }
        (at_contact, least)
    }

    /// Whether the contact is still about where the plane was found for.
    #[inline(always)]
    fn plane_reaches(&self, displacement: [[R; 3]; N], step: &Step<'_, R>) -> bool {
        let time = R::from_f64(step.time[1]);
        let away: [R; 3] = std::array::from_fn(|axis| {
            self.contact(displacement)[axis] - self.surface_motion[axis] * time - self.found_at[axis]
        });
        let reach = step.thickness * R::from_f64(PLANE_REACH);
        dot(away, away) <= reach * reach
    }

    /// Displacement of the contact on the cloth.
    #[inline(always)]
    fn contact(&self, displacement: [[R; 3]; N]) -> [R; 3] {
        std::array::from_fn(|axis| (0..N).map(|k| self.weights[k] * displacement[k][axis]).sum())
    }

    /// Takes the exact places of the two, and the plane that belongs to them.
    #[cold]
    fn look_closer(&mut self, step: &Step<'_, R>, least: R) -> Outcome {
        let [x0, x1] = step.cloth(self.points);
        let [q0, q1] = step.surface(self.collider_points);
        let at_start = closest(x0, q0);
        let start_line = weigh(x0, at_start.0) - weigh(q0, at_start.1);
        let at_end = closest(x1, q1);
        let thickness = step.kept(self.points, at_end.0.map(R::from_f64)).to_f64();
        let line = weigh(x1, at_end.0) - weigh(q1, at_end.1);
        let distance = line.norm();
        let mut proof = None;
        if least < R::ZERO {
            let directions = [start_line, across(x1, q1), across(x0, q0), line];
            let Some((gap, normal)) = best_plane(directions, [x0, x1], [q0, q1]) else {
                return Outcome::Tangled;
            };
            if gap < 0.0 && self.may_pass(step) {
                return Outcome::Apart; // It is on the other side from now on.
            }
            if gap < 0.0 {
                self.turn_to(normal, at_start, step);
                self.carry(step, R::from_f64(thickness - gap));
                return Outcome::Caught;
            }
            proof = Some(normal);
        }
        let old = Point::new(self.normal[0].to_f64(), self.normal[1].to_f64(), self.normal[2].to_f64());
        let normal = line.try_normalize(1e-9).or(proof).unwrap_or(old);
        self.turn_to(normal, at_end, step);
        if distance >= thickness * (1.0 - TOUCH) {
            return Outcome::Apart;
        }
        self.push(step, R::from_f64(thickness - distance), R::from_f64(thickness - start_line.norm()));
        Outcome::Pushed
    }

    /// Sets the plane, and the contact it belongs to.
    fn turn_to(&mut self, normal: Point, (b, c): ([f64; N], [f64; M]), step: &Step<'_, R>) {
        self.normal = [normal.x, normal.y, normal.z].map(R::from_f64);
        // As it is rounded, so that plane and direction belong together to the last bit.
        let normal = Point::from(self.normal.map(R::to_f64));
        for (end, time) in step.span.into_iter().enumerate() {
            let support = self.collider_points.iter().map(|&q| normal.dot(&step.surface_point(q, time)));
            let support = support.fold(f64::NEG_INFINITY, f64::max);
            self.plane[end] = self
                .points
                .map(|point| R::from_f64(support - normal.dot(&Point::from(step.anchors[point as usize]))));
        }
        let ends = step.collider.map(|points| weigh(self.collider_points.map(|q| points[q as usize]), c));
        let motion = ends[1] - ends[0];
        self.weights = b.map(R::from_f64);
        self.surface_motion = [motion.x, motion.y, motion.z].map(R::from_f64);
        let contact = self.contact(self.points.map(|point| step.moved(point).xyz()));
        let time = R::from_f64(step.time[1]);
        self.found_at = std::array::from_fn(|axis| contact[axis] - self.surface_motion[axis] * time);
    }

    /// Moves the cloth's points by `depth` along the plane's normal at the contact, with friction.
    /// `before` is how much of that was missing when the step began.
    fn push(&self, step: &Step<'_, R>, depth: R, before: R) {
        let rows = self.points.map(|point| step.moved(point));
        let mobility: R = (0..N).map(|k| rows[k].0[3] * self.weights[k] * self.weights[k]).sum();
        // Beside a pinned point the arm is short, and what is free would be flung.
        let least = rows.iter().fold(R::ZERO, |most, row| if row.0[3] > most { row.0[3] } else { most });
        let least = least * R::from_f64(LEAST_ARM);
        let mobility = if mobility < least { least } else { mobility };
        if mobility <= R::ZERO {
            return;
        }
        let mut push = Push::new(depth, before, step.h);
        if step.terms.is_weak(step.maps) {
            push = push.times(step.terms.strength_at(step.maps, self.sides(&(self.weights, []))));
        }
        let along = self.normal.map(|n| n * push.length());
        let rub = self.friction(step, rows, along, push.pressed);
        for k in 0..N {
            let mobile = rows[k].0[3] * self.weights[k] / mobility;
            let mut row = rows[k];
            for axis in 0..3 {
                row.0[axis] += mobile * (along[axis] + rub[axis]);
            }
            self.write(step, self.points[k], row, self.normal.map(|n| n * push.led * mobile));
        }
    }

    /// The points of the cloth's element, with how near each of them is; of the collider's there is nothing to tell.
    fn sides<'a>(&self, weights: &'a ([R; N], [R; 0])) -> Sides<'a, R, N, 0> {
        (self.points, [], weights)
    }

    /// Moves all of the cloth's element along the plane's normal: no point of it is behind the plane then.
    fn carry(&self, step: &Step<'_, R>, depth: R) {
        for point in self.points {
            let mut row = step.moved(point);
            if row.0[3] > R::ZERO {
                for axis in 0..3 {
                    row.0[axis] += self.normal[axis] * depth;
                }
                self.write(step, point, row, [R::ZERO; 3]);
            }
        }
    }

    /// Whether it is certain that the two did not pass each other in this step; takes up another plane if that
    /// proves it. What was not apart when the step began has nothing to lose.
    #[inline]
    pub fn prove(&mut self, step: &Step<'_, R>) -> bool {
        let moved = self.points.map(|point| step.moved(point).xyz());
        let size = moved[0].into_iter().map(|x| if x > R::ZERO { x } else { -x }).sum::<R>();
        // What lies within rounding of the plane is looked at in double precision.
        let grain = (size + step.thickness) * (R::EPSILON * R::from_f64(16.0));
        let (_, at_end) = self.gaps(moved, step.share(step.time[1]));
        // The plane may be of the end of a pass in this step, and good for nothing at its start.
        let (_, at_start) = self.gaps(self.points.map(|point| step.start(point)), step.share(step.time[0]));
        (at_end > grain && at_start > grain) || self.may_pass(step) || self.prove_otherwise(step)
    }

    /// Whether the scene lets the two pass through each other: a collision that is carried out in part is none that holds.
    #[cold]
    fn may_pass(&self, step: &Step<'_, R>) -> bool {
        let of_points = |map: &[R]| map.is_empty() || self.points.iter().any(|&p| map[p as usize] < R::ONE);
        let all = step.terms.strength.iter().any(|&side| side < R::ONE);
        step.terms.is_weak(step.maps) && (all || of_points(&step.maps.strength))
    }

    #[cold]
    fn prove_otherwise(&mut self, step: &Step<'_, R>) -> bool {
        let (cloth, surface) = (step.cloth(self.points), step.surface(self.collider_points));
        let ([x0, x1], [q0, q1]) = (cloth, surface);
        let at_start = closest(x0, q0);
        let line = |x, q, (b, c)| weigh(x, b) - weigh(q, c);
        let directions =
            [line(x0, q0, at_start), across(x1, q1), across(x0, q0), line(x1, q1, closest(x1, q1))];
        match best_plane(directions, cloth, surface) {
            Some((gap, normal)) if gap > 0.0 => self.turn_to(normal, at_start, step),
            Some(_) => return false,
            None => {}
        }
        true
    }

    /// Takes the cloth's element along with the surface, as it was at the start of the step.
    pub fn ride(&self, step: &Step<'_, R>) {
        let passed = R::from_f64(step.time[1] - step.time[0]);
        for point in self.points {
            let mut row = step.moved(point);
            if row.0[3] > R::ZERO {
                let start = step.start(point);
                for axis in 0..3 {
                    row.0[axis] = start[axis] + self.surface_motion[axis] * passed;
                }
                self.write(step, point, row, [R::ZERO; 3]);
            }
        }
    }

    /// The correction along the surface, against the motion over it within the step.
    fn friction(&self, step: &Step<'_, R>, rows: [Row4<R>; N], along: [R; 3], pressed: R) -> [R; 3] {
        let slip_limit = step.terms.friction_at(step.maps, self.sides(&(self.weights, []))) * pressed;
        if slip_limit <= R::ZERO {
            return [R::ZERO; 3];
        }
        let start = self.contact(self.points.map(|point| step.start(point)));
        let now = self.contact(rows.map(|row| row.xyz()));
        let passed = R::from_f64(step.time[1] - step.time[0]);
        let motion: [R; 3] = std::array::from_fn(|axis| {
            now[axis] + along[axis] - start[axis] - self.surface_motion[axis] * passed
        });
        rub(motion, self.normal, slip_limit)
    }

    #[allow(unsafe_code)]
    #[inline(always)]
    fn write(&self, step: &Step<'_, R>, point: u32, row: Row4<R>, led: [R; 3]) {
        // SAFETY: the phase hands every task points of its own.
        unsafe {
            step.displacement.set(point, row);
            let mut predicted = step.predicted.get(point);
            for axis in 0..3 {
                predicted.0[axis] += led[axis];
            }
            step.predicted.set(point, predicted);
        }
    }
}

/// Among some directions, each taken both ways, the one that separates the two at the start of the step
/// and leaves the largest gap at its end.
fn best_plane<const N: usize, const M: usize>(
    directions: [Point; 4],
    [x0, x1]: [[Point; N]; 2],
    [q0, q1]: [[Point; M]; 2],
) -> Option<(f64, Point)> {
    let gap = |n: Point, x: &[Point], q: &[Point]| {
        let least = x.iter().map(|x| n.dot(x)).fold(f64::INFINITY, f64::min);
        least - q.iter().map(|q| n.dot(q)).fold(f64::NEG_INFINITY, f64::max)
    };
    let units = directions.into_iter().filter_map(|direction| direction.try_normalize(1e-12));
    let planes = units.flat_map(|n| [n, -n]).filter(|&n| gap(n, &x0, &q0) > 0.0);
    planes.map(|n| (gap(n, &x1, &q1), n)).max_by(|a, b| a.0.total_cmp(&b.0))
}

/// The closest points of two elements, as weights.
fn closest<const N: usize, const M: usize>(x: [Point; N], q: [Point; M]) -> ([f64; N], [f64; M]) {
    narrow::closest(x.map(Into::into), q.map(Into::into))
}

/// A direction across two elements, of any length.
fn across<const N: usize, const M: usize>(x: [Point; N], q: [Point; M]) -> Point {
    narrow::across(x.map(Into::into), q.map(Into::into)).into()
}

fn weigh<const K: usize>(points: [Point; K], weights: [f64; K]) -> Point {
    (0..K).map(|k| points[k] * weights[k]).sum()
}
