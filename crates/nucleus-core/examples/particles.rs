//! Time of free particles that fall on a ball and the ground: `cargo run --release -p nucleus-core --example particles`.
//!
//! Particles do not collide with each other. One substep and one collision pass suffice for them.

use std::f64::consts::{PI, TAU};
use std::time::Instant;

use nalgebra::Vector3;
use nucleus_core::{
    Cloth, ClothFrame, ClothLists, Collider, ColliderFrame, Elements, Faces, FrameInput, GroundPlane, Mass,
    ModelBuilder, Particles, ResistanceModel, SelfCollision, Solver, Surface,
};

type Vec3 = Vector3<f64>;

/// Frames that are timed, after as many that are not.
const FRAMES: u32 = 24;

fn main() {
    println!("| particles | ms per frame | ns per particle |");
    println!("|----------:|-------------:|----------------:|");
    for count in [10_000, 100_000, 1_000_000] {
        let milliseconds = time(count);
        println!("| {count} | {milliseconds:.2} | {:.1} |", milliseconds * 1e6 / count as f64);
    }
}

/// Milliseconds per frame of so many particles, on one thread.
fn time(count: usize) -> f64 {
    let side = (count as f64).cbrt().ceil() as usize;
    let spacing = 2.0 / side as f64;
    let place = |k: usize| {
        let [x, y, z] = [k % side, k / (side * side), k / side % side].map(|n| n as f64 * spacing);
        Vec3::new(x - 1.0, y + 0.6, z - 1.0)
    };
    let surface = Surface { positions: (0..count).map(place).collect(), faces: Faces::default() };
    let particles = Some(Particles { capacity: count, ..Particles::default() });
    let mut builder = ModelBuilder::new();
    let cloth = Cloth { particles, ..Cloth::new(surface, Mass::PerPoint(1e-3), ClothLists::NONE) };
    builder.cloth(cloth).expect("valid particles");
    builder.collider(Collider { surface: sphere(0.5) }).expect("a good mesh");
    let mut solver = Solver::<f32>::new(builder, 1);
    let balls = ClothFrame {
        thickness: 0.002,
        elements: Elements::Points,
        self_collision: SelfCollision::OFF,
        ..ClothFrame::default()
    };
    let plane = GroundPlane {
        origin: -Vec3::y() * 0.5,
        normal: Vec3::y(),
        bounce: 0.0,
        friction: 0.2,
        stickiness: 0.0,
    };
    let collider =
        ColliderFrame { collide: true, thickness: 0.001, friction: 0.2, ..ColliderFrame::default() };
    let input = FrameInput {
        resistance: ResistanceModel::Classic,
        substeps: 1,
        collision_iterations: 1.0,
        gravity: -Vec3::y() * 9.81,
        plane: Some(plane),
        cloths: vec![balls],
        colliders: vec![collider],
        ..FrameInput::default()
    };
    (0..FRAMES / 2).for_each(|_| _ = solver.step(&input, &mut ()));
    let begin = Instant::now();
    (0..FRAMES).for_each(|_| _ = solver.step(&input, &mut ()));
    begin.elapsed().as_secs_f64() * 1e3 / f64::from(FRAMES)
}

/// A sphere about the origin, 64 round and 32 down.
fn sphere(radius: f64) -> Surface {
    let (round, down) = (64u32, 32u32);
    let mut surface = Surface { positions: vec![Vec3::y() * radius], faces: Faces::default() };
    for (j, i) in (1..down).flat_map(|j| (0..round).map(move |i| (j, i))) {
        let (polar, turn) = (PI * f64::from(j) / f64::from(down), TAU * f64::from(i) / f64::from(round));
        let across = Vec3::new(turn.cos(), 0.0, turn.sin()) * polar.sin();
        surface.positions.push((across + Vec3::y() * polar.cos()) * radius);
    }
    surface.positions.push(-Vec3::y() * radius);
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
