//! The summary of a run, as text and as JSON.

use std::fmt::Write;
use std::path::PathBuf;

use nucleus_cache::shell_word;
use nucleus_core::{InvalidInput, MAX_COORDINATE};
use nucleus_graph::audit::Audit;
use nucleus_graph::checks::{self, Bound};
use nucleus_graph::compile::{Object, ObjectKind};
use serde_json::{Value, json};

use crate::process::Outcome;
use crate::run_statistics::{Count, Ending, RunStatistics};
use crate::{figures, warnings};

/// A run that has ended.
pub struct Summary<'a> {
    /// State hashes of all nuclei in the last frame, in hexadecimal.
    pub hash: String,
    pub statistics: RunStatistics,
    pub ending: Ending,
    pub checks: &'a [checks::Outcome],
    /// The audit, if `--audit` requested one.
    pub audit: Option<&'a Audit>,
    /// The cache and its size in bytes, if it is complete.
    pub recorded: Option<(PathBuf, u64)>,
    /// The file of an interrupted run whose place an older cache keeps.
    pub unfinished: Option<PathBuf>,
    /// The start frame and the last simulated one.
    pub frames: (i64, i64),
    /// The objects of the run.
    pub objects: &'a [Object],
    /// The names of its fields.
    pub fields: Vec<&'a str>,
    /// Cloths that started flat, are pressed together, and are flat still.
    pub flat: Vec<String>,
}

