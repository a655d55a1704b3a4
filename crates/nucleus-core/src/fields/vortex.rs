//! Vortex field: a force about an axis through the centre.

use nalgebra::Vector3;

use crate::fields::point::PointInField;

/// The acceleration by a force in newtons, in m/s²; none on the axis.
pub(super) fn acceleration(force: f64, axis: Vector3<f64>, point: &PointInField) -> Vector3<f64> {
    let around = axis.cross(&point.from_center).try_normalize(0.0).unwrap_or_default();
    around * (force * point.inverse_mass)
}
