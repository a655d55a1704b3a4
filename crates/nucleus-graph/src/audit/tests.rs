use std::path::Path;

use nucleus_audit::Plane;
use nucleus_core::{ClothId, ColliderId};

use super::*;
use crate::Simulation;
use crate::checks::Judge;
use crate::compile::{AttachmentState, Program, compile};
use crate::scene::read_scene_text;

fn program(nodes: &str) -> Program {
    let text = format!(
        r#"Scene(time: (start: 1, end: 9, fps: 24), nodes: {{
            "n": nucleus(),
            "sheet": polyPlane(width: 2, height: 2, subdivisions: (6, 6), translate: (0, 1.5, 0)),
            "ball": polySphere(radius: 1, subdivisions: (12, 8)),
            {nodes}
        }}, checks: [noSelfIntersection])"#
    );
    let (scene, _) = read_scene_text(&text, Path::new("test.ron")).expect("a valid scene");
    compile(&scene).expect("a valid scene")
}

const SHEET_AND_BALL: &str = r#""c": nCloth(inputMesh: "sheet"), "r": nRigid(inputMesh: "ball")"#;

/// A state with the sheet horizontal, at a height in metres.
struct Level<'a> {
    start: &'a dyn StateView,
    height: f64,
}

impl StateView for Level<'_> {
    fn positions(&self, _: ClothId, _: f64, _: &mut Vec<[f32; 3]>) {}
    fn velocities(&self, _: ClothId, _: f64, _: &mut Vec<[f32; 3]>) {}
    fn collider_positions(&self, collider: ColliderId, units: f64, out: &mut Vec<[f32; 3]>) {
        self.start.collider_positions(collider, units, out);
    }
    fn collider_moved(&self, _: ColliderId) -> bool {
        false
    }
    fn point(&self, cloth: ClothId, point: usize) -> Vector3<f64> {
        let place = self.start.point(cloth, point);
        Vector3::new(place.x, self.height, place.z)
    }
}

/// The audit of a sheet that moves from height to height.
fn found(nodes: &str, closeness: Closeness, heights: &[f64]) -> AuditCounts {
    let program = program(nodes);
    let run = Simulation::<f64>::new(&program, 1);
    let rules = |world: &CollisionMesh| collision_rules(&program, 2, &AuditScope::default(), world);
    let mut audit = Audit::new(run.objects(), closeness, run.state(), rules);
    for (frame, &height) in (2..).zip(heights) {
        audit.begin_frame(frame, rules);
        let moment = core::SubstepIndex { substep: 1, substeps: 1 };
        audit.substep(moment, &Level { start: run.state(), height }, &GroundPlanes::default());
    }
    audit.account()
}

#[test]
fn a_sheet_that_moves_through_a_ball_in_one_step_is_found_only_in_its_motion() {
    let leap = [1.4, -1.5];
    assert!(found(SHEET_AND_BALL, Closeness::Steps, &leap).crossings > 0);
    assert!(found(SHEET_AND_BALL, Closeness::Frames, &leap).is_clean());
}

#[test]
fn a_sheet_that_ends_inside_a_ball_is_found_in_states_and_in_motions() {
    for closeness in [Closeness::Steps, Closeness::Frames] {
        assert!(!found(SHEET_AND_BALL, closeness, &[1.4, 0.3]).is_clean(), "{closeness:?}");
        assert!(found(SHEET_AND_BALL, closeness, &[1.4, 1.3]).is_clean(), "{closeness:?}");
    }
}

#[test]
fn states_within_a_substep_are_audited() {
    let program = program(SHEET_AND_BALL);
    let run = Simulation::<f64>::new(&program, 1);
    let rules = |world: &CollisionMesh| collision_rules(&program, 2, &AuditScope::default(), world);
    let mut audit = Audit::new(run.objects(), Closeness::Steps, run.state(), rules);
    audit.begin_frame(2, rules);
    let level = |height: f64| Level { start: run.state(), height };
    let mut watch = ();
    let planes = RefCell::default();
    let mut audited = Audited::new(&mut audit, &planes, &mut watch);
    audited.step(0.5, &level(-1.5));
    audited.step(1.0, &level(1.4));
    audited.substep(core::SubstepIndex { substep: 1, substeps: 1 }, &level(1.4));
    let account = audit.account();
    assert_eq!((account.motions, account.intersections), (2, 0), "the end of the substep adds no motion");
    assert!(account.crossings > 0, "the sheet moved down and up again");
}

