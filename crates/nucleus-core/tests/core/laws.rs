//! Invariants of every scene: energy, momentum, translation, determinism, and the contract of the observer.

use std::ops::ControlFlow;

use crate::scenes::{LINKS, Vec3, drape, frame, grid, one_cloth, physical, pins, still};
use nalgebra::{Rotation3, Vector3};
use nucleus_core::{
    Cloth, ClothFrame, ClothId, ClothLists, Collider, ColliderFrame, Elements, FrameInput, Mass,
    ModelBuilder, Pin, ResistanceModel, SelfCollision, Solver, Start, StateView, StepObserver, StepReport,
    SubstepIndex,
};
use proptest::prelude::*;

const CLOTH: ClothId = ClothId(0);

fn points(solver: &impl StateView, count: usize) -> Vec<Vec3> {
    (0..count).map(|point| solver.point(CLOTH, point)).collect()
}

#[test]
fn the_99th_percentile_of_strain_is_that_of_the_links_also_above_one() {
    // Half of the links are three times as long as at rest, and two of 544 are far longer.
    let sheet = grid(17, 17, Vec3::x(), Vec3::z());
    let mut held = pins(&sheet, 0..289);
    for pin in &mut held {
        pin.start.x *= 3.0;
        pin.end.x *= 3.0;
    }
    (held[0].start.y, held[0].end.y) = (10.0, 10.0);
    let input = FrameInput { pins: held, ..frame(1, physical(24.0)) };
    let report = Solver::<f32>::new(one_cloth(sheet, LINKS), 1).step(&input, &mut ());
    assert!((report.strain_99 - 2.0).abs() < 1e-4 && report.max_strain > 100.0, "{report:?}");
}

#[test]
fn an_undamped_swing_creates_no_energy_at_any_setting() {
    let sheet = grid(81, 81, Vec3::x(), Vec3::z());
    for evaluations in [24.0, 48.0, 96.0, 192.0] {
        let input = FrameInput { pins: pins(&sheet, [0, 80]), ..frame(1, physical(evaluations)) };
        let mut solver = Solver::<f32>::new(one_cloth(sheet.clone(), LINKS), 2);
        // Mass by area: an inner point of a grid has the mass of one cell.
        let share = |k: usize| {
            let side = |k: usize| if k == 0 || k == 80 { 0.5 } else { 1.0 };
            side(k % 81) * side(k / 81) * 0.2 / 6400.0
        };
        for step in 0..48 {
            let kinetic = solver.step(&input, &mut ()).kinetic_energy;
            let height: f64 = points(&solver, 6561).iter().enumerate().map(|(k, p)| share(k) * p.y).sum();
            let total = kinetic + 9.81 * height;
            // It starts at zero; the potential energy of the swing is 1.96 J.
            assert!(total < 1e-4, "{evaluations} evaluations, frame {step}: {total} J");
        }
    }
}

// EVIDENCE: N2.1-2  fast, low settings give soft cloth, not an explosion
#[test]
fn few_evaluations_are_stable() {
    let sheet = grid(41, 41, Vec3::x(), Vec3::z());
    for resistance in [ResistanceModel::Classic, physical(1.0), physical(3.0), physical(10.0)] {
        let cloths =
            vec![ClothFrame { bend_resistance: 10.0, shear_resistance: 200.0, drag: 1.0, ..still() }];
        let input = FrameInput { pins: pins(&sheet, [0, 40]), cloths, ..frame(1, resistance) };
        let mut solver = Solver::<f32>::new(one_cloth(sheet.clone(), ClothLists::DEFAULT), 1);
        for _ in 0..240 {
            let report = solver.step(&input, &mut ());
            assert!(report.finite && report.kinetic_energy < 4.0, "{resistance:?}: {report:?}");
        }
    }
}

#[test]
fn a_falling_sheet_moves_as_a_rigid_body() {
    let sheet = grid(33, 33, Vec3::x(), Vec3::z());
    for resistance in [ResistanceModel::Classic, physical(48.0)] {
        let mut solver = Solver::<f32>::new(one_cloth(sheet.clone(), ClothLists::DEFAULT), 1);
        let input = FrameInput {
            cloths: vec![ClothFrame { bend_resistance: 1.0, shear_resistance: 20.0, ..still() }],
            ..frame(3, resistance)
        };
        for _ in 0..24 {
            solver.step(&input, &mut ());
        }
        let first = solver.point(CLOTH, 0) - sheet.positions[0];
        for (now, start) in points(&solver, 1089).iter().zip(&sheet.positions) {
            assert!((now - start - first).norm() < 1e-6, "{:e}", (now - start - first).norm());
        }
    }
}

