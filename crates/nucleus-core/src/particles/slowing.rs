//! Particles lose speed without air: `conserve` keeps a share of the velocity from frame to frame, and `damp` takes it at
//! a rate, both in all directions and whatever the mass.
//!
//! Damping acts before the move, as drag does, and the way of a time step is the loss of velocity over the rate, as in
//! dv = -k dx: of a single step, that at the velocity after it. So the way of a particle until it rests, and its speed of
//! fall, are exact for any length of the substeps.

use crate::input::frame::{COUNT_PERIOD, ClothFrame, FrameInput};
use crate::math::Real;
use crate::model::ClothModel;
use crate::state::State;

/// A `damp` beyond which a particle stops at once.
const MAX_DAMP: f64 = 1e12;

/// Scales the velocities of particles that are not pinned by `conserve`, for `substep` seconds of a frame.
pub fn conserve_velocities<R: Real>(
    cloths: &[ClothModel<R>],
    state: &mut State<R>,
    frame: &FrameInput,
    substep: f64,
) {
    for (cloth, settings) in cloths.iter().zip(&frame.cloths) {
        let kept = conserved_share(settings, substep, frame.duration);
        if kept >= 1.0 || cloth.has_faces {
            continue;
        }
        let kept = R::from_f64(kept);
        for row in cloth.points() {
            let row = row as usize;
            if state.displacement[row].0[3] > R::ZERO {
                let velocity = &mut state.velocity[row];
                (0..3).for_each(|axis| velocity.0[axis] = velocity.0[axis] * kept);
            }
        }
    }
}

/// The share of its velocity that a particle keeps by `conserve` in a substep.
pub fn conserved_share(settings: &ClothFrame, substep: f64, frame: f64) -> f64 {
    let conserve = settings.conserve.clamp(0.0, 1.0);
    if conserve < 1.0 { libm::pow(conserve, substep / frame) } else { 1.0 }
}

/// The damping of a particle in a time step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ParticleDamping {
    /// The share of its velocity that it loses: in short steps the share that it keeps would round to a wrong rate.
    pub lost: f64,
    /// Its way, relative to that at the velocity after the step.
    pub advance: f64,
}

impl ParticleDamping {
    /// None.
    pub const OFF: Self = Self { lost: 0.0, advance: 1.0 };

    /// That of some `seconds` of a substep.
    pub fn new(settings: &ClothFrame, seconds: f64, substep: f64) -> Self {
        let rate = settings.damp.clamp(0.0, MAX_DAMP) / COUNT_PERIOD;
        if rate * seconds <= 0.0 {
            return Self::OFF;
        }
        // Over the substep implicit: a velocity shrinks but never changes its sign, however large the rate.
        let decay = libm::log1p(rate * substep) * seconds / substep;
        Self { lost: -libm::expm1(-decay), advance: libm::expm1(decay) / (rate * seconds) }
    }
}
