//! A row of the table.

use super::scene::TestScene;
use super::timeline::Timeline;

/// A named extreme.
#[derive(Debug, Clone, Copy)]
pub struct StressCase {
    /// Its name, for `--only`.
    pub name: &'static str,
    /// Which part of the table it belongs to.
    pub group: &'static str,
    /// What is extreme, in one line.
    pub what: &'static str,
    /// What a user should expect, and what to do where that is not enough.
    pub expect: &'static str,
    /// How it is put to the test.
    pub expectation: Expectation,
    /// Why it fails, where it is known to.
    pub known_failure: Option<&'static str>,
}

/// How an extreme is put to the test.
#[derive(Debug, Clone, Copy)]
pub enum Expectation {
    /// It runs, and these things hold.
    Runs {
        /// The scene.
        scene: fn() -> TestScene,
        /// The same without the extreme, that it may cost three times as much as.
        baseline: fn() -> TestScene,
        /// By what the cost is divided.
        cost: CostUnit,
        /// What the start holds in joules besides what falls and is stretched.
        initial_energy: f64,
        /// How it comes to rest when the cause has ended.
        recovery: Option<Recovery>,
        /// What else holds.
        assertions: &'static [Assertion],
        /// What has to be said when it is read; nothing else is.
        warnings: &'static [&'static str],
    },
    /// It is refused when it is read, in these words.
    InvalidInput {
        /// The scene.
        scene: fn() -> TestScene,
        /// What the message has to name.
        names: &'static [&'static str],
    },
}

/// What the processor time of a run is divided by, before it is compared.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CostUnit {
    /// Frames.
    Frame,
    /// Time steps: where the extreme is how many there are.
    Step,
    /// Evaluated rows: where the extreme is how often an effect is evaluated, or how large the mesh is.
    Evaluation,
}

/// How a run comes to rest when the cause has ended.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Recovery {
    /// From this frame on...
    pub from: i64,
    /// ... the root mean square speed is at most this, in m/s.
    pub speed: f64,
    /// ... 99 % of the links are stretched by at most this share.
    pub strain: f64,
}

/// On which side of its limit a figure has to stay.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Side {
    /// It must not be larger.
    AtMost,
    /// It must not be smaller.
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

/// Something else that holds: a figure read off the run and its nominal one, and a bound on it.
#[derive(Debug, Clone, Copy)]
pub struct Assertion {
    /// What is measured, with its unit.
    pub what: &'static str,
    /// Reads it off: the run, then the nominal one.
    pub figure: fn(&Timeline, &Timeline) -> f64,
    /// On which side of the limit it has to stay.
    pub side: Side,
    /// The limit.
    pub limit: f64,
}

impl CostUnit {
    /// What a run took, in seconds per frame, step or evaluation.
    pub fn of(self, timeline: &Timeline) -> f64 {
        let divisor = match self {
            Self::Frame => timeline.frames.len() as f64,
            Self::Step => timeline.steps,
            Self::Evaluation => timeline.evaluations,
        };
        timeline.seconds / divisor.max(1.0)
    }

    /// What it is per.
    pub fn per(self) -> &'static str {
        match self {
            Self::Frame => "frame",
            Self::Step => "time step",
            Self::Evaluation => "evaluated row",
        }
    }
}
