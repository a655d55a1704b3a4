//! Liquids that moving walls drive: they get no more than the speed of the walls.

use crate::liquids::{Moved, WATER, block, built, frictionless, liquid, walls, water};
use crate::scenes::{Vec3, frame, grid, ground, physical};
use nucleus_core::{COUNT_PERIOD, FrameInput, GroundPlane, Solver, StateView, Surface};

/// Water of 6 by 4 by 6 particles in an upright tube on the ground, with further colliders; and its input at rest.
fn water_in_a_tube(spacing: f64, lids: Vec<Surface>) -> (Solver<f32>, FrameInput) {
    let cloth = water(block(Vec3::zeros(), [6, 4, 6], spacing), Vec::new(), spacing);
    let mut colliders = walls([[0.0; 2], [6.0 * spacing; 2]], 60.0 * spacing);
    colliders.extend(lids);
    let input = FrameInput {
        cloths: vec![liquid(spacing)],
        colliders: frictionless(colliders.len()),
        plane: Some(ground(0.0)),
        ..frame(3, physical(96.0))
    };
    (Solver::new(built([cloth], colliders), 1), input)
}

/// In the frame of the floor nothing moves that could do work, so the energy there is at most what it was when the floor
/// started, and what the water can lose by falling.
// EVIDENCE: N2.4-8  a floor that starts at once gives a liquid no energy but that of the impact
#[test]
fn a_floor_that_starts_at_once_makes_no_energy_in_water() {
    let spacing = 0.08;
    for speed in [1.0, 4.0, 8.0] {
        let (mut solver, mut input) = water_in_a_tube(spacing, Vec::new());
        (0..12).for_each(|_| _ = solver.step(&input, &mut ()));
        for k in 1..=2 {
            let origin = Vec3::y() * (f64::from(k) * speed * COUNT_PERIOD);
            input.plane = Some(GroundPlane { origin, ..ground(0.0) });
            solver.step(&input, &mut ());
        }
        let mut velocities = Vec::new();
        solver.velocities(WATER, 1.0, &mut velocities);
        let relative =
            velocities.iter().map(|v| (Vec3::from(v.map(f64::from)) - Vec3::y() * speed).norm_squared());
        let energy = relative.sum::<f64>() / (2.0 * velocities.len() as f64);
        let most = speed * speed / 2.0 + input.gravity.norm() * 4.0 * spacing;
        assert!(energy < most, "a floor at {speed} m/s: {energy} J/kg of {most}");
    }
}

#[test]
fn a_piston_that_leaves_water_no_room_presses_it_together_and_makes_no_energy() {
    let spacing = 0.05;
    let lid = |height: f64| {
        let side = 10.0 * spacing;
        grid(2, 2, Vec3::x() * side, Vec3::z() * side).moved(Vec3::new(
            -2.0 * spacing,
            height,
            -2.0 * spacing,
        ))
    };
    let (mut solver, mut input) = water_in_a_tube(spacing, vec![lid(6.0 * spacing)]);
    let mass = 144.0 * 1000.0 * spacing.powi(3);
    let mut height = 6.0 * spacing;
    for _ in 0..16 {
        height = (height - 0.5 * COUNT_PERIOD).max(2.5 * spacing);
        input.colliders[4].end = lid(height).positions;
        let report = solver.step(&input, &mut ());
        let speed = (2.0 * report.kinetic_energy / mass).sqrt();
        assert!(report.finite && speed < 4.0, "the piston at {height} m moves at 0.5 m/s, water at {speed}");
    }
}
