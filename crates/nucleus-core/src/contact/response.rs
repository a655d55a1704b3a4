//! Contact response: how a push is split, Coulomb friction in positions, and adhesion.
//!
//! Adhesion (Maya's stickiness) removes a part of the motion by which two sides separate, as friction does along
//! the surface. At a sum of 1 they never separate, and with a friction of 1 they do not slide either. Below that
//! the separation speed decays as in a viscous film, by the sum of the stickinesses in each default substep of
//! Maya, independent of the step length.

use crate::input::frame::COUNT_PERIOD;
use crate::math::{Real, add, clamp_length, dot, max, min, scale, sub};
use crate::state::State;

/// Speed in m/s at which contact resolves a depth that existed before the step.
pub(super) const DEPENETRATION_SPEED: f64 = 1.0;
/// Share of the thickness that counts as touching: without a tolerance a contact at rest would push for ever at
/// its last bit.
pub(super) const TOUCH_TOLERANCE: f64 = 1e-6;

/// Smallest mobility of a contact, relative to that of its most mobile point: no point moves farther than 1 / this times
/// the depth.
const MIN_MOBILITY: f64 = 0.25;

/// The mobility of a contact: Σ w b² over its points, with inverse masses w in 1/kg and weights b.
///
/// Beside a pinned point the weights of the free points are small, and a push that only they take would throw them.
#[derive(Debug, Clone, Copy)]
pub struct Mobility<R> {
    sum: R,
    largest: R,
}

impl<R: Real> Mobility<R> {
    /// That of one side.
    #[inline(always)]
    pub fn of<const N: usize>(inverse_masses: [R; N], weights: [R; N]) -> Self {
        let mut own = Self { sum: R::ZERO, largest: R::ZERO };
        for k in 0..N {
            own.sum += inverse_masses[k] * weights[k] * weights[k];
            own.largest = max(own.largest, inverse_masses[k]);
        }
        own
    }

    /// That of two sides.
    #[inline(always)]
    pub fn and(self, other: Self) -> Self {
        Self { sum: self.sum + other.sum, largest: max(self.largest, other.largest) }
    }

    /// The mobility by which a push is divided; 0 where all points are pinned.
    #[inline(always)]
    pub fn total(self) -> R {
        max(self.sum, self.largest * R::from_f64(MIN_MOBILITY))
    }
}

/// A push along the contact normal, in metres.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Push<R> {
    /// The part that undoes the motion of this step: it changes velocity.
    pub pressed: R,
    /// The part that resolves a depth from before the step, slowly and without velocity. Cloth that starts too
    /// close does not jump, and cloth between two bodies with too little clearance does not tremble.
    pub depenetration: R,
}

impl<R: Real> Push<R> {
    /// Splits the push that brings a gap from `now` to `rest_gap`. `before` is the gap at the start of the step
    /// of length `h`. `depenetration` is how far contacts have already separated the two in this step; where
    /// other contacts have moved them together, that is reversed without velocity.
    #[inline(always)]
    pub fn new(rest_gap: R, [before, now]: [R; 2], depenetration: R, h: R) -> Self {
        let depth = rest_gap - now;
        let prior_depth = clamp(rest_gap - before - depenetration, depth);
        let most = h * R::from_f64(DEPENETRATION_SPEED);
        let depenetration = clamp(
            if depenetration < R::ZERO { max(most, -depenetration) } else { most - depenetration },
            prior_depth,
        );
        Self { pressed: depth - prior_depth, depenetration }
    }

    /// A share of the push.
    #[inline(always)]
    pub fn scaled(self, share: R) -> Self {
        Self { pressed: self.pressed * share, depenetration: self.depenetration * share }
    }

    /// The whole push.
    #[inline(always)]
    pub fn length(&self) -> R {
        self.pressed + self.depenetration
    }
}

/// The correction along the surface: against the relative motion within the step, up to `limit`, which is
/// friction times push (Coulomb's law in positions). The second value is the part without velocity: it reverses
/// depenetration by other contacts.
#[inline(always)]
pub fn coulomb_correction<R: Real>(
    [motion, depenetration]: [[R; 3]; 2],
    normal: [R; 3],
    limit: R,
) -> [[R; 3]; 2] {
    let along = |x: [R; 3]| sub(x, scale(normal, dot(x, normal)));
    let sliding = along(motion);
    let length = dot(sliding, sliding).sqrt();
    let share = if length <= limit { R::ONE } else { limit / length };
    [scale(sliding, -share), scale(along(depenetration), -share)]
}

