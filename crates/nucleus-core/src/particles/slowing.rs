//! Particles lose speed without air: `conserve` keeps a share of the velocity from frame to frame, and `damp` takes it at
//! a rate, both in all directions and whatever the mass.
//!
//! Damping acts before the move in each time step, as drag does: dv = -k dx. So the way of a particle until it rests, and its
//! speed of fall, are exact for any length of the time step.

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

/// The share of its velocity that `damp` takes from a particle in a time step of so many seconds. Implicit: a velocity shrinks
/// but never changes its sign, however large the rate.
pub fn damped_share(settings: &ClothFrame, seconds: f64) -> f64 {
    let decay = settings.damp.clamp(0.0, MAX_DAMP) / COUNT_PERIOD * seconds;
    decay / (1.0 + decay)
}
