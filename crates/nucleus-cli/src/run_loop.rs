//! A run from its current frame to its last: simulate, record, evaluate the checks, report, close the cache.

use std::ops::ControlFlow;
use std::path::PathBuf;
use std::time::{Duration, Instant};

use anyhow::{Context, Result};
use nucleus_cache::{RecordError, Recorder};
use nucleus_core::{Real, Stage, StateView, StepObserver, SubstepIndex};
use nucleus_graph::audit::Closeness;
use nucleus_graph::checks::{Check, Judge};
use nucleus_graph::scene::TimeSpan;
use nucleus_graph::{FrameReport, Simulation, flat_cloths};
use serde_json::{Value, json};

use crate::process::Outcome;
use crate::progress::RunProgress;
use crate::run_statistics::{Ending, FrameStatistics, RunStatistics, Stopped};
use crate::summary::Summary;
use crate::{output, process};

/// A run that is set up: the rest of a simulation, its checks and its audit.
pub struct RunLoop<R: Real> {
    pub simulation: Simulation<R>,
    judge: Judge,
    /// The statistics of the frames so far.
    statistics: RunStatistics,
    /// Whether findings of the audit are part of the outcome.
    is_audited: bool,
}

/// The cache that a run writes.
pub struct Recording {
    /// `None` if the run is not recorded.
    pub recorder: Option<Recorder>,
    /// The file of the cache.
    pub out: PathBuf,
    /// Whether the cache replaces another run's; an interrupted run must not.
    pub replaces: bool,
}

impl<R: Real> RunLoop<R> {
    /// A run from the current frame of a simulation to the last frame of its program. With `is_audited` every time step is
    /// audited, else every frame if a check needs it.
    pub fn new(mut simulation: Simulation<R>, is_audited: bool) -> Self {
        let program = simulation.program();
        let judge = Judge::new(program.checks(), program.mass());
        if is_audited {
            simulation.begin_audit(Closeness::Steps);
        } else if program.checks().iter().any(Check::needs_audit) {
            simulation.begin_audit(Closeness::Frames);
        }
        Self { simulation, judge, statistics: RunStatistics::default(), is_audited }
    }

    /// Adds a frame before the current one, as a cache holds it.
    pub fn add_recorded(&mut self, figures: &FrameStatistics) {
        self.judge.see(&figures.report());
        self.statistics.add_recorded(figures);
    }

    /// The first frame so far with a position or velocity that is not finite.
    pub fn not_finite(&self) -> Option<i32> {
        self.statistics.not_finite
    }

    /// Runs to the last frame. With `json` each frame is reported as JSON.
    ///
    /// # Errors
    /// If the run ended with an error of which `is_refusal` is true.
    pub fn finish(
        self,
        recording: Recording,
        json: bool,
        is_refusal: impl Fn(&anyhow::Error) -> bool,
    ) -> Result<Finished> {
        let Self { mut simulation, mut judge, statistics, is_audited } = self;
        let Recording { mut recorder, out, replaces } = recording;
        let TimeSpan { start, end, .. } = simulation.program().time();
        let frames = u32::try_from(end - simulation.frame()).unwrap_or_default();
        let mut progress = RunProgress::new(frames, end);
        let mut report = |figures: &FrameStatistics, statistics: &RunStatistics| {
            progress.show(figures.frame, statistics);
            if json {
                report_frame(figures, statistics);
            }
        };
        let (statistics, mut ending) =
            simulate(&mut simulation, &mut recorder, &mut judge, statistics, &mut report)?;
        progress.end();
        let is_kept = replaces && matches!(ending, Ending::Interrupted | Ending::Stopped(_)) && out.exists();
        let unfinished = Some(nucleus_cache::part_path(&out)).filter(|part| is_kept && part.exists());
        let recorded = close(&simulation, recorder, is_kept, &mut ending).map(|bytes| (out, bytes));
        process::files_are_closed();
        match ending {
            Ending::Lost(error) if is_refusal(&error) => return Err(error),
            _ => {}
        }
        let last = simulation.frame();
        let audit = simulation.audit().filter(|_| is_audited);
        let (checks, frames, objects) = (judge.outcomes(), (start, last), simulation.objects());
        let hash = combined_hash(&simulation);
        let flat = flat_cloths(&simulation);
        let fields = simulation.program().field_names().collect();
        let summary = Summary {
            hash,
            statistics,
            ending,
            checks,
            audit,
            recorded,
            unfinished,
            frames,
            objects,
            fields,
            flat,
        };
        let (outcome, text, report) = (summary.outcome(), summary.as_text()?, summary.as_json());
        Ok(Finished { outcome, text, warnings: summary.warnings(), report })
    }
}

/// A run that has ended, with its summary.
pub struct Finished {
    pub outcome: Outcome,
    pub text: String,
    /// Those of its lines that warn of the result.
    pub warnings: Vec<String>,
    pub report: Value,
}

impl Finished {
    /// Prints the summary and returns the outcome.
    pub fn print(self, json: bool) -> Outcome {
        match json {
            true => output::report_json(&self.report),
            false if output::is_quiet() && self.outcome == Outcome::Success => {
                self.warnings.iter().for_each(|line| output::report_always(&format!("{line}\n")));
            }
            false => output::report_always(&self.text),
        }
        self.outcome
    }
}

/// The state hashes of all nuclei in hexadecimal: the same for the same bits.
fn combined_hash<R: Real>(simulation: &Simulation<R>) -> String {
    let hashes: Vec<String> =
        simulation.solvers().map(|solver| format!("{:016x}", solver.state_hash())).collect();
    hashes.join("-")
}

