//! Lift, wind shadows, pushed air, and the force fields of points.

use crate::scenes::{Vec3, frame, grid, physical, still};
use nucleus_core::{
    Cloth, ClothFrame, ClothId, ClothLists, Collider, ColliderFrame, ColliderId, FieldSide, ForceField,
    FrameInput, LinkOrder, Mass, ModelBuilder, PointField, Real, Solver, StateView, Surface, VertexMaps,
    WindField,
};

const CLOTH: ClothId = ClothId(0);
const AIRY: ClothLists = ClothLists { air: true, ..ClothLists::NONE };

/// A square of four points, `side` metres long, whose normal is `z`, with its middle at `place`.
fn tile(side: f64, place: Vec3) -> Surface {
    let mut tile = grid(2, 2, Vec3::x() * side, -Vec3::y() * side);
    tile.positions.iter_mut().for_each(|p| *p += place - Vec3::new(side, -side, 0.0) / 2.0);
    tile
}

fn air(wind: Vec3, cloths: Vec<ClothFrame>) -> FrameInput {
    FrameInput { gravity: Vec3::zeros(), wind, cloths, ..frame(2, physical(96.0)) }
}

fn mean_velocity<R: Real>(solver: &Solver<R>, cloth: ClothId, points: std::ops::Range<usize>) -> Vec3 {
    let mut column = Vec::new();
    solver.velocities(cloth, 1.0, &mut column);
    let count = points.len() as f64;
    column[points].iter().map(|v| Vec3::from(v.map(f64::from))).sum::<Vec3>() / count
}

/// What a frame adds to the velocity of the first cloth.
fn gain(mut solver: Solver<f64>, input: &FrameInput) -> Vec3 {
    let before = mean_velocity(&solver, CLOTH, 0..4);
    solver.step(input, &mut ());
    mean_velocity(&solver, CLOTH, 0..4) - before
}

fn solver(cloths: Vec<Cloth>, colliders: Vec<Surface>) -> Solver<f64> {
    let mut builder = ModelBuilder::new();
    cloths.into_iter().for_each(|cloth| {
        builder.cloth(cloth).expect("a good mesh");
    });
    colliders.into_iter().for_each(|surface| {
        builder.collider(Collider { surface }).expect("a good mesh");
    });
    Solver::new(builder, 1)
}

/// Lift: 1 kg/m² at 30° gains L v² sin 30° cos 30° across the stream, in air of any speed, and keeps its speed.
// EVIDENCE: N1.2-8  lift grows with the square of the speed and with the angle of attack, and does no work
#[test]
fn lift_is_the_square_of_the_speed_times_sine_and_cosine_of_the_angle() {
    let lift = 0.5;
    for speed in [1.0, 4.0, 16.0] {
        for degrees in [10.0f64, 30.0, 60.0] {
            let (sine, cosine) = degrees.to_radians().sin_cos();
            let mut cloth = Cloth::new(tile(1.0, Vec3::zeros()), Mass::PerArea(1.0), AIRY);
            let velocity = Vec3::new(cosine, 0.0, sine) * speed;
            cloth.start.velocities = vec![velocity; 4];
            let settings = ClothFrame { drag: 0.0, lift, ..still() };
            let input = FrameInput { duration: 1e-3, ..air(Vec3::zeros(), vec![settings]) };
            let gained = gain(solver(vec![cloth], Vec::new()), &input);
            let expected = lift * speed * speed * sine * cosine * input.duration;
            assert!((gained.norm() / expected - 1.0).abs() < 0.01, "{speed} m/s at {degrees}°: {gained}");
            // Across the stream, against the side of the surface that faces it.
            assert!(gained.z < 0.0 && gained.dot(&velocity).abs() < 0.01 * gained.norm() * speed);
        }
    }
}

/// The share of the wind that a small cloth behind a wall feels, at a place.
fn share_behind(wall: Surface, settings: WindField, place: Vec3) -> f64 {
    let wind = Vec3::z() * 2.0;
    let gained = |wind_field: WindField| {
        let cloth = Cloth::new(tile(0.01, place), Mass::PerArea(1.0), AIRY);
        let settings = ClothFrame { drag: 0.05, lift: 0.0, ..still() };
        let colliders = vec![ColliderFrame { wind_field, ..ColliderFrame::default() }];
        let input = FrameInput { colliders, ..air(wind, vec![settings]) };
        gain(solver(vec![cloth], vec![wall.clone()]), &input).z
    };
    gained(settings) / gained(WindField::OFF)
}

