//! Free points: particles without links that touch no other cloth, among colliders and on the ground.

use crate::scenes::{Vec3, built, cuboid, frame, ground, physical, sphere, still};
use nucleus_core::{
    Cloth, ClothFrame, ClothId, ClothLists, ColliderFrame, ConstraintFrame, Elements, Faces, FrameInput,
    GroundPlane, Link, LinkSide, Mass, ModelBuilder, PointId, ResistanceModel, SelfCollision, Solver, Start,
    StateView, Surface,
};

const SPRAY: ClothId = ClothId(0);
const RADIUS: f64 = 0.01;
const CLASSIC: ResistanceModel = ResistanceModel::Classic;

fn particles(positions: Vec<Vec3>, velocities: Vec<Vec3>, lists: ClothLists) -> Cloth {
    let start = Start { velocities, ..Start::default() };
    let surface = Surface { positions, faces: Faces::default() };
    Cloth { start, ..Cloth::new(surface, Mass::PerPoint(1e-3), lists) }
}

fn spray() -> ClothFrame {
    ClothFrame { thickness: RADIUS, elements: Elements::Points, friction: 0.0, ..still() }
}

fn solid() -> ColliderFrame {
    ColliderFrame { collide: true, friction: 0.0, ..ColliderFrame::default() }
}

/// Numbers between -1 and 1 without a pattern.
fn spread(count: usize) -> impl FnMut() -> Vec3 {
    let mut seed = count as u32;
    let mut next = move || {
        seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        f64::from(seed >> 8) / f64::from(1 << 23) - 1.0
    };
    move || Vec3::new(next(), next(), next())
}

fn places(solver: &impl StateView, count: usize) -> Vec<Vec3> {
    (0..count).map(|point| solver.point(SPRAY, point)).collect()
}

/// A cloud about a ball of 0.3 m, flying at up to so many metres per second. None starts inside.
fn cloud(count: usize, speed: f64) -> Cloth {
    let mut next = spread(count);
    let outside = |place: Vec3| if place.norm() < 0.35 { place.normalize() * 0.4 } else { place };
    let positions = (0..count).map(|_| outside(next() * 0.8)).collect();
    let velocities = (0..count).map(|_| next() * speed).collect();
    particles(positions, velocities, ClothLists::NONE)
}

#[test]
fn free_points_pass_through_no_ball_at_any_speed() {
    let count = 3000;
    for (speed, substeps, resistance) in
        [(1.0, 1, CLASSIC), (30.0, 1, CLASSIC), (30.0, 3, physical(24.0)), (300.0, 2, CLASSIC)]
    {
        let mut solver = Solver::<f32>::new(built(cloud(count, speed), [sphere(0.3, Vec3::zeros())]), 2);
        let input = FrameInput {
            cloths: vec![spray()],
            colliders: vec![solid()],
            plane: Some(GroundPlane { origin: -Vec3::y(), ..ground(0.2) }),
            ..frame(substeps, resistance)
        };
        let mut touched = 0;
        for _ in 0..24 {
            let report = solver.step(&input, &mut ());
            assert!(report.finite && report.pairs_unresolved == 0, "{speed} m/s: {report:?}");
            touched += report.contacts;
            for place in places(&solver, count) {
                // The faces of the mesh lie up to 0.4 mm inside the ball, and a particle keeps its radius from them.
                assert!(place.norm() > 0.3 - 0.0012 + 0.9 * RADIUS, "{speed} m/s: {place:?}");
                assert!(place.y > -1.0 + 0.99 * RADIUS, "{speed} m/s: {place:?}");
            }
        }
        assert!(touched as usize > count, "most of them hit something");
    }
}

