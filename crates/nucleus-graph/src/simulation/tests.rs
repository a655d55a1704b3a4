use std::path::Path;

use nucleus_core::{ClothId, SubstepIndex};

use super::*;
use crate::compile::{ObjectKind, compile};
use crate::scene::read_scene_text;

fn program(nucleus: &str, scale: f64) -> Program {
    let text = format!(
        r#"Scene(
            time: (start: 1, end: 25, fps: 24),
            nodes: {{
                "n": nucleus(airDensity: 0, {nucleus}),
                "p": polyPlane(width: {scale}, height: {scale}, subdivisions: (2, 2)),
                "c": nCloth(inputMesh: "p"),
                "b": polySphere(radius: {scale}, ty: {}),
                "r": nRigid(inputMesh: "b"),
            }},
        )"#,
        -20.0 * scale
    );
    let (scene, _) = read_scene_text(&text, Path::new("test.ron")).expect("a valid scene");
    compile(&scene).expect("a valid scene")
}

/// Counts substeps.
#[derive(Default)]
struct Counter(Vec<u32>);

impl StepObserver for Counter {
    fn substep(&mut self, moment: SubstepIndex, _state: &dyn StateView) {
        self.0.push(moment.substep);
    }
}

/// The distance that the cloth falls in all frames, in scene units.
fn fall(program: &Program) -> f32 {
    let mut run = Simulation::<f64>::new(program, 1);
    while !run.is_done() {
        run.advance(&mut ());
    }
    let mut positions = Vec::new();
    run.state().positions(ClothId(0), run.units_per_metre(), &mut positions);
    -positions[0][1]
}

// EVIDENCE: N1.3-1  with spaceScale 1 in metres and 0.01 in centimetres, the cloth falls 4.9 m in one second
#[test]
fn free_fall_is_correct_in_metres_and_in_centimetres() {
    let metres = fall(&program("subSteps: 100", 1.0));
    assert!((metres - 4.9).abs() < 0.01, "{metres}");
    let centimetres = fall(&program("subSteps: 100, spaceScale: 0.01", 100.0));
    assert!((centimetres - 490.0).abs() < 1.0, "{centimetres}");
}

// EVIDENCE: N3.1-6  every change of time makes one solver call, which runs all substeps
#[test]
fn a_frame_is_one_solver_call() {
    let program = program("subSteps: 3", 1.0);
    let mut run = Simulation::<f32>::new(&program, 1);
    let mut counter = Counter::default();
    assert_eq!((run.frame(), run.is_done()), (1, false));
    assert_eq!(run.advance(&mut counter).frame, 2);
    assert_eq!(counter.0, [1, 2, 3]);
    assert_eq!(run.advance(&mut counter).frame, 3);
    assert_eq!(counter.0, [1, 2, 3, 1, 2, 3]);
    assert_eq!(run.frame(), 3);
}

// EVIDENCE: N3.1-5  gravity acts in every substep: n of them fall g T² (n + 1) / 2n, not g T²
#[test]
fn gravity_acts_in_every_substep() {
    for substeps in [1.0, 4.0] {
        let program = program(&format!("resistanceModel: classic, subSteps: {substeps}"), 1.0);
        let mut run = Simulation::<f64>::new(&program, 1);
        run.advance(&mut ());
        let fallen = -run.state().point(ClothId(0), 0).y;
        let expected = 9.8 / 576.0 * (substeps + 1.0) / (2.0 * substeps);
        assert!((fallen - expected).abs() < 1e-9, "{substeps}: {fallen}");
    }
}

#[test]
fn cloths_precede_colliders_in_the_list_of_objects() {
    let run = Simulation::<f32>::new(&program("", 1.0), 1);
    let objects: Vec<_> = run.objects().iter().map(|o| (o.name.as_str(), o.points, o.faces.len())).collect();
    assert_eq!(objects, [("c", 9, 4), ("r", 382, 400)]);
    assert!(matches!(run.objects()[0].kind, ObjectKind::Cloth(ClothId(0))));
}

#[test]
fn the_initial_state_has_the_positions_of_the_meshes() {
    let run = Simulation::<f32>::new(&program("spaceScale: 0.01", 100.0), 1);
    let mut positions = Vec::new();
    run.state().positions(ClothId(0), run.units_per_metre(), &mut positions);
    assert_eq!(positions[0], [-50.0, 0.0, 50.0]);
}