#[test]
fn objects_that_do_not_collide_and_pinned_points_are_not_audited() {
    let ghost = r#""c": nCloth(inputMesh: "sheet", collide: false), "r": nRigid(inputMesh: "ball")"#;
    assert!(found(ghost, Closeness::Steps, &[0.3]).is_clean());
    let held = format!(
        r#"{SHEET_AND_BALL}, "k": dynamicConstraint(constraintType: transform, components: ["c.vtx[*]"])"#
    );
    let program = program(&held);
    let mut run = Simulation::<f64>::new(&program, 1);
    run.begin_audit(Closeness::Steps);
    let scope = run.next_scope();
    let world = CollisionMesh::new(vec![
        Body { points: 49, ..Body::default() },
        Body { points: 86, ..Body::default() },
    ]);
    let mut all = CollisionFilter::default();
    (0..135).for_each(|point| all.set_kinematic(point));
    all.ignore(1, 1); // as Maya makes an nRigid
    assert_eq!(collision_rules(&program, 2, &scope, &world), all);
}

#[test]
fn cloths_in_distant_collision_layers_are_not_audited() {
    let two = |layer: f64| {
        let nodes = format!(
            r#""other": polyPlane(width: 2, height: 2, translate: (0.01, 1, 0.02)),
               "c": nCloth(inputMesh: "sheet"), "d": nCloth(inputMesh: "other", collisionLayer: {layer})"#
        );
        let program = program(&nodes);
        let world = CollisionMesh::new(vec![Body::default(), Body::default()]);
        collision_rules(&program, 2, &AuditScope::default(), &world) == CollisionFilter::default()
    };
    assert!(two(0.0) && two(3.9) && !two(4.0), "the range is 4 unless it is set");
}

#[test]
fn the_check_for_crossings_passes_only_with_an_audit() {
    let program = program(SHEET_AND_BALL);
    let passes = |audited: bool| {
        let mut run = Simulation::<f32>::new(&program, 1);
        if audited {
            run.begin_audit(Closeness::Frames);
        }
        let mut judge = Judge::new(program.checks(), program.mass());
        while !run.is_done() {
            judge.see(&run.advance(&mut ()));
        }
        judge.outcomes()[0].passed
    };
    assert!(passes(true) && !passes(false));
}

#[test]
fn an_audit_does_not_change_the_result() {
    let program = program(SHEET_AND_BALL);
    let hash = |closeness: Option<Closeness>| {
        let mut run = Simulation::<f32>::new(&program, 1);
        closeness.into_iter().for_each(|closeness| run.begin_audit(closeness));
        for _ in 0..4 {
            run.advance(&mut ());
        }
        run.solver().state_hash()
    };
    assert_eq!(hash(None), hash(Some(Closeness::Steps)));
}

