//! A sweep: all runs of a scene in parallel, resumed where an earlier sweep ended.

use std::sync::atomic::{AtomicU64, AtomicUsize, Ordering};
use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::thread;
use std::time::Duration;

use nucleus_graph::compile::Program;
use serde::{Deserialize, Serialize};

use super::benchmark::{Benchmark, MAX_REFERENCE_UNCERTAINTY, TradeError};
use super::curve::{Choice, Trade, Wish};
use super::error::ErrorMeasure;
use super::plan::{self, SweepOptions};
use super::reference::{self, ReferenceRun, References};
use super::request::is_resolved;
use super::run::{Run, RunStates, Trajectory, key, run_setting};
use super::setting::Setting;
use crate::result_cache::ResultCache;

/// List of the finished runs of a scene.
const LIST: &str = "runs.jsonl";

/// Rounds of settings near the recommended one.
const REFINEMENTS: u32 = 3;

/// Interval between progress reports.
const PROGRESS_PERIOD: Duration = Duration::from_millis(200);

/// Progress of a sweep.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Progress {
    /// Share of the work that is done, 0 to 1, without the runs loaded from the cache.
    pub done: f64,
    /// Finished runs, and runs to do.
    pub runs: [usize; 2],
    /// Runs loaded from the cache.
    pub kept: usize,
}

/// A run that is done in another process: its setting, and its floating-point width in bits (64 for references).
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct RemoteRun {
    /// The setting.
    pub setting: Setting,
    /// 32 or 64.
    pub bits: u32,
}

/// Runs that are done in other processes at once.
pub struct RemoteStage<'a> {
    /// How often the references were made finer.
    pub finer: usize,
    /// The round of settings: 0 for the first; `None` for references.
    pub round: Option<u32>,
    /// The runs.
    pub runs: &'a [RemoteRun],
    /// The reference that they are measured against: the name of its run, and its trajectory.
    pub target: Option<(String, &'a Trajectory)>,
}

/// Does runs in other processes, and returns them in their order.
pub type Elsewhere<'a> = dyn FnMut(&RemoteStage) -> Result<Vec<(Run, RunStates)>, TradeError> + 'a;

/// Parallelism, progress and cancellation of a sweep.
pub struct SweepControl<'a> {
    /// Concurrent runs, one thread each.
    pub workers: usize,
    /// Called with the progress.
    pub progress: &'a mut dyn FnMut(&Progress),
    /// Returns false to cancel.
    pub should_continue: &'a (dyn Fn() -> bool + Sync),
    /// Does the runs in other processes; `None` does them on threads of this one.
    pub elsewhere: Option<&'a mut Elsewhere<'a>>,
}

/// Result of a sweep.
pub struct SweepResult {
    /// The work-precision curve.
    pub trade: Trade,
    /// The references; `None` if all settings are Classic.
    pub references: Option<References>,
    /// All runs.
    pub runs: Vec<Run>,
}

impl SweepResult {
    /// Distance of the run of a setting from the reference in each frame; `None` without a reference.
    pub fn divergence(&self, setting: &Setting) -> Option<Vec<f64>> {
        let run = self.runs.iter().find(|run| run.setting == *setting)?;
        run.frames.iter().map(|frame| frame.divergence.map(|[rms, _]| rms)).collect()
    }
}

/// A run that is still to do.
struct Task {
    setting: Setting,
    bits: u32,
    program: Program,
    work: f64,
}

