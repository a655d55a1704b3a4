//! The work-precision curve: every setting with its processor time and its error; frontier, slope, recommendation.

use std::cmp::Ordering;

use serde::{Deserialize, Serialize};

use super::benchmark::Benchmark;
use super::error::{Component, ErrorMeasure, Quantity};
use super::reference::References;
use super::request::{Request, least_met};
use super::run::Run;
use super::setting::Setting;
use crate::metrics::conservation::created;
use crate::metrics::root_mean_square;
use crate::result_cache::{ResultCache, ResultCacheError};

/// Tolerance of created energy, as a share of the potential energy of a fall by the cloth's own size.
const CREATED: f64 = 0.001;

/// A setting with its cost and its error.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Point {
    /// The setting.
    pub setting: Setting,
    /// Milliseconds of processor time per frame, on one core.
    pub ms: f64,
    /// The error in each quantity; empty if the run was not finite.
    pub errors: Vec<Component>,
    /// The least error, wanted in every quantity, that the setting and all that differ from it only by more evaluations
    /// meet. `None` if the run was not finite.
    pub error: Option<f64>,
    /// The quantity that sets this error; `None` if the noise of the references does.
    pub limit: Option<Quantity>,
    /// Distance from the reference up to the horizon: RMS and maximum.
    pub position: Option<[f64; 2]>,
    /// 99th percentile of strain, RMS over frames.
    pub strain: f64,
    /// Maximum strain of all frames.
    pub max_strain: f64,
    /// Energy created, over that of a fall by the cloth's own size; `None` if something drives the cloth.
    pub created: Option<f64>,
    /// Smallest ratio of gap to thickness.
    pub least_gap: Option<f64>,
    /// Pairs of elements unresolved at the end of a time step, over all time steps.
    #[serde(alias = "crossed")]
    pub pairs_unresolved: u64,
    /// Candidate pairs per frame.
    pub pairs: f64,
    /// Broad-phase queries per frame.
    #[serde(rename = "searches")]
    pub queries: f64,
    /// The first frame that was not finite, counted from the start.
    #[serde(rename = "lost")]
    pub first_nonfinite: Option<usize>,
    /// Whether it is Pareto-optimal among the sound settings.
    pub on_frontier: bool,
    /// Hash of the run's last state, in hexadecimal.
    pub hash: String,
}

/// The work-precision curve of a scene.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Trade {
    /// Fingerprints of the scene and the solver: the name of the folder of results.
    pub name: String,
    /// The frame before the compared ones, and the last.
    pub frames: [i64; 2],
    /// The measured quantities, and the difference of the two references in each.
    pub measure: ErrorMeasure,
    /// Distance of the two references in each frame.
    #[serde(rename = "apart")]
    pub divergence: Vec<f64>,
    /// The finer reference, with its cost.
    pub reference: Option<Point>,
    /// The scene's own setting.
    pub own: Setting,
    /// All settings, by increasing cost.
    pub points: Vec<Point>,
    /// Whether the system is closed, so that created energy can be measured.
    pub is_closed: bool,
}

impl Point {
    fn new(
        benchmark: &Benchmark,
        run: &Run,
        measure: &ErrorMeasure,
        references: Option<&References>,
    ) -> Self {
        let errors = measure.of(benchmark, run, references.map(|both| &both.fine.run));
        let (error, limit) = least_met(measure, &errors).unzip();
        let span = references.map_or(0, |both| both.horizon.frames.max(1));
        let divergence: Vec<[f64; 2]> =
            run.frames.iter().take(span).filter_map(|frame| frame.divergence).collect();
        let largest = |of: fn(&super::run::Frame) -> f64| run.frames.iter().map(of).fold(0.0, f64::max);
        let weight = benchmark.fall_energy();
        let gain = created(run.start_energy, run.frames.iter().map(|frame| frame.energy));
        Self {
            setting: run.setting,
            ms: run.ms(),
            errors,
            error,
            limit: limit.flatten(),
            position: (!divergence.is_empty()).then(|| {
                [
                    root_mean_square(divergence.iter().map(|[rms, _]| *rms)),
                    divergence.iter().map(|[_, max]| *max).fold(0.0, f64::max),
                ]
            }),
            strain: root_mean_square(run.frames.iter().map(|frame| frame.strain)),
            max_strain: largest(|frame| frame.max_strain),
            created: (benchmark.is_closed && weight > 0.0).then(|| gain / weight),
            least_gap: run.contact.least_gap,
            pairs_unresolved: run.contact.pairs_unresolved,
            pairs: run.pairs as f64 / run.frames.len().max(1) as f64,
            queries: run.queries as f64 / run.frames.len().max(1) as f64,
            first_nonfinite: (!run.is_finite()).then(|| run.skipped + run.frames.len() + 1),
            on_frontier: false,
            hash: run.hash.clone(),
        }
    }

