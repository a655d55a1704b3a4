//! The rows of the table: a run with its result, and its figures.

use serde_json::Value;

use crate::plan::PlannedRun;
use crate::result::{RunOutcome, RunResult};

/// A run with its result.
#[derive(Debug, Clone, Copy)]
pub struct Row<'a> {
    /// The run.
    pub run: &'a PlannedRun,
    /// Its result; `None` if it has not ended.
    pub result: Option<&'a RunResult>,
    /// What is wrong with the cache that it has left.
    pub fault: Option<&'a str>,
}

impl Row<'_> {
    /// The problems of the run and of its cache, in words.
    pub fn problems(&self) -> Vec<String> {
        let of_run = self.result.map(RunResult::problems).unwrap_or_default();
        of_run.into_iter().chain(self.fault.map(str::to_owned)).collect()
    }
}

/// How many runs ended in which way.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Counts {
    /// All runs of the plan.
    pub all: usize,
    /// Runs with all their frames, and nothing wrong.
    pub success: usize,
    /// Runs with all their frames, and a problem.
    pub problem: usize,
    /// Runs that failed or were killed.
    pub failed: usize,
    /// Runs that have not ended, or were interrupted.
    pub open: usize,
}

impl Counts {
    /// Counts results.
    pub fn of<'a>(results: impl Iterator<Item = Option<&'a RunResult>>) -> Self {
        let mut counts = Self::default();
        for result in results {
            counts.all += 1;
            *match result.map(|result| result.outcome) {
                Some(RunOutcome::Success) => &mut counts.success,
                Some(RunOutcome::Problem) => &mut counts.problem,
                Some(RunOutcome::Failed | RunOutcome::Killed) => &mut counts.failed,
                Some(RunOutcome::Interrupted) | None => &mut counts.open,
            } += 1;
        }
        counts
    }
}

/// `45 runs: 43 success, 1 problem, 1 failed`.
impl std::fmt::Display for Counts {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { all, success, problem, failed, open } = *self;
        let parts = [(success, "success"), (problem, "problem"), (failed, "failed"), (open, "open")];
        let said: Vec<String> = parts
            .iter()
            .filter(|(count, _)| *count > 0)
            .map(|(count, word)| format!("{count} {word}"))
            .collect();
        write!(f, "{all} run{}: {}", if all == 1 { "" } else { "s" }, said.join(", "))
    }
}

/// A figure of the table: heading, and its value in a report.
pub type Figure = (&'static str, fn(&RunResult) -> Value);

/// The figures of a run, in the order of the columns.
pub const FIGURES: [Figure; 13] = [
    ("frames", |result| result.figure("frames").clone()),
    ("last frame", |result| result.figure("last").clone()),
    ("ms/frame", |result| result.solved().and_then(|solved| solved.milliseconds()).into()),
    ("frames timed", |result| result.solved().map(|solved| solved.frames).into()),
    ("worst strain", |result| result.figure("worst_strain")["value"].clone()),
    ("smallest gap", |result| result.figure("smallest_gap")["value"].clone()),
    ("volume error", |result| result.figure("worst_volume_error")["value"].clone()),
    ("unresolved pairs", |result| result.figure("pairs_unresolved").clone()),
    ("points in colliders", |result| result.figure("depenetrating")["most"].clone()),
    ("intersections", |result| result.figure("intersections")["most"].clone()),
    ("failed checks", |result| failed_checks(result)),
    ("bytes", |result| result.figure("bytes").clone()),
    ("runs at once", |result| result.at_once.into()),
];

fn failed_checks(result: &RunResult) -> Value {
    match result.figure("checks").as_array() {
        Some(checks) => checks.iter().filter(|check| check["passed"] == false).count().into(),
        None => Value::Null,
    }
}

/// A value as text: empty for null, numbers in full.
pub fn text(value: &Value) -> String {
    match value {
        Value::Null => String::new(),
        Value::String(text) => text.clone(),
        other => other.to_string(),
    }
}
