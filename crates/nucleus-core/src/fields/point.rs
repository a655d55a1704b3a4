//! A point in the space of a field.

use nalgebra::Vector3;

/// A point in a field.
#[derive(Debug, Clone, Copy)]
pub(super) struct PointInField {
    /// Position from the centre of the field in metres.
    pub(super) from_center: Vector3<f64>,
    /// Velocity in m/s.
    pub(super) velocity: Vector3<f64>,
    /// Inverse of the mass that forces accelerate, in 1/kg; in m²/kg for cloth whose mass is per area.
    pub(super) inverse_mass: f64,
    /// The time in seconds for which the result is kept.
    pub(super) interval: f64,
}
