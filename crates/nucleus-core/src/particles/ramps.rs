//! Ramps of particles: factors on the attributes of each particle, read by its age, speed, number or size (Maya's
//! `radiusScale` and the other ramps of nParticle).
//!
//! Ramps of attributes that act on the motion are evaluated at the end of each substep, and at the start of a frame, into
//! columns by row, which contact and liquids read as they read vertex maps.

use crate::contact::system::ContactSystem;
use crate::input::particles::RampTarget;
use crate::math::Real;
use crate::particles::looks::speed;
use crate::particles::population::Population;
use crate::solver::Solver;
use crate::state::{State, inverse_mass_of};

/// Evaluates the ramps that act on the motion into the columns of all objects.
pub fn apply_ramps<R: Real>(solver: &mut Solver<R>) {
    let Solver { model, state, contact, .. } = solver;
    let mut populations = std::mem::take(&mut state.populations);
    for population in populations.iter_mut().filter(|population| !population.ramps().is_empty()) {
        let first = model.cloths[population.cloth()].blocks.rows().start as usize;
        (0..population.len()).for_each(|at| apply_to(population, at, first + at, state, contact));
    }
    state.populations = populations;
}

/// Evaluates the ramps of one particle.
fn apply_to<R: Real>(
    population: &mut Population,
    at: usize,
    row: usize,
    state: &mut State<R>,
    contact: &mut ContactSystem<R>,
) {
    let facts = population.facts(at, speed(state, row));
    let maps = &mut contact.material_maps;
    for k in 0..population.ramps().len() {
        let ramp = &population.ramps()[k];
        let target = ramp.target;
        if target.is_look() {
            continue;
        }
        let factor = ramp.factor(&facts);
        let column = match target {
            RampTarget::Radius => &mut maps.thickness,
            RampTarget::Friction => &mut maps.friction,
            RampTarget::Stickiness => &mut maps.stickiness,
            RampTarget::Bounce => &mut maps.bounce,
            RampTarget::CollideStrength => &mut maps.strength,
            RampTarget::Mass => {
                set_mass(state, row, population.masses()[at] * factor);
                continue;
            }
            _ => {
                population.set_factor(target, at, factor);
                continue;
            }
        };
        column[row] = R::from_f64(factor);
    }
}

/// Gives a point another mass in kilograms; a pinned point stays pinned.
fn set_mass<R: Real>(state: &mut State<R>, row: usize, mass: f64) {
    state.inverse_mass[row] = inverse_mass_of(mass);
    if state.displacement[row].0[3] > R::ZERO {
        state.displacement[row].0[3] = state.inverse_mass[row];
    }
}
