//! Attributes that differ by particle, collision events, and particles that lose speed.

use crate::scenes::{Vec3, frame, ground, physical, still};
use nucleus_core::{
    Birth, COUNT_PERIOD, Cloth, ClothFrame, ClothId, ClothLists, Collider, CollisionEvent, Elements,
    FrameInput, Mass, ModelBuilder, ParticleChange, ParticleRamp, Particles, PointId, RampInput, RampTarget,
    ResistanceModel, SelfCollision, Solver, Start, StateView, Surface,
};

const BEADS: ClothId = ClothId(0);
const CLASSIC: ResistanceModel = ResistanceModel::Classic;

fn cloth(first: &[Vec3], particles: Particles) -> Cloth {
    let surface = Surface { positions: first.to_vec(), faces: Default::default() };
    let lists = ClothLists { air: true, self_collision: true, ..ClothLists::NONE };
    Cloth { particles: Some(particles), ..Cloth::new(surface, Mass::PerPoint(0.5), lists) }
}

fn solver(cloth: Cloth) -> Solver<f32> {
    let mut builder = ModelBuilder::new();
    builder.cloth(cloth).expect("valid particles");
    Solver::new(builder, 1)
}

fn places(solver: &Solver<f32>) -> Vec<Vec3> {
    (0..count(solver)).map(|at| solver.point(BEADS, at)).collect()
}

fn count(solver: &Solver<f32>) -> usize {
    let mut ages = Vec::new();
    solver.particles(BEADS, &mut ages);
    ages.len()
}

/// A ramp from one factor to another.
fn ramp(target: RampTarget, input: RampInput, input_max: f64, ends: [f64; 2]) -> ParticleRamp {
    ParticleRamp { target, input, input_max, samples: ends.to_vec(), randomize: 0.0 }
}

fn balls(radius: f64) -> ClothFrame {
    let own = SelfCollision { on: true, thickness: radius, elements: Elements::Points, edges: false };
    ClothFrame { thickness: radius, elements: Elements::Points, self_collision: own, ..still() }
}

#[test]
fn a_particle_rests_on_the_ground_at_its_own_radius() {
    // By number: radii of a fifth, two fifths and so on of 0.1 m.
    let first: Vec<Vec3> = (0..5).map(|k| Vec3::new(f64::from(k), 0.3, 0.0)).collect();
    let ramps = vec![ramp(RampTarget::Radius, RampInput::Id, 4.0, [0.2, 1.0])];
    let particles = Particles { capacity: 5, radius: 0.1, ramps, ..Particles::default() };
    let mut solver = solver(cloth(&first, particles));
    let input = FrameInput { plane: Some(ground(0.0)), cloths: vec![balls(0.1)], ..frame(4, CLASSIC) };
    (0..40).for_each(|_| _ = solver.step(&input, &mut ()));
    for (k, place) in places(&solver).iter().enumerate() {
        let radius = 0.1 * (0.2 + 0.2 * k as f64);
        assert!((place.y - radius).abs() < 0.02 * radius, "{k}: {} for {radius}", place.y);
    }
}

#[test]
fn a_particle_grows_with_its_age_and_its_neighbours_make_room() {
    let first = [Vec3::zeros(), Vec3::new(0.05, 0.0, 0.0)];
    let ramps = vec![ramp(RampTarget::Radius, RampInput::Age, 1.0, [0.25, 1.0])];
    let particles = Particles { capacity: 2, radius: 0.1, ramps, ..Particles::default() };
    let mut solver = solver(cloth(&first, particles));
    let cloth = ClothFrame { conserve: 0.0, ..balls(0.1) };
    let input = FrameInput { gravity: Vec3::zeros(), cloths: vec![cloth], ..frame(4, CLASSIC) };
    for (frames, age) in [(12, 0.5), (18, 1.25)] {
        (0..frames).for_each(|_| _ = solver.step(&input, &mut ()));
        let all = places(&solver);
        // Ramps are evaluated at the start of a substep, of which there are 96 in a second.
        let radius = 0.1 * (0.25 + 0.75 * f64::min(age - 1.0 / 96.0, 1.0));
        let apart = (all[1] - all[0]).norm();
        assert!((apart / (2.0 * radius) - 1.0).abs() < 0.01, "at {age} s {apart} for {}", 2.0 * radius);
    }
}

