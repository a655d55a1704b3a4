//! The command, a small cache and a small scene.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use nalgebra::Vector3;
use nucleus_cache::{ObjectInfo, ObjectKind, Recorder, RunInfo, Source};
use nucleus_core::{
    Cloth, ClothFrame, ClothLists, Faces, FrameInput, Mass, ModelBuilder, ResistanceModel, Solver, Surface,
};
use tempfile::TempDir;

pub const END: i32 = 6;

/// A temporary folder that is removed with the test.
pub fn folder() -> TempDir {
    tempfile::tempdir().unwrap()
}

/// `nucleus` with these arguments, run in `folder`.
pub fn nucleus(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_nucleus")).args(arguments).current_dir(folder).output().unwrap()
}

pub fn stdout(output: &Output) -> String {
    String::from_utf8(output.stdout.clone()).unwrap()
}

pub fn stderr(output: &Output) -> String {
    String::from_utf8(output.stderr.clone()).unwrap()
}

/// Asserts that a command could not start, with these words in its error.
pub fn assert_refused(output: &Output, words: &str) {
    let said = stderr(output);
    assert_eq!(output.status.code(), Some(2), "{said}");
    assert!(said.starts_with("error: ") && said.contains(words), "{said}");
}

/// A cache of a falling square with sides of 1 m, frames 1 to [`END`], in centimetres.
pub fn cache(folder: &Path) -> PathBuf {
    let path = folder.join("fall.mcap");
    let mut faces = Faces::default();
    faces.push(&[0, 1, 2, 3]);
    let corners = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    let positions: Vec<_> = corners.iter().map(|[x, z]| Vector3::new(*x, 2.0, *z)).collect();
    let rest = positions.iter().map(|p| [p.x, p.y, p.z].map(|x| 100.0 * x as f32)).collect();
    let mut builder = ModelBuilder::new();
    let surface = Surface { positions, faces: faces.clone() };
    let cloth = builder.cloth(Cloth::new(surface, Mass::PerPoint(1.0), ClothLists::NONE)).unwrap();
    let mut solver: Solver = Solver::new(builder, 1);

    let object = ObjectInfo { name: "sheet".to_owned(), kind: ObjectKind::Cloth, faces, rest };
    let run =
        RunInfo { scene_path: "fall.ron".to_owned(), end: END, units_per_metre: 100.0, ..RunInfo::default() };
    let mut recorder = Recorder::create(&path, &run, vec![(Source::Cloth(cloth), object)]).unwrap();
    recorder.record_start(&solver).unwrap();
    for frame in 2..=END {
        solver.step(&input(), &mut recorder.frame(frame).unwrap());
        recorder.end_frame(&serde_json::json!({ "max_strain": 0.0 })).unwrap();
    }
    recorder.finish().unwrap();
    path
}

fn input() -> FrameInput {
    FrameInput {
        duration: 1.0 / 24.0,
        substeps: 2,
        collision_iterations: 1.0,
        resistance: ResistanceModel::Classic,
        gravity: Vector3::new(0.0, -9.8, 0.0),
        wind: Vector3::zeros(),
        air_density: 0.0,
        plane: None,
        layer_range: 4.0,
        self_collision_iterations: 4.0,
        cloths: vec![ClothFrame::default()],
        colliders: Vec::new(),
        pins: Vec::new(),
        ..FrameInput::default()
    }
}

/// Writes `drape.ron`, a sheet that falls on a ball.
pub fn scene(folder: &Path, frames: u32, checks: &str) {
    let text = format!(
        r#"Scene(
    time: (start: 1, end: {frames}, fps: 24),
    nodes: {{
        "nucleus1": nucleus(spaceScale: 0.01, subSteps: 2),
        "sheet": polyPlane(width: 50, height: 50, subdivisions: (6, 6), translate: (0, 25, 0)),
        "cloth1": nCloth(inputMesh: "sheet", thickness: 1),
        "ball": polySphere(radius: 20),
        "rigid1": nRigid(inputMesh: "ball"),
    }},
    checks: [{checks}],
)
"#
    );
    std::fs::write(folder.join("drape.ron"), text).unwrap();
}
