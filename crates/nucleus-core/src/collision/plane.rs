//! The ground plane: every point of a cloth stays above it by its thickness, with friction.
//!
//! A plane has no far side to pass to and no edges, so a point needs no pair: its height is one dot product.

use nalgebra::Vector3;

use super::friction::{Push, rub};
use super::maps::Maps;
use super::mover::Mover;
use super::stick::Adhesion;
use super::terms::{Sides, Terms};
use crate::scalar::{Real, Row4, add, dot, scale};
use std::ops::Range;

/// The plane as a cloth meets it in one step.
pub struct Ground<'a, R> {
    /// Places of the points.
    pub mover: Mover<'a, R>,
    /// Displacements at the start of the step.
    pub start: &'a [Row4<R>],
    /// Height of each anchor above the plane, in metres.
    pub height: &'a [R],
    /// The plane's normal, of unit length.
    pub normal: [R; 3],
    /// The share of every thickness that is kept.
    pub squeeze: R,
    /// How the cloth meets it.
    pub terms: Terms<R>,
    /// What the cloth's points bring into a contact beyond their cloth.
    pub maps: &'a Maps<R>,
    /// Length of the step in seconds.
    pub h: R,
}

/// The heights of anchors above a plane through `origin` with a normal of unit length.
pub fn heights<R: Real>(anchors: &[[f64; 3]], origin: Vector3<f64>, normal: Vector3<f64>, out: &mut Vec<R>) {
    out.clear();
    out.extend(anchors.iter().map(|&anchor| R::from_f64((Vector3::from(anchor) - origin).dot(&normal))));
}

impl<R: Real> Ground<'_, R> {
    /// Lifts the points of a run to the thickness; how many were pressed against it.
    pub fn lift(&self, points: Range<u32>) -> u64 {
        let mut contacts = 0;
        for point in points {
            let row = self.mover.row(point);
            let gap = self.height[point as usize] + dot(self.normal, row.xyz());
            let kept = self.kept(point);
            if gap < kept && row.0[3] > R::ZERO {
                contacts += 1;
                self.lift_point(point, row, [kept, gap]);
            }
        }
        contacts
    }

    /// Holds the points of a run to the plane by what sticks.
    pub fn stick(&self, points: Range<u32>) {
        let rows = points.map(|point| (self.mover.row(point), point));
        for (mut row, point) in rows.filter(|(row, _)| row.0[3] > R::ZERO) {
            let start = self.start[point as usize].xyz();
            let gap = self.height[point as usize] + dot(self.normal, start);
            let sides: Sides<'_, R, 1, 0> = ([point], [], &([R::ONE], []));
            let adhesion = Adhesion {
                reach: self.kept(point) * R::from_f64(self.terms.reach),
                thickness: self.kept(point),
                stickiness: self.terms.stickiness_at(self.maps, sides),
                friction: self.terms.friction_at(self.maps, sides),
            };
            let before = self.normal.map(|n| n * gap);
            let now = std::array::from_fn(|axis| before[axis] + row.0[axis] - start[axis]);
            let held = adhesion.hold(before, now, self.normal, self.h).unwrap_or([R::ZERO; 3]);
            (0..3).for_each(|axis| row.0[axis] += held[axis]);
            self.mover.push(point, row, [R::ZERO; 3]);
        }
    }

    /// The height that a point is kept at.
    #[inline(always)]
    fn kept(&self, point: u32) -> R {
        let most = R::from_f64(self.terms.thickness);
        self.terms.thickness_at(self.maps, ([point], [], &([R::ONE], [])), most) * self.squeeze
    }

    fn lift_point(&self, point: u32, mut row: Row4<R>, [kept, gap]: [R; 2]) {
        let start = self.start[point as usize].xyz();
        let gap_at_start = self.height[point as usize] + dot(self.normal, start);
        let led = self.mover.led(point);
        let mut push = Push::new(kept, [gap_at_start, gap], dot(self.normal, led), self.h);
        let sides: Sides<'_, R, 1, 0> = ([point], [], &([R::ONE], []));
        if self.terms.is_weak(self.maps) {
            push = push.times(self.terms.strength_at(self.maps, sides));
        }
        let motion: [R; 3] = std::array::from_fn(|axis| row.0[axis] - start[axis]);
        let friction = self.terms.friction_at(self.maps, sides);
        let [rub, given_back] = rub([motion, led], self.normal, friction * push.length());
        for axis in 0..3 {
            row.0[axis] += self.normal[axis] * push.length() + rub[axis];
        }
        self.mover.push(point, row, add(scale(self.normal, push.led), given_back));
    }
}
