//! From a simulation to a recorder: the metadata of a run, and the fingerprint of its inputs.

use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::Path;

use anyhow::{Context, Result, anyhow, bail};
use nucleus_cache::{
    Camera, CameraView, FaceSet, FaceSets, FilmFit, ObjectInfo, ObjectKind, Packing, Plane, RecordError,
    Recorder, RunInfo, SelectedPoints, Source, SurfaceShape, TextureCoordinates, shell_word,
};
use nucleus_core::{GroundPlane, Real};
use nucleus_graph::Simulation;
use nucleus_graph::compile::{self, NucleusProgram, Program};
use nucleus_graph::mesh;
use nucleus_graph::scene::Scene;
use nucleus_measure::result_cache::Fingerprint;
use nucleus_measure::trade::Setting;

use crate::files;
use crate::initial_state::InitialState;
use crate::options::{Channels, Moments, Scalar};

/// Key of the [`fingerprint`] in the facts of a cache.
pub const PROGRAM: &str = "program";
/// Key of the scalar that a run computes with.
pub const SCALAR: &str = "scalar";
/// Key of the setting that `--quality` selected.
pub const SETTING: &str = "setting";
/// Key of `--audit`, which a resumed run continues.
pub const AUDIT: &str = "audit";
/// Key of the seed of `--seed`.
pub const SEED: &str = "seed";
/// The cache and the frame whose state the run began with.
pub const FROM: &str = "from";

/// How a cache is written.
#[derive(Debug, Clone)]
pub struct RecordOptions {
    pub moments: Moments,
    pub channels: Channels,
    /// Whether an existing cache is replaced.
    pub force: bool,
    /// Whether the cache is packed harder: smaller, and slower to write.
    pub compact: bool,
    /// Frames from one checkpoint to the next; 0 for none.
    pub checkpoint: u32,
    /// Further facts about the run; see [`facts`].
    pub facts: BTreeMap<String, String>,
    /// What is recorded of the meshes besides points and faces.
    pub surface_data: SurfaceData,
}

/// What meshes have besides points and faces, by object.
#[derive(Debug, Clone, Default)]
pub struct SurfaceData {
    pub texture_coordinates: BTreeMap<String, TextureCoordinates>,
    pub face_sets: BTreeMap<String, FaceSets>,
}

impl SurfaceData {
    /// That of the objects of a scene.
    pub fn of(scene: &Scene, program: &Program) -> Self {
        let coordinates = |(name, (values, corners)): (String, compile::MeshCoordinates)| {
            let values = values.into_iter().map(|uv| uv.map(|x| x as f32)).collect();
            (name, TextureCoordinates { values, corners })
        };
        let set = |mesh::FaceSet { name, faces }| FaceSet { name, faces };
        let sets = |(name, mesh::FaceSets { groups, materials }): (String, mesh::FaceSets)| {
            let [groups, materials] = [groups, materials].map(|sets| sets.into_iter().map(set).collect());
            (name, FaceSets { groups, materials })
        };
        Self {
            texture_coordinates: compile::texture_coordinates(scene, program)
                .into_iter()
                .map(coordinates)
                .collect(),
            face_sets: compile::face_sets(scene, program).into_iter().map(sets).collect(),
        }
    }
}

/// Creates the cache of a run and records the start frame. Returns `None` if nothing is recorded.
pub fn begin<R: Real>(
    simulation: &Simulation<R>,
    options: RecordOptions,
    out: &Path,
    scene: (&Path, &str),
) -> Result<Option<Recorder>> {
    let Moments::Of(detail) = options.moments else { return Ok(None) };
    let Channels { velocities, contacts, strain } = options.channels;
    let run = RunInfo {
        detail,
        velocities,
        contacts,
        strain,
        packing: if options.compact { Packing::Small } else { Packing::Fast },
        checkpoint: options.checkpoint,
        extra: options.facts,
        texture_coordinates: options.surface_data.texture_coordinates,
        face_sets: options.surface_data.face_sets,
        ..of_scene(simulation, scene)?
    };
    let objects = objects(simulation);
    files::make_folder_of(out)?;
    let recorder = match options.force {
        true => Recorder::replace(out, &run, objects),
        false => Recorder::create(out, &run, objects),
    };
    let mut recorder = recorder.map_err(with_options)?;
    recorder.record_start(simulation.state())?;
    if recorder.checkpoint_due() {
        recorder.record_checkpoint(&simulation.save())?;
    }
    Ok(Some(recorder))
}

/// An error of a recorder, with the options of the command that help.
pub fn with_options(error: RecordError) -> anyhow::Error {
    match error {
        RecordError::Exists { path } => {
            anyhow!("`{}` exists; `--force` replaces it, `-o` names another file", path.display())
        }
        RecordError::Unfinished { path } => anyhow!(
            "`{}` is left of a run that was killed; `nucleus recover {}` saves its frames, `--force` replaces it",
            path.display(),
            shell_word(&path)
        ),
        other => anyhow!(other),
    }
}

