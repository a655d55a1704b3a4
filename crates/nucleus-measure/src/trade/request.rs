//! Wanted errors, and the rule by which a setting meets one.
//!
//! One figure decides: the least wanted error that a component of a run meets, `Request::least_met`. A setting meets a
//! request if it is at most the wanted error in every quantity. The recommendation, each row of a list of errors and
//! the place of a setting in the chart follow from it.
//!
//! - Against another reference an error may be larger by the noise floor, so a component meets the wanted errors from its
//!   error plus the floor on.
//! - In a deciding quantity (position and stretch, and every quantity with a bound of its own) the references resolve
//!   wanted errors from twice the floor on. A run without error is measured within the floor, and meets those. Below,
//!   nothing is promised: no component meets them.
//! - In the other quantities the references resolve wanted errors w from four times the floor on. A run with half the
//!   wanted error is measured within w/2 + floor ≤ w - floor, and always meets it. Below, such a quantity is named with
//!   this bound, and rejects only what misses for certain. An error up to twice the floor may be noise, and meets every
//!   wanted error. One up to three times the floor meets those from the error less the floor on. A larger one counts as
//!   where the references resolve it, or a larger wanted error would be missed where a smaller one is met.
//!
//! A component that meets a wanted error therefore meets every larger one, and in the other quantities a run with half
//! the wanted error always meets it.

use super::error::{Component, ErrorMeasure, Quantity};

/// The least wanted error that the references resolve in a quantity that decides, over its noise floor.
const DECIDING: f64 = 2.0;
/// The same in the other quantities.
const OTHERS: f64 = 4.0;
/// The largest error in the other quantities that is within the noise, over their noise floor.
const NOISE: f64 = 2.0;

/// A wanted error: one for all quantities, and bounds of single ones.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Request {
    /// The wanted error of every quantity without a bound of its own; `None`: any error.
    pub every: Option<f64>,
    /// Wanted errors of single quantities.
    pub bounds: Vec<(Quantity, f64)>,
}

impl Request {
    /// The same error in every quantity.
    pub fn every(error: f64) -> Self {
        Self { every: Some(error), bounds: Vec::new() }
    }

    /// The wanted error of a quantity.
    pub fn of(&self, quantity: Quantity) -> Option<f64> {
        self.bound(quantity).or(self.every)
    }

    fn bound(&self, quantity: Quantity) -> Option<f64> {
        self.bounds.iter().find(|(of, _)| *of == quantity).map(|(_, error)| *error)
    }

    /// Whether nothing is promised where the references do not resolve the wanted error of a quantity.
    fn decides(&self, measure: &ErrorMeasure, quantity: Quantity) -> bool {
        measure.is_essential(quantity) || self.bound(quantity).is_some()
    }

    /// The least wanted error that references with this noise floor resolve in a quantity.
    fn least_resolved(&self, measure: &ErrorMeasure, quantity: Quantity, floor: f64) -> f64 {
        floor * if self.decides(measure, quantity) { DECIDING } else { OTHERS }
    }

    /// The least wanted error that a component of a run meets; 0 if it meets every one.
    fn least_met(&self, measure: &ErrorMeasure, component: &Component) -> f64 {
        let Component { quantity, error, floor } = *component;
        if self.decides(measure, quantity) {
            return component.largest().max(DECIDING * floor);
        }
        if error <= NOISE * floor {
            0.0
        } else if error <= (OTHERS - 1.0) * floor {
            error - floor
        } else {
            component.largest()
        }
    }

    /// The largest that a component within the noise of the references may be against another reference; `None` if it is
    /// above the noise.
    pub fn noise_bound(&self, measure: &ErrorMeasure, component: &Component) -> Option<f64> {
        let noise = if self.decides(measure, component.quantity) { DECIDING - 1.0 } else { NOISE };
        (component.error <= noise * component.floor).then_some((noise + 1.0) * component.floor)
    }

