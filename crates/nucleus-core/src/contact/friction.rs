//! Friction, and how much of a push may count as motion.

use crate::math::{Real, dot, max, scale, sub};

/// The speed in m/s at which cloth that starts a step inside the thickness is led out of it.
const PUSH_OUT_SPEED: f64 = 1.0;

/// A push out of a contact, in metres.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Push<R> {
    /// What undoes the motion of this step: it takes up velocity.
    pub pressed: R,
    /// What leads out of a depth that was there before the step, slowly and without velocity: a cloth that
    /// was put down too close does not jump, and one between two bodies that leave too little room does not tremble.
    pub led: R,
}

impl<R: Real> Push<R> {
    /// Splits the push that brings a gap from `now` to what is `kept`. The gap was `before` when the step of length `h`
    /// began; since then contacts `led` the two apart by so much. What others led them together by is given back without
    /// velocity.
    #[inline(always)]
    pub fn new(kept: R, [before, now]: [R; 2], led: R, h: R) -> Self {
        let depth = kept - now;
        let free = clamp(kept - before - led, depth);
        let most = h * R::from_f64(PUSH_OUT_SPEED);
        let led = clamp(if led < R::ZERO { max(most, -led) } else { most - led }, free);
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
/// friction times how far the contact was pushed (Coulomb's law, in positions). Then the part of it that is not to become
/// velocity: it gives back what other contacts `led`.
#[inline(always)]
pub fn rub<R: Real>([motion, led]: [[R; 3]; 2], normal: [R; 3], limit: R) -> [[R; 3]; 2] {
    let along = |way: [R; 3]| sub(way, scale(normal, dot(way, normal)));
    let slip = along(motion);
    let length = dot(slip, slip).sqrt();
    let grip = if length <= limit { R::ONE } else { limit / length };
    [slip, along(led)].map(|way| scale(way, -grip))
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