/// The facts about a run that follow from its scene. `scene` is its path and its text.
pub fn of_scene<R: Real>(simulation: &Simulation<R>, scene: (&Path, &str)) -> Result<RunInfo> {
    let program = simulation.program();
    let (start, end) = frames(program)?;
    let units = program.units_per_metre();
    let in_scene_units =
        |plane: GroundPlane| Plane { origin: (plane.origin * units).into(), normal: plane.normal.into() };
    let mut ground_motion: Vec<Plane> = program.ground_planes().into_iter().map(in_scene_units).collect();
    if ground_motion.windows(2).all(|pair| pair[0] == pair[1]) {
        ground_motion.clear();
    }
    Ok(RunInfo {
        scene_path: scene.0.display().to_string(),
        scene_text: scene.1.to_owned(),
        start,
        end,
        frames_per_second: program.time().fps,
        interval: interval(program)?,
        units_per_metre: units,
        ground: program.first_input().plane.map(in_scene_units),
        ground_motion,
        selections: program.nuclei().iter().flat_map(NucleusProgram::selections).map(selected).collect(),
        radii: simulation.objects().iter().filter_map(|o| Some((o.name.clone(), o.radius?))).collect(),
        rest_distances: simulation
            .objects()
            .iter()
            .filter_map(|o| Some((o.name.clone(), o.rest_distance?)))
            .collect(),
        surfaces: simulation.objects().iter().filter_map(surface).collect(),
        looks: program.has_looks(),
        rotation: program.has_rotation(),
        particles: program.has_individual_particles(),
        cameras: program.cameras().into_iter().map(camera).collect(),
        ..RunInfo::default()
    })
}

/// The name of a particle object and the shape of its surface, if it is not the default.
fn surface(object: &compile::Object) -> Option<(String, SurfaceShape)> {
    let [threshold, radius_scale] = object.surface.map(|x| x as f32);
    let shape = SurfaceShape { threshold, radius_scale };
    (object.radius.is_some() && shape != SurfaceShape::DEFAULT).then(|| (object.name.clone(), shape))
}

fn selected(selection: &compile::NamedSelection) -> SelectedPoints {
    let compile::NamedSelection { owner, object, points, .. } = selection.clone();
    SelectedPoints { owner, object, points }
}

/// A compiled camera as a camera of a cache.
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

/// Further facts about a run: its initial state, the setting that `--quality` selected, and the fingerprint of the program
/// that was `read`. Nothing that differs between two runs of a scene, such as the date or the number of threads, because
/// equal runs give equal bytes.
pub fn facts(
    from: Option<&InitialState>,
    setting: Option<Setting>,
    scalar: Scalar,
    read: &Program,
) -> Result<BTreeMap<String, String>> {
    let mut facts =
        BTreeMap::from([(SCALAR.to_owned(), scalar.to_string()), ("machine".to_owned(), machine())]);
    facts.extend(from.map(|from| (FROM.to_owned(), from.to_string())));
    if let Some(setting) = setting {
        facts.insert(SETTING.to_owned(), serde_json::to_string(&setting)?);
    }
    facts.insert(PROGRAM.to_owned(), fingerprint(read));
    Ok(facts)
}

/// The facts about a resumed run, whose scene may have `changed`.
pub fn facts_of(run: &RunInfo, changed: Option<String>) -> BTreeMap<String, String> {
    let mut facts = run.extra.clone();
    facts.extend(changed.map(|fingerprint| (PROGRAM.to_owned(), fingerprint)));
    facts
}

fn machine() -> String {
    format!("{} {}", std::env::consts::OS, std::env::consts::ARCH)
}

/// A hash of a compiled scene: nodes, values, connections, meshes and maps as they were read.
///
/// It does not depend on where the files are, on the frame range, the checks or the recorded channels.
pub fn fingerprint(program: &Program) -> String {
    let mut hash = Hash(Fingerprint::default());
    // Every derived field takes part. Writing to a hash cannot fail.
    let _ = write!(hash, "{:?}{:?}", program.nuclei(), program.graph());
    hash.0.name()
}

/// Hashes text as it is written.
struct Hash(Fingerprint);

impl Write for Hash {
    fn write_str(&mut self, text: &str) -> std::fmt::Result {
        self.0 = self.0.bytes(text.as_bytes());
        Ok(())
    }
}

/// Frames from one solved frame of a program to the next.
pub fn interval(program: &Program) -> Result<u32> {
    let frames = program.whole_frames();
    u32::try_from(frames).with_context(|| format!("`every: {frames}` is out of range"))
}

/// First and last frame of a program.
pub fn frames(program: &Program) -> Result<(i32, i32)> {
    let time = program.time();
    if time.end < time.start {
        bail!(
            "the run ends at frame {} before it starts at frame {}: correct `time` or `--frames`",
            time.end,
            time.start
        );
    }
    let frame = |frame: i64| i32::try_from(frame).with_context(|| format!("frame {frame} is out of range"));
    Ok((frame(time.start)?, frame(time.end)?))
}

/// Recorded objects with the objects of the solver that have their names.
pub fn sources<R: Real>(simulation: &Simulation<R>, objects: Vec<ObjectInfo>) -> Vec<(Source, ObjectInfo)> {
    let source = |recorded: &ObjectInfo| {
        let object = simulation.objects().iter().find(|object| object.name == recorded.name)?;
        Some(match object.kind {
            compile::ObjectKind::Cloth(id) => Source::Cloth(id),
            compile::ObjectKind::Collider(id) => Source::Collider(id),
        })
    };
    objects.into_iter().filter_map(|object| source(&object).map(|source| (source, object))).collect()
}

/// The objects of a simulation at its start frame, with rest positions in scene units.
pub fn objects<R: Real>(simulation: &Simulation<R>) -> Vec<(Source, ObjectInfo)> {
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
