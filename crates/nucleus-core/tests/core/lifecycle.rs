//! Particles that are born and die.

use crate::scenes::{LINKS, Vec3, frame, grid, ground, physical, pins, sphere, still};
use nucleus_core::{
    Birth, COUNT_PERIOD, Cloth, ClothFrame, ClothId, ClothLists, Collider, ColliderFrame, Elements,
    ExcludedSide, Exclusion, FrameInput, Mass, ModelBuilder, Particle, Particles, Pin, PointId,
    ResistanceModel, RestoreError, SelfCollision, Solver, StateView, Surface,
};

const BEADS: ClothId = ClothId(0);
const CLASSIC: ResistanceModel = ResistanceModel::Classic;

/// Room for particles of this mass in kilograms, of which some are there at the start, each with a lifespan.
fn room(capacity: usize, first: &[Vec3], lifespans: &[f64], mass: f64) -> Cloth {
    let surface = Surface { positions: first.to_vec(), faces: Default::default() };
    let lists = ClothLists { air: true, self_collision: true, ..ClothLists::NONE };
    let particles = Some(Particles { capacity, lifespans: lifespans.to_vec(), ..Particles::default() });
    Cloth { particles, ..Cloth::new(surface, Mass::PerPoint(mass), lists) }
}

fn solver(cloth: Cloth, threads: usize) -> Solver<f32> {
    let mut builder = ModelBuilder::new();
    builder.cloth(cloth).expect("valid particles");
    Solver::new(builder, threads)
}

/// Free particles in a vacuum.
fn free() -> ClothFrame {
    ClothFrame { collide: false, ..still() }
}

fn balls(radius: f64) -> ClothFrame {
    let own = SelfCollision { on: true, thickness: radius, elements: Elements::Points, edges: false };
    ClothFrame { thickness: radius, elements: Elements::Points, self_collision: own, ..still() }
}

fn birth(time: f64, position: Vec3, velocity: Vec3, lifespan: f64) -> Birth {
    Birth { cloth: BEADS, time, position, velocity, lifespan }
}

fn places(solver: &Solver<f32>) -> Vec<Vec3> {
    let mut out = Vec::new();
    solver.positions(BEADS, 1.0, &mut out);
    out.into_iter().map(|p| Vec3::from(p.map(f64::from))).collect()
}

fn ages(solver: &Solver<f32>) -> Vec<Particle> {
    let mut out = Vec::new();
    solver.particles(BEADS, &mut out);
    out
}

/// Births at the origin with this velocity, `rate` per frame, in frame number `number`.
fn even_births(number: u32, rate: f64, velocity: Vec3) -> Vec<Birth> {
    let first = (f64::from(number) * rate).floor() as u32 + 1;
    let last = (f64::from(number + 1) * rate).floor() as u32;
    let time = |k: u32| f64::from(k) / rate - f64::from(number);
    (first..=last).map(|k| birth(time(k).clamp(0.0, 1.0), Vec3::zeros(), velocity, f64::INFINITY)).collect()
}

#[test]
fn a_steady_emitter_leaves_an_even_trail_within_frames_and_across_them() {
    for (substeps, resistance) in [(1, CLASSIC), (3, CLASSIC), (4, physical(96.0))] {
        for (gravity, drag) in [(0.0, 0.0), (9.81, 0.0), (0.0, 0.3), (9.81, 0.3)] {
            let mut solver = solver(room(400, &[], &[], 1.0), 1);
            let cloth = ClothFrame { drag, tangential_drag: 1.0, lift: 0.0, ..free() };
            for number in 0..10 {
                let input = FrameInput {
                    births: even_births(number, 7.3, Vec3::new(2.0, 0.0, 0.0)),
                    gravity: -Vec3::y() * gravity,
                    air_density: 1.0,
                    cloths: vec![cloth],
                    ..frame(substeps, resistance)
                };
                assert_eq!(solver.step(&input, &mut ()).births_refused, 0);
            }
            let places = places(&solver);
            assert_eq!(places.len(), 73);
            // A particle is a function of its age: position is smooth over the row of particles. A pulse would show as a
            // spacing that differs from the mean of its neighbours.
            let spacing: Vec<f64> = places.windows(2).map(|pair| (pair[0] - pair[1]).norm()).collect();
            for three in spacing.windows(3) {
                let bump = (three[1] - (three[0] + three[2]) / 2.0).abs() / three[1];
                assert!(bump < 3e-3, "{substeps} substeps, gravity {gravity}, drag {drag}: {bump}");
            }
            if gravity == 0.0 && drag == 0.0 {
                let even = 2.0 * COUNT_PERIOD / 7.3;
                assert!(spacing.iter().all(|s| (s / even - 1.0).abs() < 1e-4), "{spacing:?}");
            }
        }
    }
}

