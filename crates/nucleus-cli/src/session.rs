//! A run from where it is to its end: frame by frame, told, closed, and summed up.

use std::path::PathBuf;

use anyhow::Result;
use nucleus_cache::Recorder;
use nucleus_graph::Simulation;
use nucleus_graph::checks::Judge;
use serde_json::json;

use crate::account::{Account, FrameFigures};
use crate::outcome::Outcome;
use crate::progress::Progress;
use crate::simulate::{Ending, simulate};
use crate::summary::Summary;
use crate::{interrupt, output};

/// A run that is set up.
pub struct Session {
    pub simulation: Simulation,
    /// Where it is recorded, if it is.
    pub recorder: Option<Recorder>,
    /// The cache that it is recorded as.
    pub out: PathBuf,
    pub judge: Judge,
    /// What it has come to so far.
    pub account: Account,
    /// Its start frame.
    pub start: i32,
    /// Frames that are still to be solved.
    pub frames: u32,
    /// Whether what an audit finds is part of the outcome.
    pub audit: bool,
    /// Whether a machine is to read what is printed.
    pub json: bool,
}

impl Session {
    /// Runs it to its end.
    ///
    /// # Errors
    /// When `is_refusal` says so of why the run was lost.
    pub fn run(self, is_refusal: impl Fn(&anyhow::Error) -> bool) -> Result<Outcome> {
        let Self { mut simulation, mut recorder, out, mut judge, account, start, frames, audit, json } = self;
        let mut progress = Progress::new(frames);
        let mut tell = |figures: &FrameFigures, account: &Account| {
            progress.show(account);
            if json {
                tell_frame(figures, account);
            }
        };
        let (account, mut ending) = simulate(&mut simulation, &mut recorder, &mut judge, account, &mut tell)?;
        progress.end();
        let recorded = close(&simulation, recorder, &mut ending).map(|bytes| (out, bytes));
        interrupt::run_is_over();
        match ending {
            Ending::Lost(error) if is_refusal(&error) => return Err(error),
            _ => {}
        }
        let last = simulation.frame();
        let audit = simulation.audit().filter(|_| audit);
        let (checks, frames, objects) = (judge.outcomes(), (start.into(), last), simulation.objects());
        let summary = Summary { account, ending, checks, audit, recorded, frames, objects };
        match json {
            true => output::tell_json(&summary.as_json()),
            false => output::tell(&summary.as_text()?),
        }
        Ok(summary.outcome())
    }
}

/// Closes the cache, with a checkpoint of its last frame; gives its size in bytes, if there is one and it could be
/// written to its end.
fn close(simulation: &Simulation, recorder: Option<Recorder>, ending: &mut Ending) -> Option<u64> {
    let is_open = |ending: &Ending| match ending {
        Ending::Lost(_) => false,
        Ending::Stopped(stopped) => stopped.is_clean,
        _ => true,
    };
    let mut recorder = recorder.filter(|_| is_open(ending))?;
    let state = match ending {
        // What is no number is nothing to go on from.
        Ending::NotFinite => None,
        // The state is that of a frame that is dropped.
        Ending::Stopped(stopped) => stopped.state.take(),
        _ => recorder.final_checkpoint_due().then(|| simulation.save()),
    };
    let state = state.filter(|_| recorder.final_checkpoint_due());
    let last = state.map_or(Ok(()), |state| recorder.record_checkpoint(&state));
    match last.and_then(|()| recorder.finish()) {
        Ok(recorded) => Some(recorded.bytes),
        Err(error) => {
            *ending = Ending::Lost(error.into());
            None
        }
    }
}

fn tell_frame(figures: &FrameFigures, account: &Account) {
    let mut line = json!(figures);
    line["milliseconds"] = json!(account.last.as_secs_f64() * 1e3);
    output::tell_json(&line);
}