/// The largest strain, and the largest kinetic energy in joules, of an undamped cloth that starts at rest without
/// gravity.
fn at_rest(surface: nucleus_core::Surface, evaluations: f64, bend: f64, frames: u32) -> (f64, f64) {
    let lists = ClothLists { bend: true, cross_links: true, ..LINKS };
    let mut solver = Solver::<f32>::new(one_cloth(surface, lists), 1);
    let cloths = vec![ClothFrame { bend_resistance: bend, ..still() }];
    let input = FrameInput { gravity: Vec3::zeros(), cloths, ..frame(3, physical(evaluations)) };
    let reports: Vec<_> = (0..frames).map(|_| solver.step(&input, &mut ())).collect();
    let most = |of: fn(&StepReport) -> f64| reports.iter().map(of).fold(0.0, f64::max);
    (most(|report| report.max_strain), most(|report| report.kinetic_energy))
}

#[test]
fn a_curved_cloth_at_rest_stays_at_rest() {
    // A fine mesh of uneven triangles, bent at rest. Sweeps in one direction would amplify rounding errors to a strain
    // of 1 % within a second at 192 evaluations.
    for (evaluations, bend) in
        [(24.0, 0.2), (48.0, 0.2), (96.0, 0.0), (96.0, 2.0), (192.0, 0.0), (192.0, 20.0)]
    {
        let (strain, energy) = at_rest(crate::scenes::sphere(0.3, Vec3::zeros()), evaluations, bend, 48);
        assert!(strain < 1e-5, "{evaluations} evaluations, bend {bend}: strain {strain:e}, {energy:e} J");
    }
}

/// A curved sheet of uneven cells: quads, or triangles.
fn uneven(seed: u64, quads: bool) -> nucleus_core::Surface {
    let mut surface = grid(17, 17, Vec3::x(), Vec3::z());
    let mut state = seed;
    let mut chance = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as f64 / f64::from(1u32 << 31) - 0.5
    };
    for p in &mut surface.positions {
        *p += Vec3::new(chance(), 0.0, chance()) * 0.02;
        p.y = 0.2 * (4.0 * p.x).sin() * (3.0 * p.z).cos();
    }
    if !quads {
        surface.faces = surface.faces.triangles().collect::<Vec<_>>().iter().map(|t| &t[..]).collect();
    }
    surface
}

#[test]
fn a_cloth_at_rest_gains_no_energy_in_few_steps_a_frame() {
    // With all sweeps in one direction: a strain of 1 % within three seconds.
    for evaluations in [12.0, 24.6, 30.0] {
        let (strain, energy) = at_rest(uneven(13_835_094_099_054_614_906, false), evaluations, 0.09, 72);
        assert!(strain < 1e-5, "{evaluations} evaluations: strain {strain:e}, {energy:e} J");
    }
}

/// The positions of a small drape after eight frames of a rotated and translated scene, transformed back.
fn moved(turn: Rotation3<f64>, shift: Vec3) -> Vec<Vec3> {
    let (_, input) = drape(17, 48.0);
    let builder = crate::scenes::drape_placed(17, |p| turn * p + shift);
    let input = FrameInput { gravity: turn * input.gravity, ..input };
    let mut solver = Solver::<f64>::new(builder, 1);
    (0..8).for_each(|_| {
        solver.step(&input, &mut ());
    });
    points(&solver, 289).into_iter().map(|p| turn.inverse() * (p - shift)).collect()
}

// The solver orders points by their positions, so a rotation changes the order of rows, and the results agree only as
// far as the sweeps have converged. A translation keeps the order.
#[test]
fn translating_or_rotating_a_scene_does_the_same_to_its_result() {
    let here = moved(Rotation3::identity(), Vec3::zeros());
    for shift in [Vec3::new(10_000.0, 0.0, 0.0), Vec3::new(-3.0, 500.0, 77.0)] {
        let there = moved(Rotation3::identity(), shift);
        let apart = here.iter().zip(&there).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max);
        assert!(apart < 1e-6, "{shift:?}: {apart:e}");
    }
    let quarter = Rotation3::from_axis_angle(&Vector3::y_axis(), std::f64::consts::FRAC_PI_2);
    let apart =
        here.iter().zip(&moved(quarter, Vec3::zeros())).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max);
    assert!(apart < 0.01, "turned: {apart:e}");
}

