//! Evaluation of a row: every figure against its bound.

use std::collections::HashMap;
use std::io;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, OnceLock, PoisonError, mpsc};

use nucleus_core::InvalidInput;
use nucleus_graph::checks::Check;
use nucleus_graph::scene::Severity;
use serde::{Deserialize, Serialize};

use super::row::{Assertion, CostUnit, Expectation, Recovery, Runs, Side, StressCase};
use super::scene::TestScene;
use super::timeline::Timeline;

/// Largest cost relative to the baseline.
pub const MAX_COST: f64 = 3.0;

/// Largest ratio of kinetic to supplied energy. The bound is exact; its sum over the steps of a frame is not.
const MAX_ENERGY: f64 = 1.01;

/// How long a run may take.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TimeBudget {
    /// To its end, except that a run above the cost limit is aborted after 20 s of processor time.
    Long,
    /// At most 1 s of processor time.
    Short,
    /// To its end. Cost is not measured, because other runs share the machine.
    Untimed,
}

impl TimeBudget {
    fn seconds(self) -> f64 {
        match self {
            Self::Long => 20.0,
            Self::Short => 1.0,
            Self::Untimed => f64::INFINITY,
        }
    }
}

/// Repetitions of a run that is slightly above the cost limit.
const RERUNS: usize = 3;

/// Subject of a measurement: the columns of the table.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Kind {
    /// Whether it runs and stays finite.
    Runs,
    /// Ratio of kinetic to supplied energy.
    Energy,
    /// Speed after the disturbance, in m/s.
    Speed,
    /// 99th percentile of strain after the disturbance.
    Strain,
    /// Cost over the baseline.
    Cost,
    /// Diagnostics.
    Words,
    /// Specific to the row.
    Own,
}

/// A figure and its bound.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Measurement {
    /// Its subject.
    pub kind: Kind,
    /// The figure, with its unit.
    pub what: String,
    /// Its value.
    #[serde(with = "crate::bits")]
    pub value: f64,
    /// Side of the limit.
    pub side: Side,
    /// The limit.
    #[serde(with = "crate::bits")]
    pub limit: f64,
}

/// Result of a row.
#[derive(Debug, Clone)]
pub struct Evaluation {
    /// The row.
    pub stress_case: StressCase,
    /// All figures, in the order of the table's columns.
    pub figures: Vec<Measurement>,
    /// Bounds on the motion after the disturbance, from the checks of the scene.
    pub recovery: Option<Recovery>,
    /// Diagnostics of the scene, and counters of the solver.
    pub reported: Vec<String>,
}

/// What a row has found, as another process reports it: an [`Evaluation`] without its row.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Findings {
    /// See [`Evaluation`] for this field and the following ones.
    pub figures: Vec<Measurement>,
    /// Bounds on the motion after the disturbance.
    pub recovery: Option<Recovery>,
    /// Diagnostics and counters.
    pub reported: Vec<String>,
}

/// Baseline runs, each executed once.
#[derive(Debug, Default)]
pub struct Baselines(Mutex<HashMap<String, Arc<OnceLock<Timeline>>>>);

impl Measurement {
    fn at_most(kind: Kind, what: impl Into<String>, value: f64, limit: f64) -> Self {
        Self { kind, what: what.into(), value, side: Side::AtMost, limit }
    }

    /// Whether the value is within its limit. NaN never is.
    pub fn holds(&self) -> bool {
        match self.side {
            Side::AtMost => self.value <= self.limit,
            Side::AtLeast => self.value >= self.limit,
        }
    }
}

impl Evaluation {
    /// The evaluation of a row from what another process has found.
    pub fn of(stress_case: &StressCase, found: Findings) -> Self {
        let Findings { figures, recovery, reported } = found;
        Self { stress_case: *stress_case, figures, recovery, reported }
    }

    /// What the row has found.
    pub fn findings(self) -> Findings {
        let Self { figures, recovery, reported, .. } = self;
        Findings { figures, recovery, reported }
    }

