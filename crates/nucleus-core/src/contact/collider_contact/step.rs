//! Where cloth and collider are in a time step, as contacts see it.

use crate::contact::collider_contact::Point;
use crate::contact::maps::Maps;
use crate::contact::mover::Mover;
use crate::contact::terms::Terms;
use crate::math::{Real, Row4};

/// All that resolving a pair needs to know of the step.
pub struct Step<'a, R> {
    /// Places of the cloth's points.
    pub mover: Mover<'a, R>,
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
    pub(in crate::contact) fn kept<const N: usize>(&self, points: [u32; N], weights: [R; N]) -> R {
        if self.maps.thickness.is_empty() {
            return self.thickness;
        }
        let most = R::from_f64(self.terms.thickness);
        self.terms.thickness_at(self.maps, (points, [], &(weights, [])), most) * self.squeeze
    }

    /// The cloth's points at the start and at the end of the step.
    #[inline]
    pub(in crate::contact) fn cloth<const N: usize>(&self, points: [u32; N]) -> [[Point; N]; 2] {
        let end = std::array::from_fn(|k| self.place(points[k], self.moved(points[k]).xyz()));
        [self.cloth_at_start(points), end]
    }

    #[inline]
    pub(in crate::contact) fn cloth_at_start<const N: usize>(&self, points: [u32; N]) -> [Point; N] {
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
    pub fn push(&self, point: u32, push: Point, led: Point) {
        let mut row = self.moved(point);
        if row.0[3] > R::ZERO {
            (0..3).for_each(|axis| row.0[axis] += R::from_f64(push[axis]));
            self.mover.push(point, row, [led.x, led.y, led.z].map(R::from_f64));
        }
    }

    #[inline(always)]
    pub(in crate::contact) fn place(&self, point: u32, [x, y, z]: [R; 3]) -> Point {
        Point::from(self.anchors[point as usize]) + Point::new(x.to_f64(), y.to_f64(), z.to_f64())
    }

    /// How far a point of the collider goes in the span, beside the drift of so many metres in a frame.
    #[inline]
    pub(in crate::contact) fn way(&self, point: u32, drift: [R; 3]) -> f64 {
        let [start, end] = self.collider.map(|points| points[point as usize]);
        (end - start - Point::from(drift.map(R::to_f64))).norm() * (self.span[1] - self.span[0])
    }

    #[inline(always)]
    pub(in crate::contact) fn moved(&self, point: u32) -> Row4<R> {
        self.mover.row(point)
    }

    #[inline(always)]
    pub(in crate::contact) fn start(&self, point: u32) -> [R; 3] {
        self.start[point as usize].xyz()
    }

    /// The collider's points at the start and at the end of the step.
    #[inline]
    pub fn surface<const M: usize>(&self, points: [u32; M]) -> [[Point; M]; 2] {
        std::array::from_fn(|end| std::array::from_fn(|k| self.surface_point(points[k], self.time[end])))
    }

    /// A point of the collider at a time of the frame.
    #[inline]
    pub(in crate::contact) fn surface_point(&self, point: u32, time: f64) -> Point {
        let [start, end] = self.collider.map(|points| points[point as usize]);
        start + (end - start) * time
    }

    /// A time as a share of the span the pairs were found for.
    pub(in crate::contact) fn share(&self, time: f64) -> R {
        let [from, to] = self.span;
        R::from_f64(if to > from { (time - from) / (to - from) } else { 0.0 })
    }
}
