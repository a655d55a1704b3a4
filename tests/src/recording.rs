//! Runs that are recorded into memory.

use std::io::Cursor;

use nucleus_cache::{Detail, ObjectInfo, ObjectKind, Playback, Recorder, RunInfo, Source};
use nucleus_core::StepReport;
use nucleus_graph::Simulation;
use nucleus_graph::compile::{self, Program};

/// A run and its cache.
pub struct Recording {
    /// The simulation at the last recorded frame.
    pub simulation: Simulation,
    /// The bytes of the cache.
    pub cache: Vec<u8>,
    /// The report of each frame after the first.
    pub reports: Vec<StepReport>,
}

impl Recording {
    /// Opens the cache.
    pub fn play(&self) -> Playback<Cursor<&[u8]>> {
        Playback::read(Cursor::new(self.cache.as_slice())).expect("the cache can be opened")
    }
}

/// Runs a program for `frames` frames after its first.
pub fn record(program: &Program, frames: i32, threads: usize, detail: Detail) -> Recording {
    let mut simulation = Simulation::new(program, threads);
    let start = program.time().start as i32;
    let run = RunInfo {
        start,
        end: start + frames,
        frames_per_second: program.time().fps,
        units_per_metre: program.units_per_metre(),
        detail,
        particles: program.has_individual_particles(),
        ..RunInfo::default()
    };
    let mut cache = Vec::new();
    let mut reports = Vec::new();
    let target = Cursor::new(&mut cache);
    let mut recorder = Recorder::to_writer(target, &run, objects(&simulation)).expect("it can be recorded");
    recorder.record_start(simulation.state()).expect("it can be recorded");
    for frame in start + 1..=start + frames {
        let mut observer = recorder.frame(frame).expect("it can be recorded");
        let report = simulation.advance(&mut observer).report;
        recorder.end_frame(&report.max_strain).expect("it can be recorded");
        reports.push(report);
    }
    recorder.finish().expect("it can be recorded");
    Recording { simulation, cache, reports }
}

fn objects(simulation: &Simulation) -> Vec<(Source, ObjectInfo)> {
    let (state, units) = (simulation.state(), simulation.units_per_metre());
    let object = |object: &compile::Object| {
        let mut rest = Vec::new();
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