#[test]
fn a_ball_that_moves_fast_passes_through_no_free_point() {
    let count = 2000;
    for (speed, substeps) in [(2.0, 1), (20.0, 1), (20.0, 4)] {
        let mut next = spread(count);
        let positions = (0..count).map(|_| next() * 0.5).collect();
        let cloth = particles(positions, Vec::new(), ClothLists::NONE);
        let ball = sphere(0.3, Vec3::zeros());
        let at = |x: f64| ball.positions.iter().map(|place| place + Vec3::x() * x).collect::<Vec<_>>();
        let mut solver = Solver::<f32>::new(built(cloth, [sphere(0.3, Vec3::x() * -1.0)]), 1);
        let mut input = FrameInput {
            gravity: Vec3::zeros(),
            cloths: vec![spray()],
            colliders: vec![solid()],
            ..frame(substeps, CLASSIC)
        };
        let length = input.duration;
        let mut x = -1.0;
        while x < 1.0 {
            (input.colliders[0].start, input.colliders[0].end) = (at(x), at(x + speed * length));
            let report = solver.step(&input, &mut ());
            x += speed * length;
            assert_eq!(report.pairs_unresolved, 0, "{speed} m/s");
            let nearest =
                places(&solver, count).iter().map(|p| (p - Vec3::x() * x).norm()).fold(9.0, f64::min);
            assert!(nearest > 0.3 - 0.0012 + 0.9 * RADIUS, "{speed} m/s, {substeps} substeps: {nearest}");
        }
    }
}

#[test]
fn a_free_point_slides_down_a_slope_as_the_law_of_friction_says() {
    let (angle, friction, time) = (0.5f64, 0.3, 12);
    let along = Vec3::new(angle.cos(), -angle.sin(), 0.0);
    let normal = Vec3::new(angle.sin(), angle.cos(), 0.0);
    let mut board = cuboid(Vec3::new(-2.0, -0.1, -1.0), Vec3::new(2.0, 0.0, 1.0));
    for place in &mut board.positions {
        *place = along * place.x + normal * place.y + Vec3::z() * place.z;
    }
    let cloth = particles(vec![along * -1.5 + normal * RADIUS], Vec::new(), ClothLists::NONE);
    for substeps in [4, 20] {
        let mut solver = Solver::<f64>::new(built(cloth.clone(), [board.clone()]), 1);
        let input = FrameInput {
            cloths: vec![spray()],
            colliders: vec![ColliderFrame { friction, ..solid() }],
            ..frame(substeps, CLASSIC)
        };
        (0..time).for_each(|_| _ = solver.step(&input, &mut ()));
        let seconds = f64::from(time) * input.duration;
        let exact = 9.81 * (angle.sin() - friction * angle.cos()) * seconds * seconds / 2.0;
        let way = solver.point(SPRAY, 0) - (along * -1.5 + normal * RADIUS);
        let error = way.dot(&along) / exact - 1.0;
        // N steps of symplectic Euler go N (N + 1) / 2 of the way of the first, not N² / 2.
        let ahead = 1.0 / f64::from(time * substeps);
        assert!((error - ahead).abs() < 1e-4, "{substeps} substeps: {error} for {ahead}");
        assert!(way.dot(&normal).abs() < 0.01 * RADIUS, "it stays on the slope");
    }
}

#[test]
fn a_free_point_rebounds_with_its_share_of_the_speed() {
    for on_ground in [true, false] {
        let cloth = particles(vec![Vec3::new(0.1, 0.5 + RADIUS, 0.05)], Vec::new(), ClothLists::NONE);
        let block = cuboid(Vec3::new(-1.0, -1.0, -1.0), Vec3::new(1.0, 0.0, 1.0));
        let mut solver = Solver::<f64>::new(built(cloth, [block]), 1);
        let input = FrameInput {
            cloths: vec![ClothFrame { bounce: 0.5, ..spray() }],
            colliders: vec![ColliderFrame { collide: !on_ground, ..solid() }],
            plane: on_ground.then(|| ground(0.0)),
            ..frame(40, CLASSIC)
        };
        let mut top: f64 = 0.0;
        for step in 0..16 {
            solver.step(&input, &mut ());
            if step > 8 {
                top = top.max(solver.point(SPRAY, 0).y - RADIUS);
            }
        }
        // A quarter of 0.5 m.
        assert!((top / 0.125 - 1.0).abs() < 0.05, "ground {on_ground}: {top}");
    }
}

