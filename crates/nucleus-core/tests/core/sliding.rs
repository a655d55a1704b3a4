//! Links that slide along surfaces.

use std::f64::consts::{PI, TAU};

use crate::scenes::links::{PHYSICAL, model, point, points, run, tied};
use crate::scenes::{Vec3, grid, sphere};
use nucleus_core::{
    ClothId, Collider, ColliderFrame, ColliderId, ConstraintFrame, FrameInput, Link, LinkKind, LinkMethod,
    LinkSide, ModelBuilder, PointId, ResistanceModel, Solver, StateView,
};

/// A bead on a ball, pushed along it.
fn bead_on_ball(friction: f64, speed: f64) -> (ModelBuilder, FrameInput) {
    let ball = sphere(0.5, Vec3::zeros());
    let start = Vec3::new(0.0, 0.51, 0.0);
    let mut bead = points(&[start]);
    bead.start.velocities = vec![Vec3::x() * speed];
    let mut builder = model([bead]);
    builder.collider(Collider { surface: ball.clone() }).expect("a good mesh");
    let top = ball.faces.triangles().find(|corners| corners.contains(&0)).expect("a face at the pole");
    let weights = top.map(|corner| if corner == 0 { 1.0 } else { 0.0 });
    let foot = LinkSide::Collider { collider: ColliderId(0), points: top.map(PointId), weights };
    let link = Link { kind: LinkKind::Surface, ..Link::new([point(0, 0), foot], 0.01) };
    let constraint = ConstraintFrame {
        formed: Some(vec![link]),
        slides: true,
        friction,
        keep_off: Some(0.01),
        strength: 20.0,
        ..ConstraintFrame::default()
    };
    let mut input = tied(1, PHYSICAL, constraint);
    input.gravity = Vec3::zeros();
    input.colliders = vec![ColliderFrame::default()];
    (builder, input)
}

// EVIDENCE: N2.4-4  a sliding point stays on its surface at speed
#[test]
fn a_sliding_point_leaves_the_surface_by_less_than_its_thickness_at_speed() {
    let (builder, mut input) = bead_on_ball(0.0, 6.0);
    let mut solver: Solver<f64> = Solver::new(builder, 1);
    let mut turned = 0.0;
    for _ in 0..24 {
        let before = solver.point(ClothId(0), 0);
        run(&mut solver, &mut input, 1);
        let now = solver.point(ClothId(0), 0);
        turned += before.angle(&now);
        let height = now.norm() - 0.5;
        assert!(height > 0.002 && height < 0.02, "{height} m above the ball");
    }
    assert!(turned > 10.0, "it has gone round the ball by {turned} rad");
}

// EVIDENCE: N2.4-4  a sliding point stays on a surface that deforms
#[test]
fn a_sliding_point_leaves_a_surface_that_deforms_by_less_than_its_thickness() {
    let (builder, mut input) = bead_on_ball(0.0, 3.0);
    let ball = sphere(0.5, Vec3::zeros());
    // The ball breathes by a fifth of its radius, twice a second.
    let radius = |frame: u32| 0.5 * (1.0 + 0.2 * (TAU * f64::from(frame) / 12.0).sin());
    let at = |frame| -> Vec<Vec3> { ball.positions.iter().map(|p| p * (radius(frame) / 0.5)).collect() };
    let mut solver: Solver<f64> = Solver::new(builder, 1);
    let mut turned = 0.0;
    for frame in 0..24 {
        (input.colliders[0].start, input.colliders[0].end) = (at(frame), at(frame + 1));
        let before = solver.point(ClothId(0), 0);
        run(&mut solver, &mut input, 1);
        let now = solver.point(ClothId(0), 0);
        turned += before.angle(&now);
        let height = now.norm() - radius(frame + 1);
        assert!(height > 0.0 && height < 0.02, "frame {frame}: {height} m above the ball");
    }
    assert!(turned > 4.0, "it has gone round the ball by {turned} rad");
}

#[test]
fn a_point_that_slides_off_an_open_border_gains_no_energy() {
    let (sin, cos) = (PI / 6.0).sin_cos();
    let (down, across) = (Vec3::new(cos, -sin, 0.0), Vec3::z());
    let mut slope = grid(3, 3, down, across);
    slope.positions.iter_mut().for_each(|place| *place -= (down + across) * 0.5);
    let start = Vec3::new(sin, cos, 0.0) * 0.05;
    for evaluations in [24.0, 96.0, 384.0] {
        let mut builder = model([points(&[start])]);
        builder.collider(Collider { surface: slope.clone() }).expect("a good mesh");
        let corners = slope.faces.triangles().find(|corners| corners.contains(&4)).expect("the middle");
        let weights = corners.map(|corner| if corner == 4 { 1.0 } else { 0.0 });
        let foot = LinkSide::Collider { collider: ColliderId(0), points: corners.map(PointId), weights };
        let normal = {
            let [a, b, c] = corners.map(|corner| slope.positions[corner as usize]);
            (b - a).cross(&(c - a))
        };
        let rest = 0.05 * normal.y.signum();
        let link = Link { kind: LinkKind::Surface, ..Link::new([point(0, 0), foot], rest) };
        let constraint = ConstraintFrame {
            formed: Some(vec![link]),
            method: LinkMethod::Weld,
            slides: true,
            single_sided: true,
            ..ConstraintFrame::default()
        };
        let mut input = tied(1, ResistanceModel::Physical { evaluations }, constraint);
        input.colliders = vec![ColliderFrame::default()];
        let (gravity, mut solver) = (input.gravity, Solver::<f64>::new(builder, 1));
        let energy = |solver: &Solver<f64>| {
            let mut velocities = Vec::new();
            solver.velocities(ClothId(0), 1.0, &mut velocities);
            let speed = Vec3::from(velocities[0].map(f64::from)).norm();
            speed * speed / 2.0 - gravity.dot(&solver.point(ClothId(0), 0))
        };
        let before = energy(&solver);
        let mut lowest = 0.0f64;
        for number in 0..96 {
            run(&mut solver, &mut input, 1);
            let place = solver.point(ClothId(0), 0);
            lowest = lowest.min(place.y);
            assert!(
                energy(&solver) < before + 0.02,
                "{evaluations}, frame {number}: {} at {place}",
                energy(&solver)
            );
        }
        assert!(lowest < -0.25, "it reaches the border: {lowest}");
    }
}

#[test]
fn sliding_with_full_friction_does_not_slide() {
    let (builder, mut input) = bead_on_ball(1.0, 2.0);
    input.constraints[0].tangent_strength = 20.0;
    input.constraints[0].damp = 10.0;
    input.constraints[0].motion_drag = 0.5;
    let mut solver: Solver<f64> = Solver::new(builder, 1);
    run(&mut solver, &mut input, 72);
    assert!((solver.point(ClothId(0), 0) - Vec3::new(0.0, 0.51, 0.0)).norm() < 0.01);
}
