//! A resumed run: the cache it continues, the scene of that cache, and whether both still match.

use std::path::{Path, PathBuf};
use std::{fmt, fs};

use anyhow::{Context, Result, anyhow, bail, ensure};
use nucleus_cache::{Checkpoint, ObjectInfo, OpenError, Playback, ReadError, RecordError, shell_word};
use nucleus_core::{Real, RestoreError};
use nucleus_graph::Simulation;
use nucleus_graph::compile::Program;
use nucleus_graph::scene::Scene;
use nucleus_measure::trade::Benchmark;
use nucleus_wedge::seed;
use serde_json::Value;

use crate::initial_state::in_scene_units;
use crate::options::Scalar;
use crate::output::say;
use crate::recording::{AUDIT, FROM, PROGRAM, SCALAR, SEED, SETTING, fingerprint};
use crate::run_statistics::FrameStatistics;
use crate::{diagnostics, figures, files};

/// Why a cache can never be resumed as it is: the run must be started again, or the cache be changed by hand.
#[derive(Debug)]
pub struct Unresumable(pub String);

impl fmt::Display for Unresumable {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for Unresumable {}

/// An [`Unresumable`] with a formatted message.
macro_rules! unresumable {
    ($($message:tt)*) => { Unresumable(format!($($message)*)) };
}

/// Whether an error of a resumed run lies in its cache. Any other error, such as a full disk, may pass.
pub fn is_unresumable(error: &anyhow::Error) -> bool {
    let is_refused = |error: &RecordError| {
        matches!(error, RecordError::ReplayMismatch { .. } | RecordError::ReplayIncomplete { .. })
    };
    let is_broken = |error: &OpenError| {
        use OpenError::{BadValue, Empty, NoRecord, NotMcap, TooShort, Topology};
        matches!(error, Empty | TooShort | NotMcap | NoRecord { .. } | BadValue { .. } | Topology { .. })
    };
    error.is::<Unresumable>()
        || error.downcast_ref().is_some_and(is_refused)
        || error.downcast_ref().is_some_and(is_broken)
}

/// The scene of a resumed run.
pub struct ResumedScene {
    /// The program, with the initial state of the run.
    pub program: Program,
    /// The path of its file.
    pub path: PathBuf,
    /// Its text.
    pub text: String,
    /// The fingerprint of the program before its initial state was changed.
    pub fingerprint: String,
}

/// A run that is resumed from its cache.
pub struct ResumedRun {
    /// The file that is read.
    pub file: PathBuf,
    /// The name of the complete cache: `file` without `.part`.
    pub complete: PathBuf,
    /// The cache, with every frame verified.
    pub cache: Playback,
}

impl ResumedRun {
    /// Opens a cache. The `.part` file of a killed run has precedence over an older complete cache beside it.
    pub fn open(path: &Path) -> Result<Self> {
        let is_part = path.extension().is_some_and(|end| end == "part");
        let complete = if is_part { path.with_extension("") } else { path.to_owned() };
        let part = nucleus_cache::part_path(&complete);
        let has_part = fs::metadata(&part).is_ok_and(|found| found.is_file() && found.len() > 0);
        let file = if has_part { part } else { path.to_owned() };
        let cannot = || format!("cannot resume `{}`", file.display());
        let opened = Playback::open_to_resume(&file).map_err(|error| match error {
            OpenError::TooShort | OpenError::Empty => anyhow!(error).context(
                "the run ended before its first frame was recorded: start the run again with `nucleus run`",
            ),
            other => anyhow!(other),
        });
        let mut cache = opened.with_context(cannot)?;
        cache.verify().with_context(cannot)?;
        ensure!(
            cache.corruption().can_resume(),
            unresumable!("{}: {}; `nucleus recover` saves the frames", cannot(), cache.corruption())
        );
        ensure!(
            !cache.time_samples().is_empty(),
            unresumable!("`{}` holds no frame: start the run again with `nucleus run`", file.display())
        );
        Ok(Self { file, complete, cache })
    }