impl Summary<'_> {
    /// The outcome of the command.
    pub fn outcome(&self) -> Outcome {
        match self.ending {
            Ending::Interrupted | Ending::Stopped(_) => Outcome::Interrupted,
            Ending::Done if self.is_clean() => Outcome::Success,
            _ => Outcome::Problem,
        }
    }

    /// Whether a check has a result: a run that ended early says nothing about later frames, and one of the start frame
    /// alone about none.
    fn is_evaluated(&self, outcome: &checks::Outcome) -> bool {
        let has_frames = self.frames.0 < self.frames.1;
        outcome.worst.is_some() || has_frames && matches!(self.ending, Ending::Done)
    }

    /// Why a check has no result; `None` if it has one.
    fn unevaluated(&self, outcome: &checks::Outcome) -> Option<&'static str> {
        match (self.is_evaluated(outcome), &self.ending) {
            (true, _) => None,
            (false, Ending::Done) => Some("the run is the start frame alone"),
            (false, _) => Some("the run ended before"),
        }
    }

    fn is_clean(&self) -> bool {
        self.audit
            .is_none_or(|audit| audit.account().is_clean() && self.statistics.passed_through_before == 0)
            && self.checks.iter().all(|check| check.passed || !self.is_evaluated(check))
            && self.unresolved_contact().is_empty()
    }

    fn sanitized(&self, input: InvalidInput) -> String {
        sanitized(input, self.objects, &self.fields)
    }

    fn unresolved_contact(&self) -> Vec<String> {
        warnings::unresolved_contact(&self.statistics, self.checks, self.audit.is_some())
    }

    /// Warnings of the result of a run that succeeded.
    pub fn warnings(&self) -> Vec<String> {
        let all = [warnings::large_strain, warnings::large_compression];
        all.into_iter().filter_map(|warning| warning(&self.statistics, self.checks)).collect()
    }

    fn hint(&self) -> Option<String> {
        warnings::flat(&self.flat)
    }

    /// The summary as text.
    pub fn as_text(&self) -> Result<String, std::fmt::Error> {
        let Self { statistics, frames: (start, last), .. } = self;
        let mut text = String::new();
        let seconds = figures::number(statistics.time.as_secs_f64());
        let each = figures::number(statistics.milliseconds());
        let timed = match statistics.frames_before {
            0 => String::new(),
            _ => format!(", {} solved now", statistics.frames),
        };
        writeln!(text, "frames {start} to {last}{timed} in {seconds} s, {each} ms/frame")?;
        if let Some((strain, frame)) = statistics.worst_strain {
            let of_99 = statistics.worst_strain_99.map_or(String::new(), |(strain, frame)| {
                format!("; p99 strain {} at frame {frame}", figures::percent(strain))
            });
            writeln!(text, "worst strain {} at frame {frame}{of_99}", figures::percent(strain))?;
        }
        if let Some((gap, frame)) = statistics.smallest_gap {
            match gap < checks::MAX_MEASURED_GAP {
                true => {
                    writeln!(text, "minimum gap {} of the thickness, at frame {frame}", figures::number(gap))?
                }
                false => writeln!(text, "minimum gap at least the thickness; larger gaps are not measured")?,
            }
        }
        if let Some((error, frame)) = statistics.volume_error() {
            writeln!(text, "worst volume error of liquids {} at frame {frame}", figures::percent(error))?;
        }
        if statistics.particles.most > 0 {
            let Count { most, frame, end, .. } = statistics.particles;
            writeln!(text, "{}, most at frame {frame}: {most}", figures::count(end as usize, "particle"))?;
        }
        if statistics.births_refused.total > 0 {
            let count = figures::count(statistics.births_refused.total as usize, "particle");
            writeln!(
                text,
                "{count} not emitted: the object was full (`maxCount`, or the room found for the scene), or 64 others \
                 touched the place"
            )?;
        }
        if statistics.births_pruned.total > 0 {
            let count = figures::count(statistics.births_pruned.total as usize, "particle");
            writeln!(
                text,
                "{count} not emitted: they would have overlapped others (`emissionOverlapPruning`)"
            )?;
        }
        if let Some((input, frame)) = statistics.first_sanitized {
            let count = figures::count(statistics.sanitized as usize, "value");
            writeln!(text, "frame {frame}: {} ({count} sanitized in all)", self.sanitized(input))?;
        }
        for outcome in self.checks {
            writeln!(text, "{}", check_line(outcome, self.unevaluated(outcome)))?;
        }
        self.audit
            .into_iter()
            .for_each(|audit| text += &audit_lines(audit, statistics.passed_through_before));
        let tolerated = warnings::tolerated(statistics, self.checks);
        for line in
            tolerated.into_iter().chain(self.unresolved_contact()).chain(self.warnings()).chain(self.hint())
        {
            writeln!(text, "{line}")?;
        }
        text += &self.ending_line();
        if let Some(part) = &self.unfinished {
            let (word, cache) = (shell_word(part), part.with_extension(""));
            let (part, cache) = (part.display(), cache.display());
            writeln!(text, "`{cache}` stays as it was; the unfinished run is `{part}`")?;
            writeln!(text, "continue it with `nucleus resume {word}`, which then replaces `{cache}`")?;
        }
        if let Some((path, bytes)) = &self.recorded {
            let (word, size) = (shell_word(path), figures::bytes(*bytes));
            writeln!(text, "recorded in `{}` ({size})", path.display())?;
            writeln!(text, "watch it with `nucleus play {word}`, draw it with `nucleus render {word}`")?;
        }
        Ok(text)
    }

    fn ending_line(&self) -> String {
        let last = self.frames.1;
        match &self.ending {
            Ending::Done => String::new(),
            Ending::Interrupted => format!("interrupted after frame {last}\n"),
            Ending::Stopped(stopped) if !stopped.is_clean => format!(
                "interrupted within the frame after frame {last}, some substeps of which are recorded: the cache stays a \
                 `.part` file, which `nucleus resume` continues\n"
            ),
            Ending::Stopped(_) => {
                format!("interrupted after frame {last}; the unfinished frame is dropped\n")
            }
            Ending::NotFinite => {
                format!("ended at frame {last}: a position or velocity is not a finite number\n")
            }
            Ending::Lost(error) => format!("ended at frame {last}: {error:#}\n"),
        }
    }

    /// The summary as JSON.
    pub fn as_json(&self) -> Value {
        let Self { statistics, frames: (start, last), .. } = self;
        let at = |figure: Option<(f64, i32)>| {
            figure.map(|(value, frame)| json!({ "value": value, "frame": frame }))
        };
        let checks: Vec<Value> = self
            .checks
            .iter()
            .map(|outcome| {
                let (figure, frame) = outcome.worst.unzip();
                let passed = self.is_evaluated(outcome).then_some(outcome.passed);
                json!({ "check": outcome.check.to_string(), "passed": passed, "figure": figure, "frame": frame })
            })
            .collect();
        let (path, bytes) =
            self.recorded.as_ref().map(|(path, bytes)| (path.display().to_string(), *bytes)).unzip();
        let (ending, error) = match &self.ending {
            Ending::Done => ("done", None),
            Ending::Interrupted | Ending::Stopped(_) => ("interrupted", None),
            Ending::NotFinite => ("not finite", None),
            Ending::Lost(error) => ("lost", Some(format!("{error:#}"))),
        };
        json!({ "summary": {
            "ending": ending,
            "error": error,
            "start": start,
            "last": last,
            "state_hash": self.hash,
            "frames": statistics.frames_before + statistics.frames,
            "frames_before": statistics.frames_before,
            "seconds": statistics.time.as_secs_f64(),
            "milliseconds_per_frame": statistics.milliseconds(),
            "worst_strain": at(statistics.worst_strain),
            "worst_strain_99": at(statistics.worst_strain_99),
            "smallest_gap": at(statistics.smallest_gap),
            "worst_volume_error": at(statistics.volume_error()),
            "pairs_unresolved": statistics.pairs_unresolved.total,
            "most_unresolved": most(&statistics.pairs_unresolved),
            "depenetrating": over_run(&statistics.depenetrating),
            "intersections": over_run(&statistics.intersections),
            "unresolved_contact": self.unresolved_contact(),
            "warning": Some(self.warnings().join("\n")).filter(|text| !text.is_empty()),
            "hint": self.hint(),
            "sanitized": statistics.sanitized,
            "first_sanitized": statistics.first_sanitized.map(|(input, _)| self.sanitized(input)),
            "checks": checks,
            "audit": self.audit.map(|audit| audit_json(audit, statistics.passed_through_before)),
            "cache": path,
            "unfinished": self.unfinished.as_ref().map(|part| part.display().to_string()),
            "bytes": bytes,
        }})
    }
}

