//! A cache holds the states of the solver, with equal bytes on any number of threads.

use std::path::Path;

use nucleus_cache::Detail;
use nucleus_core::{ClothId, ColliderId};
use nucleus_graph::compile::{Program, compile};
use nucleus_tests::gallery::{program_of, program_of_text, scene};
use nucleus_tests::{Recording, record};

/// A sheet of 2 601 points that falls on a rising ball, with four substeps. Threads share the points.
fn drape() -> Program {
    program_of(
        r#""nucleus1": nucleus(spaceScale: 0.01, subSteps: 4, windSpeed: 2, usePlane: true),
           "sheet": polyPlane(width: 100, height: 100, subdivisions: (50, 50), translate: (0, 32, 0)),
           "cloth": nCloth(inputMesh: "sheet", pointMass: 0.2, bendResistance: 0.5, thickness: 0.5),
           "sphere": polySphere(radius: 20, translateY: keys([(1, 10), (12, 20)])),
           "ball": nRigid(inputMesh: "sphere")"#,
    )
}

#[test]
fn the_same_scene_gives_the_same_bytes_every_time() {
    let program = drape();
    let [first, second] = [1, 2].map(|_| record(&program, 12, 1, Detail::Frames).cache);
    assert!(first == second);
}

#[test]
fn one_two_and_three_threads_give_the_same_bytes() {
    let program = drape();
    let recordings = [1, 2, 3].map(|threads| record(&program, 12, threads, Detail::Frames));
    let contacts: u64 = recordings[0].reports.iter().map(|report| report.contacts).sum();
    assert!(contacts > 0, "there were no contacts, so the test shows little");
    assert!(recordings.iter().all(|recording| recording.cache == recordings[0].cache));
}

#[test]
fn the_positions_in_the_cache_are_those_of_the_solver() {
    let recording = record(&drape(), 12, 1, Detail::Frames);
    let (state, units) = (recording.simulation.state(), recording.simulation.units_per_metre());
    let (mut cloth, mut ball) = (Vec::new(), Vec::new());
    state.positions(ClothId(0), units, &mut cloth);
    state.collider_positions(ColliderId(0), units, &mut ball);
    let mut cache = recording.play();
    let last = cache.time_samples().len() - 1;
    assert_eq!(last, 12);
    let names: Vec<String> = cache.objects().iter().map(|object| object.name.clone()).collect();
    for (name, expected) in [("cloth", cloth), ("ball", ball)] {
        let object = names.iter().position(|found| found == name).expect(name);
        assert_eq!(cache.positions(object, last).expect("it was recorded"), expected, "{name}");
    }
}

#[test]
fn a_cache_of_substeps_holds_every_substep() {
    let recording = record(&drape(), 3, 1, Detail::Substeps);
    let cache = recording.play();
    let moments: Vec<_> = cache.time_samples().iter().map(|moment| (moment.frame, moment.substep)).collect();
    let expected = (2..=4).flat_map(|frame| (1..=4).map(move |substep| (frame, substep)));
    assert_eq!(moments, [(1, 0)].into_iter().chain(expected).collect::<Vec<_>>());
}

// EVIDENCE: N2.4-6, N2.4-7  a collider that turns by 90 degrees in a frame moves along the chord, not the arc
#[test]
fn within_a_frame_a_collider_moves_along_straight_lines() {
    let program = program_of(
        r#""nucleus1": nucleus(subSteps: 2),
           "cube": polyCube(rotateY: keys([(1, 0), (2, 90)])), "wall": nRigid(inputMesh: "cube"),
           "sheet": polyPlane(translate: (0, 9, 0)), "cloth": nCloth(inputMesh: "sheet")"#,
    );
    let recording = record(&program, 1, 1, Detail::Substeps);
    let mut cache = recording.play();
    let wall = cache.objects().iter().position(|object| object.name == "wall").expect("it is there");
    let [start, middle, end] =
        [0, 1, 2].map(|moment| cache.positions(wall, moment).expect("it was recorded"));
    for ((a, b), m) in start.iter().zip(&end).zip(&middle) {
        for axis in 0..3 {
            assert!((f64::from(a[axis]) / 2.0 + f64::from(b[axis]) / 2.0 - f64::from(m[axis])).abs() < 1e-6);
        }
    }
    let radius = |point: &[f32; 3]| point[0].hypot(point[2]);
    assert!(radius(&middle[0]) < 0.75 * radius(&start[0]), "an arc would keep the distance from the axis");
}

/// The height of the first point of an object at each recorded time, beside its frame.
fn heights(recording: &Recording, name: &str) -> Vec<(i32, f32)> {
    let mut cache = recording.play();
    let object = cache.objects().iter().position(|object| object.name == name).expect(name);
    let frames: Vec<i32> = cache.time_samples().iter().map(|sample| sample.frame).collect();
    let height = |sample| cache.positions(object, sample).expect("it was recorded")[0][1];
    frames.into_iter().zip((0..).map(height)).collect()
}

#[test]
fn a_collider_is_recorded_where_its_keys_put_it_while_its_nucleus_is_not_solved() {
    let others = [
        "enable: keys([(1, true), (10, false), (20, true)])",
        "enable: keys([(1, false), (20, true)])",
        "enable: false",
        "startFrame: 10",
        "currentTime: keys([(1, 1), (10, 10), (15, 10), (25, 20)])",
        "timeScale: 0.5",
    ];
    for other in others {
        // All nuclei have the same moving mesh; the first is always solved.
        let text = |every: f64, first: &str| {
            format!(
                r#"Scene(time: (start: 1, end: 24, fps: 24, every: {every}), nodes: {{
                    "s": polyPlane(width: 1, height: 1, translateY: keys([(1, -2), (5, -1), (15, -3), (18, -1)])),
                    {first}
                    "n2": nucleus(subSteps: 2, {other}), "own": nRigid(inputMesh: "s", nucleus: "n2"),
                    "p2": nParticle(position0: [(5, 5, 5)], nucleus: "n2"),
                }})"#
            )
        };
        let first = r#""n1": nucleus(subSteps: 3), "always": nRigid(inputMesh: "s", nucleus: "n1"),
            "p1": nParticle(position0: [(5, 9, 5)], nucleus: "n1"),"#;
        for (every, detail) in
            [(1.0, Detail::Frames), (1.0, Detail::Every(4)), (0.5, Detail::Frames), (1.0, Detail::Substeps)]
        {
            // It may begin later than the scene, which is a warning.
            let alone = compile(&scene(&text(every, ""), Path::new("test.ron"))).expect("a valid scene");
            let both = program_of_text(&text(every, first));
            let [alone, both] = [alone, both].map(|program| record(&program, 23, 1, detail));
            let expected = heights(&both, "always");
            let own = heights(&both, "own");
            assert_eq!(own.len(), expected.len());
            for ((frame, height), (_, keyed)) in own.iter().zip(&expected) {
                assert!(
                    (height - keyed).abs() < 1e-5,
                    "{other}, {detail:?}: {height}, not {keyed}, at {frame}"
                );
            }
            for frame in [2, 9, 10, 12, 15, 19, 20, 24] {
                let ends = |all: &[(i32, f32)]| all.iter().rev().find(|one| one.0 == frame).map(|one| one.1);
                if let (Some(height), Some(keyed)) = (ends(&heights(&alone, "own")), ends(&expected)) {
                    let case = format!("{other}, {detail:?}, every {every}");
                    assert!((height - keyed).abs() < 1e-5, "{case}: {height}, not {keyed}, at {frame}");
                }
            }
        }
    }
}
