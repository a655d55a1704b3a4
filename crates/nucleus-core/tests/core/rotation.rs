//! Rotation of particles by contact.

use crate::scenes::{Vec3, built, cuboid, frame, ground, physical, still};
use nucleus_core::{
    Cloth, ClothFrame, ClothId, ClothLists, ColliderFrame, Elements, Faces, FrameInput, Mass, Particles,
    ResistanceModel, SelfCollision, Solver, Start, StateView, Surface,
};

const BALLS: ClothId = ClothId(0);
const RADIUS: f64 = 0.05;
const CLASSIC: ResistanceModel = ResistanceModel::Classic;

fn balls(positions: Vec<Vec3>, velocities: Vec<Vec3>, lists: ClothLists) -> Cloth {
    let particles =
        Particles { capacity: positions.len(), radius: RADIUS, rotates: true, ..Particles::default() };
    let start = Start { velocities, ..Start::default() };
    let surface = Surface { positions, faces: Faces::default() };
    Cloth { start, particles: Some(particles), ..Cloth::new(surface, Mass::PerPoint(0.1), lists) }
}

/// Balls without friction on their motion, and without loss of spin.
fn rolling() -> ClothFrame {
    ClothFrame {
        thickness: RADIUS,
        elements: Elements::Points,
        friction: 0.0,
        rotation_friction: 1.0,
        rotation_damp: 0.0,
        ..still()
    }
}

/// The turn of a ball as axis times angle in rad, of the least angle.
fn turn_of(solver: &Solver<f64>, at: usize) -> Vec3 {
    let mut turns = Vec::new();
    solver.orientations(BALLS, &mut turns);
    let [x, y, z, w] = turns[at].map(f64::from);
    let axis = Vec3::new(x, y, z);
    let length = axis.norm();
    assert!((length * length + w * w - 1.0).abs() < 1e-6, "a unit quaternion");
    if length < 1e-9 { Vec3::zeros() } else { axis / length * 2.0 * length.atan2(w) }
}

/// An angle between -π and π that is the same turn.
fn wrapped(angle: f64) -> f64 {
    angle - (angle / std::f64::consts::TAU).round() * std::f64::consts::TAU
}

#[test]
fn a_ball_that_rolls_on_a_plane_without_slip_turns_by_its_way_over_its_radius() {
    let velocity = Vec3::new(0.6, 0.0, 0.0);
    let block = cuboid(Vec3::new(-3.0, -1.0, -3.0), Vec3::new(3.0, 0.0, 3.0));
    for (on_ground, substeps, resistance) in
        [(true, 1, CLASSIC), (true, 5, physical(48.0)), (false, 3, CLASSIC)]
    {
        let cloth = balls(vec![Vec3::new(0.01, RADIUS, 2.0)], vec![velocity], ClothLists::NONE);
        let mut solver = Solver::<f64>::new(built(cloth, [block.clone()]), 1);
        let input = FrameInput {
            cloths: vec![rolling()],
            colliders: vec![ColliderFrame { collide: !on_ground, friction: 0.0, ..ColliderFrame::default() }],
            plane: on_ground.then(|| ground(0.0)),
            ..frame(substeps, resistance)
        };
        for step in 1..=48 {
            solver.step(&input, &mut ());
            let way = solver.point(BALLS, 0).x - 0.01;
            let exact = wrapped(-way / RADIUS);
            let turn = turn_of(&solver, 0);
            // Two turns of opposite sign are the same at half a turn.
            let error = wrapped(turn.z - exact).abs();
            assert!(error < 1e-4, "frame {step}, {substeps} substeps: {turn:?} for {exact}");
            assert!(turn.x.abs() < 1e-6 && turn.y.abs() < 1e-6, "about the z axis: {turn:?}");
        }
        let turns = (solver.point(BALLS, 0).x - 0.01) / RADIUS / std::f64::consts::TAU;
        assert!(turns > 3.0, "more than three turns: {turns}");
    }
}

#[test]
fn a_ball_on_a_plane_that_carries_it_does_not_turn_and_one_it_slides_under_does() {
    let velocity = Vec3::new(0.5, 0.0, 0.0);
    let positions = vec![Vec3::new(0.0, RADIUS, 0.0), Vec3::new(0.0, RADIUS, 0.5)];
    let cloth = balls(positions, vec![velocity, Vec3::zeros()], ClothLists::NONE);
    let block = cuboid(Vec3::new(-3.0, -1.0, -3.0), Vec3::new(3.0, 0.0, 3.0));
    let mut solver = Solver::<f64>::new(built(cloth, [block.clone()]), 1);
    let mut at = 0.0;
    for _ in 0..6 {
        let input = frame(2, CLASSIC);
        let places = |x: f64| block.positions.iter().map(|place| place + Vec3::x() * x).collect::<Vec<_>>();
        let next = at + velocity.x * input.duration;
        let (start, end) = (places(at), places(next));
        let belt = ColliderFrame { collide: true, friction: 0.0, start, end, ..ColliderFrame::default() };
        at = next;
        solver.step(&FrameInput { cloths: vec![rolling()], colliders: vec![belt], ..input }, &mut ());
    }
    assert!(turn_of(&solver, 0).norm() < 1e-6, "{:?}", turn_of(&solver, 0));
    assert!((turn_of(&solver, 1).z - wrapped(at / RADIUS)).abs() < 1e-4, "{:?}", turn_of(&solver, 1));
}