    /// The components of a run that miss the request.
    pub fn missed<'a>(
        &'a self,
        measure: &'a ErrorMeasure,
        errors: &'a [Component],
    ) -> impl Iterator<Item = &'a Component> {
        let misses = |c: &Component, wanted| self.least_met(measure, c) > wanted;
        errors.iter().filter(move |c| self.of(c.quantity).is_some_and(|wanted| misses(c, wanted)))
    }

    /// The quantities in which the references do not resolve the wanted error, each with the least error that they do,
    /// essential ones first.
    pub fn unresolved<'a>(&'a self, measure: &'a ErrorMeasure) -> impl Iterator<Item = (Quantity, f64)> {
        let bounds = measure.floors.iter().map(|&(quantity, floor)| {
            let bound = self.least_resolved(measure, quantity, floor);
            (quantity, bound)
        });
        bounds.filter(|(quantity, bound)| self.of(*quantity).is_some_and(|wanted| *bound > wanted))
    }

    /// Those of [`Self::unresolved`] that decide: with any of them nothing is promised.
    pub fn undecided<'a>(&'a self, measure: &'a ErrorMeasure) -> impl Iterator<Item = (Quantity, f64)> {
        self.unresolved(measure).filter(|(quantity, _)| self.decides(measure, *quantity))
    }

    /// The quantities that the request needs and nothing measures: those that were bounded, and position, where an
    /// error of every quantity is wanted and neither positions nor shapes can be compared.
    pub fn unmeasured(&self, measure: &ErrorMeasure) -> Vec<Quantity> {
        let needs_motion = self.every.is_some() && !measure.shows_motion();
        let bounded = self.bounds.iter().map(|(quantity, _)| *quantity);
        let mut missing: Vec<Quantity> =
            bounded.filter(|quantity| measure.floor(*quantity).is_none()).collect();
        if needs_motion && !missing.contains(&Quantity::Position) {
            missing.insert(0, Quantity::Position);
        }
        missing
    }

    /// Whether nothing can be promised: a deciding quantity is not resolved or not measured.
    pub fn is_unresolved(&self, measure: &ErrorMeasure) -> bool {
        !self.unmeasured(measure).is_empty() || self.undecided(measure).next().is_some()
    }
}

/// Whether references with this noise floor in a deciding quantity resolve an error.
pub(super) fn is_resolved(floor: f64, error: f64) -> bool {
    DECIDING * floor <= error
}

/// The least error wanted in every quantity that can be promised; `None` if no essential quantity is measured.
pub fn least_promised(measure: &ErrorMeasure) -> Option<f64> {
    let essential = measure.floors.iter().filter(|(quantity, _)| measure.is_essential(*quantity));
    essential.map(|(_, floor)| DECIDING * floor).reduce(f64::max)
}

/// The least error wanted in every quantity that a run meets, and the quantity that sets it; no quantity where the noise
/// of the references does. `None` if the run was not finite.
pub fn least_met(measure: &ErrorMeasure, errors: &[Component]) -> Option<(f64, Option<Quantity>)> {
    let request = Request::default();
    let each = errors.iter().map(|component| {
        let is_noise = request.noise_bound(measure, component).is_some();
        (request.least_met(measure, component), (!is_noise).then_some(component.quantity))
    });
    let (met, limit) = each.max_by(|a, b| a.0.total_cmp(&b.0))?;
    if met > 0.0 {
        return Some((met, limit));
    }
    // Nothing decides, so nothing smaller than the noise is known.
    let bounds = errors.iter().filter_map(|component| request.noise_bound(measure, component));
    Some((bounds.reduce(f64::min).unwrap_or(0.0), None))
}

#[cfg(test)]
mod tests {
    use super::super::error::tests::component;
    use super::*;

    /// A measure of positions and these quantities.
    fn measure(floors: &[(Quantity, f64)]) -> ErrorMeasure {
        ErrorMeasure { comparable: 9, floors: [&[(Quantity::Position, 1e-3)], floors].concat() }
    }

    fn meets(wanted: f64, component: Component) -> bool {
        Request::every(wanted).missed(&measure(&[]), &[component]).next().is_none()
    }

    #[test]
    fn a_request_is_missed_by_any_quantity_above_it() {
        let errors = [component(Quantity::Position, 0.004), component(Quantity::Stretch, 0.06)];
        let measure = measure(&[]);
        let missed =
            |request: &Request| request.missed(&measure, &errors).map(|c| c.quantity).collect::<Vec<_>>();
        assert_eq!(missed(&Request::every(0.01)), [Quantity::Stretch]);
        assert_eq!(missed(&Request::every(0.1)), []);
        let bounded = Request { every: Some(0.01), bounds: vec![(Quantity::Stretch, 0.07)] };
        assert_eq!(missed(&bounded), []);
        let only = Request { every: None, bounds: vec![(Quantity::Stretch, 0.03)] };
        assert_eq!(missed(&only), [Quantity::Stretch]);
    }

