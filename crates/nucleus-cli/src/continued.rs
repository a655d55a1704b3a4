//! A cache whose run is gone on with: where it is, which scene it is of, and whether that still fits.

use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, anyhow, bail, ensure};
use nucleus_cache::{Checkpoint, ObjectInfo, OpenError, Playback, ReadError};
use nucleus_core::RestoreError;
use nucleus_graph::Simulation;
use nucleus_graph::compile::{Program, compile};
use nucleus_graph::scene::Scene;
use nucleus_measure::trade::Benchmark;

use crate::account::FrameFigures;
use crate::output::say;
use crate::{fingerprint, scene_file};

/// A cache to go on with.
pub struct Continued {
    /// The file that is read.
    pub file: PathBuf,
    /// The file that it belongs to, without `.part`.
    pub whole: PathBuf,
    /// What it holds; every frame has been looked at.
    pub cache: Playback,
}

impl Continued {
    /// Opens what a run has left: beside a cache, what a killed run has left of a newer one counts.
    pub fn open(path: &Path) -> Result<Self> {
        let is_part = path.extension().is_some_and(|end| end == "part");
        let whole = if is_part { path.with_extension("") } else { path.to_owned() };
        let part = nucleus_cache::unfinished(&whole);
        let has_part = fs::metadata(&part).is_ok_and(|found| found.is_file() && found.len() > 0);
        let file = if has_part { part } else { path.to_owned() };
        let cannot = || format!("cannot go on with `{}`", file.display());
        let opened = Playback::open_to_resume(&file).map_err(|error| match error {
            OpenError::TooShort | OpenError::Empty => anyhow!(error).context(
                "its run was ended before its first frame was recorded: `nucleus run` begins it again",
            ),
            other => anyhow!(other),
        });
        let mut cache = opened.with_context(cannot)?;
        cache.verify().with_context(cannot)?;
        ensure!(
            cache.loss().knows_run(),
            "{}: {}; `nucleus recover` saves its frames",
            cannot(),
            cache.loss()
        );
        ensure!(
            !cache.moments().is_empty(),
            "`{}` holds no frame: `nucleus run` begins it again",
            file.display()
        );
        Ok(Self { file, whole, cache })
    }

    /// The last frame that was recorded.
    pub fn last(&self) -> i32 {
        self.cache.moments().last().map_or(self.cache.run().start, |moment| moment.frame)
    }

    /// The frames that are lost before the last, in order.
    pub fn lost(&self) -> &[i32] {
        &self.cache.loss().frames
    }

    /// The scene, up to `end`: as the cache holds it, or as `changed` is now. Nothing if it has mistakes, which are told.
    pub fn scene(
        &self,
        changed: Option<&Path>,
        end: Option<i32>,
    ) -> Result<Option<(Program, PathBuf, String)>> {
        let run = self.cache.run();
        let read = match changed {
            Some(path) => scene_file::open(path, None)?,
            None => {
                let text = &run.scene_text;
                ensure!(!text.is_empty(), "{} holds no scene: `--scene` names it", self.name());
                scene_file::of_text(text.clone(), &self.scene_path(), None)?
            }
        };
        let path = changed.map_or_else(|| PathBuf::from(&run.scene_path), Path::to_owned);
        let Some((mut scene, _, text)) = read.told()? else { return Ok(None) };
        let (first, program) = (i64::from(run.start), self.program(&mut scene, changed.is_some(), end)?);
        ensure!(
            program.time().start == first,
            "the scene begins at frame {}, {} at frame {first}: `nucleus run` begins it anew",
            program.time().start,
            self.name()
        );
        self.check_objects(&program)?;
        if changed.is_none() {
            self.check_inputs(&program)?;
        }
        Ok(Some((program, path, text)))
    }

    /// Compiles the scene for the frames and at the setting of the run.
    fn program(&self, scene: &mut Scene, is_changed: bool, end: Option<i32>) -> Result<Program> {
        let run = self.cache.run();
        let own_end = if is_changed { scene.time.end } else { run.end.into() };
        scene.time.end = end.map_or(own_end, i64::from);
        let broken = |found: Vec<nucleus_graph::scene::Diagnostic>| {
            let first = found.into_iter().map(|one| one.message).next().unwrap_or_default();
            anyhow!("the scene cannot go on: {first}")
        };
        if let Some(setting) = run.extra.get(SETTING) {
            let setting = serde_json::from_str(setting).context("the cache's `setting` cannot be read")?;
            *scene = Benchmark::new(scene)?.set(&setting);
        }
        let program = compile(scene).map_err(broken)?;
        if program.time().start == i64::from(run.start) {
            return Ok(program);
        }
        // The run was of other frames than its scene.
        scene.time.start = run.start.into();
        compile(scene).map_err(broken)
    }