    /// The last recorded frame.
    pub fn last(&self) -> i32 {
        self.cache.time_samples().last().map_or(self.cache.run().start, |moment| moment.frame)
    }

    /// Lost frames before the last one, in ascending order.
    pub fn lost(&self) -> &[i32] {
        &self.cache.corruption().frames
    }

    /// The program up to frame `end`, the path and the text of its scene. The scene is the text in the cache, or the file
    /// `changed`. Returns `None` if it has errors, which are reported.
    pub fn scene(&self, changed: Option<&Path>, end: Option<i32>) -> Result<Option<ResumedScene>> {
        let run = self.cache.run();
        let read = match changed {
            Some(path) => files::open_scene(path, None)?,
            None => {
                let text = &run.scene_text;
                ensure!(
                    !text.is_empty(),
                    unresumable!("{} holds no scene: name it with `--scene`", self.name())
                );
                files::scene_from_text(
                    text.clone(),
                    &files::recorded_scene(&self.cache, &self.complete),
                    None,
                )?
            }
        };
        let path = changed.map_or_else(|| PathBuf::from(&run.scene_path), Path::to_owned);
        let Some((mut scene, _, text)) = read.report()? else { return Ok(None) };
        let (first, given) = (i64::from(run.start), self.program(&mut scene, changed.is_some(), end)?);
        ensure!(
            given.time().start == first,
            unresumable!(
                "the scene starts at frame {}, but {} at frame {first}: run it again with `nucleus run`",
                given.time().start,
                self.name()
            )
        );
        if changed.is_none() {
            self.check_inputs(&given)?;
        }
        let fingerprint = fingerprint(&given);
        let program = self.begun(scene, given)?;
        self.check_objects(&program)?;
        Ok(Some(ResumedScene { program, path, text, fingerprint }))
    }

    /// The program with the initial state of the run: particles of another cache are those that this one begins with, and a
    /// seed displaces the start again.
    fn begun(&self, mut scene: Scene, given: Program) -> Result<Program> {
        let extra = &self.cache.run().extra;
        if extra.contains_key(FROM) {
            let particles = given.objects().iter().filter(|object| object.radius.is_some());
            for object in particles {
                let recorded = self.cache.objects().iter().find(|recorded| recorded.name == object.name);
                if let Some((node, recorded)) = scene.graph.find(&object.name).zip(recorded) {
                    scene.set_particle_positions(node, in_scene_units(&recorded.rest, 1.0))?;
                }
            }
        } else if let Some(seed) = extra.get(SEED) {
            let seed = seed.parse().with_context(|| format!("`seed` of {} cannot be read", self.name()))?;
            scene = seed::displaced(scene, &given, seed);
        } else {
            return Ok(given);
        }
        diagnostics::compile_changed(&scene, "the scene does not compile with the initial state of the run")
    }

    /// Compiles the scene for the frame range and at the setting of the run.
    fn program(&self, scene: &mut Scene, is_changed: bool, end: Option<i32>) -> Result<Program> {
        let run = self.cache.run();
        let own_end = if is_changed { scene.time.end } else { run.end.into() };
        scene.time.end = end.map_or(own_end, i64::from);
        if let Some(setting) = run.extra.get(SETTING) {
            let setting = serde_json::from_str(setting).context("the cache's `setting` cannot be read")?;
            *scene = Benchmark::new(scene)?.set(&setting);
        }
        let program = diagnostics::compile_changed(scene, "the scene of the run does not compile")?;
        if program.time().start == i64::from(run.start) {
            return Ok(program);
        }
        // `--frames` of the run replaced the frame range of the scene.
        scene.time.start = run.start.into();
        diagnostics::compile_changed(scene, "the scene of the run does not compile")
    }