// EVIDENCE: N3.1-4  a surface behind another catches less of the wind
#[test]
fn a_wind_shadow_is_whole_behind_the_object_and_closes_at_its_distance() {
    let wall = tile(1.0, Vec3::zeros());
    let shadow = WindField { shadow_distance: 2.0, ..WindField::OFF };
    let at = |x: f64, z: f64| share_behind(wall.clone(), shadow, Vec3::new(x, 0.1, z));
    assert!(at(0.0, 0.02) < 1e-3, "close behind it there is none");
    assert!((at(0.0, 1.0) - 0.25).abs() < 1e-3, "half way a quarter of it: {}", at(0.0, 1.0));
    for free in [at(0.0, 2.1), at(0.0, -0.5), at(0.6, 0.5)] {
        assert!((free - 1.0).abs() < 1e-9, "beyond, before and beside it all of it: {free}");
    }
    let soft = WindField { shadow_diffusion: 1.0, ..shadow };
    let soft = |x: f64, z: f64| share_behind(wall.clone(), soft, Vec3::new(x, 0.1, z));
    assert!(soft(0.0, 1.0) > at(0.0, 1.0) + 0.2, "wind gets in from the sides: {}", soft(0.0, 1.0));
    assert!(soft(0.6, 0.5) < 0.95, "and less of it comes past the edge: {}", soft(0.6, 0.5));
}

#[test]
fn a_mesh_shadows_itself_only_if_it_is_told_to() {
    let mut both = tile(1.0, Vec3::zeros());
    let behind = tile(0.5, Vec3::new(0.0, 0.0, 0.5));
    both.positions.extend(&behind.positions);
    both.faces.push(&[4, 6, 7, 5]);
    let moved = |self_shadow: bool| {
        let cloth = Cloth::new(both.clone(), Mass::PerArea(1.0), AIRY);
        let wind_field = WindField { shadow_distance: 1.0, self_shadow, ..WindField::OFF };
        let settings = ClothFrame { drag: 0.05, lift: 0.0, wind_field, ..still() };
        let mut solver = solver(vec![cloth], Vec::new());
        solver.step(&air(Vec3::z() * 2.0, vec![settings]), &mut ());
        [0..4, 4..8].map(|points| mean_velocity(&solver, CLOTH, points).z)
    };
    let [first, second] = moved(false);
    assert!((first - second).abs() < 1e-9 && first > 0.0);
    let [shading, shaded] = moved(true);
    assert!((shading - first).abs() < 1e-9, "the first sheet feels all of it");
    assert!((shaded / first - 0.25).abs() < 0.02, "{}", shaded / first);
}

#[test]
fn every_cloth_shadows_itself_by_its_own_faces() {
    let ball = |x: f64| Cloth::new(crate::scenes::sphere(0.5, Vec3::x() * x), Mass::PerArea(1.0), AIRY);
    let wind_field = WindField { shadow_distance: 2.0, self_shadow: true, ..WindField::OFF };
    let settings = ClothFrame { drag: 0.05, lift: 0.0, wind_field, ..still() };
    let mut solver = solver(vec![ball(0.0), ball(50.0)], Vec::new());
    solver.step(&air(Vec3::new(0.1, 0.2, 2.0), vec![settings; 2]), &mut ());
    let points = crate::scenes::sphere(0.5, Vec3::zeros()).positions.len();
    let [first, second] = [0, 1].map(|ball| mean_velocity(&solver, ClothId(ball), 0..points));
    assert!((second - first).norm() < 1e-3 * first.norm(), "{second}, not {first}");
}

/// The gain of a cloth at a place by a wall that moves at this velocity, over that of free wind of 1 m/s.
fn pushed(wall: Vec3, wind: Vec3, settings: WindField, place: Vec3) -> Vec3 {
    let run = |wind: Vec3, wind_field: WindField| {
        let mut cloth = Cloth::new(tile(0.01, place), Mass::PerArea(1.0), AIRY);
        // A ball's drag: the same in all directions.
        cloth.start.velocities = vec![Vec3::zeros(); 4];
        let settings = ClothFrame { drag: 0.05, tangential_drag: 1.0, lift: 0.0, ..still() };
        let start = tile(1.0, Vec3::zeros()).positions;
        let duration = 1e-3;
        let end = start.iter().map(|point| point + wall * duration).collect();
        let colliders = vec![ColliderFrame { start, end, wind_field, ..ColliderFrame::default() }];
        let input = FrameInput { duration, colliders, ..air(wind, vec![settings]) };
        gain(solver(vec![cloth], vec![tile(1.0, Vec3::zeros())]), &input)
    };
    run(wind, settings) / run(Vec3::z(), WindField::OFF).z
}