/// Makes the references, runs all settings and builds the curve. A refined sweep ([`SweepOptions::is_refined`]) then runs
/// settings near the one that it recommends for `wish`. Loads finished runs from `cache`, and saves each new
/// one when it finishes.
///
/// # Errors
/// When the scene has nothing to compare, when results cannot be saved, and on cancellation.
pub fn run_sweep(
    benchmark: &Benchmark,
    options: &SweepOptions,
    wish: &Wish,
    cache: &ResultCache,
    mut control: SweepControl,
) -> Result<SweepResult, TradeError> {
    let settings = plan::settings(benchmark, options)?;
    let progress = Progress { done: 0.0, runs: [0, 0], kept: 0 };
    let is_refined = options.is_refined();
    let all_finer = plan::finenesses(is_refined);
    let finest = finest_stored(benchmark, &settings, all_finer, cache)?;
    let mut done = Done { progress, before: 0.0, all: 0.0, finer: finest, round: None };
    let mut finer = all_finer[finest..].iter().peekable();
    loop {
        let both = finer.next().and_then(|finer| plan::references(benchmark, &settings, *finer));
        let references = match both {
            Some(both) => Some(references(benchmark, both, cache, &mut done, &mut control)?),
            None => None,
        };
        if let Some(both) = &references {
            if finer.peek().is_some() && !resolves(benchmark, both, wish) {
                done.make_finer();
                continue;
            }
            validate_references(benchmark, both)?;
        }
        let mut runs = Vec::new();
        done.round = Some(0);
        run_settings(benchmark, &settings, references.as_ref(), cache, &mut done, &mut control, &mut runs)?;
        let mut trade = Trade::new(benchmark, &runs, references.as_ref());
        for round in 0..if is_refined { REFINEMENTS } else { 0 } {
            let mut near = plan::near(&trade, wish, round);
            done.round = Some(round + 1);
            near.retain(|setting| runs.iter().all(|run| run.setting.key() != setting.key()));
            run_settings(benchmark, &near, references.as_ref(), cache, &mut done, &mut control, &mut runs)?;
            trade = Trade::new(benchmark, &runs, references.as_ref());
        }
        let stored = with_stored(benchmark, &runs, references.as_ref(), cache)?;
        if is_refined {
            // A refined sweep has the runs near its own wish; with those of other wishes all show the same curve.
            let is_tried = |run: &&Run| settings.iter().any(|tried| tried.reading == run.setting.reading);
            runs = stored.iter().filter(is_tried).cloned().collect();
            trade = Trade::new(benchmark, &runs, references.as_ref());
        }
        // Finer references show no setting that is faster.
        let is_missed = matches!(wish, Wish::Error(_)) && !matches!(wish.choose(&trade), Choice::Found(_));
        if finer.peek().is_some() && references.is_some() && is_missed {
            done.make_finer();
            continue;
        }
        Trade::new(benchmark, &stored, references.as_ref()).save(cache)?;
        return Ok(SweepResult { trade, references, runs });
    }
}

/// The index of the finest references that an earlier sweep has made, else of the first ones. A wanted error is then
/// judged by the same references after every sweep.
fn finest_stored(
    benchmark: &Benchmark,
    settings: &[Setting],
    finenesses: &[[f64; 2]],
    cache: &ResultCache,
) -> Result<usize, TradeError> {
    for (index, finer) in finenesses.iter().enumerate().skip(1).rev() {
        let Some(both) = plan::references(benchmark, settings, *finer) else { continue };
        let [coarse, fine] = both.map(|setting| reference::load(cache, benchmark, &setting));
        if coarse?.is_some() && fine?.is_some() {
            return Ok(index);
        }
    }
    Ok(0)
}

/// Whether references resolve what is wished, over enough frames.
fn resolves(benchmark: &Benchmark, references: &References, wish: &Wish) -> bool {
    let References { coarse, fine, horizon } = references;
    let measure = ErrorMeasure::new(benchmark, coarse, fine, horizon);
    horizon.is_usable() && !wish.request().is_unresolved(&measure)
}

/// The runs of a sweep with those of earlier sweeps against the same reference: `nucleus run --quality` chooses from all.
fn with_stored(
    benchmark: &Benchmark,
    runs: &[Run],
    references: Option<&References>,
    cache: &ResultCache,
) -> Result<Vec<Run>, TradeError> {
    let (against, mut all) = (reference_key(references), runs.to_vec());
    for run in cache.list::<Run>(LIST)? {
        let is_comparable = run.against == against && run.key() == key(&run.setting, 32, benchmark.window());
        if is_comparable && all.iter().all(|other| other.key() != run.key()) {
            all.push(run);
        }
    }
    Ok(all)
}

/// The name of the reference that runs are measured against; empty without one.
fn reference_key(references: Option<&References>) -> String {
    references.map(|both| both.fine.run.key()).unwrap_or_default()
}

