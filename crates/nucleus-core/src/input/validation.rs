//! Validation of a frame's input: a value that is NaN, infinite or beyond [`MAX_COORDINATE`] is replaced and counted,
//! so that one bad point does not end the run.
//!
//! | Invalid value | Replaced by |
//! |---|---|
//! | a point of a collider | its position before the frame |
//! | a missing entry of a cloth or a collider | the default; a surplus one is dropped |
//! | start or end of a pin's motion | the other of the two; if both are invalid, the point's current position |
//! | a pin, an input mesh, a link, an exclusion or a target of a field that does not exist | nothing: it is dropped |
//! | a second input mesh of a cloth, an exclusion beyond the limit | nothing: it is dropped |
//! | a birth or a change of a particle | nothing: it is dropped |
//! | births that are not in the order of their times | the same ones, sorted; they are not counted |
//! | gravity, wind, a force | zero |
//! | substeps or evaluations beyond the limit | the limit |
//! | any other attribute | its default |
//! | duration of the frame | nothing: the frame is skipped |
//!
//! | You want to know… | Read |
//! |---|---|
//! | the range of an attribute | `attributes.rs` |
//! | the documented range of every number, which `check_frame` demands | `ranges.rs`, `number.rs` |
//! | which constraints and exclusions are valid | `constraints.rs` |
//! | which fields are valid | `fields.rs` |
//! | which births and changes of particles are valid | `particles.rs` |
//! | what the report says of invalid input | `sanitized.rs` |

mod attributes;
mod constraints;
mod fields;
mod number;
mod particles;
mod ranges;
mod sanitized;

use std::borrow::Cow;

use nalgebra::Vector3;

pub use attributes::{MAX_COORDINATE, MAX_FACTOR, is_in_range};
use attributes::{is_duration, sanitize_cloth, sanitize_collider_settings, sanitize_settings};
use constraints::{are_exclusions, is_valid_constraint, sanitize_constraint, sanitize_exclusions};
use fields::{are_valid_fields, sanitize_fields};
pub use number::{InputNumber, InputRange, InputSubject};
use particles::{are_births, is_change, sanitize_particles};
pub(crate) use ranges::first_out_of_range;
pub use sanitized::{InvalidInput, LastPositions, Sanitized};

use crate::input::frame::{ClothFrame, ColliderFrame, FrameInput, InputMesh, Pin, StartVelocity};
use crate::input::{ClothId, ColliderId, PointId};

/// The frame with every invalid value replaced, and what was replaced. A valid frame is not copied.
pub fn sanitize<'f>(frame: &'f FrameInput, last: &impl LastPositions) -> (Cow<'f, FrameInput>, Sanitized) {
    let mut sanitized = Sanitized::default();
    if is_valid(frame, last) {
        return (Cow::Borrowed(frame), sanitized);
    }
    let mut frame = frame.clone();
    if !is_duration(frame.duration) {
        sanitized.add(InvalidInput::Duration);
    }
    sanitize_counts(&mut frame, last.objects(), &mut sanitized);
    if sanitize_settings(&mut frame) {
        sanitized.add(InvalidInput::Setting);
    }
    for (id, cloth) in (0..).map(ClothId).zip(&mut frame.cloths) {
        if sanitize_cloth(cloth) {
            sanitized.add(InvalidInput::Cloth(id));
        }
    }
    for (id, collider) in (0..).map(ColliderId).zip(&mut frame.colliders) {
        sanitize_collider(id, collider, last.collider(id), &mut sanitized);
    }
    for at in sanitize_fields(&mut frame.fields, last.objects()[0]) {
        sanitized.add(InvalidInput::Field(at));
    }
    sanitize_pins(&mut frame, last, &mut sanitized);
    for of in frame.velocities.extract_if(.., |of| !is_velocity(of, last)) {
        sanitized.add(InvalidInput::StartVelocity(of.cloth));
    }
    for (at, constraint) in (0..).zip(&mut frame.constraints) {
        if sanitize_constraint(constraint, last) {
            sanitized.add(InvalidInput::Constraint(at));
        }
    }
    sanitize_meshes(&mut frame.input_meshes, last, &mut sanitized);
    sanitize_exclusions(&mut frame.exclusions, last, &mut sanitized);
    sanitize_particles(&mut frame, last, &mut sanitized);
    (Cow::Owned(frame), sanitized)
}

/// Gives every object its entry.
fn sanitize_counts(frame: &mut FrameInput, [cloths, colliders]: [usize; 2], sanitized: &mut Sanitized) {
    if frame.cloths.len() != cloths {
        frame.cloths.resize_with(cloths, ClothFrame::default);
        sanitized.add(InvalidInput::ClothCount);
    }
    if frame.colliders.len() != colliders {
        frame.colliders.resize_with(colliders, ColliderFrame::default);
        sanitized.add(InvalidInput::ColliderCount);
    }
}

