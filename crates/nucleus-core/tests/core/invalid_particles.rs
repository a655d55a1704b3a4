//! Births, events and models that cannot be: refused, or dropped and reported.

use crate::scenes::{LINKS, Vec3, drape, frame, grid, ground, physical, still};
use nucleus_core::{
    Birth, BuildError, Cloth, ClothFrame, ClothId, ClothLists, Collider, ColliderId, CollisionEvent,
    Elements, FrameInput, InvalidInput, LinkOrder, Mass, ModelBuilder, Particles, PointId, Solver, StateView,
    StepReport, Surface, VertexMaps,
};

const BEADS: ClothId = ClothId(0);

fn cloth(first: &[Vec3], particles: Particles) -> Cloth {
    let surface = Surface { positions: first.to_vec(), ..Surface::default() };
    Cloth { particles: Some(particles), ..Cloth::new(surface, Mass::PerPoint(0.01), ClothLists::NONE) }
}

fn birth(time: f64) -> Birth {
    Birth { cloth: BEADS, time, position: Vec3::y(), velocity: Vec3::x(), lifespan: 5.0 }
}

/// Solves a frame with these births beside a ball: the state, and the report.
fn born(births: Vec<Birth>) -> (u64, StepReport) {
    let mut builder = ModelBuilder::new();
    let room = Particles { capacity: 9, ..Particles::default() };
    builder.cloth(cloth(&[], room)).expect("good particles");
    builder.collider(Collider { surface: Surface::sphere(Vec3::zeros(), 0.3, 3) }).expect("a good mesh");
    let mut solver: Solver = Solver::new(builder, 1);
    let input = FrameInput { births, ..solver.default_frame() };
    let report = solver.step(&input, &mut ());
    (solver.state_hash(), report)
}

#[test]
fn births_that_cannot_happen_are_dropped_and_reported() {
    let (expected, usual) = born(vec![birth(0.2), birth(0.8)]);
    assert_eq!((usual.births, usual.sanitized.count), (2, 0));
    let bad = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, -1.0, 2.0].map(birth);
    let far = [f64::NAN, 1e300].map(|x| Birth { position: Vec3::x() * x, ..birth(0.5) });
    let fast = [f64::NAN, 1e300].map(|x| Birth { velocity: Vec3::x() * x, ..birth(0.5) });
    let other = [Birth { lifespan: f64::NAN, ..birth(0.5) }, Birth { cloth: ClothId(7), ..birth(0.5) }];
    for wrong in bad.into_iter().chain(far).chain(fast).chain(other) {
        for at in 0..3 {
            let mut births = vec![birth(0.2), birth(0.8)];
            births.insert(at, wrong);
            let (state, report) = born(births);
            assert_eq!(report.sanitized.first, Some(InvalidInput::Birth(wrong.cloth)), "{wrong:?}");
            assert_eq!((state, report.births, report.births_refused), (expected, 2, 1), "{wrong:?}");
            assert_eq!(report.sanitized.count, 1);
        }
    }
}

#[test]
fn births_happen_in_the_order_of_their_times_however_they_are_given() {
    let (expected, _) = born(vec![birth(0.1), birth(0.5), birth(1.0)]);
    let (state, report) = born(vec![birth(1.0), birth(0.1), birth(0.5)]);
    assert_eq!((state, report.births, report.sanitized.count), (expected, 3, 0));
}

#[test]
fn births_of_a_frame_without_a_valid_duration_are_refused() {
    let mut builder = ModelBuilder::new();
    let particles = Particles { capacity: 8, ..Particles::default() };
    builder.cloth(cloth(&[Vec3::zeros()], particles)).expect("good particles");
    let mut solver: Solver = Solver::new(builder, 1);
    let birth = |at: f64| Birth {
        cloth: BEADS,
        time: 0.5,
        position: Vec3::x() * at,
        velocity: Vec3::zeros(),
        lifespan: f64::INFINITY,
    };
    let births = vec![birth(1.0), birth(f64::NAN), birth(2.0)];
    let input = FrameInput { duration: 0.0, births, ..frame(4, physical(24.0)) };
    let report = solver.step(&input, &mut ());
    assert_eq!((report.births, report.births_refused), (0, 3));
}

/// An event of no effect.
const NOTHING: CollisionEvent = CollisionEvent {
    count: 1,
    probability: 1.0,
    emit: 0,
    split: 0,
    random: false,
    die: false,
    spread: 1.0,
    target: BEADS,
    lifespan: [10.0, 1.0],
};