#[test]
fn particles_in_air_may_be_far_fewer_than_there_is_room_for() {
    let mut solver = solver(room(40_000, &[], &[], 1.0), 2);
    let cloth = ClothFrame { drag: 0.3, tangential_drag: 1.0, lift: 0.0, ..free() };
    for number in 0..3 {
        let births = even_births(number, 1400.0, Vec3::x());
        let input = FrameInput { births, air_density: 1.0, cloths: vec![cloth], ..frame(1, CLASSIC) };
        solver.step(&input, &mut ());
    }
    assert_eq!(places(&solver).len(), 4200);
}

#[test]
fn a_particle_born_within_a_frame_falls_like_one_that_was_there() {
    // Both start from rest at the origin, one a third of a frame later; after t seconds each has fallen as symplectic
    // Euler says: g t (t + h) / 2.
    let mut solver = solver(room(4, &[Vec3::zeros()], &[], 1.0), 1);
    let input = |births| FrameInput { births, cloths: vec![free()], ..frame(4, CLASSIC) };
    solver.step(&input(vec![birth(1.0 / 3.0, Vec3::zeros(), Vec3::zeros(), f64::INFINITY)]), &mut ());
    (0..11).for_each(|_| _ = solver.step(&input(Vec::new()), &mut ()));
    let h = COUNT_PERIOD / 4.0;
    for (place, late) in places(&solver).iter().zip([0.0, 1.0 / 3.0]) {
        let time = (12.0 - late) * COUNT_PERIOD;
        let fallen = 9.81 * time * (time + h) / 2.0;
        assert!((place.y / -fallen - 1.0).abs() < 1e-5, "{} for {fallen}", place.y);
    }
}

// EVIDENCE: N2.4-17  particles that collide with nothing, or with objects only, need no second substep
#[test]
fn particles_independent_of_each_other_fall_exactly_as_one() {
    let alone = {
        let mut solver = solver(room(1, &[Vec3::new(0.3, 2.0, 0.1)], &[], 1.0), 1);
        let input = FrameInput {
            plane: Some(ground(0.2)),
            cloths: vec![collides_with_ground()],
            ..frame(1, CLASSIC)
        };
        (0..48).for_each(|_| _ = solver.step(&input, &mut ()));
        places(&solver)[0]
    };
    let many: Vec<Vec3> = (0..2000).map(|k| Vec3::new(0.3 + f64::from(k), 2.0, 0.1)).collect();
    let mut all = solver(room(2000, &many, &[], 1.0), 2);
    let input =
        FrameInput { plane: Some(ground(0.2)), cloths: vec![collides_with_ground()], ..frame(1, CLASSIC) };
    (0..48).for_each(|_| _ = all.step(&input, &mut ()));
    assert!(places(&all).iter().all(|place| place.y.to_bits() == alone.y.to_bits()), "to the last bit");
    assert!((alone.y - 0.05).abs() < 1e-6, "it rests on the ground: {}", alone.y);
}

fn collides_with_ground() -> ClothFrame {
    ClothFrame { self_collision: SelfCollision::OFF, ..balls(0.05) }
}