#[test]
fn a_moving_object_makes_wind_and_one_at_rest_slows_it() {
    let push = WindField { push_distance: 1.0, ..WindField::OFF };
    let ahead = Vec3::new(0.1, 0.1, 0.5);
    let gust = pushed(Vec3::z() * 3.0, Vec3::zeros(), push, ahead);
    assert!((gust - Vec3::z() * 0.75).norm() < 0.01, "a quarter of its speed half way: {gust}");
    let slowed = pushed(Vec3::zeros(), Vec3::z(), push, ahead);
    assert!((slowed.z - 0.75).abs() < 0.01, "{slowed}");
    let beyond = pushed(Vec3::z() * 3.0, Vec3::zeros(), push, ahead * 2.5);
    assert!(beyond.norm() < 1e-9, "{beyond}");
    let beside = Vec3::new(0.9, 0.0, 0.0);
    let curled = WindField { push_vorticity: 1.0, ..push };
    let [along, back] = [push, curled].map(|push| pushed(Vec3::z() * 3.0, Vec3::zeros(), push, beside).z);
    assert!(along > 0.5 && (back / along + 0.5).abs() < 0.01, "it flows back at the sides: {along} {back}");
}

/// The gain of a small cloth at a place by a particle of 30 cm at the origin, over that of free wind of 1 m/s.
fn by_a_particle(velocity: Vec3, wind: Vec3, wind_field: WindField, place: Vec3) -> f64 {
    let run = |wind: Vec3, wind_field: WindField| {
        let cloth = Cloth::new(tile(0.01, place), Mass::PerArea(1.0), AIRY);
        let surface = Surface { positions: vec![Vec3::zeros()], ..Surface::default() };
        let mut particle = Cloth::new(surface, Mass::PerPoint(1.0), ClothLists::NONE);
        particle.start.velocities = vec![velocity];
        let airy = ClothFrame { drag: 0.05, tangential_drag: 1.0, lift: 0.0, ..still() };
        let settings = vec![airy, ClothFrame { thickness: 0.3, wind_field, drag: 0.0, ..still() }];
        gain(solver(vec![cloth, particle], Vec::new()), &FrameInput { duration: 1e-3, ..air(wind, settings) })
            .z
    };
    run(wind, wind_field) / run(Vec3::z(), WindField::OFF)
}

#[test]
fn a_particle_casts_a_wind_shadow_and_pushes_air_from_its_radius_on() {
    let shadow = WindField { shadow_distance: 2.0, ..WindField::OFF };
    let at = |x: f64, z: f64| by_a_particle(Vec3::zeros(), Vec3::z(), shadow, Vec3::new(x, 0.02, z));
    assert!(at(0.02, 0.35) < 0.05, "close behind it there is hardly any: {}", at(0.02, 0.35));
    assert!(at(0.02, 1.0) > 0.1 && at(0.02, 1.0) < 0.6, "half way a part of it: {}", at(0.02, 1.0));
    for free in [at(0.4, 0.5), at(0.02, -0.5), at(0.02, 2.4)] {
        assert!((free - 1.0).abs() < 1e-9, "beside, before and beyond it all of it: {free}");
    }
    let push = WindField { push_distance: 1.0, ..WindField::OFF };
    let ahead = |z: f64| by_a_particle(Vec3::z() * 3.0, Vec3::zeros(), push, Vec3::new(0.0, 0.0, z));
    assert!((ahead(0.8) - 0.75).abs() < 0.03, "a quarter of its speed half way: {}", ahead(0.8));
    assert!(ahead(1.4).abs() < 1e-9, "none beyond: {}", ahead(1.4));
}

#[test]
fn the_air_of_objects_and_parallel_links_give_the_same_bits_on_any_number_of_threads() {
    let hash = |threads: usize| {
        let mut builder = ModelBuilder::new();
        let lists = ClothLists { air: true, ..crate::scenes::LINKS };
        for height in [0.0, 0.3] {
            let mut sheet = grid(40, 40, Vec3::x(), -Vec3::y());
            sheet.positions.iter_mut().for_each(|p| p.z += height + 0.05 * (7.0 * p.x).sin());
            let cloth = builder.cloth(Cloth::new(sheet, Mass::PerArea(0.2), lists)).expect("a good mesh");
            builder.set_link_order(cloth, LinkOrder::Parallel).expect("points of the mesh");
        }
        let wind_field = WindField {
            shadow_distance: 0.5,
            shadow_diffusion: 0.5,
            self_shadow: true,
            push_distance: 0.4,
            push_vorticity: 0.5,
        };
        let settings = ClothFrame { drag: 0.05, lift: 0.1, wind_field, collide: false, ..still() };
        let wind_noise = 0.5;
        let input = FrameInput { wind_noise, ..air(Vec3::z() * 4.0, vec![settings; 2]) };
        let mut solver = Solver::<f32>::new(builder, threads);
        (0..2).for_each(|_| {
            solver.step(&input, &mut ());
        });
        solver.state_hash()
    };
    assert_eq!(hash(1), hash(2));
}

