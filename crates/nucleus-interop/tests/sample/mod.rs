//! A small synthetic run, defined by formulas.

#![allow(dead_code)] // each user needs a part of it

pub mod exports;

use std::path::Path;

use nalgebra::Vector3;
use nucleus_cache::{
    Camera, CameraView, Detail, FaceSet, FaceSets, FilmFit, ObjectInfo, ObjectKind, Recorder, RunInfo,
    Source, TextureCoordinates,
};
use nucleus_core::{ClothId, ColliderId, Particle, ParticleLook, StateView, StepObserver, SubstepIndex};

pub const START: i32 = 3;
pub const END: i32 = 12;
pub const SUBSTEPS: u32 = 2;
/// Scene units are centimetres.
pub const UNITS: f64 = 100.0;
/// The first frame in which the cart moves.
const ROLLS: i32 = 7;

const SHEET: ClothId = ClothId(0);
const CART: ColliderId = ColliderId(0);

/// The first frame after the tear of a sheet that tears.
pub const TORN: i32 = 8;

/// Variants of the run.
#[derive(Debug, Clone, Copy)]
pub struct Variant {
    /// The sheet tears: it gains a point, and its faces change.
    pub tears: bool,
    /// Frames per second.
    pub fps: f64,
    /// Substeps of a frame.
    pub substeps: u32,
    pub units_per_metre: f64,
    /// Name of the wall.
    pub wall: &'static str,
    /// The faces of the sheet have groups and materials.
    pub sets: bool,
    /// Each particle of the dust has a look of its own.
    pub looks: bool,
    /// In each frame a particle of the dust dies and another is born.
    pub lives: bool,
}

impl Default for Variant {
    fn default() -> Self {
        let (fps, substeps, units_per_metre) = (24.0, SUBSTEPS, UNITS);
        let [tears, sets, looks, lives] = [false; 4];
        Self { tears, fps, substeps, units_per_metre, wall: "wall", sets, looks, lives }
    }
}

/// Writes the sample as a cache of substeps.
pub fn write(path: &Path) {
    record(path, Variant::default());
}

/// The same, with a sheet that tears: it gains a point, and its faces change.
pub fn write_torn(path: &Path) {
    record(path, Variant { tears: true, ..Variant::default() });
}

/// Writes a variant of the sample.
pub fn record(path: &Path, variant: Variant) {
    let run = RunInfo {
        scene_path: "scenes/\"sample\".ron".to_owned(),
        start: START,
        end: END,
        units_per_metre: variant.units_per_metre,
        frames_per_second: variant.fps,
        looks: variant.looks,
        particles: variant.lives,
        detail: Detail::Substeps,
        velocities: true,
        rotation: true,
        radii: [("dust".to_owned(), 0.25)].into(),
        cameras: vec![camera()],
        texture_coordinates: [("wall", &[][..]), ("1 cart", &[1, 0, 1, 0, 1])]
            .map(|(name, corners)| {
                let values = if corners.is_empty() {
                    vec![[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]
                } else {
                    vec![[0.25, 0.5], [0.75, 0.5]]
                };
                (name.to_owned(), TextureCoordinates { values, corners: corners.to_vec() })
            })
            .into(),
        face_sets: variant.sets.then(|| ("ns:sheet|1".to_owned(), face_sets())).into_iter().collect(),
        ..RunInfo::default()
    };
    let mut recorder = Recorder::create(path, &run, objects(variant.wall)).unwrap();
    recorder.record_start(&State { frame: START, time: 0.0, variant }).unwrap();
    for frame in START + 1..=END {
        let mut observer = recorder.frame(frame).unwrap();
        for substep in 1..=variant.substeps {
            let time = (frame - START - 1) as f32 + substep as f32 / variant.substeps as f32;
            let moment = SubstepIndex { substep, substeps: variant.substeps };
            if variant.tears && (frame, substep) == (TORN, 1) {
                let rest = torn(positions("ns:sheet|1", 0.0));
                observer.change_mesh(moment, "ns:sheet|1", torn_faces().iter().copied().collect(), rest);
            }
            observer.substep(moment, &State { frame, time, variant });
        }
        recorder.end_frame(&()).unwrap();
    }
    recorder.finish().unwrap();
}

/// Of the four faces of the sheet, one is in no group, one in two, and one has no material. The name of a group has a space.
fn face_sets() -> FaceSets {
    let set = |name: &str, faces: &[u32]| FaceSet { name: name.to_owned(), faces: faces.to_vec() };
    FaceSets {
        groups: vec![set("hem", &[0, 2]), set("left side", &[2, 3])],
        materials: vec![set("silk", &[0, 1]), set("wall", &[3])],
    }
}

/// A camera that rises, looking along -z.
fn camera() -> Camera {
    let view = |frame: i32| CameraView {
        eye: [50.0, 100.0 + 10.0 * (frame - START) as f32, 900.0],
        forward: [0.0, 0.0, -1.0],
        up: [0.0, 1.0, 0.0],
        focal_length: 35.0,
        film: [1.41732, 0.94488],
        interest: 500.0,
    };
    Camera { name: "shot".to_owned(), fit: FilmFit::Fill, views: (START..=END).map(view).collect() }
}

/// Positions of an object `time` frames after the start, in scene units.
pub fn positions(object: &str, time: f32) -> Vec<[f32; 3]> {
    let units = UNITS as f32;
    let metres = match object {
        "ns:sheet|1" => sheet(time),
        "1 cart" => cart((time - (ROLLS - START - 1) as f32).max(0.0)),
        "wall" => wall(),
        _ => dust(time),
    };
    metres.into_iter().map(|point| point.map(|x| x * units)).collect()
}

pub fn objects(wall: &str) -> Vec<(Source, ObjectInfo)> {
    let object = |name: &str, kind, faces: &[&[u32]]| ObjectInfo {
        name: name.to_owned(),
        kind,
        faces: faces.iter().copied().collect(),
        rest: positions(name, 0.0),
    };
    let sheet: &[&[u32]] = &[&[0, 1, 4, 3], &[1, 2, 5], &[1, 5, 4], &[3, 4, 5, 8, 7, 6]];
    let cart: &[&[u32]] = &[&[0, 1, 2, 3, 4]];
    let quad: &[&[u32]] = &[&[0, 1, 2, 3]];
    vec![
        (Source::Cloth(SHEET), object("ns:sheet|1", ObjectKind::Cloth, sheet)),
        (Source::Cloth(ClothId(1)), object("dust", ObjectKind::Particles, &[])),
        (Source::Collider(CART), object("1 cart", ObjectKind::Collider, cart)),
        (
            Source::Collider(ColliderId(1)),
            ObjectInfo { name: wall.to_owned(), ..object("wall", ObjectKind::Collider, quad) },
        ),
    ]
}

/// The faces of the torn sheet: one face uses the added point.
pub fn torn_faces() -> &'static [&'static [u32]] {
    &[&[0, 1, 4, 3], &[1, 2, 11], &[1, 5, 4], &[3, 4, 5, 8, 7, 6]]
}