    /// Whether the solver created energy.
    pub fn created_energy(&self) -> bool {
        self.created.is_some_and(|created| created > CREATED)
    }

    /// Why the setting is not sound, in words.
    pub fn trouble(&self) -> Option<String> {
        let nonfinite = self.first_nonfinite.map(|frame| format!("not finite from frame {frame} on"));
        let unresolved =
            (self.pairs_unresolved > 0).then(|| format!("{} pairs unresolved", self.pairs_unresolved));
        let created = self.created.filter(|_| self.created_energy());
        let created = created.map(|share| format!("created energy: {:.2} % of a fall", 100.0 * share));
        let all: Vec<String> = [nonfinite, unresolved, created].into_iter().flatten().collect();
        (!all.is_empty()).then(|| all.join(", "))
    }

    /// Whether it is free of trouble and its error is known.
    pub fn is_sound(&self) -> bool {
        self.trouble().is_none() && self.error.is_some()
    }
}

impl Trade {
    /// Builds the curve from runs.
    pub fn new(benchmark: &Benchmark, runs: &[Run], references: Option<&References>) -> Self {
        let measure = match references {
            Some(both) => ErrorMeasure::new(benchmark, &both.coarse, &both.fine, &both.horizon),
            None => ErrorMeasure::without_reference(),
        };
        let mut points: Vec<Point> =
            runs.iter().map(|run| Point::new(benchmark, run, &measure, references)).collect();
        points.sort_by(|a, b| a.ms.total_cmp(&b.ms));
        include_finer(&mut points);
        mark_frontier(&mut points);
        // Nothing measures the finer reference itself.
        let reference = references.map(|both| Point {
            errors: Vec::new(),
            error: None,
            limit: None,
            ..Point::new(benchmark, &both.fine.run, &measure, None)
        });
        Self {
            name: benchmark.name(),
            frames: benchmark.span(),
            measure,
            divergence: references.map(|both| both.horizon.divergence.clone()).unwrap_or_default(),
            reference,
            own: benchmark.own(),
            points,
            is_closed: benchmark.is_closed,
        }
    }

    /// The Pareto frontier of sound settings, by increasing cost.
    pub fn frontier(&self) -> impl Iterator<Item = &Point> {
        self.points.iter().filter(|point| point.on_frontier)
    }

    /// The cheapest sound setting that meets a request, with all that differ from it only by more evaluations: where
    /// one of those misses it, the setting meets it by luck.
    fn cheapest(&self, request: &Request) -> Option<&Point> {
        let meets = |point: &Point| request.missed(&self.measure, &point.errors).next().is_none();
        let is_robust = |point: &Point| {
            self.points.iter().filter(|finer| is_finer(&finer.setting, &point.setting)).all(meets)
        };
        self.points.iter().find(|point| point.is_sound() && meets(point) && is_robust(point))
    }

    /// Exponent of error against time along the frontier: -1 halves the error for twice the time.
    /// `None` with fewer than three settings whose error the references resolve.
    pub fn slope(&self) -> Option<f64> {
        let all = self.frontier().filter(|point| point.limit.is_some());
        let resolved: Vec<(f64, f64)> = all.filter_map(|point| Some((point.ms.ln(), point.error?))).collect();
        if resolved.len() < 3 {
            return None;
        }
        let count = resolved.len() as f64;
        let mean = |of: &dyn Fn(&(f64, f64)) -> f64| resolved.iter().map(of).sum::<f64>() / count;
        let (x, y) = (mean(&|at| at.0), mean(&|at| at.1.ln()));
        let covariance = mean(&|at| (at.0 - x) * (at.1.ln() - y));
        let variance = mean(&|at| (at.0 - x) * (at.0 - x));
        (variance > 0.0).then(|| covariance / variance)
    }

