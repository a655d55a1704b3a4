//! A row of the table: a scene, its baseline, and bounds.

use serde::{Deserialize, Serialize};

use super::scene::TestScene;
use super::timeline::Timeline;

/// A stress case.
#[derive(Debug, Clone, Copy)]
pub struct StressCase {
    /// Its name, for `--only`.
    pub name: &'static str,
    /// Its group in the table.
    pub group: &'static str,
    /// The extreme input, in one line without a full stop.
    pub summary: &'static str,
    /// The expected behaviour, and a workaround if that is not sufficient.
    pub expected: &'static str,
    /// Scene and bounds.
    pub expectation: Expectation,
    /// Why it fails, if it is known to.
    pub known_failure: Option<&'static str>,
}

/// Expected outcome of a scene.
#[derive(Debug, Clone, Copy)]
pub enum Expectation {
    /// It runs within bounds.
    Runs(Runs),
    /// It is rejected with an error.
    Rejected {
        /// The scene.
        scene: fn() -> TestScene,
        /// Parts of the message, separated by semicolons.
        message: &'static str,
    },
}

/// A scene that runs, and its bounds. Bounds that the check language expresses are checks of the scene itself.
#[derive(Debug, Clone, Copy)]
pub struct Runs {
    /// The scene.
    pub scene: fn() -> TestScene,
    /// The same scene without the extreme input: the baseline of its cost.
    pub baseline: fn() -> TestScene,
    /// The unit of cost.
    pub cost: CostUnit,
    /// Energy of the initial state in joules, besides potential and elastic energy.
    pub initial_energy: f64,
    /// Bounds on the motion after the disturbance; `None` takes them from the checks of the scene.
    pub recovery: Option<Recovery>,
    /// Bounds besides the checks of the scene.
    pub assertions: &'static [Assertion],
    /// Parts of the expected warnings; any other warning is a failure.
    pub warnings: &'static [&'static str],
}

/// Denominator of the processor time of a run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CostUnit {
    /// Frames.
    Frame,
    /// Time steps: for an extreme number of steps.
    Step,
    /// Evaluated rows: for an extreme number of iterations, or a larger mesh.
    Evaluation,
}

/// Bounds on the motion after the disturbance has ended.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Recovery {
    /// First frame of the bounds.
    pub from: i64,
    /// Root mean square speed in m/s.
    #[serde(with = "crate::bits")]
    pub speed: f64,
    /// 99th percentile of strain.
    #[serde(with = "crate::bits")]
    pub strain: f64,
}

/// Side of a limit.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Side {
    /// Upper limit.
    AtMost,
    /// Lower limit.
    AtLeast,
}

impl Side {
    /// In words.
    pub fn words(self) -> &'static str {
        match self {
            Self::AtMost => "at most",
            Self::AtLeast => "at least",
        }
    }
}

/// A bound on a figure of a run and its baseline.
#[derive(Debug, Clone, Copy)]
pub struct Assertion {
    /// The figure, with its unit.
    pub what: &'static str,
    /// Computes it from the run and the baseline.
    pub figure: fn(&Timeline, &Timeline) -> f64,
    /// Side of the limit.
    pub side: Side,
    /// The limit.
    pub limit: f64,
}

impl Assertion {
    /// An upper limit.
    pub const fn at_most(what: &'static str, limit: f64, figure: fn(&Timeline, &Timeline) -> f64) -> Self {
        Self { what, figure, side: Side::AtMost, limit }
    }

    /// A lower limit.
    pub const fn at_least(what: &'static str, limit: f64, figure: fn(&Timeline, &Timeline) -> f64) -> Self {
        Self { what, figure, side: Side::AtLeast, limit }
    }
}

impl StressCase {
    /// The scene.
    pub fn scene(&self) -> TestScene {
        match self.expectation {
            Expectation::Runs(Runs { scene, .. }) | Expectation::Rejected { scene, .. } => scene(),
        }
    }
}

impl CostUnit {
    /// Processor time in seconds per unit.
    pub fn of(self, timeline: &Timeline) -> f64 {
        let divisor = match self {
            Self::Frame => timeline.frames.len() as f64,
            Self::Step => timeline.steps,
            Self::Evaluation => timeline.evaluations,
        };
        timeline.seconds / divisor.max(1.0)
    }

    /// Name of the unit.
    pub fn name(self) -> &'static str {
        match self {
            Self::Frame => "frame",
            Self::Step => "time step",
            Self::Evaluation => "evaluated row",
        }
    }
}