/// Drops particles on the ground with an event; the births and the refused births of half a second.
fn dropped(event: CollisionEvent) -> [u64; 2] {
    let particles = Particles { capacity: 64, radius: 0.05, events: vec![event], ..Particles::default() };
    let mut builder = ModelBuilder::new();
    builder.cloth(cloth(&[Vec3::y() * 0.3, Vec3::new(1.0, 0.3, 0.0)], particles)).expect("good particles");
    let mut solver: Solver = Solver::new(builder, 1);
    let settings = ClothFrame { thickness: 0.05, bounce: 0.5, elements: Elements::Points, ..still() };
    let input = FrameInput { plane: Some(ground(0.0)), cloths: vec![settings], ..frame(4, physical(24.0)) };
    let mut sums = [0; 2];
    for _ in 0..8 {
        let report = solver.step(&input, &mut ());
        sums = [sums[0] + report.births, sums[1] + report.births_refused];
        assert!(report.finite);
    }
    let mut ages = Vec::new();
    solver.particles(BEADS, &mut ages);
    assert!(ages.len() <= 64);
    sums
}

#[test]
fn an_event_makes_no_more_particles_than_there_is_room_for() {
    // Both particles add this many at once, and so does each new one later.
    for (emit, split) in [(100_000, 100_000), (u32::MAX, u32::MAX)] {
        let [births, refused] = dropped(CollisionEvent { emit, split, ..NOTHING });
        assert_eq!(births, 62);
        assert!(births + refused >= 2 * (u64::from(emit) + u64::from(split) - 1), "{refused}");
    }
}

#[test]
fn an_event_for_an_object_without_room_for_particles_is_refused_each_time() {
    assert_eq!(dropped(CollisionEvent { emit: 3, target: ClothId(9), ..NOTHING }), [0, 6]);
}

#[test]
fn events_and_radii_that_are_no_numbers_are_refused() {
    let refused = |particles: Particles| ModelBuilder::new().cloth(cloth(&[], particles)).unwrap_err();
    let usual = Particles { capacity: 9, ..Particles::default() };
    let events = [
        CollisionEvent { spread: f64::NAN, ..NOTHING },
        CollisionEvent { probability: f64::NAN, ..NOTHING },
        CollisionEvent { lifespan: [f64::NAN, 0.0], ..NOTHING },
        CollisionEvent { lifespan: [1.0, f64::INFINITY], ..NOTHING },
    ];
    for event in events {
        let events = vec![NOTHING, event];
        assert_eq!(refused(Particles { events, ..usual.clone() }), BuildError::BadEvent { event: 1 });
    }
    for radius in [f64::NAN, f64::INFINITY, -1.0] {
        let error = refused(Particles { radius, ..usual.clone() });
        assert!(matches!(error, BuildError::BadRadius { .. }), "{error:?}");
    }
    for capacity in [1 << 32, usize::MAX] {
        let error = refused(Particles { capacity, ..usual.clone() });
        assert!(matches!(error, BuildError::TooManyParticles { .. }), "{error:?}");
    }
}

#[test]
fn more_cloths_than_have_a_number_for_each_pair_are_refused() {
    let mut builder = ModelBuilder::new();
    let one = cloth(&[], Particles { capacity: 1, ..Particles::default() });
    (0..11_585).for_each(|at| assert_eq!(builder.cloth(one.clone()), Ok(ClothId(at))));
    let error = BuildError::TooManyCloths { most: 11_585 };
    assert_eq!(builder.cloth(one.clone()), Err(error));
}

#[test]
fn links_are_sorted_from_points_of_the_cloth_only() {
    let (mut builder, _) = drape(9, 24.0);
    let from = |point: u32| LinkOrder::Outwards(vec![PointId(point)]);
    assert_eq!(builder.set_link_order(ClothId(0), from(80)), Ok(()));
    let error = BuildError::NoSource { point: 81, points: 81 };
    assert_eq!(builder.set_link_order(ClothId(0), from(81)), Err(error));
    let error = BuildError::NoCloth { cloth: 1 };
    assert_eq!(builder.set_link_order(ClothId(1), LinkOrder::Mesh), Err(error));
    let maps = builder.set_collider_maps(ColliderId(1), VertexMaps::default());
    assert_eq!(maps, Err(BuildError::NoCollider { collider: 1 }));
}

#[test]
fn a_mesh_is_either_refused_as_too_small_or_stays_finite() {
    for scale in [1e-30, 1e-12, 1e-10, 1e-9, 1e-8, 1e-6] {
        let sheet = grid(5, 5, Vec3::x() * scale, Vec3::z() * scale);
        let mut builder = ModelBuilder::new();
        match builder.cloth(Cloth::new(sheet, Mass::PerArea(0.2), ClothLists { bend: true, ..LINKS })) {
            Err(error) => assert!(matches!(error, BuildError::TooSmall { .. }) && scale < 4e-9, "{error:?}"),
            Ok(_) => {
                let mut solver: Solver = Solver::new(builder, 1);
                let input = solver.default_frame();
                for _ in 0..4 {
                    assert!(solver.step(&input, &mut ()).finite, "{scale:e} m");
                }
            }
        }
    }
}
