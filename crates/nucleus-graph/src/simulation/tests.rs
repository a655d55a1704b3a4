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

/// Notes the height of the first collider's first point at each time step, beside the share of the frame.
#[derive(Default)]
struct Heights(Vec<(f64, f64)>);

impl StepObserver for Heights {
    fn substep(&mut self, _: SubstepIndex, _: &dyn StateView) {}

    fn step(&mut self, share: f64, state: &dyn StateView) {
        let mut points = Vec::new();
        state.collider_points(ColliderId(0), share, &mut points);
        self.0.push((share, points[0].y));
    }
}

/// The heights in the first frame, less that of the start state. The ball rises at 4 m per frame.
fn rise(every: f64, second: &str) -> Vec<(f64, f64)> {
    let text = format!(
        r#"Scene(time: (start: 1, end: 9, fps: 24, every: {every}), nodes: {{
            "n": nucleus(),
            "p": polyPlane(width: 1, height: 1, subdivisions: (2, 2)),
            "c": nCloth(inputMesh: "p", nucleus: "n"),
            "b": polySphere(radius: 1, translateX: 9, translateY: keys([(1, 0), (9, 32)])),
            "r": nRigid(inputMesh: "b", nucleus: "n"),
            {second}
        }}, checks: [finite])"#
    );
    let (scene, _) = read_scene_text(&text, Path::new("test.ron")).expect("a valid scene");
    let program = compile(&scene).expect("a valid scene");
    let mut run = Simulation::<f64>::new(&program, 1);
    let mut start = Vec::new();
    run.state().collider_points(ColliderId(0), 1.0, &mut start);
    let mut heights = Heights::default();
    run.advance(&mut heights);
    heights.0.into_iter().map(|(share, height)| (share, height - start[0].y)).collect()
}

#[test]
fn a_collider_is_seen_at_the_time_of_the_step_however_often_the_animation_is_evaluated() {
    for every in [1.0, 0.5, 0.25] {
        let heights = rise(every, "");
        assert!(heights.len() >= 4);
        for (share, height) in heights {
            assert!((height - 4.0 * share).abs() < 1e-5, "{height} at {share}, every {every}");
        }
    }
}

#[test]
fn a_collider_of_one_nucleus_stays_at_the_end_of_its_frame_while_the_next_nucleus_is_solved() {
    let second = r#""z": nucleus(), "d": nCloth(inputMesh: "p", nucleus: "z")"#;
    let heights: Vec<f64> = rise(1.0, second).into_iter().map(|(_, height)| height).collect();
    let (own, other) = heights.split_at(heights.len() / 2);
    for (step, height) in (1..).zip(own) {
        assert!((height - 4.0 * f64::from(step) / own.len() as f64).abs() < 1e-5, "{height} at step {step}");
    }
    assert!(other.iter().all(|height| (height - 4.0).abs() < 1e-5), "{other:?}");
}

fn program_of(text: &str) -> Program {
    let (scene, _) = read_scene_text(text, Path::new("test.ron")).expect("a valid scene");
    compile(&scene).expect("a valid scene")
}

/// The first coordinate of the first point, and its velocity.
fn along_x(state: &dyn StateView, cloth: ClothId) -> [f64; 2] {
    let mut column = Vec::new();
    let mut first = |read: &dyn Fn(&mut Vec<[f32; 3]>)| {
        read(&mut column);
        f64::from(column[0][0])
    };
    [first(&|out| state.positions(cloth, 1.0, out)), first(&|out| state.velocities(cloth, 1.0, out))]
}

// The time of the nucleus runs at half speed until frame 3 and at a quarter of that from then on; at frame 5 it stands still.
#[test]
fn velocities_are_per_second_of_the_scene() {
    for second in ["", r#""z": nucleus(), "c": nParticle(position0: [(9, 0, 0)], nucleus: "z"),"#] {
        let program = program_of(&format!(
            r#"Scene(time: (start: 1, end: 9, fps: 24), nodes: {{
                "n": nucleus(gravity: 0, timeScale: keys([(2, 0.5), (3, 0.125)]), enable: keys([(1, true), (5, false)])),
                "b": nParticle(position0: [(0, 0, 0)], velocity0: [(1, 0, 0)], drag: 0, nucleus: "n"), {second}
            }})"#
        ));
        let mut run = Simulation::<f64>::new(&program, 1);
        assert_eq!(along_x(run.state(), ClothId(0)), [0.0, 0.5]);
        let mut before = 0.0;
        for expected in [0.5, 0.125, 0.125, 0.0] {
            let mut seen = Positions { cloths: vec![ClothId(0)], ..Positions::default() };
            run.advance(&mut seen);
            let saved = Simulation::<f64>::restored(&program, 1, &run.save()).expect("the same program");
            let [x, velocity] = along_x(run.state(), ClothId(0));
            assert_eq!(along_x(saved.state(), ClothId(0)), [x, velocity]);
            assert_eq!(seen.velocities.last(), Some(&velocity));
            assert!((velocity - expected).abs() < 1e-6, "{velocity}, not {expected}");
            assert!((24.0 * (x - before) - velocity).abs() < 1e-5, "{x} after {before} at {velocity}");
            before = x;
        }
    }
}

