//! Validation of dynamic constraints and exclusions: invalid numbers are replaced, invalid links and exclusions dropped.

use std::sync::Arc;

use nalgebra::{Matrix3, Vector3};

use super::attributes::{MAX_COORDINATE, MAX_FACTOR, is_in_range, sanitize_numbers};
use super::sanitized::{InvalidInput, LastPositions, Sanitized};
use crate::input::links::{ConstraintFrame, ExcludedSide, Exclusion, Falloff, LinkForce, MAX_EXCLUSIONS};

pub(super) fn is_valid_constraint(constraint: &ConstraintFrame, last: &impl LastPositions) -> bool {
    let links = constraint.formed.iter().flatten().all(|link| last.has_link(link));
    links && !sanitize_constraint(&mut ConstraintFrame { formed: None, ..constraint.clone() }, last)
}

/// Replaces invalid numbers of a constraint, and drops invalid links; whether there were any.
pub(super) fn sanitize_constraint(constraint: &mut ConstraintFrame, last: &impl LastPositions) -> bool {
    let mut replaced = sanitize_numbers([
        (&mut constraint.strength, 0.0),
        (&mut constraint.tangent_strength, 0.0),
        (&mut constraint.bend_strength, 0.0),
        (&mut constraint.break_half_sine, 1.0),
        (&mut constraint.friction, 0.0),
        (&mut constraint.damp, 0.0),
        (&mut constraint.motion_drag, 0.0),
        (&mut constraint.glue_strength, 1.0),
        (&mut constraint.glue_scale, 1.0),
    ]);
    let [least, most] = &mut constraint.iterations;
    let [start, end] = &mut constraint.rest_scale;
    replaced |= sanitize_numbers([(least, 0.0), (most, MAX_COORDINATE)]);
    for scale in [start, end].into_iter().filter(|scale| !is_factor(**scale)) {
        *scale = 1.0;
        replaced = true;
    }
    replaced |= take_invalid(&mut constraint.keep_off, |distance| distance.abs() <= MAX_COORDINATE);
    replaced |= take_invalid(&mut constraint.force, is_force);
    replaced |= take_invalid(&mut constraint.dropoff, is_dropoff);
    if !constraint.space.iter().all(is_space) {
        constraint.space = ConstraintFrame::default().space;
        replaced = true;
    }
    if let Some(links) = &mut constraint.formed {
        let before = links.len();
        links.retain(|link| last.has_link(link));
        replaced |= links.len() < before;
    }
    replaced
}

/// Removes a value that is not valid; whether it did.
fn take_invalid<T>(value: &mut Option<T>, is_valid: impl Fn(&T) -> bool) -> bool {
    value.take_if(|value| !is_valid(value)).is_some()
}

fn is_factor(x: f64) -> bool {
    x.abs() <= MAX_FACTOR
}

fn is_ramp(ramp: &Falloff) -> bool {
    ramp.distance.abs() <= MAX_COORDINATE && ramp.samples.iter().all(|sample| is_factor(*sample))
}

/// Whether a ramp can scale a strength: one below zero would push apart what it holds.
fn is_dropoff(ramp: &Falloff) -> bool {
    is_ramp(ramp) && ramp.samples.iter().all(|sample| *sample >= 0.0)
}

fn is_force(force: &LinkForce) -> bool {
    force.acceleration.abs() <= MAX_COORDINATE && is_ramp(&force.falloff)
}

fn is_space((linear, offset): &(Matrix3<f64>, Vector3<f64>)) -> bool {
    linear.iter().all(|x| is_factor(*x)) && is_in_range(offset)
}

/// Whether there is a bit for each exclusion, and all of their points exist.
pub(super) fn are_exclusions(exclusions: &[Arc<Exclusion>], last: &impl LastPositions) -> bool {
    exclusions.len() <= MAX_EXCLUSIONS && exclusions.iter().all(|exclusion| is_exclusion(exclusion, last))
}

/// Drops exclusions of points that do not exist, and those beyond the limit.
pub(super) fn sanitize_exclusions(
    exclusions: &mut Vec<Arc<Exclusion>>,
    last: &impl LastPositions,
    sanitized: &mut Sanitized,
) {
    let (mut at, mut kept) = (0, 0);
    exclusions.retain(|exclusion| {
        let is_kept = kept < MAX_EXCLUSIONS && is_exclusion(exclusion, last);
        if !is_kept {
            sanitized.add(InvalidInput::Exclusion(at));
        }
        (at, kept) = (at + 1, kept + usize::from(is_kept));
        is_kept
    });
}

/// Whether the points of both sides exist, if only as capacity for particles.
fn is_exclusion(exclusion: &Exclusion, last: &impl LastPositions) -> bool {
    let [cloths, colliders] = last.objects();
    exclusion.sides.iter().all(|side| match side {
        ExcludedSide::Everything => true,
        ExcludedSide::Points(of_cloths, of_colliders) => {
            of_cloths
                .iter()
                .all(|(cloth, point)| cloth.index() < cloths && point.index() < last.capacity(*cloth))
                && of_colliders.iter().all(|(collider, point)| {
                    collider.index() < colliders && point.index() < last.collider(*collider).len()
                })
        }
    })
}