fn is_valid(frame: &FrameInput, last: &impl LastPositions) -> bool {
    let is_valid_collider = |(id, collider): (ColliderId, &ColliderFrame)| {
        let points = last.collider(id).len();
        let is_of_length = |column: &[Vector3<f64>]| column.is_empty() || column.len() == points;
        is_of_length(&collider.start)
            && is_of_length(&collider.end)
            && collider.start.iter().chain(&collider.end).all(is_in_range)
            && !sanitize_collider_settings(&mut collider_settings(collider))
    };
    is_duration(frame.duration)
        && [frame.cloths.len(), frame.colliders.len()] == last.objects()
        && !sanitize_settings(&mut settings_of(frame))
        && !frame.cloths.iter().any(|cloth| sanitize_cloth(&mut cloth.clone()))
        && (0..).map(ColliderId).zip(&frame.colliders).all(is_valid_collider)
        && frame.pins.iter().all(|pin| exists(pin, last) && is_in_range(&pin.start) && is_in_range(&pin.end))
        && frame.velocities.iter().all(|of| is_velocity(of, last))
        && (0..frame.input_meshes.len()).all(|at| is_valid_mesh(&frame.input_meshes, at, last))
        && frame.constraints.iter().all(|constraint| is_valid_constraint(constraint, last))
        && are_valid_fields(&frame.fields, last.objects()[0])
        && are_exclusions(&frame.exclusions, last)
        && are_births(&frame.births, last)
        && frame.particle_changes.iter().all(|change| is_change(change, last))
}

/// Whether a start velocity is finite, and that of a point that exists.
fn is_velocity(of: &StartVelocity, last: &impl LastPositions) -> bool {
    of.cloth.index() < last.objects()[0]
        && of.point.index() < last.cloth_points(of.cloth)
        && is_in_range(&of.velocity)
        && is_in_range(&of.acceleration)
}

fn exists(pin: &Pin, last: &impl LastPositions) -> bool {
    pin.cloth.index() < last.objects()[0] && pin.point.index() < last.cloth_points(pin.cloth)
}

/// Whether an input mesh has one valid position per point, and is the first of its cloth.
fn is_valid_mesh(meshes: &[InputMesh], at: usize, last: &impl LastPositions) -> bool {
    let mesh = &meshes[at];
    let is_second = meshes[..at].iter().any(|other| other.cloth == mesh.cloth);
    if mesh.cloth.index() >= last.objects()[0] || is_second {
        return false;
    }
    let points = last.cloth_points(mesh.cloth);
    let is_valid = |column: &[Vector3<f64>]| column.len() == points && column.iter().all(is_in_range);
    is_valid(&mesh.start) && is_valid(&mesh.end)
}

fn sanitize_meshes(meshes: &mut Vec<InputMesh>, last: &impl LastPositions, sanitized: &mut Sanitized) {
    // From the last one on, so that the first of two is still there.
    for at in (0..meshes.len()).rev() {
        if !is_valid_mesh(meshes, at, last) {
            sanitized.add(InvalidInput::InputMesh(meshes.remove(at).cloth));
        }
    }
}

fn sanitize_collider(
    id: ColliderId,
    collider: &mut ColliderFrame,
    last: &[Vector3<f64>],
    sanitized: &mut Sanitized,
) {
    for column in [&mut collider.start, &mut collider.end] {
        if !column.is_empty() && column.len() != last.len() {
            column.clear();
            sanitized.add(InvalidInput::ColliderMotion(id));
        }
        for (point, (position, before)) in (0..).map(PointId).zip(column.iter_mut().zip(last)) {
            if !is_in_range(position) {
                *position = *before;
                sanitized.add(InvalidInput::ColliderPoint(id, point));
            }
        }
    }
    if sanitize_collider_settings(collider) {
        sanitized.add(InvalidInput::Collider(id));
    }
}

fn sanitize_pins(frame: &mut FrameInput, last: &impl LastPositions, sanitized: &mut Sanitized) {
    for pin in frame.pins.extract_if(.., |pin| !exists(pin, last)) {
        sanitized.add(InvalidInput::NoSuchPin(pin.cloth, pin.point));
    }
    for pin in &mut frame.pins {
        let (start, end) = (is_in_range(&pin.start), is_in_range(&pin.end));
        if start && end {
            continue;
        }
        sanitized.add(InvalidInput::Pin(pin.cloth, pin.point));
        let now = last.cloth_point(pin.cloth, pin.point);
        (pin.start, pin.end) = match (start, end) {
            (true, _) => (pin.start, pin.start),
            (false, true) => (pin.end, pin.end),
            (false, false) => (now, now),
        };
    }
}

/// A frame without its long columns.
fn settings_of(frame: &FrameInput) -> FrameInput {
    FrameInput {
        cloths: Vec::new(),
        colliders: Vec::new(),
        pins: Vec::new(),
        velocities: Vec::new(),
        input_meshes: Vec::new(),
        constraints: Vec::new(),
        exclusions: Vec::new(),
        births: Vec::new(),
        particle_changes: Vec::new(),
        fields: Vec::new(),
        ..*frame
    }
}

fn collider_settings(collider: &ColliderFrame) -> ColliderFrame {
    ColliderFrame { start: Vec::new(), end: Vec::new(), ..*collider }
}