/// The points of the torn sheet: the point at the tear is duplicated.
pub fn torn(mut sheet: Vec<[f32; 3]>) -> Vec<[f32; 3]> {
    sheet.push(sheet[5].map(|x| x + 1.0));
    sheet
}

/// Eleven points, of which the last two are in no face.
fn sheet(time: f32) -> Vec<[f32; 3]> {
    (0..11u8).map(|k| [f32::from(k % 3), 1.0 + 0.1 * (time + f32::from(k)).sin(), f32::from(k / 3)]).collect()
}

/// The turns of the dust about the y axis, as quaternions x, y, z, w.
pub fn turns(time: f32) -> Vec<[f32; 4]> {
    (0..5u8).map(|k| (0.1 * time * f32::from(k)).sin_cos()).map(|(sin, cos)| [0.0, sin, 0.0, cos]).collect()
}

/// The looks of the dust.
pub fn looks(time: f32) -> Vec<ParticleLook> {
    let look = |k: u8| ParticleLook {
        radius: 0.5 + 0.5 * f32::from(k),
        opacity: 0.2 * f32::from(k),
        color: Some([0.125 * f32::from(k), 0.5, 0.0625 * time]),
        incandescence: [0.0; 3],
    };
    (0..5).map(look).collect()
}

/// The particles of the dust where they live for five frames; their numbers need more than 32 bits.
pub fn lives(time: f32) -> Vec<Particle> {
    let life = |k: u8| {
        let age = f64::from(4 - k) + f64::from(time.fract());
        let lifespan = if k == 0 { f64::INFINITY } else { 5.0 };
        Particle { id: (1 << 33) + u64::from(k) + time as u64, age, lifespan, mass: 0.5 + f64::from(k) }
    };
    (0..5).map(life).collect()
}

fn dust(time: f32) -> Vec<[f32; 3]> {
    (0..5u8).map(|k| [f32::from(k), 3.0 - 0.01 * time * time, f32::from(k * k) + 0.1 * time]).collect()
}

fn cart(rolled: f32) -> Vec<[f32; 3]> {
    [[0.0, 0.0], [1.0, 0.0], [1.5, 1.0], [0.5, 1.6], [-0.3, 1.0]]
        .map(|[x, z]| [x + 0.2 * rolled, 0.0, z])
        .into()
}

fn wall() -> Vec<[f32; 3]> {
    vec![[-1.0, 0.0, -1.0], [-1.0, 0.0, 3.0], [-1.0, 2.0, 3.0], [-1.0, 2.0, -1.0]]
}

struct State {
    frame: i32,
    time: f32,
    variant: Variant,
}

impl StateView for State {
    fn orientations(&self, cloth: ClothId, out: &mut Vec<[f32; 4]>) {
        out.clear();
        out.extend((cloth != SHEET).then(|| turns(self.time)).into_iter().flatten());
    }
    fn looks(&self, cloth: ClothId, out: &mut Vec<ParticleLook>) {
        out.clear();
        out.extend((self.variant.looks && cloth != SHEET).then(|| looks(self.time)).into_iter().flatten());
    }
    fn particles(&self, cloth: ClothId, out: &mut Vec<Particle>) {
        out.clear();
        out.extend((self.variant.lives && cloth != SHEET).then(|| lives(self.time)).into_iter().flatten());
    }
    fn positions(&self, cloth: ClothId, _: f64, out: &mut Vec<[f32; 3]>) {
        *out = positions(if cloth == SHEET { "ns:sheet|1" } else { "dust" }, self.time);
        if cloth == SHEET && self.variant.tears && self.frame >= TORN {
            *out = torn(std::mem::take(out));
        }
    }
    fn velocities(&self, cloth: ClothId, units: f64, out: &mut Vec<[f32; 3]>) {
        self.positions(cloth, units, out);
        out.iter_mut().for_each(|velocity| *velocity = [self.time, 2.0, -1.0]);
    }
    fn collider_positions(&self, collider: ColliderId, _: f64, out: &mut Vec<[f32; 3]>) {
        *out = positions(if collider == CART { "1 cart" } else { "wall" }, self.time);
    }
    fn collider_moved(&self, collider: ColliderId) -> bool {
        collider == CART && self.frame >= ROLLS
    }
    fn point(&self, _: ClothId, _: usize) -> Vector3<f64> {
        Vector3::zeros()
    }
}
