//! Particles: points without links, against cloth, colliders, the ground and each other.

use crate::scenes::{LINKS, Vec3, frame, grid, ground, physical, pins, sphere, still};
use nucleus_core::{
    COUNT_PERIOD, Cloth, ClothFrame, ClothId, ClothLists, Collider, ColliderFrame, Elements, FrameInput,
    Mass, ModelBuilder, ResistanceModel, SelfCollision, Solver, Start, StateView, Surface,
};

const BEADS: ClothId = ClothId(0);
const CLASSIC: ResistanceModel = ResistanceModel::Classic;

/// Particles of this mass in kilograms, each with a velocity.
fn beads(positions: &[Vec3], velocities: &[Vec3], mass: f64) -> Cloth {
    let surface = Surface { positions: positions.to_vec(), faces: Default::default() };
    let lists = ClothLists { air: true, self_collision: true, ..ClothLists::NONE };
    let start = Start { velocities: velocities.to_vec(), ..Start::default() };
    Cloth { start, ..Cloth::new(surface, Mass::PerPoint(mass), lists) }
}

/// Balls of a radius that collide with everything.
fn balls(radius: f64) -> ClothFrame {
    let own = SelfCollision { on: true, thickness: radius, elements: Elements::Points, edges: false };
    ClothFrame {
        thickness: radius,
        elements: Elements::Points,
        self_collision: own,
        friction: 0.0,
        ..still()
    }
}

fn built(cloths: impl IntoIterator<Item = Cloth>) -> ModelBuilder {
    let mut builder = ModelBuilder::new();
    for cloth in cloths {
        builder.cloth(cloth).expect("good points");
    }
    builder
}

fn points(solver: &impl StateView, cloth: ClothId, count: usize) -> Vec<Vec3> {
    (0..count).map(|point| solver.point(cloth, point)).collect()
}

fn velocities(solver: &impl StateView, cloth: ClothId) -> Vec<Vec3> {
    let mut out = Vec::new();
    solver.velocities(cloth, 1.0, &mut out);
    out.into_iter().map(|v| Vec3::from(v.map(f64::from))).collect()
}

/// The smallest distance of two points.
fn nearest(points: &[Vec3]) -> f64 {
    let pairs = (0..points.len()).flat_map(|a| (0..a).map(move |b| (a, b)));
    pairs.map(|(a, b)| (points[a] - points[b]).norm()).fold(f64::INFINITY, f64::min)
}

/// Beads in layers of `side` by `side`, each layer slightly offset from the one below.
fn layers(count: usize, side: usize, spacing: f64) -> Vec<Vec3> {
    let place = |k: usize| {
        let [x, y, z] = [k % side, k / (side * side), k / side % side].map(|n| n as f64);
        let turn = k as f64;
        Vec3::new(x + 0.1 * turn.sin(), y + 1.0, z + 0.1 * (turn * 1.7).cos()) * spacing
    };
    (0..count * side * side).map(place).collect()
}

// EVIDENCE: N1.1-4  a particle is cloth without links: drag is that of cloth, the same in all directions
#[test]
fn drag_slows_a_particle_as_recorded_output_of_the_original_shows() {
    let velocity = Vec3::new(3.0, -2.0, 1.0);
    let cloths = vec![ClothFrame { drag: 0.01, tangential_drag: 1.0, ..balls(0.1) }];
    let input = FrameInput { gravity: Vec3::zeros(), cloths, ..frame(3, CLASSIC) };
    let mut solver = Solver::<f64>::new(built([beads(&[Vec3::zeros()], &[velocity], 1.0)]), 1);
    let mut places = vec![Vec3::zeros()];
    for _ in 0..24 {
        solver.step(&input, &mut ());
        places.push(solver.point(BEADS, 0));
    }
    let moved: Vec<Vec3> = places.windows(2).map(|pair| pair[1] - pair[0]).collect();
    // Displacement per frame over a 24th of the velocity before it, and the logarithm of the remaining share of the
    // speed.
    assert!((moved[0].norm() * 24.0 / velocity.norm() - 0.993_364_92).abs() < 1e-6);
    for pair in moved.windows(2) {
        let ratio = (pair[1].norm() / pair[0].norm()).ln();
        assert!((ratio + 0.009_991_39).abs() < 2e-7, "{ratio}");
        assert!(pair[1].cross(&velocity).norm() < 1e-12, "it goes straight on");
    }
}

