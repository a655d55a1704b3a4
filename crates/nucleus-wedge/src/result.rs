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
    /// Wall-clock time of its process in seconds. A resumed run adds that of the earlier processes whose time is known.
    pub seconds: f64,
    /// The frames that earlier processes of a resumed run solved, as far as their time is known.
    #[serde(default, skip_serializing_if = "SolvedFrames::is_none")]
    pub earlier: SolvedFrames,
    /// Runs that were started side by side, this one included. Times are those of a run alone only if it is 1.
    pub at_once: u32,
    /// The machine that ran it.
    pub machine: String,
    /// The number of results that the run has had, this one included. It tells the result of a process from an older one.
    #[serde(default)]
    pub attempt: u32,
    /// The report of the command.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub report: Option<Value>,
}

/// Solved frames and their time. A frame that was solved again counts twice.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct SolvedFrames {
    /// How many.
    pub frames: u64,
    /// Wall-clock time of all of them in seconds.
    pub seconds: f64,
}

impl SolvedFrames {
    fn is_none(&self) -> bool {
        self.frames == 0
    }

    /// Mean time of a frame in milliseconds; `None` without frames.
    pub fn milliseconds(&self) -> Option<f64> {
        (self.frames > 0).then(|| 1e3 * self.seconds / self.frames as f64)
    }
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

    /// The frames that all processes of the run have solved, as far as their time is known: a process that was killed left
    /// none. `None` if the report has no frames.
    pub fn solved(&self) -> Option<SolvedFrames> {
        let before = self.figure("frames_before").as_u64().unwrap_or_default();
        let frames = self.figure("frames").as_u64()?.saturating_sub(before);
        let seconds = self.figure("seconds").as_f64()?;
        Some(SolvedFrames { frames: self.earlier.frames + frames, seconds: self.earlier.seconds + seconds })
    }

    /// This result as the next one after an earlier one, with its times if this process has continued its frames.
    pub fn after(mut self, earlier: Option<&Self>) -> Self {
        self.attempt = earlier.map_or(0, |earlier| earlier.attempt) + 1;
        let has_continued = self.figure("frames_before").as_u64().is_some_and(|frames| frames > 0);
        if let Some(earlier) = earlier.filter(|_| has_continued)
            && let Some(solved) = earlier.solved()
        {
            self.earlier = solved;
            self.seconds += earlier.seconds;
        }
        self
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

/// A value as text: numbers with four significant digits, nothing for null.
pub(crate) fn rounded(value: &Value) -> String {
    match value {
        Value::Null => String::new(),
        Value::String(text) => text.clone(),
        Value::Number(number) if number.is_f64() && number.as_f64() != Some(0.0) => {
            let x = number.as_f64().unwrap_or_default();
            let digits = (3.0 - x.abs().log10().floor()).clamp(0.0, 12.0) as usize;
            let text = format!("{x:.digits$}");
            match text.contains('.') {
                true => text.trim_end_matches('0').trim_end_matches('.').to_owned(),
                false => text,
            }
        }
        other => other.to_string(),
    }
}

fn failed_check(check: &Value) -> String {
    let figure = match (&check["figure"], &check["frame"]) {
        (Value::Null, _) => String::new(),
        (figure, frame) => format!(" with {} at frame {frame}", rounded(figure)),
    };
    format!("check {} failed{figure}", check["check"].as_str().unwrap_or_default())
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    /// A process that continued a run of `before` frames and solved `frames` in `seconds`.
    fn process(outcome: RunOutcome, before: u64, frames: u64, seconds: f64) -> RunResult {
        let summary = json!({ "frames": before + frames, "frames_before": before, "seconds": seconds });
        let report = Some(json!({ "summary": summary }));
        let (earlier, machine) = (SolvedFrames::default(), String::new());
        RunResult {
            outcome,
            error: None,
            seconds: seconds + 1.0,
            earlier,
            at_once: 1,
            machine,
            attempt: 0,
            report,
        }
    }

    #[test]
    fn a_resumed_run_has_the_time_of_all_its_processes() {
        let first = process(RunOutcome::Interrupted, 0, 10, 4.0);
        let second = process(RunOutcome::Interrupted, 10, 5, 2.0).after(Some(&first));
        let last = process(RunOutcome::Success, 15, 5, 4.0).after(Some(&second));
        assert_eq!(last.solved(), Some(SolvedFrames { frames: 20, seconds: 10.0 }));
        assert_eq!((last.solved().unwrap().milliseconds(), last.seconds), (Some(500.0), 13.0));
        let read: RunResult = serde_json::from_value(json!(last)).unwrap();
        assert_eq!(read, last);
    }

    #[test]
    fn the_figure_of_a_failed_check_has_four_digits() {
        let check = json!({ "check": "maxStretch(0.02)", "passed": false, "figure": 0.075_400_000_000_000_01, "frame": 5 });
        let report = Some(json!({ "summary": { "checks": [check] } }));
        let failed = RunResult { report, ..process(RunOutcome::Problem, 0, 9, 1.0) };
        assert_eq!(failed.problems(), ["check maxStretch(0.02) failed with 0.0754 at frame 5"]);
    }

    #[test]
    fn frames_of_a_killed_process_are_part_of_the_run_and_have_no_time() {
        let killed = RunResult { report: None, ..process(RunOutcome::Killed, 0, 0, 0.0) };
        let last = process(RunOutcome::Success, 15, 5, 4.0).after(Some(&killed));
        assert_eq!((last.figure("frames"), last.solved().unwrap().frames), (&json!(20), 5));
        let anew = process(RunOutcome::Success, 0, 20, 4.0).after(Some(&process(
            RunOutcome::Interrupted,
            0,
            9,
            3.0,
        )));
        assert_eq!(anew.solved(), Some(SolvedFrames { frames: 20, seconds: 4.0 }), "it started again");
    }
}