/// Adds the runs of settings to `runs`, loaded or done.
fn run_settings(
    benchmark: &Benchmark,
    settings: &[Setting],
    references: Option<&References>,
    cache: &ResultCache,
    done: &mut Done,
    control: &mut SweepControl,
    runs: &mut Vec<Run>,
) -> Result<(), TradeError> {
    let known: Vec<Run> = cache.list(LIST)?;
    // A stored run holds its distances from the reference of its sweep, which may have been another.
    let against = reference_key(references);
    let window = benchmark.window();
    let mut tasks = Vec::new();
    for setting in settings {
        let is_same = |run: &&Run| run.key() == key(setting, 32, window) && run.against == against;
        match known.iter().find(is_same) {
            Some(run) => runs.push(run.clone()),
            None => tasks.push(task(benchmark, setting, 32)?),
        }
    }
    done.progress.kept += settings.len() - tasks.len();
    done.progress.runs[1] += tasks.len();
    done.all += tasks.iter().map(|task| task.work).sum::<f64>();
    let target = references.map(|both| (against.clone(), &both.fine.trajectory));
    work_through(benchmark, tasks, target, done, control, &mut |run, kept| {
        let run = Run { against: against.clone(), ..run };
        reference::save_end(cache, &run.key(), &kept.end)?;
        cache.append(LIST, &run)?;
        runs.push(run);
        Ok(())
    })
}

impl RemoteRun {
    /// Does the run. Returns `None` if `should_continue` returns false.
    pub fn run(
        &self,
        benchmark: &Benchmark,
        program: &Program,
        target: Option<&Trajectory>,
        should_continue: &dyn Fn() -> bool,
    ) -> Option<(Run, RunStates)> {
        match self.bits {
            64 => run_setting::<f64>(benchmark, &self.setting, program, target, should_continue),
            _ => run_setting::<f32>(benchmark, &self.setting, program, target, should_continue),
        }
    }
}

/// Last frame of a run of a sweep: all objects in the order of the program, in scene units.
///
/// # Errors
/// When the file exists and cannot be read.
pub fn end(
    cache: &ResultCache,
    benchmark: &Benchmark,
    setting: &Setting,
) -> Result<Option<Vec<Vec<[f32; 3]>>>, TradeError> {
    Ok(reference::load_end(cache, &key(setting, 32, benchmark.window()))?)
}

/// Two references, loaded or computed.
fn references(
    benchmark: &Benchmark,
    both: [Setting; 2],
    cache: &ResultCache,
    done: &mut Done,
    control: &mut SweepControl,
) -> Result<References, TradeError> {
    let mut solved = Vec::new();
    let mut tasks = Vec::new();
    for setting in &both {
        match reference::load(cache, benchmark, setting)? {
            Some(kept) => solved.push(kept),
            None => tasks.push(task(benchmark, setting, 64)?),
        }
    }
    done.all += tasks.iter().map(|task| task.work).sum::<f64>();
    done.progress.runs[1] += tasks.len();
    done.progress.kept += solved.len();
    work_through(benchmark, tasks, None, done, control, &mut |run, kept| {
        let made = ReferenceRun::of(run, kept);
        made.save(cache)?;
        solved.push(made);
        Ok(())
    })?;
    solved.sort_by(|a, b| a.run.setting.evaluations.total_cmp(&b.run.setting.evaluations));
    let [coarse, fine] = <[ReferenceRun; 2]>::try_from(solved).map_err(|_| TradeError::Interrupted)?;
    Ok(References::new(coarse, fine, benchmark.size))
}

/// Rejects references that diverge, do not move, or do not converge.
fn validate_references(benchmark: &Benchmark, references: &References) -> Result<(), TradeError> {
    let [start, end] = benchmark.span();
    for solved in [&references.coarse, &references.fine] {
        if !solved.run.is_finite() {
            return Err(TradeError::ReferenceLost { frame: start + solved.run.frames.len() as i64 + 1 });
        }
    }
    let trajectory = &references.fine.trajectory;
    let (mut first, mut now) = (Vec::new(), Vec::new());
    trajectory.frame(0, &mut first);
    let moves = (1..trajectory.frames()).any(|frame| {
        trajectory.frame(frame, &mut now);
        crate::metrics::deformation::distance(&now, &first, benchmark.size).max > 1e-7
    });
    if !moves {
        return Err(TradeError::NothingMoves { start, end });
    }
    let measure = ErrorMeasure::new(benchmark, &references.coarse, &references.fine, &references.horizon);
    let uncertainty = measure.essential_floor().unwrap_or(0.0);
    match is_resolved(uncertainty, MAX_REFERENCE_UNCERTAINTY) {
        true => Ok(()),
        false => {
            let evaluations =
                [&references.coarse, &references.fine].map(|solved| solved.run.setting.evaluations);
            Err(TradeError::ReferenceDoesNotConverge { evaluations, uncertainty })
        }
    }
}

