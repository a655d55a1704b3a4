//! The loop over the frames of a run: simulate, record, judge, tell.

use std::time::Instant;

use anyhow::{Context, Result};
use nucleus_cache::{RecordError, Recorder};
use nucleus_graph::checks::Judge;
use nucleus_graph::{FrameReport, Simulation};

use crate::account::{Account, FrameFigures};
use crate::interrupt;

/// Why the loop has ended.
#[derive(Debug)]
pub enum Ending {
    /// All frames are done.
    Done,
    /// It was asked to.
    Interrupted,
    /// What comes after a number that is not finite means nothing.
    NotFinite,
    /// The cache could not be written.
    Lost(anyhow::Error),
}

/// Advances to the last frame, from where `account` stands. `tell` is shown each frame with the account so far.
pub fn simulate(
    simulation: &mut Simulation,
    recorder: &mut Option<Recorder>,
    judge: &mut Judge,
    mut account: Account,
    tell: &mut dyn FnMut(&FrameFigures, &Account),
) -> Result<(Account, Ending)> {
    while !simulation.is_done() {
        if interrupt::asked() {
            return Ok((account, Ending::Interrupted));
        }
        let begin = Instant::now();
        let frame = i32::try_from(simulation.next_frame()).context("there are too many frames")?;
        let figures = match advance(simulation, frame, recorder, judge) {
            Ok(figures) => figures,
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

/// One frame.
fn advance(
    simulation: &mut Simulation,
    frame: i32,
    recorder: &mut Option<Recorder>,
    judge: &mut Judge,
) -> Result<FrameFigures, RecordError> {
    let look = |seen: FrameReport, judge: &mut Judge| {
        judge.see(&seen);
        FrameFigures::new(frame, &seen.report)
    };
    match recorder {
        None => Ok(look(simulation.advance(&mut ()), judge)),
        Some(recorder) => {
            let seen = simulation.advance(&mut recorder.frame(frame)?);
            let figures = look(seen, judge);
            recorder.end_frame(&figures)?;
            if figures.finite && recorder.wants_checkpoint() {
                recorder.record_checkpoint(&simulation.save())?;
            }
            Ok(figures)
        }
    }
}
