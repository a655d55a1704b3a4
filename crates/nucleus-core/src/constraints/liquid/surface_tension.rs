//! Surface tension: particles attract each other (cohesion of Akinci et al. 2013, "Versatile surface tension and adhesion
//! for SPH fluids", eq. 2).
//!
//! The force peaks at one rest distance and repels below half of it. Its strength follows from the surface tension: a force
//! f(r) per mass between all pairs of particles of a uniform liquid gives a tension over density of pi/8 times the integral
//! of r⁴ f(r), per cubed rest distance (Kirkwood & Buff 1949, for a sharp surface).

use std::f32::consts::PI;

use super::kernel::REACH;
use super::neighbours::{Neighbours, chunk_range};
use super::viscosity::pair_factor;

/// The integral of q⁴ times [`cohesion`] over the reach.
const FOURTH_MOMENT: f32 = 1.5273;

/// The force between two particles at a distance in rest distances, relative to its peak.
fn cohesion(q: f32) -> f32 {
    let outer = (REACH - q).max(0.0);
    let bell = outer * outer * outer * q * q * q;
    if q > 1.0 { bell } else { 2.0 * bell - 1.0 }
}

/// Acceleration of a unit of cohesion in rest distances per squared second: `tension` is surface tension over density, in
/// cubed rest distances per squared second.
pub fn strength(tension: f32) -> f32 {
    8.0 * tension / (PI * FOURTH_MOMENT)
}

/// The acceleration of a particle, for a strength of one. The particle is the `k`th of a chunk. The factors are by particle,
/// and empty where they are 1.
pub fn acceleration(neighbours: &Neighbours, chunk: usize, k: usize, factors: &[f32]) -> [f32; 3] {
    let at = chunk_range(chunk, neighbours.len()).start as usize + k;
    let (place, mut sum) = (neighbours.positions[at], [0.0f32; 3]);
    for pair in neighbours.of(chunk, k) {
        let other = neighbours.positions[pair.other()];
        let apart = [place[0] - other[0], place[1] - other[1], place[2] - other[2]];
        let distance = (apart[0] * apart[0] + apart[1] * apart[1] + apart[2] * apart[2]).sqrt();
        let pull = -cohesion(distance) / distance.max(1e-3) * pair_factor(factors, [at, pair.other()]);
        (0..3).for_each(|axis| sum[axis] += pull * apart[axis]);
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_fourth_moment_is_that_of_the_force() {
        let width = REACH / 20_000.0;
        let part = |k: u32| {
            let q = (k as f32 + 0.5) * width;
            f64::from(q * q * q * q * cohesion(q) * width)
        };
        let sum: f64 = (0..20_000).map(part).sum();
        assert!((sum / f64::from(FOURTH_MOMENT) - 1.0).abs() < 1e-3, "{sum}");
    }
}
