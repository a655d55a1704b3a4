//! Sine and cosine of an angle in degrees.

/// Sine and cosine of `degrees`, exact at multiples of 90 and with the same bits on every platform.
///
/// The error is below 1e-15. Angles that are not finite give NaN.
pub fn sin_cos_degrees(degrees: f64) -> (f64, f64) {
    // The remainder and the difference are exact, so no angle is too large.
    let rest = degrees % 360.0;
    let quarters = (rest / 90.0).round();
    let (sin, cos) = sin_cos_within_45(rest - 90.0 * quarters);
    match quarters.rem_euclid(4.0) as u8 {
        0 => (sin, cos),
        1 => (cos, -sin),
        2 => (-sin, -cos),
        _ => (-cos, sin),
    }
}

fn sin_cos_within_45(degrees: f64) -> (f64, f64) {
    // At odd multiples of 45° both values are equal, whichever multiple of 90° the rounding chose.
    if degrees.abs() == 45.0 {
        return (std::f64::consts::FRAC_1_SQRT_2.copysign(degrees), std::f64::consts::FRAC_1_SQRT_2);
    }
    let radians = degrees * (std::f64::consts::PI / 180.0);
    (sin_series(radians), cos_series(radians))
}

/// Taylor series up to x¹⁵: the remainder is below 5e-17 for |x| ≤ π/4.
fn sin_series(x: f64) -> f64 {
    let inner = [15.0, 13.0, 11.0, 9.0, 7.0, 5.0, 3.0];
    x * inner.iter().fold(1.0, |sum, n| 1.0 - x * x / (n * (n - 1.0)) * sum)
}

/// Taylor series up to x¹⁶: the remainder is below 3e-18 for |x| ≤ π/4.
fn cos_series(x: f64) -> f64 {
    let inner = [16.0, 14.0, 12.0, 10.0, 8.0, 6.0, 4.0, 2.0];
    inner.iter().fold(1.0, |sum, n| 1.0 - x * x / (n * (n - 1.0)) * sum)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn multiples_of_ninety_are_exact() {
        for turns in [-3.0, 0.0, 1.0, 1e6] {
            for (degrees, expected) in
                [(0.0, (0.0, 1.0)), (90.0, (1.0, 0.0)), (180.0, (0.0, -1.0)), (270.0, (-1.0, 0.0))]
            {
                assert_eq!(sin_cos_degrees(degrees + 360.0 * turns), expected);
            }
        }
    }

    #[test]
    fn angles_that_are_not_finite_give_nan() {
        for degrees in [f64::NAN, f64::INFINITY] {
            let (sin, cos) = sin_cos_degrees(degrees);
            assert!(sin.is_nan() && cos.is_nan());
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(4096))]

        #[test]
        fn sine_and_cosine_agree_with_the_standard_library(degrees in -360.0..360.0_f64) {
            let (sin, cos) = sin_cos_degrees(degrees);
            let (true_sin, true_cos) = degrees.to_radians().sin_cos();
            // The conversion to radians rounds too: 6.3 by up to 4.4e-16.
            prop_assert!((sin - true_sin).abs() < 1e-15 && (cos - true_cos).abs() < 1e-15);
        }

        #[test]
        fn whole_turns_change_no_bit(degrees in -180..180_i32, turns in -1000..1000_i32) {
            let (once, later) = (f64::from(degrees), f64::from(degrees + 360 * turns));
            prop_assert_eq!(sin_cos_degrees(once), sin_cos_degrees(later));
        }

        #[test]
        fn turning_back_undoes_turning(degrees in -1e6..1e6_f64) {
            let (sin, cos) = sin_cos_degrees(degrees);
            prop_assert_eq!(sin_cos_degrees(-degrees), (-sin, cos));
        }

        #[test]
        fn the_squares_add_up_to_one(degrees in any::<f64>().prop_filter("finite", |x| x.is_finite())) {
            let (sin, cos) = sin_cos_degrees(degrees);
            prop_assert!((sin * sin + cos * cos - 1.0).abs() < 1e-15);
        }
    }
}