/// `x` between zero and `most`.
#[inline(always)]
fn clamp<R: Real>(x: R, most: R) -> R {
    if x < R::ZERO {
        R::ZERO
    } else if x > most {
        most
    } else {
        x
    }
}

/// Time in seconds in which stickiness removes its share of a speed: Maya's default substep.
const ADHESION_PERIOD: f64 = COUNT_PERIOD / 3.0;
/// Range of adhesion, in thicknesses.
pub const ADHESION_RANGE: f64 = 1.5;

/// Adhesion of two sides at a contact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Adhesion<R> {
    /// Distance in metres up to which it acts, at the start of a step.
    pub range: R,
    /// Contact thickness in metres: below it contact pushes, and adhesion has no effect.
    pub thickness: R,
    /// Sum of the two stickinesses.
    pub stickiness: R,
    /// Sum of the two frictions.
    pub friction: R,
}

impl<R: Real> Adhesion<R> {
    /// The correction in metres to the motion of one side relative to the other in a step of length `h`. `before`
    /// and `now` are the lines between the contact points, `normal` is the contact normal. `None` out of range.
    #[inline]
    pub fn correction(&self, before: [R; 3], now: [R; 3], normal: [R; 3], h: R) -> Option<[R; 3]> {
        let [gap_before, gap] = [before, now].map(|line| dot(normal, line));
        if gap_before > self.range || self.stickiness <= R::ZERO {
            return None;
        }
        let motion = sub(now, before);
        let sliding = sub(motion, scale(normal, dot(normal, motion)));
        let rest_gap = if gap_before > self.thickness { gap_before } else { self.thickness };
        let separation = if gap > rest_gap { gap - rest_gap } else { R::ZERO };
        let [normal_share, sliding_share] =
            [self.stickiness, self.stickiness * self.friction].map(|grip| share_per_step(grip, h));
        Some(scale(add(scale(normal, separation * normal_share), scale(sliding, sliding_share)), -R::ONE))
    }
}

/// The share of a motion that is removed in a step of length `h`.
#[inline(always)]
pub fn share_per_step<R: Real>(grip: R, h: R) -> R {
    let left = (R::ONE - grip) * R::from_f64(ADHESION_PERIOD);
    if left <= R::ZERO { R::ONE } else { grip * h / (left + grip * h) }
}

/// Gap above the thickness up to which a contact is touching, as a share of the thickness; elements of a released seam touch at
/// a distance below it.
pub const TOUCHING_GAP: f64 = 1e-3;

/// Restitution at a surface in one step.
#[derive(Debug, Clone, Copy)]
pub struct Restitution<R> {
    /// Coefficient of restitution, 0 to 1.
    pub coefficient: R,
    /// The sum of both frictions.
    pub friction: R,
    /// Approach speed in m/s below which there is none: resting contacts would jitter on the speed that gravity
    /// adds in each step.
    pub min_speed: R,
    /// Length of the step in seconds.
    pub h: R,
}

/// A point that touches the ground or a collider at the end of a step.
#[derive(Debug, Clone, Copy)]
pub struct TouchingPoint<R> {
    /// The point.
    pub row: u32,
    /// Unit normal of the surface.
    pub normal: [R; 3],
    /// Its velocity, in m/s.
    pub surface: [R; 3],
    /// Coefficient of restitution, 0 to 1.
    pub coefficient: R,
    /// The sum of both frictions.
    pub friction: R,
    /// Its distance in metres.
    pub gap: R,
    /// Whether it is nearest to an edge or a corner of the face that it touches.
    pub is_rim: bool,
}

/// Which of the touches of a point with a collider count: those with the inside of a face, else the nearest one. Beside an edge
/// of a flat mesh the direction to the rim of the next face is no slope that the point hits.
#[derive(Debug, Clone, Copy)]
pub struct CountedTouches<R> {
    has_face: bool,
    nearest: R,
}

impl<R: Real> CountedTouches<R> {
    /// Those of a point, if it has any.
    pub fn of(touches: impl Iterator<Item = TouchingPoint<R>>) -> Option<Self> {
        touches
            .map(|touch| Self { has_face: !touch.is_rim, nearest: touch.gap })
            .reduce(|a, b| Self { has_face: a.has_face || b.has_face, nearest: min(a.nearest, b.nearest) })
    }