#[test]
fn rotation_friction_takes_the_same_share_of_the_slip_at_any_number_of_substeps() {
    let spin_after = |substeps: u32, friction: f64| {
        let cloth = balls(vec![Vec3::y() * RADIUS], vec![Vec3::x() * 0.1], ClothLists::NONE);
        let mut solver = Solver::<f64>::new(built(cloth, []), 1);
        let input = FrameInput {
            cloths: vec![ClothFrame { rotation_friction: friction, ..rolling() }],
            plane: Some(ground(0.0)),
            ..frame(substeps, CLASSIC)
        };
        let mut before = 0.0;
        let mut angles = Vec::new();
        for _ in 0..4 {
            solver.step(&input, &mut ());
            let angle = -turn_of(&solver, 0).z;
            angles.push((angle - before) / input.duration);
            before = angle;
        }
        angles
    };
    let full = 0.1 / RADIUS;
    assert!(spin_after(4, 0.0).iter().all(|spin| spin.abs() < 1e-9), "without friction it does not spin");
    for friction in [0.2, 0.5] {
        let [coarse, fine] = [12, 48].map(|substeps| spin_after(substeps, friction));
        assert!(coarse[0] < 0.9 * full, "it slips at first: {coarse:?}");
        for (coarse, fine) in coarse.iter().zip(&fine) {
            assert!((coarse / fine - 1.0).abs() < 0.1, "{friction}: {coarse} and {fine}");
        }
        assert!(fine.windows(2).all(|pair| pair[1] > pair[0]) && fine[3] < full, "{fine:?}");
    }
}

#[test]
fn spin_lasts_in_the_air_and_is_damped_by_its_rate() {
    let damped = |damp: f64| {
        let cloth = balls(vec![Vec3::y() * RADIUS], vec![Vec3::x() * 0.1], ClothLists::NONE);
        let mut solver = Solver::<f64>::new(built(cloth, []), 1);
        let settings = ClothFrame { rotation_damp: damp, ..rolling() };
        let on_plane = FrameInput { cloths: vec![settings], plane: Some(ground(0.0)), ..frame(4, CLASSIC) };
        let in_air = FrameInput { plane: None, ..on_plane.clone() };
        solver.step(&FrameInput { cloths: vec![rolling()], ..on_plane }, &mut ());
        let mut spins = Vec::new();
        for _ in 0..5 {
            let before = turn_of(&solver, 0).z;
            solver.step(&in_air, &mut ());
            spins.push(wrapped(turn_of(&solver, 0).z - before) / in_air.duration);
        }
        spins
    };
    let free = damped(0.0);
    assert!(free.iter().all(|spin| (spin / (-0.1 / RADIUS) - 1.0).abs() < 1e-5), "{free:?}");
    let slow = damped(1.0);
    let shares: Vec<f64> = slow.windows(2).map(|pair| pair[1] / pair[0]).collect();
    // Four implicit substeps of a quarter of the rate each.
    assert!(shares.iter().all(|share| (share - 1.25f64.powi(-4)).abs() < 1e-4), "{shares:?}");
}

#[test]
fn two_balls_that_pass_each_other_in_touch_turn_the_same_way() {
    let self_collision = ClothLists { self_collision: true, ..ClothLists::NONE };
    let positions = vec![Vec3::new(-0.01, RADIUS, 0.0), Vec3::new(0.01, -RADIUS, 0.0)];
    let cloth = balls(positions, vec![Vec3::x() * 0.2, -Vec3::x() * 0.2], self_collision);
    let mut solver = Solver::<f64>::new(built(cloth, []), 1);
    let own = SelfCollision { on: true, thickness: RADIUS, elements: Elements::Points, edges: false };
    let settings = ClothFrame { self_collision: own, ..rolling() };
    let input = FrameInput { cloths: vec![settings], gravity: Vec3::zeros(), ..frame(4, CLASSIC) };
    solver.step(&input, &mut ());
    let [upper, lower] = [0, 1].map(|at| turn_of(&solver, at).z);
    assert!(upper < -0.01 && (upper / lower - 1.0).abs() < 1e-3, "{upper} and {lower}");
}

#[test]
fn rotation_is_the_same_after_a_checkpoint_and_without_it_nothing_else_changes() {
    let run = |rotates: bool, saved_at: Option<usize>| {
        let positions =
            (0..60).map(|k| Vec3::new(f64::from(k % 8), 1.5 * f64::from(k / 8), 0.3 * f64::from(k)) * 0.1);
        let velocities = vec![Vec3::new(0.4, 0.0, 0.3); 60];
        let mut cloth = balls(positions.map(|x| x + Vec3::y() * 0.2).collect(), velocities, ClothLists::NONE);
        cloth.particles.iter_mut().for_each(|particles| particles.rotates = rotates);
        let builder = || built(cloth.clone(), [cuboid(Vec3::new(0.0, 0.0, 0.0), Vec3::new(0.5, 0.1, 0.9))]);
        let mut solver = Solver::<f64>::new(builder(), 2);
        let input = FrameInput {
            cloths: vec![ClothFrame { friction: 0.01, ..rolling() }],
            colliders: vec![ColliderFrame { collide: true, ..ColliderFrame::default() }],
            plane: Some(ground(0.0)),
            ..frame(3, CLASSIC)
        };
        for step in 0..20 {
            if saved_at == Some(step) {
                solver = Solver::restored(builder(), 1, &solver.save()).expect("its own state");
            }
            solver.step(&input, &mut ());
        }
        let mut turns = Vec::new();
        solver.orientations(BALLS, &mut turns);
        (solver.state_hash(), turns)
    };
    let (hash, turns) = run(true, None);
    assert!(turns.iter().filter(|turn| turn[3] < 0.999).count() > 20, "many have turned");
    assert!(run(true, Some(9)) == (hash, turns), "a checkpoint");
    assert_eq!(run(false, None), (hash, Vec::new()));
}
