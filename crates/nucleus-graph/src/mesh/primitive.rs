//! What all meshes made from numbers have in common: how large they are, the check at the door, and even spacing.

use nucleus_core::Surface;

use super::{poly_cube, poly_cylinder, poly_plane, poly_sphere};
use crate::memory::Size;

/// A mesh that is made from numbers; see the function of the same name for what they mean.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Primitive {
    /// [`poly_plane`]: width, height; subdivisions along them.
    Plane([f64; 2], [u32; 2]),
    /// [`poly_sphere`]: radius; subdivisions.
    Sphere(f64, [u32; 2]),
    /// [`poly_cube`]: width, height, depth; subdivisions along them.
    Cube([f64; 3], [u32; 3]),
    /// [`poly_cylinder`]: radius, height; subdivisions.
    Cylinder([f64; 2], [u32; 3]),
}

impl Primitive {
    /// How large it is to be, before it is made; of numbers that make no mesh it means nothing.
    pub fn size(&self) -> Size {
        let product = |factors: &[u64]| factors.iter().fold(1, |all: u64, one| all.saturating_mul(*one));
        let sum = |terms: &[u64]| terms.iter().fold(0, |all: u64, one| all.saturating_add(*one));
        let (points, corners) = match *self {
            Self::Plane(_, [x, y]) => {
                let [x, y] = [x, y].map(u64::from);
                (product(&[x + 1, y + 1]), product(&[4, x, y]))
            }
            Self::Sphere(_, [x, y]) => {
                let [x, y] = [x, y].map(u64::from);
                (sum(&[product(&[x, y.max(1) - 1]), 2]), product(&[x, 4 * y.max(2) - 2]))
            }
            Self::Cube(_, [x, y, z]) => {
                let [x, y, z] = [x, y, z].map(u64::from);
                let sides = product(&[2, y.max(1) - 1, z.max(1) - 1]);
                let faces = sum(&[product(&[x, y]), product(&[y, z]), product(&[z, x])]);
                (sum(&[product(&[2, y + z, x + 1]), sides]), product(&[8, faces]))
            }
            Self::Cylinder(_, [x, y, 0]) => {
                let [x, y] = [x, y].map(u64::from);
                (product(&[x, y + 1]), product(&[x, 4 * y + 2]))
            }
            Self::Cylinder(_, [x, y, z]) => {
                let [x, y, z] = [x, y, z].map(u64::from);
                let rings = y + 2 * (z - 1);
                (sum(&[product(&[x, rings + 1]), 2]), product(&[x, 4 * rings + 6]))
            }
        };
        Size { points, corners }
    }

    /// Makes it.
    ///
    /// # Errors
    /// When the numbers do not describe a mesh.
    pub fn surface(&self) -> Result<Surface, PrimitiveError> {
        match *self {
            Self::Plane([width, height], [x, y]) => poly_plane(width, height, (x, y)),
            Self::Sphere(radius, [x, y]) => poly_sphere(radius, (x, y)),
            Self::Cube([width, height, depth], [x, y, z]) => poly_cube(width, height, depth, (x, y, z)),
            Self::Cylinder([radius, height], [x, y, z]) => poly_cylinder(radius, height, (x, y, z)),
        }
    }
}

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
