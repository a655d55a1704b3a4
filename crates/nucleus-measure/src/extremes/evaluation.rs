//! How a row is judged: every figure against its bound.

use std::collections::HashMap;
use std::io;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, OnceLock, PoisonError, mpsc};

use nucleus_core::InvalidInput;
use nucleus_graph::scene::Severity;

use super::row::{Assertion, CostUnit, Expectation, Recovery, Side, StressCase};
use super::scene::TestScene;
use super::timeline::Timeline;

/// An extreme may cost this many times what the ordinary scene costs.
pub const MOST_COST: f64 = 3.0;

/// Energy is told to this share: the bound is exact, the sum over a frame's steps is not quite.
const ENERGY: f64 = 1.01;

/// How long a run may take.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TimeBudget {
    /// To its end; one that is too dear is given up after 20 s of the processor.
    Long,
    /// 2 s of the processor, after which it is judged by what it has shown.
    Short,
}

impl TimeBudget {
    fn seconds(self) -> f64 {
        match self {
            Self::Long => 20.0,
            Self::Short => 2.0,
        }
    }
}

/// How often a run that is a little too dear is run again.
const RERUNS: usize = 3;

/// What a figure is about: the columns of the table.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// Whether it runs at all, and stays finite.
    Runs,
    /// Energy of motion over what was brought in.
    Energy,
    /// Speed after the cause has ended, in m/s.
    Speed,
    /// 99 % strain after the cause has ended.
    Strain,
    /// Cost over nominal.
    Cost,
    /// What was said, or was not.
    Words,
    /// What only this row is about.
    Own,
}

/// A figure and its bound.
#[derive(Debug, Clone, PartialEq)]
pub struct Measurement {
    /// What it is about.
    pub kind: Kind,
    /// What is measured, with its unit.
    pub what: String,
    /// What was found.
    pub value: f64,
    /// On which side of the limit it has to stay.
    pub side: Side,
    /// The limit.
    pub limit: f64,
}

/// What came of a row.
#[derive(Debug, Clone)]
pub struct Evaluation {
    /// The row.
    pub stress_case: StressCase,
    /// All figures, in the order of the table's columns.
    pub figures: Vec<Measurement>,
    /// What was said about the scene, and counted by the solver.
    pub reported: Vec<String>,
}

/// Nominal runs, each made once.
#[derive(Debug, Default)]
pub struct Baselines(Mutex<HashMap<String, Arc<OnceLock<Timeline>>>>);

impl Measurement {
    fn at_most(kind: Kind, what: impl Into<String>, value: f64, limit: f64) -> Self {
        Self { kind, what: what.into(), value, side: Side::AtMost, limit }
    }

    /// Whether it is on the right side of its limit. NaN never is.
    pub fn holds(&self) -> bool {
        match self.side {
            Side::AtMost => self.value <= self.limit,
            Side::AtLeast => self.value >= self.limit,
        }
    }
}

impl Evaluation {
    /// Whether everything holds.
    pub fn holds(&self) -> bool {
        self.figures.iter().all(Measurement::holds)
    }

    /// Whether everything holds but what it costs, which is a matter of the machine too.
    pub fn holds_at_any_cost(&self) -> bool {
        self.figures.iter().filter(|figure| figure.kind != Kind::Cost).all(Measurement::holds)
    }

    /// The figure of a column, if the row has it.
    pub fn figure(&self, kind: Kind) -> Option<&Measurement> {
        self.figures.iter().find(|figure| figure.kind == kind)
    }

    /// The figures that do not hold.
    pub fn failures(&self) -> impl Iterator<Item = &Measurement> {
        self.figures.iter().filter(|figure| !figure.holds())
    }
}

/// Puts an extreme to the test.
///
/// # Errors
/// When a mesh cannot be written to a folder of its own.
pub fn evaluate(
    stress_case: &StressCase,
    baselines: &Baselines,
    budget: TimeBudget,
) -> io::Result<Evaluation> {
    let mut evaluation = Evaluation { stress_case: *stress_case, figures: Vec::new(), reported: Vec::new() };
    // A solver that panics has failed its row, not the table.
    let result = catch_unwind(AssertUnwindSafe(|| match &stress_case.expectation {
        Expectation::InvalidInput { scene, names } => evaluation.refused(&scene(), names),
        Expectation::Runs { .. } => evaluation.runs(baselines, budget),
    }));
    match result {
        Ok(result) => result?,
        Err(_) => evaluation.figures.push(Measurement::at_most(Kind::Runs, "panics", 1.0, 0.0)),
    }
    Ok(evaluation)
}

/// Puts all these to the test, on so many threads, and tells each outcome in the order of the rows.
///
/// # Errors
/// When a mesh cannot be written to a folder of its own, or `tell` fails.
pub fn evaluate_all<E: From<io::Error>>(
    rows: &[&StressCase],
    threads: usize,
    budget: TimeBudget,
    tell: &mut dyn FnMut(Evaluation) -> Result<(), E>,
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
                        return; // nobody wants to know any more
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
            tell(evaluation?)?;
        }
        Ok(())
    })
}

impl Evaluation {
    /// A scene that cannot run says so, and names what is wrong.
    fn refused(&mut self, scene: &TestScene, names: &[&str]) -> io::Result<()> {
        let compiled = scene.compile()?;
        self.reported = compiled.words(Severity::Error);
        // Folders of this run mean nothing to anyone.
        self.reported.iter_mut().for_each(|said| *said = without_folder(said));
        let said = self.reported.join("\n");
        let missing = names.iter().filter(|name| !said.contains(**name)).count();
        let runs = usize::from(compiled.program.is_some());
        self.figures.push(Measurement::at_most(Kind::Runs, "runs after all", runs as f64, 0.0));
        self.figures.push(Measurement::at_most(Kind::Words, "not named in the error", missing as f64, 0.0));
        Ok(())
    }

