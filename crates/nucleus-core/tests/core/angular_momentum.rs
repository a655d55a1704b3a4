//! Angular momentum: what holds a cloth together has no torque.

use crate::scenes::{LINKS, Vec3, frame, ground, physical, still};
use crate::soft_bodies::{crate_of, icosphere};
use nalgebra::Matrix3;
use nucleus_core::{
    Cloth, ClothFrame, ClothId, ClothLists, Elements, FrameInput, Mass, ModelBuilder, PointId, Pressure,
    Real, SelfCollision, Solver, Start, StateView, Surface,
};
use proptest::prelude::*;

const CLOTH: ClothId = ClothId(0);
const GAS: Pressure =
    Pressure::Gas { start: 0.3, bulk: 2e4, pump: 0.0, tightness: 1.0, damping: 0.0, sealed: false };

fn built<R: Real>(surface: Surface, velocities: Vec<Vec3>) -> Solver<R> {
    let lists = ClothLists { pressure: true, air: true, damp: true, ..LINKS };
    let mut builder = ModelBuilder::new();
    let cloth = Cloth::new(surface, Mass::PerArea(0.2), lists);
    let start = Start { velocities, ..Start::default() };
    builder.cloth(Cloth { start, ..cloth }).expect("a good mesh");
    Solver::new(builder, 1)
}

/// Mass, place and velocity of some points.
fn motion<R: Real>(solver: &Solver<R>, points: std::ops::Range<usize>) -> Vec<(f64, Vec3, Vec3)> {
    let mut velocities = Vec::new();
    solver.velocities(CLOTH, 1.0, &mut velocities);
    let of = |point: usize| {
        let mass = solver.mass(CLOTH, PointId(point as u32));
        (mass, solver.point(CLOTH, point), Vec3::from(velocities[point].map(f64::from)))
    };
    points.map(of).collect()
}

/// Angular momentum about the centre of mass, and the angular velocity of a rigid body of as much.
fn spin(motion: &[(f64, Vec3, Vec3)]) -> [Vec3; 2] {
    let mass: f64 = motion.iter().map(|(m, ..)| m).sum();
    let centre: Vec3 = motion.iter().map(|(m, x, _)| x * *m).sum::<Vec3>() / mass;
    let (mut momentum, mut inertia) = (Vec3::zeros(), Matrix3::zeros());
    for &(m, x, v) in motion {
        let r = x - centre;
        momentum += r.cross(&v) * m;
        inertia += (Matrix3::identity() * r.norm_squared() - r * r.transpose()) * m;
    }
    [momentum, inertia.try_inverse().expect("a body") * momentum]
}

/// A cushion: a flat box of quads.
fn cushion() -> Surface {
    let mut surface = crate_of(0.2, 8);
    surface.positions.iter_mut().for_each(|p| p.y *= 0.2);
    surface
}

fn inflated() -> FrameInput {
    let cloth = ClothFrame { pressure: GAS, bend_resistance: 0.1, ..still() };
    FrameInput { gravity: Vec3::zeros(), cloths: vec![cloth], ..frame(3, physical(96.0)) }
}

#[test]
fn a_ball_under_pressure_does_not_begin_to_spin() {
    let surface = icosphere(0.1);
    let count = surface.positions.len();
    let mut solver = built::<f32>(surface, Vec::new());
    (0..72).for_each(|_| _ = solver.step(&inflated(), &mut ()));
    let [_, turn] = spin(&motion(&solver, 0..count));
    assert!(turn.norm() < 1e-3, "{turn} rad/s"); // 45 with the torque
}

/// Each part of a mesh, under pressure and damped.
fn assert_each_part_keeps_its_own_angular_momentum(damp: f64) {
    let one = cushion();
    let count = one.positions.len();
    let mut two = one.clone();
    two.positions.extend(one.positions.iter().map(|p| p + Vec3::x()));
    for face in one.faces.iter() {
        two.faces.push(&face.iter().map(|point| point + count as u32).collect::<Vec<_>>());
    }
    // The first turns; the second is at rest, and stays so.
    let about = |p: &Vec3| if p.x < 0.5 { Vec3::y().cross(p) * 6.0 } else { Vec3::zeros() };
    let velocities = two.positions.iter().map(about).collect();
    let mut solver = built::<f32>(two, velocities);
    let before = spin(&motion(&solver, 0..count))[0];
    let mut input = inflated();
    input.cloths[0].damp = damp;
    (0..24).for_each(|_| _ = solver.step(&input, &mut ()));
    let [first, second] = [0..count, count..2 * count].map(|part| spin(&motion(&solver, part)));
    assert!((first[0] / before.norm() - before.normalize()).norm() < 1e-3, "{} and {before}", first[0]);
    assert!(second[1].norm() < 0.01, "{} rad/s", second[1]);
}

#[test]
fn each_part_of_a_mesh_keeps_its_own_angular_momentum() {
    assert_each_part_keeps_its_own_angular_momentum(0.0);
}

#[test]
fn damping_has_no_torque() {
    assert_each_part_keeps_its_own_angular_momentum(2.0);
}

