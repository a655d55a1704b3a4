//! Properties of recommendations, on generated curves.

use proptest::prelude::*;

use super::curve::tests::{measured, point};
use super::{Choice, Component, ErrorMeasure, Point, Quantity, Request, Setting, Trade, Wish, for_error};
use crate::report::{figure, percent, recommendation, time_to};

/// A number whose logarithm is uniform.
fn log(from: f64, to: f64) -> impl Strategy<Value = f64> {
    (from.ln()..to.ln()).prop_map(f64::exp)
}

/// Noise floors of all quantities; positions can be compared, or in no frame.
fn measure() -> impl Strategy<Value = ErrorMeasure> {
    let floors = prop::array::uniform6(log(1e-3, 0.05));
    (any::<bool>(), floors).prop_map(|(is_comparable, floors)| {
        let floors = Quantity::AGAINST_REFERENCE.into_iter().zip(floors);
        let is_measured = |(quantity, _): &(Quantity, f64)| is_comparable || *quantity != Quantity::Position;
        ErrorMeasure {
            comparable: if is_comparable { 9 } else { 0 },
            floors: floors.filter(is_measured).collect(),
        }
    })
}

/// A setting with its time, its errors over the noise floors, and whether it leaves pairs unresolved.
fn setting() -> impl Strategy<Value = (Setting, f64, [f64; 6], bool)> {
    let evaluations = prop::sample::select(vec![24.0, 48.0, 96.0, 192.0]);
    let substeps = prop::sample::select(vec![1, 3]);
    let errors = prop::array::uniform6(log(0.2, 8.0));
    (evaluations, substeps, log(1.0, 100.0), errors, prop::bool::weighted(0.1)).prop_map(
        |(evaluations, substeps, ms, errors, leaves_pairs)| {
            let setting = Setting { substeps, evaluations, ..point(ms, 0.0).setting };
            (setting, ms, errors, leaves_pairs)
        },
    )
}

fn curve() -> impl Strategy<Value = Trade> {
    (measure(), prop::collection::vec(setting(), 1..9)).prop_map(|(measure, settings)| {
        let mut points: Vec<Point> = Vec::new();
        for (setting, ms, errors, leaves_pairs) in settings {
            let component = |(&(quantity, floor), over): (&(Quantity, f64), f64)| Component {
                quantity,
                error: floor * over,
                floor,
            };
            let errors = measure.floors.iter().zip(errors).map(component).collect();
            let pairs_unresolved = u64::from(leaves_pairs);
            if points.iter().all(|other| other.setting != setting) {
                points.push(Point { setting, errors, pairs_unresolved, ..point(ms, 0.0) });
            }
        }
        measured(measure, points)
    })
}

fn found(trade: &Trade, wanted: f64) -> Option<&Point> {
    match for_error(trade, &Request::every(wanted)) {
        Choice::Found(point) => Some(point),
        _ => None,
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn a_row_of_the_list_is_the_recommendation_for_its_error(trade in curve(), wanted in log(1e-3, 1.0)) {
        let row = time_to(&trade, wanted);
        let sentence = recommendation(&trade, &Wish::Error(Request::every(wanted)));
        let Some(point) = found(&trade, wanted) else {
            prop_assert!(!row.contains(" ms per frame with "), "{row}");
            prop_assert!(!sentence.starts_with("recommended"), "{sentence}");
            return Ok(());
        };
        let (ms, wanted) = (figure(point.ms), percent(wanted));
        let sentence = sentence.strip_prefix(&format!("recommended for an error of {wanted}"));
        let except = sentence.and_then(|sentence| sentence.split_once(&format!(": {}, {ms} ms", point.setting)));
        let (except, _) = except.expect("a sentence with the setting");
        prop_assert_eq!(row, format!("to {wanted}: {ms} ms per frame with {}{except}", point.setting));
    }

    #[test]
    fn the_recommendation_is_the_leftmost_sound_dot_at_or_below_the_wanted_error(
        trade in curve(),
        wanted in log(1e-3, 1.0),
    ) {
        let is_below = |point: &&Point| point.is_sound() && point.error.is_some_and(|error| error <= wanted);
        let dot = trade.points.iter().find(is_below);
        let found = found(&trade, wanted);
        prop_assert_eq!(found.map(|point| point.setting), dot.map(|point| point.setting));
        prop_assert!(found.is_none_or(|point| point.on_frontier));
    }

    #[test]
    fn a_larger_wanted_error_has_a_recommendation_that_is_no_slower(
        trade in curve(),
        wanted in log(1e-3, 1.0),
        factor in 1.0..3.0,
    ) {
        if let Some(point) = found(&trade, wanted) {
            prop_assert!(found(&trade, factor * wanted).is_some_and(|other| other.ms <= point.ms));
        }
    }

    #[test]
    fn a_recommendation_holds_against_another_reference_or_names_the_bound(
        trade in curve(),
        wanted in log(1e-3, 1.0),
    ) {
        let request = Request::every(wanted);
        let Some(point) = found(&trade, wanted) else { return Ok(()) };
        for component in &point.errors {
            let named = request.unresolved(&trade.measure).find(|(quantity, _)| *quantity == component.quantity);
            let bound = named.map_or(wanted, |(_, bound)| bound);
            prop_assert!(component.error + component.floor <= bound, "{component:?} is above {bound}");
        }
        let essential = [Quantity::Position, Quantity::Stretch];
        prop_assert!(request.unresolved(&trade.measure).all(|(quantity, _)| !essential.contains(&quantity)));
    }

    #[test]
    fn a_quantity_that_is_not_resolved_rejects_a_setting_only_where_it_misses_for_certain(
        trade in curve(),
        wanted in log(1e-3, 1.0),
    ) {
        let request = Request::every(wanted);
        for point in &trade.points {
            for Component { quantity, error, floor } in request.missed(&trade.measure, &point.errors) {
                let is_certain = error - floor > wanted || *error > 3.0 * floor;
                let is_strict = trade.measure.is_essential(*quantity) || wanted >= 4.0 * floor;
                prop_assert!(is_certain || is_strict, "{error} against {floor}");
            }
        }
    }

    #[test]
    fn a_run_with_half_the_wanted_error_is_rejected_by_position_and_stretch_alone(
        trade in curve(),
        wanted in log(1e-3, 1.0),
    ) {
        let request = Request::every(wanted);
        for point in &trade.points {
            for Component { quantity, error, floor } in request.missed(&trade.measure, &point.errors) {
                // The noise floor is the most by which the measured error exceeds that of the run.
                let may_be_half = error - floor <= 0.5 * wanted;
                prop_assert!(!may_be_half || trade.measure.is_essential(*quantity), "{error} against {floor}");
            }
        }
    }
}