/// The largest count and its frame; `None` if it is zero in every frame.
fn most(count: &Count) -> Option<Value> {
    (count.most > 0).then(|| json!({ "value": count.most, "frame": count.frame }))
}

/// The largest count, its frame, and the count of the last frame.
fn over_run(count: &Count) -> Value {
    let frame = (count.most > 0).then_some(count.frame);
    json!({ "most": count.most, "frame": frame, "end": count.end })
}

/// `` point 17 of `ball` had no usable position and kept its last one ``.
fn sanitized(input: InvalidInput, objects: &[Object], fields: &[&str]) -> String {
    let name = |kind: ObjectKind| {
        objects.iter().find(|object| object.kind == kind).map_or("an object", |object| object.name.as_str())
    };
    let (cloth, collider) = (ObjectKind::Cloth, ObjectKind::Collider);
    let expression = |attribute: &str, id| {
        format!(
            "`{attribute}` of `{}` gave a value that is not a finite number, as a division by zero does; the particle \
             kept its own",
            name(cloth(id))
        )
    };
    match input {
        InvalidInput::ColliderPoint(id, point) => {
            let (ball, point) = (name(collider(id)), point.0);
            format!("point {point} of `{ball}` had no usable position and kept its last one")
        }
        InvalidInput::ColliderMotion(id) => {
            format!("`{}` was given the wrong number of points and did not move", name(collider(id)))
        }
        InvalidInput::Pin(id, point) => {
            format!(
                "the constraint of point {} of `{}` had no usable position and kept its last one",
                point.0,
                name(cloth(id))
            )
        }
        InvalidInput::InputMesh(id) => {
            format!("the input mesh of `{}` had no usable positions", name(cloth(id)))
        }
        InvalidInput::CreationExpression(id) => expression("creationExpression", id),
        InvalidInput::RuntimeExpression(id) => expression("runtimeExpression", id),
        InvalidInput::Birth(id) => {
            format!("a new particle of `{}` had no usable value, and was not emitted", name(cloth(id)))
        }
        InvalidInput::ParticleChange(id) => {
            format!("a change of a particle of `{}` had no usable value, and was dropped", name(cloth(id)))
        }
        InvalidInput::Exclusion(_) => {
            "a constraint excludes the collisions of points that do not exist".to_owned()
        }
        InvalidInput::Constraint(_) => {
            "a constraint had no usable value, or a link to points that do not exist".to_owned()
        }
        InvalidInput::Cloth(id) => format!("an attribute of `{}` had no usable value", name(cloth(id))),
        InvalidInput::Collider(id) => {
            format!("an attribute of `{}` had no usable value", name(collider(id)))
        }
        InvalidInput::Field(at) => format!(
            "`{}` did not act: its `magnitude`, or another of its attributes or its place, is not finite or is beyond \
             {MAX_COORDINATE:e} in SI units",
            fields.get(at as usize).copied().unwrap_or("a field")
        ),
        InvalidInput::Duration => {
            "the duration of the frame was not above zero; the frame was skipped".to_owned()
        }
        _ => "an attribute of the nucleus had no usable value".to_owned(),
    }
}

