//! Stickiness between two elements that can both be moved.

use super::near::{Motion, Near};
use crate::contact::narrow::shortest;
use crate::contact::stick::Adhesion;
use crate::math::Real;

impl<R: Real, const N: usize, const M: usize> Near<R, N, M> {
    /// Holds the two to each other by what sticks; whether anything did.
    pub fn stick(&self, step: &Motion<'_, R>) -> bool {
        let Some(terms) = self.terms(step).filter(|terms| terms.sticks()) else { return false };
        let (now, before) = (self.now(step), self.before(step));
        let (normal, weights, _) = shortest(before);
        let thickness = self.thickness_at(step.terms, step.maps, &weights);
        let adhesion = Adhesion {
            reach: thickness * R::from_f64(terms.reach),
            thickness,
            stickiness: terms.stickiness_at(step.maps, self.sides(&weights)),
            friction: terms.friction_at(step.maps, self.sides(&weights)),
        };
        let [before, now] = [self.line(&before, &weights), self.line(&now, &weights)];
        let held = adhesion.hold(before, now, normal, step.h);
        held.inspect(|&held| self.part(step, terms, &weights, held, [R::ZERO; 3])).is_some()
    }
}
