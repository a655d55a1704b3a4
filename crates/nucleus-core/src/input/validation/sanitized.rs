//! What was invalid in the input of a frame, and what the check has to know of the solver.

use nalgebra::Vector3;

use super::attributes::{MAX_COORDINATE, MIN_DURATION};
use super::number::{InputNumber, InputRange, InputSubject};
use crate::input::links::Link;
use crate::input::{ClothId, ColliderId, PointId};

/// An invalid value in the input of a frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum InvalidInput {
    /// The number of entries in [`FrameInput::cloths`](crate::FrameInput::cloths) differs from the number of cloths.
    #[error("the frame has not one entry per cloth; `Solver::default_frame` makes one")]
    ClothCount,
    /// The number of entries in [`FrameInput::colliders`](crate::FrameInput::colliders) differs from the number of colliders.
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
    /// A velocity at the start of the frame, or its rate: not finite, or of a point that does not exist.
    #[error("a start velocity of cloth {} is not finite, or there is no such point", .0.0)]
    StartVelocity(ClothId),
    /// Positions of the input mesh of a cloth: not one per point, not finite, or given twice. It attracts nothing in this
    /// frame; of two meshes the first does.
    #[error("the input mesh of cloth {} has not one finite position per point, or there are two of them", .0.0)]
    InputMesh(ClothId),
    /// A birth: a number that is not usable, a time outside of the frame, or an object without capacity for particles.
    #[error("a birth in cloth {} has a number that is not usable, or the cloth has no capacity for particles", .0.0)]
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
    /// An attribute of a cloth that was built without the list that it needs. Only
    /// [`Solver::check_frame`](crate::Solver::check_frame) says so; in a step it has no effect.
    #[error("`{attribute}` of cloth {} has no effect without `ClothLists::{list}`", .cloth.0)]
    NoList {
        /// The cloth.
        cloth: ClothId,
        /// The field of [`ClothFrame`](crate::ClothFrame).
        attribute: &'static str,
        /// The field of [`ClothLists`](crate::ClothLists).
        list: &'static str,
    },
    /// A number outside of the range that its documentation states. Only [`Solver::check_frame`](crate::Solver::check_frame)
    /// says so; a step names the object alone, and of numbers that it can compute with it replaces none.
    #[error("`{field}` of {subject} is {value}; it must be {range}")]
    OutOfRange {
        /// Whose number it is.
        subject: InputSubject,
        /// Its field, with those that lead to it.
        field: &'static str,
        /// Its value.
        value: InputNumber,
        /// Its valid values.
        range: InputRange,
    },
    /// A birth at an earlier time than the one before it in [`FrameInput::births`](crate::FrameInput::births). Only
    /// [`Solver::check_frame`](crate::Solver::check_frame) says so; a step sorts them.
    #[error(
        "`time` of birth {birth} is {time}, before {before} of the birth before it; `births` must be in the order of their times"
    )]
    BirthOrder {
        /// The index of the birth.
        birth: u32,
        /// Its time as a share of the frame.
        time: InputNumber,
        /// The time of the one before.
        before: InputNumber,
    },
    /// An attribute of a collider.
    #[error("an attribute of collider {} is not a usable number", .0.0)]
    Collider(ColliderId),
    /// Gravity, wind, the ground plane or another setting of the solver.
    #[error("gravity, wind, the ground plane or another setting is not a usable number")]
    Setting,
    /// A number of a field, or a target that does not exist; by the index of the field.
    #[error("field {0} has a number that is not usable, or a target that does not exist")]
    Field(u32),
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
    pub(super) fn add(&mut self, invalid: InvalidInput) {
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
    fn capacity(&self, cloth: ClothId) -> usize;
    /// How many particles of an object are alive; `None` where none are born or die.
    fn particles(&self, cloth: ClothId) -> Option<usize>;
    /// Whether all that a link refers to exists, and its numbers are in range.
    fn has_link(&self, link: &Link) -> bool;
}
