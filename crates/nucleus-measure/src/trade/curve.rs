//! The work-precision curve: every setting with its processor time and its error; frontier, slope, recommendation.

use serde::{Deserialize, Serialize};

use super::benchmark::Benchmark;
use super::reference::{ErrorMeasure, References};
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
    /// The error by the scene's measure; `None` if the run was not finite.
    pub error: Option<f64>,
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
    /// First and last frame.
    pub frames: [i64; 2],
    /// Definition of the error.
    pub measure: ErrorMeasure,
    /// Reference uncertainty: the difference of the two references by the same measure.
    pub floor: Option<f64>,
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
        let error = measure.error(run, references.map(|both| &both.fine.run));
        let span = references.map_or(0, |both| both.horizon.frames.max(1));
        let divergence: Vec<[f64; 2]> =
            run.frames.iter().take(span).filter_map(|frame| frame.divergence).collect();
        let largest = |of: fn(&super::run::Frame) -> f64| run.frames.iter().map(of).fold(0.0, f64::max);
        let weight = benchmark.masses.iter().sum::<f64>() * benchmark.gravity.norm() * benchmark.size;
        let gain = created(run.start_energy, run.frames.iter().map(|frame| frame.energy));
        Self {
            setting: run.setting,
            ms: run.ms(),
            error: error.is_finite().then_some(error),
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
            first_nonfinite: (!run.is_finite()).then(|| run.frames.len() + 1),
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
        let measure = ErrorMeasure::choose(references.map(|both| &both.horizon));
        let mut points: Vec<Point> =
            runs.iter().map(|run| Point::new(benchmark, run, &measure, references)).collect();
        points.sort_by(|a, b| a.ms.total_cmp(&b.ms));
        mark_frontier(&mut points);
        let span = benchmark.program().time();
        let floor = references.map(Self::floor);
        Self {
            name: benchmark.name(),
            frames: [span.start, span.end],
            measure,
            floor,
            divergence: references.map(|both| both.horizon.divergence.clone()).unwrap_or_default(),
            reference: references.map(|both| Point::new(benchmark, &both.fine.run, &measure, None)),
            own: benchmark.own(),
            points,
            is_closed: benchmark.is_closed,
        }
    }

    /// Reference uncertainty: the difference of the two references by the measure that they permit.
    pub fn floor(both: &References) -> f64 {
        match ErrorMeasure::choose(Some(&both.horizon)) {
            ErrorMeasure::Position { .. } => both.horizon.floor,
            measure => measure.error(&both.coarse.run, Some(&both.fine.run)),
        }
    }

    /// The Pareto frontier of sound settings, by increasing cost.
    pub fn frontier(&self) -> impl Iterator<Item = &Point> {
        self.points.iter().filter(|point| point.on_frontier)
    }

    /// The cheapest sound setting with at most this error.
    pub fn cheapest(&self, error: f64) -> Option<&Point> {
        self.frontier().find(|point| point.error.is_some_and(|found| found <= error))
    }

    /// Whether the reference uncertainty is at most half of an error.
    pub fn resolves(&self, error: f64) -> bool {
        self.floor.is_none_or(|floor| is_resolved(floor, error))
    }

    /// Exponent of error against time along the frontier: -1 halves the error for twice the time.
    /// `None` with fewer than three settings whose error the references resolve.
    pub fn slope(&self) -> Option<f64> {
        let all = self.frontier().filter_map(|point| Some((point.ms.ln(), point.error?)));
        let resolved: Vec<(f64, f64)> =
            all.filter(|(_, error)| self.resolves(*error) && *error > 0.0).collect();
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

/// Whether references with an uncertainty of `floor` resolve an error.
pub(super) fn is_resolved(floor: f64, error: f64) -> bool {
    2.0 * floor <= error
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

/// A recommended setting.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Choice<'a> {
    /// It meets the request.
    Found(&'a Point),
    /// No setting meets the request; this one is nearest.
    Nearest(&'a Point),
    /// The reference uncertainty is too large to decide; this is the most exact setting.
    Unresolved(&'a Point),
    /// No setting is sound.
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

/// The cheapest setting with at most this error, or else the most exact. An unresolved error is never [`Choice::Found`].
pub fn for_error(trade: &Trade, error: f64) -> Choice<'_> {
    match (trade.resolves(error), trade.frontier().last()) {
        (false, Some(best)) => Choice::Unresolved(best),
        (_, best) => Choice::of(trade.cheapest(error), best),
    }
}

/// The most exact setting that takes at most this many milliseconds per frame, or else the cheapest.
pub fn for_time(trade: &Trade, ms: f64) -> Choice<'_> {
    Choice::of(trade.frontier().take_while(|point| point.ms <= ms).last(), trade.frontier().next())
}

#[cfg(test)]
pub(super) mod tests {
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
        };
        Point {
            setting,
            ms,
            error: Some(error),
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
    pub fn trade(mut points: Vec<Point>) -> Trade {
        mark_frontier(&mut points);
        Trade {
            name: "synthetic".to_owned(),
            frames: [1, 48],
            measure: ErrorMeasure::Position { frames: 47 },
            floor: Some(1e-4),
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
        assert_eq!(trade.cheapest(0.06).map(|point| point.ms), Some(5.0));
        assert_eq!(trade.cheapest(0.01), None);
    }

    #[test]
    fn an_error_inversely_proportional_to_time_has_a_slope_of_minus_one() {
        let trade = trade([1.0, 2.0, 4.0, 8.0].map(|ms| point(ms, 0.1 / ms)).to_vec());
        assert!((trade.slope().unwrap() + 1.0).abs() < 1e-12);
    }

    #[test]
    fn errors_below_the_reference_uncertainty_give_no_slope() {
        let trade = trade([1.0, 2.0, 4.0].map(|ms| point(ms, 1e-4 / ms)).to_vec());
        assert!(!trade.resolves(1e-4) && trade.resolves(1e-3));
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
        assert_eq!(ms(for_error(&trade, 0.05)), Ok(2.0));
        assert_eq!(ms(for_error(&trade, 0.001)), Err(8.0));
        assert_eq!(ms(for_time(&trade, 5.0)), Ok(4.0));
        assert_eq!(ms(for_time(&trade, 0.5)), Err(1.0));
    }

    #[test]
    fn an_error_that_the_references_do_not_resolve_is_not_promised() {
        let trade = Trade { floor: Some(0.004), ..trade(vec![point(1.0, 0.1), point(2.0, 0.001)]) };
        assert!(matches!(for_error(&trade, 0.007), Choice::Unresolved(point) if point.ms == 2.0));
        assert!(matches!(for_error(&trade, 0.009), Choice::Found(point) if point.ms == 2.0));
    }

    #[test]
    fn without_a_sound_setting_nothing_is_recommended() {
        let trade = trade(vec![Point { pairs_unresolved: 3, ..point(1.0, 0.1) }]);
        assert_eq!(for_error(&trade, 1.0), Choice::None);
        assert_eq!(for_time(&trade, 9.0).point(), None);
    }
}
