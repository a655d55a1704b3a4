//! Validation of births and of changes of particles: invalid ones are dropped.

use super::attributes::is_in_range;
use super::sanitized::{InvalidInput, LastPositions, Sanitized};
use crate::input::frame::{Birth, FrameInput};
use crate::input::particles::ParticleChange;

/// Whether all births can happen, and are in the order of their times.
pub(super) fn are_births(births: &[Birth], last: &impl LastPositions) -> bool {
    births.is_sorted_by(|a, b| a.time <= b.time) && births.iter().all(|birth| is_birth(birth, last))
}

/// Whether a birth is in the frame, in an object with capacity for particles, and its numbers are in range.
fn is_birth(birth: &Birth, last: &impl LastPositions) -> bool {
    (0.0..=1.0).contains(&birth.time)
        && is_in_range(&birth.position)
        && is_in_range(&birth.velocity)
        && !birth.lifespan.is_nan()
        && last.particles(birth.cloth).is_some()
}

/// Whether a change concerns a particle that is alive, and its numbers are in range.
pub(super) fn is_change(change: &ParticleChange, last: &impl LastPositions) -> bool {
    last.particles(change.cloth).is_some_and(|living| change.place < living)
        && change.velocity.as_ref().is_none_or(is_in_range)
        && !change.lifespan.is_some_and(f64::is_nan)
}

/// Drops invalid births and changes of particles, and sorts the births by their times.
pub(super) fn sanitize_particles(
    frame: &mut FrameInput,
    last: &impl LastPositions,
    sanitized: &mut Sanitized,
) {
    for birth in frame.births.extract_if(.., |birth| !is_birth(birth, last)) {
        sanitized.add(InvalidInput::Birth(birth.cloth));
    }
    frame.births.sort_by(|a, b| a.time.total_cmp(&b.time));
    for change in frame.particle_changes.extract_if(.., |change| !is_change(change, last)) {
        sanitized.add(InvalidInput::ParticleChange(change.cloth));
    }
}