#[test]
fn masses_of_a_ramp_share_the_speed_of_a_collision() {
    // A central collision without bounce: both go on with the momentum over the sum of the masses.
    let first = [Vec3::zeros(), Vec3::new(0.5, 0.0, 0.0)];
    let ramps = vec![ramp(RampTarget::Mass, RampInput::Id, 1.0, [1.0, 3.0])];
    let mut cloth = cloth(&first, Particles { capacity: 2, radius: 0.1, ramps, ..Particles::default() });
    cloth.start.velocities = vec![Vec3::new(2.0, 0.0, 0.0), Vec3::zeros()];
    let mut solver = solver(cloth);
    let input = FrameInput { gravity: Vec3::zeros(), cloths: vec![balls(0.1)], ..frame(8, CLASSIC) };
    (0..12).for_each(|_| _ = solver.step(&input, &mut ()));
    assert!((solver.mass(BEADS, PointId(1)) - 1.5).abs() < 1e-6);
    let mut fast = Vec::new();
    solver.velocities(BEADS, 1.0, &mut fast);
    assert!(fast.iter().all(|v| (v[0] - 0.5).abs() < 0.01), "{fast:?}");
}

#[test]
fn conserve_keeps_its_share_of_the_velocity_in_each_frame_whatever_the_substeps() {
    for substeps in [1, 4, 7] {
        let mut cloth = cloth(&[Vec3::zeros()], Particles { capacity: 1, ..Particles::default() });
        cloth.start.velocities = vec![Vec3::x()];
        let mut solver = solver(cloth);
        let settings = ClothFrame { conserve: 0.9, collide: false, ..still() };
        let input = FrameInput { gravity: Vec3::zeros(), cloths: vec![settings], ..frame(substeps, CLASSIC) };
        (0..10).for_each(|_| _ = solver.step(&input, &mut ()));
        let mut fast = Vec::new();
        solver.velocities(BEADS, 1.0, &mut fast);
        assert!((f64::from(fast[0][0]) / 0.9f64.powi(10) - 1.0).abs() < 1e-5, "{substeps}: {fast:?}");
    }
}

/// A particle of 1 m/s that `damp` 0.1 slows, a rate of 2.4/s, after some frames of 1/24 s: its way and its velocity.
fn damped(substeps: u32, resistance: ResistanceModel, frames: usize, gravity: f64) -> [f64; 2] {
    let mut cloth = cloth(&[Vec3::zeros()], Particles { capacity: 1, ..Particles::default() });
    cloth.start.velocities = vec![Vec3::x()];
    let mut solver = solver(cloth);
    let settings = ClothFrame { damp: 0.1, collide: false, ..still() };
    let input = FrameInput {
        gravity: Vec3::x() * gravity,
        cloths: vec![settings],
        duration: 1.0 / 24.0,
        ..frame(substeps, resistance)
    };
    (0..frames).for_each(|_| _ = solver.step(&input, &mut ()));
    let mut fast = Vec::new();
    solver.velocities(BEADS, 1.0, &mut fast);
    [solver.point(BEADS, 0).x, f64::from(fast[0][0])]
}

#[test]
fn the_way_of_a_damped_particle_is_its_loss_of_velocity_over_the_rate_whatever_the_steps() {
    let rate = 2.4;
    // Classic has a time step in each substep, Physical 96 in a frame.
    let cases = [1, 3, 12].map(|substeps| (substeps, CLASSIC, substeps));
    for (substeps, resistance, steps) in cases.into_iter().chain([(3, physical(96.0), 96)]) {
        let share = rate / 24.0 / f64::from(steps);
        for frames in [6, 24, 240] {
            let [way, velocity] = damped(substeps, resistance, frames, 0.0);
            let kept = (1.0 + share).powi(-(frames as i32) * steps as i32);
            assert!((velocity - kept).abs() < 1e-5, "{steps}, {frames}: {velocity}, {kept}");
            let lost = (1.0 - velocity) / rate;
            assert!((way / lost - 1.0).abs() < 1e-4, "{steps}, {frames}: {way}, {lost}");
            let exact = (1.0 - (-rate * frames as f64 / 24.0).exp()) / rate;
            // Of a way that is not over yet, the error is that of the implicit velocity.
            let allowed = if frames == 240 { 1e-4 } else { 0.5 * share };
            assert!((way / exact - 1.0).abs() < allowed, "{steps}, {frames}: {way}, {exact}");
        }
    }
}