/// Advances to the last frame. `report` receives the figures of each frame and the statistics so far.
fn simulate<R: Real>(
    simulation: &mut Simulation<R>,
    recorder: &mut Option<Recorder>,
    judge: &mut Judge,
    mut statistics: RunStatistics,
    report: &mut dyn FnMut(&FrameStatistics, &RunStatistics),
) -> Result<(RunStatistics, Ending)> {
    let mut previous = PreviousState::default();
    while !simulation.is_done() {
        if process::is_interrupted() {
            return Ok((statistics, Ending::Interrupted));
        }
        if recorder.as_ref().is_some_and(Recorder::records_checkpoints) {
            previous.save(simulation, statistics.last_frame_time);
        }
        let begin = Instant::now();
        let frame = i32::try_from(simulation.next_frame())
            .context("the next frame number exceeds the largest, 2147483647")?;
        let figures = match advance(simulation, frame, recorder, judge) {
            Ok(Some(figures)) => figures,
            Ok(None) => {
                let is_clean = recorder.as_mut().is_none_or(Recorder::discard_frame);
                let stopped = Stopped { state: previous.state, is_clean };
                return Ok((statistics, Ending::Stopped(stopped)));
            }
            Err(error) => return Ok((statistics, Ending::Lost(error.into()))),
        };
        statistics.add(&figures, begin.elapsed());
        report(&figures, &statistics);
        if !figures.finite {
            return Ok((statistics, Ending::NotFinite));
        }
    }
    Ok((statistics, Ending::Done))
}

/// A checkpoint of the last complete frame, for a run that is stopped within the next one.
#[derive(Debug, Default)]
struct PreviousState {
    state: Option<Vec<u8>>,
    /// Time that the last save took.
    cost: Duration,
}

impl PreviousState {
    /// A frame shorter than this many saves is cheaper to solve again than to save.
    const MIN_FRAME_PER_SAVE: u32 = 50;

    fn save<R: Real>(&mut self, simulation: &Simulation<R>, last_frame_time: Duration) {
        self.state = None;
        if last_frame_time >= self.cost * Self::MIN_FRAME_PER_SAVE {
            let begin = Instant::now();
            self.state = Some(simulation.save());
            self.cost = begin.elapsed();
        }
    }
}

/// Simulates and records one frame. Returns `None` if it was stopped.
fn advance<R: Real>(
    simulation: &mut Simulation<R>,
    frame: i32,
    recorder: &mut Option<Recorder>,
    judge: &mut Judge,
) -> Result<Option<FrameStatistics>, RecordError> {
    let evaluate = |report: FrameReport, judge: &mut Judge| {
        judge.see(&report);
        FrameStatistics::of(&report, frame)
    };
    let Some(recorder) = recorder else {
        let report = simulation.advance(&mut StopOnSignal(&mut ()));
        return Ok((!report.report.stopped).then(|| evaluate(report, judge)));
    };
    let report = simulation.advance(&mut StopOnSignal(&mut recorder.frame(frame)?));
    if report.report.stopped {
        return Ok(None);
    }
    let figures = evaluate(report, judge);
    recorder.end_frame(&figures)?;
    if figures.finite && recorder.checkpoint_due() {
        recorder.record_checkpoint(&simulation.save())?;
    }
    Ok(Some(figures))
}

/// An observer that stops the frame when a signal has arrived.
struct StopOnSignal<'a>(&'a mut dyn StepObserver);

impl StepObserver for StopOnSignal<'_> {
    fn substep(&mut self, moment: SubstepIndex, state: &dyn StateView) {
        self.0.substep(moment, state);
    }

    fn step(&mut self, share: f64, state: &dyn StateView) {
        self.0.step(share, state);
    }

    fn observes_substeps(&self) -> bool {
        self.0.observes_substeps()
    }

    fn should_continue(&self) -> ControlFlow<()> {
        if process::is_interrupted() { ControlFlow::Break(()) } else { self.0.should_continue() }
    }

    fn enter(&mut self, stage: Stage) {
        self.0.enter(stage);
    }
}

/// Closes the cache with a checkpoint of its last frame. Returns its size in bytes, or `None` if it stays unfinished, as
/// with `stays_part`.
fn close<R: Real>(
    simulation: &Simulation<R>,
    recorder: Option<Recorder>,
    stays_part: bool,
    ending: &mut Ending,
) -> Option<u64> {
    let can_finish = |ending: &Ending| match ending {
        Ending::Lost(_) => false,
        Ending::Stopped(stopped) => stopped.is_clean,
        _ => true,
    };
    let mut recorder = recorder.filter(|_| can_finish(ending))?;
    let state = match ending {
        // No run can resume from a state that is not finite.
        Ending::NotFinite => None,
        // The simulation is at the dropped frame, so the state of the previous one is written.
        Ending::Stopped(stopped) => stopped.state.take(),
        _ => recorder.final_checkpoint_due().then(|| simulation.save()),
    };
    let state = state.filter(|_| recorder.final_checkpoint_due());
    let last = state.map_or(Ok(()), |state| recorder.record_checkpoint(&state));
    let finished = last.and_then(|()| if stays_part { Ok(None) } else { recorder.finish().map(Some) });
    match finished {
        Ok(recorded) => recorded.map(|recorded| recorded.bytes),
        Err(error) => {
            *ending = Ending::Lost(error.into());
            None
        }
    }
}

fn report_frame(figures: &FrameStatistics, statistics: &RunStatistics) {
    let mut line = json!(figures);
    line["milliseconds"] = json!(statistics.last_frame_time.as_secs_f64() * 1e3);
    output::report_json(&line);
}
