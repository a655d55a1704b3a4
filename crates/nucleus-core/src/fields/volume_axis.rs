//! Volume axis field: forces away from, along and around the axis of a volume.

use nalgebra::Vector3;

use crate::fields::noise::noise;
use crate::fields::point::PointInField;
use crate::input::fields::VolumeAxis;

/// The acceleration in m/s².
pub(super) fn acceleration(field: &VolumeAxis, point: &PointInField) -> Vector3<f64> {
    let unit = |v: Vector3<f64>| v.try_normalize(0.0).unwrap_or_default();
    let from_axis = unit(point.from_center - field.axis * field.axis.dot(&point.from_center));
    let force = unit(point.from_center) * field.from_center
        + from_axis * field.from_axis
        + field.axis * field.along_axis
        + field.axis.cross(&from_axis) * field.around_axis
        + field.directional;
    let stirred = match field.turbulence {
        0.0 => force,
        strength => force + noise(&field.noise, point.from_center) * strength,
    };
    stirred * point.inverse_mass
}