/// Notes the share of the frame and first coordinates at each substep, and the velocities of the first cloth.
#[derive(Default)]
struct Positions {
    cloths: Vec<ClothId>,
    seen: Vec<(f64, Vec<f64>)>,
    velocities: Vec<f64>,
}

impl StepObserver for Positions {
    fn substep(&mut self, SubstepIndex { substep, substeps }: SubstepIndex, state: &dyn StateView) {
        let along = self.cloths.iter().map(|&cloth| along_x(state, cloth));
        let [positions, velocities] = [0, 1].map(|k| along.clone().map(|row| row[k]).collect::<Vec<f64>>());
        self.velocities.push(velocities[0]);
        self.seen.push((f64::from(substep) / f64::from(substeps), positions));
    }
}

/// Two beads at 24 m/s, each in a nucleus of its own with these attributes.
fn two_beads(every: f64, nuclei: [&str; 2]) -> Program {
    let bead = |name: &str, nucleus: &str| {
        format!(
            r#""{name}": nParticle(position0: [(0, 0, 0)], velocity0: [(24, 0, 0)], drag: 0, radius: 0.1,
                nucleus: "{nucleus}"),"#
        )
    };
    program_of(&format!(
        r#"Scene(time: (start: 1, end: 9, fps: 24, every: {every}), nodes: {{
            "m": nucleus(gravity: 0, {}), "n": nucleus(gravity: 0, {}), {} {}
        }})"#,
        nuclei[0],
        nuclei[1],
        bead("a", "m"),
        bead("b", "n"),
    ))
}

#[test]
fn substeps_of_several_nuclei_are_seen_at_their_own_times() {
    let cases: [(f64, [&str; 2], &[f64]); 4] = [
        (1.0, ["subSteps: 2", "subSteps: 3"], &[1.0 / 3.0, 0.5, 2.0 / 3.0, 1.0]),
        (1.0, ["subSteps: 2", "subSteps: 2"], &[0.5, 1.0]),
        (0.5, ["subSteps: 1", "subSteps: 2"], &[0.25, 0.5, 0.75, 1.0]),
        (1.0, ["subSteps: 1", "subSteps: 1, startFrame: 5"], &[1.0]),
    ];
    for (every, nuclei, times) in cases {
        let mut run = Simulation::<f64>::new(&two_beads(every, nuclei), 1);
        let starts_later = nuclei[1].contains("startFrame");
        for frame in 0..2 {
            let mut seen = Positions { cloths: vec![ClothId(0), ClothId(1)], ..Positions::default() };
            run.advance(&mut seen);
            assert_eq!(seen.seen.len(), times.len(), "{nuclei:?}");
            for ((share, positions), time) in seen.seen.iter().zip(times) {
                assert!((share - time).abs() < 1e-12, "{share}, not {time}");
                let expected = f64::from(frame) + time;
                assert!((positions[0] - expected).abs() < 1e-5, "{nuclei:?}: {positions:?} at {expected}");
                let of_second = if starts_later { 0.0 } else { expected };
                assert!((positions[1] - of_second).abs() < 1e-5, "{nuclei:?}: {positions:?} at {expected}");
            }
        }
    }
}

#[test]
fn a_restored_run_of_several_nuclei_shows_the_same_substeps() {
    let balls = r#"maximumCorner: (3, 3, 3), radius: 0.2"#;
    let program = program_of(&format!(
        r#"Scene(time: (start: 1, end: 30, fps: 24), nodes: {{
            "m": nucleus(subSteps: 2, usePlane: true), "n": nucleus(subSteps: 3, usePlane: true),
            "a": nParticle({balls}, nucleus: "m"), "b": nParticle({balls}, nucleus: "n"),
        }})"#
    ));
    let mut run = Simulation::<f32>::new(&program, 1);
    while run.frame() < 20 {
        run.advance(&mut ());
    }
    let mut again = Simulation::<f32>::restored(&program, 1, &run.save()).expect("the same program");
    let mut seen =
        [(); 2].map(|()| Positions { cloths: vec![ClothId(0), ClothId(1)], ..Positions::default() });
    run.advance(&mut seen[0]);
    again.advance(&mut seen[1]);
    assert_eq!(seen[0].seen, seen[1].seen);
    assert_eq!(seen[0].velocities, seen[1].velocities);
}
