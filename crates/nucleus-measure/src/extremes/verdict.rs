//! How a row is judged: every figure against its bound.

use std::collections::HashMap;
use std::io;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, OnceLock, PoisonError, mpsc};

use nucleus_core::InvalidInput;
use nucleus_graph::scene::Severity;

use super::case::Case;
use super::course::Course;
use super::row::{Cost, Demand, Extreme, Recovery, Trial};

/// An extreme may cost this many times what the ordinary scene costs.
pub const MOST_COST: f64 = 3.0;

/// Energy is told to this share: the bound is exact, the sum over a frame's steps is not quite.
const ENERGY: f64 = 1.01;

/// How long a run may take.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Patience {
    /// To its end; one that is too dear is given up after 20 s of the processor.
    Long,
    /// 2 s of the processor, after which it is judged by what it has shown.
    Short,
}

impl Patience {
    fn seconds(self) -> f64 {
        match self {
            Self::Long => 20.0,
            Self::Short => 2.0,
        }
    }
}

/// How often a run that is a little too dear is run again.
const RERUNS: usize = 3;

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
pub struct Figure {
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
pub struct Outcome {
    /// The row.
    pub extreme: Extreme,
    /// All figures, in the order of the table's columns.
    pub figures: Vec<Figure>,
    /// What was said about the scene, and counted by the solver.
    pub reported: Vec<String>,
}

/// Nominal runs, each made once.
#[derive(Debug, Default)]
pub struct Nominals(Mutex<HashMap<String, Arc<OnceLock<Course>>>>);

impl Figure {
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

impl Outcome {
    /// Whether everything holds.
    pub fn holds(&self) -> bool {
        self.figures.iter().all(Figure::holds)
    }

    /// Whether everything holds but what it costs, which is a matter of the machine too.
    pub fn holds_at_any_cost(&self) -> bool {
        self.figures.iter().filter(|figure| figure.kind != Kind::Cost).all(Figure::holds)
    }

    /// The figure of a column, if the row has it.
    pub fn figure(&self, kind: Kind) -> Option<&Figure> {
        self.figures.iter().find(|figure| figure.kind == kind)
    }

    /// The figures that do not hold.
    pub fn failures(&self) -> impl Iterator<Item = &Figure> {
        self.figures.iter().filter(|figure| !figure.holds())
    }
}

/// Puts an extreme to the test.
///
/// # Errors
/// When a mesh cannot be written to a folder of its own.
pub fn judge(extreme: &Extreme, nominals: &Nominals, patience: Patience) -> io::Result<Outcome> {
    let mut outcome = Outcome { extreme: *extreme, figures: Vec::new(), reported: Vec::new() };
    // A solver that panics has failed its row, not the table.
    let judged = catch_unwind(AssertUnwindSafe(|| match &extreme.trial {
        Trial::InvalidInput { case, names } => outcome.refused(&case(), names),
        Trial::Runs { .. } => outcome.runs(nominals, patience),
    }));
    match judged {
        Ok(result) => result?,
        Err(_) => outcome.figures.push(Figure::at_most(Kind::Runs, "panics", 1.0, 0.0)),
    }
    Ok(outcome)
}

/// Puts all these to the test, on so many threads, and tells each outcome in the order of the rows.
///
/// # Errors
/// When a mesh cannot be written to a folder of its own, or `tell` fails.
pub fn judge_all<E: From<io::Error>>(
    rows: &[&Extreme],
    threads: usize,
    patience: Patience,
    tell: &mut dyn FnMut(Outcome) -> Result<(), E>,
) -> Result<(), E> {
    let nominals = Nominals::default();
    let next = AtomicUsize::new(0);
    let (done, outcomes) = mpsc::channel();
    std::thread::scope(|scope| {
        for _ in 0..threads.clamp(1, rows.len().max(1)) {
            let done = done.clone();
            scope.spawn(|| {
                let done = done;
                while let Some(row) = rows.get(next.fetch_add(1, Ordering::Relaxed)) {
                    if done.send((row.name, judge(row, &nominals, patience))).is_err() {
                        return; // nobody wants to know any more
                    }
                }
            });
        }
        drop(done);
        let mut waiting = HashMap::new();
        for row in rows {
            let outcome = loop {
                if let Some(outcome) = waiting.remove(row.name) {
                    break outcome;
                }
                let Ok((name, outcome)) = outcomes.recv() else { return Ok(()) };
                waiting.insert(name, outcome);
            };
            tell(outcome?)?;
        }
        Ok(())
    })
}

impl Outcome {
    /// A scene that cannot run says so, and names what is wrong.
    fn refused(&mut self, case: &Case, names: &[&str]) -> io::Result<()> {
        let compiled = case.compile()?;
        self.reported = compiled.words(Severity::Error);
        // Folders of this run mean nothing to anyone.
        self.reported.iter_mut().for_each(|said| *said = without_folder(said));
        let said = self.reported.join("\n");
        let missing = names.iter().filter(|name| !said.contains(**name)).count();
        let runs = usize::from(compiled.program.is_some());
        self.figures.push(Figure::at_most(Kind::Runs, "runs after all", runs as f64, 0.0));
        self.figures.push(Figure::at_most(Kind::Words, "not named in the error", missing as f64, 0.0));
        Ok(())
    }

