//! `nucleus resume`: continues a run from its cache.

use std::path::PathBuf;

use anyhow::{Result, ensure};
use clap::Args;
use nucleus_cache::{RecordError, Recorder, ResumeRange, RunInfo, shell_word};
use nucleus_core::Real;
use nucleus_graph::checks::Check;

use crate::options::Scalar;
use crate::output::say;
use crate::process::Outcome;
use crate::resumed_run::{ResumedRun, ResumedScene, Unresumable};
use crate::run_loop::{Finished, Recording, RunLoop};
use crate::{files, options, output, process, recording};

/// Resumes an interrupted or killed run, with the same bits as a run that never stopped.
///
/// The run starts at the last checkpoint, solves the frames recorded after it again, compares them with the cache, and
/// continues to the last frame. The cache is replaced only when all its frames are solved again. A resumed run may itself
/// be killed and resumed. A run with `--audit` continues with it.
#[derive(Debug, Args)]
pub struct Resume {
    /// The cache (.mcap), or the unfinished cache of a killed run (.mcap.part).
    cache: PathBuf,
    /// Keep the frames up to this one and solve the later ones again.
    #[arg(long, value_name = "FRAME", allow_hyphen_values = true)]
    at: Option<i32>,
    /// The last frame; default: that of the run.
    #[arg(long, value_name = "FRAME", allow_hyphen_values = true)]
    to: Option<i32>,
    /// Continue with this scene instead of the text in the cache. It must give the same result for the frames that are kept.
    #[arg(long)]
    scene: Option<PathBuf>,
    /// Write another cache and leave this one unchanged.
    #[arg(short, long)]
    out: Option<PathBuf>,
    /// Replace the cache given with `--out` if it exists.
    #[arg(long)]
    force: bool,
    /// Threads to use; default: one per core. The result does not depend on it.
    #[arg(long, value_parser = clap::value_parser!(u16).range(1..))]
    threads: Option<u16>,
    /// Print one JSON object per frame and one for the run.
    #[arg(long)]
    json: bool,
}

/// How resuming a run ended.
pub enum Resumed {
    /// The scene has errors, which are reported.
    InvalidScene,
    /// There was nothing to do.
    Complete,
    Finished(Finished),
}

impl Resume {
    /// The end of a cache, as part of a wedge.
    pub fn within(cache: PathBuf, threads: u16) -> Self {
        let (at, to, scene, out) = (None, None, None, None);
        Self { cache, at, to, scene, out, force: false, threads: Some(threads), json: true }
    }

    /// Resumes the run and prints the summary.
    pub fn run(self) -> Result<Outcome> {
        let json = self.json;
        Ok(match self.execute()? {
            Resumed::InvalidScene => Outcome::InvalidInput,
            Resumed::Complete => Outcome::Success,
            Resumed::Finished(finished) => finished.print(json),
        })
    }

    /// Resumes the run.
    pub fn execute(self) -> Result<Resumed> {
        let old = ResumedRun::open(&self.cache)?;
        let Some(scene) = old.scene(self.scene.as_deref(), self.to)? else {
            return Ok(Resumed::InvalidScene);
        };
        let (_, end) = recording::frames(&scene.program)?;
        let compared = self.kept(&old, end)?;
        let is_complete = old.file == old.complete && old.lost().is_empty();
        if is_complete && self.at.is_none() && old.last() >= end {
            self.report_finished(&old)?;
            return Ok(Resumed::Complete);
        }
        if old.file != self.cache {
            say!("resuming {}, the unfinished cache of an ended run", old.name());
        }
        process::listen_for_signals()?;
        match old.scalar() {
            Scalar::F32 => self.simulate::<f32>(old, scene, compared),
            Scalar::F64 => self.simulate::<f64>(old, scene, compared),
        }
    }

