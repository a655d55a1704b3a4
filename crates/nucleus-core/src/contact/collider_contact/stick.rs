//! Stickiness of cloth on a collider.

use super::{Pair, Step};
use crate::contact::stick::Adhesion;
use crate::math::Real;

impl<R: Real, const N: usize, const M: usize> Pair<R, N, M> {
    /// The gap at the end of the step.
    pub fn gap(&self, step: &Step<'_, R>) -> R {
        self.gaps(self.points.map(|point| step.moved(point).xyz()), step.share(step.time[1])).0
    }

    /// Holds the cloth's element to the surface by what sticks.
    pub fn stick(&self, step: &Step<'_, R>) {
        let sides = &(self.weights, []);
        let adhesion = Adhesion {
            reach: step.reach(),
            thickness: step.kept(self.points, self.weights),
            stickiness: step.terms.stickiness_at(step.maps, self.sides(sides)),
            friction: step.terms.friction_at(step.maps, self.sides(sides)),
        };
        let rows = self.points.map(|point| step.moved(point));
        let start = self.points.map(|point| step.start(point));
        let (gap, _) = self.gaps(start, step.share(step.time[0]));
        let (before, passed) = (self.normal.map(|n| n * gap), R::from_f64(step.time[1] - step.time[0]));
        let [from, to] = [self.contact(start), self.contact(rows.map(|row| row.xyz()))];
        let now = std::array::from_fn(|axis| {
            before[axis] + to[axis] - from[axis] - self.surface_motion[axis] * passed
        });
        let Some(held) = adhesion.hold(before, now, self.normal, step.h) else { return };
        let mobility: R = (0..N).map(|k| rows[k].0[3] * self.weights[k] * self.weights[k]).sum();
        if mobility > R::ZERO {
            for (k, mut row) in rows.into_iter().enumerate() {
                let part = row.0[3] * self.weights[k] / mobility;
                (0..3).for_each(|axis| row.0[axis] += part * held[axis]);
                step.mover.push(self.points[k], row, [R::ZERO; 3]);
            }
        }
    }
}
