//! `nucleus run`: simulates a scene and records it.

use std::path::{Path, PathBuf};

use anyhow::{Context, Result, anyhow};
use clap::Args;
use nucleus_graph::Simulation;
use nucleus_graph::audit::Closeness;
use nucleus_graph::checks::{Check, Judge};
use nucleus_graph::compile::{Program, compile};
use nucleus_graph::scene::{Diagnostic, Scene};
use nucleus_measure::trade::Setting;

use crate::account::Account;
use crate::frame_range::FrameRange;
use crate::initial_state::InitialState;
use crate::outcome::Outcome;
use crate::output::say;
use crate::record::{Channels, Record};
use crate::recording::{self, Manner};
use crate::session::Session;
use crate::{interrupt, quality, scene_file, threads};

/// Frames from one checkpoint to the next, unless others are asked for: two seconds of film. A checkpoint takes about as
/// much as twenty frames.
const CHECKPOINT: u32 = 48;

/// Simulates a scene and records it as a cache.
///
/// Ctrl-C drops the frame that is being solved, closes the cache with the frame before, and gives exit code 130. A second
/// Ctrl-C ends the program at once; the cache then plays to its last whole frame. `nucleus resume` goes on after either.
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
    /// Frames from one checkpoint to the next, from which `nucleus resume` goes on; the last frame has one too. 0: none.
    #[arg(long, value_name = "FRAMES", default_value_t = CHECKPOINT)]
    checkpoint: u32,
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
            checkpoint: CHECKPOINT,
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
            return Ok(Outcome::InvalidInput);
        };
        let (read, is_from) = (program.clone(), self.from.is_some());
        let (scene, program) = match &self.from {
            None => (scene, program),
            Some(from) => from.applied(scene, &program)?,
        };
        let (program, setting) = match self.quality {
            None => (program, None),
            Some(wanted) => {
                self.program_of(&scene, wanted).map(|(program, setting)| (program, Some(setting)))?
            }
        };
        interrupt::listen()?;
        let (start, end) = recording::frames(&program)?;
        let mut simulation = Simulation::new(&program, threads::count(self.threads));
        if self.audit {
            simulation.begin_audit(Closeness::Steps);
        } else if program.checks().iter().any(Check::needs_audit) {
            simulation.begin_audit(Closeness::Frames);
        }
        let judge = Judge::new(program.checks(), program.mass());
        let record = self.record.unwrap_or_default();
        let channels = record.channels();
        let manner = Manner {
            moments: record.moments(&program),
            channels: Channels { velocities: channels.velocities || self.velocities, ..channels },
            force: self.force,
            compact: self.compact,
            checkpoint: self.checkpoint,
            facts: recording::facts(self.from.as_ref(), setting, if is_from { &read } else { &program })?,
        };
        let out = self.out()?;
        let recorder = recording::begin(&simulation, manner, &out, (&self.scene, &text))?;
        let (account, frames, audit, json) = (Account::default(), end.abs_diff(start), self.audit, self.json);
        let session = Session { simulation, recorder, out, judge, account, start, frames, audit, json };
        session.run(|_| false)
    }

    /// The program at the setting that a quality wants, and that setting.
    fn program_of(&self, scene: &Scene, wanted: f64) -> Result<(Program, Setting)> {
        let (scene, said, setting) = quality::scene_at(scene, &self.scene.display().to_string(), wanted)?;
        say!("{said}");
        let first =
            |found: Vec<Diagnostic>| found.into_iter().map(|one| one.message).next().unwrap_or_default();
        let program =
            compile(&scene).map_err(|found| anyhow!("the scene cannot run so: {}", first(found)))?;
        Ok((program, setting))
    }
}