    /// Where the scene was; its folder is where meshes are looked for. Beside the cache, if it is not there any more.
    fn scene_path(&self) -> PathBuf {
        let path = PathBuf::from(&self.cache.run().scene_path);
        let beside = self.whole.with_file_name(path.file_name().unwrap_or_default());
        if !path.exists() && beside.exists() { beside } else { path }
    }

    /// The objects of the scene must be those of the cache.
    fn check_objects(&self, program: &Program) -> Result<()> {
        let run = self.cache.run();
        let units = program.units_per_metre();
        ensure!(
            program.time().fps == run.frames_per_second && units == run.units_per_metre,
            "the scene has {} frames a second and {units} units to the metre, {} {} and {}: `nucleus run` begins it anew",
            program.time().fps,
            self.name(),
            run.frames_per_second,
            run.units_per_metre
        );
        let recorded: Vec<&ObjectInfo> = self.cache.objects().iter().collect();
        for object in program.objects() {
            let Some(found) = recorded.iter().find(|recorded| recorded.name == object.name) else {
                bail!("`{}` is not in {}: a run cannot go on with other objects", object.name, self.name())
            };
            ensure!(
                found.rest.len() == object.points && found.faces == object.faces,
                "the mesh of `{}` is not that in {}: it has {} points and {} faces, there it has {} and {}",
                object.name,
                self.name(),
                object.points,
                object.faces.len(),
                found.rest.len(),
                found.faces.len()
            );
        }
        let is_gone =
            |recorded: &&&ObjectInfo| program.objects().iter().all(|object| object.name != recorded.name);
        match recorded.iter().find(is_gone) {
            Some(gone) => bail!("`{}` is in {} and no more in the scene", gone.name, self.name()),
            None => Ok(()),
        }
    }

    /// Meshes and maps must be what they were.
    fn check_inputs(&self, program: &Program) -> Result<()> {
        let known = self.cache.run().extra.get(PROGRAM);
        ensure!(
            known.is_none_or(|known| *known == fingerprint::fingerprint(program)),
            "a mesh or map that the scene reads, or nucleus itself, has changed since {} was recorded; `nucleus resume {} \
             --scene {} --at FRAME` keeps what there is up to a frame and goes on with what is there now",
            self.name(),
            self.file.display(),
            self.cache.run().scene_path
        );
        Ok(())
    }

    /// The run at its last sound checkpoint up to a frame, and that frame; its start where there is none.
    pub fn restored(&mut self, program: &Program, threads: usize, latest: i32) -> Result<(Simulation, i32)> {
        let frames = self.cache.checkpoints();
        for frame in frames.into_iter().rev().filter(|&frame| frame <= latest) {
            let found = match self.cache.checkpoint(frame) {
                Ok(Some(Checkpoint { bytes, .. })) => Simulation::restored(program, threads, &bytes),
                Ok(None) | Err(ReadError::Damaged { .. }) => Err(RestoreError::Damaged),
                Err(error) => return Err(error.into()),
            };
            match found {
                Ok(simulation) => return Ok((simulation, frame)),
                Err(error @ (RestoreError::Damaged | RestoreError::OtherVersion)) => {
                    say!("warning: frame {frame}: {error}; the one before it is taken");
                }
                Err(error) => bail!("{} cannot be gone on with: {error}", self.name()),
            }
        }
        let start = self.cache.run().start;
        if let Some(from) = self.cache.run().extra.get("from") {
            bail!(
                "{} has no sound checkpoint up to frame {latest}, and its start is that of `{from}`: run it again",
                self.name()
            );
        }
        say!(
            "{} has no sound checkpoint up to frame {latest}: all is solved again from frame {start}",
            self.name()
        );
        Ok((Simulation::new(program, threads), start))
    }

    /// What is known of the frames up to one, in order.
    pub fn figures(&mut self, last: i32) -> Result<Vec<FrameFigures>> {
        let reports = self.cache.reports()?;
        let figures =
            reports.into_iter().filter_map(|report| serde_json::from_value::<FrameFigures>(report).ok());
        Ok(figures.filter(|figures| figures.frame <= last).collect())
    }

    /// Its name, in backquotes.
    pub fn name(&self) -> String {
        format!("`{}`", self.file.display())
    }
}

/// The key under which a cache has the fingerprint of what it was made from.
pub const PROGRAM: &str = "program";
/// The key of the setting that a quality stood for.
pub const SETTING: &str = "setting";
