//! Contact attributes of cloth and colliders: elements, self-collision, push out, and the force field of a surface.

use crate::input::samples::FALLOFF_SAMPLES;

/// The elements of a mesh that touch the points of another.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Elements {
    /// Points alone.
    Points,
    /// Edges too.
    Edges,
    /// Faces too.
    Faces,
}

impl Elements {
    /// Whether edges touch.
    pub(crate) fn has_edges(self) -> bool {
        self != Self::Points
    }
}

/// Moves points of other objects to a side of the surface (`pushOut`).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PushOut {
    /// Share of the distance that points move in a substep, 0 to 1; negative towards the inner side.
    pub share: f64,
    /// Distance from the surface within which points are moved, in metres (`pushOutRadius`).
    pub radius: f64,
}

impl PushOut {
    /// Off.
    pub const OFF: Self = Self { share: 0.0, radius: 0.0 };

    /// Whether any point can be moved.
    pub fn is_on(&self) -> bool {
        self.share != 0.0 && self.radius > 0.0
    }
}

/// Self-collision of a cloth.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SelfCollision {
    /// Whether it is on (`selfCollide`).
    pub on: bool,
    /// Thickness of each side in metres: `thickness` times `selfCollideWidthScale`.
    pub thickness: f64,
    /// The elements that touch its points (`selfCollisionFlag`).
    pub elements: Elements,
    /// Whether edges touch edges too, so that nothing can pass through (`selfCollisionFlag` full surface).
    pub edges: bool,
}

impl SelfCollision {
    /// Off.
    pub const OFF: Self = Self { on: false, thickness: 0.0, elements: Elements::Faces, edges: true };
}

/// A force field around a surface (`forceField`).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ForceField {
    /// On which side it acts, and in which direction.
    pub side: FieldSide,
    /// Acceleration at the surface in m/s²; above 0 it repels.
    pub magnitude: f64,
    /// Range in metres.
    pub distance: f64,
    /// Factor from the surface (first) to the distance (last), evenly spaced.
    pub falloff: [f64; Self::SAMPLES],
}

impl ForceField {
    /// Samples of the falloff.
    pub const SAMPLES: usize = FALLOFF_SAMPLES;

    /// Whether it acts at all.
    pub fn is_on(&self) -> bool {
        self.magnitude != 0.0 && self.distance > 0.0
    }
}

/// Where the force field of a surface acts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FieldSide {
    /// On both sides, along the normals.
    AlongNormal,
    /// On the side that the normals point to, away from the surface.
    Single,
    /// On both sides, away from the surface.
    Double,
}
