//! What a run has come to, for people and for machines.

use std::fmt::Write;
use std::path::PathBuf;

use nucleus_core::InvalidInput;
use nucleus_graph::audit::Audit;
use nucleus_graph::checks::{self, Bound};
use nucleus_graph::compile::{Object, ObjectKind};
use serde_json::{Value, json};

use crate::account::{Account, Count};
use crate::figures;
use crate::outcome::Outcome;
use crate::simulate::Ending;
use crate::trouble;

/// A run that has ended.
pub struct Summary<'a> {
    pub account: Account,
    pub ending: Ending,
    pub checks: &'a [checks::Outcome],
    /// The audit, if one was asked for.
    pub audit: Option<&'a Audit>,
    /// The cache and its size in bytes, if one was written to its end.
    pub recorded: Option<(PathBuf, u64)>,
    /// The start frame and the last one reached.
    pub frames: (i64, i64),
    /// The objects of the run.
    pub objects: &'a [Object],
}

impl Summary<'_> {
    /// What the command is to end with.
    pub fn outcome(&self) -> Outcome {
        match self.ending {
            Ending::Interrupted | Ending::Stopped(_) => Outcome::Interrupted,
            Ending::Done if self.is_clean() => Outcome::Fine,
            _ => Outcome::Trouble,
        }
    }

    fn is_clean(&self) -> bool {
        self.audit.is_none_or(|audit| audit.account().is_clean())
            && self.checks.iter().all(|check| check.passed)
            && self.unseparated().is_empty()
    }

    fn unseparated(&self) -> Vec<String> {
        trouble::unseparated(&self.account, self.checks, self.audit.is_some())
    }

    fn warning(&self) -> Option<String> {
        trouble::stretched(&self.account, self.checks)
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
        if let Some((what, frame)) = account.first_refused {
            let (what, count) =
                (refused(what, self.objects), figures::count(account.refused as usize, "value"));
            writeln!(text, "frame {frame}: {what} ({count} in all)")?;
        }
        for outcome in self.checks {
            writeln!(text, "{}", check_line(outcome))?;
        }
        self.audit.into_iter().for_each(|audit| text += &audit_lines(audit));
        let tolerated = trouble::tolerated(account, self.checks);
        for line in tolerated.into_iter().chain(self.unseparated()).chain(self.warning()) {
            writeln!(text, "{line}")?;
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
            Ending::Stopped(stopped) if !stopped.is_clean => format!(
                "interrupted within the frame after frame {last}, of which substeps are recorded: the cache stays a \
                 `.part`, and `nucleus resume` goes on with it\n"
            ),
            Ending::Stopped(_) => {
                format!("interrupted after frame {last}; the frame that was in flight is dropped\n")
            }
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
            Ending::Interrupted | Ending::Stopped(_) => ("interrupted", None),
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
            "pairs_unresolved": account.pairs_unresolved.total,
            "most_unresolved": most(&account.pairs_unresolved),
            "trapped": lasting(&account.trapped),
            "tangled": lasting(&account.tangled),
            "not_separated": self.unseparated(),
            "warning": self.warning(),
            "refused": account.refused,
            "first_refused": account.first_refused.map(|(what, _)| refused(what, self.objects)),
            "checks": checks,
            "audit": self.audit.map(audit_json),
            "cache": path,
            "bytes": bytes,
        }})
    }
}

/// The worst frame of a count; nothing if it never was more than zero.
fn most(count: &Count) -> Option<Value> {
    (count.most > 0).then(|| json!({ "value": count.most, "frame": count.frame }))
}

fn lasting(count: &Count) -> Value {
    let frame = (count.most > 0).then_some(count.frame);
    json!({ "most": count.most, "frame": frame, "end": count.end })
}

