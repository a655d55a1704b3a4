//! One pass over the links of a constraint, as the schedule plans it.

use crate::constraints::stretch::LinkStrength;
use crate::math::Real;

/// One pass over the links of a constraint.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LinkSweep<R> {
    /// The constraint, by its index.
    pub constraint: usize,
    /// Along links, and along the normals of surfaces; without the factor on rest lengths, which changes in the frame.
    pub normal: LinkStrength<R>,
    /// Along surfaces.
    pub tangent: LinkStrength<R>,
    /// Of folds.
    pub bend: LinkStrength<R>,
}

impl<R: Real> LinkSweep<R> {
    /// Each of two passes that together have this strength.
    pub fn half(&self) -> Self {
        let Self { constraint, normal, tangent, bend } = self;
        Self { constraint: *constraint, normal: normal.half(), tangent: tangent.half(), bend: bend.half() }
    }
}
