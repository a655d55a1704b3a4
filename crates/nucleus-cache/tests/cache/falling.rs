//! A run for the tests: a falling cloth of four points, and a collider that moves in one frame.

use std::io::{Read, Seek, SeekFrom, Write};
use std::sync::{Arc, Mutex};

use nalgebra::Vector3;
use nucleus_cache::{
    Camera, CameraView, Detail, FilmFit, ObjectInfo, ObjectKind, RecordError, Recorded, Recorder, RunInfo,
    Source,
};
use nucleus_core::{ClothId, ColliderId, ContactState, Faces, StateView, StepObserver, SubstepIndex};

pub const START: i32 = 10;
pub const END: i32 = 18;
pub const SUBSTEPS: u32 = 3;
/// The collider moves in this frame and in no other.
pub const SHOVE: i32 = 13;

/// The end of a substep. Positions are a formula of it, so that tests can compute every recorded number.
#[derive(Clone, Copy)]
pub struct Falling {
    pub frame: i32,
    pub substep: u32,
}

impl Falling {
    /// Substep 0 of the start frame.
    pub const INITIAL: Self = Self { frame: START, substep: SUBSTEPS };

    /// Height of the cloth in metres.
    pub fn height(self) -> f32 {
        let frames = (self.frame - START - 1) as f32 + self.substep as f32 / SUBSTEPS as f32;
        10.0 - frames * frames
    }

    /// Positions of the cloth as recorded.
    pub fn cloth_positions(self, units: f64) -> Vec<[f32; 3]> {
        let mut out = Vec::new();
        self.positions(ClothId(0), units, &mut out);
        out
    }
}

impl StateView for Falling {
    fn object_counts(&self) -> Option<[usize; 2]> {
        Some([1, 1])
    }
    fn positions(&self, _: ClothId, units: f64, out: &mut Vec<[f32; 3]>) {
        out.clear();
        out.extend((0..4).map(|k| [k as f32, self.height(), 0.25].map(|x| x * units as f32)));
    }
    fn velocities(&self, _: ClothId, units: f64, out: &mut Vec<[f32; 3]>) {
        out.clear();
        out.extend((0..4).map(|k| [0.0, -(self.frame as f32), k as f32].map(|x| x * units as f32)));
    }
    fn contacts(&self, out: &mut Vec<Vec<ContactState>>) {
        let first = if self.frame >= SHOVE { ContactState::Depenetrating } else { ContactState::Free };
        *out =
            vec![vec![first, ContactState::Touching, ContactState::Compressed, ContactState::Intersecting]];
    }
    fn collider_positions(&self, _: ColliderId, units: f64, out: &mut Vec<[f32; 3]>) {
        let shoved = if self.frame >= SHOVE { 1.0 } else { 0.0 };
        out.clear();
        out.extend((0..3).map(|k| [k as f32 + shoved, -1.0, 0.0].map(|x| x * units as f32)));
    }
    fn collider_moved(&self, _: ColliderId) -> bool {
        self.frame == SHOVE
    }
    fn point(&self, _: ClothId, _: usize) -> Vector3<f64> {
        Vector3::zeros()
    }
}

/// Metadata of the run.
pub fn run_info() -> RunInfo {
    RunInfo {
        scene_path: "scenes/falling.ron".to_owned(),
        scene_text: "Scene()".to_owned(),
        start: START,
        end: END,
        units_per_metre: 100.0,
        ..RunInfo::default()
    }
}

/// The same, with all attributes of cloth.
pub fn with_all_channels() -> RunInfo {
    let views = (0..3).map(|k| CameraView { eye: [k as f32; 3], ..CameraView::default() }).collect();
    let camera = Camera { name: "shot".to_owned(), fit: FilmFit::Fill, views };
    RunInfo { contacts: true, strain: true, cameras: vec![camera], checkpoint: 3, ..with_substeps() }
}

