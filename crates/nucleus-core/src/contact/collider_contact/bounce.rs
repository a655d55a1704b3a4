//! Bounce off a collider: whether a pair touches, and what it touches.

use super::{Pair, Step};
use crate::contact::bounce::Bounce;
use crate::math::Real;

impl<R: Real, const N: usize, const M: usize> Pair<R, N, M> {
    /// The plane's normal, the collider's velocity at the contact in m/s, and whether the two touch at the end
    /// of the step.
    pub fn touch(&self, step: &Step<'_, R>, frame: f64) -> Option<([R; 3], [R; 3])> {
        let moved = self.points.map(|point| step.moved(point).xyz());
        let (gap, _) = self.gaps(moved, step.share(step.time[1]));
        let velocity = self.surface_motion.map(|x| x / R::from_f64(frame));
        Bounce::touches(gap, step.kept(self.points, self.weights)).then_some((self.normal, velocity))
    }
}
