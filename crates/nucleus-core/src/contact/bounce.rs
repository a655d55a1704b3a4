//! Bounce: a point that hit something leaves with part of the speed it came with.
//!
//! Positions know nothing of bounce, so it is given when the velocities of the step are known: for each point
//! at the thickness of what it hit, the speed along the normal becomes the bounce times that before
//! (Müller et al. 2020, "Detailed rigid body simulation with extended position based dynamics", §3.6).

use crate::math::{Real, dot};

/// A contact counts as touching up to this much above the thickness.
const TOUCHES: f64 = 1e-3;

/// How a point bounces off a surface in one step.
#[derive(Debug, Clone, Copy)]
pub struct Bounce<R> {
    /// The part of the speed that is kept, 0 to 1.
    pub bounce: R,
    /// Slower than this in m/s nothing bounces: what rests would jitter on the speed that gravity gives it anew
    /// in every step.
    pub slowest: R,
    /// Length of the step in seconds.
    pub h: R,
}

/// A point after its contacts: its place before and after they pushed it, and its velocity now.
#[derive(Debug, Clone, Copy)]
pub struct Hit<R> {
    /// Predicted displacement.
    pub predicted: [R; 3],
    /// Displacement now.
    pub displacement: [R; 3],
    /// Velocity now.
    pub velocity: [R; 3],
}

impl<R: Real> Bounce<R> {
    /// Whether a gap counts as touching.
    pub fn touches(gap: R, thickness: R) -> bool {
        gap <= thickness * R::from_f64(1.0 + TOUCHES)
    }

    /// The velocity after the bounce off a surface with this normal and velocity.
    pub fn off(&self, hit: &Hit<R>, normal: [R; 3], surface: [R; 3]) -> [R; 3] {
        let now: [R; 3] = std::array::from_fn(|axis| hit.velocity[axis] - surface[axis]);
        let pushed: [R; 3] = std::array::from_fn(|axis| hit.displacement[axis] - hit.predicted[axis]);
        let speed = dot(normal, now);
        let before = speed - dot(normal, pushed) / self.h;
        let after = -(self.bounce * before);
        if -before <= self.slowest || speed >= after {
            return hit.velocity;
        }
        std::array::from_fn(|axis| hit.velocity[axis] + normal[axis] * (after - speed))
    }
}
