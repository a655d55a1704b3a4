//! Newton field: attraction that grows as the distance shrinks.

use nalgebra::Vector3;

use crate::fields::point::PointInField;

/// The acceleration in m/s²: the magnitude over the distance, in scene units, to the power of the attenuation. `unit` is a
/// scene unit in metres; none within `min_distance` metres.
pub(super) fn acceleration(
    [magnitude, min_distance, attenuation, unit]: [f64; 4],
    point: &PointInField,
) -> Vector3<f64> {
    let distance = point.from_center.norm();
    if distance < min_distance {
        return Vector3::zeros();
    }
    let inward = -point.from_center.try_normalize(0.0).unwrap_or_default();
    // A thousandth of a unit keeps the acceleration finite at the centre.
    let apart = (distance / unit).max(1e-3);
    let law = if attenuation == 0.0 { 1.0 } else { libm::pow(apart, -attenuation) };
    inward * (magnitude * law)
}
