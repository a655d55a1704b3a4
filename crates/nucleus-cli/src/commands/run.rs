//! `nucleus run`: simulates a scene and records it.

use std::path::{Path, PathBuf};

use anyhow::{Context, Result, anyhow};
use clap::Args;
use nucleus_cache::Recorder;
use nucleus_graph::Simulation;
use nucleus_graph::audit::Closeness;
use nucleus_graph::checks::{Check, Judge};
use nucleus_graph::compile::{Program, compile};
use nucleus_graph::scene::{Diagnostic, Scene};
use serde_json::json;

use crate::account::{Account, FrameFigures};
use crate::frame_range::FrameRange;
use crate::initial_state::InitialState;
use crate::outcome::Outcome;
use crate::progress::Progress;
use crate::record::{Channels, Record};
use crate::recording::{self, Manner};
use crate::simulate::{Ending, simulate};
use crate::summary::Summary;
use crate::{interrupt, output, quality, scene_file};

/// Simulates a scene and records it as a cache.
///
/// Ctrl-C ends the run after the frame it is in and closes the cache; the exit code is then 130. A second
/// Ctrl-C ends it at once; the cache then plays to its last whole frame.
#[derive(Debug, Args)]
pub struct Run {
    /// The scene (.ron).
    scene: PathBuf,
    /// Frames to run: so many (`48`, the start frame among them) or from one to another (`10..58`).
    #[arg(long, allow_hyphen_values = true)]
    frames: Option<FrameRange>,
    /// Start all cloth as a frame of a cache has it, `drape.mcap@80`; without a frame, as its last one.
    #[arg(long, value_name = "CACHE@FRAME")]
    from: Option<InitialState>,
    /// Cores to use; all if none are given. The result is the same, bit for bit.
    #[arg(long, value_parser = clap::value_parser!(u16).range(1..))]
    threads: Option<u16>,
    /// What to record, instead of what the scene says: frames, substeps, every:10 or none; and, behind commas, what of it:
    /// positions, velocities, contacts, strain. `substeps,contacts,strain`; positions and contacts if nothing is said.
    #[arg(long, value_name = "WHAT")]
    record: Option<Record>,
    /// Record velocities too; the cache becomes twice as large.
    #[arg(long)]
    velocities: bool,
    /// Pack harder: a cache about a tenth smaller, without loss, a hundred times slower to write.
    #[arg(long)]
    compact: bool,
    /// Replace a cache that exists.
    #[arg(long)]
    force: bool,
    /// The cache to write; the scene's name with `.mcap` if none is given.
    #[arg(short, long)]
    out: Option<PathBuf>,
    /// Look, apart from the solver, whether anything passes through anything on the way from each state that the
    /// solver shows to the next. Exit code 1 if it does. It takes time, and changes nothing.
    #[arg(long)]
    audit: bool,
    /// The cheapest setting with at most this error (`1%`), by what `nucleus trade` has found for the scene.
    #[arg(long, value_name = "ERROR", value_parser = quality::error)]
    quality: Option<f64>,
    /// Print a JSON object for each frame and one for the run.
    #[arg(long)]
    json: bool,
}

impl Run {
    /// A run of a scene with everything else left as it is.
    pub fn of(scene: PathBuf, force: bool) -> Self {
        Self {
            scene,
            frames: None,
            from: None,
            threads: None,
            record: None,
            velocities: false,
            compact: false,
            force,
            out: None,
            audit: false,
            quality: None,
            json: false,
        }
    }

    /// The cache that it writes.
    pub fn out(&self) -> Result<PathBuf> {
        match &self.out {
            Some(out) => Ok(out.clone()),
            None => {
                let stem = self.scene.file_stem().context("the scene has no name")?;
                Ok(Path::new(stem).with_extension("mcap"))
            }
        }
    }

    /// Runs it.
    pub fn run(self) -> Result<Outcome> {
        let Some((scene, program, text)) = scene_file::open(&self.scene, self.frames)?.told()? else {
            return Ok(Outcome::Refused);
        };
        let (scene, program) = match &self.from {
            None => (scene, program),
            Some(from) => from.applied(scene, &program)?,
        };
        let program = match self.quality {
            None => program,
            Some(wanted) => self.program_of(&scene, wanted)?,
        };
        interrupt::listen()?;
        let (start, end) = recording::frames(&program)?;
        let mut simulation = Simulation::new(&program, self.threads());
        if self.audit {
            simulation.begin_audit(Closeness::Steps);
        } else if program.checks().iter().any(Check::needs_audit) {
            simulation.begin_audit(Closeness::Frames);
        }
        let mut judge = Judge::new(program.checks(), program.mass());
        let record = self.record.unwrap_or_default();
        let channels = record.channels();
        let manner = Manner {
            moments: record.moments(&program),
            channels: Channels { velocities: channels.velocities || self.velocities, ..channels },
            force: self.force,
            compact: self.compact,
            from: self.from.as_ref().map(ToString::to_string),
        };
        let out = self.out()?;
        let mut recorder = recording::begin(&simulation, manner, &out, (&self.scene, &text))?;
        let mut progress = Progress::new(end.abs_diff(start));
        let mut tell = |figures: &FrameFigures, account: &Account| {
            progress.show(account);
            if self.json { print_frame(figures, account) } else { Ok(()) }
        };
        let (account, mut ending) = simulate(&mut simulation, &mut recorder, &mut judge, &mut tell)?;
        progress.end();
        let recorded = close(recorder, &mut ending).map(|bytes| (out, bytes));
        interrupt::run_is_over();
        let last = simulation.frame();
        let audit = simulation.audit().filter(|_| self.audit);
        let (checks, frames, objects) = (judge.outcomes(), (start.into(), last), simulation.objects());
        let summary = Summary { account, ending, checks, audit, recorded, frames, objects };
        match self.json {
            true => output::print_json(&summary.as_json())?,
            false => output::print(&summary.as_text()?)?,
        }
        Ok(summary.outcome())
    }

    /// The program at the setting that a quality wants.
    fn program_of(&self, scene: &Scene, wanted: f64) -> Result<Program> {
        let (scene, said) = quality::scene_at(scene, &self.scene.display().to_string(), wanted)?;
        eprintln!("{said}");
        let first =
            |found: Vec<Diagnostic>| found.into_iter().map(|one| one.message).next().unwrap_or_default();
        compile(&scene).map_err(|found| anyhow!("the scene cannot run so: {}", first(found)))
    }

    fn threads(&self) -> usize {
        let all = || std::thread::available_parallelism().map_or(1, usize::from);
        self.threads.map_or_else(all, usize::from)
    }
}

/// Closes the cache; gives its size in bytes, if there is one and it could be written to its end.
fn close(recorder: Option<Recorder>, ending: &mut Ending) -> Option<u64> {
    let recorder = recorder.filter(|_| !matches!(ending, Ending::Lost(_)))?;
    match recorder.finish() {
        Ok(recorded) => Some(recorded.bytes),
        Err(error) => {
            *ending = Ending::Lost(error.into());
            None
        }
    }
}

fn print_frame(figures: &FrameFigures, account: &Account) -> Result<()> {
    let mut line = serde_json::to_value(figures)?;
    line["milliseconds"] = json!(account.last.as_secs_f64() * 1e3);
    output::print_json(&line)
}