#[test]
fn a_damped_particle_falls_at_gravity_over_the_rate_whatever_the_substeps() {
    for (substeps, resistance) in [1, 3, 12].into_iter().flat_map(|n| [(n, CLASSIC), (n, physical(96.0))]) {
        let [[before, _], [after, velocity]] =
            [240, 264].map(|frames| damped(substeps, resistance, frames, 9.8));
        for speed in [after - before, velocity] {
            assert!((speed / (9.8 / 2.4) - 1.0).abs() < 1e-3, "{substeps}: {speed}");
        }
    }
}

/// Drops one particle on the ground with an event, and returns the living particles after it.
fn dropped(event: CollisionEvent, frames: usize) -> Solver<f32> {
    dropped_with(ClothFrame { bounce: 0.5, ..balls(0.05) }, event, frames)
}

/// The same with these settings, without self-collision.
fn dropped_with(settings: ClothFrame, event: CollisionEvent, frames: usize) -> Solver<f32> {
    let event = CollisionEvent { target: BEADS, ..event };
    let particles = Particles { capacity: 64, radius: 0.05, events: vec![event], ..Particles::default() };
    let mut solver = solver(cloth(&[Vec3::new(0.0, 0.3, 0.0)], particles));
    let alone = SelfCollision { on: false, ..settings.self_collision };
    let settings = ClothFrame { self_collision: alone, ..settings };
    let input = FrameInput { plane: Some(ground(0.0)), cloths: vec![settings], ..frame(4, CLASSIC) };
    (0..frames).for_each(|_| _ = solver.step(&input, &mut ()));
    solver
}

const NOTHING: CollisionEvent = CollisionEvent {
    count: 1,
    probability: 1.0,
    emit: 0,
    split: 0,
    random: false,
    die: false,
    spread: 0.0,
    target: BEADS,
    lifespan: [10.0, 0.0],
};

#[test]
fn a_particle_emits_splits_or_dies_when_it_collides() {
    assert_eq!(count(&dropped(NOTHING.clone(), 10)), 1);
    let emitted = dropped(CollisionEvent { emit: 3, ..NOTHING.clone() }, 8);
    let mut ages = Vec::new();
    emitted.particles(BEADS, &mut ages);
    assert_eq!(ages.len(), 4);
    // Falling 0.25 m takes 0.226 s, in the sixth frame; the emitted ones are younger by that.
    assert!(ages[0].age > 0.3 && ages[1..].iter().all(|one| one.age < 0.13 && one.lifespan == 10.0));
    let split = dropped(CollisionEvent { split: 3, ..NOTHING.clone() }, 8);
    split.particles(BEADS, &mut ages);
    assert!(ages.len() == 3 && ages.iter().all(|one| one.age == ages[0].age), "{ages:?}");
    assert_eq!(count(&dropped(CollisionEvent { die: true, ..NOTHING.clone() }, 8)), 0);
    assert_eq!(count(&dropped(CollisionEvent { die: true, emit: 5, ..NOTHING.clone() }, 8)), 5);
    assert_eq!(count(&dropped(CollisionEvent { die: true, probability: 0.0, ..NOTHING }, 8)), 1);
}

#[test]
fn an_event_happens_at_its_collision_and_new_particles_fly_with_the_rebound() {
    // The second bounce comes 0.46 s after the start at half the speed.
    let second = CollisionEvent { count: 2, emit: 2, ..NOTHING };
    assert_eq!(count(&dropped(second.clone(), 9)), 1);
    assert_eq!(count(&dropped(second, 13)), 3);
    let narrow = dropped(CollisionEvent { emit: 4, spread: 0.0, ..NOTHING }, 6);
    let mut fast = Vec::new();
    narrow.velocities(BEADS, 1.0, &mut fast);
    assert!(fast.len() == 5 && fast.iter().all(|v| (v[1] - fast[0][1]).abs() < 0.3), "{fast:?}");
}