    fn runs(&mut self, nominals: &Nominals, patience: Patience) -> io::Result<()> {
        let Trial::Runs { case, nominal, cost, stored, recovery, demands, warns } = self.extreme.trial else {
            return Ok(());
        };
        let case = case();
        let compiled = case.compile()?;
        self.reported = compiled.words(Severity::Warning);
        let Some(program) = &compiled.program else {
            self.reported.extend(compiled.words(Severity::Error));
            self.figures.push(Figure::at_most(Kind::Runs, "does not run", 1.0, 0.0));
            return Ok(());
        };
        let nominal = nominals.of(&nominal())?;
        let is_cheap = |course: &Course| cost.of(course) / cost.of(&nominal) <= MOST_COST;
        let should_continue = |course: &Course| {
            course.seconds < patience.seconds() || (patience == Patience::Long && is_cheap(course))
        };
        let run = || Course::of::<f32>(program, case.tamper, stored, &should_continue);
        let mut course = run();
        // A busy machine makes a run dear, though never cheap: what is a little too dear is run again.
        let by_far = cost.of(&course) / cost.of(&nominal) > 2.0 * MOST_COST;
        for _ in 0..RERUNS {
            if by_far || is_cheap(&course) || patience == Patience::Short {
                break;
            }
            course.seconds = course.seconds.min(run().seconds);
        }
        self.basics(&course);
        // What has to hold in the end says nothing of a run that has not got there.
        if course.given_up.is_none() {
            self.recovers(&course, recovery);
            self.demands(&course, &nominal, demands);
        }
        self.costs(&course, &nominal, cost);
        self.warns(warns);
        self.counts(&course);
        if let Some(frame) = course.given_up {
            self.reported.push(format!("given up after frame {frame}"));
        }
        Ok(())
    }

    fn basics(&mut self, course: &Course) {
        let bad = course.frames.iter().filter(|seen| !seen.report.finite).count();
        self.figures.push(Figure::at_most(Kind::Runs, "frames not finite", bad as f64, 0.0));
        let energy = course.most(|seen| seen.energy.share);
        self.figures.push(Figure::at_most(Kind::Energy, "energy over what was brought in", energy, ENERGY));
    }

    fn recovers(&mut self, course: &Course, recovery: Option<Recovery>) {
        let Some(Recovery { from, speed, strain }) = recovery else { return };
        let fastest = course.most_from(from, |seen| seen.energy.speed);
        let longest = course.most_from(from, |seen| seen.report.strain_99);
        self.figures.push(Figure::at_most(
            Kind::Speed,
            format!("speed from frame {from} on (m/s)"),
            fastest,
            speed,
        ));
        self.figures.push(Figure::at_most(
            Kind::Strain,
            format!("99 % strain from frame {from} on"),
            longest,
            strain,
        ));
    }

    fn demands(&mut self, course: &Course, nominal: &Course, demands: &[Demand]) {
        for &Demand { what, figure, side, limit } in demands {
            let value = figure(course, nominal);
            self.figures.push(Figure { kind: Kind::Own, what: what.to_owned(), value, side, limit });
        }
    }

    fn costs(&mut self, course: &Course, nominal: &Course, cost: Cost) {
        let ratio = cost.of(course) / cost.of(nominal);
        self.figures.push(Figure::at_most(
            Kind::Cost,
            format!("cost per {} over nominal", cost.per()),
            ratio,
            MOST_COST,
        ));
    }

    /// Everything that has to be said is said, and nothing else.
    fn warns(&mut self, warns: &[&str]) {
        let said = &self.reported;
        let missing =
            warns.iter().filter(|warning| !said.iter().any(|said| said.contains(**warning))).count();
        let expected = |said: &&String| warns.iter().any(|warning| said.contains(warning));
        let idle = said.iter().filter(|said| !expected(said)).count();
        self.figures.push(Figure::at_most(
            Kind::Words,
            "warnings missing or idle",
            (missing + idle) as f64,
            0.0,
        ));
    }

    /// What the solver counted, in words.
    fn counts(&mut self, course: &Course) {
        let counts = [
            (course.sum(|seen| seen.report.sanitized.count), "inputs refused"),
            (course.sum(|seen| seen.report.pairs_reverted), "pairs reverted"),
            (course.sum(|seen| seen.report.pairs_unresolved), "pairs unresolved"),
        ];
        let words = counts.iter().filter(|(count, _)| *count > 0);
        self.reported.extend(words.map(|(count, what)| format!("{count} {what}")));
        let first = course.frames.iter().find_map(|seen| Some((seen.frame, seen.report.sanitized.first?)));
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

impl Nominals {
    /// The run of an ordinary scene: the cheaper of two.
    fn of(&self, case: &Case) -> io::Result<Course> {
        let mut runs = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let slot = Arc::clone(runs.entry(case.text()).or_default());
        drop(runs);
        let compiled = case.compile()?;
        let course = slot.get_or_init(|| match &compiled.program {
            None => Course::default(),
            Some(program) => {
                let run = || Course::of::<f32>(program, None, 0.0, &|_| true);
                let mut course = run();
                course.seconds = course.seconds.min(run().seconds);
                course
            }
        });
        Ok(course.clone())
    }
}
