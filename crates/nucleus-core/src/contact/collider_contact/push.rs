//! A contact with a collider pushes, with friction, and carries what it pushes along.

use super::Pair;
use super::step::Step;
use crate::contact::friction::{Push, rub};
use crate::contact::terms::Sides;
use crate::math::{Real, add, dot, scale};

/// Least mobility of an element, in that of its most mobile point: no point moves farther than 1 / this times
/// the depth of a contact.
const LEAST_ARM: f64 = 0.25;

impl<R: Real, const N: usize, const M: usize> Pair<R, N, M> {
    /// Moves the cloth's points along the plane's normal until `kept` is kept at the contact, with friction. `gaps` are those
    /// at the start of the step and now.
    pub(super) fn push(&self, step: &Step<'_, R>, kept: R, gaps: [R; 2]) {
        let rows = self.points.map(|point| step.moved(point));
        let mobility: R = (0..N).map(|k| rows[k].0[3] * self.weights[k] * self.weights[k]).sum();
        // Beside a pinned point the arm is short, and what is free would be flung.
        let least = rows.iter().fold(R::ZERO, |most, row| if row.0[3] > most { row.0[3] } else { most });
        let least = least * R::from_f64(LEAST_ARM);
        let mobility = if mobility < least { least } else { mobility };
        if mobility <= R::ZERO {
            return;
        }
        let led = self.led(step);
        let mut push = Push::new(kept, gaps, dot(self.normal, led), step.h);
        if step.terms.is_weak(step.maps) {
            push = push.times(step.terms.strength_at(step.maps, self.sides(&(self.weights, []))));
        }
        let (along, led_along) = (scale(self.normal, push.length()), scale(self.normal, push.led));
        let [rub, given_back] = self.friction(step, led, along, push.length());
        let (moved, led) = (add(along, rub), add(led_along, given_back));
        for k in 0..N {
            let mobile = rows[k].0[3] * self.weights[k] / mobility;
            let mut row = rows[k];
            for axis in 0..3 {
                row.0[axis] += mobile * moved[axis];
            }
            step.mover.push(self.points[k], row, scale(led, mobile));
        }
    }

    /// The points of the cloth's element, with how near each of them is; of the collider's there is nothing to tell.
    pub(super) fn sides<'a>(&self, weights: &'a ([R; N], [R; 0])) -> Sides<'a, R, N, 0> {
        (self.points, [], weights)
    }

    /// Moves all of the cloth's element along the plane's normal: no point of it is behind the plane then.
    pub(super) fn carry(&self, step: &Step<'_, R>, push: Push<R>) {
        for point in self.points {
            let mut row = step.moved(point);
            if row.0[3] > R::ZERO {
                for axis in 0..3 {
                    row.0[axis] += self.normal[axis] * push.length();
                }
                step.mover.push(point, row, self.normal.map(|n| n * push.led));
            }
        }
    }

    /// Takes the cloth's element along with the surface, as it was at the start of the step.
    pub fn ride(&self, step: &Step<'_, R>) {
        let passed = R::from_f64(step.time[1] - step.time[0]);
        for point in self.points {
            let mut row = step.moved(point);
            if row.0[3] > R::ZERO {
                let start = step.start(point);
                for axis in 0..3 {
                    row.0[axis] = start[axis] + self.surface_motion[axis] * passed;
                }
                step.mover.put(point, row);
            }
        }
    }

    /// The correction along the surface, against the motion over it within the step, and the part of it that is no motion.
    fn friction(&self, step: &Step<'_, R>, led: [R; 3], along: [R; 3], pushed: R) -> [[R; 3]; 2] {
        let slip_limit = step.terms.friction_at(step.maps, self.sides(&(self.weights, []))) * pushed;
        if slip_limit <= R::ZERO {
            return [[R::ZERO; 3]; 2];
        }
        let start = self.contact(self.points.map(|point| step.start(point)));
        let now = self.contact(self.points.map(|point| step.moved(point).xyz()));
        let passed = R::from_f64(step.time[1] - step.time[0]);
        let motion: [R; 3] = std::array::from_fn(|axis| {
            now[axis] + along[axis] - start[axis] - self.surface_motion[axis] * passed
        });
        rub([motion, led], self.normal, slip_limit)
    }
}