    /// The point of the scene's own setting.
    pub fn own_point(&self) -> Option<&Point> {
        self.points.iter().find(|point| point.setting == self.own)
    }
}

/// Whether a setting differs from another only by more evaluations.
fn is_finer(finer: &Setting, setting: &Setting) -> bool {
    finer.evaluations > setting.evaluations && finer.with_evaluations(setting.evaluations) == *setting
}

/// Raises the error of each point to the largest of its finer ones: a setting that is better than those is so by luck.
fn include_finer(points: &mut [Point]) {
    let own: Vec<_> = points.iter().map(|point| (point.setting, point.error, point.limit)).collect();
    for point in points.iter_mut().filter(|point| point.error.is_some()) {
        let finer = own.iter().filter(|(setting, ..)| is_finer(setting, &point.setting));
        let worst = finer.max_by(|a, b| a.1.partial_cmp(&b.1).unwrap_or(Ordering::Equal));
        if let Some((_, error, limit)) = worst.filter(|(_, error, _)| *error > point.error) {
            (point.error, point.limit) = (*error, *limit);
        }
    }
}

/// Marks the Pareto-optimal sound points; `points` come by increasing cost.
fn mark_frontier(points: &mut [Point]) {
    let mut least = f64::INFINITY;
    for point in points {
        point.on_frontier = point.is_sound() && point.error.is_some_and(|error| error < least);
        if point.on_frontier {
            least = point.error.unwrap_or(least);
        }
    }
}

/// File of a saved curve.
const FILE: &str = "trade.json";

impl Trade {
    /// Saves the curve for `nucleus run --quality`.
    ///
    /// # Errors
    /// When it cannot be written.
    pub fn save(&self, cache: &ResultCache) -> Result<(), ResultCacheError> {
        cache.write(FILE, &serde_json::to_vec_pretty(self).unwrap_or_default())
    }

    /// Loads the last saved curve; `None` if there is none or it does not parse.
    ///
    /// # Errors
    /// When the file exists and cannot be read.
    pub fn load(cache: &ResultCache) -> Result<Option<Self>, ResultCacheError> {
        Ok(cache.read(FILE)?.and_then(|bytes| serde_json::from_slice(&bytes).ok()))
    }
}

/// The target of a recommendation.
#[derive(Debug, Clone, PartialEq)]
pub enum Wish {
    /// Errors not above these.
    Error(Request),
    /// Milliseconds per frame on one core, at most.
    Time(f64),
}

impl Wish {
    /// The setting of a trade for this wish.
    pub fn choose<'a>(&self, trade: &'a Trade) -> Choice<'a> {
        match self {
            Self::Error(request) => for_error(trade, request),
            Self::Time(ms) => for_time(trade, *ms),
        }
    }

    /// The error that the references have to resolve.
    pub(crate) fn request(&self) -> Request {
        match self {
            Self::Error(request) => request.clone(),
            Self::Time(_) => Request::every(ERROR_OF_TIMES),
        }
    }
}

/// The error that the references resolve if a time is wanted.
const ERROR_OF_TIMES: f64 = 0.01;

/// A recommended setting.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Choice<'a> {
    /// It meets the request.
    Found(&'a Point),
    /// No setting meets the request; this one is nearest.
    Nearest(&'a Point),
    /// The reference uncertainty is too large to decide; this is the most exact setting.
    Unresolved(&'a Point),
    /// No setting is sound, or what is wanted is not measured.
    None,
}

impl<'a> Choice<'a> {
    /// The setting, whether it meets the request or not.
    pub fn point(&self) -> Option<&'a Point> {
        match self {
            Self::Found(point) | Self::Nearest(point) | Self::Unresolved(point) => Some(point),
            Self::None => None,
        }
    }

    fn of(found: Option<&'a Point>, nearest: Option<&'a Point>) -> Self {
        found.map(Self::Found).or(nearest.map(Self::Nearest)).unwrap_or(Self::None)
    }
}

/// The cheapest setting that meets a request, or else the most exact. A request that the references do not resolve is
/// never [`Choice::Found`], and there is no choice where nothing measures what is wanted.
pub fn for_error<'a>(trade: &'a Trade, request: &Request) -> Choice<'a> {
    if !request.unmeasured(&trade.measure).is_empty() {
        return Choice::None;
    }
    match (request.is_unresolved(&trade.measure), trade.frontier().last()) {
        (true, Some(best)) => Choice::Unresolved(best),
        (_, best) => Choice::of(trade.cheapest(request), best),
    }
}

