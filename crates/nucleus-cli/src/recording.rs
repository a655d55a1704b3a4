//! From a program to a recorder: what the cache is to say of the run.

use std::collections::BTreeMap;
use std::path::Path;
use std::str::FromStr;

use anyhow::{Context, Result, bail};
use nucleus_cache::{Detail, ObjectInfo, ObjectKind, Packing, Plane, Recorder, RunInfo, Source};
use nucleus_graph::compile::{self, Program};
use nucleus_graph::{Simulation, scene};
use nucleus_measure::trade::Setting;

use crate::continued::{PROGRAM, SETTING};
use crate::fingerprint::fingerprint;
use crate::initial_state::InitialState;

/// What is recorded of a run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Record {
    /// Moments of it.
    Moments(Detail),
    /// Nothing.
    None,
}

impl Record {
    /// What is asked for, or else what the scene wants.
    pub fn of(asked: Option<Self>, program: &Program) -> Self {
        asked.unwrap_or(match program.record() {
            scene::Record::Frames => Self::Moments(Detail::Frames),
            scene::Record::Substeps => Self::Moments(Detail::Substeps),
            scene::Record::Every(n) => Self::Moments(Detail::Every(n)),
            scene::Record::None => Self::None,
        })
    }
}

impl FromStr for Record {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let every = || text.strip_prefix("every:")?.trim().parse().ok().filter(|&n| n > 0);
        match text {
            "frames" => Ok(Self::Moments(Detail::Frames)),
            "substeps" => Ok(Self::Moments(Detail::Substeps)),
            "none" => Ok(Self::None),
            _ => every().map(|n| Self::Moments(Detail::Every(n))).ok_or_else(|| {
                "write frames, substeps, every:10 (each tenth frame and the last) or none".to_owned()
            }),
        }
    }
}

/// How a cache is to be written.
#[derive(Debug, Clone)]
pub struct Manner {
    /// What is recorded.
    pub record: Record,
    /// Whether velocities are, too.
    pub velocities: bool,
    /// Whether an older cache may be replaced.
    pub force: bool,
    /// Whether it is to be as small as can be, at the cost of time.
    pub compact: bool,
    /// Frames from one checkpoint to the next; 0 for none.
    pub checkpoint: u32,
    /// What else is worth knowing.
    pub facts: BTreeMap<String, String>,
}

/// Begins the cache of a run at its start frame; none if nothing is to be recorded.
pub fn begin(
    simulation: &Simulation,
    manner: Manner,
    out: &Path,
    scene: (&Path, &str),
) -> Result<Option<Recorder>> {
    let Record::Moments(detail) = manner.record else { return Ok(None) };
    let program = simulation.program();
    let (start, end) = frames(program)?;
    let units = program.units_per_metre();
    let plane = program.first_input().plane;
    let run = RunInfo {
        scene_path: scene.0.display().to_string(),
        scene_text: scene.1.to_owned(),
        start,
        end,
        frames_per_second: program.time().fps,
        units_per_metre: units,
        detail,
        velocities: manner.velocities,
        ground: plane
            .map(|plane| Plane { origin: (plane.origin * units).into(), normal: plane.normal.into() }),
        packing: if manner.compact { Packing::Small } else { Packing::Fast },
        checkpoint: manner.checkpoint,
        extra: manner.facts,
        ..RunInfo::default()
    };
    let objects = objects(simulation);
    let recorder = match manner.force {
        true => Recorder::replace(out, &run, objects),
        false => Recorder::create(out, &run, objects),
    };
    let mut recorder = recorder?;
    recorder.record_start(simulation.state())?;
    if recorder.wants_checkpoint() {
        recorder.record_checkpoint(&simulation.save())?;
    }
    Ok(Some(recorder))
}

/// What else is worth knowing of a run: where it begins, if that is a frame of another cache; the setting that a quality
/// stands for; a fingerprint of what was `read`. Nothing that may change from one run of a scene to the next, such as the
/// date or the number of threads: the same run gives the same bytes.
pub fn facts(
    from: Option<&InitialState>,
    setting: Option<Setting>,
    read: &Program,
) -> Result<BTreeMap<String, String>> {
    let mut facts =
        BTreeMap::from([("scalar".to_owned(), "f32".to_owned()), ("machine".to_owned(), machine())]);
    facts.extend(from.map(|from| ("from".to_owned(), from.to_string())));
    if let Some(setting) = setting {
        facts.insert(SETTING.to_owned(), serde_json::to_string(&setting)?);
    }
    facts.insert(PROGRAM.to_owned(), fingerprint(read));
    Ok(facts)
}

/// The same of a run that goes on, perhaps with a scene that has `changed`.
pub fn facts_of(run: &RunInfo, changed: Option<&Program>) -> BTreeMap<String, String> {
    let mut facts = run.extra.clone();
    facts.extend(changed.map(|program| (PROGRAM.to_owned(), fingerprint(program))));
    facts
}

fn machine() -> String {
    format!("{} {}", std::env::consts::OS, std::env::consts::ARCH)
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

/// What each recorded object is to the solver, for objects of these names.
pub fn sources(simulation: &Simulation, objects: Vec<ObjectInfo>) -> Vec<(Source, ObjectInfo)> {
    let source = |recorded: &ObjectInfo| {
        let object = simulation.objects().iter().find(|object| object.name == recorded.name)?;
        Some(match object.kind {
            compile::ObjectKind::Cloth(id) => Source::Cloth(id),
            compile::ObjectKind::Collider(id) => Source::Collider(id),
        })
    };
    objects.into_iter().filter_map(|object| source(&object).map(|source| (source, object))).collect()
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
