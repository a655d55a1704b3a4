//! How curves run.

use proptest::prelude::*;

use super::*;

fn curve(tangent: Tangent, keys: &[(f64, f64)]) -> Curve {
    Curve::new(keys.iter().map(|&(frame, value)| Key { frame, value, tangent }).collect()).unwrap()
}

/// Curves of up to six keys, at least a hundredth of a frame apart, of any tangents.
fn curves() -> impl Strategy<Value = Curve> {
    let tangent = prop::sample::select(vec![Tangent::Stepped, Tangent::Linear, Tangent::Spline]);
    prop::collection::vec((0.01..50.0_f64, -100.0..100.0_f64, tangent), 1..7).prop_map(|steps| {
        let mut frame = -20.0;
        let key = |(step, value, tangent)| {
            frame += step;
            Key { frame, value, tangent }
        };
        Curve::new(steps.into_iter().map(key).collect()).unwrap()
    })
}

#[test]
fn a_stepped_key_holds_until_the_next() {
    let curve = curve(Tangent::Stepped, &[(1.0, 5.0), (10.0, 7.0)]);
    assert_eq!([1.0, 9.999, 10.0].map(|frame| curve.value_at(frame)), [5.0, 5.0, 7.0]);
}

#[test]
fn linear_keys_are_joined_by_straight_lines() {
    let curve = curve(Tangent::Linear, &[(1.0, 0.0), (49.0, 12.0), (51.0, 0.0)]);
    assert_eq!([1.0, 13.0, 25.0, 49.0, 50.0].map(|frame| curve.value_at(frame)), [0.0, 3.0, 6.0, 12.0, 6.0]);
}

#[test]
fn a_spline_through_evenly_spaced_points_of_a_parabola_is_that_parabola() {
    let keys: Vec<_> = (0..6).map(|k| f64::from(k) * 4.0).map(|x| (x, x * x - 3.0 * x)).collect();
    let curve = curve(Tangent::Spline, &keys);
    // Not in the first and last stretch, where the ends are flat.
    for x in [4.0, 5.0, 7.5, 10.0, 15.9] {
        assert!((curve.value_at(x) - (x * x - 3.0 * x)).abs() < 1e-12, "{x}");
    }
}

#[test]
fn a_spline_is_flat_at_its_ends() {
    let curve = curve(Tangent::Spline, &[(0.0, 0.0), (10.0, 1.0)]);
    assert!(curve.value_at(0.01) < 1e-5 && curve.value_at(9.99) > 1.0 - 1e-5);
    assert!((curve.value_at(5.0) - 0.5).abs() < 1e-15);
}

#[test]
fn keys_that_are_no_curve_are_refused() {
    let new = |keys: &[(f64, f64)]| {
        Curve::new(
            keys.iter().map(|&(frame, value)| Key { frame, value, tangent: Tangent::Linear }).collect(),
        )
    };
    assert_eq!(new(&[]), Err(CurveError::NoKeys));
    assert_eq!(new(&[(1.0, 0.0), (1.0, 2.0)]), Err(CurveError::Repeated { frame: 1.0 }));
    assert_eq!(new(&[(2.0, 0.0), (1.0, 2.0)]), Err(CurveError::OutOfOrder { frame: 1.0, previous: 2.0 }));
    for bad in [f64::NAN, f64::INFINITY, 1e308] {
        assert!(matches!(new(&[(1.0, bad)]), Err(CurveError::NotFinite { .. })));
        assert!(matches!(new(&[(bad, 1.0)]), Err(CurveError::NotFinite { .. })));
    }
}

#[test]
fn a_curve_that_is_never_anything_but_zero_is_known() {
    assert_eq!(curve(Tangent::Spline, &[(0.0, 0.0), (5.0, 0.0), (9.0, 0.0)]).max_abs(), 0.0);
    assert_eq!(Curve::constant(-3.0).unwrap().max_abs(), 3.0);
    assert!(curve(Tangent::Stepped, &[(0.0, 0.0), (5.0, 1e-9)]).max_abs() > 0.0);
}

proptest! {
    #[test]
    fn every_curve_goes_through_its_keys_and_stays_put_outside(curve in curves()) {
        for key in curve.keys() {
            prop_assert_eq!(curve.value_at(key.frame), key.value);
        }
        let (first, last) = (curve.keys()[0], curve.keys()[curve.keys().len() - 1]);
        prop_assert_eq!(curve.value_at(first.frame - 1e3), first.value);
        prop_assert_eq!(curve.value_at(last.frame + 1e3), last.value);
    }

    #[test]
    fn between_two_linear_keys_the_value_is_between_theirs(
        (a, b) in (-1e6..1e6_f64, -1e6..1e6_f64),
        frame in 0.0..7.0_f64,
    ) {
        let value = curve(Tangent::Linear, &[(0.0, a), (7.0, b)]).value_at(frame);
        prop_assert!(a.min(b) <= value && value <= a.max(b));
        prop_assert!((value - (a + (b - a) * frame / 7.0)).abs() <= 1e-9);
    }

    #[test]
    fn no_value_lies_outside_the_range(curve in curves(), frame in -30.0..300.0_f64) {
        let (low, high) = curve.range();
        let value = curve.value_at(frame);
        prop_assert!(low <= value && value <= high && value.abs() <= curve.max_abs());
        prop_assert_eq!(curve.is_constant(), low == high);
    }

    #[test]
    fn a_spline_has_no_corner_at_its_keys(
        steps in prop::collection::vec((1.0..50.0_f64, -100.0..100.0_f64), 3..7),
    ) {
        let mut frame = 0.0;
        let keys: Vec<_> = steps.iter().map(|&(step, value)| { frame += step; (frame, value) }).collect();
        let curve = curve(Tangent::Spline, &keys);
        for &(frame, value) in &keys {
            let h = 1e-6;
            let before = (value - curve.value_at(frame - h)) / h;
            let after = (curve.value_at(frame + h) - value) / h;
            // The second derivative is below 6 (|b - a| + slopes) / 1², so corners would be far larger.
            prop_assert!((before - after).abs() < 0.01, "{} {}", before, after);
        }
    }
}
