//! Frame rates, evaluation intervals, and moving meshes.

use std::fs;

use nucleus_core::{StateView, StepObserver, SubstepIndex};
use nucleus_graph::Simulation;
use nucleus_graph::compile::{ObjectKind, Program, compile};
use nucleus_graph::scene::read_scene_text;

use super::scenes::{of_nodes, program};

/// A falling sheet, in vacuum.
fn falling(time: &str, nucleus: &str) -> Program {
    program(&format!(
        r#"Scene(time: ({time}), nodes: {{
            "n": nucleus(airDensity: 0, resistanceModel: classic, {nucleus}), "p": polyPlane(subdivisions: (1, 1)), "c": nCloth(inputMesh: "p"),
        }})"#
    ))
}

/// Height of a point of the first cloth after each frame that is evaluated.
fn heights(program: &Program) -> Vec<f64> {
    let mut run = Simulation::<f64>::new(program, 1);
    let mut heights = Vec::new();
    while !run.is_done() {
        run.advance(&mut ());
        heights.push(run.state().point(nucleus_core::ClothId(0), 0).y);
    }
    heights
}

fn last(program: &Program) -> f64 {
    heights(program).pop().unwrap_or_default()
}

// EVIDENCE: N1.3-1  a second of fall is 4.9 m at any frame rate
#[test]
fn a_second_is_a_second_at_any_frame_rate() {
    for (fps, end) in [(24.0, 25), (25.0, 26), (30.0, 31), (60.0, 61), (12.5, 26)] {
        let program = falling(&format!("start: 1, end: {end}, fps: {fps}"), "subSteps: 20");
        let seconds = (end - 1) as f64 / fps;
        let expected = -4.9 * seconds * seconds;
        let height = last(&program);
        assert!((height / expected - 1.0).abs() < 0.01, "{fps}: {height} is not {expected}");
    }
}

// EVIDENCE: N2.4-9  evaluating more often refines the base step
#[test]
fn evaluations_may_be_finer_or_coarser_than_frames() {
    // Symplectic Euler with n equal steps falls by g t² (n + 1) / 2n, which gives the number of steps.
    let steps = |every: f64, sub_steps: u32| {
        let program = falling(
            &format!("start: 1, end: 25, fps: 24, every: {every}"),
            &format!("subSteps: {sub_steps}"),
        );
        1.0 / (last(&program) / -4.9 - 1.0)
    };
    for (every, sub_steps, expected) in [(1.0, 1, 24.0), (0.25, 1, 96.0), (0.5, 2, 96.0), (2.0, 1, 12.0)] {
        let found = steps(every, sub_steps);
        assert!((found / expected - 1.0).abs() < 1e-3, "{every}: {found} steps, not {expected}");
    }
}

/// Records the substeps that the observer sees.
#[derive(Default)]
struct Shown(Vec<(u32, u32)>);

impl StepObserver for Shown {
    fn substep(&mut self, moment: SubstepIndex, _: &dyn StateView) {
        self.0.push((moment.substep, moment.substeps));
    }
}

#[test]
fn the_evaluations_of_a_frame_are_observed_as_one_frame() {
    let program = falling("start: 1, end: 3, fps: 24, every: 0.5", "subSteps: 2");
    let mut shown = Shown::default();
    Simulation::<f32>::new(&program, 1).advance(&mut shown);
    assert_eq!(shown.0, [(1, 4), (2, 4), (3, 4), (4, 4)]);
}

#[test]
fn evaluations_that_skip_frames_end_at_the_last_frame() {
    let program = falling("start: 1, end: 6, fps: 24, every: 2", "");
    let mut run = Simulation::<f32>::new(&program, 1);
    let mut frames = Vec::new();
    while !run.is_done() {
        assert_eq!(run.next_frame(), run.advance(&mut ()).frame);
        frames.push(run.frame());
    }
    assert_eq!(frames, [3, 5, 6]);
}

