//! What is found: every setting with its error and its cost.

use serde::{Deserialize, Serialize};

use super::measure::Measure;
use super::run::Run;
use super::setting::Setting;
use super::subject::Subject;
use crate::metrics::{energy, root_mean_square};
use crate::reference::References;

/// Energy above the start counts as created from this share of what the cloth has in a fall by its own size.
const CREATED: f64 = 0.001;

/// A setting with what it costs and how wrong it is.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Point {
    /// What was set.
    pub setting: Setting,
    /// Milliseconds of processor time to a frame, on one core.
    pub ms: f64,
    /// The error by the scene's measure; nothing if the run was not finite.
    pub error: Option<f64>,
    /// The distance from the reference to the horizon: RMS, and the largest.
    pub position: Option<[f64; 2]>,
    /// The strain that 99 % of the edges stay below, RMS over frames.
    pub strain: f64,
    /// The largest strain of all frames.
    pub max_strain: f64,
    /// Energy created, over that of a fall by the cloth's own size; nothing where something drives the cloth.
    pub created: Option<f64>,
    /// The smallest gap over the thickness.
    pub least_gap: Option<f64>,
    /// Pairs of elements that were not kept apart, once for each time step.
    #[serde(alias = "crossed")]
    pub pairs_unresolved: u64,
    /// Candidate pairs in a frame.
    pub pairs: f64,
    /// Runs of the broad phase in a frame.
    pub searches: f64,
    /// The first frame that was not finite, counted from the start.
    pub lost: Option<usize>,
    /// Whether no setting that is sound is both cheaper and more exact.
    pub on_frontier: bool,
    /// The run's last state, in hexadecimal.
    pub hash: String,
}

/// A scene at many settings.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Trade {
    /// The solver, and the scene: where results are kept.
    pub name: String,
    /// First and last frame.
    pub frames: [i64; 2],
    /// What error means here.
    pub measure: Measure,
    /// The error below which nothing can be told: how far the two references differ by the same measure.
    pub floor: Option<f64>,
    /// How far the references differ in each frame.
    pub apart: Vec<f64>,
    /// The reference, with its cost.
    pub reference: Option<Point>,
    /// The scene's own setting.
    pub own: Setting,
    /// Every setting, the cheapest first.
    pub points: Vec<Point>,
    /// Whether nothing drives the cloth, so that energy created can be told.
    pub is_closed: bool,
}

impl Point {
    fn new(subject: &Subject, run: &Run, measure: &Measure, references: Option<&References>) -> Self {
        let error = measure.error(run, references.map(|both| &both.fine.run));
        let span = references.map_or(0, |both| both.horizon.frames.max(1));
        let apart: Vec<[f64; 2]> = run.frames.iter().take(span).filter_map(|frame| frame.apart).collect();
        let largest = |of: fn(&super::run::Frame) -> f64| run.frames.iter().map(of).fold(0.0, f64::max);
        let weight = subject.masses.iter().sum::<f64>() * subject.gravity.norm() * subject.size;
        let made = energy::created(run.start_energy, run.frames.iter().map(|frame| frame.energy));
        Self {
            setting: run.setting,
            ms: run.ms(),
            error: error.is_finite().then_some(error),
            position: (!apart.is_empty()).then(|| {
                [
                    root_mean_square(apart.iter().map(|[rms, _]| *rms)),
                    apart.iter().map(|[_, max]| *max).fold(0.0, f64::max),
                ]
            }),
            strain: root_mean_square(run.frames.iter().map(|frame| frame.strain)),
            max_strain: largest(|frame| frame.max_strain),
            created: (subject.is_closed && weight > 0.0).then(|| made / weight),
            least_gap: run.contact.least_gap,
            pairs_unresolved: run.contact.pairs_unresolved,
            pairs: run.pairs as f64 / run.frames.len().max(1) as f64,
            searches: run.searches as f64 / run.frames.len().max(1) as f64,
            lost: (!run.is_finite()).then(|| run.frames.len() + 1),
            on_frontier: false,
            hash: run.hash.clone(),
        }
    }

    /// Whether energy came from nowhere.
    pub fn made_energy(&self) -> bool {
        self.created.is_some_and(|created| created > CREATED)
    }

    /// What forbids the setting, in words.
    pub fn trouble(&self) -> Option<String> {
        let lost = self.lost.map(|frame| format!("not finite from frame {frame} on"));
        let unresolved =
            (self.pairs_unresolved > 0).then(|| format!("{} pairs unresolved", self.pairs_unresolved));
        let created = self.created.filter(|_| self.made_energy());
        let created = created.map(|share| format!("created energy: {:.2} % of a fall", 100.0 * share));
        let all: Vec<String> = [lost, unresolved, created].into_iter().flatten().collect();
        (!all.is_empty()).then(|| all.join(", "))
    }

    /// Whether nothing forbids it, and its error is known.
    pub fn is_sound(&self) -> bool {
        self.trouble().is_none() && self.error.is_some()
    }
}

