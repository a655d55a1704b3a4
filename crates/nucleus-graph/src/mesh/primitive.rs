//! What all meshes made from numbers have in common: the check at the door, and even spacing.

/// Why numbers do not describe a mesh.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum PrimitiveError {
    /// A length is zero, negative, NaN or infinite.
    #[error("{name} must be above zero and finite, not {value}")]
    BadLength {
        /// Which: `width`, `radius` ...
        name: &'static str,
        /// What was given.
        value: f64,
    },
    /// Too few subdivisions to close the shape.
    #[error("{name} needs at least {least} subdivisions, not {value}")]
    TooFewSubdivisions {
        /// Which: `width`, `axis` ...
        name: &'static str,
        /// What was given.
        value: u32,
        /// The fewest that make sense.
        least: u32,
    },
    /// More points than any solver run could hold.
    #[error("the mesh would have {points} points, more than {most}")]
    TooManyPoints {
        /// How many it would have.
        points: u64,
        /// How many are allowed.
        most: u64,
    },
}

/// A hundred million points: 2.4 GB of positions.
const MOST_POINTS: u64 = 100_000_000;

/// Refuses a length that is not above zero and finite.
pub(super) fn check_length(name: &'static str, value: f64) -> Result<(), PrimitiveError> {
    if value > 0.0 && value.is_finite() { Ok(()) } else { Err(PrimitiveError::BadLength { name, value }) }
}

/// Refuses fewer subdivisions than `least`.
pub(super) fn check_subdivisions(name: &'static str, value: u32, least: u32) -> Result<(), PrimitiveError> {
    if value >= least { Ok(()) } else { Err(PrimitiveError::TooFewSubdivisions { name, value, least }) }
}

/// Refuses a mesh of about `across` times `along` points if that is too many.
pub(super) fn check_size(across: u64, along: u64) -> Result<(), PrimitiveError> {
    let points = across.saturating_mul(along);
    if points <= MOST_POINTS {
        Ok(())
    } else {
        Err(PrimitiveError::TooManyPoints { points, most: MOST_POINTS })
    }
}

/// Step `k` of `steps` from -0.5 to 0.5; both halves are the same but for the sign.
pub(super) fn even_step(k: u32, steps: u32) -> f64 {
    (2.0 * f64::from(k) - f64::from(steps)) / (2.0 * f64::from(steps))
}