#[test]
fn particles_die_at_their_age_and_the_others_keep_their_order() {
    let first: Vec<Vec3> = (0..6).map(|k| Vec3::x() * f64::from(k)).collect();
    let lifespans = [0.2, 10.0, 0.1, 10.0, 0.2, 0.05];
    let mut solver = solver(room(8, &first, &lifespans, 1.0), 1);
    let input = FrameInput { gravity: Vec3::zeros(), cloths: vec![free()], ..frame(2, CLASSIC) };
    let mut deaths = Vec::new();
    for number in 1..=6 {
        let report = solver.step(&input, &mut ());
        assert_eq!(report.particles as usize, places(&solver).len());
        deaths.push(report.deaths);
        let now = f64::from(number) * COUNT_PERIOD;
        let alive: Vec<u64> = (0..6).filter(|&k| lifespans[k as usize] > now + 1e-9).collect();
        assert_eq!(ages(&solver).iter().map(|age| age.id).collect::<Vec<_>>(), alive, "frame {number}");
        assert!(places(&solver).iter().zip(&alive).all(|(place, &id)| place.x == id as f64));
        assert!(ages(&solver).iter().all(|age| (age.age - now).abs() < 1e-12));
    }
    assert_eq!(deaths, [0, 1, 1, 0, 2, 0]);
}

#[test]
fn particles_that_do_not_collide_with_the_ground_fall_through_it_whoever_dies_or_is_born() {
    let first: Vec<Vec3> = (0..8).map(|k| Vec3::new(f64::from(k), 0.06, 0.0)).collect();
    let lifespans: Vec<f64> = (0..8).map(|k| if k % 2 == 0 { f64::from(k) / 64.0 } else { 10.0 }).collect();
    let mut solver = solver(room(16, &first, &lifespans, 1.0), 1);
    let all = ExcludedSide::Points((0..16).map(|k| (BEADS, PointId(k))).collect(), Vec::new());
    let exclusion = Exclusion { sides: [all, ExcludedSide::Everything] };
    let mut input = FrameInput {
        cloths: vec![balls(0.05)],
        plane: Some(ground(0.0)),
        exclusions: vec![exclusion.into()],
        ..frame(4, physical(96.0))
    };
    let mut reports = Vec::new();
    for number in 0..6 {
        let at = Vec3::new(-1.0 - f64::from(number), 0.06, 0.0);
        input.births = vec![birth(0.4, at, Vec3::y() * -2.0, 10.0)];
        reports.push(solver.step(&input, &mut ()));
    }
    assert!(
        reports.iter().any(|report| report.deaths > 0) && reports.iter().all(|report| report.contacts == 0)
    );
    let fallen = |time: f64| 0.06 - 9.81 / 2.0 * time * time;
    for (place, particle) in places(&solver).iter().zip(ages(&solver)) {
        let own = if particle.id < 8 { 0.0 } else { -2.0 };
        let expected = fallen(particle.age) + own * particle.age;
        assert!((place.y - expected).abs() < 0.02, "{particle:?} at {place:?}, not {expected}");
    }
}

#[test]
fn births_beyond_the_room_or_at_no_position_are_refused_and_counted() {
    let mut solver = solver(room(3, &[Vec3::zeros()], &[], 1.0), 1);
    let mut births = even_births(0, 4.0, Vec3::x());
    births[0].position.x = f64::NAN;
    let input = FrameInput { births, cloths: vec![free()], ..frame(2, CLASSIC) };
    let report = solver.step(&input, &mut ());
    assert_eq!((report.births, report.births_refused, report.particles), (2, 2, 3));
    assert!(report.finite);
}

#[test]
fn particles_of_given_masses_have_room_for_others_of_the_mass_at_birth() {
    let mut cloth = room(5, &[Vec3::zeros(), Vec3::x()], &[], 2.0);
    cloth.vertex_maps.mass = vec![0.5, 4.0];
    let mut solver = solver(cloth, 1);
    let births = vec![birth(0.5, Vec3::y(), Vec3::zeros(), 1.0)];
    solver.step(&FrameInput { births, cloths: vec![free()], ..frame(2, CLASSIC) }, &mut ());
    assert_eq!([0, 1, 2].map(|at| solver.mass(ClothId(0), PointId(at))), [1.0, 8.0, 2.0]);
}