    /// The scene must have the objects, the frame rate and the units of the cache.
    fn check_objects(&self, program: &Program) -> Result<()> {
        let run = self.cache.run();
        let units = program.units_per_metre();
        ensure!(
            program.time().fps == run.frames_per_second && units == run.units_per_metre,
            unresumable!(
                "the scene has {} frames per second and {units} units per metre, but {} has {} and {}: run it again with `nucleus run`",
                program.time().fps,
                self.name(),
                run.frames_per_second,
                run.units_per_metre
            )
        );
        let recorded: Vec<&ObjectInfo> = self.cache.objects().iter().collect();
        for object in program.objects() {
            let Some(found) = recorded.iter().find(|recorded| recorded.name == object.name) else {
                bail!(unresumable!(
                    "`{}` is not in {}: a resumed run needs the same objects",
                    object.name,
                    self.name()
                ))
            };
            ensure!(
                found.rest.len() == object.points && found.faces == object.faces,
                unresumable!(
                    "the mesh of `{}` differs from that in {}: {} points and {} faces, but {} and {} in the cache",
                    object.name,
                    self.name(),
                    object.points,
                    object.faces.len(),
                    found.rest.len(),
                    found.faces.len()
                )
            );
        }
        let is_gone =
            |recorded: &&&ObjectInfo| program.objects().iter().all(|object| object.name != recorded.name);
        match recorded.iter().find(is_gone) {
            Some(gone) => {
                bail!(unresumable!("`{}` is in {} but no longer in the scene", gone.name, self.name()))
            }
            None => Ok(()),
        }
    }

    /// Meshes and maps must be unchanged.
    fn check_inputs(&self, program: &Program) -> Result<()> {
        let known = self.cache.run().extra.get(PROGRAM);
        ensure!(
            known.is_none_or(|known| *known == fingerprint(program)),
            unresumable!(
                "a mesh or map that the scene reads, or nucleus itself, has changed since {} was recorded; `nucleus resume {} \
                 --scene {} --at FRAME` keeps the frames up to FRAME and continues with the present files",
                self.name(),
                shell_word(&self.file),
                shell_word(Path::new(&self.cache.run().scene_path))
            )
        );
        Ok(())
    }

    /// The simulation at the last intact checkpoint up to frame `latest`, and the frame of that checkpoint. Without a
    /// checkpoint, or where the frames to solve need more room for particles than it has, the simulation at its start.
    pub fn restored<R: Real>(
        &mut self,
        program: &Program,
        threads: usize,
        latest: i32,
    ) -> Result<(Simulation<R>, i32)> {
        let frames = self.cache.checkpoints();
        for frame in frames.into_iter().rev().filter(|&frame| frame <= latest) {
            let found = match self.cache.checkpoint(frame) {
                Ok(Some(Checkpoint { bytes, .. })) => Simulation::restored(program, threads, &bytes),
                Ok(None) | Err(ReadError::Damaged { .. }) => Err(RestoreError::Damaged),
                Err(error) => return Err(error.into()),
            };
            match found {
                Ok(simulation) => return Ok((simulation, frame)),
                // Earlier checkpoints have no more room.
                Err(error @ RestoreError::SmallerCapacity { .. }) => {
                    return self.restarted(program, threads, &error.to_string());
                }
                Err(error @ (RestoreError::Damaged | RestoreError::OtherVersion)) => {
                    say!("warning: checkpoint of frame {frame}: {error}; the previous checkpoint is used");
                }
                Err(error) => bail!(unresumable!("{} cannot be resumed: {error}", self.name())),
            }
        }
        self.restarted(program, threads, &format!("there is no intact checkpoint up to frame {latest}"))
    }

    /// The simulation at its start, if the scene alone gives that; `reason` says why no checkpoint is used.
    fn restarted<R: Real>(
        &self,
        program: &Program,
        threads: usize,
        reason: &str,
    ) -> Result<(Simulation<R>, i32)> {
        let (name, run) = (self.name(), self.cache.run());
        if let Some(from) = run.extra.get(FROM) {
            bail!(unresumable!("{name}: {reason}, and its initial state is that of `{from}`: run it again"));
        }
        say!("{name}: {reason}: every frame is solved again from frame {}", run.start);
        Ok((Simulation::new(program, threads), run.start))
    }

