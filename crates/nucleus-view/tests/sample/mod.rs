//! A small synthetic run: a waving flag of cloth, a ball that starts to roll later, and a static cube.

#![allow(dead_code)] // each test needs a part of it

use std::f32::consts::{PI, TAU};
use std::path::Path;

use nalgebra::Vector3;
use nucleus_cache::{
    Camera, CameraView, Detail, FilmFit, ObjectInfo, ObjectKind, Plane, Recorded, Recorder, RunInfo,
    SelectedPoints, Source,
};
use nucleus_core::{
    ClothId, ColliderId, ContactState, Faces, ParticleLook, StateView, StepObserver, StepReport, SubstepIndex,
};

pub const FRAMES: i32 = 24;
/// The first frame in which the ball has moved.
pub const ROLLS: i32 = 10;
/// Points along a side of the cloth.
const SIDE: u32 = 33;
const BALL: ColliderId = ColliderId(0);
const DUST: ClothId = ClothId(1);
const SUBSTEPS: u32 = 4;

/// Variants of the run.
#[derive(Debug, Clone, Copy, Default)]
pub struct Sample {
    /// Substeps are recorded.
    pub substeps: bool,
    /// From the middle of the run on, one point in fifty is not a number.
    pub broken: bool,
    /// The flag is one frame late.
    pub late: bool,
    /// Contact states are recorded: the hoist of the flag is touching, its first corner is intersecting.
    pub contacts: bool,
    /// The scene has a camera that approaches.
    pub camera: bool,
    /// In the middle of the run the flag loses the faces of its free half.
    pub torn: bool,
    /// A constraint names the points of the hoist of the flag.
    pub selected: bool,
    /// Height of a ground plane.
    pub plane: Option<f64>,
    /// The X component of its normal, whose Y component is 1.
    pub tilt: f64,
    /// The plane rises by this in each frame.
    pub rise: f64,
    /// Particles beside the flag, green and half transparent.
    pub dust: bool,
    /// They move by 0.05 along X in each frame.
    pub blown: bool,
    /// There is no flag.
    pub bare: bool,
    /// Only every such frame is recorded, and the last one; 0 is every frame.
    pub every: u32,
    /// Frames per second; 0 is 24.
    pub fps: u32,
}

fn hoist() -> SelectedPoints {
    let points = (0..SIDE).map(|row| row * SIDE).collect();
    SelectedPoints { owner: "hoist".to_owned(), object: "flag".to_owned(), points }
}

/// Writes the run as a cache of the frames 1 to [`FRAMES`].
pub fn write(path: &Path, sample: Sample) -> Recorded {
    let mut recorder = begin(path, sample);
    for frame in 2..=FRAMES {
        step(&mut recorder, sample, frame);
    }
    recorder.finish().unwrap()
}

/// Starts a recording and records the start.
pub fn begin(path: &Path, sample: Sample) -> Recorder {
    let run = RunInfo {
        scene_path: "scenes/sample.ron".into(),
        end: FRAMES,
        contacts: sample.contacts,
        looks: sample.dust,
        radii: sample.dust.then(|| ("dust".to_owned(), 0.1)).into_iter().collect(),
        selections: if sample.selected { vec![hoist()] } else { Vec::new() },
        ground: sample.plane.map(|y| plane(y, sample.tilt)),
        ground_motion: match sample.plane.filter(|_| sample.rise != 0.0) {
            Some(y) => {
                (0..FRAMES).map(|frame| plane(y + sample.rise * f64::from(frame), sample.tilt)).collect()
            }
            None => Vec::new(),
        },
        detail: match (sample.substeps, sample.every) {
            (true, _) => Detail::Substeps,
            (_, 0) => Detail::Frames,
            (_, every) => Detail::Every(every),
        },
        frames_per_second: f64::from(if sample.fps == 0 { 24 } else { sample.fps }),
        ..RunInfo::default()
    };
    let run = RunInfo { cameras: sample.camera.then(camera).into_iter().collect(), ..run };
    let mut recorder = Recorder::create(path, &run, objects(sample)).unwrap();
    recorder.record_start(&State { time: 0.0, frame: 1, broken: false, blown: sample.blown }).unwrap();
    recorder
}

fn plane(y: f64, tilt: f64) -> Plane {
    Plane { origin: [0.0, y, 0.0], normal: [tilt, 1.0, 0.0] }
}

/// A camera that approaches the flag.
fn camera() -> Camera {
    let view = |frame: i32| CameraView {
        eye: [1.0, 1.3, 9.0 - 0.3 * frame as f32],
        forward: [0.0, 0.0, -1.0],
        up: [0.0, 1.0, 0.0],
        focal_length: 35.0,
        film: [1.41732, 0.94488],
        interest: 5.0,
    };
    Camera { name: "close".into(), fit: FilmFit::Fill, views: (1..=FRAMES).map(view).collect() }
}

/// Records one frame.
pub fn step(recorder: &mut Recorder, sample: Sample, frame: i32) {
    let mut watching = recorder.frame(frame).unwrap();
    for substep in 1..=SUBSTEPS {
        let time = (frame - 2) as f32 + substep as f32 / SUBSTEPS as f32;
        let time = if sample.late { time - 1.0 } else { time };
        let broken = sample.broken && frame > FRAMES / 2;
        let moment = SubstepIndex { substep, substeps: SUBSTEPS };
        if sample.torn && (frame, substep) == (FRAMES / 2, 1) {
            watching.change_mesh(moment, "flag", half_grid(), rest());
        }
        watching.substep(moment, &State { time, frame, broken, blown: sample.blown });
    }
    let report = StepReport { max_strain: 0.0123, min_gap: 0.98, contacts: 4321, ..StepReport::default() };
    let report = [("max_strain", report.max_strain), ("min_gap", report.min_gap), ("contacts", 4321.0)];
    recorder.end_frame(&std::collections::BTreeMap::from(report)).unwrap();
}