impl Trade {
    /// Judges runs.
    pub fn new(subject: &Subject, runs: &[Run], references: Option<&References>) -> Self {
        let measure = Measure::choose(references.map(|both| &both.horizon));
        let mut points: Vec<Point> =
            runs.iter().map(|run| Point::new(subject, run, &measure, references)).collect();
        points.sort_by(|a, b| a.ms.total_cmp(&b.ms));
        mark_frontier(&mut points);
        let span = subject.program().time();
        let floor = references.map(Self::floor);
        Self {
            name: subject.name(),
            frames: [span.start, span.end],
            measure,
            floor,
            apart: references.map(|both| both.horizon.apart.clone()).unwrap_or_default(),
            reference: references.map(|both| Point::new(subject, &both.fine.run, &measure, None)),
            own: subject.own(),
            points,
            is_closed: subject.is_closed,
        }
    }

    /// How far two references differ by the measure that they allow.
    pub fn floor(both: &References) -> f64 {
        match Measure::choose(Some(&both.horizon)) {
            Measure::Position { .. } => both.horizon.floor,
            measure => measure.error(&both.coarse.run, Some(&both.fine.run)),
        }
    }

    /// The settings that nothing beats, the cheapest first.
    pub fn frontier(&self) -> impl Iterator<Item = &Point> {
        self.points.iter().filter(|point| point.on_frontier)
    }

    /// The cheapest sound setting whose error is not above this.
    pub fn cheapest(&self, error: f64) -> Option<&Point> {
        self.frontier().find(|point| point.error.is_some_and(|found| found <= error))
    }

    /// Whether an error can be told from none: the references have to differ by less than half of it.
    pub fn can_tell(&self, error: f64) -> bool {
        self.floor.is_none_or(|floor| told(floor, error))
    }

    /// By which power of the time the error falls along the frontier: -1 is half the error for twice the time.
    /// Nothing with fewer than three settings whose error can be told.
    pub fn slope(&self) -> Option<f64> {
        let told = self.frontier().filter_map(|point| Some((point.ms.ln(), point.error?)));
        let told: Vec<(f64, f64)> = told.filter(|(_, error)| self.can_tell(*error) && *error > 0.0).collect();
        if told.len() < 3 {
            return None;
        }
        let count = told.len() as f64;
        let mean = |of: &dyn Fn(&(f64, f64)) -> f64| told.iter().map(of).sum::<f64>() / count;
        let (x, y) = (mean(&|at| at.0), mean(&|at| at.1.ln()));
        let above = mean(&|at| (at.0 - x) * (at.1.ln() - y));
        let below = mean(&|at| (at.0 - x) * (at.0 - x));
        (below > 0.0).then(|| above / below)
    }

    /// The point of the scene's own setting.
    pub fn own_point(&self) -> Option<&Point> {
        self.points.iter().find(|point| point.setting == self.own)
    }
}

/// Whether an error can be told from none by references that differ by so much.
pub(super) fn told(floor: f64, error: f64) -> bool {
    2.0 * floor <= error
}

/// Marks the sound points that none before them is more exact than; they come the cheapest first.
fn mark_frontier(points: &mut [Point]) {
    let mut least = f64::INFINITY;
    for point in points {
        point.on_frontier = point.is_sound() && point.error.is_some_and(|error| error < least);
        if point.on_frontier {
            least = point.error.unwrap_or(least);
        }
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::trade::Reading;

    /// A point of a made-up trade.
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
            searches: 0.0,
            lost: None,
            on_frontier: false,
            hash: String::new(),
        }
    }

    /// A made-up trade.
    pub fn trade(mut points: Vec<Point>) -> Trade {
        mark_frontier(&mut points);
        Trade {
            name: "made up".to_owned(),
            frames: [1, 48],
            measure: Measure::Position { frames: 47 },
            floor: Some(1e-4),
            apart: vec![1e-4; 47],
            reference: None,
            own: points[0].setting,
            points,
            is_closed: true,
        }
    }

    #[test]
    fn the_frontier_is_what_nothing_sound_beats() {
        let through = Point { pairs_unresolved: 1, ..point(2.0, 1e-6) };
        let made = Point { created: Some(0.5), ..point(3.0, 1e-6) };
        let trade = trade(vec![point(1.0, 0.1), through, made, point(4.0, 0.2), point(5.0, 0.05)]);
        let frontier: Vec<f64> = trade.frontier().map(|point| point.ms).collect();
        assert_eq!(frontier, [1.0, 5.0]);
        assert_eq!(trade.cheapest(0.06).map(|point| point.ms), Some(5.0));
        assert_eq!(trade.cheapest(0.01), None);
    }

    #[test]
    fn an_error_that_halves_with_twice_the_time_has_a_slope_of_minus_one() {
        let trade = trade([1.0, 2.0, 4.0, 8.0].map(|ms| point(ms, 0.1 / ms)).to_vec());
        assert!((trade.slope().unwrap() + 1.0).abs() < 1e-12);
    }

    #[test]
    fn what_the_references_themselves_differ_by_counts_for_no_slope() {
        let trade = trade([1.0, 2.0, 4.0].map(|ms| point(ms, 1e-4 / ms)).to_vec());
        assert!(!trade.can_tell(1e-4) && trade.can_tell(1e-3));
        assert_eq!(trade.slope(), None);
    }
}