    /// Whether all figures are within their limits.
    pub fn holds(&self) -> bool {
        self.figures.iter().all(Measurement::holds)
    }

    /// The same without the cost, which depends on the machine.
    pub fn holds_at_any_cost(&self) -> bool {
        self.figures.iter().filter(|figure| figure.kind != Kind::Cost).all(Measurement::holds)
    }

    /// Whether the row ran without its cost being measured.
    pub fn is_untimed(&self) -> bool {
        self.figure(Kind::Energy).is_some() && self.figure(Kind::Cost).is_none()
    }

    /// The first figure of a kind, if the row has one.
    pub fn figure(&self, kind: Kind) -> Option<&Measurement> {
        self.figures.iter().find(|figure| figure.kind == kind)
    }

    /// The figures outside their limits.
    pub fn failures(&self) -> impl Iterator<Item = &Measurement> {
        self.figures.iter().filter(|figure| !figure.holds())
    }
}

/// Runs and evaluates a row.
///
/// # Errors
/// When a mesh cannot be written to a temporary folder.
pub fn evaluate(
    stress_case: &StressCase,
    baselines: &Baselines,
    budget: TimeBudget,
) -> io::Result<Evaluation> {
    let mut evaluation =
        Evaluation { stress_case: *stress_case, figures: Vec::new(), recovery: None, reported: Vec::new() };
    // A panic of the solver fails its row, not the table.
    let result = catch_unwind(AssertUnwindSafe(|| match &stress_case.expectation {
        Expectation::Rejected { scene, message } => evaluation.rejects(&scene(), message),
        Expectation::Runs(runs) => evaluation.runs(runs, baselines, budget),
    }));
    match result {
        Ok(result) => result?,
        Err(_) => evaluation.figures.push(Measurement::at_most(Kind::Runs, "panics", 1.0, 0.0)),
    }
    Ok(evaluation)
}

/// Evaluates rows on some threads and passes the results to `report` in the order of the rows.
///
/// # Errors
/// When a mesh cannot be written to a temporary folder, or `report` fails.
pub fn evaluate_all<E: From<io::Error>>(
    rows: &[&StressCase],
    threads: usize,
    budget: TimeBudget,
    report: &mut dyn FnMut(Evaluation) -> Result<(), E>,
) -> Result<(), E> {
    let baselines = Baselines::default();
    let next = AtomicUsize::new(0);
    let (done, evaluations) = mpsc::channel();
    std::thread::scope(|scope| {
        for _ in 0..threads.clamp(1, rows.len().max(1)) {
            let done = done.clone();
            scope.spawn(|| {
                let done = done;
                while let Some(row) = rows.get(next.fetch_add(1, Ordering::Relaxed)) {
                    if done.send((row.name, evaluate(row, &baselines, budget))).is_err() {
                        return; // the receiver stopped after an error
                    }
                }
            });
        }
        drop(done);
        let mut waiting = HashMap::new();
        for row in rows {
            let evaluation = loop {
                if let Some(evaluation) = waiting.remove(row.name) {
                    break evaluation;
                }
                let Ok((name, evaluation)) = evaluations.recv() else { return Ok(()) };
                waiting.insert(name, evaluation);
            };
            report(evaluation?)?;
        }
        Ok(())
    })
}

impl Evaluation {
    fn rejects(&mut self, scene: &TestScene, message: &str) -> io::Result<()> {
        let compiled = scene.compile()?;
        self.reported = compiled.messages(Severity::Error);
        // The temporary folder of the scene is meaningless to readers.
        self.reported.iter_mut().for_each(|message| *message = without_folder(message));
        let messages = self.reported.join("\n");
        let missing = message.split("; ").filter(|part| !messages.contains(part)).count();
        let runs = usize::from(compiled.program.is_some());
        self.figures.push(Measurement::at_most(Kind::Runs, "runs after all", runs as f64, 0.0));
        self.figures.push(Measurement::at_most(Kind::Words, "not named in the error", missing as f64, 0.0));
        Ok(())
    }

