//! The looks of particles, evaluated for an observer that asks: radius, opacity, colour and light.

use crate::input::particles::RampTarget;
use crate::math::{Real, dot};
use crate::output::ParticleLook;
use crate::particles::population::Population;
use crate::state::State;

/// The speed of a point in m/s.
pub fn speed<R: Real>(state: &State<R>, row: usize) -> f64 {
    let velocity = state.velocity[row].xyz().map(R::to_f64);
    dot(velocity, velocity).sqrt()
}

/// The looks of the particles of an object, in the order of their rows, of which the first is `first`.
pub fn looks<'a, R: Real>(
    population: &'a Population,
    state: &'a State<R>,
    first: usize,
) -> impl Iterator<Item = ParticleLook> + 'a {
    (0..population.len()).map(move |at| {
        let facts = population.facts(at, speed(state, first + at));
        let mut look = ParticleLook { radius: 1.0, opacity: 1.0, color: None, incandescence: [0.0; 3] };
        for ramp in population.ramps() {
            let factor = ramp.factor(&facts) as f32;
            match ramp.target {
                RampTarget::Radius => look.radius = factor,
                RampTarget::Opacity => look.opacity = factor.min(1.0),
                RampTarget::Color(channel) => {
                    look.color.get_or_insert([0.0; 3])[usize::from(channel.min(2))] = factor;
                }
                RampTarget::Incandescence(channel) => {
                    look.incandescence[usize::from(channel.min(2))] = factor
                }
                _ => {}
            }
        }
        look
    })
}