    /// The scalar that the run computes with.
    pub fn scalar(&self) -> Scalar {
        match self.cache.run().extra.get(SCALAR).map(String::as_str) {
            Some("f64") => Scalar::F64,
            _ => Scalar::F32,
        }
    }

    /// Whether the run was audited at every time step.
    pub fn is_audited(&self) -> bool {
        self.cache.run().extra.contains_key(AUDIT)
    }

    /// The recorded figures of the frames up to `last`, in order. `needs_audit`: frames without an audit are reported, as are
    /// figures that cannot be read.
    pub fn figures(&mut self, last: i32, needs_audit: bool) -> Result<Vec<FrameStatistics>> {
        let (mut figures, unread) = parse_figures(self.cache.reports()?);
        if let Some(first) = unread.first() {
            let count = figures::count(unread.len(), "frame");
            say!(
                "warning: checks do not see {count} of {}, whose figures cannot be read: {first}",
                self.name()
            );
        }
        figures.retain(|figures| figures.frame <= last);
        let unaudited = figures.iter().filter(|figures| figures.passed_through.is_none()).count();
        if needs_audit && unaudited > 0 {
            let count = figures::count(unaudited, "frame");
            say!("warning: no audit sees {count} of {}, recorded without one", self.name());
        }
        Ok(figures)
    }

    /// The name of the file in backquotes, for messages.
    pub fn name(&self) -> String {
        format!("`{}`", self.file.display())
    }
}

/// The figures of each frame, and the reasons why those of some frames cannot be read.
fn parse_figures(reports: Vec<Value>) -> (Vec<FrameStatistics>, Vec<String>) {
    let (mut figures, mut unread) = (Vec::new(), Vec::new());
    for report in reports {
        let frame = report["frame"].clone();
        match serde_json::from_value(report) {
            Ok(found) => figures.push(found),
            Err(error) => unread.push(format!("frame {frame}: {error}")),
        }
    }
    (figures, unread)
}

#[cfg(test)]
mod tests {
    use std::io;

    use nucleus_core::StepReport;
    use serde_json::json;

    use super::*;

    #[test]
    fn figures_that_cannot_be_read_are_named_by_their_frame() {
        let whole = json!(FrameStatistics::new(3, &StepReport::default()));
        let (figures, unread) = parse_figures(vec![json!({ "frame": 2, "max_strain": 0.1 }), whole]);
        assert_eq!(figures.iter().map(|figures| figures.frame).collect::<Vec<_>>(), [3]);
        assert_eq!(unread.len(), 1);
        assert!(unread[0].starts_with("frame 2: missing field"), "{}", unread[0]);
    }

    #[test]
    fn an_error_of_the_system_may_pass_and_one_of_the_cache_remains() {
        let full = || io::Error::from(io::ErrorKind::StorageFull);
        let path = || PathBuf::from("a.mcap");
        for passes in [
            anyhow!(RecordError::Create { path: path(), source: full() }),
            anyhow!(RecordError::Write { frames: 9, bytes: 9, source: full() }),
            anyhow!(OpenError::Io { path: path(), source: full() }),
            anyhow!(OpenError::Read(full())).context("cannot resume `a.mcap`"),
            anyhow!(OpenError::InUse { path: path() }),
            anyhow!(full()),
        ] {
            assert!(!is_unresumable(&passes), "{passes:#}");
        }
        for remains in [
            anyhow!(RecordError::ReplayMismatch { frame: 3, object: "cloth1".to_owned() }).context("advice"),
            anyhow!(OpenError::TooShort).context("it ended early").context("cannot resume `a.mcap`"),
            anyhow!(unresumable!("`a.mcap` holds no frame")),
        ] {
            assert!(is_unresumable(&remains), "{remains:#}");
        }
    }

    #[test]
    fn a_frame_of_infinite_energy_is_read() {
        let report = StepReport { kinetic_energy: f64::INFINITY, ..StepReport::default() };
        let (figures, unread) = parse_figures(vec![json!(FrameStatistics::new(2, &report))]);
        assert_eq!((figures.len(), unread.len()), (1, 0));
        assert!(figures[0].kinetic_energy.is_nan());
    }
}
