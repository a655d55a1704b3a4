//! `nucleus run`: simulates a scene and records a cache.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result};
use clap::Args;
use nucleus_core::Real;
use nucleus_graph::Simulation;
use nucleus_graph::compile::Program;
use nucleus_graph::scene::{Assignment, Scene};
use nucleus_measure::trade::Setting;

use super::import;
use crate::initial_state::InitialState;
use crate::options::{self, Channels, FrameRange, Record, Scalar};
use crate::output::say;
use crate::process::Outcome;
use crate::recording::{self, RecordOptions, SurfaceData};
use crate::run_loop::{Finished, Recording, RunLoop};
use crate::{budget_hints, diagnostics, files, process, quality};

/// Default number of frames from one checkpoint to the next: two seconds of film. A checkpoint takes about as many bytes
/// as twenty frames.
const CHECKPOINT: u32 = 48;

/// Simulates a scene and records it as a cache.
///
/// Ctrl-C drops the unfinished frame, closes the cache after the previous one and exits with 130; with --force an existing
/// cache stays, and the unfinished one keeps the name with `.part`. A second Ctrl-C ends the process at once; the unfinished
/// cache then plays to its last complete frame. `nucleus resume` continues after either.
#[derive(Debug, Args)]
pub struct Run {
    /// The scene (.ron), or a Maya scene (.ma), which is first imported beside the cache.
    scene: PathBuf,
    /// Frames to run: a count that includes the start frame (`48`) or a range (`10..58`); default: those of the scene.
    #[arg(long, allow_hyphen_values = true)]
    frames: Option<FrameRange>,
    /// Initial state of all cloth: a frame of a cache, `drape.mcap@80`, or its last frame, `drape.mcap`. Positions and
    /// velocities are taken over, and ages and numbers of particles; constraints, plasticity, gas and the phase of emitters begin anew.
    #[arg(long, value_name = "CACHE@FRAME")]
    from: Option<InitialState>,
    /// Threads to use; default: one per core. The result does not depend on it.
    #[arg(long, value_parser = clap::value_parser!(u16).range(1..))]
    threads: Option<u16>,
    /// Times and channels to record, separated by commas: frames, substeps, every:10 or none; positions, velocities,
    /// contacts, strain. Default: the times of the scene, positions and contacts.
    #[arg(long, value_name = "WHAT")]
    record: Option<Record>,
    /// Record velocities too; the cache becomes twice as large.
    #[arg(long)]
    velocities: bool,
    /// Pack harder, without loss: the cache is about a tenth smaller and a hundred times slower to write.
    #[arg(long)]
    compact: bool,
    /// Frames from one checkpoint to the next, for `nucleus resume`; the last frame has one too. 0: no checkpoints.
    #[arg(long, value_name = "FRAMES", default_value_t = CHECKPOINT)]
    checkpoint: u32,
    /// Replace an existing cache.
    #[arg(long)]
    force: bool,
    /// The cache to write; default: the name of the scene with `.mcap`.
    #[arg(short, long)]
    out: Option<PathBuf>,
    /// Audit every time step with an independent intersection test, and exit with 1 if anything passes through anything.
    /// The result of the run does not change; the run takes longer.
    #[arg(long)]
    audit: bool,
    /// Set an attribute, as if the scene said so; may be given several times. The cache holds the scene as it was run.
    #[arg(long, value_name = "NODE.ATTRIBUTE=VALUE")]
    pub set: Vec<Assignment>,
    /// Displace the start positions of cloth and particles at random by up to a thousandth of an edge or radius, to see
    /// how much of a result is chance.
    #[arg(long, value_name = "NUMBER")]
    seed: Option<u32>,
    /// Use the cheapest setting with at most this error (`1%`) according to `nucleus trade` for this scene.
    #[arg(long, value_name = "ERROR", value_parser = quality::error)]
    quality: Option<f64>,
    /// Precision of the solver. With f64, a scene at the setting of a reference of `nucleus trade` gives its bits.
    #[arg(long, value_enum, default_value_t)]
    scalar: Scalar,
    /// Print one JSON object per frame and one for the run.
    #[arg(long)]
    json: bool,
}