#[test]
fn a_ground_plane_moves_linearly_in_each_span_from_the_end_of_the_span_before() {
    let level = |height: f64| Plane::new(Vector3::y() * height, Vector3::y());
    let program = program(r#""c": nCloth(inputMesh: "sheet")"#);
    let mut input = program
        .interval(0, [1.0, 2.0], 1.0, false)
        .input(&mut AttachmentState::default(), &|_, _| Vector3::zeros());
    let mut put = |planes: &mut GroundPlanes, height: f64, span: [f64; 2]| {
        let (origin, normal) = (Vector3::y() * height, Vector3::y());
        input.plane = Some(core::GroundPlane::new(origin, normal));
        planes.begin_span(0, 0, &input, span);
    };
    let mut planes = GroundPlanes::default();
    let at = |planes: &GroundPlanes, share: f64| planes.of(ClothId(0), share).map(|[_, now]| now);
    put(&mut planes, 1.0, [0.0, 1.0]);
    assert_eq!(at(&planes, 0.0), level(1.0), "a plane that appears does not move");
    planes.begin_frame();
    assert_eq!(at(&planes, 0.0), level(1.0), "it has not moved yet");
    put(&mut planes, 2.0, [0.0, 0.5]);
    assert_eq!([0.0, 0.25, 0.5].map(|share| at(&planes, share)), [1.0, 1.5, 2.0].map(level));
    put(&mut planes, 4.0, [0.5, 1.0]);
    assert_eq!([0.5, 0.75, 1.0].map(|share| at(&planes, share)), [2.0, 3.0, 4.0].map(level));
    assert_eq!(planes.of(ClothId(1), 1.0), None, "there is one cloth");
}

#[test]
fn excluded_pairs_and_welded_points_are_not_audited() {
    let audited = |constraint: &str| {
        let nodes = format!(
            r#""other": polyPlane(width: 2, height: 2, translate: (0, 1, 0)),
               "c": nCloth(inputMesh: "sheet"), "d": nCloth(inputMesh: "other") {constraint}"#
        );
        let program = program(&nodes);
        let run = Simulation::<f64>::new(&program, 1);
        let scope = run.next_scope();
        (scope.welds.len(), scope.exclusions.len())
    };
    assert_eq!(audited(""), (0, 0));
    let excluded = r#", "k": dynamicConstraint(type: collisionExclusion, components: ["c", "d"])"#;
    assert_eq!(audited(excluded), (0, 1));
    let welded = r#", "k": dynamicConstraint(type: pointToPoint, constraintMethod: weld, components: ["c.vtx[0:2]", "d.vtx[0:2]"])"#;
    assert_eq!(audited(welded), (3, 0));
}

#[test]
fn elements_with_a_partial_collide_strength_are_not_audited() {
    // The sheet moves into the ball and out of it again.
    let passed = |cloth: &str, ball: &str| {
        let program = program(&format!(
            r#""c": nCloth(inputMesh: "sheet", {cloth}), "r": nRigid(inputMesh: "ball", {ball})"#
        ));
        let run = Simulation::<f64>::new(&program, 1);
        let scope = run.next_scope();
        let rules = |world: &CollisionMesh| collision_rules(&program, 2, &scope, world);
        let mut audit = Audit::new(run.objects(), Closeness::Steps, run.state(), rules);
        audit.begin_frame(2, rules);
        let moment = core::SubstepIndex { substep: 1, substeps: 1 };
        audit.substep(moment, &Level { start: run.state(), height: 0.3 }, &GroundPlanes::default());
        audit.account().found()
    };
    let all = passed("", "");
    assert!(all > 0);
    assert_eq!(passed("", "collideStrength: 0.5"), 0);
    assert_eq!(passed("collideStrength: 0.5", ""), 0);
    assert_eq!(passed("collideStrength: 2", "collideStrength: 1"), all);
    let upper = passed("", r#"collideStrengthPerVertex: expression("x > 0 ? 0.5 : 1")"#);
    assert!(0 < upper && upper < all, "half of the ball is audited: {upper} of {all}");
}

#[test]
fn a_mesh_that_can_tear_does_not_intersect_itself_at_its_welds() {
    let text = r#"Scene(time: (start: 1, end: 9, fps: 24), nodes: {
        "n": nucleus(), "box": polyCube(subdivisions: (2, 2, 2)), "c": nCloth(inputMesh: "box"),
        "rip": dynamicConstraint(constraintType: tearableSurface, components: ["c"]),
    }, checks: [finite])"#;
    let (scene, _) = read_scene_text(text, Path::new("test.ron")).expect("a valid scene");
    let warnings = crate::first_frame_warnings(&scene, &compile(&scene).expect("a valid scene"));
    let about_intersections = warnings.iter().find(|warning| warning.message.contains("intersection"));
    assert_eq!(about_intersections, None);
}
