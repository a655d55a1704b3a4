//! What a run has come to, for people and for machines.

use std::fmt::Write;
use std::path::PathBuf;

use nucleus_graph::checks::{self, Bound};
use serde_json::{Value, json};

use crate::account::Account;
use crate::figures;
use crate::outcome::Outcome;
use crate::simulate::Ending;

/// A run that has ended.
pub struct Summary<'a> {
    pub account: Account,
    pub ending: Ending,
    pub checks: &'a [checks::Outcome],
    /// The cache and its size in bytes, if one was written to its end.
    pub recorded: Option<(PathBuf, u64)>,
    /// The start frame and the last one reached.
    pub frames: (i64, i64),
}

impl Summary<'_> {
    /// What the command is to end with.
    pub fn outcome(&self) -> Outcome {
        match self.ending {
            Ending::Interrupted => Outcome::Interrupted,
            Ending::Done if self.checks.iter().all(|check| check.passed) => Outcome::Fine,
            _ => Outcome::Trouble,
        }
    }

    /// For people.
    pub fn as_text(&self) -> Result<String, std::fmt::Error> {
        let Self { account, frames: (start, last), .. } = self;
        let mut text = String::new();
        let seconds = figures::number(account.spent.as_secs_f64());
        let each = figures::number(account.milliseconds());
        writeln!(text, "frames {start} to {last} in {seconds} s, {each} ms/frame")?;
        if let Some((strain, frame)) = account.worst_strain {
            writeln!(text, "worst strain {} at frame {frame}", figures::percent(strain))?;
        }
        if let Some((gap, frame)) = account.smallest_gap {
            writeln!(text, "smallest gap {} of the thickness, at frame {frame}", figures::number(gap))?;
        }
        if account.crossed > 0 {
            let points = figures::count(account.crossed as usize, "point");
            writeln!(text, "{points} ended on the far side of a collider")?;
        }
        for outcome in self.checks {
            writeln!(text, "{}", check_line(outcome))?;
        }
        text += &self.ending_line();
        if let Some((path, bytes)) = &self.recorded {
            let (path, size) = (path.display(), figures::bytes(*bytes));
            writeln!(text, "recorded in `{path}` ({size})")?;
            writeln!(text, "`nucleus play {path}` shows it, `nucleus render {path}` draws it")?;
        }
        Ok(text)
    }

    fn ending_line(&self) -> String {
        let last = self.frames.1;
        match &self.ending {
            Ending::Done => String::new(),
            Ending::Interrupted => format!("interrupted after frame {last}\n"),
            Ending::NotFinite => {
                format!("ended at frame {last}: a position or velocity is not a finite number\n")
            }
            Ending::Lost(error) => format!("ended at frame {last}: {error:#}\n"),
        }
    }

    /// For machines.
    pub fn as_json(&self) -> Value {
        let Self { account, frames: (start, last), .. } = self;
        let at = |figure: Option<(f64, i32)>| {
            figure.map(|(value, frame)| json!({ "value": value, "frame": frame }))
        };
        let checks: Vec<Value> = self
            .checks
            .iter()
            .map(|outcome| {
                let (figure, frame) = outcome.worst.unzip();
                json!({ "check": outcome.check.to_string(), "passed": outcome.passed, "figure": figure, "frame": frame })
            })
            .collect();
        let (path, bytes) =
            self.recorded.as_ref().map(|(path, bytes)| (path.display().to_string(), *bytes)).unzip();
        let (ending, trouble) = match &self.ending {
            Ending::Done => ("done", None),
            Ending::Interrupted => ("interrupted", None),
            Ending::NotFinite => ("not finite", None),
            Ending::Lost(error) => ("lost", Some(format!("{error:#}"))),
        };
        json!({ "summary": {
            "ending": ending,
            "trouble": trouble,
            "start": start,
            "last": last,
            "frames": account.frames,
            "seconds": account.spent.as_secs_f64(),
            "milliseconds_per_frame": account.milliseconds(),
            "worst_strain": at(account.worst_strain),
            "smallest_gap": at(account.smallest_gap),
            "crossed": account.crossed,
            "checks": checks,
            "cache": path,
            "bytes": bytes,
        }})
    }
}

/// `check maxStretch(0.02): failed with 0.031 at frame 48`.
fn check_line(outcome: &checks::Outcome) -> String {
    let check = &outcome.check;
    let verdict = if outcome.passed { "passed" } else { "FAILED" };
    let side = match check.limit() {
        (Bound::AtMost, limit) => format!("at most {}", figures::number(limit)),
        (Bound::AtLeast, limit) => format!("at least {}", figures::number(limit)),
    };
    match outcome.worst {
        None => format!("check {check}: {verdict}, no frame was looked at"),
        Some((figure, frame)) => {
            format!("check {check}: {verdict} with {} at frame {frame} ({side})", figures::number(figure))
        }
    }
}
