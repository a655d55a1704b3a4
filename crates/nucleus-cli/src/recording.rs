//! From a program to a recorder: what the cache is to say of the run.

use std::path::Path;

use anyhow::{Context, Result, bail};
use nucleus_cache::{Detail, ObjectInfo, ObjectKind, Recorder, RunInfo, Source};
use nucleus_graph::compile::{self, Program};
use nucleus_graph::{Simulation, scene};

/// What is recorded of a run.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub enum Record {
    /// The end of every frame.
    Frames,
    /// The end of every substep.
    Substeps,
    /// Nothing.
    None,
}

impl Record {
    /// What is asked for, or else what the scene wants.
    pub fn of(asked: Option<Self>, program: &Program) -> Self {
        asked.unwrap_or(match program.record() {
            scene::Record::Frames => Self::Frames,
            scene::Record::Substeps => Self::Substeps,
        })
    }

    fn detail(self) -> Option<Detail> {
        match self {
            Self::Frames => Some(Detail::Frames),
            Self::Substeps => Some(Detail::Substeps),
            Self::None => None,
        }
    }
}

/// Begins the cache of a run at its start frame; none if nothing is to be recorded.
pub fn begin(
    simulation: &Simulation,
    record: Record,
    out: &Path,
    scene: (&Path, &str),
) -> Result<Option<Recorder>> {
    let Some(detail) = record.detail() else { return Ok(None) };
    let program = simulation.program();
    let (start, end) = frames(program)?;
    let run = RunInfo {
        scene_path: scene.0.display().to_string(),
        scene_text: scene.1.to_owned(),
        start,
        end,
        frames_per_second: program.time().fps,
        units_per_metre: program.units_per_metre(),
        detail,
        ..RunInfo::default()
    };
    let mut recorder = Recorder::create(out, &run, objects(simulation))?;
    recorder.record_start(simulation.state())?;
    Ok(Some(recorder))
}

/// First and last frame of a program.
pub fn frames(program: &Program) -> Result<(i32, i32)> {
    let time = program.time();
    if time.end < time.start {
        bail!("the run ends at frame {}, before it starts at frame {}", time.end, time.start);
    }
    let frame = |frame: i64| i32::try_from(frame).with_context(|| format!("frame {frame} is out of range"));
    Ok((frame(time.start)?, frame(time.end)?))
}

/// The objects as they are now, at the start frame.
fn objects(simulation: &Simulation) -> Vec<(Source, ObjectInfo)> {
    let units = simulation.units_per_metre();
    let state = simulation.state();
    let object = |object: &compile::Object| {
        let mut rest = Vec::with_capacity(object.points);
        let (source, kind) = match object.kind {
            compile::ObjectKind::Cloth(id) => {
                state.positions(id, units, &mut rest);
                let free = object.faces.is_empty();
                (Source::Cloth(id), if free { ObjectKind::Particles } else { ObjectKind::Cloth })
            }
            compile::ObjectKind::Collider(id) => {
                state.collider_positions(id, units, &mut rest);
                (Source::Collider(id), ObjectKind::Collider)
            }
        };
        (source, ObjectInfo { name: object.name.clone(), kind, faces: object.faces.clone(), rest })
    };
    simulation.objects().iter().map(object).collect()
}