    #[test]
    fn an_error_within_the_noise_of_the_references_is_not_missed_but_named() {
        let measure = measure(&[(Quantity::WorstStretch, 0.02)]);
        let noisy = Component { quantity: Quantity::WorstStretch, error: 0.03, floor: 0.02 };
        let request = Request::every(0.01);
        assert_eq!(request.missed(&measure, &[noisy]).count(), 0);
        assert_eq!(request.unresolved(&measure).collect::<Vec<_>>(), [(Quantity::WorstStretch, 0.08)]);
        assert_eq!(request.noise_bound(&measure, &noisy), Some(0.06));
        assert!(!request.is_unresolved(&measure), "the worst edge alone does not decide");
        let bounded = Request { every: None, bounds: vec![(Quantity::WorstStretch, 0.01)] };
        assert!(bounded.is_unresolved(&measure), "a bound that was asked for does");
        assert!(Request::every(1e-3).is_unresolved(&measure));
    }

    #[test]
    fn a_quantity_that_is_not_resolved_at_the_wanted_error_decides_only_where_it_misses_for_certain() {
        let silhouette = |error| Component { quantity: Quantity::Silhouette, error, floor: 0.037 };
        assert!([0.0735, 0.0755, 0.093].into_iter().all(|error| meets(0.1, silhouette(error))));
        assert!(meets(0.01, silhouette(0.0735)), "it may be noise");
        assert!(!meets(0.01, silhouette(0.0755)), "3.85 % at least, against any reference");
        assert!(!meets(0.1, silhouette(0.5)), "an error far above the noise is no noise");
        // 15 % is resolved, and against another reference 13 % may be more.
        assert!(meets(0.15, silhouette(0.112)) && !meets(0.15, silhouette(0.13)));
        let bounded = Request { every: None, bounds: vec![(Quantity::Silhouette, 0.1)] };
        let noisy = [silhouette(0.093)];
        assert_eq!(bounded.missed(&measure(&[]), &noisy).count(), 1, "a bound that was asked for is strict");
    }

    #[test]
    fn position_and_stretch_meet_an_error_only_with_the_noise_of_the_references_added() {
        for quantity in [Quantity::Position, Quantity::Stretch] {
            let of = |error| Component { quantity, error, floor: 0.004 };
            assert!(meets(0.01, of(0.006)) && !meets(0.01, of(0.007)));
            assert!(meets(0.008, of(0.0)) && !meets(0.0079, of(0.0)), "from twice the noise on");
        }
    }

    #[test]
    fn the_least_error_that_a_run_meets_is_set_by_its_largest_or_by_the_noise() {
        let measure = measure(&[]);
        let least = |errors: &[Component]| least_met(&measure, errors);
        let of = |quantity, error, floor| Component { quantity, error, floor };
        let noisy = of(Quantity::WorstStretch, 0.03, 0.02);
        let position = of(Quantity::Position, 0.25, 0.125);
        assert_eq!(least(&[position, noisy]), Some((0.375, Some(Quantity::Position))));
        assert_eq!(least(&[of(Quantity::Position, 0.003, 0.004), noisy]), Some((0.008, None)));
        assert_eq!(least(&[noisy]), Some((0.06, None)), "nothing decides");
        assert_eq!(least(&[]), None);
    }

    #[test]
    fn without_comparable_positions_an_unresolved_shape_decides() {
        let floors = vec![(Quantity::Stretch, 1e-4), (Quantity::Shape, 0.02)];
        let measure = |comparable| ErrorMeasure { comparable, floors: floors.clone() };
        assert!(!Request::every(0.01).is_unresolved(&measure(9)));
        assert!(Request::every(0.01).is_unresolved(&measure(0)));
        assert!(!Request::every(0.05).is_unresolved(&measure(0)));
        let strain = Request { every: None, bounds: vec![(Quantity::Stretch, 0.01)] };
        assert!(!strain.is_unresolved(&measure(0)), "the shape was not asked for");
    }

    #[test]
    fn a_request_for_what_is_not_measured_is_unresolved() {
        // Particles whose motions diverge have no edges and no surface.
        let beads = ErrorMeasure { comparable: 0, floors: vec![(Quantity::Energy, 1e-9)] };
        assert_eq!(Request::every(0.01).unmeasured(&beads), [Quantity::Position]);
        assert!(Request::every(1.0).is_unresolved(&beads));
        let bound = |quantity| Request { every: None, bounds: vec![(quantity, 0.01)] };
        assert_eq!(bound(Quantity::Stretch).unmeasured(&beads), [Quantity::Stretch]);
        assert!(!bound(Quantity::Energy).is_unresolved(&beads));
        let cloth =
            ErrorMeasure { comparable: 0, floors: vec![(Quantity::Stretch, 0.0), (Quantity::Shape, 0.0)] };
        assert_eq!(Request::every(0.01).unmeasured(&cloth), []);
        assert_eq!(bound(Quantity::Position).unmeasured(&cloth), [Quantity::Position]);
        assert_eq!(Request::every(0.01).unmeasured(&ErrorMeasure::without_reference()), []);
    }
}
