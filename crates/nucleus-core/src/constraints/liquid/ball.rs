//! The density that a ball of liquid adds to a particle: what a particle of another object counts as.

use std::f32::consts::PI;

use super::kernel::{REACH, weight};

/// Entries of a table.
const ENTRIES: usize = 64;
/// Shells about a particle, over which the kernel is summed.
const SHELLS: usize = 64;

/// Densities of balls of one radius, by distance; lengths in rest distances.
#[derive(Debug, Clone)]
pub struct BallKernel {
    /// Radius of the ball.
    pub radius: f32,
    /// Distance from which on the table begins: nearer, the kernel is inside the ball.
    from: f32,
    /// Density and its derivative, at equal distances up to [`reach`](Self::reach).
    table: Vec<[f32; 2]>,
}

impl BallKernel {
    /// That of balls of this radius.
    pub fn new(radius: f32) -> Self {
        let from = (radius - REACH).max(0.0);
        let step = (radius + REACH - from) / ENTRIES as f32;
        let at = |distance: f32| density(distance.abs(), radius);
        let entry = |k: usize| {
            let distance = from + k as f32 * step;
            [at(distance), (at(distance + step / 2.0) - at(distance - step / 2.0)) / step]
        };
        Self { radius, from, table: (0..=ENTRIES).map(entry).collect() }
    }

    /// The distance from its centre up to which it adds to the density.
    pub fn reach(&self) -> f32 {
        self.radius + REACH
    }

    /// The density that it adds at a distance from its centre, and its derivative.
    #[inline]
    pub fn at(&self, distance: f32) -> [f32; 2] {
        let place = ((distance - self.from) / (self.reach() - self.from)).clamp(0.0, 1.0) * ENTRIES as f32;
        let at = (place as usize).min(ENTRIES - 1);
        let share = place - at as f32;
        let ([a, b], [c, d]) = (self.table[at], self.table[at + 1]);
        [a + (c - a) * share, b + (d - b) * share]
    }
}

/// The kernel, summed over the part of a ball in each shell about a particle at a distance from its centre.
fn density(distance: f32, radius: f32) -> f32 {
    let thickness = REACH / SHELLS as f32;
    let shell = |k: usize| {
        let s = (k as f32 + 0.5) * thickness;
        weight(s) * 4.0 * PI * s * s * share_of_shell(s, distance.max(1e-6), radius) * thickness
    };
    (0..SHELLS).map(shell).sum()
}

/// The share of a sphere of radius `s` that is inside a ball whose centre is at a distance from its own.
fn share_of_shell(s: f32, distance: f32, radius: f32) -> f32 {
    let cosine = (distance * distance + s * s - radius * radius) / (2.0 * distance * s);
    (1.0 - cosine.clamp(-1.0, 1.0)) / 2.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::constraints::liquid::kernel::half_space;

    #[test]
    fn a_large_ball_weighs_as_a_half_space_and_a_small_one_as_its_volume() {
        let (large, small) = (BallKernel::new(100.0), BallKernel::new(0.1));
        for q in [0.2f32, 0.5, 1.0, 1.5] {
            let ([density, slope], [expected, expected_slope]) = (large.at(100.0 + q), half_space(q));
            // The half-space is corrected by half a percent less than the kernel's sum, and a ball curves away.
            assert!((density - expected).abs() < 0.02, "{q}: {density} and {expected}");
            assert!((slope - expected_slope).abs() < 0.03, "{q}: {slope} and {expected_slope}");
        }
        let volume = 4.0 / 3.0 * PI * 1e-3;
        for distance in [0.4f32, 0.8, 1.3] {
            let density = small.at(distance)[0] / volume;
            assert!((density - weight(distance)).abs() < 0.02, "{distance}: {density}");
        }
        assert!(small.at(small.reach())[0].abs() < 1e-6 && large.at(large.reach())[0].abs() < 1e-4);
        assert!((large.at(50.0)[0] - 1.0).abs() < 0.02, "inside it is as dense as liquid");
    }
}