    /// Continues a run with scalar `R` after frame `compared`.
    fn simulate<R: Real>(self, mut old: ResumedRun, scene: ResumedScene, compared: i32) -> Result<Resumed> {
        let ResumedScene { program, path, text, fingerprint } = scene;
        let (start, end) = recording::frames(&program)?;
        let needs_audit = old.is_audited() || program.checks().iter().any(Check::needs_audit);
        // Lost frames are solved again.
        let sound = old.lost().first().map_or(compared, |lost| compared.min(lost - 1));
        let (simulation, copied) = old.restored::<R>(&program, options::thread_count(self.threads), sound)?;
        let mut run = RunLoop::new(simulation, old.is_audited());
        old.figures(copied, needs_audit)?.iter().for_each(|figures| run.add_recorded(figures));
        ensure!(
            run.not_finite().is_none(),
            Unresumable(format!(
                "a position or velocity is not finite from frame {} on: give an earlier frame with `--at`",
                run.not_finite().unwrap_or_default()
            ))
        );
        // A changed scene may solve other frames from here on: only those of both are sure to be recorded.
        let interval = recording::interval(&program)?;
        let both = program.common_frames(old.cache.run().interval);
        let interval = u32::try_from(both).unwrap_or(interval);
        let info = RunInfo {
            end,
            interval,
            scene_path: path.display().to_string(),
            scene_text: text,
            extra: recording::facts_of(old.cache.run(), self.scene.is_some().then_some(fingerprint)),
            ..old.cache.run().clone()
        };
        let out = match &self.out {
            Some(out) => files::named_as_cache(out)?.to_owned(),
            None => old.complete.clone(),
        };
        let replace = self.force || self.out.is_none();
        // The frames of the resumed cache itself are all in the new one.
        let replaces = out != old.file;
        let objects = recording::sources(&run.simulation, old.cache.objects().to_vec());
        let help = self.help(&old, copied);
        let start_is_lost = old.lost().contains(&start);
        let kept = ResumeRange { copied: if start_is_lost { start - 1 } else { copied }, compared };
        let resumed = Recorder::resume(&out, replace, &info, objects, old.cache, kept);
        let mut recorder = resumed.map_err(recording::with_options)?;
        if start_is_lost {
            recorder.record_start(run.simulation.state())?;
        }
        if recorder.checkpoint_due() {
            recorder.record_checkpoint(&run.simulation.save())?; // The checkpoint of the start was lost.
        }
        let recording = Recording { recorder: Some(recorder), out, replaces };
        let is_refusal = |error: &anyhow::Error| {
            matches!(
                error.downcast_ref(),
                Some(RecordError::ReplayMismatch { .. } | RecordError::ReplayIncomplete { .. })
            )
        };
        let finished = run.finish(recording, self.json, is_refusal);
        finished.map(Resumed::Finished).map_err(|error| match error.downcast_ref() {
            Some(RecordError::ReplayMismatch { .. }) => error.context(help),
            _ => error,
        })
    }

    /// The last frame to keep.
    fn kept(&self, old: &ResumedRun, end: i32) -> Result<i32> {
        let (first, last) = (old.cache.run().start, old.last());
        let kept = self.at.unwrap_or(last);
        ensure!(
            first <= kept && kept <= last,
            "there is no frame {kept} to resume from; {} has {first} to {last}",
            old.name()
        );
        ensure!(
            kept <= end,
            "{} already has frames up to {last}, beyond frame {end}: drop the later frames with `--at`",
            old.name()
        );
        Ok(kept)
    }

    /// Advice if a frame that is solved again differs from the recorded one.
    fn help(&self, old: &ResumedRun, copied: i32) -> String {
        let scene =
            self.scene.as_ref().map(|path| format!(" --scene {}", shell_word(path))).unwrap_or_default();
        format!(
            "the scene, a file that it reads, or nucleus itself has changed; {} is unchanged; `nucleus resume {}{scene} --at \
             {copied}` solves the frames after {copied} again",
            old.name(),
            shell_word(&old.file)
        )
    }

    fn report_finished(&self, old: &ResumedRun) -> Result<()> {
        let (name, last) = (old.name(), old.last());
        output::print(&format!(
            "{name} is complete: its last frame is {last}; `--to` continues beyond it, `--at` solves the frames after one again\n"
        ))
    }
}