/// The objects of the run. One name has unusual characters.
pub fn objects() -> Vec<(Source, ObjectInfo)> {
    let mut quad = Faces::default();
    quad.push(&[0, 1, 2, 3]);
    let mut triangle = Faces::default();
    triangle.push(&[0, 1, 2]);
    let cloth = ObjectInfo {
        name: "a|b:cloth/1 \u{e4}".to_owned(),
        kind: ObjectKind::Cloth,
        faces: quad,
        rest: (0..4).map(|k| [k as f32, 0.0, 0.0]).collect(),
    };
    let collider = ObjectInfo {
        name: "floor".to_owned(),
        kind: ObjectKind::Collider,
        faces: triangle,
        rest: (0..3).map(|k| [k as f32, -1.0, 0.0]).collect(),
    };
    vec![(Source::Cloth(ClothId(0)), cloth), (Source::Collider(ColliderId(0)), collider)]
}

/// Records the initial state and the frames up to `last`, with all due checkpoints; the caller finishes the file.
pub fn record<W: Write + Seek>(recorder: &mut Recorder<W>, last: i32) -> Result<(), RecordError> {
    record_frames(recorder, START + 1..=last)
}

/// The same for these frames only.
pub fn record_frames<W: Write + Seek>(
    recorder: &mut Recorder<W>,
    frames: impl IntoIterator<Item = i32>,
) -> Result<(), RecordError> {
    recorder.record_start(&Falling::INITIAL)?;
    checkpoint(recorder, START)?;
    for frame in frames {
        let mut observer = recorder.frame(frame)?;
        for substep in 1..=SUBSTEPS {
            observer.substep(SubstepIndex { substep, substeps: SUBSTEPS }, &Falling { frame, substep });
        }
        recorder.end_frame(&serde_json::json!({ "max_strain": 0.5, "min_gap": f64::INFINITY }))?;
        checkpoint(recorder, frame)?;
    }
    Ok(())
}

fn checkpoint<W: Write + Seek>(recorder: &mut Recorder<W>, frame: i32) -> Result<(), RecordError> {
    match recorder.checkpoint_due() {
        true => recorder.record_checkpoint(&state_bytes(frame)),
        false => Ok(()),
    }
}

/// Stands for the state of a solver in a checkpoint.
pub fn state_bytes(frame: i32) -> Vec<u8> {
    frame.to_le_bytes().repeat(100)
}

/// A whole run in memory.
pub fn whole_run(run: &RunInfo) -> (Vec<u8>, Recorded) {
    let file = Shared::default();
    let mut recorder = Recorder::to_writer(file.clone(), run, objects()).unwrap();
    record(&mut recorder, run.end).unwrap();
    let recorded = recorder.finish().unwrap();
    (file.contents(), recorded)
}

/// The same cache with all redundant copies damaged, like one of a version without them.
pub fn without_copies(bytes: &[u8]) -> Vec<u8> {
    let mut bytes = bytes.to_vec();
    for copy in mcap::Summary::read(&bytes).unwrap().unwrap().attachment_indexes {
        bytes[(copy.offset + copy.length) as usize - 1] ^= 0x55;
    }
    bytes
}

/// The same, with every substep.
pub fn with_substeps() -> RunInfo {
    RunInfo { detail: Detail::Substeps, velocities: true, ..run_info() }
}

/// A file in memory that can be inspected while it is written, with space for `room` bytes.
#[derive(Clone)]
pub struct Shared {
    cursor: Arc<Mutex<std::io::Cursor<Vec<u8>>>>,
    room: u64,
}

impl Default for Shared {
    fn default() -> Self {
        Self::with_room(u64::MAX)
    }
}

impl Shared {
    pub fn with_room(room: u64) -> Self {
        Self { cursor: Arc::default(), room }
    }

    pub fn contents(&self) -> Vec<u8> {
        self.cursor.lock().unwrap().get_ref().clone()
    }
}

impl Write for Shared {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        let mut cursor = self.cursor.lock().unwrap();
        let room = self.room.saturating_sub(cursor.position()) as usize;
        if room == 0 && !bytes.is_empty() {
            return Err(std::io::ErrorKind::StorageFull.into());
        }
        cursor.write(&bytes[..bytes.len().min(room)])
    }
    fn flush(&mut self) -> std::io::Result<()> {
        Ok(())
    }
}

impl Read for Shared {
    fn read(&mut self, bytes: &mut [u8]) -> std::io::Result<usize> {
        self.cursor.lock().unwrap().read(bytes)
    }
}

impl Seek for Shared {
    fn seek(&mut self, to: SeekFrom) -> std::io::Result<u64> {
        self.cursor.lock().unwrap().seek(to)
    }
}
