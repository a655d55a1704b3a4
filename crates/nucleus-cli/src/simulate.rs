//! The loop over the frames of a run: simulate, record, judge, tell.

use std::ops::ControlFlow;
use std::time::{Duration, Instant};

use anyhow::{Context, Result};
use nucleus_cache::{RecordError, Recorder};
use nucleus_core::{Stage, StateView, StepObserver, SubstepIndex};
use nucleus_graph::checks::Judge;
use nucleus_graph::{FrameReport, Simulation};

use crate::account::{Account, FrameFigures};
use crate::interrupt;

/// Why the loop has ended.
#[derive(Debug)]
pub enum Ending {
    /// All frames are done.
    Done,
    /// It was asked to, between two frames.
    Interrupted,
    /// It was asked to within a frame, which is dropped.
    Stopped(Stopped),
    /// What comes after a number that is not finite means nothing.
    NotFinite,
    /// The cache could not be written.
    Lost(anyhow::Error),
}

/// A run that was ended within a frame.
#[derive(Debug)]
pub struct Stopped {
    /// The state at the end of the frame before, to go on from, if it was kept.
    pub state: Option<Vec<u8>>,
    /// Whether the cache holds nothing of the frame that was dropped.
    pub is_clean: bool,
}

/// The state at the end of the last frame, kept for when the next is stopped within.
#[derive(Debug, Default)]
struct Kept {
    state: Option<Vec<u8>>,
    /// What it takes to keep it.
    cost: Duration,
}

impl Kept {
    /// Frames that take less than so many times what keeping takes are rather solved again.
    const WORTH: u32 = 50;

    fn keep(&mut self, simulation: &Simulation, frame: Duration) {
        self.state = None;
        if frame >= self.cost * Self::WORTH {
            let begin = Instant::now();
            self.state = Some(simulation.save());
            self.cost = begin.elapsed();
        }
    }
}

/// Advances to the last frame, from where `account` stands. `tell` is shown each frame with the account so far.
pub fn simulate(
    simulation: &mut Simulation,
    recorder: &mut Option<Recorder>,
    judge: &mut Judge,
    mut account: Account,
    tell: &mut dyn FnMut(&FrameFigures, &Account),
) -> Result<(Account, Ending)> {
    let mut kept = Kept::default();
    while !simulation.is_done() {
        if interrupt::asked() {
            return Ok((account, Ending::Interrupted));
        }
        if recorder.as_ref().is_some_and(Recorder::records_checkpoints) {
            kept.keep(simulation, account.last);
        }
        let begin = Instant::now();
        let frame = i32::try_from(simulation.next_frame()).context("there are too many frames")?;
        let figures = match advance(simulation, frame, recorder, judge) {
            Ok(Some(figures)) => figures,
            Ok(None) => {
                let is_clean = recorder.as_mut().is_none_or(Recorder::discard_frame);
                let stopped = Stopped { state: kept.state, is_clean };
                return Ok((account, Ending::Stopped(stopped)));
            }
            Err(error) => return Ok((account, Ending::Lost(error.into()))),
        };
        account.add(&figures, begin.elapsed());
        tell(&figures, &account);
        if !figures.finite {
            return Ok((account, Ending::NotFinite));
        }
    }
    Ok((account, Ending::Done))
}

/// One frame; nothing if it was stopped.
fn advance(
    simulation: &mut Simulation,
    frame: i32,
    recorder: &mut Option<Recorder>,
    judge: &mut Judge,
) -> Result<Option<FrameFigures>, RecordError> {
    let look = |seen: FrameReport, judge: &mut Judge| {
        judge.see(&seen);
        FrameFigures::new(frame, &seen.report)
    };
    let Some(recorder) = recorder else {
        let seen = simulation.advance(&mut UntilAsked(&mut ()));
        return Ok((!seen.report.stopped).then(|| look(seen, judge)));
    };
    let seen = simulation.advance(&mut UntilAsked(&mut recorder.frame(frame)?));
    if seen.report.stopped {
        return Ok(None);
    }
    let figures = look(seen, judge);
    recorder.end_frame(&figures)?;
    if figures.finite && recorder.checkpoint_due() {
        recorder.record_checkpoint(&simulation.save())?;
    }
    Ok(Some(figures))
}

/// Stops a frame once the run has been asked to end.
struct UntilAsked<'a>(&'a mut dyn StepObserver);

impl StepObserver for UntilAsked<'_> {
    fn substep(&mut self, moment: SubstepIndex, state: &dyn StateView) {
        self.0.substep(moment, state);
    }

    fn step(&mut self, share: f64, state: &dyn StateView) {
        self.0.step(share, state);
    }

    fn should_continue(&self) -> ControlFlow<()> {
        if interrupt::asked() { ControlFlow::Break(()) } else { self.0.should_continue() }
    }

    fn enter(&mut self, stage: Stage) {
        self.0.enter(stage);
    }
}
