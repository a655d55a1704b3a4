//! Random numbers as a function of a key: no generator is shared, so nothing depends on the order of use.

use nalgebra::Vector3;

use crate::animation::sin_cos_degrees;

/// The random numbers of one particle.
#[derive(Debug, Clone, Copy)]
pub(super) struct Random {
    state: u64,
}

impl Random {
    /// The numbers of a key.
    pub(super) fn new(key: [u64; 3]) -> Self {
        Self { state: key.into_iter().fold(0x9e37_79b9_7f4a_7c15, |state, word| mix(state ^ mix(word))) }
    }

    /// Other numbers of the same key, for a seed other than 0.
    pub(super) fn with_seed(self, seed: u64) -> Self {
        Self { state: self.state ^ mix(seed) }
    }

    /// The next number, from 0 to below 1.
    pub(super) fn next(&mut self) -> f64 {
        // SplitMix64 (Steele et al. 2014): a counter, mixed.
        self.state = self.state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        (mix(self.state) >> 11) as f64 / (1u64 << 53) as f64
    }

    /// From `low` to `high`.
    pub(super) fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.next()
    }

    /// A direction within a cone about +z with this half angle in degrees, evenly spread over the sphere.
    pub(super) fn direction(&mut self, half_angle: f64) -> Vector3<f64> {
        let (_, cos) = sin_cos_degrees(half_angle);
        let z = self.between(1.0, cos);
        let across = (1.0 - z * z).max(0.0).sqrt();
        let (sin, cos) = sin_cos_degrees(self.between(0.0, 360.0));
        Vector3::new(across * cos, across * sin, z)
    }
}

fn mix(mut x: u64) -> u64 {
    x = (x ^ x >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    x = (x ^ x >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
    x ^ x >> 31
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_of_neighbouring_keys_are_evenly_spread_and_not_correlated() {
        let of = |key: u64| {
            let mut random = Random::new([1, 0, key]);
            [random.next(), random.next()]
        };
        let all: Vec<[f64; 2]> = (0..20_000).map(of).collect();
        let mean = |f: &dyn Fn(&[f64; 2]) -> f64| all.iter().map(f).sum::<f64>() / all.len() as f64;
        assert!((mean(&|x| x[0]) - 0.5).abs() < 0.01);
        assert!((mean(&|x| x[0] * x[0]) - 1.0 / 3.0).abs() < 0.01);
        assert!((mean(&|x| (x[0] - 0.5) * (x[1] - 0.5))).abs() < 0.002);
        let next = all.windows(2).map(|pair| (pair[0][0] - 0.5) * (pair[1][0] - 0.5)).sum::<f64>();
        assert!((next / all.len() as f64).abs() < 0.002);
    }

    #[test]
    fn directions_fill_the_sphere_evenly() {
        let mut random = Random::new([3, 1, 4]);
        let all: Vec<Vector3<f64>> = (0..20_000).map(|_| random.direction(180.0)).collect();
        assert!(all.iter().all(|v| (v.norm() - 1.0).abs() < 1e-12));
        let mean = all.iter().sum::<Vector3<f64>>() / all.len() as f64;
        assert!(mean.norm() < 0.02, "{mean}");
        let narrow = random.direction(0.0);
        assert!((narrow - Vector3::z()).norm() < 1e-7);
    }
}
