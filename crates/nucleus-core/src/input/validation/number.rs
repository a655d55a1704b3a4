//! A number in the input of a frame, its valid range, and whose it is: what an error message names.

use std::fmt;

use crate::input::{ClothId, ColliderId};

/// A number of an error message, compared by its bits, so that NaN equals itself.
#[derive(Debug, Clone, Copy)]
pub struct InputNumber(pub f64);

impl PartialEq for InputNumber {
    fn eq(&self, other: &Self) -> bool {
        self.0.to_bits() == other.0.to_bits()
    }
}

impl Eq for InputNumber {}

impl fmt::Display for InputNumber {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.0.abs() {
            large if (1e5..f64::INFINITY).contains(&large) => write!(f, "{:e}", self.0),
            _ => write!(f, "{}", self.0),
        }
    }
}

/// The valid values of a number.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct InputRange {
    /// The least valid value.
    pub least: InputNumber,
    /// The largest valid value.
    pub most: InputNumber,
    /// Whether the least value itself is excluded.
    pub is_above: bool,
}

impl InputRange {
    pub(super) fn contains(&self, x: f64) -> bool {
        (self.least.0..=self.most.0).contains(&x) && !(self.is_above && x == self.least.0)
    }
}

impl fmt::Display for InputRange {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let InputRange { least, most, is_above } = self;
        match (least.0, most.0, is_above) {
            (f64::NEG_INFINITY, _, _) => write!(f, "a number"),
            (_, f64::INFINITY, _) => write!(f, "at least {least}"),
            (_, _, true) => write!(f, "above {least}, and at most {most}"),
            _ => write!(f, "from {least} to {most}"),
        }
    }
}

/// Whose number it is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum InputSubject {
    /// A setting of the solver in [`FrameInput`](crate::FrameInput).
    Frame,
    /// The ground plane.
    Plane,
    /// A cloth.
    Cloth(ClothId),
    /// A collider.
    Collider(ColliderId),
    /// A start velocity, by its index.
    StartVelocity(u32),
    /// A constraint, by its index.
    Constraint(u32),
    /// A link that a constraint forms, by the index of the constraint and its own.
    Link(u32, u32),
    /// A force field, by its index.
    Field(u32),
    /// A birth, by its index.
    Birth(u32),
    /// A change of a particle, by its index.
    ParticleChange(u32),
}

impl fmt::Display for InputSubject {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Frame => write!(f, "the frame"),
            Self::Plane => write!(f, "the ground plane"),
            Self::Cloth(id) => write!(f, "cloth {}", id.0),
            Self::Collider(id) => write!(f, "collider {}", id.0),
            Self::StartVelocity(at) => write!(f, "start velocity {at}"),
            Self::Constraint(at) => write!(f, "constraint {at}"),
            Self::Link(constraint, at) => write!(f, "link {at} of constraint {constraint}"),
            Self::Field(at) => write!(f, "field {at}"),
            Self::Birth(at) => write!(f, "birth {at}"),
            Self::ParticleChange(at) => write!(f, "particle change {at}"),
        }
    }
}