#[test]
fn a_particle_falls_in_air_as_the_closed_form_says() {
    // Per second: 24 · 0.5 / 2 kg.
    let rate: f64 = 6.0;
    let cloths = vec![ClothFrame { drag: 0.5, tangential_drag: 1.0, ..balls(0.1) }];
    let input = FrameInput { cloths, ..frame(200, CLASSIC) };
    let mut solver = Solver::<f32>::new(built([beads(&[Vec3::zeros()], &[], 2.0)]), 1);
    for _ in 0..24 {
        solver.step(&input, &mut ());
    }
    let exact = -9.81 / rate * (1.0 - (1.0 - (-rate).exp()) / rate);
    let fallen = solver.point(BEADS, 0).y;
    assert!((fallen / exact - 1.0).abs() < 5e-4, "{fallen} for {exact}");
}

#[test]
fn a_particle_that_falls_through_air_reaches_the_speed_at_which_drag_carries_it() {
    let cloths = vec![ClothFrame { drag: 0.5, tangential_drag: 1.0, ..balls(0.1) }];
    for (mass, substeps) in [(1.0, 50), (2.0, 50), (2.0, 200)] {
        let input = FrameInput { cloths: cloths.clone(), ..frame(substeps, CLASSIC) };
        let mut solver = Solver::<f32>::new(built([beads(&[Vec3::zeros()], &[], mass)]), 1);
        (0..72).for_each(|_| _ = solver.step(&input, &mut ()));
        // Weight m g over the drag of 24 · 0.5 kg/s.
        let exact = 9.81 * mass / 12.0;
        let speed = -velocities(&solver, BEADS)[0].y;
        assert!((speed / exact - 1.0).abs() < 5e-3, "{speed} for {exact} m/s");
    }
}

// EVIDENCE: N2.3-2  points collide with each other, with thickness
#[test]
fn a_collision_of_two_particles_keeps_their_momentum_at_any_speed() {
    for (speed, substeps) in [(0.3, 1), (5.0, 1), (5.0, 8), (100.0, 1), (100.0, 3), (100.0, 8)] {
        for beside in [0.0, 0.007, 0.015] {
            let places = [Vec3::new(-0.5, 0.0, 0.0), Vec3::new(0.5, beside, 0.0)];
            let way = [Vec3::x() * speed, -Vec3::x() * speed];
            let [light, heavy] = [0, 1].map(|k| beads(&places[k..=k], &way[k..=k], [1.0, 3.0][k]));
            let cloths = vec![balls(0.01); 2];
            let input = FrameInput { gravity: Vec3::zeros(), cloths, ..frame(substeps, CLASSIC) };
            let mut solver = Solver::<f32>::new(built([light, heavy]), 1);
            let frames = (3.0 / (2.0 * speed) / COUNT_PERIOD).ceil() as u32 + 3;
            for _ in 0..frames {
                solver.step(&input, &mut ());
            }
            let [light, heavy] = [0, 1].map(|cloth| velocities(&solver, ClothId(cloth))[0]);
            let momentum = light + heavy * 3.0;
            let off = (momentum + Vec3::x() * (2.0 * speed)).norm() / speed;
            assert!(off < 1e-5, "{speed} m/s at {substeps}, {beside} beside: {off:e}");
            // Head on they move on together. Off centre they are deflected, the less the farther they move in a step.
            let turned = (light - Vec3::x() * speed).norm() / speed;
            assert!(turned > 0.01, "{speed} m/s at {substeps}, {beside} beside: {light} {heavy}");
            assert!(beside > 0.0 || (light - heavy).norm() < 1e-3 * speed, "{speed} m/s at {substeps}");
            let line = solver.point(ClothId(1), 0) - solver.point(ClothId(0), 0);
            assert!(
                line.norm() >= 0.02 * 0.999,
                "{speed} m/s at {substeps}, {beside} beside: {}",
                line.norm()
            );
        }
    }
}