#[test]
fn a_particle_that_dies_makes_room_for_the_next() {
    let mut solver = solver(room(2, &[], &[], 1.0), 1);
    for number in 0..48 {
        let mut births = even_births(number, 1.0, Vec3::x());
        births.iter_mut().for_each(|birth| birth.lifespan = 1.9 * COUNT_PERIOD);
        let report = solver.step(&FrameInput { births, cloths: vec![free()], ..frame(2, CLASSIC) }, &mut ());
        assert_eq!(report.births_refused, 0, "frame {number}");
    }
    assert_eq!(ages(&solver).last().map(|age| age.id), Some(47));
}

#[test]
fn a_birth_that_would_touch_more_than_sixty_four_others_is_refused_and_counted() {
    for (radius, born) in [(0.01, 65), (0.0, 1000)] {
        let mut solver = solver(room(1000, &[], &[], 1.0), 1);
        let births = (0..1000).map(|_| birth(1.0, Vec3::zeros(), Vec3::zeros(), f64::INFINITY)).collect();
        let mut cloth = balls(radius);
        cloth.self_collision.on = radius > 0.0;
        let report = solver.step(&FrameInput { births, cloths: vec![cloth], ..frame(1, CLASSIC) }, &mut ());
        assert_eq!((report.births, report.births_refused), (born, 1000 - born), "radius {radius}");
    }
}

/// Beads that are poured on a ball, a sheet and the ground, and die.
struct Pour {
    builder: ModelBuilder,
    sheet: Surface,
}

impl Pour {
    fn new() -> Self {
        let mut sheet = grid(9, 9, Vec3::x() * 0.4, Vec3::z() * 0.4);
        sheet.positions.iter_mut().for_each(|p| *p += Vec3::new(-0.2, 0.3, -0.2));
        let mut builder = ModelBuilder::new();
        builder.cloth(room(300, &[], &[], 0.003)).expect("valid particles");
        let lists = ClothLists { cross_links: true, self_collision: true, ..LINKS };
        builder.cloth(Cloth::new(sheet.clone(), Mass::PerArea(0.3), lists)).expect("a good mesh");
        builder.collider(Collider { surface: sphere(0.1, Vec3::zeros()) }).expect("a good mesh");
        Self { builder, sheet }
    }

    fn input(&self, number: u32) -> FrameInput {
        let mut births = even_births(number, 9.7, -Vec3::y());
        for (k, birth) in births.iter_mut().enumerate() {
            let turn = f64::from(number * 16 + k as u32);
            birth.position = Vec3::new(0.1 * (turn * 1.3).sin(), 0.6, 0.1 * (turn * 2.1).cos());
            birth.lifespan = 0.4 + 0.1 * (turn * 0.7).sin();
        }
        let own = SelfCollision { on: true, thickness: 0.003, elements: Elements::Faces, edges: true };
        let corners = pins(&self.sheet, [0, 8, 72, 80]).into_iter();
        FrameInput {
            births,
            plane: Some(ground(0.2)),
            cloths: vec![balls(0.012), ClothFrame { thickness: 0.003, self_collision: own, ..still() }],
            colliders: vec![ColliderFrame { collide: true, thickness: 0.002, ..ColliderFrame::default() }],
            pins: corners.map(|pin| Pin { cloth: ClothId(1), ..pin }).collect(),
            ..frame(2, physical(48.0))
        }
    }
}

#[test]
fn births_and_deaths_have_the_same_bits_on_any_number_of_threads_and_after_a_checkpoint() {
    let pour = Pour::new();
    let run = |threads: usize, resumed_at: Option<u32>| {
        let mut solver = Solver::<f32>::new(pour.builder.clone(), threads);
        let mut hashes = Vec::new();
        for number in 0..24 {
            if resumed_at == Some(number) {
                solver =
                    Solver::restored(pour.builder.clone(), threads, &solver.save()).expect("its own state");
            }
            let report = solver.step(&pour.input(number), &mut ());
            assert!(report.finite && report.births_refused == 0);
            hashes.push((solver.state_hash(), report.particles, report.deaths));
        }
        hashes
    };
    let one = run(1, None);
    assert!(one.iter().map(|frame| frame.2).sum::<u64>() > 50, "many die");
    assert!(one == run(2, None), "two threads");
    assert!(one == run(1, Some(15)), "resumed");
}

