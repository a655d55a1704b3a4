//! The result of one run: a JSON file that exists only when the run has ended.

use serde::{Deserialize, Serialize};
use serde_json::Value;

/// How a run ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum RunOutcome {
    /// It reached its last frame, and nothing is wrong.
    Success,
    /// It ran and found a problem: a check failed, contact stayed unresolved, or a number was not finite.
    Problem,
    /// It could not start, or could not write its cache.
    Failed,
    /// It was asked to end, and has closed its cache.
    Interrupted,
    /// The system or another user ended its process.
    Killed,
}

/// The result of a run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RunResult {
    /// How it ended.
    pub outcome: RunOutcome,
    /// Why it failed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub error: Option<String>,
    /// Wall-clock time of its process in seconds; of the last one if it was resumed.
    pub seconds: f64,
    /// Runs that were started side by side, this one included. Times are those of a run alone only if it is 1.
    pub at_once: u32,
    /// The machine that ran it.
    pub machine: String,
    /// The report of the command.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub report: Option<Value>,
}

impl RunOutcome {
    /// Whether the run has all its frames. Other runs are done again or resumed by `--continue`.
    pub fn is_final(self) -> bool {
        matches!(self, Self::Success | Self::Problem)
    }

    /// In a word, for tables.
    pub fn word(self) -> &'static str {
        match self {
            Self::Success => "success",
            Self::Problem => "problem",
            Self::Failed => "failed",
            Self::Interrupted => "interrupted",
            Self::Killed => "killed",
        }
    }
}

impl RunResult {
    /// A field of the report's summary.
    pub fn figure(&self, key: &str) -> &Value {
        self.report.as_ref().map_or(&Value::Null, |report| &report["summary"][key])
    }

    /// The problems in words: the error, failed checks, unresolved contact.
    pub fn problems(&self) -> Vec<String> {
        let mut all: Vec<String> = self.error.iter().cloned().collect();
        if let Some(ending) = self.figure("ending").as_str().filter(|ending| *ending == "not finite") {
            all.push(format!("a position or velocity is {ending} at frame {}", self.figure("last")));
        }
        let checks = self.figure("checks").as_array().into_iter().flatten();
        all.extend(checks.filter(|check| check["passed"] == false).map(failed_check));
        let texts = self.figure("unresolved_contact").as_array().into_iter().flatten();
        all.extend(texts.filter_map(Value::as_str).map(str::to_owned));
        if all.is_empty() && self.outcome != RunOutcome::Success {
            all.push(self.outcome.word().to_owned());
        }
        all
    }
}

fn failed_check(check: &Value) -> String {
    let figure = match (&check["figure"], &check["frame"]) {
        (Value::Null, _) => String::new(),
        (figure, frame) => format!(" with {figure} at frame {frame}"),
    };
    format!("check {} failed{figure}", check["check"].as_str().unwrap_or_default())
}