impl Run {
    /// A run of a scene with default options.
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
            set: Vec::new(),
            seed: None,
            quality: None,
            scalar: Scalar::F32,
            json: false,
        }
    }

    /// The path of the cache.
    pub fn out(&self) -> Result<PathBuf> {
        match &self.out {
            Some(out) => files::named_as_cache(out).map(Path::to_owned),
            None => {
                let no_file = || format!("`{}` is a folder, not a scene", self.scene.display());
                let stem = self.scene.file_stem().with_context(no_file)?;
                Ok(Path::new(stem).with_extension("mcap"))
            }
        }
    }

    /// Simulates the scene and prints the summary.
    pub fn run(self) -> Result<Outcome> {
        let json = self.json;
        Ok(self.execute()?.map_or(Outcome::InvalidInput, |finished| finished.print(json)))
    }

    /// Simulates the scene. Returns `None` if it has errors, which are reported.
    pub fn execute(mut self) -> Result<Option<Finished>> {
        let out = self.out()?;
        self.scene = import::own_scene(self.scene, &out, self.force)?;
        let file = files::open_scene_with(&self.scene, self.frames, &self.set)?;
        // A run from a cache starts elsewhere.
        let file = if self.from.is_none() { file.with_first_frame() } else { file };
        let Some((scene, program, text)) = file.report()? else { return Ok(None) };
        let read = program.clone();
        let (scene, program) = match &self.from {
            None => (scene, program),
            Some(from) => from.applied(scene, &program, &text)?,
        };
        let (scene, program) = match self.seed {
            None => (scene, program),
            Some(seed) => displaced(scene, &program, seed)?,
        };
        let is_changed = self.from.is_some() || self.seed.is_some();
        let (program, setting) = match self.quality {
            None => (program, None),
            Some(wanted) => {
                self.program_of(&scene, wanted).map(|(program, setting)| (program, Some(setting)))?
            }
        };
        budget_hints::budgets(&program).iter().for_each(|line| say!("{line}"));
        budget_hints::liquid_steps(&program).iter().for_each(|line| say!("{line}"));
        if self.scalar == Scalar::F32 {
            budget_hints::unresolved_steps(&program).iter().for_each(|line| say!("{line}"));
        }
        process::listen_for_signals()?;
        let facts = self.facts(setting, if is_changed { &read } else { &program })?;
        let surface_data = SurfaceData::of(&scene, &program);
        match self.scalar {
            Scalar::F32 => self.simulate::<f32>(&program, (facts, surface_data), (out, &text)),
            Scalar::F64 => self.simulate::<f64>(&program, (facts, surface_data), (out, &text)),
        }
    }

    /// Runs a program with scalar `R` and records it in the file `out`; `text` is that of its scene.
    fn simulate<R: Real>(
        self,
        program: &Program,
        (facts, surface_data): (BTreeMap<String, String>, SurfaceData),
        (out, text): (PathBuf, &str),
    ) -> Result<Option<Finished>> {
        recording::frames(program)?;
        let simulation: Simulation<R> = Simulation::new(program, options::thread_count(self.threads));
        let run = RunLoop::new(simulation, self.audit);
        let record = self.record.unwrap_or_default();
        let channels = record.channels();
        let options = RecordOptions {
            moments: record.moments(program),
            channels: Channels { velocities: channels.velocities || self.velocities, ..channels },
            force: self.force,
            compact: self.compact,
            checkpoint: self.checkpoint,
            surface_data,
            facts,
        };
        let recorder = recording::begin(&run.simulation, options, &out, (&self.scene, text))?;
        let recording = Recording { recorder, out, replaces: self.force };
        run.finish(recording, self.json, |_| false).map(Some)
    }

    /// Facts about the run. `read` is the program before any change of its initial state.
    fn facts(&self, setting: Option<Setting>, read: &Program) -> Result<BTreeMap<String, String>> {
        let mut facts = recording::facts(self.from.as_ref(), setting, self.scalar, read)?;
        if self.audit {
            facts.insert(recording::AUDIT.to_owned(), "every step".to_owned());
        }
        facts.extend(self.seed.map(|seed| (recording::SEED.to_owned(), seed.to_string())));
        if !self.set.is_empty() {
            let set: Vec<String> = self.set.iter().map(Assignment::to_string).collect();
            facts.insert("set".to_owned(), set.join(" "));
        }
        Ok(facts)
    }

    /// The run as part of a wedge: into this cache, with this number of threads, replacing the files of an earlier
    /// attempt.
    pub fn within(self, out: PathBuf, threads: u16) -> Self {
        Self { out: Some(out), threads: Some(threads), force: true, json: true, ..self }
    }

    /// The program at the setting for an error, and that setting.
    fn program_of(&self, scene: &Scene, wanted: f64) -> Result<(Program, Setting)> {
        let (scene, said, setting) = quality::scene_at(scene, &self.scene.display().to_string(), wanted)?;
        say!("{said}");
        let program = diagnostics::compile_changed(&scene, "the scene does not compile at this setting")?;
        Ok((program, setting))
    }
}

/// The scene with displaced start positions, and its program.
fn displaced(scene: Scene, program: &Program, seed: u32) -> Result<(Scene, Program)> {
    let scene = nucleus_wedge::seed::displaced(scene, program, seed);
    let program = diagnostics::compile_changed(&scene, "the scene does not compile with displaced points")?;
    Ok((scene, program))
}