#[test]
fn any_thread_count_gives_the_same_bits() {
    let hash = |threads: usize| {
        let (builder, mut input) = drape(65, 24.0);
        input.cloths[0] = ClothFrame { drag: 0.05, shear_resistance: 5.0, damp: 0.1, ..input.cloths[0] };
        let mut solver = Solver::<f32>::new(builder, threads);
        (0..10)
            .map(|_| {
                solver.step(&input, &mut ());
                solver.state_hash()
            })
            .collect::<Vec<_>>()
    };
    let one = hash(1);
    assert!([2, 4, 8].into_iter().all(|threads| hash(threads) == one));
}

/// Adds two sheets that fall on each other and on a ball, at `place`, with a downward start velocity of `speed` m/s.
fn a_heap(place: Vec3, speed: f64, builder: &mut ModelBuilder, input: &mut FrameInput) {
    for k in 0..2 {
        let mut sheet = grid(13, 13, Vec3::x(), Vec3::z());
        let at = place + Vec3::new(-0.5 + 0.03 * f64::from(k), 0.33 + 0.02 * f64::from(k), -0.5);
        sheet.positions.iter_mut().for_each(|p| *p += at);
        let start = Start { velocities: vec![-Vec3::y() * speed; 169], ..Start::default() };
        let sheet = Cloth { start, ..Cloth::new(sheet, Mass::PerArea(0.2), LINKS) };
        builder.cloth(sheet).expect("a good mesh");
        let own = SelfCollision { on: true, thickness: 0.004, elements: Elements::Faces, edges: true };
        input.cloths.push(ClothFrame { thickness: 0.004, friction: 0.3, self_collision: own, ..still() });
    }
    builder.collider(Collider { surface: crate::scenes::sphere(0.3, place) }).expect("a good mesh");
    input.colliders.push(ColliderFrame { collide: true, friction: 0.3, ..ColliderFrame::default() });
}

/// The positions of the first sheet of a heap after each frame, in contact with the second sheet throughout. `far` is
/// the start speed in m/s of another heap 50 m away.
fn beside(far: Option<f64>) -> Vec<Vec<Vec3>> {
    let mut builder = ModelBuilder::new();
    let mut input = FrameInput { cloths: Vec::new(), ..frame(3, physical(48.0)) };
    a_heap(Vec3::zeros(), 0.0, &mut builder, &mut input);
    if let Some(speed) = far {
        a_heap(Vec3::new(50.0, 0.1, 0.0), speed, &mut builder, &mut input);
    }
    let mut solver = Solver::<f32>::new(builder, 1);
    let one = |_| {
        let report = solver.step(&input, &mut ());
        assert!(report.min_cloth_gap < 3.0, "the sheets are near each other: {report:?}");
        points(&solver, 169)
    };
    (0..12).map(one).collect()
}

#[test]
fn cloth_in_contact_far_away_changes_not_one_bit() {
    let alone = beside(None);
    for speed in [1.0, 10.0] {
        let apart = |(a, b): (&Vec<Vec3>, &Vec<Vec3>)| {
            a.iter().zip(b).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max)
        };
        let apart: Vec<f64> = alone.iter().zip(&beside(Some(speed))).map(apart).collect();
        assert!(apart.iter().all(|&apart| apart == 0.0), "{speed} m/s, metres in each frame: {apart:?}");
    }
}

struct Substeps(Vec<SubstepIndex>);

impl StepObserver for Substeps {
    fn substep(&mut self, moment: SubstepIndex, _state: &dyn StateView) {
        self.0.push(moment);
    }
}

// EVIDENCE: N2.4-10  a substep is the smallest unit of time that an observer sees
#[test]
fn an_observer_sees_every_substep_once() {
    let mut solver = Solver::<f32>::new(one_cloth(grid(3, 3, Vec3::x(), Vec3::z()), LINKS), 1);
    let mut seen = Substeps(Vec::new());
    solver.step(&frame(7, physical(96.0)), &mut seen);
    assert_eq!(seen.0, (1..=7).map(|substep| SubstepIndex { substep, substeps: 7 }).collect::<Vec<_>>());
}