fn falling() -> [f64; ForceField::SAMPLES] {
    std::array::from_fn(|k| 1.0 - k as f64 / (ForceField::SAMPLES - 1) as f64)
}

fn particle(place: Vec3, mass: f64) -> Cloth {
    let surface = Surface { positions: vec![place], ..Surface::default() };
    Cloth::new(surface, Mass::PerPoint(mass), ClothLists::NONE)
}

#[test]
fn the_field_of_a_point_falls_off_from_its_radius_and_pushes_others() {
    let field =
        PointField { magnitude: 8.0, self_attract: 0.0, radius: 0.1, distance: 1.0, falloff: falling() };
    for (distance, expected) in [(0.05, 8.0), (0.6, 4.0), (1.0, 0.8), (1.2, 0.0)] {
        let source = ClothFrame { point_field: Some(field), ..still() };
        let input = FrameInput { duration: 1e-3, ..air(Vec3::zeros(), vec![still(), source]) };
        let cloths = vec![particle(Vec3::x() * distance, 0.3), particle(Vec3::zeros(), 2.0)];
        let mut solver = solver(cloths, Vec::new());
        solver.step(&input, &mut ());
        let gained = mean_velocity(&solver, CLOTH, 0..1) / input.duration;
        assert!((gained - Vec3::x() * expected).norm() < 1e-3 * expected.max(1e-3), "{distance}: {gained}");
        assert_eq!(mean_velocity(&solver, ClothId(1), 0..1), Vec3::zeros());
    }
}

#[test]
fn points_that_attract_themselves_draw_together_and_keep_their_momentum() {
    let positions: Vec<Vec3> = (0..20)
        .map(|k| Vec3::new(f64::from(k * 7 % 20), f64::from(k * 3 % 20), f64::from(k)) * 0.05)
        .collect();
    let mut cloth =
        Cloth::new(Surface { positions, ..Surface::default() }, Mass::PerPoint(0.1), ClothLists::NONE);
    cloth.vertex_maps.mass = (0..20).map(|k| 1.0 + f64::from(k) / 5.0).collect();
    let masses = cloth.point_masses();
    let field =
        PointField { magnitude: 0.0, self_attract: 5.0, radius: 0.0, distance: 3.0, falloff: falling() };
    let input = air(Vec3::zeros(), vec![ClothFrame { point_field: Some(field), collide: false, ..still() }]);
    let mut solver = solver(vec![cloth], Vec::new());
    let spread = |solver: &Solver<f64>| {
        let points: Vec<Vec3> = (0..20).map(|point| solver.point(CLOTH, point)).collect();
        let middle =
            points.iter().zip(&masses).map(|(p, m)| p * *m).sum::<Vec3>() / masses.iter().sum::<f64>();
        let spread = points.iter().map(|p| (p - middle).norm_squared()).sum::<f64>();
        (middle, spread)
    };
    let (middle, before) = spread(&solver);
    (0..4).for_each(|_| {
        solver.step(&input, &mut ());
    });
    let (moved, after) = spread(&solver);
    assert!(after < 0.8 * before, "{before} {after}");
    assert!((moved - middle).norm() < 1e-9, "{}", (moved - middle).norm());
}

#[test]
fn the_force_field_of_a_collider_is_as_strong_as_its_map() {
    let field = ForceField { side: FieldSide::Double, magnitude: 6.0, distance: 1.0, falloff: falling() };
    let gained = |map: Vec<f64>| {
        let mut builder = ModelBuilder::new();
        builder.cloth(particle(Vec3::new(0.5, -0.25, 0.5), 1.0)).expect("a point");
        builder.collider(Collider { surface: tile(2.0, Vec3::zeros()) }).expect("a good mesh");
        let maps = VertexMaps { field_magnitude: map, ..VertexMaps::default() };
        builder.set_collider_maps(ColliderId(0), maps)?;
        let colliders = vec![ColliderFrame { field: Some(field), ..ColliderFrame::default() }];
        let input = FrameInput { duration: 1e-3, colliders, ..air(Vec3::zeros(), vec![still()]) };
        let mut solver = Solver::<f64>::new(builder, 1);
        solver.step(&input, &mut ());
        Ok::<_, nucleus_core::BuildError>(mean_velocity(&solver, CLOTH, 0..1).z / input.duration)
    };
    // The corners: (-1, 1), (1, 1), (-1, -1), (1, -1).
    let [plain, mapped] = [vec![], vec![0.0, 1.0, 0.0, 1.0]].map(|map| gained(map).expect("a good map"));
    assert!((plain - 3.0).abs() < 0.01 && (mapped - 3.0 * 0.75).abs() < 0.01, "{plain} {mapped}");
    assert!(gained(vec![1.0; 3]).is_err() && gained(vec![-1.0; 4]).is_err());
}