#[test]
fn particles_that_miss_each_other_and_cloth_are_not_slowed() {
    for substeps in [1, 3, 8] {
        let sheet = grid(9, 9, Vec3::z(), -Vec3::y());
        let places = [Vec3::new(-1.0, 0.1, 0.5), Vec3::new(1.0, 0.15, 0.5), Vec3::new(-1.0, -0.5, -0.1)];
        let way = [Vec3::x() * 100.0, -Vec3::x() * 100.0, Vec3::x() * 100.0];
        let cloth = Cloth::new(sheet.clone(), Mass::PerArea(0.2), LINKS);
        let builder = built([beads(&places, &way, 0.01), cloth]);
        let held = pins(&sheet, 0..81).into_iter().map(|pin| nucleus_core::Pin { cloth: ClothId(1), ..pin });
        let input = FrameInput {
            gravity: Vec3::zeros(),
            cloths: vec![balls(0.01), ClothFrame { thickness: 0.005, ..still() }],
            pins: held.collect(),
            ..frame(substeps, CLASSIC)
        };
        let mut solver = Solver::<f32>::new(builder, 1);
        solver.step(&input, &mut ());
        for (now, way) in velocities(&solver, BEADS).iter().zip(way) {
            assert!((now - way).norm() < 1e-3, "{substeps}: {now}");
        }
    }
}

#[test]
fn a_particle_that_is_dropped_on_pinned_cloth_rests_at_the_sum_of_their_thicknesses() {
    for resistance in [CLASSIC, physical(96.0)] {
        let sheet = grid(9, 9, Vec3::x(), Vec3::z());
        let cloth = Cloth::new(sheet.clone(), Mass::PerArea(0.2), LINKS);
        // On a face, on an edge, and on a point.
        let places = [Vec3::new(0.3, 0.3, 0.3), Vec3::new(0.3, 0.3, 0.625), Vec3::new(0.75, 0.3, 0.5)];
        let builder = built([beads(&places, &[], 0.01), cloth]);
        let held = pins(&sheet, 0..81).into_iter().map(|pin| nucleus_core::Pin { cloth: ClothId(1), ..pin });
        let input = FrameInput {
            cloths: vec![balls(0.02), ClothFrame { thickness: 0.01, ..still() }],
            pins: held.collect(),
            ..frame(3, resistance)
        };
        let mut solver = Solver::<f32>::new(builder, 1);
        for step in 0..48 {
            solver.step(&input, &mut ());
            for point in points(&solver, BEADS, 3).iter().filter(|_| step > 12) {
                assert!((point.y - 0.03).abs() < 1e-5, "{resistance:?}, frame {step}: {point}");
            }
        }
    }
}

// EVIDENCE: N1.1-1  particles weigh on cloth, and cloth carries particles
#[test]
fn a_particle_weighs_on_cloth_that_carries_it() {
    let sag = |mass: f64| {
        let mut sheet = grid(17, 17, Vec3::x(), Vec3::z());
        sheet.positions.iter_mut().for_each(|p| *p -= Vec3::new(0.5, 0.0, 0.5));
        let corners = [0, 16, 272, 288];
        let lists = ClothLists { cross_links: true, damp: true, ..LINKS };
        let cloth = Cloth::new(sheet.clone(), Mass::PerArea(0.2), lists);
        let builder = built([beads(&[Vec3::new(0.01, 0.1, 0.02)], &[], mass), cloth]);
        let held =
            pins(&sheet, corners).into_iter().map(|pin| nucleus_core::Pin { cloth: ClothId(1), ..pin });
        let input = FrameInput {
            cloths: vec![
                ClothFrame { friction: 1.0, ..balls(0.03) },
                ClothFrame { thickness: 0.005, damp: 1.0, ..still() },
            ],
            pins: held.collect(),
            ..frame(3, physical(96.0))
        };
        let mut solver = Solver::<f32>::new(builder, 1);
        // It oscillates like on a trampoline: the mean over the last two seconds.
        let height = |_| {
            let report = solver.step(&input, &mut ());
            assert!(report.min_cloth_gap > 0.9, "{report:?}");
            solver.point(BEADS, 0).y
        };
        (0..96).map(height).skip(48).sum::<f64>() / 48.0
    };
    let (light, heavy) = (sag(0.001), sag(1.0));
    println!("a bead of 1 g rests at {light} m, one of 1 kg at {heavy} m");
    assert!(light < 0.05 && heavy < light - 0.02, "{light} {heavy}");
    assert!(heavy > -0.5, "cloth carries it: {heavy}");
}

