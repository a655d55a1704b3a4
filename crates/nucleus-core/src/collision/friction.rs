//! Friction, and how much of a push may count as motion.

use crate::scalar::{Real, dot};

/// The speed in m/s at which cloth that starts a step inside the thickness is led out of it.
const PUSH_OUT_SPEED: f64 = 1.0;

/// A push out of a contact, in metres.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Push<R> {
    /// What undoes the motion of this step: it takes up velocity, and friction goes by it.
    pub pressed: R,
    /// What leads out of a depth that was there before the step, slowly and without velocity: a cloth that
    /// was put down too close does not jump.
    pub led: R,
}

impl<R: Real> Push<R> {
    /// Splits a push of `depth`, of which `before` was missing already when the step of length `h` began.
    #[inline(always)]
    pub fn new(depth: R, before: R, h: R) -> Self {
        let free = clamp(before, depth);
        let led = clamp(h * R::from_f64(PUSH_OUT_SPEED), free);
        Self { pressed: depth - free, led }
    }

    /// A share of it.
    #[inline(always)]
    pub fn times(self, share: R) -> Self {
        Self { pressed: self.pressed * share, led: self.led * share }
    }

    /// The whole push.
    #[inline(always)]
    pub fn length(&self) -> R {
        self.pressed + self.led
    }
}

/// The correction along a surface: against the motion over it within the step, up to `limit`, which is the
/// friction times how far the contact was pressed (Coulomb's law, in positions).
#[inline(always)]
pub fn rub<R: Real>(motion: [R; 3], normal: [R; 3], limit: R) -> [R; 3] {
    let off = dot(motion, normal);
    let slip: [R; 3] = std::array::from_fn(|axis| motion[axis] - normal[axis] * off);
    let length = dot(slip, slip).sqrt();
    let grip = if length <= limit { R::ONE } else { limit / length };
    slip.map(|s| -(s * grip))
}

/// `x` between nought and `most`.
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
