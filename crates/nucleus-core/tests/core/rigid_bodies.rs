//! Impacts of bodies that keep their shape.

use crate::scenes::{Vec3, built, frame, ground, still};
use crate::soft_bodies::{crate_of, icosphere};
use nucleus_core::{
    Cloth, ClothFrame, ClothId, ClothLists, ColliderFrame, FrameInput, Mass, ModelBuilder, ResistanceModel,
    Solver, StateView, Surface,
};

const CLOTH: ClothId = ClothId(0);
const PHYSICAL: ResistanceModel = ResistanceModel::Physical { evaluations: 96.0 };

/// The height in metres that a body of this rigidity reaches after it has fallen by 0.8 m on the ground, and its largest energy
/// over that at the start.
fn rebound(body: &Surface, rigidity: f64, bounce: f64) -> [f64; 2] {
    let mut body = body.clone();
    let lowest = body.positions.iter().map(|place| place.y).fold(f64::MAX, f64::min);
    body.positions.iter_mut().for_each(|place| place.y += 0.8 - lowest);
    let count = body.positions.len();
    let lists = ClothLists { stretch: true, damp: true, shape: true, ..ClothLists::NONE };
    let mut builder = ModelBuilder::new();
    builder.cloth(Cloth::new(body, Mass::PerPoint(0.01), lists)).expect("a good mesh");
    let mut solver: Solver<f64> = Solver::new(builder, 1);
    let cloth = ClothFrame { rigidity, bounce, thickness: 0.001, ..still() };
    let input = FrameInput { cloths: vec![cloth], plane: Some(ground(0.0)), ..frame(1, PHYSICAL) };
    let energy = |solver: &Solver<f64>| {
        let mut velocities = Vec::new();
        solver.velocities(CLOTH, 1.0, &mut velocities);
        let kinetic =
            velocities.iter().map(|v| Vec3::from(v.map(f64::from)).norm_squared() / 2.0).sum::<f64>();
        kinetic + (0..count).map(|k| 9.81 * solver.point(CLOTH, k).y).sum::<f64>()
    };
    let (start, mut most, mut highest) = (energy(&solver), 0.0f64, 0.0f64);
    for k in 0..30 {
        solver.step(&input, &mut ());
        most = most.max(energy(&solver) / start);
        // It lands in the tenth frame.
        if k >= 12 {
            let lowest = (0..count).map(|k| solver.point(CLOTH, k).y).fold(f64::MAX, f64::min);
            highest = highest.max(lowest);
        }
    }
    [highest, most]
}

#[test]
fn a_rigid_ball_rebounds_by_the_square_of_its_bounce() {
    let ball = icosphere(0.1);
    for rigidity in [1.0, 20.0, 1000.0] {
        for bounce in [0.0, 0.5, 1.0] {
            let [height, energy] = rebound(&ball, rigidity, bounce);
            let expected = 0.8 * bounce * bounce;
            assert!((height - expected).abs() < 0.05, "{rigidity}, {bounce}: {height} m, not {expected}");
            assert!(energy < 1.01, "{rigidity}, {bounce}: energy {energy}");
        }
    }
}

#[test]
fn a_rigid_crate_gains_no_energy_on_whatever_corner_it_lands() {
    let tilts =
        [Vec3::zeros(), Vec3::new(0.1, 0.0, 0.0), Vec3::new(0.6, 0.2, 0.4), Vec3::new(0.0, 0.0, 0.785)];
    for tilt in tilts {
        let mut body = crate_of(0.2, 4);
        body.positions.iter_mut().for_each(|place| *place = nalgebra::Rotation3::new(tilt) * *place);
        for bounce in [0.0, 0.5, 1.0] {
            let [height, energy] = rebound(&body, 20.0, bounce);
            assert!(energy < 1.01 && height < 0.85, "{tilt:?}, {bounce}: energy {energy}, {height} m");
            assert!(bounce > 0.0 || height < 0.05, "{tilt:?}: it does not bounce, but rises by {height} m");
        }
    }
    // Flat, all of its bottom lands at once.
    let [height, _] = rebound(&crate_of(0.2, 4), 20.0, 1.0);
    assert!((height - 0.8).abs() < 0.05, "{height} m");
}

