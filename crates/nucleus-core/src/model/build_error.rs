//! Why the builder refuses an object.

use crate::input::validation::MAX_COORDINATE;

/// What is wrong with an object, and with which element of it.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum BuildError {
    /// A position is NaN or infinite.
    #[error("point {point} is not a finite position")]
    NotFinite {
        /// The point, in the mesh's order.
        point: usize,
    },
    /// A position is farther than [`MAX_COORDINATE`] from the origin.
    #[error("point {point} is more than {MAX_COORDINATE:e} m from the origin")]
    TooFar {
        /// The point, in the mesh's order.
        point: usize,
    },
    /// A face names a point that does not exist.
    #[error("face {face} names point {point}, but there are only {points} points")]
    FaceOutOfRange {
        /// The face.
        face: usize,
        /// The point it names.
        point: u32,
        /// How many there are.
        points: usize,
    },
    /// A face has fewer than three corners or names a point twice.
    #[error("face {face} has fewer than three different points")]
    DegenerateFace {
        /// The face.
        face: usize,
    },
    /// The mesh has faces, but none of them has any area.
    #[error("the mesh has no area")]
    NoArea,
    /// The mesh has no points at all.
    #[error("the mesh has no points")]
    NoPoints,
    /// A column of the start is not as long as the mesh has points.
    #[error("there are {given} {what} to start from, but {points} points")]
    StartCount {
        /// `positions` or `velocities`.
        what: &'static str,
        /// How many were given.
        given: usize,
        /// How many points the mesh has.
        points: usize,
    },
    /// A position or velocity to start from cannot be reckoned with.
    #[error("point {point} cannot start so: its {what} is not finite, or more than {MAX_COORDINATE:e}")]
    BadStart {
        /// `position` or `velocity`.
        what: &'static str,
        /// The point, in the mesh's order.
        point: usize,
    },
    /// A column of factors is not as long as the mesh has points.
    #[error("there are {factors} factors on {column}, but {points} points")]
    FactorCount {
        /// What it is a factor on.
        column: &'static str,
        /// How many there are.
        factors: usize,
        /// How many points the mesh has.
        points: usize,
    },
    /// A factor is not a number, or out of range.
    #[error("the factor on {column} of point {point} must be between {least} and {most}, not {factor}")]
    BadFactor {
        /// What it is a factor on.
        column: &'static str,
        /// The point, in the mesh's order.
        point: usize,
        /// What was given.
        factor: f64,
        /// The least it may be.
        least: f64,
        /// The most it may be.
        most: f64,
    },
    /// The mass is not a positive number.
    #[error("the mass must be above zero and finite, not {mass}")]
    BadMass {
        /// What was given.
        mass: f64,
    },
}
