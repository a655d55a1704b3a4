//! Interpolation, tangents and infinities of curves.

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
    // Not in the first and last segment, where the ends are flat.
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
fn keys_that_are_empty_unordered_repeated_or_not_finite_are_refused() {
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
fn the_bound_of_absolute_values_is_zero_only_for_a_curve_of_zeros() {
    assert_eq!(curve(Tangent::Spline, &[(0.0, 0.0), (5.0, 0.0), (9.0, 0.0)]).max_abs(), 0.0);
    assert_eq!(Curve::constant(-3.0).unwrap().max_abs(), 3.0);
    assert!(curve(Tangent::Stepped, &[(0.0, 0.0), (5.0, 1e-9)]).max_abs() > 0.0);
}

proptest! {
    #[test]
    fn a_curve_passes_through_its_keys_and_is_constant_beyond_them(curve in curves()) {
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
    fn all_values_lie_in_the_range(curve in curves(), frame in -30.0..300.0_f64) {
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

fn line(after: Infinity) -> Curve {
    let key = |frame, value| Key { frame, value, tangent: Tangent::Linear };
    Curve::new(vec![key(0.0, 1.0), key(10.0, 3.0)])
        .expect("in order")
        .with_infinity(Infinity::Constant, after)
}

#[track_caller]
fn near<const N: usize>(found: [f64; N], expected: [f64; N]) {
    let is_near = found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-12);
    assert!(is_near, "{found:?} is not {expected:?}");
}

#[test]
fn after_its_last_key_a_curve_follows_its_infinity() {
    let at = |infinity| [12.0, 25.0, 37.0].map(|frame| line(infinity).value_at(frame));
    near(at(Infinity::Constant), [3.0, 3.0, 3.0]);
    near(at(Infinity::Linear), [3.4, 6.0, 8.4]);
    near(at(Infinity::Cycle), [1.4, 2.0, 2.4]);
    near(at(Infinity::CycleOffset), [3.4, 6.0, 8.4]);
    near(at(Infinity::Oscillate), [2.6, 2.0, 1.6]);
}

#[test]
fn before_its_first_key_a_curve_follows_its_infinity() {
    let before = |infinity| line(Infinity::Constant).with_infinity(infinity, Infinity::Constant);
    let at = |infinity| [-2.0, -15.0].map(|frame| before(infinity).value_at(frame));
    near(at(Infinity::Constant), [1.0, 1.0]);
    near(at(Infinity::Linear), [0.6, -2.0]);
    near(at(Infinity::Cycle), [2.6, 2.0]);
    near(at(Infinity::Oscillate), [1.4, 2.0]);
    assert_eq!(line(Infinity::Cycle).value_at(-2.0), 1.0, "only before, not after");
}

#[test]
fn a_flat_key_has_slope_zero_and_an_auto_key_has_it_at_local_extremes() {
    for tangent in [Tangent::Flat, Tangent::Auto] {
        let key = |frame, value| Key { frame, value, tangent };
        let curve = Curve::new(vec![key(0.0, 0.0), key(10.0, 1.0), key(20.0, 0.0)]).expect("in order");
        let slope = (curve.value_at(10.001) - curve.value_at(9.999)) / 0.002;
        assert!(slope.abs() < 1e-3, "{tangent:?}: {slope}");
    }
    let key = |frame, value| Key { frame, value, tangent: Tangent::Auto };
    let rising = Curve::new(vec![key(0.0, 0.0), key(10.0, 1.0), key(20.0, 2.0)]).expect("in order");
    let slope = (rising.value_at(10.001) - rising.value_at(9.999)) / 0.002;
    assert!((slope - 0.1).abs() < 1e-3, "the slope of the neighbours: {slope}");
}

fn infinities() -> impl Strategy<Value = Infinity> {
    prop::sample::select(Infinity::WORDS.map(|(_, infinity)| infinity).to_vec())
}

proptest! {
    #[test]
    fn an_auto_curve_never_overshoots_its_keys(values in prop::collection::vec(-5.0..5.0, 2..6), at in 0.0..1.0) {
        let key = |(k, &value): (usize, &f64)| Key { frame: (k * k) as f64, value, tangent: Tangent::Auto };
        let curve = Curve::new(values.iter().enumerate().map(key).collect()).expect("in order");
        let frame = at * ((values.len() - 1) * (values.len() - 1)) as f64;
        let k = curve.keys().partition_point(|key| key.frame <= frame).clamp(1, values.len() - 1);
        let (a, b) = (values[k - 1], values[k]);
        let value = curve.value_at(frame);
        prop_assert!(value >= a.min(b) - 1e-12 && value <= a.max(b) + 1e-12, "{value} is not between {a} and {b}");
    }

    #[test]
    fn a_curve_is_finite_everywhere(
        values in prop::collection::vec(any::<f64>().prop_filter("in range", |x| x.abs() < 1e300), 1..5),
        before in infinities(), after in infinities(), frame in -1e9..1e9,
    ) {
        let tangents = Tangent::WORDS;
        let key = |(k, &value): (usize, &f64)| Key { frame: k as f64, value, tangent: tangents[k % 5].1 };
        let curve = Curve::new(values.iter().enumerate().map(key).collect()).expect("in order");
        let curve = curve.with_infinity(before, after);
        let value = curve.value_at(frame);
        let (low, high) = curve.range();
        prop_assert!(value.is_finite() && value >= low && value <= high, "{value} is not in {low} to {high}");
    }
}
