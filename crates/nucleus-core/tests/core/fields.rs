//! Force fields on particles and cloth.

use crate::scenes::{LINKS, Vec3, frame, grid, still};
use nucleus_core::{
    COUNT_PERIOD, Cloth, ClothFrame, ClothId, ClothLists, Field, FieldKind, FrameInput, Mass, ModelBuilder,
    Noise, Reach, ResistanceModel, Solver, StateView, Surface, VolumeAxis,
};

const POINTS: ClothId = ClothId(0);

/// Points of a mass in kilograms, each with a velocity.
fn points(places: &[Vec3], velocity: Vec3, mass: f64) -> Solver<f64> {
    let surface = Surface { positions: places.to_vec(), faces: Default::default() };
    let start = nucleus_core::Start { velocities: vec![velocity; places.len()], ..Default::default() };
    let cloth = Cloth { start, ..Cloth::new(surface, Mass::PerPoint(mass), ClothLists::NONE) };
    let mut builder = ModelBuilder::new();
    builder.cloth(cloth).expect("good points");
    Solver::new(builder, 1)
}

fn input(kind: FieldKind, reach: Reach, substeps: u32, per_substep: bool) -> FrameInput {
    let fields = vec![Field { kind, reach, targets: vec![(POINTS, 1.0)] }];
    FrameInput {
        gravity: Vec3::zeros(),
        fields,
        fields_per_substep: per_substep,
        cloths: vec![ClothFrame { collide: false, ..still() }],
        ..frame(substeps, ResistanceModel::Classic)
    }
}

/// Velocity after one frame from a start velocity, at a place, of a point of 2 kg.
fn velocity_after(kind: FieldKind, place: Vec3, velocity: Vec3) -> Vec3 {
    let mut solver = points(&[place], velocity, 2.0);
    solver.step(&input(kind, Reach::everywhere(), 2, false), &mut ());
    let mut out = Vec::new();
    solver.velocities(POINTS, 1.0, &mut out);
    Vec3::from(out[0].map(f64::from))
}

#[test]
fn each_field_changes_the_velocity_as_its_law_says() {
    let t = COUNT_PERIOD;
    let place = Vec3::new(0.0, 0.0, 4.0);
    let z = Vec3::z();
    let laws = [
        (FieldKind::Gravity { acceleration: Vec3::x() * 3.0 }, Vec3::x() * 3.0 * t),
        (FieldKind::Uniform { force: Vec3::x() * 3.0 }, Vec3::x() * 1.5 * t),
        (FieldKind::Radial { force: 6.0 }, z * 3.0 * t),
        (FieldKind::Radial { force: -6.0 }, -z * 3.0 * t),
        (FieldKind::Newton { magnitude: 6.0, min_distance: 0.0 }, -z * 6.0 * t),
        (FieldKind::Vortex { force: 6.0, axis: Vec3::y() }, Vec3::x() * 3.0 * t),
    ];
    for (kind, expected) in laws {
        let found = velocity_after(kind, place, Vec3::zeros());
        assert!((found - expected).norm() < 1e-6, "{kind:?}: {found} for {expected}");
    }
    let axis = VolumeAxis {
        from_center: 2.0,
        from_axis: 4.0,
        along_axis: 6.0,
        around_axis: 8.0,
        directional: Vec3::x() * 10.0,
        axis: Vec3::y(),
        turbulence: 0.0,
        noise: Noise { frequency: Vec3::zeros(), phase: Vec3::zeros(), octaves: 0, ratio: 0.0 },
    };
    let found = velocity_after(FieldKind::VolumeAxis(axis), place, Vec3::zeros());
    assert!((found - (z * 3.0 + Vec3::y() * 3.0 + Vec3::x() * 9.0) * t).norm() < 1e-6, "{found}");
}

#[test]
fn newtons_attraction_falls_with_the_power_of_the_distance_and_stays_finite() {
    let within = |distance: f64, attenuation: f64, min_distance: f64| {
        let mut solver = points(&[Vec3::z() * distance], Vec3::zeros(), 2.0);
        let reach = Reach { attenuation, ..Reach::everywhere() };
        let kind = FieldKind::Newton { magnitude: 6.0, min_distance };
        let report = solver.step(&input(kind, reach, 1, false), &mut ());
        assert!(report.finite);
        let mut out = Vec::new();
        solver.velocities(POINTS, 1.0, &mut out);
        -f64::from(out[0][2]) / COUNT_PERIOD
    };
    let at = |distance: f64, attenuation: f64| within(distance, attenuation, 0.5);
    assert!((at(2.0, 2.0) - 1.5).abs() < 1e-5);
    assert!((at(2.0, 1.0) - 3.0).abs() < 1e-5);
    assert_eq!(at(0.1, 2.0), 0.0, "none within the smallest distance");
    assert!((within(0.1, 2.0, 0.0) - 600.0).abs() < 1e-2);
    assert!((within(1e-9, 2.0, 0.0) - 6e6).abs() < 10.0, "no stronger than at a thousandth of a unit");
    assert_eq!(within(0.0, 2.0, 0.0), 0.0, "none at the centre, which has no direction");
}

#[test]
fn drag_slows_a_motion_and_never_turns_it_round() {
    for magnitude in [0.1, 10.0, 1e6] {
        let kind = FieldKind::Drag { magnitude, along: None, velocity: Vec3::zeros(), half_speed: 0.0 };
        let left = velocity_after(kind, Vec3::zeros(), Vec3::x() * 3.0).x;
        let expected = 3.0 / (1.0 + magnitude / 2.0 * COUNT_PERIOD);
        assert!((left - expected).abs() < 1e-6, "{magnitude}: {left} for {expected}");
    }
    let kind =
        FieldKind::Drag { magnitude: 1e6, along: Some(Vec3::y()), velocity: Vec3::zeros(), half_speed: 0.0 };
    let left = velocity_after(kind, Vec3::zeros(), Vec3::new(3.0, 2.0, 0.0));
    assert!((left - Vec3::x() * 3.0).norm() < 1e-3, "only along its direction: {left}");
}

