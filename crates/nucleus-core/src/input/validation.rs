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
//! | gravity, wind, a force | zero |
//! | substeps or evaluations beyond the limit | the limit |
//! | any other attribute | its default |
//! | duration of the frame | nothing: the frame is skipped |
//!
//! | You want to know… | Read |
//! |---|---|
//! | the range of an attribute | `attributes.rs` |
//! | which constraints and exclusions are valid | `constraints.rs` |
//! | which fields are valid | `fields.rs` |
//! | which births and changes of particles are valid | `particles.rs` |

mod attributes;
mod constraints;
mod fields;
mod particles;

use std::borrow::Cow;

use nalgebra::Vector3;

pub use attributes::{MAX_COORDINATE, MAX_FACTOR, is_in_range};
use attributes::{MIN_DURATION, is_duration, sanitize_cloth, sanitize_collider_settings, sanitize_settings};
use constraints::{are_exclusions, is_valid_constraint, sanitize_constraint, sanitize_exclusions};
use fields::{are_valid_fields, sanitize_fields};
use particles::{are_births, is_change, sanitize_particles};

use crate::input::frame::{ClothFrame, ColliderFrame, FrameInput, InputMesh, Pin};
use crate::input::links::Link;
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
    /// Positions of the input mesh of a cloth: not one per point, not finite, or given twice. It attracts nothing in this
    /// frame; of two meshes the first does.
    #[error("the input mesh of cloth {} has not one finite position per point, or there are two of them", .0.0)]
    InputMesh(ClothId),
    /// A birth: a number that is not usable, a time outside of the frame, or an object without room for particles.
    #[error("a birth in cloth {} has a number that is not usable, or the cloth has no room for particles", .0.0)]
    Birth(ClothId),
    /// A change of a particle: a number that is not usable, or a particle that is not alive.
    #[error("a change of a particle of cloth {} has a number that is not usable, or there is no such particle", .0.0)]
    ParticleChange(ClothId),
    /// An exclusion with points that do not exist, or one beyond [`MAX_EXCLUSIONS`](crate::MAX_EXCLUSIONS); by its index.
    #[error("exclusion {0} names points that do not exist, or is one too many")]
    Exclusion(u32),
    /// An attribute of a cloth.
    #[error("an attribute of cloth {} is not a usable number", .0.0)]
    Cloth(ClothId),
    /// An attribute of a collider.
    #[error("an attribute of collider {} is not a usable number", .0.0)]
    Collider(ColliderId),
    /// Gravity, wind, the ground plane, a field or another setting of the solver.
    #[error("gravity, wind, the ground plane, a field or another setting is not a usable number")]
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
    /// The duration of the frame, which must be above zero; in `f32` it must not vanish when it is divided into steps.
    #[error("the duration of the frame must be above zero, at least {MIN_DURATION:e} s")]
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
    /// How many points a cloth can have.
    fn room(&self, cloth: ClothId) -> usize;
    /// How many particles of an object are alive; `None` where none are born or die.
    fn particles(&self, cloth: ClothId) -> Option<usize>;
    /// Whether all that a link refers to exists, and its numbers are in range.
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
    if sanitize_fields(&mut frame.fields, last.objects()[0]) {
        sanitized.add(InvalidInput::Setting);
    }
    sanitize_pins(&mut frame, last, &mut sanitized);
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
        && (0..frame.input_meshes.len()).all(|at| is_valid_mesh(&frame.input_meshes, at, last))
        && frame.constraints.iter().all(|constraint| is_valid_constraint(constraint, last))
        && are_valid_fields(&frame.fields, last.objects()[0])
        && are_exclusions(&frame.exclusions, last)
        && are_births(&frame.births, last)
        && frame.particle_changes.iter().all(|change| is_change(change, last))
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