/// The mean position of a crate of 20 cm, and the height of its lowest point, after 24 frames in which it lands from `drop` metres
/// and slides at 2 m/s on a flat mesh of so many quads.
fn slid(quads: [u32; 2], friction: f64, drop: f64) -> [f64; 2] {
    let mut body = crate_of(0.2, 3);
    body.positions.iter_mut().for_each(|place| place.y += 0.11 + drop);
    let count = body.positions.len();
    let lists = ClothLists { stretch: true, damp: true, shape: true, ..ClothLists::NONE };
    let mut cloth = Cloth::new(body, Mass::PerPoint(0.01), lists);
    cloth.start.velocities = vec![Vec3::x() * 2.0; count];
    let floor = Surface::sheet(Vec3::new(-1.0, 0.0, -1.0), [Vec3::x() * 4.0, Vec3::z() * 2.0], quads);
    let mut solver: Solver<f64> = Solver::new(built(cloth, [floor]), 1);
    let cloth = ClothFrame { rigidity: 10.0, thickness: 0.005, friction: friction / 2.0, ..still() };
    let collider = ColliderFrame {
        collide: true,
        thickness: 0.005,
        friction: friction / 2.0,
        ..ColliderFrame::default()
    };
    let input = FrameInput { cloths: vec![cloth], colliders: vec![collider], ..frame(1, PHYSICAL) };
    for _ in 0..24 {
        solver.step(&input, &mut ());
    }
    let points = || (0..count).map(|k| solver.point(CLOTH, k));
    let way = points().map(|place| place.x).sum::<f64>() / count as f64;
    [way, points().map(|place| place.y).fold(f64::MAX, f64::min)]
}

#[test]
fn a_rigid_crate_slides_over_the_edges_of_a_flat_mesh_without_tripping() {
    for quads in [[1, 1], [20, 10], [160, 80]] {
        let [way, height] = slid(quads, 0.0, 0.002);
        assert!((way - 2.0).abs() < 0.02, "{quads:?}: it slid by {way} m");
        assert!((height - 0.01).abs() < 1e-3, "{quads:?}: it is at {height} m");
        // Friction stops it after v² / 2 µ g.
        let [way, height] = slid(quads, 0.5, 0.0);
        assert!((way - 0.408).abs() < 0.03, "{quads:?}: it slid by {way} m");
        assert!((height - 0.01).abs() < 1e-3, "{quads:?}: it is at {height} m");
    }
}

const LANDED_FRAMES: u32 = 5;

/// The mean velocity of a crate of 20 cm five frames after it has started 1 mm above the ground or a mesh at this velocity,
/// and the largest tilt of its bottom: the difference of heights over its width.
fn landed(velocity: Vec3, friction: f64, rigidity: f64, on_ground: bool) -> (Vec3, f64) {
    let mut body = crate_of(0.2, 4);
    body.positions.iter_mut().for_each(|place| place.y += 0.106);
    let count = body.positions.len();
    let bottom: Vec<usize> = (0..count).filter(|&k| body.positions[k].y < 0.0061).collect();
    let lists = ClothLists { stretch: true, shape: true, ..ClothLists::NONE };
    let mut cloth = Cloth::new(body, Mass::PerPoint(0.01), lists);
    cloth.start.velocities = vec![velocity; count];
    let floor = Surface::sheet(Vec3::new(-1.0, 0.0, -2.0), [Vec3::x() * 4.0, Vec3::z() * 4.0], [8, 8]);
    let mut solver: Solver<f64> = Solver::new(built(cloth, [floor].into_iter().filter(|_| !on_ground)), 1);
    let cloth = ClothFrame { rigidity, thickness: 0.005, friction: friction / 2.0, ..still() };
    let collider =
        ColliderFrame { collide: true, thickness: 0.0, friction: friction / 2.0, ..ColliderFrame::default() };
    let input = FrameInput {
        cloths: vec![cloth],
        colliders: vec![collider; usize::from(!on_ground)],
        plane: on_ground.then(|| ground(friction / 2.0)),
        ..frame(1, PHYSICAL)
    };
    let mut tilt = 0.0f64;
    for _ in 0..LANDED_FRAMES {
        solver.step(&input, &mut ());
        let heights = || bottom.iter().map(|&k| solver.point(CLOTH, k).y);
        tilt = tilt.max((heights().fold(f64::MIN, f64::max) - heights().fold(f64::MAX, f64::min)) / 0.2);
    }
    let mut velocities = Vec::new();
    solver.velocities(CLOTH, 1.0, &mut velocities);
    (velocities.iter().map(|v| Vec3::from(v.map(f64::from))).sum::<Vec3>() / count as f64, tilt)
}

#[test]
fn a_rigid_crate_that_lands_loses_friction_times_its_normal_impulse_of_sliding_speed() {
    for (friction, fall) in [(0.0, 3.0), (0.1, 3.0), (0.3, 1.0), (0.3, 3.0)] {
        for (rigidity, on_ground) in [(20.0, true), (20.0, false), (1000.0, true)] {
            let start = Vec3::new(2.0, -fall, 1.0);
            let (velocity, tilt) = landed(start, friction, rigidity, on_ground);
            let along = Vec3::new(start.x, 0.0, start.z);
            let normal_impulse = fall + 9.81 * f64::from(LANDED_FRAMES) / 24.0;
            let expected = along.norm() - friction * normal_impulse;
            let sliding = velocity.dot(&along) / along.norm();
            let case = format!("{friction}, {fall} m/s, rigidity {rigidity}, ground {on_ground}");
            assert!((sliding - expected).abs() < 2e-3, "{case}: it slides at {sliding} m/s, not {expected}");
            assert!(tilt < 0.02, "{case}: it tips by {tilt}");
        }
    }
}