#[test]
fn drag_on_slow_points_is_weaker_where_it_is_attenuated() {
    for (speed, share) in [(1e-6, 0.0), (1.0, 1.0 / 3.0), (2.0, 0.5), (1e5, 1.0)] {
        let kind = FieldKind::Drag { magnitude: 10.0, along: None, velocity: Vec3::zeros(), half_speed: 2.0 };
        let left = velocity_after(kind, Vec3::zeros(), Vec3::x() * speed).x / speed;
        let expected = 1.0 / (1.0 + share * 5.0 * COUNT_PERIOD);
        assert!((left - expected).abs() < 1e-4, "{speed} m/s: {left} for {expected}");
    }
}

#[test]
fn air_takes_points_along_up_to_its_own_velocity() {
    let air = |rate, component_only| FieldKind::Air {
        velocity: Vec3::x() * 4.0,
        rate,
        component_only,
        spread: None,
    };
    let start = Vec3::y() * 2.0;
    assert!((velocity_after(air(1.0, false), Vec3::zeros(), start) - Vec3::x() * 4.0).norm() < 1e-5);
    assert!((velocity_after(air(0.5, false), Vec3::zeros(), start) - Vec3::new(2.0, 1.0, 0.0)).norm() < 1e-5);
    assert!((velocity_after(air(1.0, true), Vec3::zeros(), start) - Vec3::new(4.0, 2.0, 0.0)).norm() < 1e-5);
    let faster = Vec3::x() * 9.0;
    assert!(
        (velocity_after(air(1.0, true), Vec3::zeros(), faster) - faster).norm() < 1e-5,
        "it never brakes"
    );
}

#[test]
fn turbulence_is_smooth_repeatable_and_of_mean_zero() {
    let places: Vec<Vec3> = (0..4000).map(|k| Vec3::new(f64::from(k) * 0.05, 0.3, -0.7)).collect();
    let run = || {
        let mut solver = points(&places, Vec3::zeros(), 1.0);
        let noise = Noise { frequency: Vec3::repeat(0.7), phase: Vec3::repeat(0.2), octaves: 2, ratio: 0.5 };
        solver.step(
            &input(FieldKind::Turbulence { force: 1.0, noise }, Reach::everywhere(), 1, false),
            &mut (),
        );
        let mut out = Vec::new();
        solver.velocities(POINTS, 1.0, &mut out);
        out.into_iter().map(|v| Vec3::from(v.map(f64::from)) / COUNT_PERIOD).collect::<Vec<_>>()
    };
    let all = run();
    assert_eq!(all, run());
    assert!(all.iter().all(|a| a.amax() <= 1.0));
    assert!(all.windows(2).all(|pair| (pair[1] - pair[0]).norm() < 0.3), "smooth");
    let mean = all.iter().sum::<Vec3>() / all.len() as f64;
    assert!(mean.norm() < 0.1, "{mean}");
    assert!(all.iter().map(Vec3::norm).sum::<f64>() / all.len() as f64 > 0.1);
}

// EVIDENCE: N3.1-5  fields act once per frame, gravity of the solver in every substep
#[test]
fn fields_act_once_per_frame_or_in_every_substep_and_the_difference_is_small() {
    // A point that orbits a centre: the field's direction changes within the frame.
    let radius = |per_substep: bool, substeps: u32| {
        let mut solver = points(&[Vec3::x()], Vec3::z() * 2.0, 1.0);
        let input = input(FieldKind::Radial { force: -4.0 }, Reach::everywhere(), substeps, per_substep);
        (0..24).for_each(|_| _ = solver.step(&input, &mut ()));
        solver.point(POINTS, 0).norm()
    };
    let (once, each, finest) = (radius(false, 8), radius(true, 8), radius(true, 256));
    println!("radius after a second: {once} once per frame, {each} in 8 substeps, {finest} in 256");
    assert!((finest - 1.0).abs() < 0.01);
    assert!((each - finest).abs() < 0.2 * (once - finest).abs(), "{once} {each} {finest}");
    assert_eq!(radius(true, 1), radius(false, 1), "the same with one substep");
}

#[test]
fn a_field_acts_on_its_targets_only_and_as_much_as_they_feel() {
    let sheet = grid(3, 3, Vec3::x(), Vec3::z());
    let mut builder = ModelBuilder::new();
    for _ in 0..3 {
        builder.cloth(Cloth::new(sheet.clone(), Mass::PerPoint(1.0), LINKS)).expect("a good mesh");
    }
    let mut solver = Solver::<f64>::new(builder, 1);
    let kind = FieldKind::Gravity { acceleration: Vec3::y() };
    let targets = vec![(ClothId(0), 1.0), (ClothId(2), 0.5)];
    let input = FrameInput {
        gravity: Vec3::zeros(),
        fields: vec![Field { kind, reach: Reach::everywhere(), targets }],
        cloths: vec![ClothFrame { collide: false, ..still() }; 3],
        ..frame(2, ResistanceModel::Classic)
    };
    solver.step(&input, &mut ());
    let speeds = [0, 1, 2].map(|cloth| {
        let mut out = Vec::new();
        solver.velocities(ClothId(cloth), 1.0, &mut out);
        f64::from(out[4][1]) / COUNT_PERIOD
    });
    assert!(
        (speeds[0] - 1.0).abs() < 1e-5 && speeds[1] == 0.0 && (speeds[2] - 0.5).abs() < 1e-5,
        "{speeds:?}"
    );
}