#[test]
fn parts_of_a_particle_rebound_with_it_from_a_sheet_that_moves_at_them() {
    for bounce in [0.0, 0.5] {
        let event = CollisionEvent { split: 4, spread: 0.2, ..NOTHING };
        let particles = Particles { capacity: 64, radius: 0.05, events: vec![event], ..Particles::default() };
        let start = Start { velocities: vec![Vec3::y() * -3.0], ..Start::default() };
        let bead = Cloth { start, ..cloth(&[Vec3::new(0.1, 0.0, 0.2)], particles) };
        let mut builder = ModelBuilder::new();
        builder.cloth(bead).expect("a good object");
        let at = |height: f64| -> Vec<Vec3> {
            [[-1.0, -1.0], [-1.0, 1.0], [1.0, 1.0], [1.0, -1.0]].map(|[x, z]| Vec3::new(x, height, z)).into()
        };
        let faces = [[0, 1, 2, 3]].iter().map(|face| &face[..]).collect();
        let sheet = Surface { positions: at(-0.5), faces };
        builder.collider(Collider { surface: sheet }).expect("a good mesh");
        let mut solver: Solver = Solver::new(builder, 1);
        let still = SelfCollision { on: false, ..balls(0.05).self_collision };
        let settings = ClothFrame { bounce, self_collision: still, ..balls(0.05) };
        let mut input = solver.default_frame();
        (input.gravity, input.cloths[0]) = (Vec3::zeros(), settings);
        input.colliders[0].friction = 0.0;
        let mut height = -0.5;
        for _ in 0..6 {
            height += 5.0 / 24.0;
            input.colliders[0].end = at(height);
            solver.step(&input, &mut ());
        }
        let (mut places, mut fast) = (Vec::new(), Vec::new());
        solver.positions(BEADS, 1.0, &mut places);
        solver.velocities(BEADS, 1.0, &mut fast);
        // Seen from the sheet they come at 8 m/s.
        let rebound = 5.0 + 8.0 * bounce;
        assert_eq!(places.len(), 4);
        assert!(places.iter().all(|place| f64::from(place[1]) > height), "{bounce}: {places:?} at {height}");
        assert!(fast.iter().all(|v| f64::from(v[1]) > 0.9 * rebound), "{bounce}: {fast:?}");
    }
}

#[test]
fn what_a_collision_makes_does_not_collide_there_again() {
    // Nothing rebounds: the new particles stay where they begin.
    for event in [CollisionEvent { emit: 5, ..NOTHING }, CollisionEvent { split: 6, ..NOTHING }] {
        let settings = ClothFrame { bounce: 0.0, ..balls(0.05) };
        assert_eq!(count(&dropped_with(settings, event.clone(), 8)), 6, "{event:?}");
    }
}

#[test]
fn events_that_feed_themselves_are_bounded_by_the_room() {
    let all = CollisionEvent { count: 0, emit: 9, spread: 1.0, ..NOTHING };
    let solver = dropped(all, 40);
    assert_eq!(count(&solver), 64);
}

#[test]
fn a_checkpoint_continues_ramps_and_events_with_the_same_bits() {
    let event =
        CollisionEvent { count: 0, emit: 2, spread: 0.5, random: true, lifespan: [0.4, 0.2], ..NOTHING };
    let ramps = vec![
        ramp(RampTarget::Radius, RampInput::Age, 1.0, [0.5, 1.0]),
        ramp(RampTarget::Mass, RampInput::RandomizedId, 1.0, [1.0, 2.0]),
        ramp(RampTarget::Bounce, RampInput::Acceleration, 20.0, [1.0, 0.0]),
        ramp(RampTarget::Friction, RampInput::Speed, 2.0, [1.0, 0.5]),
    ];
    let particles = Particles {
        capacity: 200,
        radius: 0.05,
        ids: vec![3, 9],
        ages: vec![0.1, 0.0],
        lifespans: vec![0.9, f64::INFINITY],
        ramps,
        events: vec![event],
        rotates: true,
    };
    let own = cloth(&[Vec3::new(0.0, 0.3, 0.0), Vec3::new(0.02, 0.5, 0.0)], particles);
    let mut builder = ModelBuilder::new();
    builder.cloth(own).expect("valid particles");
    let births = |k: u32| {
        let position = Vec3::new(0.1 * f64::from(k % 3), 0.6, 0.0);
        vec![Birth { cloth: BEADS, time: 0.3, position, velocity: -Vec3::y(), lifespan: 1.0 }]
    };
    let input = |k: u32| FrameInput {
        plane: Some(ground(0.0)),
        cloths: vec![ClothFrame { bounce: 0.4, ..balls(0.05) }],
        births: births(k),
        ..frame(3, CLASSIC)
    };
    let mut whole = Solver::<f32>::new(builder.clone(), 1);
    (0..14).for_each(|k| _ = whole.step(&input(k), &mut ()));
    let saved = whole.save();
    let mut resumed = Solver::<f32>::restored(builder, 2, &saved).expect("a valid checkpoint");
    // Expressions read these before the next step.
    let seen = [&whole, &resumed].map(|solver| {
        let mut fast = Vec::new();
        solver.velocities(BEADS, 1.0, &mut fast);
        fast
    });
    assert!(seen[0] == seen[1]);
    for k in 14..40 {
        whole.step(&input(k), &mut ());
        resumed.step(&input(k), &mut ());
        assert_eq!(whole.state_hash(), resumed.state_hash(), "frame {k}");
    }
    let mut ages = Vec::new();
    whole.particles(BEADS, &mut ages);
    assert!(ages.len() > 10 && ages[0].id == 9, "{ages:?}");
}

