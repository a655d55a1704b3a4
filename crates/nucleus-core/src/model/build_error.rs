//! Why the builder refuses an object.

use crate::input::validation::MAX_COORDINATE;

/// An invalid object, with the element at fault.
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
        /// Their number.
        points: usize,
    },
    /// A face has fewer than three corners or names a point twice.
    #[error("face {face} has fewer than three different points")]
    DegenerateFace {
        /// The face.
        face: usize,
    },
    /// A point is said to be split off one that does not exist, or that was split off itself.
    #[error("a point is split off point {point}, but only the first {points} points are originals")]
    BadSplit {
        /// The point that it is said to be split off.
        point: u32,
        /// The number of points that were not split off any.
        points: usize,
    },
    /// Woven cloth has not one direction of the warp per face.
    #[error("there are {given} directions of the warp, but {faces} faces")]
    WarpCount {
        /// The number of directions given.
        given: usize,
        /// The number of faces.
        faces: usize,
    },
    /// The direction of the warp in a face is zero or not finite.
    #[error("the warp has no direction in face {face}")]
    BadWarp {
        /// The face.
        face: usize,
    },
    /// The mesh has faces, but none of them has any area.
    #[error("the mesh has no area")]
    NoArea,
    /// The longest edge of the mesh is too short to be represented.
    #[error("the longest edge of the mesh is {length:e} m; it must be at least {least:e} m")]
    TooSmall {
        /// Its length in metres.
        length: f64,
        /// The shortest valid length in metres.
        least: f64,
    },
    /// The mesh has no points at all.
    #[error("the mesh has no points")]
    NoPoints,
    /// Particles that are born and die have faces, a lifespan that is negative or NaN, or a number that is not below 2⁶³.
    #[error(
        "particles that are born and die have no faces, lifespans of at least 0 s, and numbers below 2^63"
    )]
    BadParticles,
    /// More particles at the start than the capacity, or no capacity.
    #[error("there are {points} particles at the start, and a capacity of {capacity}")]
    Capacity {
        /// The number of particles at the start.
        points: usize,
        /// The capacity in particles.
        capacity: usize,
    },
    /// A larger capacity for particles than there can be.
    #[error("the capacity is {capacity} particles; an object has {most} at most")]
    TooManyParticles {
        /// The capacity in particles.
        capacity: usize,
        /// The largest capacity.
        most: usize,
    },
    /// The solver has as many cloths as it can tell pairs of apart.
    #[error("a solver has at most {most} cloths and objects of particles")]
    TooManyCloths {
        /// The largest number.
        most: usize,
    },
    /// The radius of particles is negative, NaN or too large.
    #[error("the radius of the particles must be from 0 to {MAX_COORDINATE:e} m, not {radius}")]
    BadRadius {
        /// The given value.
        radius: f64,
    },
    /// A collision event has a number that is NaN or infinite.
    #[error("the probability, spread or lifespan of collision event {event} is not a usable number")]
    BadEvent {
        /// The event, by its index.
        event: usize,
    },
    /// There is no such cloth.
    #[error("there is no cloth {cloth}")]
    NoCloth {
        /// Its id.
        cloth: u32,
    },
    /// There is no such collider.
    #[error("there is no collider {collider}")]
    NoCollider {
        /// Its id.
        collider: u32,
    },
    /// The links of a cloth are to be sorted from a point that does not exist.
    #[error("links cannot be sorted from point {point}: there are only {points} points")]
    NoSource {
        /// The point, in the mesh's order.
        point: u32,
        /// Their number.
        points: usize,
    },
    /// A column of the start has not one entry per point.
    #[error("there are {given} {what} to start from, but {points} points")]
    StartCount {
        /// `positions` or `velocities`.
        what: &'static str,
        /// The number of entries given.
        given: usize,
        /// The number of points of the mesh.
        points: usize,
    },
    /// A start position or velocity is not finite, or too large.
    #[error("point {point} cannot start so: its {what} is not finite, or more than {MAX_COORDINATE:e}")]
    BadStart {
        /// `position` or `velocity`.
        what: &'static str,
        /// The point, in the mesh's order.
        point: usize,
    },
    /// A vertex map has not one factor per point.
    #[error("there are {factors} factors on {column}, but {points} points")]
    FactorCount {
        /// The attribute of the map.
        column: &'static str,
        /// Their number.
        factors: usize,
        /// The number of points of the mesh.
        points: usize,
    },
    /// A factor is NaN or out of range.
    #[error("the factor on {column} of point {point} must be between {least} and {most}, not {factor}")]
    BadFactor {
        /// The attribute of the map.
        column: &'static str,
        /// The point, in the mesh's order.
        point: usize,
        /// The given value.
        factor: f64,
        /// The smallest valid value.
        least: f64,
        /// The largest valid value.
        most: f64,
    },
    /// The mass is not a positive number.
    #[error("the mass must be above zero and finite, not {mass}")]
    BadMass {
        /// The given value.
        mass: f64,
    },
}
