//! Drag field: resistance against motion through a medium.

use nalgebra::Vector3;

use crate::fields::point::PointInField;

/// The acceleration in m/s² by a resistance in kg/s, as a whole or along one direction. Implicit over the interval that it
/// is kept for: the velocity relative to the medium shrinks to 1 / (1 + k t) of itself, and never turns.
pub(super) fn acceleration(
    resistance: f64,
    along: Option<Vector3<f64>>,
    medium: Vector3<f64>,
    point: &PointInField,
) -> Vector3<f64> {
    let through = point.velocity - medium;
    let through = along.map_or(through, |along| along * along.dot(&through));
    let rate = resistance * point.inverse_mass;
    if rate < 0.0 {
        return -through * rate; // it drives
    }
    -through * (rate / (1.0 + rate * point.interval))
}

/// The factor on the resistance at a speed; it grows from 0 at rest to 1, and is one half at `half_speed`.
pub(super) fn attenuation(speed: f64, half_speed: f64) -> f64 {
    if half_speed > 0.0 { speed / (speed + half_speed) } else { 1.0 }
}
