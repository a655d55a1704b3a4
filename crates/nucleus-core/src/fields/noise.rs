//! Noise with octaves, of mean zero.

use nalgebra::Vector3;

use crate::input::fields::Noise;
use crate::integrate::gusts::lattice_noise;

/// Upper limit of octaves: further ones are below the precision of a position.
const MAX_OCTAVES: u32 = 16;

/// The noise at a place in metres from its origin: each component between -1 and 1.
pub(super) fn noise(noise: &Noise, place: Vector3<f64>) -> Vector3<f64> {
    let at = place.component_mul(&noise.frequency) + noise.phase;
    let (mut sum, mut weights) = (Vector3::zeros(), 0.0);
    let (mut weight, mut scale) = (1.0, 1.0);
    for _ in 0..=noise.octaves.min(MAX_OCTAVES) {
        sum += lattice_noise(at * scale) * weight;
        weights += f64::abs(weight);
        weight *= noise.ratio;
        scale *= 2.0;
    }
    sum / weights
}