#[test]
fn a_free_point_that_starts_inside_a_closed_mesh_leaves_it() {
    let cloth =
        particles(vec![Vec3::new(0.25, 0.02, 0.01), Vec3::new(0.0, 0.05, 0.0)], Vec::new(), ClothLists::NONE);
    let mut solver = Solver::<f32>::new(built(cloth, [sphere(0.3, Vec3::zeros())]), 1);
    let input = FrameInput {
        gravity: Vec3::zeros(),
        cloths: vec![spray()],
        colliders: vec![ColliderFrame { trapped_check: true, ..solid() }],
        ..frame(3, CLASSIC)
    };
    let first = solver.step(&input, &mut ());
    assert_eq!(first.depenetrating, 2);
    (0..16).for_each(|_| _ = solver.step(&input, &mut ()));
    let last = solver.step(&input, &mut ());
    assert_eq!(last.depenetrating, 0);
    for place in places(&solver, 2) {
        assert!(place.norm() > 0.3 - 0.0012 + 0.9 * RADIUS, "{place:?}");
    }
}

fn rain() -> (ModelBuilder, FrameInput) {
    let input = FrameInput {
        cloths: vec![ClothFrame { friction: 0.3, bounce: 0.3, stickiness: 0.1, ..spray() }],
        colliders: vec![ColliderFrame { friction: 0.2, ..solid() }],
        plane: Some(ground(0.2)),
        ..frame(2, CLASSIC)
    };
    (built(cloud(2500, 3.0), [sphere(0.3, Vec3::zeros())]), input)
}

#[test]
fn free_points_have_the_same_bits_on_any_number_of_threads_and_after_a_checkpoint() {
    let run = |threads: usize, saved_at: Option<usize>| {
        let (builder, input) = rain();
        let mut solver = Solver::<f32>::new(builder, threads);
        for step in 0..16 {
            if saved_at == Some(step) {
                solver = Solver::restored(rain().0, threads, &solver.save()).expect("its own state");
            }
            solver.step(&input, &mut ());
        }
        (solver.state_hash(), solver.save())
    };
    let one = run(1, None);
    assert!(one == run(2, None), "threads");
    assert!(one == run(3, Some(7)), "a checkpoint");
}

#[test]
fn points_that_begin_to_collide_with_each_other_pass_through_nothing() {
    let count = 400;
    let lists = ClothLists { self_collision: true, ..ClothLists::NONE };
    let mut next = spread(count);
    let positions = (0..count).map(|k| next() * 0.1 + Vec3::y() * (0.45 + 0.01 * k as f64)).collect();
    let cloth = particles(positions, Vec::new(), lists);
    let mut solver = Solver::<f32>::new(built(cloth, [sphere(0.3, Vec3::zeros())]), 1);
    let own = SelfCollision { on: true, thickness: RADIUS, elements: Elements::Points, edges: false };
    for step in 0..40 {
        let own = if (step / 8) % 2 == 1 { own } else { SelfCollision::OFF };
        let input = FrameInput {
            cloths: vec![ClothFrame { self_collision: own, ..spray() }],
            colliders: vec![solid()],
            ..frame(2, CLASSIC)
        };
        solver.step(&input, &mut ());
        for place in places(&solver, count) {
            assert!(place.norm() > 0.3 - 0.0012 + 0.5 * RADIUS, "frame {step}: {place:?}");
        }
    }
}

#[test]
fn the_motion_of_a_free_point_does_not_depend_on_the_others_or_their_order() {
    let count = 1500;
    let Cloth { surface, start, .. } = cloud(count, 20.0);
    let run = |order: &[usize]| {
        let positions = order.iter().map(|&at| surface.positions[at]).collect();
        let velocities = order.iter().map(|&at| start.velocities[at]).collect();
        let cloth = particles(positions, velocities, ClothLists::NONE);
        let mut solver = Solver::<f32>::new(built(cloth, [sphere(0.3, Vec3::zeros())]), 1);
        let (_, input) = rain();
        (0..12).for_each(|_| _ = solver.step(&input, &mut ()));
        let mut places = vec![Vec3::zeros(); count];
        order.iter().enumerate().for_each(|(at, &point)| places[point] = solver.point(SPRAY, at));
        places
    };
    let forward: Vec<usize> = (0..count).collect();
    let backward: Vec<usize> = (0..count).rev().collect();
    let mixed: Vec<usize> = (0..count).map(|at| at * 701 % count).collect();
    assert_eq!(run(&forward), run(&backward));
    assert_eq!(run(&forward), run(&mixed));
}

