//! Meshes and frames that several tests share.
#![allow(dead_code)] // each program of tests uses its own part

pub mod links;

use nalgebra::Vector3;
use nucleus_core::{
    COUNT_PERIOD, Cloth, ClothFrame, ClothId, ClothLists, Collider, ColliderFrame, Faces, FrameInput,
    GroundPlane, Mass, ModelBuilder, Pin, PointId, ResistanceModel, Surface,
};

pub type Vec3 = Vector3<f64>;

/// Only links along edges.
pub const LINKS: ClothLists = ClothLists { stretch: true, ..ClothLists::NONE };

/// Quads, `columns` by `rows` points, from the origin along `u` and `v`.
pub fn grid(columns: u32, rows: u32, u: Vec3, v: Vec3) -> Surface {
    let mut surface = Surface::default();
    for row in 0..rows {
        for column in 0..columns {
            let at = |k: u32, of: u32| f64::from(k) / f64::from(of - 1);
            surface.positions.push(u * at(column, columns) + v * at(row, rows));
        }
    }
    for (row, column) in (0..rows - 1).flat_map(|row| (0..columns - 1).map(move |column| (row, column))) {
        let a = row * columns + column;
        surface.faces.push(&[a, a + columns, a + columns + 1, a + 1]);
    }
    surface
}

/// A sphere of triangles, 64 round and 32 down.
pub fn sphere(radius: f64, centre: Vec3) -> Surface {
    let (round, down) = (64u32, 32u32);
    let mut surface = Surface { positions: vec![centre + Vec3::y() * radius], faces: Faces::default() };
    for j in 1..down {
        let polar = std::f64::consts::PI * f64::from(j) / f64::from(down);
        for i in 0..round {
            let turn = std::f64::consts::TAU * f64::from(i) / f64::from(round);
            let across = Vec3::new(turn.cos(), 0.0, turn.sin()) * polar.sin();
            surface.positions.push(centre + (across + Vec3::y() * polar.cos()) * radius);
        }
    }
    surface.positions.push(centre - Vec3::y() * radius);
    let last = 1 + (down - 1) * round;
    for i in 0..round {
        let next = (i + 1) % round;
        surface.faces.push(&[0, 1 + next, 1 + i]);
        for a in (0..down - 2).map(|j| 1 + j * round) {
            surface.faces.push(&[a + i, a + next, a + next + round]);
            surface.faces.push(&[a + i, a + next + round, a + i + round]);
        }
        surface.faces.push(&[last, last - round + i, last - round + next]);
    }
    surface
}

/// Radius of the largest ball inside [`sphere`]'s faces, over its radius: every point within it is inside the mesh.
pub const INSCRIBED: f64 = 0.993;

/// A frame of 1/24 s with a cloth under gravity only.
pub fn frame(substeps: u32, resistance: ResistanceModel) -> FrameInput {
    FrameInput {
        duration: COUNT_PERIOD,
        substeps,
        collision_iterations: 4.0,
        resistance,
        gravity: Vec3::new(0.0, -9.81, 0.0),
        wind: Vec3::zeros(),
        air_density: 1.0,
        plane: None,
        layer_range: 4.0,
        self_collision_iterations: 4.0,
        cloths: vec![still()],
        colliders: Vec::new(),
        pins: Vec::new(),
        ..FrameInput::default()
    }
}

/// The ground plane at height zero.
pub fn ground(friction: f64) -> GroundPlane {
    GroundPlane { friction, ..GroundPlane::new(Vec3::zeros(), Vec3::y()) }
}

/// A model of one cloth and these colliders.
pub fn built(cloth: Cloth, colliders: impl IntoIterator<Item = Surface>) -> ModelBuilder {
    let mut builder = ModelBuilder::new();
    builder.cloth(cloth).expect("good points");
    for surface in colliders {
        builder.collider(Collider { surface }).expect("a good mesh");
    }
    builder
}

/// A cloth without damping, drag or bending, equally stiff in compression and stretch.
pub fn still() -> ClothFrame {
    ClothFrame {
        compression_resistance: 20.0,
        bend_resistance: 0.0,
        stretch_damp: 0.0,
        drag: 0.0,
        lift: 0.0,
        ..ClothFrame::default()
    }
}

pub fn physical(evaluations: f64) -> ResistanceModel {
    ResistanceModel::Physical { evaluations }
}

/// One cloth of 0.2 kg/m².
pub fn one_cloth(surface: Surface, lists: ClothLists) -> ModelBuilder {
    let mut builder = ModelBuilder::new();
    builder.cloth(Cloth::new(surface, Mass::PerArea(0.2), lists)).expect("a good mesh");
    builder
}

pub fn pins(surface: &Surface, points: impl IntoIterator<Item = usize>) -> Vec<Pin> {
    let pin = |point: usize| {
        let place = surface.positions[point];
        Pin { cloth: ClothId(0), point: PointId(point as u32), start: place, end: place }
    };
    points.into_iter().map(pin).collect()
}

/// A sheet over a sphere.
pub fn drape(points: u32, evaluations: f64) -> (ModelBuilder, FrameInput) {
    let builder = drape_placed(points, |p| p);
    let mut frame = frame(3, physical(evaluations));
    frame.cloths[0] =
        ClothFrame { bend_resistance: 0.1, stretch_damp: 0.1, thickness: 0.0025, friction: 0.5, ..still() };
    frame.colliders =
        vec![ColliderFrame { collide: true, thickness: 0.0025, friction: 0.5, ..ColliderFrame::default() }];
    (builder, frame)
}

/// The objects of [`drape`], with transformed positions.
pub fn drape_placed(points: u32, place: impl Fn(Vec3) -> Vec3) -> ModelBuilder {
    let mut sheet = grid(points, points, Vec3::x(), Vec3::z());
    sheet.positions.iter_mut().for_each(|p| *p = place(*p + Vec3::new(-0.5, 0.35, -0.5)));
    let mut ball = sphere(0.31, Vec3::zeros());
    ball.positions.iter_mut().for_each(|p| *p = place(*p));
    let mut builder = one_cloth(sheet, ClothLists { cross_links: false, ..ClothLists::DEFAULT });
    builder.collider(Collider { surface: ball }).expect("a good mesh");
    builder
}

/// A box of six quads.
pub fn cuboid(low: Vec3, high: Vec3) -> Surface {
    let mut surface = Surface::default();
    for corner in 0..8u32 {
        let pick = |axis: u32| if corner >> axis & 1 == 0 { low[axis as usize] } else { high[axis as usize] };
        surface.positions.push(Vec3::new(pick(0), pick(1), pick(2)));
    }
    for face in [[0u32, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]] {
        surface.faces.push(&face);
    }
    surface
}
