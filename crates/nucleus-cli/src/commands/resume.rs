//! `nucleus resume`: goes on with a run.

use std::path::PathBuf;

use anyhow::{Result, ensure};
use clap::Args;
use nucleus_cache::{RecordError, Recorder, ResumeRange, RunInfo};
use nucleus_graph::audit::Closeness;
use nucleus_graph::checks::{Check, Judge};

use crate::account::Account;
use crate::continued::Continued;
use crate::outcome::Outcome;
use crate::output::say;
use crate::session::Session;
use crate::{interrupt, output, recording, threads};

/// Goes on with a run that was ended, with the same bits as one that never stopped.
///
/// It begins at the last checkpoint, solves again what was recorded after it, holds that to what the cache has, and goes on
/// to the last frame. The cache stays as it is until all of it is there again; a run that goes on may itself be killed at any
/// moment, and gone on with.
#[derive(Debug, Args)]
pub struct Resume {
    /// The cache (.mcap), or what a killed run has left of it (.mcap.part).
    cache: PathBuf,
    /// Keep the frames up to this one and solve all that comes after it again.
    #[arg(long, value_name = "FRAME", allow_hyphen_values = true)]
    at: Option<i32>,
    /// Go on to this frame instead of the one that the run was to end with.
    #[arg(long, value_name = "FRAME", allow_hyphen_values = true)]
    to: Option<i32>,
    /// Go on with this scene as it is now, not with what the cache holds. What it changes may not begin before the frames
    /// that are kept end.
    #[arg(long)]
    scene: Option<PathBuf>,
    /// Write another cache, and leave this one as it is.
    #[arg(short, long)]
    out: Option<PathBuf>,
    /// Replace that one if it exists.
    #[arg(long)]
    force: bool,
    /// Cores to use; all if none are given. The result is the same, bit for bit.
    #[arg(long, value_parser = clap::value_parser!(u16).range(1..))]
    threads: Option<u16>,
    /// Print a JSON object for each frame and one for the run.
    #[arg(long)]
    json: bool,
}

impl Resume {
    /// Goes on with it.
    pub fn run(self) -> Result<Outcome> {
        let mut old = Continued::open(&self.cache)?;
        let Some((program, scene_path, text)) = old.scene(self.scene.as_deref(), self.to)? else {
            return Ok(Outcome::InvalidInput);
        };
        let (start, end) = recording::frames(&program)?;
        let compared = self.kept(&old, end)?;
        let is_whole = old.file == old.whole && old.lost().is_empty();
        if is_whole && self.at.is_none() && old.last() >= end {
            return self.tell_that_it_is_finished(&old);
        }
        if old.file != self.cache {
            say!("going on with {}, which a run that was ended has left", old.name());
        }
        interrupt::listen()?;
        // What is lost is solved again too.
        let sound = old.lost().first().map_or(compared, |lost| compared.min(lost - 1));
        let (mut simulation, copied) = old.restored(&program, threads::count(self.threads), sound)?;
        if program.checks().iter().any(Check::needs_audit) {
            simulation.begin_audit(Closeness::Frames);
        }
        let mut judge = Judge::new(program.checks(), program.mass());
        let mut account = Account::default();
        for figures in old.figures(copied)? {
            judge.see(&figures.report());
            account.recall(&figures);
        }
        ensure!(
            account.not_finite.is_none(),
            "a position or velocity is no finite number from frame {} on: `--at` goes back to a frame before it",
            account.not_finite.unwrap_or_default()
        );
        let run = RunInfo {
            end,
            scene_path: scene_path.display().to_string(),
            scene_text: text,
            extra: recording::facts_of(old.cache.run(), self.scene.is_some().then_some(&program)),
            ..old.cache.run().clone()
        };
        let out = self.out.clone().unwrap_or_else(|| old.whole.clone());
        let replace = self.force || self.out.is_none();
        let objects = recording::sources(&simulation, old.cache.objects().to_vec());
        let help = self.help(&old, copied);
        let start_is_lost = old.lost().contains(&start);
        let kept = ResumeRange { copied: if start_is_lost { start - 1 } else { copied }, compared };
        let mut recorder = Recorder::resume(&out, replace, &run, objects, old.cache, kept)?;
        if start_is_lost {
            recorder.record_start(simulation.state())?;
        }
        if recorder.checkpoint_due() {
            recorder.record_checkpoint(&simulation.save())?; // that of the start was lost
        }
        let frames = end.abs_diff(copied);
        let recorder = Some(recorder);
        let (audit, json) = (false, self.json);
        let session = Session { simulation, recorder, out, judge, account, start, frames, audit, json };
        let is_refusal = |error: &anyhow::Error| {
            matches!(
                error.downcast_ref(),
                Some(RecordError::ReplayMismatch { .. } | RecordError::ReplayIncomplete { .. })
            )
        };
        session.run(is_refusal).map_err(|error| match error.downcast_ref() {
            Some(RecordError::ReplayMismatch { .. }) => error.context(help),
            _ => error,
        })
    }

    /// The last frame that is kept.
    fn kept(&self, old: &Continued, end: i32) -> Result<i32> {
        let (first, last) = (old.cache.run().start, old.last());
        let kept = self.at.unwrap_or(last);
        ensure!(
            first <= kept && kept <= last,
            "there is no frame {kept} to go on from; {} has {first} to {last}",
            old.name()
        );
        ensure!(
            kept <= end,
            "{} goes on to frame {last} already, past frame {end}: `--at` drops what comes after a frame",
            old.name()
        );
        Ok(kept)
    }

    /// What to do where a frame does not come out as it was recorded.
    fn help(&self, old: &Continued, copied: i32) -> String {
        let scene =
            self.scene.as_ref().map(|path| format!(" --scene {}", path.display())).unwrap_or_default();
        format!(
            "the scene, a file that it reads, or nucleus itself has changed; {} is left as it was, and `nucleus resume {}{scene} \
             --at {copied}` solves all that comes after frame {copied} anew",
            old.name(),
            old.file.display()
        )
    }

    fn tell_that_it_is_finished(&self, old: &Continued) -> Result<Outcome> {
        let (name, last) = (old.name(), old.last());
        output::print(&format!(
            "{name} is finished: frame {last} is its last; `--to` goes on past it, `--at` solves a part of it again\n"
        ))?;
        Ok(Outcome::Fine)
    }
}