/// `point 17 of `ball` was no usable position, and was held where it was`.
fn refused(what: InvalidInput, objects: &[Object]) -> String {
    let name = |kind: ObjectKind| {
        objects.iter().find(|object| object.kind == kind).map_or("an object", |object| object.name.as_str())
    };
    let (cloth, collider) = (ObjectKind::Cloth, ObjectKind::Collider);
    match what {
        InvalidInput::ColliderPoint(id, point) => {
            let (ball, point) = (name(collider(id)), point.0);
            format!("point {point} of `{ball}` was no usable position, and was held where it was")
        }
        InvalidInput::ColliderMotion(id) => {
            format!("`{}` was given the wrong number of points, and stood still", name(collider(id)))
        }
        InvalidInput::Pin(id, point) => {
            format!("point {} of `{}` was held nowhere, and stayed where it was", point.0, name(cloth(id)))
        }
        InvalidInput::Cloth(id) => format!("an attribute of `{}` was no usable number", name(cloth(id))),
        InvalidInput::Collider(id) => {
            format!("an attribute of `{}` was no usable number", name(collider(id)))
        }
        InvalidInput::Duration => "it had no length, and was passed over".to_owned(),
        _ => "a setting of the solver was no usable number".to_owned(),
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

/// Findings that are told one by one; the rest is counted.
const TOLD: usize = 5;

/// What an audit has come to, and the first that it found.
fn audit_lines(audit: &Audit) -> String {
    let account = audit.account();
    let motions = figures::count(account.motions as usize, "step");
    let mut text = match account.is_clean() {
        true => format!("audit of {motions}: nothing passed through anything\n"),
        false => {
            let kinds = [
                (account.crossings, "passed through each other"),
                (account.intersections, "were found inside each other"),
                (account.touches, "touched"),
                (account.undecided, "could not be told apart"),
            ];
            let said = kinds.iter().filter(|(count, _)| *count > 0);
            let mut said: Vec<_> = said
                .map(|(count, what)| format!("{} {what}", figures::count(*count as usize, "pair")))
                .collect();
            if account.below_ground > 0 {
                let points = figures::count(account.below_ground as usize, "point");
                said.push(format!("{points} went through the ground plane"));
            }
            format!("audit of {motions}: {}\n", said.join(", "))
        }
    };
    if account.initial_intersections > 0 {
        let (start, now) = (account.initial_intersections, account.remaining_initial_intersections);
        let start = figures::count(start as usize, "pair");
        text += &format!("audit: {start} of edge and face began inside each other, {now} still are\n");
    }
    audit.findings().take(TOLD).for_each(|finding| text += &format!("  {finding}\n"));
    let rest = account.found().saturating_sub(TOLD as u64);
    if rest > 0 { text + &format!("  and {rest} more\n") } else { text }
}

fn audit_json(audit: &Audit) -> Value {
    let account = audit.account();
    json!({
        "steps": account.motions,
        "crossings": account.crossings,
        "overlaps": account.intersections,
        "touches": account.touches,
        "undecided": account.undecided,
        "below_ground": account.below_ground,
        "tangled_at_start": account.initial_intersections,
        "tangled": account.remaining_initial_intersections,
        "inside": account.current_intersections,
        "first": audit.findings().next(),
    })
}

#[cfg(test)]
mod tests {
    use nucleus_core::{ClothId, ColliderId, Faces, PointId};

    use super::*;

    #[test]
    fn what_was_refused_is_named_as_the_scene_names_it() {
        let object = |name: &str, kind| Object {
            name: name.to_owned(),
            kind,
            points: 3,
            faces: Faces::default(),
            radius: None,
        };
        let objects = [
            object("silk", ObjectKind::Cloth(ClothId(0))),
            object("ball", ObjectKind::Collider(ColliderId(0))),
        ];
        let said = refused(InvalidInput::ColliderPoint(ColliderId(0), PointId(17)), &objects);
        assert_eq!(said, "point 17 of `ball` was no usable position, and was held where it was");
        assert!(refused(InvalidInput::Cloth(ClothId(0)), &objects).contains("`silk`"));
    }
}
