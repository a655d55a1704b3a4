//! Gravity field: one acceleration for all points.

use nalgebra::Vector3;

/// The acceleration in m/s².
pub(super) fn acceleration(acceleration: Vector3<f64>) -> Vector3<f64> {
    acceleration
}
