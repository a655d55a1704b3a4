//! Contacts: a pair of elements, one of a cloth and one of a collider, kept apart by its thickness.
//!
//! A pair carries a separating plane: a direction `n`, and for each cloth point the gap n·x - max n·q over
//! the collider's points. Both sides move along straight lines within a step, so a positive gap at both ends
//! of the step, for one `n`, *proves* that nothing passed in between (the maximum of linear functions stays
//! below its chord). Where the pair's own plane proves nothing any more, others are tried; where none does,
//! the cloth would pass, and is pushed back to its side by the plane that held at the start of the step.

mod bounce;
mod proof;
mod push;
mod step;
mod stick;

pub use step::Step;

use nalgebra::Vector3;

use proof::{best_plane, stays};

use super::foresee::{Foreseen, spread};
use super::friction::Push;
use super::narrow;
use crate::bytes::encode_struct;
use crate::math::{Real, Row4, dot};

type Point = Vector3<f64>;

/// Parts in a million of the thickness that count as touching: without it a contact at rest would push
/// for ever at its last bit.
const TOUCH: f64 = 1e-6;
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

encode_struct!([R: Real, const N: usize, const M: usize] Pair<R, N, M> {
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
    Reverted,
    /// The two touched when the step began: no plane is between them, and they are left alone.
    Inseparable,
}

/// Whether it is certain that a pair did not pass each other in a step.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Proof {
    /// It is.
    Certain,
    /// It is not, and something has to be done.
    Open,
    /// The two touched when the step began, and one is behind the other's plane now: nothing can tell their sides.
    Inseparable,
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
        self.push(step, kept, [self.gap_at_start(step), gap]);
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

    /// The gap at the start of the step.
    #[inline(always)]
    fn gap_at_start(&self, step: &Step<'_, R>) -> R {
        self.gaps(self.points.map(|point| step.start(point)), step.share(step.time[0])).0
    }

    /// How far contacts led the cloth in this step, where this one is.
    #[inline(always)]
    fn led(&self, step: &Step<'_, R>) -> [R; 3] {
        self.contact(self.points.map(|point| step.mover.led(point)))
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
                return Outcome::Inseparable;
            };
            let passes = gap < 0.0 && !stays([x0, x1], [q0, q1]);
            if passes && self.may_pass(step) {
                return Outcome::Apart; // It is on the other side from now on.
            }
            if passes {
                self.turn_to(normal, at_start, step);
                let kept = R::from_f64(thickness);
                let (gaps, led) =
                    ([self.gap_at_start(step), R::from_f64(gap)], dot(self.normal, self.led(step)));
                self.carry(step, Push::new(kept, gaps, led, step.h));
                return Outcome::Reverted;
            }
            proof = (gap >= 0.0).then_some(normal);
        }
        let old = Point::new(self.normal[0].to_f64(), self.normal[1].to_f64(), self.normal[2].to_f64());
        let normal = line.try_normalize(1e-9).or(proof).unwrap_or(old);
        self.turn_to(normal, at_end, step);
        if distance >= thickness * (1.0 - TOUCH) {
            return Outcome::Apart;
        }
        self.push(step, R::from_f64(thickness), [start_line.norm(), distance].map(R::from_f64));
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
