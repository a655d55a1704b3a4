//! The smoothing kernel: a cubic spline over two rest distances (Monaghan 1992, §2), times the volume of a particle.
//!
//! Lengths are in rest distances, so all values are plain numbers.

use crate::math::Lanes;

/// The integral of the spline over space, less a correction: with pi itself, a liquid that has come to rest is 0.5 % denser
/// than its particles are in a grid (inside a column of 24 layers, at 1, 4 and 16 substeps alike).
const NORM: f32 = 0.995 * std::f32::consts::PI;

/// Reach of the kernel in rest distances.
pub const REACH: f32 = 2.0;

/// The kernel at a distance.
#[inline(always)]
pub fn weight(q: f32) -> f32 {
    let outer = (2.0 - q).max(0.0);
    let inner = (1.0 - q).max(0.0);
    (0.25 * outer * outer * outer - inner * inner * inner) / NORM
}

/// The kernel at several distances, and its derivative per rest distance, which is not positive.
#[inline(always)]
pub fn weights_and_slopes<W: Lanes<f32>>(q: W) -> [W; 2] {
    let zero = W::splat(0.0);
    let (outer, inner) = ((W::splat(2.0) - q).most(zero), (W::splat(1.0) - q).most(zero));
    let [outer_square, inner_square] = [outer * outer, inner * inner];
    let weight = W::splat(0.25 / NORM) * outer_square * outer - W::splat(1.0 / NORM) * inner_square * inner;
    [weight, W::splat(3.0 / NORM) * inner_square - W::splat(0.75 / NORM) * outer_square]
}

/// Density that a half-space of liquid at distance `q` adds to a particle, and its derivative.
///
/// A sheet at distance t, spread evenly, weighs S(t) = 2 pi times the integral of r W(r) from t on; the half-space is the
/// integral of S from q on.
#[inline]
pub fn half_space(q: f32) -> [f32; 2] {
    let powers = |x: f32| {
        let square = x * x;
        [square * square, square * square * x, square * square * square]
    };
    let q = q.abs().min(REACH);
    let [outer, inner] = [(2.0 - q).max(0.0), (1.0 - q).max(0.0)].map(powers);
    // The integrals of r (a - r)³ from t on are a (a - t)⁴ / 4 - (a - t)⁵ / 5, and so on once more.
    let sheet = 2.0 * (0.25 * (outer[0] / 2.0 - outer[1] / 5.0) - (inner[0] / 4.0 - inner[1] / 5.0));
    let all = 2.0 * (0.25 * (outer[1] / 10.0 - outer[2] / 30.0) - (inner[1] / 20.0 - inner[2] / 30.0));
    [all, -sheet]
}

/// The weight S of a sheet of liquid at several distances, which are not negative: what [`half_space`] changes by.
#[inline(always)]
pub fn sheet<W: Lanes<f32>>(q: W) -> W {
    let zero = W::splat(0.0);
    let (outer, inner) = ((W::splat(2.0) - q).most(zero), (W::splat(1.0) - q).most(zero));
    let [outer_square, inner_square] = [outer * outer, inner * inner];
    outer_square * outer_square * (W::splat(0.25) - outer * W::splat(0.1))
        - inner_square * inner_square * (W::splat(0.5) - inner * W::splat(0.4))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Real;

    #[test]
    fn the_sum_over_a_cubic_grid_is_one_but_for_the_disorder_at_rest() {
        let near = || (-2..=2).map(|k| k as f32);
        let places = near()
            .flat_map(|x| near().flat_map(move |y| near().map(move |z| (x * x + y * y + z * z).sqrt())));
        let sum: f32 = places.map(weight).sum();
        assert!((sum * 0.995 - 1.0).abs() < 2e-3, "{sum}");
    }

    #[test]
    fn a_half_space_at_no_distance_is_half_of_all() {
        assert!((half_space(0.0)[0] - 0.5).abs() < 1e-6);
        for q in [0.0f32, 0.3, 0.9, 1.0, 1.5, 2.0] {
            let [below, above] = [half_space((q - 1e-2).max(0.0))[0], half_space(q + 1e-2)[0]];
            let width = q + 1e-2 - (q - 1e-2).max(0.0);
            assert!(((above - below) / width - half_space(q)[1]).abs() < 2e-2, "{q}");
        }
    }

    #[test]
    fn the_slope_is_the_derivative_of_the_weight() {
        for k in 1..200 {
            let q = k as f32 * 0.0101;
            let [weights, slopes] = weights_and_slopes(<f32 as Real>::Lanes::splat(q)).map(Lanes::to_array);
            let slope_of = (weight(q + 1e-3) - weight(q - 1e-3)) / 2e-3;
            assert!((slope_of - slopes[0]).abs() < 1e-3 && (weights[0] - weight(q)).abs() < 1e-6, "{q}");
        }
    }
}