// EVIDENCE: N3.1-6  the nucleus solves only when its time advances
#[test]
fn a_nucleus_that_is_off_or_has_no_time_keeps_its_state() {
    let off = falling("start: 1, end: 9, fps: 24", "enable: keys([(1, true), (5, false)])");
    let heights = heights(&off);
    assert!(heights[2] < heights[1] && heights[3] == heights[2] && heights[7] == heights[2], "{heights:?}");
    let text = of_nodes(r#""n": nucleus(), "p": polyPlane(), "c": nCloth(inputMesh: "p")"#, "");
    let (mut scene, _) = read_scene_text(&text, "test.ron".as_ref()).expect("valid");
    let [from, to] = ["time1.outTime", "n.currentTime"].map(|plug| scene.graph.plug(plug).expect("there"));
    assert!(scene.graph.disconnect(from, to));
    let still = compile(&scene).expect("it runs");
    assert!(
        still.warnings().iter().any(|warning| warning.message.contains("nothing is solved")),
        "{:?}",
        still.warnings()
    );
    assert_eq!(last(&still), 0.0);
}

#[test]
fn a_time_of_its_own_drives_a_nucleus() {
    let run = |time: &str| falling("start: 1, end: 13, fps: 24", time);
    let half = run("currentTime: keys([(1, 1), (13, 7)])");
    assert!(half.warnings().is_empty(), "{:?}", half.warnings());
    let (half, whole) = (heights(&half), heights(&run("")));
    // Half of the time in as many steps.
    assert!((half[11] / whole[5] - 1.0).abs() < 0.1, "{} after half of the time, {}", half[11], whole[5]);
    let frozen = run("currentTime: 5");
    assert_eq!(last(&frozen), 0.0);
    assert!(frozen.warnings().iter().any(|warning| warning.message.contains("nothing is solved")));
}

#[test]
fn a_run_that_begins_within_a_time_warp_moves_as_the_time_says() {
    let warp = "currentTime: keys([(1, 1), (25, 13)])";
    let whole = heights(&falling("start: 1, end: 25, fps: 24", warp));
    for start in ["", "startFrame: 1, "] {
        let part = falling("start: 13, end: 25, fps: 24", &format!("{start}{warp}"));
        let part = heights(&part);
        let apart = part.iter().zip(&whole).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(
            part.len() == 12 && apart < 1e-12,
            "{start}: from its initial state it falls as the whole run does"
        );
        assert!(part[0] < 0.0);
    }
    // Its time is 10 at frame 19.
    let later = heights(&falling("start: 13, end: 25, fps: 24", &format!("startFrame: 10, {warp}")));
    assert_eq!(later[5], 0.0, "{later:?}");
    assert!(later[6] < 0.0, "{later:?}");
}

/// The frames of a run and the height of its particle `q` after each.
fn falls(time: &str, nodes: &str) -> Vec<(i64, f64)> {
    let falling = "nParticle(position0: [(0, 9, 0)], drag: 0, nucleus: \"n\")";
    let program = program(&format!("Scene(time: ({time}), nodes: {{{nodes}, \"q\": {falling}}})"));
    let kind = program.objects().iter().find(|object| object.name == "q").map(|object| object.kind);
    let Some(ObjectKind::Cloth(id)) = kind else { panic!("it is an object") };
    let mut run = Simulation::<f32>::new(&program, 1);
    let mut heights = Vec::new();
    while !run.is_done() {
        let frame = run.advance(&mut ()).frame;
        heights.push((frame, run.state().point(id, 0).y));
    }
    heights
}

#[test]
fn a_nucleus_that_starts_later_than_another_one_falls_as_it_does_alone() {
    let other = r#""a": nucleus(), "p": nParticle(position0: [(5, 9, 0)], nucleus: "a")"#;
    for (start, every) in [(5, 1.0), (5, 0.5), (3, 2.0)] {
        let time = format!("start: 1, end: 11, fps: 24, every: {every}");
        let own = format!(r#""n": nucleus(startFrame: {start})"#);
        let found = falls(&time, &format!("{other}, {own}"));
        let (waits, moves) = found.split_at(found.iter().filter(|one| one.0 <= start).count());
        assert!(waits.iter().all(|one| one.1 == 9.0), "{waits:?}");
        assert_eq!(moves, falls(&time, &own), "startFrame {start}, every {every}");
        assert!(moves.len() >= 4 && moves[3].1 < 8.9, "{moves:?}");
    }
}

#[test]
fn a_jump_of_time_beyond_the_limit_is_not_solved() {
    let jump = |limit: u32| {
        program(&of_nodes(
            &format!(
                r#""clock": transform(tx: keys([(1, 1), (4, 4), (5, 9), (24, 28)])),
                   "n": nucleus(airDensity: 0, resistanceModel: classic, frameJumpLimit: {limit}),
                   "p": polyPlane(subdivisions: (1, 1)), "c": nCloth(inputMesh: "p")"#
            ),
            r#"("clock.tx", "n.currentTime")"#,
        ))
    };
    let (strict, loose) = (heights(&jump(1)), heights(&jump(5)));
    assert_eq!(strict[2], loose[2]);
    assert_eq!(strict[3], strict[2], "the jump to frame 9 is not solved");
    assert!(loose[3] < loose[2]);
    assert!(strict[4] < strict[3], "later frames are solved");
}

/// Points of a collider after some frames, in scene units.
fn collider(program: &Program, frames: usize) -> Vec<[f32; 3]> {
    let mut run = Simulation::<f32>::new(program, 1);
    for _ in 0..frames {
        run.advance(&mut ());
    }
    let mut points = Vec::new();
    let is_collider = |kind: &ObjectKind| matches!(kind, ObjectKind::Collider(_));
    let kind = program.objects().iter().map(|object| object.kind).find(is_collider);
    if let Some(ObjectKind::Collider(id)) = kind {
        run.state().collider_positions(id, run.units_per_metre(), &mut points);
    }
    points
}

// EVIDENCE: N2.4-8  a collider that changes its shape has a velocity at each of its points
#[test]
fn the_points_of_a_collider_follow_its_blend() {
    let text = of_nodes(
        r#""n": nucleus(gravity: 0, airDensity: 0),
           "low": polyPlane(width: 4, height: 4, blendTarget: "high", blend: keys([(1, 0), (11, 1)])),
           "high": polyPlane(width: 8, height: 4),
           "floor": nRigid(inputMesh: "low", thickness: 0.1),
           "lift": transform(), "p": polyPlane(translate: (0, 3, 0)), "c": nCloth(inputMesh: "p")"#,
        "",
    );
    let program = program(&text);
    assert_eq!(collider(&program, 0)[0][0], -2.0);
    assert_eq!(collider(&program, 5)[0][0], -3.0);
    assert_eq!(collider(&program, 20)[0][0], -4.0);
}

#[test]
fn a_mesh_can_have_a_file_for_each_frame() {
    let folder = tempfile::tempdir().expect("a folder");
    for frame in 1..=4 {
        let x = frame * frame;
        let text = format!("v {x} 0 0\nv {x} 0 1\nv {x} 1 1\nf 1 2 3\n");
        fs::write(folder.path().join(format!("wall.{frame:04}.obj")), text).expect("written");
    }
    let scene = |end: u32, every: f64| {
        format!(
            r#"Scene(time: (start: 1, end: {end}, fps: 24, every: {every}), nodes: {{
                "n": nucleus(), "p": polyPlane(), "c": nCloth(inputMesh: "p"),
                "wall": mesh(file: "wall.####.obj", ty: 5), "r": nRigid(inputMesh: "wall"),
            }})"#
        )
    };
    let file = folder.path().join("scene.ron");
    let read = |text: &str| read_scene_text(text, &file).expect("it reads").0;
    for every in [1.0, 0.5] {
        let program = compile(&read(&scene(4, every))).expect("all files are there");
        assert_eq!(
            [0, 1, 3].map(|frames| collider(&program, frames)[0]),
            [[1.0, 5.0, 0.0], [4.0, 5.0, 0.0], [16.0, 5.0, 0.0]]
        );
    }
    let missing = compile(&read(&scene(5, 1.0))).map(|_| ()).expect_err("there is no fifth file");
    assert!(missing[0].message.contains("wall.0005.obj"), "{missing:?}");
    fs::write(folder.path().join("wall.0003.obj"), "v 0 0 0\nv 0 0 1\nv 0 1 1\nv 9 9 9\nf 1 2 3\n")
        .expect("written");
    let other = compile(&read(&scene(4, 1.0))).map(|_| ()).expect_err("it has another point");
    assert!(other[0].message.contains("has 3 points at frame 1, but 4 at frame 3"), "{other:?}");
}
