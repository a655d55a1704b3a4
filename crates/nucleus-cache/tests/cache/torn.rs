//! A run for the tests in which the falling cloth tears twice; each tear gives it a mesh with one more point.

use std::io::{Seek, Write};

use nalgebra::Vector3;
use nucleus_cache::{Detail, ObjectInfo, RecordError, Recorder, RunInfo};
use nucleus_core::{ClothId, ColliderId, ContactState, Faces, StateView, StepObserver, SubstepIndex};

use crate::falling::{self, Falling, START, SUBSTEPS, Shared};

/// Frame and substep of the tears.
const TEARS: [(i32, u32); 2] = [(START + 3, 2), (START + 5, 1)];
pub const CLOTH: &str = "a|b:cloth/1 \u{e4}";
/// Frame of the checkpoint that a run resumes from.
pub const CHECKPOINT: i32 = START + 3;

/// Number of tears by the end of a substep.
pub fn tears(frame: i32, substep: u32) -> usize {
    TEARS.iter().filter(|&&tear| tear <= (frame, substep)).count()
}

/// The cloth after `tears` tears: each adds a point and changes the faces.
pub fn torn(tears: usize) -> ObjectInfo {
    let mut cloth = falling::objects()[0].1.clone();
    cloth.faces = match tears {
        0 => Faces::from_iter([&[0_u32, 1, 2, 3][..]]),
        1 => Faces::from_iter([&[0_u32, 1, 2][..], &[0, 4, 3]]),
        _ => Faces::from_iter([&[5_u32, 1, 2][..], &[0, 4, 3]]),
    };
    cloth.rest = (0..4 + tears).map(|k| [k as f32, 0.0, 0.0]).collect();
    cloth
}

struct Torn(Falling);

impl Torn {
    fn points(&self) -> usize {
        4 + if self.0.frame == START { 0 } else { tears(self.0.frame, self.0.substep) }
    }
}

impl StateView for Torn {
    fn positions(&self, _: ClothId, units: f64, out: &mut Vec<[f32; 3]>) {
        out.clear();
        out.extend((0..self.points()).map(|k| [k as f32, self.0.height(), 0.25].map(|x| x * units as f32)));
    }
    fn velocities(&self, _: ClothId, _: f64, out: &mut Vec<[f32; 3]>) {
        *out = vec![[0.0, -1.0, 0.0]; self.points()];
    }
    fn contacts(&self, out: &mut Vec<Vec<ContactState>>) {
        *out = vec![vec![ContactState::Compressed; self.points()]];
    }
    fn collider_positions(&self, collider: ColliderId, units: f64, out: &mut Vec<[f32; 3]>) {
        self.0.collider_positions(collider, units, out);
    }
    fn collider_moved(&self, collider: ColliderId) -> bool {
        self.0.collider_moved(collider)
    }
    fn point(&self, _: ClothId, _: usize) -> Vector3<f64> {
        Vector3::zeros()
    }
}

/// Records the frames after `from`.
pub fn record<W: Write + Seek>(recorder: &mut Recorder<W>, from: i32, last: i32) -> Result<(), RecordError> {
    for frame in from + 1..=last {
        let mut observer = recorder.frame(frame)?;
        for substep in 1..=SUBSTEPS {
            let sample = SubstepIndex { substep, substeps: SUBSTEPS };
            if TEARS.contains(&(frame, substep)) {
                let ObjectInfo { faces, rest, .. } = torn(tears(frame, substep));
                observer.change_mesh(sample, CLOTH, faces, rest);
            }
            observer.substep(sample, &Torn(Falling { frame, substep }));
        }
        recorder.end_frame(&())?;
        if frame == CHECKPOINT {
            recorder.record_checkpoint(&falling::state_bytes(frame))?;
        }
    }
    Ok(())
}

/// All attributes, and a checkpoint at [`CHECKPOINT`].
pub fn run_info(detail: Detail) -> RunInfo {
    RunInfo { detail, checkpoint: (CHECKPOINT - START) as u32, ..falling::with_all_channels() }
}

/// A run in memory, up to frame `last`.
pub fn recorded(run: &RunInfo, last: i32) -> Vec<u8> {
    let file = Shared::default();
    let mut recorder = Recorder::to_writer(file.clone(), run, falling::objects()).unwrap();
    recorder.record_start(&Torn(Falling::INITIAL)).unwrap();
    recorder.record_checkpoint(&[]).unwrap();
    record(&mut recorder, START, last).unwrap();
    recorder.finish().unwrap();
    file.contents()
}