#[test]
fn an_observer_can_end_a_frame_between_time_steps() {
    struct UntilSubstep(u32, Substeps);
    impl StepObserver for UntilSubstep {
        fn substep(&mut self, moment: SubstepIndex, state: &dyn StateView) {
            self.1.substep(moment, state);
        }
        fn should_continue(&self) -> ControlFlow<()> {
            if self.1.0.len() as u32 == self.0 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        }
    }
    let solver = || Solver::<f32>::new(one_cloth(grid(3, 3, Vec3::x(), Vec3::z()), LINKS), 1);
    let input = frame(7, physical(96.0));
    let mut watch = UntilSubstep(3, Substeps(Vec::new()));
    assert!(solver().step(&input, &mut watch).stopped);
    assert_eq!(watch.1.0.len(), 3);
    let mut watch = UntilSubstep(7, Substeps(Vec::new()));
    assert!(!solver().step(&input, &mut watch).stopped);
    assert_eq!(watch.1.0.len(), 7);
}

// EVIDENCE: N2.4-7  what is animated moves along a straight line inside a frame
// EVIDENCE: N2.4-6  animation is read once per frame
#[test]
fn pins_and_colliders_move_along_straight_lines_inside_a_frame() {
    struct Watch(Vec<(f64, f32)>);
    impl StepObserver for Watch {
        fn substep(&mut self, _moment: SubstepIndex, state: &dyn StateView) {
            let mut out = Vec::new();
            state.collider_positions(nucleus_core::ColliderId(0), 1.0, &mut out);
            self.0.push((state.point(CLOTH, 0).x, out[0][1]));
        }
    }
    let (builder, input) = drape(5, 8.0);
    let start = Vec3::new(-0.5, 0.35, -0.5);
    let pin = Pin { start, end: start + Vec3::x(), ..pins(&grid(5, 5, Vec3::x(), Vec3::z()), [0])[0] };
    let ball = crate::scenes::sphere(0.31, Vec3::zeros()).positions;
    let end: Vec<Vec3> = ball.iter().map(|p| p + Vec3::y() * 4.0).collect();
    let colliders = vec![ColliderFrame { start: ball, end, collide: false, ..ColliderFrame::default() }];
    let input = FrameInput { substeps: 4, pins: vec![pin], colliders, ..input };
    let mut watch = Watch(Vec::new());
    Solver::<f32>::new(builder, 1).step(&input, &mut watch);
    for (k, (pinned, top)) in watch.0.iter().enumerate() {
        let share = (k + 1) as f64 / 4.0;
        assert!((pinned - (start.x + share)).abs() < 1e-6);
        assert!((f64::from(*top) - (0.31 + 4.0 * share)).abs() < 1e-6);
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]
    #[test]
    fn a_cloth_at_rest_gains_no_energy_on_any_mesh(
        seed: u64, quads: bool, evaluations in 16.0..400.0f64, bend in 0.0..10.0f64,
    ) {
        let (strain, energy) = at_rest(uneven(seed, quads), evaluations, bend, 36);
        // Rounding gives some 1e-11 J; a speed of 1 mm/s would be 1e-7 J.
        prop_assert!(energy < 1e-9 && strain < 1e-5, "strain {strain:e}, {energy:e} J");
    }

    #[test]
    fn every_state_is_finite_at_any_setting(
        stretch in 0.0..1000.0f64, bend in 0.0..1000.0f64, shear in 0.0..1000.0f64, substeps in 1u32..6,
        evaluations in 1.0..60.0f64, classic: bool, mass in 1e-3..1e3f64, friction in 0.0..2.0f64,
    ) {
        let mut builder = ModelBuilder::new();
        let surface = grid(9, 9, Vec3::x(), Vec3::z());
        let held = pins(&surface, [0]);
        builder.cloth(Cloth::new(surface, Mass::PerPoint(mass), ClothLists::DEFAULT)).expect("a good mesh");
        builder.collider(Collider { surface: crate::scenes::sphere(0.3, Vec3::new(0.5, -0.4, 0.5)) }).expect("a good mesh");
        let resistance = if classic { ResistanceModel::Classic } else { physical(evaluations) };
        let cloth = ClothFrame { stretch_resistance: stretch, bend_resistance: bend, shear_resistance: shear,
            thickness: 0.02, friction, ..ClothFrame::default() };
        let input = FrameInput { cloths: vec![cloth], pins: held,
            colliders: vec![ColliderFrame { collide: true, friction, ..ColliderFrame::default() }], ..frame(substeps, resistance) };
        let mut solver = Solver::<f32>::new(builder, 1);
        for _ in 0..24 {
            let report = solver.step(&input, &mut ());
            prop_assert!(report.finite, "{report:?}");
        }
    }
}
