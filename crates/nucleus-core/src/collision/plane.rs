//! The ground plane: every point of a cloth stays above it by its thickness, with friction.
//!
//! A plane has no far side to pass to and no edges, so a point needs no pair: its height is one dot product.

use nalgebra::Vector3;

use super::friction::{Push, extra, rub};
use crate::columns::Shared;
use crate::scalar::{Real, Row4, dot};
use std::ops::Range;

/// The plane as a cloth meets it in one step.
pub struct Ground<'a, R> {
    /// Displacements, with the inverse mass.
    pub displacement: Shared<'a, Row4<R>>,
    /// Predicted displacements.
    pub predicted: Shared<'a, Row4<R>>,
    /// Displacements at the start of the step.
    pub start: &'a [Row4<R>],
    /// Height of each anchor above the plane, in metres.
    pub height: &'a [R],
    /// The plane's normal, of unit length.
    pub normal: [R; 3],
    /// Thickness of the cloth in metres.
    pub thickness: R,
    /// Sum of the two frictions.
    pub friction: R,
    /// What points have of it beyond their cloth; empty where nothing has.
    pub extra_friction: &'a [R],
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
    #[allow(unsafe_code)]
    pub fn lift(&self, points: Range<u32>) -> u64 {
        // SAFETY: the phase hands every task a block of its own.
        let rows = unsafe { self.displacement.run(points.clone()) };
        let mut contacts = 0;
        for (row, point) in rows.iter_mut().zip(points) {
            let gap = self.height[point as usize] + dot(self.normal, row.xyz());
            if gap < self.thickness && row.0[3] > R::ZERO {
                contacts += 1;
                self.lift_point(point, row, gap);
            }
        }
        contacts
    }

    #[allow(unsafe_code)]
    fn lift_point(&self, point: u32, row: &mut Row4<R>, gap: R) {
        // SAFETY: as above.
        let mut p = unsafe { self.predicted.get(point) };
        let start = self.start[point as usize].xyz();
        let gap_at_start = self.height[point as usize] + dot(self.normal, start);
        let push = Push::new(self.thickness - gap, self.thickness - gap_at_start, self.h);
        let motion: [R; 3] = std::array::from_fn(|axis| row.0[axis] - start[axis]);
        let friction = self.friction + extra(self.extra_friction, [point], [R::ONE]);
        let rub = rub(motion, self.normal, friction * push.pressed);
        for axis in 0..3 {
            row.0[axis] += self.normal[axis] * push.length() + rub[axis];
            p.0[axis] += self.normal[axis] * push.led;
        }
        // SAFETY: as above.
        unsafe { self.predicted.set(point, p) };
    }
}