struct State {
    /// Frames since the start.
    time: f32,
    frame: i32,
    broken: bool,
    blown: bool,
}

impl StateView for State {
    fn positions(&self, cloth: ClothId, _: f64, out: &mut Vec<[f32; 3]>) {
        if cloth == DUST {
            *out = dust();
            let moved = if self.blown { 0.05 * self.time } else { 0.0 };
            out.iter_mut().for_each(|point| point[0] += moved);
            return;
        }
        *out = flag(self.time);
        if self.broken {
            out.iter_mut().step_by(50).for_each(|point| point[1] = f32::NAN);
        }
    }
    fn looks(&self, cloth: ClothId, out: &mut Vec<ParticleLook>) {
        let look =
            ParticleLook { radius: 2.0, opacity: 0.5, color: Some([0.0, 0.8, 0.0]), incandescence: [0.0; 3] };
        out.clear();
        out.resize(if cloth == DUST { dust().len() } else { 0 }, look);
    }
    fn velocities(&self, _: ClothId, _: f64, _: &mut Vec<[f32; 3]>) {}
    fn contacts(&self, out: &mut Vec<Vec<ContactState>>) {
        let at_hoist = |k: u32| if k % SIDE < SIDE / 2 { ContactState::Touching } else { ContactState::Free };
        *out = vec![(0..SIDE * SIDE).map(at_hoist).collect(), vec![ContactState::Touching; dust().len()]];
        out[0][0] = ContactState::Intersecting;
    }
    fn collider_positions(&self, collider: ColliderId, _: f64, out: &mut Vec<[f32; 3]>) {
        *out = if collider == BALL { sphere().1 } else { cube().1 };
        if collider == BALL {
            out.iter_mut().for_each(|point| point[0] += (self.time - (ROLLS - 2) as f32).max(0.0) * 0.04);
        }
    }
    fn collider_moved(&self, collider: ColliderId) -> bool {
        collider == BALL && self.frame >= ROLLS
    }
    fn point(&self, _: ClothId, _: usize) -> Vector3<f64> {
        Vector3::zeros()
    }
}

fn objects(sample: Sample) -> Vec<(Source, ObjectInfo)> {
    let [(sphere, at_start), (cube, corners)] = [sphere(), cube()];
    let (cloth, collider) = (ObjectKind::Cloth, ObjectKind::Collider);
    let object = |name: &str, kind, faces, rest| ObjectInfo { name: name.into(), kind, faces, rest };
    let particles = object("dust", ObjectKind::Particles, Faces::default(), dust());
    let flag = (Source::Cloth(ClothId(0)), object("flag", cloth, grid(), rest()));
    let colliders = [
        (Source::Collider(BALL), object("ball", collider, sphere, at_start)),
        (Source::Collider(ColliderId(1)), object("cube", collider, cube, corners)),
    ];
    let dust = sample.dust.then_some((Source::Cloth(DUST), particles));
    let flag = (!sample.bare).then_some(flag);
    flag.into_iter().chain(dust).chain(colliders).collect()
}

fn dust() -> Vec<[f32; 3]> {
    (0..4u8).map(|k| [0.2 + 0.6 * f32::from(k), 2.5, 0.4]).collect()
}

fn rest() -> Vec<[f32; 3]> {
    sheet(|x, y| [x, y, 0.0])
}

/// The faces of the half at the hoist.
fn half_grid() -> Faces {
    grid().iter().filter(|face| face[0] % SIDE < SIDE / 2).collect()
}

fn flag(time: f32) -> Vec<[f32; 3]> {
    sheet(|x, y| {
        let wave = 0.16 * x * (5.0 * x - 0.5 * time + y).sin() + 0.04 * x * (13.0 * x - time).sin();
        [x * 0.97, y - 0.08 * x * x, wave]
    })
}

fn sheet(at: impl Fn(f32, f32) -> [f32; 3]) -> Vec<[f32; 3]> {
    let place = |k: u32| k as f32 / (SIDE - 1) as f32;
    (0..SIDE * SIDE).map(|k| at(2.0 * place(k % SIDE), 0.6 + 1.4 * place(k / SIDE))).collect()
}

fn grid() -> Faces {
    let mut faces = Faces::default();
    for k in (0..SIDE * (SIDE - 1)).filter(|k| k % SIDE + 1 < SIDE) {
        faces.push(&[k, k + 1, k + 1 + SIDE, k + SIDE]);
    }
    faces
}

fn sphere() -> (Faces, Vec<[f32; 3]>) {
    let (rows, columns) = (16u32, 32u32);
    let (mut faces, mut points) = (Faces::default(), Vec::new());
    for row in 0..=rows {
        for column in 0..columns {
            let (down, around) = (row as f32 / rows as f32 * PI, column as f32 / columns as f32 * TAU);
            let out = [down.sin() * around.cos(), down.cos(), -down.sin() * around.sin()];
            points.push([0.3 + 0.35 * out[0], 0.35 + 0.35 * out[1], 0.9 + 0.35 * out[2]]);
            let (a, b) = (row * columns + column, row * columns + (column + 1) % columns);
            if row < rows {
                faces.push(&[a, a + columns, b + columns, b]);
            }
        }
    }
    (faces, points)
}

fn cube() -> (Faces, Vec<[f32; 3]>) {
    let sides = [[0u32, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
    let corner = |k: usize| {
        let side = |axis: usize| if k >> axis & 1 == 1 { 0.4 } else { 0.0 };
        [1.5 + side(0), side(1), -0.8 + side(2)]
    };
    (sides.iter().map(|side| &side[..]).collect(), (0..8).map(corner).collect())
}
