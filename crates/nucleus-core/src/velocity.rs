//! Velocity follows: what held a point back within the step has changed its velocity.
//!
//! v += (x - x_predicted) / h. Not v = (x - x_before) / h: that would take velocity from a difference of
//! rounded positions, and a free fall of 100 m would be 0.37 m off after a second at 20 substeps a frame.

use std::ops::Range;

use crate::columns::Shared;
use crate::scalar::{Lanes, Real, Row4};

/// Corrects the velocities of a run of points.
///
/// # Safety
/// No other task of the phase touches these points.
#[allow(unsafe_code)]
pub unsafe fn follow_positions<R: Real>(
    displacement: Shared<'_, Row4<R>>,
    predicted: Shared<'_, Row4<R>>,
    velocity: Shared<'_, Row4<R>>,
    points: Range<u32>,
    h: R,
) {
    // SAFETY: the caller's promise.
    let (displacement, predicted, velocity) =
        unsafe { (displacement.run(points.clone()), predicted.run(points.clone()), velocity.run(points)) };
    let per_h = R::Lanes::splat(R::ONE / h);
    for ((d, p), v) in displacement.iter().zip(predicted).zip(velocity) {
        *v = Row4((v.lanes() + (d.lanes() - p.lanes()) * per_h).to_array());
    }
}