/// The most exact setting that takes at most this many milliseconds per frame, or else the cheapest. None where nothing
/// measures the motion.
pub fn for_time(trade: &Trade, ms: f64) -> Choice<'_> {
    if !Request::every(ERROR_OF_TIMES).unmeasured(&trade.measure).is_empty() {
        return Choice::None;
    }
    Choice::of(trade.frontier().take_while(|point| point.ms <= ms).last(), trade.frontier().next())
}

#[cfg(test)]
pub(super) mod tests {
    use super::super::error::tests::component;
    use super::*;
    use crate::trade::Reading;

    /// A synthetic point.
    pub fn point(ms: f64, error: f64) -> Point {
        let setting = Setting {
            reading: Reading::Physical,
            substeps: 3,
            collision_iterations: 4,
            evaluations: ms,
            resistance: 1.0,
            tethers: false,
        };
        Point {
            setting,
            ms,
            errors: vec![component(Quantity::Position, error)],
            error: Some(error),
            limit: Some(Quantity::Position),
            position: None,
            strain: 0.0,
            max_strain: 0.0,
            created: Some(0.0),
            least_gap: None,
            pairs_unresolved: 0,
            pairs: 0.0,
            queries: 0.0,
            first_nonfinite: None,
            on_frontier: false,
            hash: String::new(),
        }
    }

    /// A synthetic curve.
    pub fn trade(points: Vec<Point>) -> Trade {
        measured(ErrorMeasure { comparable: 47, floors: vec![(Quantity::Position, 1e-4)] }, points)
    }

    /// A curve of points with these errors.
    pub fn measured(measure: ErrorMeasure, mut points: Vec<Point>) -> Trade {
        for point in &mut points {
            let (error, limit) = least_met(&measure, &point.errors).unzip();
            (point.error, point.limit) = (error, limit.flatten());
        }
        points.sort_by(|a, b| a.ms.total_cmp(&b.ms));
        include_finer(&mut points);
        mark_frontier(&mut points);
        Trade {
            name: "synthetic".to_owned(),
            frames: [1, 48],
            measure,
            divergence: vec![1e-4; 47],
            reference: None,
            own: points[0].setting,
            points,
            is_closed: true,
        }
    }

    #[test]
    fn the_frontier_holds_the_pareto_optimal_sound_settings() {
        let through = Point { pairs_unresolved: 1, ..point(2.0, 1e-6) };
        let made = Point { created: Some(0.5), ..point(3.0, 1e-6) };
        let trade = trade(vec![point(1.0, 0.1), through, made, point(4.0, 0.2), point(5.0, 0.05)]);
        let frontier: Vec<f64> = trade.frontier().map(|point| point.ms).collect();
        assert_eq!(frontier, [1.0, 5.0]);
        assert_eq!(trade.cheapest(&Request::every(0.06)).map(|point| point.ms), Some(5.0));
        assert_eq!(trade.cheapest(&Request::every(0.01)), None);
    }

    #[test]
    fn an_error_inversely_proportional_to_time_has_a_slope_of_minus_one() {
        let trade = trade([1.0, 2.0, 4.0, 8.0].map(|ms| point(ms, 0.1 / ms)).to_vec());
        // The noise floor of 0.01 % is part of each error.
        assert!((trade.slope().unwrap() + 1.0).abs() < 0.01);
    }

    #[test]
    fn errors_below_the_reference_uncertainty_give_no_slope() {
        let trade = trade([1.0, 2.0, 4.0].map(|ms| point(ms, 1e-4 / ms)).to_vec());
        assert!(trade.points.iter().all(|point| point.limit.is_none()));
        assert_eq!(trade.slope(), None);
    }

