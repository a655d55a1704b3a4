use std::path::Path;

use nucleus_audit::Plane;
use nucleus_core::{ClothId, ColliderId};

use super::*;
use crate::Simulation;
use crate::checks::Judge;
use crate::compile::{Grips, Program, compile};
use crate::scene::read_scene_text;

fn program(nodes: &str) -> Program {
    let text = format!(
        r#"Scene(time: (start: 1, end: 9, fps: 24), nodes: {{
            "n": nucleus(),
            "sheet": polyPlane(width: 2, height: 2, subdivisions: (6, 6), translate: (0, 1.5, 0)),
            "ball": polySphere(radius: 1, subdivisions: (12, 8)),
            {nodes}
        }}, checks: [noCrossing])"#
    );
    let (scene, _) = read_scene_text(&text, Path::new("test.ron")).expect("a valid scene");
    compile(&scene).expect("a valid scene")
}

const SHEET_AND_BALL: &str = r#""c": nCloth(inputMesh: "sheet"), "r": nRigid(inputMesh: "ball")"#;

/// A state in which the sheet is level, at a height.
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

/// What an audit finds of a sheet that is put at one height after the other.
fn found(nodes: &str, closeness: Closeness, heights: &[f64]) -> AuditCounts {
    let program = program(nodes);
    let run = Simulation::<f64>::new(&program, 1);
    let rules = |world: &CollisionMesh| program.kept_apart(2, &[], world);
    let mut audit = Audit::new(run.objects(), closeness, run.state(), rules);
    for (frame, &height) in (2..).zip(heights) {
        audit.begin_frame(frame, rules);
        let moment = core::SubstepIndex { substep: 1, substeps: 1 };
        audit.substep(moment, &Level { start: run.state(), height }, &Grounds::default());
    }
    audit.account()
}

#[test]
fn a_sheet_that_leaps_over_a_ball_is_seen_only_on_the_way() {
    let leap = [1.4, -1.5];
    assert!(found(SHEET_AND_BALL, Closeness::Steps, &leap).crossings > 0);
    assert!(found(SHEET_AND_BALL, Closeness::Frames, &leap).is_clean());
}

#[test]
fn a_sheet_that_ends_inside_a_ball_is_seen_either_way() {
    for closeness in [Closeness::Steps, Closeness::Frames] {
        assert!(!found(SHEET_AND_BALL, closeness, &[1.4, 0.3]).is_clean(), "{closeness:?}");
        assert!(found(SHEET_AND_BALL, closeness, &[1.4, 1.3]).is_clean(), "{closeness:?}");
    }
}

#[test]
fn what_is_shown_within_a_substep_is_followed() {
    let program = program(SHEET_AND_BALL);
    let run = Simulation::<f64>::new(&program, 1);
    let rules = |world: &CollisionMesh| program.kept_apart(2, &[], world);
    let mut audit = Audit::new(run.objects(), Closeness::Steps, run.state(), rules);
    audit.begin_frame(2, rules);
    let level = |height: f64| Level { start: run.state(), height };
    let mut watch = ();
    let grounds = RefCell::default();
    let mut audited = Audited::new(&mut audit, &grounds, &mut watch);
    audited.step(0.5, &level(-1.5));
    audited.step(1.0, &level(1.4));
    audited.substep(core::SubstepIndex { substep: 1, substeps: 1 }, &level(1.4));
    let account = audit.account();
    assert_eq!(
        (account.motions, account.intersections),
        (2, 0),
        "the end of the substep is no motion of its own"
    );
    assert!(account.crossings > 0, "it leapt down and up again");
}

#[test]
fn what_is_told_to_pass_through_may() {
    let ghost = r#""c": nCloth(inputMesh: "sheet", collide: false), "r": nRigid(inputMesh: "ball")"#;
    assert!(found(ghost, Closeness::Steps, &[0.3]).is_clean());
    let held = format!(
        r#"{SHEET_AND_BALL}, "k": dynamicConstraint(constraintType: transform, components: ["c.vtx[*]"])"#
    );
    let program = program(&held);
    let mut run = Simulation::<f64>::new(&program, 1);
    run.begin_audit(Closeness::Steps);
    let pins = run.next_pins();
    let world = CollisionMesh::new(vec![
        Body { points: 49, ..Body::default() },
        Body { points: 86, ..Body::default() },
    ]);
    let mut all = CollisionFilter::default();
    (0..135).for_each(|point| all.set_kinematic(point));
    all.ignore(1, 1); // as Maya makes an nRigid
    assert_eq!(program.kept_apart(2, &pins, &world), all);
}

#[test]
fn cloths_in_layers_far_apart_are_not_held_to_anything() {
    let two = |layer: f64| {
        let nodes = format!(
            r#""other": polyPlane(width: 2, height: 2, translate: (0.01, 1, 0.02)),
               "c": nCloth(inputMesh: "sheet"), "d": nCloth(inputMesh: "other", collisionLayer: {layer})"#
        );
        let program = program(&nodes);
        let world = CollisionMesh::new(vec![Body::default(), Body::default()]);
        program.kept_apart(2, &[], &world) == CollisionFilter::default()
    };
    assert!(two(0.0) && two(3.9) && !two(4.0), "the range is 4 unless it is set");
}

#[test]
fn a_check_for_crossings_is_answered_by_an_audit_and_by_nothing_else() {
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
fn an_audit_changes_nothing() {
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
fn a_ground_plane_goes_from_where_the_last_span_left_it_to_where_the_next_puts_it() {
    let level = |height: f64| Plane::new(Vector3::y() * height, Vector3::y());
    let program = program(r#""c": nCloth(inputMesh: "sheet")"#);
    let mut input =
        program.stretch(0, [1.0, 2.0], 1.0, false).input(&mut Grips::default(), &|_, _| Vector3::zeros());
    let mut put = |grounds: &mut Grounds, height: f64, span: [f64; 2]| {
        let (origin, normal) = (Vector3::y() * height, Vector3::y());
        input.plane = Some(core::GroundPlane { origin, normal, bounce: 0.0, friction: 0.0, stickiness: 0.0 });
        grounds.take(0, 0, &input, span);
    };
    let mut grounds = Grounds::default();
    let at = |grounds: &Grounds, share: f64| grounds.of(ClothId(0), share).map(|[_, now]| now);
    put(&mut grounds, 1.0, [0.0, 1.0]);
    assert_eq!(at(&grounds, 0.0), level(1.0), "a plane that appears is there from the start");
    grounds.begin_frame();
    assert_eq!(at(&grounds, 0.0), level(1.0), "it has not been moved yet");
    put(&mut grounds, 2.0, [0.0, 0.5]);
    assert_eq!([0.0, 0.25, 0.5].map(|share| at(&grounds, share)), [1.0, 1.5, 2.0].map(level));
    put(&mut grounds, 4.0, [0.5, 1.0]);
    assert_eq!([0.5, 0.75, 1.0].map(|share| at(&grounds, share)), [2.0, 3.0, 4.0].map(level));
    assert_eq!(grounds.of(ClothId(1), 1.0), None, "there is one cloth");
}
