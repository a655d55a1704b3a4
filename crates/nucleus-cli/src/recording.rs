//! From a program to a recorder: what the cache is to say of the run.

use std::collections::BTreeMap;
use std::path::Path;

use anyhow::{Context, Result, bail};
use nucleus_cache::{
    Camera, CameraView, FilmFit, ObjectInfo, ObjectKind, Packing, Plane, Recorder, RunInfo, Source,
};
use nucleus_graph::Simulation;
use nucleus_graph::compile::{self, Program};
use nucleus_measure::trade::Setting;

use crate::continued::{PROGRAM, SETTING};
use crate::fingerprint::fingerprint;
use crate::initial_state::InitialState;

use crate::record::{Channels, Moments};

/// How a cache is to be written.
#[derive(Debug, Clone)]
pub struct Manner {
    /// Which moments are recorded.
    pub moments: Moments,
    /// What is recorded of them.
    pub channels: Channels,
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
    let Moments::Of(detail) = manner.moments else { return Ok(None) };
    let Channels { velocities, contacts, strain } = manner.channels;
    let run = RunInfo {
        detail,
        velocities,
        contacts,
        strain,
        packing: if manner.compact { Packing::Small } else { Packing::Fast },
        checkpoint: manner.checkpoint,
        extra: manner.facts,
        ..of_scene(simulation, scene)?
    };
    let objects = objects(simulation);
    let recorder = match manner.force {
        true => Recorder::replace(out, &run, objects),
        false => Recorder::create(out, &run, objects),
    };
    let mut recorder = recorder?;
    recorder.record_start(simulation.state())?;
    if recorder.checkpoint_due() {
        recorder.record_checkpoint(&simulation.save())?;
    }
    Ok(Some(recorder))
}

/// What a scene alone tells of its run.
pub fn of_scene(simulation: &Simulation, scene: (&Path, &str)) -> Result<RunInfo> {
    let program = simulation.program();
    let (start, end) = frames(program)?;
    let units = program.units_per_metre();
    let plane = program.first_input().plane;
    Ok(RunInfo {
        scene_path: scene.0.display().to_string(),
        scene_text: scene.1.to_owned(),
        start,
        end,
        frames_per_second: program.time().fps,
        units_per_metre: units,
        ground: plane
            .map(|plane| Plane { origin: (plane.origin * units).into(), normal: plane.normal.into() }),
        radii: simulation.objects().iter().filter_map(|o| Some((o.name.clone(), o.radius?))).collect(),
        cameras: program.cameras().into_iter().map(camera).collect(),
        ..RunInfo::default()
    })
}

/// A camera as a cache has it.
fn camera(camera: compile::Camera) -> Camera {
    let fit = match camera.fit {
        compile::FilmFit::Fill => FilmFit::Fill,
        compile::FilmFit::Horizontal => FilmFit::Horizontal,
        compile::FilmFit::Vertical => FilmFit::Vertical,
        compile::FilmFit::Overscan => FilmFit::Overscan,
    };
    let view = |view: compile::View| CameraView {
        eye: view.eye.map(|x| x as f32).into(),
        forward: view.forward.map(|x| x as f32).into(),
        up: view.up.map(|x| x as f32).into(),
        focal_length: view.focal_length as f32,
        film: view.film.map(|x| x as f32),
        interest: view.interest as f32,
    };
    Camera { name: camera.name, fit, views: camera.views.into_iter().map(view).collect() }
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
pub fn objects(simulation: &Simulation) -> Vec<(Source, ObjectInfo)> {
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
