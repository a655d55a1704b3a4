//! Air field: air that accelerates points towards its velocity.

use nalgebra::Vector3;

use crate::fields::point::PointInField;
use crate::input::frame::COUNT_PERIOD;

/// The acceleration in m/s² by air of a velocity in m/s. In 1/24 s the share `rate` of the difference disappears;
/// with 1 or more it moves with the air at once.
pub(super) fn acceleration(
    air: Vector3<f64>,
    rate: f64,
    (component_only, spread): (bool, Option<f64>),
    point: &PointInField,
) -> Vector3<f64> {
    let direction = air.try_normalize(0.0).unwrap_or_default();
    let outward = point.from_center.try_normalize(0.0).unwrap_or_default();
    if spread.is_some_and(|cos| direction.dot(&outward) < cos) {
        return Vector3::zeros();
    }
    let mut missing = air - point.velocity;
    if component_only {
        missing = direction * direction.dot(&missing).max(0.0);
    }
    // No more than all of it in the interval.
    missing * (rate / COUNT_PERIOD).min(1.0 / point.interval)
}