    fn runs(&mut self, runs: &Runs, baselines: &Baselines, budget: TimeBudget) -> io::Result<()> {
        let scene = (runs.scene)();
        let compiled = scene.compile()?;
        self.recovery = runs.recovery.or_else(|| recovery(&compiled.checks));
        self.reported = compiled.messages(Severity::Warning);
        let Some(program) = &compiled.program else {
            self.reported.extend(compiled.messages(Severity::Error));
            self.figures.push(Measurement::at_most(Kind::Runs, "does not run", 1.0, 0.0));
            return Ok(());
        };
        let baseline = baselines.of(&(runs.baseline)())?;
        let cost = |timeline: &Timeline| runs.cost.of(timeline) / runs.cost.of(&baseline);
        let is_cheap = |timeline: &Timeline| cost(timeline) <= MAX_COST;
        let should_continue = |timeline: &Timeline| {
            timeline.seconds < budget.seconds() || (budget == TimeBudget::Long && is_cheap(timeline))
        };
        let run = || Timeline::of::<f32>(program, scene.inject, runs.initial_energy, &should_continue);
        let mut timeline = run();
        // A loaded machine only makes a run slower, so the fastest of several runs slightly above the limit counts.
        let is_far_above = cost(&timeline) > 2.0 * MAX_COST;
        for _ in 0..RERUNS {
            if is_far_above || is_cheap(&timeline) || budget != TimeBudget::Long {
                break;
            }
            timeline.seconds = timeline.seconds.min(run().seconds);
        }
        self.basics(&timeline);
        // Bounds on the end of a run say nothing about an aborted run.
        if timeline.aborted_after.is_none() {
            self.checks(&timeline, &compiled.checks);
            self.assertions(&timeline, &baseline, runs.assertions);
        }
        if budget != TimeBudget::Untimed {
            self.cost(cost(&timeline), runs.cost);
        }
        self.warnings(runs.warnings);
        self.counters(&timeline);
        if let Some(frame) = timeline.aborted_after {
            self.reported.push(format!("aborted after frame {frame}"));
        }
        Ok(())
    }

    fn basics(&mut self, timeline: &Timeline) {
        let bad = timeline.frames.iter().filter(|record| !record.report.finite).count();
        self.figures.push(Measurement::at_most(Kind::Runs, "frames not finite", bad as f64, 0.0));
        let energy = timeline.max(|record| record.energy.ratio);
        let what = "kinetic energy over supplied energy";
        self.figures.push(Measurement::at_most(Kind::Energy, what, energy, MAX_ENERGY));
    }

    /// The checks of the scene; [`Self::basics`] covers `finite`.
    fn checks(&mut self, timeline: &Timeline, checks: &[Check]) {
        if let Some(Recovery { from, speed, strain }) = self.recovery {
            let fastest = timeline.max_from(from, |record| record.energy.speed);
            let what = format!("speed from frame {from} on (m/s)");
            self.figures.push(Measurement::at_most(Kind::Speed, what, fastest, speed));
            let longest = timeline.max_from(from, |record| record.report.strain_99);
            let what = format!("99 % strain from frame {from} on");
            self.figures.push(Measurement::at_most(Kind::Strain, what, longest, strain));
        }
        for check in checks {
            let (what, value) = match check.form().name {
                "finite" | "atRestBy" | "settledStretch99" => continue,
                "noPenetration" => {
                    let pairs = timeline.sum(|record| record.report.pairs_unresolved);
                    ("pairs unresolved".to_owned(), pairs as f64)
                }
                "maxStretch99" => {
                    ("99 % strain at any time".to_owned(), timeline.max(|record| record.report.strain_99))
                }
                _ => (format!("`{check}` is not evaluated here"), f64::NAN),
            };
            self.figures.push(Measurement::at_most(Kind::Own, what, value, check.limit().1));
        }
    }