fn task(benchmark: &Benchmark, setting: &Setting, bits: u32) -> Result<Task, TradeError> {
    let work = plan::work(benchmark, setting, bits)?;
    Ok(Task { setting: *setting, bits, program: benchmark.at(setting)?, work })
}

/// Work done, over several rounds.
struct Done {
    progress: Progress,
    /// Work of earlier rounds.
    before: f64,
    all: f64,
    /// The stage, as in [`RemoteStage`].
    finer: usize,
    round: Option<u32>,
}

impl Done {
    /// Goes on with finer references.
    fn make_finer(&mut self) {
        (self.finer, self.round) = (self.finer + 1, None);
    }
}

/// Runs tasks in parallel, the longest first, and passes each result to `keep`.
fn work_through(
    benchmark: &Benchmark,
    mut tasks: Vec<Task>,
    target: Option<(String, &Trajectory)>,
    done: &mut Done,
    control: &mut SweepControl,
    keep: &mut dyn FnMut(Run, RunStates) -> Result<(), TradeError>,
) -> Result<(), TradeError> {
    tasks.sort_by(|a, b| b.work.total_cmp(&a.work));
    if let Some(elsewhere) = control.elsewhere.as_deref_mut().filter(|_| !tasks.is_empty()) {
        let asked = tasks.iter().map(|task| RemoteRun { setting: task.setting, bits: task.bits });
        let runs: Vec<RemoteRun> = asked.collect();
        let done = elsewhere(&RemoteStage { finer: done.finer, round: done.round, runs: &runs, target })?;
        return done.into_iter().try_for_each(|(run, kept)| keep(run, kept));
    }
    let target = target.map(|(_, trajectory)| trajectory);
    let (next, milli) = (AtomicUsize::new(0), AtomicU64::new(0));
    let (sender, receiver) = channel();
    let workers = control.workers.clamp(1, tasks.len().max(1));
    let should_continue = control.should_continue;
    thread::scope(|scope| {
        for _ in 0..workers {
            let sender = sender.clone();
            scope.spawn(|| worker(benchmark, &tasks, target, &next, &milli, should_continue, sender));
        }
        drop(sender);
        loop {
            let finished = receiver.recv_timeout(PROGRESS_PERIOD);
            match finished {
                Ok((run, kept)) => {
                    done.progress.runs[0] += 1;
                    keep(run, kept).inspect_err(|_| next.store(tasks.len(), Ordering::Relaxed))?;
                }
                Err(RecvTimeoutError::Timeout) => {}
                Err(RecvTimeoutError::Disconnected) => break,
            }
            let share = (done.before + milli.load(Ordering::Relaxed) as f64 / 1e3) / done.all.max(1.0);
            done.progress.done = share.min(1.0);
            (control.progress)(&done.progress);
        }
        Ok::<(), TradeError>(())
    })?;
    done.before += tasks.iter().map(|task| task.work).sum::<f64>();
    if should_continue() { Ok(()) } else { Err(TradeError::Interrupted) }
}

/// Runs tasks until none is left or the sweep is cancelled.
fn worker(
    benchmark: &Benchmark,
    tasks: &[Task],
    target: Option<&Trajectory>,
    next: &AtomicUsize,
    milli: &AtomicU64,
    should_continue: &(dyn Fn() -> bool + Sync),
    sender: Sender<(Run, RunStates)>,
) {
    while let Some(task) = tasks.get(next.fetch_add(1, Ordering::Relaxed)) {
        let frames = benchmark.skipped() + benchmark.frames();
        let each = (1e3 * task.work / frames.max(1) as f64) as u64;
        let pulse = || {
            milli.fetch_add(each, Ordering::Relaxed);
            should_continue()
        };
        let one = RemoteRun { setting: task.setting, bits: task.bits };
        let finished = one.run(benchmark, &task.program, target, &pulse);
        // The receiver is gone if results cannot be saved.
        let Some(finished) = finished else { return };
        if sender.send(finished).is_err() {
            return;
        }
    }
}
