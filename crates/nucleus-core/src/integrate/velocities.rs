//! Velocity follows: what held a point back within the step has changed its velocity.
//!
//! v += (x - x_predicted) / h, less depenetration. Not v = (x - x_before) / h: that would take velocity from a difference of
//! rounded positions, and a free fall of 100 m would be 0.37 m off after a second at 20 substeps a frame.

use std::ops::Range;

use crate::math::{Lanes, Real, Row4};
use crate::parallel::disjoint::DisjointSlice;

/// Corrects the velocities of a run of points; there is no `depenetration` where nothing can be met.
///
/// # Safety
/// No other task of the phase touches these points.
#[allow(unsafe_code)]
pub unsafe fn update_velocities<R: Real>(
    [displacement, predicted, velocity]: [DisjointSlice<'_, Row4<R>>; 3],
    depenetration: [&[Row4<R>]; 2],
    points: Range<u32>,
    h: R,
) {
    // SAFETY: the caller's promise.
    let (displacement, predicted, velocity) = unsafe {
        (displacement.run(points.clone()), predicted.run(points.clone()), velocity.run(points.clone()))
    };
    let depenetration = depenetration
        .map(|column| column.get(points.start as usize..points.end as usize).unwrap_or_default());
    let per_h = R::Lanes::splat(R::ONE / h);
    for (k, ((d, p), v)) in displacement.iter().zip(predicted).zip(velocity).enumerate() {
        let held = d.lanes() - p.lanes();
        // Depenetration moves a point without velocity.
        let without_depenetration =
            |held, column: &[Row4<R>]| column.get(k).map_or(held, |row| held - row.lanes());
        let held = depenetration.into_iter().fold(held, without_depenetration);
        *v = Row4((v.lanes() + held * per_h).to_array());
    }
}
