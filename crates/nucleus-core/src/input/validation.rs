//! Validation of a frame's input: a value that is NaN, infinite or beyond [`MAX_COORDINATE`] is replaced and counted,
//! so that one bad point does not end the run.
//!
//! | Invalid value | Replaced by |
//! |---|---|
//! | a point of a collider | its position before the frame |
//! | a missing entry of a cloth or a collider | the default; a surplus one is dropped |
//! | start or end of a pin's motion | the other of the two; if both are invalid, the point's current position |
//! | a pin or an input mesh of something that does not exist | nothing: it is dropped |
//! | gravity, wind, a force | zero |
//! | any other attribute | its default |
//! | duration of the frame | nothing: the frame is skipped |

mod attributes;

use std::borrow::Cow;

use nalgebra::{Matrix3, Vector3};

pub use attributes::{MAX_COORDINATE, is_in_range};
use attributes::{sanitize_cloth, sanitize_collider_settings, sanitize_numbers, sanitize_settings};

use crate::input::fields::{Field, FieldKind, Noise};
use crate::input::frame::{ClothFrame, ColliderFrame, FrameInput, InputMesh, Pin};
use crate::input::links::{ConstraintFrame, Falloff, Link};
use crate::input::{ClothId, ColliderId, PointId};

/// An invalid value in the input of a frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum InvalidInput {
    /// The number of entries in [`FrameInput::cloths`] differs from the number of cloths.
    #[error("the frame has not one entry per cloth; `Solver::default_frame` makes one")]
    ClothCount,
    /// The number of entries in [`FrameInput::colliders`] differs from the number of colliders.
    #[error("the frame has not one entry per collider; `Solver::default_frame` makes one")]
    ColliderCount,
    /// The position of a point of a collider.
    #[error("the position of point {} of collider {} is not finite, or more than {MAX_COORDINATE:e} m away", .1.0, .0.0)]
    ColliderPoint(ColliderId, PointId),
    /// The positions of a collider: their number differs from the number of its points.
    #[error("collider {} is given another number of positions than it has points", .0.0)]
    ColliderMotion(ColliderId),
    /// The position of a pin.
    #[error("the pin of point {} of cloth {} is not at a finite position", .1.0, .0.0)]
    Pin(ClothId, PointId),
    /// A pin of a cloth or a point that does not exist.
    #[error("there is no point {} of cloth {} to pin", .1.0, .0.0)]
    NoSuchPin(ClothId, PointId),
    /// Positions of the input mesh of a cloth: not one per point, or not finite. It attracts nothing in this frame.
    #[error("the input mesh of cloth {} has not one finite position per point", .0.0)]
    InputMesh(ClothId),
    /// An attribute of a cloth.
    #[error("an attribute of cloth {} is not a usable number", .0.0)]
    Cloth(ClothId),
    /// An attribute of a collider.
    #[error("an attribute of collider {} is not a usable number", .0.0)]
    Collider(ColliderId),
    /// Gravity, wind, the ground plane or another setting of the solver.
    #[error("gravity, wind, the ground plane or another setting is not a usable number")]
    Setting,
    /// A number of a constraint, or a link that refers to points that do not exist; by the index of the constraint.
    #[error("constraint {0} has a number that is not usable, or a link to points that do not exist")]
    Constraint(u32),
    /// A velocity, place or lifespan that an expression gave for a new particle. The solver evaluates no expressions: its
    /// caller reports this and the next.
    #[error("the expression at birth of the particles of cloth {} gave a value that is not a finite number", .0.0)]
    CreationExpression(ClothId),
    /// A velocity or lifespan that an expression gave for a living particle.
    #[error("the expression at run time of the particles of cloth {} gave a value that is not a finite number", .0.0)]
    RuntimeExpression(ClothId),
    /// The duration of the frame, which must be above zero.
    #[error("the duration of the frame must be above zero")]
    Duration,
}

/// How many invalid values the input of a frame had, and the first of them.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Sanitized {
    /// How many values were replaced.
    pub count: u64,
    /// The first of them.
    pub first: Option<InvalidInput>,
}

impl Sanitized {
    fn add(&mut self, invalid: InvalidInput) {
        self.count += 1;
        self.first = self.first.or(Some(invalid));
    }
}