    fn runs(&mut self, baselines: &Baselines, budget: TimeBudget) -> io::Result<()> {
        let Expectation::Runs { scene, baseline, cost, initial_energy, recovery, assertions, warnings } =
            self.stress_case.expectation
        else {
            return Ok(());
        };
        let scene = scene();
        let compiled = scene.compile()?;
        self.reported = compiled.words(Severity::Warning);
        let Some(program) = &compiled.program else {
            self.reported.extend(compiled.words(Severity::Error));
            self.figures.push(Measurement::at_most(Kind::Runs, "does not run", 1.0, 0.0));
            return Ok(());
        };
        let baseline = baselines.of(&baseline())?;
        let is_cheap = |timeline: &Timeline| cost.of(timeline) / cost.of(&baseline) <= MOST_COST;
        let should_continue = |timeline: &Timeline| {
            timeline.seconds < budget.seconds() || (budget == TimeBudget::Long && is_cheap(timeline))
        };
        let run = || Timeline::of::<f32>(program, scene.inject, initial_energy, &should_continue);
        let mut timeline = run();
        // A busy machine makes a run dear, though never cheap: what is a little too dear is run again.
        let by_far = cost.of(&timeline) / cost.of(&baseline) > 2.0 * MOST_COST;
        for _ in 0..RERUNS {
            if by_far || is_cheap(&timeline) || budget == TimeBudget::Short {
                break;
            }
            timeline.seconds = timeline.seconds.min(run().seconds);
        }
        self.basics(&timeline);
        // What has to hold in the end says nothing of a run that has not got there.
        if timeline.aborted_after.is_none() {
            self.recovers(&timeline, recovery);
            self.assertions(&timeline, &baseline, assertions);
        }
        self.costs(&timeline, &baseline, cost);
        self.warnings(warnings);
        self.counts(&timeline);
        if let Some(frame) = timeline.aborted_after {
            self.reported.push(format!("given up after frame {frame}"));
        }
        Ok(())
    }

    fn basics(&mut self, timeline: &Timeline) {
        let bad = timeline.frames.iter().filter(|record| !record.report.finite).count();
        self.figures.push(Measurement::at_most(Kind::Runs, "frames not finite", bad as f64, 0.0));
        let energy = timeline.most(|record| record.energy.share);
        self.figures.push(Measurement::at_most(
            Kind::Energy,
            "energy over what was brought in",
            energy,
            ENERGY,
        ));
    }

    fn recovers(&mut self, timeline: &Timeline, recovery: Option<Recovery>) {
        let Some(Recovery { from, speed, strain }) = recovery else { return };
        let fastest = timeline.most_from(from, |record| record.energy.speed);
        let longest = timeline.most_from(from, |record| record.report.strain_99);
        self.figures.push(Measurement::at_most(
            Kind::Speed,
            format!("speed from frame {from} on (m/s)"),
            fastest,
            speed,
        ));
        self.figures.push(Measurement::at_most(
            Kind::Strain,
            format!("99 % strain from frame {from} on"),
            longest,
            strain,
        ));
    }

    fn assertions(&mut self, timeline: &Timeline, baseline: &Timeline, assertions: &[Assertion]) {
        for &Assertion { what, figure, side, limit } in assertions {
            let value = figure(timeline, baseline);
            self.figures.push(Measurement { kind: Kind::Own, what: what.to_owned(), value, side, limit });
        }
    }

    fn costs(&mut self, timeline: &Timeline, baseline: &Timeline, cost: CostUnit) {
        let ratio = cost.of(timeline) / cost.of(baseline);
        self.figures.push(Measurement::at_most(
            Kind::Cost,
            format!("cost per {} over nominal", cost.per()),
            ratio,
            MOST_COST,
        ));
    }

    /// Everything that has to be said is said, and nothing else.
    fn warnings(&mut self, warnings: &[&str]) {
        let said = &self.reported;
        let missing =
            warnings.iter().filter(|warning| !said.iter().any(|said| said.contains(**warning))).count();
        let expected = |said: &&String| warnings.iter().any(|warning| said.contains(warning));
        let idle = said.iter().filter(|said| !expected(said)).count();
        self.figures.push(Measurement::at_most(
            Kind::Words,
            "warnings missing or idle",
            (missing + idle) as f64,
            0.0,
        ));
    }

    /// What the solver counted, in words.
    fn counts(&mut self, timeline: &Timeline) {
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
            self.reported.push(format!("frame {frame}: {}", named(what)));
        }
    }
}

/// A message without the folder that its files were in.
fn without_folder(said: &str) -> String {
    let folder = |word: &str| match word.rfind(['/', '\\']) {
        Some(end) if word.starts_with('`') => format!("`{}", &word[end + 1..]),
        _ => word.to_owned(),
    };
    said.split(' ').map(folder).collect::<Vec<_>>().join(" ")
}

/// What was refused, in words.
fn named(what: InvalidInput) -> String {
    match what {
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
    /// The run of an ordinary scene: the cheaper of two.
    fn of(&self, scene: &TestScene) -> io::Result<Timeline> {
        let mut runs = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let slot = Arc::clone(runs.entry(scene.text()).or_default());
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
