//! Cost of recording: processor time of the recorder relative to the solver, and of checkpoints.

use std::path::Path;
use std::time::Duration;

use anyhow::anyhow;
use nucleus_cache::{Detail, FrameRecorder, ObjectInfo, ObjectKind, Recorder, RunInfo, Source};
use nucleus_core::{StateView, StepObserver, SubstepIndex};
use nucleus_graph::Simulation;
use nucleus_graph::compile::{self, compile};
use nucleus_graph::scene::read_scene_text;
use nucleus_measure::clock::Clock;

use super::target::Target;
use crate::bench::table::{Table, figure};

/// A sheet of 129² points that falls on a ball, slips off and piles up on the floor.
const SCENE: &str = r#"Scene(time: (start: 1, end: 40, fps: 24), nodes: {
    "nucleus1": nucleus(usePlane: true, evaluations: 96),
    "sheet": polyPlane(width: 1.2, height: 1.2, subdivisions: (128, 128), translate: (0, 0.7, 0)),
    "cloth": nCloth(inputMesh: "sheet", pointMass: 0.2, thickness: 0.002, selfCollide: true, selfCollisionFlag: "Full Surface"),
    "sphere": polySphere(radius: 0.25, translate: (0, 0.4, 0)),
    "ball": nRigid(inputMesh: "sphere"),
})"#;
/// Frames before the measurement, until self-contact starts, and measured frames.
const FRAMES: [i32; 2] = [16, 8];

/// Recording modes: name, detail, contacts, strain and velocities.
const MODES: [(&str, Detail, bool, bool); 3] = [
    ("frames, with contacts", Detail::Frames, true, false),
    ("substeps, with contacts", Detail::Substeps, true, false),
    ("substeps, with all data", Detail::Substeps, true, true),
];

/// A recording mode and its cost so far.
struct Mode {
    name: &'static str,
    detail: Detail,
    recorder: Recorder,
    spent: Duration,
}

/// Passes a frame to all recorders and sums the processor time of each.
struct Timed<'a>(Vec<(FrameRecorder<'a>, &'a mut Duration)>);

impl StepObserver for Timed<'_> {
    fn substep(&mut self, moment: SubstepIndex, state: &dyn StateView) {
        for (recorder, spent) in &mut self.0 {
            let begin = now();
            recorder.substep(moment, state);
            **spent += now() - begin;
        }
    }
}

fn now() -> Duration {
    Clock::Thread.read().unwrap_or_default()
}

/// Limit of the cost of recording every substep, in percent of the solver's time.
const MOST: f64 = 10.0;
/// Default interval of checkpoints, in frames.
const PERIOD: f64 = 48.0;

/// The tables of the page, and the targets. One run is recorded in all modes at once.
pub fn tables() -> anyhow::Result<[(Table, Vec<Target>); 2]> {
    let (scene, _) = read_scene_text(SCENE, "recorded.ron".as_ref()).map_err(|value| anyhow!("{value:?}"))?;
    let program = compile(&scene).map_err(|value| anyhow!("{value:?}"))?;
    let mut simulation = Simulation::new(&program, 1);
    for _ in 0..FRAMES[0] {
        simulation.advance(&mut ());
    }
    let folder = tempfile::tempdir()?;
    let mut modes = begin(&simulation, folder.path())?;
    let start = now();
    for frame in 1..=FRAMES[1] {
        let recorders: Result<Vec<_>, _> = modes
            .iter_mut()
            .map(|mode| {
                mode.recorder.frame(1 + FRAMES[0] + frame).map(|recorder| (recorder, &mut mode.spent))
            })
            .collect();
        let report = simulation.advance(&mut Timed(recorders?));
        let summary = serde_json::json!({ "max_strain": report.report.max_strain });
        for mode in &mut modes {
            let begin = now();
            mode.recorder.end_frame(&summary)?;
            mode.spent += now() - begin;
        }
    }
    let spent: Duration = modes.iter().map(|mode| mode.spent).sum();
    let solver = (now() - start - spent).as_secs_f64() / f64::from(FRAMES[1]);
    Ok([costs(modes, solver)?, checkpoint(&simulation, solver)?])
}