#[test]
fn a_constraint_of_other_objects_does_not_change_a_bit_of_free_points() {
    let run = |is_tied: bool| {
        let mut builder = built(cloud(400, 20.0), [sphere(0.3, Vec3::zeros())]);
        let other = particles(vec![Vec3::y() * 9.0], Vec::new(), ClothLists::NONE);
        builder.cloth(other).expect("a point");
        let mut solver = Solver::<f32>::new(builder, 1);
        let (_, mut input) = rain();
        input.cloths.push(ClothFrame { collide: false, ..spray() });
        let hold =
            Link::new([LinkSide::point(ClothId(1), PointId(0)), LinkSide::Space(Vec3::y() * 9.0)], 0.0);
        if is_tied {
            input.constraints =
                vec![ConstraintFrame { formed: Some(vec![hold]), ..ConstraintFrame::default() }];
        }
        (0..12).for_each(|_| _ = solver.step(&input, &mut ()));
        (places(&solver, 400), solver.point(ClothId(1), 0).y)
    };
    let (free, fallen) = run(false);
    let (beside, held) = run(true);
    assert!(fallen < 8.9 && held > 8.9, "{fallen} and {held}");
    assert_eq!(free, beside);
}

#[test]
fn a_free_point_between_a_ball_that_comes_down_and_the_ground_stays_outside_both() {
    let ball = sphere(0.3, Vec3::zeros());
    let at = |y: f64| ball.positions.iter().map(|place| place + Vec3::y() * y).collect::<Vec<_>>();
    let positions = (0..40).map(|k| Vec3::new(0.02 + 0.01 * f64::from(k), RADIUS, 0.003)).collect();
    let mut solver = Solver::<f32>::new(
        built(particles(positions, Vec::new(), ClothLists::NONE), [sphere(0.3, Vec3::y() * 0.6)]),
        1,
    );
    let mut y = 0.6;
    for _ in 0..20 {
        let next = f64::max(y - 0.04, 0.3 + 2.5 * RADIUS);
        let input = FrameInput {
            cloths: vec![spray()],
            colliders: vec![ColliderFrame { start: at(y), end: at(next), ..solid() }],
            plane: Some(ground(0.0)),
            ..frame(2, CLASSIC)
        };
        y = next;
        let report = solver.step(&input, &mut ());
        assert_eq!(report.pairs_unresolved, 0);
        for place in places(&solver, 40) {
            assert!(place.y > 0.99 * RADIUS, "{place:?}");
            assert!((place - Vec3::y() * y).norm() > 0.3 - 0.0012 + 0.9 * RADIUS, "ball at {y}: {place:?}");
        }
    }
}

#[test]
fn a_free_point_that_one_collider_pushes_into_another_passes_neither() {
    let count = 600;
    let mut next = spread(count);
    // A wedge between a slope that points hit and a wall beside it that they fly along.
    let positions = (0..count).map(|_| next() * 0.2 + Vec3::y() * 1.5).collect();
    let velocities = (0..count).map(|_| Vec3::new(0.0, -60.0, 0.0) + next() * 5.0).collect();
    let mut slope = cuboid(Vec3::new(-2.0, -0.1, -2.0), Vec3::new(2.0, 0.0, 2.0));
    for place in &mut slope.positions {
        (place.x, place.y) = ((place.x - place.y) * 0.7, (place.x + place.y) * 0.7);
    }
    // The slope pushes along -x and y, into the wall.
    let wall = cuboid(Vec3::new(-0.6, -3.0, -3.0), Vec3::new(-0.5, 3.0, 3.0));
    let mut solver =
        Solver::<f32>::new(built(particles(positions, velocities, ClothLists::NONE), [slope, wall]), 1);
    let input = FrameInput { cloths: vec![spray()], colliders: vec![solid(); 2], ..frame(1, CLASSIC) };
    for _ in 0..24 {
        let report = solver.step(&input, &mut ());
        assert_eq!(report.pairs_unresolved, 0);
        // Those that have slid off the sides of the slope are below it.
        for place in places(&solver, count).into_iter().filter(|place| place.z.abs() < 1.9) {
            let above_slope = (place.y - place.x) * 0.5f64.sqrt();
            assert!(place.x > -0.5 || place.y > 3.0, "behind the wall: {place:?}");
            assert!(above_slope > 0.0, "below the slope: {place:?}");
        }
    }
}