#[test]
fn new_particles_that_would_overlap_are_left_out() {
    let born = |pruning: f64| {
        let mut solver = solver(cloth(&[Vec3::zeros()], Particles { capacity: 100, ..Particles::default() }));
        let cloth =
            ClothFrame { overlap_pruning: pruning, collide: false, feels_gravity: false, ..balls(0.1) };
        let births = (1..=50).map(|k| Birth {
            cloth: BEADS,
            time: 0.5,
            position: Vec3::x() * (0.02 * f64::from(k)),
            velocity: Vec3::zeros(),
            lifespan: f64::INFINITY,
        });
        let input = FrameInput { cloths: vec![cloth], births: births.collect(), ..frame(1, CLASSIC) };
        let report = solver.step(&input, &mut ());
        assert_eq!(report.births + report.births_pruned, 50);
        count(&solver)
    };
    // The contact distance is 0.2 m: along 1 m there is room for the one at 0 and five more, or ten at half of it.
    assert_eq!([born(0.0), born(0.999), born(0.499)], [51, 6, 11]);
}

#[test]
fn a_frame_changes_velocities_and_lifespans_of_single_particles() {
    let first = [Vec3::zeros(), Vec3::x(), Vec3::x() * 2.0];
    let mut solver = solver(cloth(&first, Particles { capacity: 3, ..Particles::default() }));
    let change = |place, velocity, lifespan| ParticleChange { cloth: BEADS, place, velocity, lifespan };
    let settings = ClothFrame { collide: false, ..still() };
    let input = FrameInput {
        gravity: Vec3::zeros(),
        cloths: vec![settings],
        particle_changes: vec![
            change(0, None, Some(0.0)),
            change(2, Some(Vec3::y() * 24.0), None),
            change(7, None, Some(0.0)),
        ],
        ..frame(1, CLASSIC)
    };
    solver.step(&input, &mut ());
    let all = places(&solver);
    assert_eq!(all.len(), 2);
    assert!((all[1] - Vec3::new(2.0, 24.0 * COUNT_PERIOD, 0.0)).norm() < 1e-6, "{all:?}");
}

/// A heap of three balls on the ground that leans: without persistent friction it creeps.
#[test]
fn a_death_elsewhere_in_the_object_does_not_drop_friction() {
    let slope = Vec3::new(0.25, 1.0, 0.0);
    let run = |with_deaths: bool| {
        // A ball on a pinned plate of two pinned balls, and others far away that die one after another.
        let first: Vec<Vec3> =
            [Vec3::new(-0.095, 0.0, 0.0), Vec3::new(0.095, 0.0, 0.0), Vec3::new(0.0, 0.178, 0.0)]
                .into_iter()
                .chain((0..20).map(|k| Vec3::new(50.0 + f64::from(k), 0.0, 0.0)))
                .collect();
        let lifespans =
            (0..23).map(|k| if k < 3 || !with_deaths { f64::INFINITY } else { 0.1 * f64::from(k) }).collect();
        let order: Vec<Vec3> = first;
        let mut solver = solver(cloth(&order, Particles { capacity: 23, lifespans, ..Particles::default() }));
        let settings = ClothFrame { friction: 0.8, ..balls(0.1) };
        let hold = |point: u32| nucleus_core::Pin {
            cloth: BEADS,
            point: PointId(point),
            start: order[point as usize],
            end: order[point as usize],
        };
        let input = FrameInput {
            gravity: -slope.normalize() * 9.81,
            cloths: vec![settings],
            pins: vec![hold(0), hold(1)],
            ..frame(4, CLASSIC)
        };
        (0..48).for_each(|_| _ = solver.step(&input, &mut ()));
        solver.point(BEADS, 2)
    };
    let [with, without] = [run(true), run(false)];
    assert!((with - without).norm() < 1e-4, "{with} {without}");
}