/// `check maxStretch(0.02): failed with 0.031 at frame 48`.
fn check_line(outcome: &checks::Outcome, unevaluated: Option<&str>) -> String {
    let check = &outcome.check;
    if let Some(reason) = unevaluated {
        return format!("check {check}: not evaluated, {reason}");
    }
    let verdict = if outcome.passed { "passed" } else { "FAILED" };
    let side = match check.limit() {
        (Bound::AtMost, limit) => format!("at most {}", figures::number(limit)),
        (Bound::AtLeast, limit) => format!("at least {}", figures::number(limit)),
    };
    match outcome.worst {
        None => format!("check {check}: {verdict}, no frame was evaluated"),
        Some((figure, frame)) => {
            format!("check {check}: {verdict} with {} at frame {frame} ({side})", figures::number(figure))
        }
    }
}

/// Findings that are listed; any further ones are only counted.
const MAX_FINDINGS: usize = 5;

/// The counts of an audit, its first findings, and the number of those before a resumed run.
fn audit_lines(audit: &Audit, before: u64) -> String {
    let account = audit.account();
    let motions = figures::count(account.motions as usize, "step");
    let mut text = match account.is_clean() {
        true => format!("audit of {motions}: nothing passed through anything\n"),
        false => {
            let kinds = [
                (account.crossings, "passed through each other"),
                (account.intersections, "intersected each other"),
                (account.touches, "touched"),
                (account.undecided, "could not be decided"),
            ];
            let counted = kinds.iter().filter(|(count, _)| *count > 0);
            let mut counts: Vec<_> = counted
                .map(|(count, what)| format!("{} {what}", figures::count(*count as usize, "pair")))
                .collect();
            if account.below_ground > 0 {
                let points = figures::count(account.below_ground as usize, "point");
                counts.push(format!("{points} went through the ground plane"));
            }
            format!("audit of {motions}: {}\n", counts.join(", "))
        }
    };
    if account.initial_intersections > 0 {
        let (start, now) = (account.initial_intersections, account.remaining_initial_intersections);
        let start = figures::count(start as usize, "pair");
        text += &format!("audit: {start} of an edge and a face intersected at the start, {now} still do\n");
    }
    if before > 0 {
        let before = figures::count(before as usize, "finding");
        text += &format!("audit: {before} in the frames before the run was resumed\n");
    }
    audit.findings().take(MAX_FINDINGS).for_each(|finding| text += &format!("  {finding}\n"));
    let rest = account.found().saturating_sub(MAX_FINDINGS as u64);
    if rest > 0 { text + &format!("  and {rest} more\n") } else { text }
}

fn audit_json(audit: &Audit, before: u64) -> Value {
    let account = audit.account();
    json!({
        "steps": account.motions,
        "crossings": account.crossings,
        "intersections": account.intersections,
        "touches": account.touches,
        "undecided": account.undecided,
        "below_ground": account.below_ground,
        "before_resumption": before,
        "initial_intersections": account.initial_intersections,
        "remaining_initial_intersections": account.remaining_initial_intersections,
        "current_intersections": account.current_intersections,
        "first": audit.findings().next(),
    })
}

#[cfg(test)]
mod tests {
    use nucleus_core::{ClothId, ColliderId, Faces, PointId};

    use super::*;

    #[test]
    fn sanitized_input_is_named_by_its_object_and_point() {
        let object = |name: &str, kind| Object {
            name: name.to_owned(),
            kind,
            points: 3,
            mesh_points: 3,
            faces: Faces::default(),
            radius: None,
            surface: [0.1, 1.0],
            rest_distance: None,
            varies: false,
        };
        let objects = [
            object("silk", ObjectKind::Cloth(ClothId(0))),
            object("ball", ObjectKind::Collider(ColliderId(0))),
        ];
        let said = sanitized(InvalidInput::ColliderPoint(ColliderId(0), PointId(17)), &objects, &[]);
        assert_eq!(said, "point 17 of `ball` had no usable position and kept its last one");
        assert!(sanitized(InvalidInput::Cloth(ClothId(0)), &objects, &[]).contains("`silk`"));
        let said = sanitized(InvalidInput::RuntimeExpression(ClothId(0)), &objects, &[]);
        assert!(
            sanitized(InvalidInput::Field(1), &objects, &["gust", "push"]).starts_with("`push` did not act")
        );
        assert!(said.starts_with("`runtimeExpression` of `silk` gave a value that is not a finite number"));
    }
}