#[test]
fn a_checkpoint_keeps_the_room_that_it_had() {
    let input = |number| FrameInput {
        births: even_births(number, 5.0, Vec3::x()),
        cloths: vec![free()],
        ..frame(2, CLASSIC)
    };
    let model = |capacity| {
        let mut builder = ModelBuilder::new();
        builder.cloth(room(capacity, &[], &[], 1.0)).expect("valid particles");
        builder
    };
    let mut solver = Solver::<f32>::new(model(64), 1);
    (0..4).for_each(|number| _ = solver.step(&input(number), &mut ()));
    let saved = solver.save();
    // A scene that has become longer may ask for more: births beyond the room would be lost.
    let longer = Solver::<f32>::restored(model(256), 1, &saved).map(|_| ());
    assert_eq!(longer, Err(RestoreError::SmallerCapacity { found: 64, wanted: 256 }));
    let mut again = Solver::<f32>::restored(model(32), 1, &saved).expect("the same objects");
    for number in 4..8 {
        solver.step(&input(number), &mut ());
        again.step(&input(number), &mut ());
        assert_eq!(solver.state_hash(), again.state_hash());
    }
}

#[test]
fn particles_that_die_do_not_disturb_those_that_rest() {
    // Ten beads rest on the ground beside each other; every third frame one dies.
    let first: Vec<Vec3> = (0..10).map(|k| Vec3::new(0.1 * f64::from(k), 0.05, 0.0)).collect();
    let lifespans: Vec<f64> =
        (0..10).map(|k| if k % 2 == 0 { 0.2 + 0.1 * f64::from(k) } else { 1e9 }).collect();
    let mut solver = solver(room(10, &first, &lifespans, 0.01), 1);
    let input = FrameInput {
        plane: Some(ground(0.5)),
        cloths: vec![ClothFrame { friction: 0.5, ..balls(0.05) }],
        ..frame(3, physical(96.0))
    };
    for _ in 0..48 {
        let report = solver.step(&input, &mut ());
        assert!(report.kinetic_energy < 1e-6, "{report:?}");
    }
    let left = places(&solver);
    assert_eq!(left.len(), 5);
    for (place, age) in left.iter().zip(ages(&solver)) {
        assert!((place - first[age.id as usize]).norm() < 1e-4, "{place}");
    }
}

#[test]
fn particles_born_inside_the_reach_of_a_moving_collider_stay_outside_of_it() {
    let ball = sphere(0.2, Vec3::zeros());
    let mut builder = ModelBuilder::new();
    builder.cloth(room(512, &[], &[], 0.01)).expect("valid particles");
    builder.collider(Collider { surface: ball.clone() }).expect("a good mesh");
    let mut solver = Solver::<f32>::new(builder, 1);
    for number in 0..24 {
        let centre = |number: u32| Vec3::x() * (0.02 * f64::from(number));
        let end = ball.positions.iter().map(|p| p + centre(number + 1)).collect();
        let mut births = even_births(number, 12.4, -Vec3::y() * 20.0);
        for (k, birth) in births.iter_mut().enumerate() {
            birth.position = centre(number) + Vec3::new(0.02 * (k as f64 - 6.0), 0.7, 0.01);
        }
        let input = FrameInput {
            births,
            cloths: vec![ClothFrame { self_collision: SelfCollision::OFF, ..balls(0.01) }],
            colliders: vec![ColliderFrame {
                end,
                collide: true,
                thickness: 0.002,
                ..ColliderFrame::default()
            }],
            ..frame(2, CLASSIC)
        };
        let report = solver.step(&input, &mut ());
        assert_eq!(report.pairs_unresolved, 0, "frame {number}");
        let inside = |p: &Vec3| (p - centre(number + 1)).norm() < crate::scenes::INSCRIBED * 0.2;
        assert_eq!(places(&solver).iter().filter(|p| inside(p)).count(), 0, "frame {number}");
    }
}