    /// Whether a touch counts.
    pub fn contain(&self, touch: &TouchingPoint<R>) -> bool {
        if self.has_face { !touch.is_rim } else { touch.gap <= self.nearest }
    }
}

/// The state of a point after its contacts.
#[derive(Debug, Clone, Copy)]
pub struct Impact<R> {
    /// Predicted displacement in metres.
    pub predicted: [R; 3],
    /// Displacement now, in metres.
    pub displacement: [R; 3],
    /// Velocity now, in m/s.
    pub velocity: [R; 3],
}

impl<R: Real> Impact<R> {
    /// That of a point, by its row.
    pub fn of(state: &State<R>, row: usize) -> Self {
        Self {
            predicted: add(
                state.predicted[row].xyz(),
                add(state.depenetration[row].xyz(), state.bearing_depenetration[row].xyz()),
            ),
            displacement: state.displacement[row].xyz(),
            velocity: state.velocity[row].xyz(),
        }
    }

    /// The speed along a normal that corrections gave to it, in a step of `h` seconds.
    pub fn push_speed(&self, normal: [R; 3], h: R) -> R {
        dot(normal, sub(self.displacement, self.predicted)) / h
    }
}

impl<R: Real> Restitution<R> {
    /// The largest gap that counts as touching, in contact thicknesses.
    pub const MAX_TOUCHING_GAP: f64 = 1.0 + TOUCHING_GAP;

    /// That at a point that touches.
    pub fn at(&self, touch: &TouchingPoint<R>) -> Self {
        Self { coefficient: touch.coefficient, friction: touch.friction, ..*self }
    }

    /// Whether a gap counts as touching.
    pub fn touches(gap: R, thickness: R) -> bool {
        gap <= thickness * R::from_f64(Self::MAX_TOUCHING_GAP)
    }

    /// The velocity after collision with a surface of this normal and velocity. Friction takes its share of the rebound too: with
    /// what the pushes of the step had, it is Coulomb's share of the whole impulse, wherever in the step the collision was.
    pub fn velocity_after(&self, impact: &Impact<R>, normal: [R; 3], surface: [R; 3]) -> [R; 3] {
        let speed = dot(normal, sub(impact.velocity, surface));
        let before = speed - impact.push_speed(normal, self.h);
        let after = -(self.coefficient * before);
        if -before <= self.min_speed || speed >= after {
            return impact.velocity;
        }
        let rebound = after - speed;
        let sliding = sub(sub(impact.velocity, surface), scale(normal, speed));
        let stopped = clamp_length(sliding, self.friction * rebound);
        std::array::from_fn(|axis| impact.velocity[axis] + normal[axis] * rebound - stopped[axis])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ADHESION: Adhesion<f64> =
        Adhesion { range: 0.015, thickness: 0.01, stickiness: 0.5, friction: 0.4 };

    #[test]
    fn stickiness_takes_its_share_of_the_separation_in_a_default_substep() {
        let correction =
            ADHESION.correction([0.0, 0.01, 0.0], [0.0, 0.03, 0.0], [0.0, 1.0, 0.0], ADHESION_PERIOD);
        assert!((correction.expect("it holds")[1] + 0.01).abs() < 1e-15);
    }

    #[test]
    fn adhesion_depends_little_on_the_step_length() {
        let left = |steps: i32| (1.0 - share_per_step(0.5, ADHESION_PERIOD / f64::from(steps))).powi(steps);
        // The limit for short steps is exp(-1) at one half; one step of a period gives 1 / (1 + 1).
        assert!((left(1) - 0.5).abs() < 1e-15);
        assert!((left(10_000) - (-1.0f64).exp()).abs() < 1e-4);
    }

    #[test]
    fn a_stickiness_of_one_allows_neither_separation_nor_sliding() {
        let full = Adhesion { stickiness: 1.0, friction: 1.0, ..ADHESION };
        let correction = full.correction([0.0, 0.01, 0.0], [0.002, 0.02, 0.0], [0.0, 1.0, 0.0], 1e-4);
        assert_eq!(correction, Some([-0.002, -0.01, 0.0]));
    }

    #[test]
    fn adhesion_does_not_act_on_approach() {
        let correction =
            ADHESION.correction([0.0, 0.014, 0.0], [0.0, 0.012, 0.0], [0.0, 1.0, 0.0], ADHESION_PERIOD);
        assert_eq!(correction, Some([-0.0; 3]));
    }
}