    fn assertions(&mut self, timeline: &Timeline, baseline: &Timeline, assertions: &[Assertion]) {
        for &Assertion { what, figure, side, limit } in assertions {
            let value = figure(timeline, baseline);
            self.figures.push(Measurement { kind: Kind::Own, what: what.to_owned(), value, side, limit });
        }
    }

    fn cost(&mut self, ratio: f64, unit: CostUnit) {
        let what = format!("cost per {} over baseline", unit.name());
        self.figures.push(Measurement::at_most(Kind::Cost, what, ratio, MAX_COST));
    }

    /// Every expected warning appears, and no other.
    fn warnings(&mut self, expected: &[&str]) {
        let reported = &self.reported;
        let missing = expected.iter().filter(|part| !reported.iter().any(|text| text.contains(**part)));
        let is_expected = |text: &&String| expected.iter().any(|part| text.contains(part));
        let unexpected = reported.iter().filter(|text| !is_expected(text)).count();
        let count = (missing.count() + unexpected) as f64;
        self.figures.push(Measurement::at_most(Kind::Words, "missing or unexpected warnings", count, 0.0));
    }

    /// Counters of the solver, in words.
    fn counters(&mut self, timeline: &Timeline) {
        let counts = [
            (timeline.sum(|record| record.report.sanitized.count), "inputs refused"),
            (timeline.sum(|record| record.report.pairs_reverted), "pairs reverted"),
            (timeline.sum(|record| record.report.pairs_unresolved), "pairs unresolved"),
        ];
        let words = counts.iter().filter(|(count, _)| *count > 0);
        self.reported.extend(words.map(|(count, what)| format!("{count} {what}")));
        let first =
            timeline.frames.iter().find_map(|record| Some((record.frame, record.report.sanitized.first?)));
        if let Some((frame, what)) = first {
            self.reported.push(format!("frame {frame}: {}", input_name(what)));
        }
    }
}

/// The bounds of `atRestBy` and `settledStretch99`, which name the same frame.
fn recovery(checks: &[Check]) -> Option<Recovery> {
    let arguments = |name: &str| checks.iter().find(|check| check.form().name == name).map(Check::arguments);
    match (arguments("atRestBy")?, arguments("settledStretch99")?) {
        (&[from, speed], &[_, strain]) => Some(Recovery { from: from as i64, speed, strain }),
        _ => None,
    }
}

/// A message with file names instead of paths.
fn without_folder(message: &str) -> String {
    let file_name = |word: &str| match word.rfind(['/', '\\']) {
        Some(end) if word.starts_with('`') => format!("`{}", &word[end + 1..]),
        _ => word.to_owned(),
    };
    message.split(' ').map(file_name).collect::<Vec<_>>().join(" ")
}

/// The rejected input, in words.
fn input_name(input: InvalidInput) -> String {
    match input {
        InvalidInput::ColliderPoint(_, point) => format!("point {} of the collider", point.0),
        InvalidInput::ColliderMotion(_) => "the collider's motion".to_owned(),
        InvalidInput::Pin(_, point) => format!("the pin of point {}", point.0),
        InvalidInput::Cloth(_) => "an attribute of the cloth".to_owned(),
        InvalidInput::Collider(_) => "an attribute of the collider".to_owned(),
        InvalidInput::Duration => "the length of the frame".to_owned(),
        _ => "a setting of the solver".to_owned(),
    }
}

impl Baselines {
    /// The run of a baseline: the faster of two.
    fn of(&self, scene: &TestScene) -> io::Result<Timeline> {
        let mut runs = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let slot = Arc::clone(runs.entry(scene.text.clone()).or_default());
        drop(runs);
        let compiled = scene.compile()?;
        let timeline = slot.get_or_init(|| match &compiled.program {
            None => Timeline::default(),
            Some(program) => {
                let run = || Timeline::of::<f32>(program, None, 0.0, &|_| true);
                let mut timeline = run();
                timeline.seconds = timeline.seconds.min(run().seconds);
                timeline
            }
        });
        Ok(timeline.clone())
    }
}