#[test]
fn a_ball_under_pressure_does_not_roll_away_on_level_ground() {
    let mut surface = icosphere(0.1);
    surface.positions.iter_mut().for_each(|p| p.y += 0.11);
    let count = surface.positions.len();
    let mut solver = built::<f32>(surface, Vec::new());
    let mut input = FrameInput { gravity: -Vec3::y() * 9.81, plane: Some(ground(0.3)), ..inflated() };
    input.cloths[0] = ClothFrame { thickness: 0.002, friction: 0.3, damp: 1.0, ..input.cloths[0] };
    let centre =
        |solver: &Solver<f32>| (0..count).map(|k| solver.point(CLOTH, k)).sum::<Vec3>() / count as f64;
    (0..72).for_each(|_| _ = solver.step(&input, &mut ()));
    let before = centre(&solver);
    (0..72).for_each(|_| _ = solver.step(&input, &mut ()));
    let way = centre(&solver) - before;
    assert!(way.norm() < 0.1, "{way} m in three seconds"); // 12 with the torque
}

#[test]
fn a_still_balloon_is_still_between_its_frames_too() {
    let surface = icosphere(0.1);
    let count = surface.positions.len();
    let mut solver = built::<f32>(surface, Vec::new());
    let mut input = inflated();
    input.cloths[0].damp = 1.0;
    (0..96).for_each(|_| _ = solver.step(&input, &mut ()));
    let fastest = motion(&solver, 0..count).iter().map(|(_, _, v)| v.norm()).fold(0.0, f64::max);
    assert!(fastest < 1e-3, "{fastest} m/s"); // 0.85 where sweeps alternate, at the same points in each frame
}

#[test]
fn a_rigid_body_under_its_own_stress_does_not_begin_to_spin() {
    let lists = ClothLists { shape: true, self_collision: true, ..LINKS };
    let surface = crate_of(0.3, 4);
    let count = surface.positions.len();
    let mut builder = ModelBuilder::new();
    builder.cloth(Cloth::new(surface, Mass::PerArea(0.2), lists)).expect("a good mesh");
    let mut solver = Solver::<f32>::new(builder, 1);
    // It can touch itself, though it does not.
    let self_collision = SelfCollision { on: true, thickness: 0.005, elements: Elements::Faces, edges: true };
    let stressed = ClothFrame { rigidity: 5.0, rest_length_scale: 1.3, self_collision, ..still() };
    let input = FrameInput { cloths: vec![stressed], ..inflated() };
    (0..96).for_each(|_| _ = solver.step(&input, &mut ()));
    let [_, turn] = spin(&motion(&solver, 0..count));
    assert!(turn.norm() < 1e-3, "{turn} rad/s");
}

#[test]
fn gas_goes_on_from_the_positions_of_a_run() {
    let run = |solver: &mut Solver<f32>, frames: u32| {
        let input =
            FrameInput { cloths: vec![ClothFrame { damp: 4.0, ..inflated().cloths[0] }], ..inflated() };
        (0..frames).for_each(|_| _ = solver.step(&input, &mut ()));
    };
    let surface = cushion();
    let count = surface.positions.len();
    let mut solver = built::<f32>(surface.clone(), Vec::new());
    run(&mut solver, 48);
    let state = motion(&solver, 0..count);
    let start = Start {
        positions: state.iter().map(|point| point.1).collect(),
        velocities: state.iter().map(|point| point.2).collect(),
    };
    let mut builder = ModelBuilder::new();
    let cloth = Cloth::new(surface, Mass::PerArea(0.2), ClothLists { pressure: true, air: true, ..LINKS });
    builder.cloth(Cloth { start, ..cloth }).expect("a good mesh");
    let mut resumed = Solver::<f32>::new(builder, 1);
    run(&mut solver, 12);
    run(&mut resumed, 12);
    let apart =
        (0..count).map(|k| (solver.point(CLOTH, k) - resumed.point(CLOTH, k)).norm()).fold(0.0, f64::max);
    assert!(apart < 1e-4, "{apart} m");
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 12, ..ProptestConfig::default() })]

    #[test]
    fn a_free_cloth_keeps_its_momentum_at_any_number_of_evaluations(
        turn in proptest::array::uniform3(-8.0..8.0f64),
        shear in -3.0..3.0f64,
        evaluations in 12.0..200.0f64,
    ) {
        let surface = crate_of(0.3, 4);
        let count = surface.positions.len();
        let velocity = |p: &Vec3| Vec3::from(turn).cross(p) + Vec3::new(shear * p.y, 1.0, 0.0);
        let velocities = surface.positions.iter().map(velocity).collect();
        // With more digits than the rounding of thousands of steps needs; velocities are read in single precision.
        let mut solver = built::<f64>(surface, velocities);
        let input = FrameInput {
            cloths: vec![ClothFrame { pressure: Pressure::Off, ..inflated().cloths[0] }],
            ..FrameInput { resistance: physical(evaluations), ..inflated() }
        };
        let linear = |motion: &[(f64, Vec3, Vec3)]| motion.iter().map(|(m, _, v)| v * *m).sum::<Vec3>();
        let before = motion(&solver, 0..count);
        (0..24).for_each(|_| _ = solver.step(&input, &mut ()));
        let after = motion(&solver, 0..count);
        let scale = before.iter().map(|(m, x, v)| m * x.norm() * v.norm()).sum::<f64>();
        prop_assert!((linear(&after) - linear(&before)).norm() < 1e-6 * linear(&before).norm());
        let lost = (spin(&after)[0] - spin(&before)[0]).norm() / scale;
        prop_assert!(lost < 1e-6, "{lost}");
    }
}