#[test]
fn a_heap_of_particles_comes_to_rest_without_overlap() {
    let radius = 0.01;
    let places = layers(8, 4, 0.021);
    let mut solver = Solver::<f32>::new(built([beads(&places, &[], 0.005)]), 1);
    let cloths = vec![ClothFrame { friction: 0.3, ..balls(radius) }];
    let input = FrameInput { plane: Some(ground(0.3)), cloths, ..frame(3, physical(96.0)) };
    let mut speeds = Vec::new();
    for step in 0..120 {
        let energy = solver.step(&input, &mut ()).kinetic_energy;
        speeds.push((2.0 * energy / (0.005 * places.len() as f64)).sqrt());
        let now = points(&solver, BEADS, places.len());
        let apart = nearest(&now) / (2.0 * radius);
        // During impact they are compressed, because contact with the ground is resolved last.
        let least = if step < 60 { 0.95 } else { 0.99 };
        assert!(apart > least, "frame {step}: {apart} of the contact distance");
        let lowest = now.iter().map(|p| p.y).fold(f64::INFINITY, f64::min);
        assert!(lowest > 0.99 * radius, "frame {step}: {lowest}");
    }
    // Single beads still drop from the heap; the test is on the speed in between.
    let last = &mut speeds[80..];
    last.sort_by(f64::total_cmp);
    let speed = last[last.len() / 2];
    assert!(speed < 0.02, "{speed} m/s");
}

/// The tangent of the slope of a heap of grains that come to rest on rough ground, as that of the cone whose grains are as
/// high and as far from its axis on average.
fn slope_of_heap(friction: f64) -> f64 {
    let (radius, side) = (0.01, 4);
    let mut places = layers(14, side, 0.0215);
    let middle = Vec3::new(1.0, 0.0, 1.0) * (0.0215 * (side as f64 - 1.0) / 2.0);
    places.iter_mut().for_each(|place| *place -= middle);
    let mut solver = Solver::<f32>::new(built([beads(&places, &[], 0.005)]), 1);
    let cloths = vec![ClothFrame { friction, ..balls(radius) }];
    let input = FrameInput { plane: Some(ground(0.5)), cloths, ..frame(2, physical(64.0)) };
    (0..60).for_each(|_| _ = solver.step(&input, &mut ()));
    let grains = points(&solver, BEADS, places.len());
    // Those that have rolled away are no part of the heap.
    let across = |place: &Vec3| place.x.hypot(place.z);
    let mut far: Vec<f64> = grains.iter().map(across).collect();
    far.sort_by(f64::total_cmp);
    let rim = 2.0 * far[far.len() / 2];
    let heap: Vec<&Vec3> = grains.iter().filter(|place| across(place) < rim).collect();
    let mean =
        |of: &dyn Fn(&Vec3) -> f64| heap.iter().map(|place| of(place)).sum::<f64>() / heap.len() as f64;
    2.0 * mean(&|place| place.y - radius) / mean(&across)
}

#[test]
fn the_angle_of_repose_follows_friction() {
    let [smooth, rough, rougher] = [0.02, 0.15, 0.4].map(slope_of_heap);
    println!("{smooth:.3} {rough:.3} {rougher:.3}");
    assert!(1.3 * smooth < rough && 1.3 * rough < rougher, "{smooth} {rough} {rougher}");
}