/// The heights of particles that are emitted at 100 m/s at a wall 0.2 m below, which is one square and moves at 2.4 m/s along
/// the way, less the height of the wall; and those of the ground plane, or of pinned cloth, in its place.
fn heights_above(obstacle: &str, wall_speed: f64) -> Vec<f64> {
    let mut wall = grid(2, 2, Vec3::x() * 2000.0, -Vec3::z() * 2000.0);
    wall.positions.iter_mut().for_each(|p| *p += Vec3::new(-1000.0, 0.0, 1000.0));
    let mut sheet = grid(5, 5, Vec3::x() * 4.0, Vec3::z() * 4.0);
    sheet.positions.iter_mut().for_each(|p| *p -= Vec3::new(2.1, 0.0, 2.1));
    let mut builder = ModelBuilder::new();
    builder.cloth(room(100, &[], &[], 1.0)).expect("valid particles");
    let lists = ClothLists { self_collision: true, ..LINKS };
    builder.cloth(Cloth::new(sheet.clone(), Mass::PerArea(0.3), lists)).expect("a good mesh");
    builder.collider(Collider { surface: wall.clone() }).expect("a good mesh");
    let mut solver = Solver::<f32>::new(builder, 1);
    let height = |frames: f64| Vec3::y() * (wall_speed * frames * COUNT_PERIOD);
    let at = |frames: f64| wall.positions.iter().map(|p| p + height(frames)).collect::<Vec<_>>();
    let collides = |here: &str| ClothFrame { collide: obstacle == here, ..still() };
    for number in 0..4 {
        let mut births = even_births(number, 9.7, Vec3::new(3.0, -100.0, 0.0));
        births.iter_mut().for_each(|birth| birth.position.y = 0.2 + wall_speed.abs() * 4.0 * COUNT_PERIOD);
        let now = f64::from(number);
        let collide = obstacle == "wall";
        let wall = ColliderFrame { start: at(now), end: at(now + 1.0), collide, ..Default::default() };
        let pins = pins(&sheet, 0..25).into_iter().map(|pin| Pin {
            cloth: ClothId(1),
            start: pin.start + height(now),
            end: pin.start + height(now + 1.0),
            ..pin
        });
        let own = SelfCollision { on: true, thickness: 0.002, elements: Elements::Faces, edges: false };
        let beads = ClothFrame { self_collision: SelfCollision::OFF, ..balls(0.002) };
        let input = FrameInput {
            births,
            plane: (obstacle == "ground").then(|| ground(0.1)),
            cloths: vec![beads, ClothFrame { thickness: 0.002, self_collision: own, ..collides("cloth") }],
            colliders: vec![wall],
            pins: pins.collect(),
            ..frame(1, physical(24.0))
        };
        let report = solver.step(&input, &mut ());
        assert_eq!((report.births_refused, report.pairs_unresolved), (0, 0));
    }
    places(&solver).iter().map(|place| place.y - height(4.0).y).collect()
}

// EVIDENCE: N2.3-4  nothing passes through a collider or cloth, from its first moment on
#[test]
fn a_particle_that_is_born_at_high_speed_beside_a_surface_does_not_pass_it() {
    let moving = ["wall", "cloth"].into_iter().flat_map(|it| [0.0, 2.4, -2.4].map(|speed| (it, speed)));
    for (obstacle, speed) in moving.chain([("ground", 0.0)]) {
        let heights = heights_above(obstacle, speed);
        assert_eq!(heights.len(), 38);
        assert!(heights.iter().all(|&height| height > 0.0), "{obstacle} at {speed} m/s: {heights:?}");
    }
    assert!(heights_above("nothing", 0.0).iter().all(|&height| height < 0.0), "nothing is in the way");
}
