//! Particles lose speed without air: `conserve` keeps a share of the velocity from frame to frame, and `damp` takes it at
//! a rate, both in all directions and whatever the mass.

use crate::input::frame::{COUNT_PERIOD, ClothFrame, FrameInput};
use crate::math::Real;
use crate::model::ClothModel;
use crate::state::State;

/// Scales the velocities of particles that are not pinned, for `substep` seconds of a frame.
pub fn slow_particles<R: Real>(
    cloths: &[ClothModel<R>],
    state: &mut State<R>,
    frame: &FrameInput,
    substep: f64,
) {
    for (cloth, settings) in cloths.iter().zip(&frame.cloths) {
        let kept = kept_share(settings, substep, frame.duration);
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

/// The share of its velocity that a particle keeps in a substep.
pub fn kept_share(settings: &ClothFrame, substep: f64, frame: f64) -> f64 {
    let conserve = settings.conserve.clamp(0.0, 1.0);
    let conserved = if conserve < 1.0 { libm::pow(conserve, substep / frame) } else { 1.0 };
    // Implicit: a velocity shrinks but never changes its sign, however large the rate.
    conserved / (1.0 + settings.damp.max(0.0) * substep / COUNT_PERIOD)
}