/// A recorder for each mode, with the start recorded.
fn begin(simulation: &Simulation, folder: &Path) -> anyhow::Result<Vec<Mode>> {
    let start = 1 + FRAMES[0];
    let mode = |(name, detail, contacts, all): (&'static str, Detail, bool, bool)| {
        let end = start + FRAMES[1];
        let run =
            RunInfo { start, end, detail, contacts, strain: all, velocities: all, ..RunInfo::default() };
        let mut recorder = Recorder::create(folder.join(name), &run, objects(simulation))?;
        recorder.record_start(simulation.state())?;
        Ok(Mode { name, detail, recorder, spent: Duration::ZERO })
    };
    MODES.into_iter().map(mode).collect()
}

fn costs(modes: Vec<Mode>, solver: f64) -> anyhow::Result<(Table, Vec<Target>)> {
    let head = ["recorded", "solver, ms per frame", "recorder, ms per frame", "more", "kB per frame"];
    let mut table = Table::new("What recording costs", &head);
    let mut targets = Vec::new();
    let frames = f64::from(FRAMES[1]);
    for Mode { name, detail, recorder, spent } in modes {
        let (spent, bytes) = (spent.as_secs_f64() / frames, recorder.finish()?.bytes as f64 / frames);
        let share = 100.0 * spent / solver;
        if detail == Detail::Substeps {
            targets.push(Target::below(&format!("recording {name}, % of a run of 129²"), MOST, share));
        }
        let more = format!("{} %", figure(share));
        let [solver, spent, bytes] = [1e3 * solver, 1e3 * spent, 1e-3 * bytes].map(figure);
        table.row([name.to_owned(), solver, spent, more, bytes]);
    }
    table.note(format!(
        "A sheet of 129² points that collides with itself, on a ball and the floor, 96 evaluations in 1/24 s; processor \
         time of one thread over frames {} to {}.",
        FRAMES[0] + 2,
        1 + FRAMES[0] + FRAMES[1]
    ));
    Ok((table, targets))
}

/// Cost of a checkpoint of the same run.
fn checkpoint(simulation: &Simulation, solver: f64) -> anyhow::Result<(Table, Vec<Target>)> {
    let start = 1 + FRAMES[0] + FRAMES[1];
    let run = RunInfo { start, end: start + 1, checkpoint: 1, ..RunInfo::default() };
    let folder = tempfile::tempdir()?;
    let path = folder.path().join("run.mcap");
    let mut recorder = Recorder::create(&path, &run, objects(simulation))?;
    recorder.record_start(simulation.state())?;
    let length = || std::fs::metadata(nucleus_cache::part_path(&path)).map(|value| value.len());
    let (before, begin) = (length()?, now());
    let state = simulation.save();
    let saved = now() - begin;
    recorder.record_checkpoint(&state)?;
    let written = now() - begin - saved;
    let (packed, each) = (length()? - before, (saved + written).as_secs_f64() / PERIOD);
    let [saved, written] = [saved, written].map(|time| 1e3 * time.as_secs_f64());
    let head =
        ["gathered, ms", "packed and written, ms", "MB", "packed, MB", "ms per frame at one in 48", "more"];
    let mut table = Table::new("What a checkpoint costs", &head);
    let figures = [saved, written, 1e-6 * state.len() as f64, 1e-6 * packed as f64, 1e3 * each];
    table.row(figures.map(figure).into_iter().chain([format!("{} %", figure(100.0 * each / solver))]));
    table.note(format!("The same sheet after frame {start}; `nucleus resume` continues from a checkpoint."));
    Ok((table, Vec::new()))
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
