//! Stickiness: two that touch come apart slowly, or not at all.
//!
//! Stickiness takes away a part of the motion by which two sides leave each other, as friction does along them. At a sum
//! of 1 they never part, and with a friction of 1 they do not slide either: full grip. Below that their parting speed
//! falls as in a viscous film, by the sum of the stickinesses in each default substep of Maya, however short steps are.

use crate::input::frame::COUNT_PERIOD;
use crate::math::{Real, add, dot, scale, sub};

/// The time in seconds in which a stickiness takes away its share of a speed: Maya's default substep.
const PERIOD: f64 = COUNT_PERIOD / 3.0;
/// Thicknesses up to which it reaches.
pub const REACH: f64 = 1.5;

/// What holds two sides together.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Adhesion<R> {
    /// The distance in metres up to which it reaches when a step begins.
    pub reach: R,
    /// The distance in metres that is nobody's to take away: contact keeps it.
    pub thickness: R,
    /// Sum of the two stickinesses.
    pub stickiness: R,
    /// Sum of the two frictions.
    pub friction: R,
}

impl<R: Real> Adhesion<R> {
    /// The correction, in metres, to the way that one side has gone from the other in a step of length `h`: `before` and
    /// `now` lead from one contact point to the other, `normal` is the direction between them.
    #[inline]
    pub fn hold(&self, before: [R; 3], now: [R; 3], normal: [R; 3], h: R) -> Option<[R; 3]> {
        let [gap_before, gap] = [before, now].map(|line| dot(normal, line));
        if gap_before > self.reach || self.stickiness <= R::ZERO {
            return None;
        }
        let way = sub(now, before);
        let slip = sub(way, scale(normal, dot(normal, way)));
        let kept = if gap_before > self.thickness { gap_before } else { self.thickness };
        let parting = if gap > kept { gap - kept } else { R::ZERO };
        let [parted, slid] = [self.stickiness, self.stickiness * self.friction].map(|grip| share(grip, h));
        Some(scale(add(scale(normal, parting * parted), scale(slip, slid)), -R::ONE))
    }
}

/// The share of a motion that is taken away in a step of length `h`.
#[inline(always)]
fn share<R: Real>(grip: R, h: R) -> R {
    let left = (R::ONE - grip) * R::from_f64(PERIOD);
    if left <= R::ZERO { R::ONE } else { grip * h / (left + grip * h) }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ADHESION: Adhesion<f64> =
        Adhesion { reach: 0.015, thickness: 0.01, stickiness: 0.5, friction: 0.4 };

    #[test]
    fn stickiness_takes_its_share_of_the_parting_in_a_default_substep() {
        let held = ADHESION.hold([0.0, 0.01, 0.0], [0.0, 0.03, 0.0], [0.0, 1.0, 0.0], PERIOD);
        assert!((held.expect("it holds")[1] + 0.01).abs() < 1e-15);
    }

    #[test]
    fn the_speed_that_is_left_depends_little_on_how_long_steps_are() {
        let left = |steps: i32| (1.0 - share(0.5, PERIOD / f64::from(steps))).powi(steps);
        // The limit of ever shorter steps is exp(-1) for one half, 1 / (1 + 1) the longest.
        assert!((left(1) - 0.5).abs() < 1e-15);
        assert!((left(10_000) - (-1.0f64).exp()).abs() < 1e-4);
    }

    #[test]
    fn at_a_sum_of_one_nothing_parts_and_nothing_slides() {
        let full = Adhesion { stickiness: 1.0, friction: 1.0, ..ADHESION };
        let held = full.hold([0.0, 0.01, 0.0], [0.002, 0.02, 0.0], [0.0, 1.0, 0.0], 1e-4);
        assert_eq!(held, Some([-0.002, -0.01, 0.0]));
    }

    #[test]
    fn what_comes_nearer_is_not_pulled() {
        let held = ADHESION.hold([0.0, 0.014, 0.0], [0.0, 0.012, 0.0], [0.0, 1.0, 0.0], PERIOD);
        assert_eq!(held, Some([-0.0; 3]));
    }
}