    #[test]
    fn an_error_gets_the_cheapest_sufficient_setting_and_a_time_the_most_exact_affordable_one() {
        let trade = trade(vec![point(1.0, 0.1), point(2.0, 0.05), point(4.0, 0.01), point(8.0, 0.002)]);
        let ms = |choice: Choice| match choice {
            Choice::Found(point) => Ok(point.ms),
            Choice::Nearest(point) | Choice::Unresolved(point) => Err(point.ms),
            Choice::None => Err(0.0),
        };
        assert_eq!(ms(for_error(&trade, &Request::every(0.051))), Ok(2.0));
        // Against other references its error may exceed 5 %.
        assert_eq!(ms(for_error(&trade, &Request::every(0.05))), Ok(4.0));
        assert_eq!(ms(for_error(&trade, &Request::every(0.001))), Err(8.0));
        assert_eq!(ms(for_time(&trade, 5.0)), Ok(4.0));
        assert_eq!(ms(for_time(&trade, 0.5)), Err(1.0));
    }

    #[test]
    fn a_setting_that_meets_an_error_by_luck_is_not_recommended() {
        let lucky = trade(vec![point(1.0, 0.004), point(2.0, 0.05), point(4.0, 0.01), point(8.0, 0.002)]);
        assert_eq!(lucky.cheapest(&Request::every(0.02)).map(|point| point.ms), Some(4.0));
        let mut other = point(2.0, 0.05);
        other.setting.substeps = 1;
        let independent = trade(vec![point(1.0, 0.004), other, point(4.0, 0.01)]);
        assert_eq!(independent.cheapest(&Request::every(0.02)).map(|point| point.ms), Some(1.0));
    }

    #[test]
    fn the_error_of_a_setting_includes_those_of_its_finer_ones() {
        let lucky = trade(vec![point(1.0, 0.004), point(2.0, 0.05), point(4.0, 0.01)]);
        let errors = lucky.points.iter().filter_map(|point| point.error);
        assert!(
            errors.zip([0.0501, 0.0501, 0.0101]).all(|(error, expected)| (error - expected).abs() < 1e-12)
        );
    }

    #[test]
    fn an_error_that_the_references_do_not_resolve_is_not_promised() {
        let measure = ErrorMeasure { comparable: 47, floors: vec![(Quantity::Position, 0.004)] };
        let trade = Trade { measure, ..trade(vec![point(1.0, 0.1), point(2.0, 0.001)]) };
        let found = |error| for_error(&trade, &Request::every(error));
        assert!(matches!(found(0.007), Choice::Unresolved(point) if point.ms == 2.0));
        assert!(matches!(found(0.009), Choice::Found(point) if point.ms == 2.0));
    }

    #[test]
    fn cloth_in_its_place_that_is_visibly_stretched_is_not_recommended() {
        let of = |position, stretch| {
            vec![component(Quantity::Position, position), component(Quantity::Stretch, stretch)]
        };
        let stretched = Point { errors: of(0.004, 0.06), ..point(1.0, 0.0) };
        let exact = Point { errors: of(0.004, 0.005), ..point(4.0, 0.0) };
        let trade = trade(vec![stretched, exact]);
        assert!(matches!(for_error(&trade, &Request::every(0.01)), Choice::Found(point) if point.ms == 4.0));
        let position = Request { every: None, bounds: vec![(Quantity::Position, 0.01)] };
        assert!(matches!(for_error(&trade, &position), Choice::Found(point) if point.ms == 1.0));
    }

    #[test]
    fn where_nothing_measures_the_motion_nothing_is_recommended() {
        let energy = |ms| Point { errors: vec![component(Quantity::Energy, 1e-6)], ..point(ms, 1e-6) };
        let measure = ErrorMeasure { comparable: 0, floors: vec![(Quantity::Energy, 1e-9)] };
        let beads = Trade { measure, ..trade(vec![energy(1.0), energy(2.0)]) };
        for error in [0.1, 0.01, 0.001] {
            assert_eq!(for_error(&beads, &Request::every(error)), Choice::None);
        }
        assert_eq!(for_time(&beads, 9.0), Choice::None);
        let only_energy = Request { every: None, bounds: vec![(Quantity::Energy, 0.01)] };
        assert!(matches!(for_error(&beads, &only_energy), Choice::Found(point) if point.ms == 1.0));
    }

    #[test]
    fn without_a_sound_setting_nothing_is_recommended() {
        let trade = trade(vec![Point { pairs_unresolved: 3, ..point(1.0, 0.1) }]);
        assert_eq!(for_error(&trade, &Request::every(1.0)), Choice::None);
        assert_eq!(for_time(&trade, 9.0).point(), None);
    }
}
