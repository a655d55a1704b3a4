//! Uniform field: one force for all points.

use nalgebra::Vector3;

use crate::fields::point::PointInField;

/// The acceleration by a force in newtons, in m/s².
pub(super) fn acceleration(force: Vector3<f64>, point: &PointInField) -> Vector3<f64> {
    force * point.inverse_mass
}
