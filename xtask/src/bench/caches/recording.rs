//! What recording costs a run: the processor time of the recorder beside that of the solver.

use std::time::Duration;

use anyhow::anyhow;
use nucleus_cache::{Detail, FrameRecorder, ObjectInfo, ObjectKind, Recorder, RunInfo, Source};
use nucleus_core::{Moment, StateView, StepObserver};
use nucleus_graph::Simulation;
use nucleus_graph::compile::{self, Program, compile};
use nucleus_graph::scene::read_scene_text;
use nucleus_measure::clock::Clock;

use super::{Table, figure};

/// A sheet of 129² points that falls on a ball, slips off and piles up on the floor.
const SCENE: &str = r#"Scene(time: (start: 1, end: 40, fps: 24), nodes: {
    "nucleus1": nucleus(usePlane: true, evaluations: 96),
    "sheet": polyPlane(width: 1.2, height: 1.2, subdivisions: (128, 128), translate: (0, 0.7, 0)),
    "cloth": nCloth(inputMesh: "sheet", pointMass: 0.2, thickness: 0.002, selfCollide: true, selfCollisionFlag: "Full Surface"),
    "sphere": polySphere(radius: 0.25, translate: (0, 0.4, 0)),
    "ball": nRigid(inputMesh: "sphere"),
})"#;
/// Frames that are run before, until the cloth meets itself, and frames that are measured.
const FRAMES: [i32; 2] = [16, 8];

/// What is recorded: its name, how finely, contacts, and strain with velocities.
const WAYS: [(&str, Detail, bool, bool); 3] = [
    ("frames, with contacts", Detail::Frames, true, false),
    ("substeps, with contacts", Detail::Substeps, true, false),
    ("substeps, with all there is", Detail::Substeps, true, true),
];

/// A recorder whose processor time is counted.
struct Timed<'a> {
    recorder: FrameRecorder<'a>,
    spent: &'a mut Duration,
}

impl StepObserver for Timed<'_> {
    fn substep(&mut self, moment: Moment, state: &dyn StateView) {
        let begin = now();
        self.recorder.substep(moment, state);
        *self.spent += now() - begin;
    }
}

fn now() -> Duration {
    Clock::Thread.read().unwrap_or_default()
}

/// The table of the page.
pub fn table() -> anyhow::Result<Table> {
    let text = SCENE;
    let (scene, _) = read_scene_text(text, "recorded.ron".as_ref()).map_err(|found| anyhow!("{found:?}"))?;
    let program = compile(&scene).map_err(|found| anyhow!("{found:?}"))?;
    let head = ["recorded", "solver, ms a frame", "recorder, ms a frame", "more", "kB a frame"];
    let mut table = Table::new("What recording costs", &head);
    for (name, detail, contacts, all) in WAYS {
        let [solver, recorder, bytes] = measure(&program, detail, contacts, all)?;
        let more = format!("{} %", figure(100.0 * recorder / solver));
        table.row([
            name.to_owned(),
            figure(1e3 * solver),
            figure(1e3 * recorder),
            more,
            figure(1e-3 * bytes),
        ]);
    }
    let [before, measured] = FRAMES;
    table.note(format!(
        "A sheet of 129² points that collides with itself, on a ball and the floor, 96 evaluations in 1/24 s; processor \
         time of one thread over frames {} to {}.",
        before + 2,
        1 + before + measured
    ));
    Ok(table)
}

/// Seconds a frame of the solver and of the recorder, and bytes a frame.
fn measure(program: &Program, detail: Detail, contacts: bool, all: bool) -> anyhow::Result<[f64; 3]> {
    let mut simulation = Simulation::new(program, 1);
    for _ in 0..FRAMES[0] {
        simulation.advance(&mut ());
    }
    let start = 1 + FRAMES[0];
    let run = RunInfo {
        start,
        end: start + FRAMES[1],
        detail,
        contacts,
        strain: all,
        velocities: all,
        ..RunInfo::default()
    };
    let folder = tempfile::tempdir()?;
    let mut recorder = Recorder::create(folder.path().join("run.mcap"), &run, objects(&simulation))?;
    recorder.record_start(simulation.state())?;
    let (mut spent, begin) = (Duration::ZERO, now());
    for frame in start + 1..=run.end {
        let report = simulation.advance(&mut Timed { recorder: recorder.frame(frame)?, spent: &mut spent });
        let told = serde_json::json!({ "max_strain": report.report.max_strain });
        let begin = now();
        recorder.end_frame(&told)?;
        spent += now() - begin;
    }
    let (whole, bytes) = (now() - begin, recorder.finish()?.bytes);
    let each = f64::from(FRAMES[1]);
    Ok([(whole - spent).as_secs_f64() / each, spent.as_secs_f64() / each, bytes as f64 / each])
}

fn objects(simulation: &Simulation) -> Vec<(Source, ObjectInfo)> {
    let object = |object: &compile::Object| {
        let mut rest = Vec::new();
        let (source, kind) = match object.kind {
            compile::ObjectKind::Cloth(id) => {
                simulation.state().positions(id, 1.0, &mut rest);
                (Source::Cloth(id), ObjectKind::Cloth)
            }
            compile::ObjectKind::Collider(id) => {
                simulation.state().collider_positions(id, 1.0, &mut rest);
                (Source::Collider(id), ObjectKind::Collider)
            }
        };
        (source, ObjectInfo { name: object.name.clone(), kind, faces: object.faces.clone(), rest })
    };
    simulation.objects().iter().map(object).collect()
}
