//! Radial field: a force away from the centre, or towards it.

use nalgebra::Vector3;

use crate::fields::point::PointInField;

/// The acceleration by a force in newtons, in m/s²; none at the centre.
pub(super) fn acceleration(force: f64, point: &PointInField) -> Vector3<f64> {
    let outward = point.from_center.try_normalize(0.0).unwrap_or_default();
    outward * (force * point.inverse_mass)
}