/// Where points are before the frame: it stands in for invalid positions.
pub trait LastPositions {
    /// How many cloths and how many colliders there are.
    fn objects(&self) -> [usize; 2];
    /// The points of a collider in metres, in the mesh's order.
    fn collider(&self, collider: ColliderId) -> &[Vector3<f64>];
    /// A point of a cloth in metres.
    fn cloth_point(&self, cloth: ClothId, point: PointId) -> Vector3<f64>;
    /// How many points a cloth has.
    fn cloth_points(&self, cloth: ClothId) -> usize;
    /// Whether all that a link refers to exists, and its numbers are finite.
    fn has_link(&self, link: &Link) -> bool;
}

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
    if sanitize_fields(&mut frame.fields) {
        sanitized.add(InvalidInput::Setting);
    }
    sanitize_pins(&mut frame, last, &mut sanitized);
    for (at, constraint) in (0..).zip(&mut frame.constraints) {
        if sanitize_constraint(constraint, last) {
            sanitized.add(InvalidInput::Constraint(at));
        }
    }
    let meshes = std::mem::take(&mut frame.input_meshes);
    let (valid, invalid): (Vec<_>, Vec<_>) = meshes.into_iter().partition(|mesh| is_valid_mesh(mesh, last));
    invalid.iter().for_each(|mesh| sanitized.add(InvalidInput::InputMesh(mesh.cloth)));
    frame.input_meshes = valid;
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
        && frame.input_meshes.iter().all(|mesh| is_valid_mesh(mesh, last))
        && frame.constraints.iter().all(|constraint| is_valid_constraint(constraint, last))
        && frame.fields.iter().all(is_valid_field)
}

fn exists(pin: &Pin, last: &impl LastPositions) -> bool {
    pin.cloth.index() < last.objects()[0] && pin.point.index() < last.cloth_points(pin.cloth)
}

fn is_valid_mesh(mesh: &InputMesh, last: &impl LastPositions) -> bool {
    if mesh.cloth.index() >= last.objects()[0] {
        return false;
    }
    let points = last.cloth_points(mesh.cloth);
    let is_valid = |column: &[Vector3<f64>]| column.len() == points && column.iter().all(is_in_range);
    is_valid(&mesh.start) && is_valid(&mesh.end)
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

/// Removes invalid fields; whether there were any.
fn sanitize_fields(fields: &mut Vec<Field>) -> bool {
    let before = fields.len();
    fields.retain(is_valid_field);
    fields.len() < before
}

/// Whether every number of a field is finite and in range.
fn is_valid_field(field: &Field) -> bool {
    let numbers = |numbers: &[f64]| numbers.iter().all(|x| x.abs() <= MAX_COORDINATE);
    let noise =
        |noise: &Noise| is_in_range(&noise.frequency) && is_in_range(&noise.phase) && numbers(&[noise.ratio]);
    let kind = match &field.kind {
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
        FieldKind::Air { velocity, rate, .. } => is_in_range(velocity) && numbers(&[*rate]),
        FieldKind::Turbulence { force, noise: waves } => numbers(&[*force]) && noise(waves),
        FieldKind::Vortex { force, axis } => numbers(&[*force]) && is_in_range(axis),
        FieldKind::VolumeAxis(axis) => {
            numbers(&[axis.from_center, axis.from_axis, axis.along_axis, axis.around_axis, axis.turbulence])
                && is_in_range(&axis.directional)
                && is_in_range(&axis.axis)
                && noise(&axis.noise)
        }
    };
    let reach = &field.reach;
    let is_volume = reach.volume.is_none_or(|volume| {
        numbers(volume.to_local.as_slice()) && is_in_range(&volume.offset) && numbers(&[volume.section])
    });
    kind && is_volume
        && is_in_range(&reach.center)
        && numbers(&[reach.attenuation])
        && numbers(&reach.falloff)
        && reach.unit > 0.0
        && reach.max_distance >= 0.0
        && field.targets.iter().all(|(_, share)| numbers(&[*share]))
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

fn is_duration(duration: f64) -> bool {
    duration > 0.0 && duration <= MAX_COORDINATE
}

/// A frame without its long columns.
fn settings_of(frame: &FrameInput) -> FrameInput {
    FrameInput {
        cloths: Vec::new(),
        colliders: Vec::new(),
        pins: Vec::new(),
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

fn is_valid_constraint(constraint: &ConstraintFrame, last: &impl LastPositions) -> bool {
    let links = constraint.formed.iter().flatten().all(|link| last.has_link(link));
    links && !sanitize_constraint(&mut ConstraintFrame { formed: None, ..constraint.clone() }, last)
}

/// Replaces invalid numbers of a constraint, and drops invalid links; whether there were any.
fn sanitize_constraint(constraint: &mut ConstraintFrame, last: &impl LastPositions) -> bool {
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
    replaced |= sanitize_numbers([(least, 0.0), (most, MAX_COORDINATE), (start, 1.0), (end, 1.0)]);
    if constraint.keep_off.is_some_and(|distance| !distance.is_finite()) {
        constraint.keep_off = None;
        replaced = true;
    }
    let is_finite = |ramp: &Falloff| ramp.distance.is_finite() && ramp.samples.iter().all(|x| x.is_finite());
    if constraint.force.is_some_and(|force| !force.acceleration.is_finite() || !is_finite(&force.falloff)) {
        constraint.force = None;
        replaced = true;
    }
    if constraint.dropoff.as_ref().is_some_and(|dropoff| !is_finite(dropoff)) {
        constraint.dropoff = None;
        replaced = true;
    }
    let is_space = |(linear, offset): &(Matrix3<f64>, Vector3<f64>)| {
        linear.iter().all(|x| x.is_finite()) && is_in_range(offset)
    };
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
