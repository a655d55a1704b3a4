//! Rotation of particles (`computeRotation`): contact spins them, and an orientation follows.
//!
//! A particle that touches a surface slips on it with the velocity of its lowest point. Friction takes a share of the slip
//! in each default substep of Maya, whatever the length of a substep here; at a share of 1 the particle rolls. Rotation does
//! not act back on the motion, as in Maya: a particle is a point, and its rotation is for what is placed on it.
//!
//! Spin and orientation are updated at the end of each substep, from the contacts there.

use nalgebra::{Quaternion, UnitQuaternion, Vector3};

use crate::contact::response::share_per_step;
use crate::contact::touches::{Touch, list_touches};
use crate::input::frame::{COUNT_PERIOD, FrameInput};
use crate::math::Real;
use crate::particles::looks::speed;
use crate::particles::population::Rotation;
use crate::schedule::PassTime;
use crate::solver::Solver;

/// Spins and turns the particles of all objects with rotation for a substep that ends `now`.
pub fn turn_particles<R: Real>(solver: &mut Solver<R>, frame: &FrameInput, now: PassTime) {
    if solver.state.populations.iter().all(|population| population.rotations().is_empty()) {
        return;
    }
    let Solver { model, state, contact, .. } = solver;
    let length = now.length;
    let touches = list_touches(model, state, contact, now.at, frame.duration);
    for index in 0..state.populations.len() {
        let population = &state.populations[index];
        if population.rotations().is_empty() {
            continue;
        }
        let first = model.cloths[population.cloth()].blocks.rows().start;
        let radius =
            |at: usize| population.facts(at, speed(state, first as usize + at)).radius.max(f64::MIN_POSITIVE);
        let settings = &frame.cloths[population.cloth()];
        let share = share_per_step(settings.rotation_friction.clamp(0.0, 1.0), length);
        let kept = 1.0 / (1.0 + settings.rotation_damp.max(0.0) * length / COUNT_PERIOD);
        let turned: Vec<Rotation> = (0..population.len())
            .map(|at| {
                let touches = touches_of(&touches, first + at as u32);
                let rolling = rolling_spin(touches, radius(at));
                turn(&population.rotations()[at], rolling, [share, kept, length])
            })
            .collect();
        state.populations[index].set_rotations(turned);
    }
}

/// The touches of a point in a list that is sorted by points.
fn touches_of(touches: &[Touch], point: u32) -> &[Touch] {
    let first = touches.partition_point(|touch| touch.point < point);
    let end = touches.partition_point(|touch| touch.point <= point);
    &touches[first..end]
}

/// The direction of the normals of some touches, and the mean spin in rad/s with which a ball of a radius in metres rolls
/// without slip; `None` without touches.
fn rolling_spin(touches: &[Touch], radius: f64) -> Option<[Vector3<f64>; 2]> {
    if touches.is_empty() {
        return None;
    }
    let share = 1.0 / touches.len() as f64;
    let normal: Vector3<f64> = touches.iter().map(|touch| touch.normal * share).sum();
    let spin: Vector3<f64> =
        touches.iter().map(|touch| touch.normal.cross(&touch.velocity) * (share / radius)).sum();
    Some([normal.try_normalize(1e-9).unwrap_or_default(), spin])
}

/// The rotation after a substep: `share` of the slip is gone, `kept` of the spin remains, and the particle has turned for
/// `length` seconds.
fn turn(before: &Rotation, rolling: Option<[Vector3<f64>; 2]>, [share, kept, length]: [f64; 3]) -> Rotation {
    let mut spin = Vector3::from(before.spin);
    if let Some([normal, rolling]) = rolling {
        // Friction at a point takes no spin about the normal there.
        let about_normal = normal * normal.dot(&(spin - rolling));
        spin += (rolling + about_normal - spin) * share;
    }
    spin *= kept;
    let [x, y, z, w] = before.orientation;
    let [a, b, c, d] = step_of(spin * length);
    let turned = Quaternion::new(d, a, b, c) * Quaternion::new(w, x, y, z);
    let unit = UnitQuaternion::new_normalize(turned);
    Rotation { orientation: [unit.i, unit.j, unit.k, unit.w], spin: spin.into() }
}

/// The quaternion x, y, z, w of a turn, given by its axis times its angle in rad.
fn step_of(turn: Vector3<f64>) -> [f64; 4] {
    let angle = turn.norm();
    if angle <= 1e-12 {
        return Rotation::NONE.orientation;
    }
    let axis = turn * (libm::sin(angle / 2.0) / angle);
    [axis.x, axis.y, axis.z, libm::cos(angle / 2.0)]
}
