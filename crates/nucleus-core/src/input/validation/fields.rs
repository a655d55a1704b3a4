//! Validation of force fields: an invalid one is dropped, and so is a target that does not exist.

use super::attributes::{MAX_COORDINATE, MAX_FACTOR, is_in_range};
use crate::input::fields::{Field, FieldKind, Noise, Reach, Volume};

/// Whether all fields are valid, and act on some of `cloths` objects.
pub(super) fn are_valid_fields(fields: &[Field], cloths: usize) -> bool {
    fields.iter().all(|field| is_valid_field(field) && has_targets(field, cloths))
}

/// Removes invalid fields and targets. Returns the places of the fields that were invalid or had an invalid target.
pub(super) fn sanitize_fields(fields: &mut Vec<Field>, cloths: usize) -> Vec<u32> {
    let is_sound = |field: &Field| is_valid_field(field) && has_targets(field, cloths);
    let unsound = (0..).zip(fields.iter()).filter(|(_, field)| !is_sound(field)).map(|(at, _)| at).collect();
    fields.retain(is_valid_field);
    fields.iter_mut().for_each(|field| field.targets.retain(|(target, _)| target.index() < cloths));
    unsound
}

/// Whether all targets of a field are among `cloths` objects.
fn has_targets(field: &Field, cloths: usize) -> bool {
    field.targets.iter().all(|(target, _)| target.index() < cloths)
}

fn numbers(numbers: &[f64]) -> bool {
    numbers.iter().all(|x| x.abs() <= MAX_COORDINATE)
}

/// Whether every number of a field is finite and in range.
fn is_valid_field(field: &Field) -> bool {
    is_valid_kind(&field.kind)
        && is_valid_reach(&field.reach)
        && field.targets.iter().all(|(_, share)| share.abs() <= MAX_FACTOR)
}

fn is_valid_kind(kind: &FieldKind) -> bool {
    let noise =
        |noise: &Noise| is_in_range(&noise.frequency) && is_in_range(&noise.phase) && numbers(&[noise.ratio]);
    match kind {
        FieldKind::Gravity { acceleration: vector } | FieldKind::Uniform { force: vector } => {
            is_in_range(vector)
        }
        FieldKind::Radial { force } => numbers(&[*force]),
        FieldKind::Newton { magnitude, min_distance } => numbers(&[*magnitude, *min_distance]),
        FieldKind::Drag { magnitude, along, velocity, half_speed } => {
            numbers(&[*magnitude, *half_speed])
                && is_in_range(velocity)
                && along.as_ref().is_none_or(is_in_range)
        }
        FieldKind::Air { velocity, rate, spread, .. } => {
            is_in_range(velocity) && numbers(&[*rate]) && spread.is_none_or(|cosine| numbers(&[cosine]))
        }
        FieldKind::Turbulence { force, noise: waves } => numbers(&[*force]) && noise(waves),
        FieldKind::Vortex { force, axis } => numbers(&[*force]) && is_in_range(axis),
        FieldKind::VolumeAxis(axis) => {
            numbers(&[axis.from_center, axis.from_axis, axis.along_axis, axis.around_axis, axis.turbulence])
                && is_in_range(&axis.directional)
                && is_in_range(&axis.axis)
                && noise(&axis.noise)
        }
    }
}

fn is_valid_reach(reach: &Reach) -> bool {
    let is_volume = |volume: &Volume| {
        numbers(volume.to_local.as_slice())
            && is_in_range(&volume.offset)
            && numbers(&[volume.section])
            && volume.sweep.is_none_or(|sweep| numbers(&sweep))
    };
    reach.volume.as_ref().is_none_or(is_volume)
        && is_in_range(&reach.center)
        && numbers(&[reach.attenuation])
        && reach.falloff.iter().all(|sample| sample.abs() <= MAX_FACTOR)
        && reach.unit > 0.0
        && reach.unit <= MAX_COORDINATE
        && reach.max_distance >= 0.0
}