#[test]
fn particles_stay_outside_of_static_and_moving_colliders() {
    for speed in [0.0, 1.0, 50.0] {
        for resistance in [CLASSIC, physical(48.0)] {
            let mut places = layers(3, 6, 0.05);
            places.iter_mut().for_each(|p| *p += Vec3::new(-0.15, 0.35, -0.15));
            let mut builder = built([beads(&places, &[], 0.01)]);
            let ball = sphere(0.3, Vec3::zeros());
            builder.collider(Collider { surface: ball.clone() }).expect("a good mesh");
            let mut solver = Solver::<f32>::new(builder, 1);
            for step in 0..24 {
                // The collider rises by half a metre and stays there.
                let height = |step: u32| (f64::from(step) * speed * COUNT_PERIOD).min(0.5);
                let at = |step: u32| ball.positions.iter().map(|p| p + Vec3::y() * height(step)).collect();
                let end: Vec<Vec3> = if speed > 0.0 { at(step + 1) } else { Vec::new() };
                let colliders =
                    vec![ColliderFrame { end, collide: true, thickness: 0.002, ..ColliderFrame::default() }];
                let cloths = vec![balls(0.01)];
                let input = FrameInput { cloths, colliders, plane: None, ..frame(3, resistance) };
                let report = solver.step(&input, &mut ());
                assert_eq!(report.pairs_unresolved, 0, "{speed} m/s, {resistance:?}, frame {step}");
                let centre = Vec3::y() * height(step + 1);
                let inside = |p: &Vec3| (p - centre).norm() < crate::scenes::INSCRIBED * 0.3;
                assert_eq!(points(&solver, BEADS, places.len()).iter().filter(|p| inside(p)).count(), 0);
            }
        }
    }
}

/// Beads that fall on a sheet pinned at its corners.
fn poured(threads: usize, far_away: bool) -> (Vec<u64>, Vec<Vec3>) {
    let mut sheet = grid(17, 17, Vec3::x() * 0.5, Vec3::z() * 0.5);
    sheet.positions.iter_mut().for_each(|p| *p -= Vec3::new(0.2, 0.0, 0.2));
    let lists = ClothLists { cross_links: true, self_collision: true, ..LINKS };
    let places = layers(4, 5, 0.025);
    let mut cloths = vec![beads(&places, &[], 0.004), Cloth::new(sheet.clone(), Mass::PerArea(0.2), lists)];
    let own = SelfCollision { on: true, thickness: 0.003, elements: Elements::Faces, edges: true };
    let mut frames = vec![balls(0.01), ClothFrame { thickness: 0.003, self_collision: own, ..still() }];
    if far_away {
        let far: Vec<Vec3> = places.iter().map(|p| p + Vec3::x() * 500.0).collect();
        cloths.push(beads(&far, &[], 0.02));
        frames.push(balls(0.02));
    }
    let corners = pins(&sheet, [0, 16, 272, 288]).into_iter();
    let held = corners.map(|pin| nucleus_core::Pin { cloth: ClothId(1), ..pin });
    let input = FrameInput { cloths: frames, pins: held.collect(), ..frame(3, physical(48.0)) };
    let mut solver = Solver::<f32>::new(built(cloths), threads);
    let mut hashes = Vec::new();
    for _ in 0..16 {
        let report = solver.step(&input, &mut ());
        assert_eq!(report.pairs_unresolved, 0);
        hashes.push(solver.state_hash());
    }
    (hashes, points(&solver, BEADS, places.len()))
}

#[test]
fn particles_on_cloth_have_the_same_bits_on_any_number_of_threads() {
    let one = poured(1, false);
    assert!([2, 4].into_iter().all(|threads| poured(threads, false) == one));
}

#[test]
fn particles_far_away_change_not_one_bit() {
    assert_eq!(poured(1, true).1, poured(1, false).1);
}
