//! Turbulence field: noise that is smooth in space and the same on every machine.

use nalgebra::Vector3;

use crate::fields::noise::noise;
use crate::fields::point::PointInField;
use crate::input::fields::Noise;

/// The acceleration in m/s² by a force of up to so many newtons per axis.
pub(super) fn acceleration(force: f64, waves: &Noise, point: &PointInField) -> Vector3<f64> {
    noise(waves, point.from_center) * (force * point.inverse_mass)
}
