//! `nucleus run --from`.

use std::fs;
use std::path::Path;

use nucleus_cache::Playback;

use crate::sample::{assert_refused, folder, nucleus, scene, stderr};

fn run(folder: &Path, arguments: &[&str]) -> std::process::Output {
    nucleus(folder, &[&["run", "drape.ron", "--threads", "1"], arguments].concat())
}

/// Positions and velocities of the cloth at the end of a frame.
fn state(folder: &Path, cache: &str, frame: i32) -> (Vec<[f32; 3]>, Option<Vec<[f32; 3]>>) {
    let mut cache = Playback::open(folder.join(cache)).unwrap();
    let moment = cache.end_of(frame).unwrap();
    (cache.positions(0, moment).unwrap(), cache.velocities(0, moment).unwrap())
}

fn farthest(a: &[[f32; 3]], b: &[[f32; 3]]) -> f32 {
    let apart = |(a, b): (&[f32; 3], &[f32; 3])| (0..3).map(|k| (a[k] - b[k]).abs()).fold(0.0, f32::max);
    a.iter().zip(b).map(apart).fold(0.0, f32::max)
}

#[test]
fn a_run_from_a_frame_of_a_cache_continues_its_motion() {
    let folder = folder();
    scene(folder.path(), 9, "");
    assert_eq!(run(folder.path(), &["--velocities", "-o", "whole.mcap"]).status.code(), Some(0));
    let at = |frame| state(folder.path(), "whole.mcap", frame);
    for start in ["2", "5"] {
        let (from, frames) = (format!("whole.mcap@{start}"), format!("{start}..9"));
        let output = run(
            folder.path(),
            &["--velocities", "--from", &from, "--frames", &frames, "--force", "-o", "rest.mcap"],
        );
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        assert!(!stderr(&output).contains("velocities"), "{}", stderr(&output));
        let start = start.parse().unwrap();
        let again = |frame| state(folder.path(), "rest.mcap", frame);
        assert_eq!(again(start), at(start));
        if start == 2 {
            // The sheet still falls freely. A cache rounds 25 cm to 2e-6 cm; the fall per frame is a thousand times that.
            assert!(farthest(&again(3).0, &at(3).0) < 1e-5);
            assert!(farthest(&at(3).0, &at(2).0) > 1e-2);
        } else {
            // The sheet lies on the ball. A run from a cache finds its contacts anew, so it settles slightly differently.
            let apart = farthest(&again(9).0, &at(9).0);
            assert!(apart < 0.1 * farthest(&at(9).0, &at(5).0), "{apart}");
        }
    }
    let stated = Playback::open(folder.path().join("rest.mcap")).unwrap().run().extra["from"].clone();
    assert_eq!(stated, "whole.mcap@5");
}

#[test]
fn a_run_from_a_frame_of_a_cache_continues_its_motion_under_a_time_warp() {
    let folder = folder();
    let text = r#"Scene(time: (start: 1, end: 25, fps: 24), nodes: {
        "n": nucleus(currentTime: keys([(1, 1), (25, 13)])),
        "m": polyPlane(width: 1, height: 1, subdivisions: (2, 2)), "c": nCloth(inputMesh: "m", drag: 0, lift: 0),
    })"#;
    fs::write(folder.path().join("drape.ron"), text).unwrap();
    assert_eq!(run(folder.path(), &["--velocities", "-o", "whole.mcap"]).status.code(), Some(0));
    let arguments = ["--from", "whole.mcap@13", "--frames", "13..25", "-o", "rest.mcap"];
    assert_eq!(run(folder.path(), &arguments).status.code(), Some(0));
    let [rest, whole] = ["rest.mcap", "whole.mcap"].map(|cache| state(folder.path(), cache, 25).0);
    let apart = farthest(&rest, &whole);
    assert!(apart < 1e-4, "{apart} after a fall to {}", whole[0][1]);
}

#[test]
fn velocities_that_were_not_recorded_are_estimated_with_a_warning() {
    let folder = folder();
    scene(folder.path(), 5, "");
    run(folder.path(), &["-o", "whole.mcap"]);
    let output =
        run(folder.path(), &["--velocities", "--from", "whole.mcap", "--frames", "2", "-o", "rest.mcap"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert!(stderr(&output).contains("`whole.mcap` has no velocities"), "{}", stderr(&output));
    let ((before, _), (last, _)) =
        (state(folder.path(), "whole.mcap", 4), state(folder.path(), "whole.mcap", 5));
    let (start, fast) = state(folder.path(), "rest.mcap", 1);
    assert_eq!(start, last);
    let expected =
        last.iter().zip(&before).map(|(now, before)| [0, 1, 2].map(|k| (now[k] - before[k]) * 24.0));
    assert!(farthest(&fast.unwrap(), &expected.collect::<Vec<_>>()) < 1e-2);
}

/// Writes a scene of five frames with these nodes.
fn particles(folder: &Path, nodes: &str) {
    let text = format!("Scene(time: (start: 1, end: 5, fps: 24), nodes: {{ \"n\": nucleus(), {nodes} }})");
    fs::write(folder.join("drape.ron"), text).unwrap();
}

#[test]
fn particles_of_a_cache_replace_those_that_fill_a_box_or_a_mesh() {
    let folder = folder();
    let of_box = "minimumCorner: (-0.1, 0, -0.1), maximumCorner: (0.1, 0.2, 0.1)";
    for fill in [of_box, r#"fillMesh: "ball""#] {
        let ball = r#""ball": polySphere(radius: 0.15)"#;
        particles(folder.path(), &format!(r#"{ball}, "p": nParticle({fill}, radius: 0.05)"#));
        run(folder.path(), &["--velocities", "-o", "whole.mcap", "--force"]);
        let output =
            run(folder.path(), &["--from", "whole.mcap@5", "--frames", "1", "-o", "rest.mcap", "--force"]);
        assert_eq!(
            (output.status.code(), stderr(&output).contains("ages")),
            (Some(0), false),
            "{}",
            stderr(&output)
        );
        assert_eq!(state(folder.path(), "rest.mcap", 1).0, state(folder.path(), "whole.mcap", 5).0, "{fill}");
    }
}

/// Writes a scene whose particles live for half a second, of a steady rate of 48 per second.
fn fountain(folder: &Path, lifespan: &str) {
    let text = format!(
        r#"Scene(time: (start: 1, end: 30, fps: 24), nodes: {{
            "n": nucleus(), "p": nParticle(radius: 0.01, {lifespan}),
            "e": pointEmitter(target: "p", emitterType: directional, rate: 48, speed: 4),
        }})"#
    );
    fs::write(folder.join("drape.ron"), text).unwrap();
}

/// The particles of the first object at the end of a frame.
fn living(folder: &Path, cache: &str, frame: i32) -> Vec<nucleus_core::Particle> {
    let mut cache = Playback::open(folder.join(cache)).unwrap();
    let moment = cache.end_of(frame).unwrap();
    cache.particles(0, moment).unwrap().unwrap()
}

#[test]
fn particles_of_a_cache_keep_their_ages_and_numbers() {
    let folder = folder();
    fountain(folder.path(), "lifespanMode: constant, lifespan: 0.5");
    run(folder.path(), &["--velocities", "-o", "whole.mcap"]);
    let from = ["--from", "whole.mcap@20", "--frames", "20..30", "-o", "rest.mcap"];
    let output = run(folder.path(), &from);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert!(!stderr(&output).contains("warning"), "{}", stderr(&output));
    assert_eq!(living(folder.path(), "rest.mcap", 20), living(folder.path(), "whole.mcap", 20));
    let [rest, whole] = ["rest.mcap", "whole.mcap"].map(|cache| living(folder.path(), cache, 30));
    // A rate of 48 for half a second; one more where the last of them is just about to die.
    let is_steady = |living: usize| living == 24 || living == 25;
    assert!(is_steady(whole.len()) && is_steady(rest.len()), "{} and {}", whole.len(), rest.len());
    let mut numbers: Vec<u64> = rest.iter().map(|particle| particle.id).collect();
    numbers.sort_unstable();
    numbers.dedup();
    assert_eq!(numbers.len(), rest.len(), "{numbers:?}");
}

#[test]
fn only_lifespans_that_are_drawn_anew_are_warned_of() {
    let folder = folder();
    for (lifespan, is_warned) in [
        ("lifespanMode: randomRange, lifespan: 0.5, lifespanRandom: 0.1", true),
        ("lifespanMode: constant, lifespan: 0.5", false),
        ("drag: 0", false),
    ] {
        fountain(folder.path(), lifespan);
        run(folder.path(), &["--velocities", "-o", "whole.mcap", "--frames", "9", "--force"]);
        let output = run(folder.path(), &["--from", "whole.mcap@9", "--force", "-o", "rest.mcap"]);
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        let said = stderr(&output);
        assert_eq!(said.contains("the particles of `p` at the start are drawn anew"), is_warned, "{said}");
    }
}

#[test]
fn a_run_from_a_cache_names_the_state_that_begins_anew() {
    let folder = folder();
    let bead = |name: &str, x: i32| format!(r#""{name}": nParticle(position0: [({x}, 0, 0)]), "#);
    let link = |more: &str| {
        format!(
            r#""k": dynamicConstraint(constraintType: pointToPoint, components: ["a", "b"], {more}),
            "s": polyPlane(), "c": nCloth(inputMesh: "s"#
        )
    };
    let said = |constraint: &str, cloth: &str| {
        let nodes = [bead("a", 0), bead("b", 1), link(constraint), format!(r#"", {cloth}"#)].concat() + ")";
        particles(folder.path(), &nodes);
        run(folder.path(), &["--velocities", "-o", "whole.mcap", "--force"]);
        let output = run(folder.path(), &["--from", "whole.mcap", "--force", "-o", "rest.mcap"]);
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        stderr(&output)
    };
    let lost = said("glueStrength: 0.5", "restitutionTension: 5, pressureMethod: volumeTrackingModel");
    for part in [
        "broken links of `k` hold again",
        "rest lengths of `k` are measured at the first frame",
        "`c` has no plastic deformation",
        "`c` has the gas of its start state",
    ] {
        assert!(lost.contains(part), "{lost}");
    }
    assert!(!said("restLengthMethod: constant, restLength: 1", "").contains("begin anew"));
}

#[test]
fn the_phase_of_an_emitter_is_named_among_the_state_that_begins_anew() {
    let folder = folder();
    let said = |rate: u32| {
        particles(
            folder.path(),
            &format!(r#""e": pointEmitter(target: "p", rate: {rate}), "p": nParticle()"#),
        );
        run(folder.path(), &["-o", "whole.mcap", "--force"]);
        stderr(&run(folder.path(), &["--from", "whole.mcap", "--force", "-o", "rest.mcap"]))
    };
    let warned = said(37);
    assert!(warned.contains("the time to the next birth from `e` counts from the start"), "{warned}");
    // A whole number per frame: none is due within a frame.
    assert!(!said(48).contains("begin anew"));
}

#[test]
fn a_surface_that_can_tear_starts_from_its_own_cache() {
    let folder = folder();
    let text = r#"Scene(time: (start: 1, end: 9, fps: 24), nodes: {
        "n": nucleus(), "m": polyPlane(width: 1, height: 1, subdivisions: (4, 4)),
        "c": nCloth(inputMesh: "m", thickness: 0.005, selfCollide: false),
        "q": dynamicConstraint(constraintType: tearableSurface, components: ["c"], glueStrength: 0.5)})"#;
    fs::write(folder.path().join("drape.ron"), text).unwrap();
    assert_eq!(run(folder.path(), &["--velocities", "-o", "whole.mcap"]).status.code(), Some(0));
    let from = ["--velocities", "--from", "whole.mcap@5", "--frames", "5..9", "-o", "rest.mcap"];
    let output = run(folder.path(), &from);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert!(stderr(&output).contains("broken links of `q` hold again"), "{}", stderr(&output));
    let [whole, rest] =
        ["whole.mcap", "rest.mcap"].map(|cache| [5, 9].map(|frame| state(folder.path(), cache, frame).0));
    assert_eq!(rest[0].len(), 64);
    assert!(farthest(&whole[0], &rest[0]) < 1e-6 && farthest(&whole[1], &rest[1]) < 1e-3);
}

#[test]
fn velocities_of_a_cache_are_converted_to_the_time_of_the_nucleus() {
    let folder = folder();
    let text = r#"Scene(time: (start: 1, end: 9, fps: 24), nodes: {
        "n": nucleus(gravity: 0, timeScale: 0.25),
        "p": nParticle(position0: [(0, 0, 0)], velocity0: [(1, 0, 0)], drag: 0)})"#;
    fs::write(folder.path().join("drape.ron"), text).unwrap();
    for velocities in [&["--velocities"][..], &[]] {
        run(folder.path(), &[&["-o", "whole.mcap", "--force"], velocities].concat());
        let from =
            ["--velocities", "--from", "whole.mcap@5", "--frames", "5..9", "--force", "-o", "rest.mcap"];
        assert_eq!(run(folder.path(), &from).status.code(), Some(0));
        for frame in [5, 9] {
            let (place, velocity) = state(folder.path(), "rest.mcap", frame);
            let expected = 0.25 * (frame - 1) as f32 / 24.0;
            assert!((place[0][0] - expected).abs() < 1e-5, "{place:?}, not {expected}");
            assert!((velocity.unwrap()[0][0] - 0.25).abs() < 1e-5);
        }
    }
}

#[test]
fn velocities_of_a_cache_are_those_of_its_own_time_in_a_scene_of_another() {
    let folder = folder();
    let scene = |rate: f64| {
        format!(
            r#"Scene(time: (start: 1, end: 9, fps: 24), nodes: {{
            "n": nucleus(gravity: 0, timeScale: {rate}),
            "p": nParticle(position0: [(0, 0, 0)], velocity0: [(1, 0, 0)], drag: 0)}})"#
        )
    };
    for [recorded, continued] in [[1.0, 0.5], [0.5, 1.0]] {
        for velocities in [&["--velocities"][..], &[]] {
            fs::write(folder.path().join("drape.ron"), scene(recorded)).unwrap();
            run(folder.path(), &[&["-o", "whole.mcap", "--force"], velocities].concat());
            fs::write(folder.path().join("drape.ron"), scene(continued)).unwrap();
            let from = ["--from", "whole.mcap@5", "--frames", "5..9", "--force", "-o", "rest.mcap"];
            assert_eq!(run(folder.path(), &from).status.code(), Some(0));
            // At 1 m/s of its own time.
            let expected = (4.0 * recorded + 4.0 * continued) / 24.0;
            let (place, _) = state(folder.path(), "rest.mcap", 9);
            assert!((f64::from(place[0][0]) - expected).abs() < 1e-5, "{place:?}, not {expected}");
        }
    }
}

#[test]
fn an_initial_state_is_converted_between_space_scales() {
    let folder = folder();
    scene(folder.path(), 4, "");
    run(folder.path(), &["-o", "whole.mcap"]);
    let text = fs::read_to_string(folder.path().join("drape.ron")).unwrap();
    let other_unit = text.replace("spaceScale: 0.01", "spaceScale: 0.02");
    let halves = [("width: 50, height: 50", "width: 25, height: 25"), ("(0, 25, 0)", "(0, 12.5, 0)")];
    let converted = halves.iter().fold(other_unit, |text, (from, to)| text.replace(from, to));
    fs::write(folder.path().join("drape.ron"), converted).unwrap();
    let output = run(folder.path(), &["--from", "whole.mcap@4", "--frames", "1", "-o", "rest.mcap"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let ((now, _), (then, _)) = (state(folder.path(), "rest.mcap", 1), state(folder.path(), "whole.mcap", 4));
    let halved: Vec<[f32; 3]> = then.iter().map(|p| p.map(|x| x / 2.0)).collect();
    assert!(farthest(&now, &halved) < 1e-5);
}

#[test]
fn an_initial_state_in_another_unit_than_an_unchanged_mesh_is_refused() {
    let folder = folder();
    scene(folder.path(), 4, "");
    run(folder.path(), &["-o", "whole.mcap"]);
    let text = fs::read_to_string(folder.path().join("drape.ron")).unwrap();
    fs::write(folder.path().join("drape.ron"), text.replace("spaceScale: 0.01", "spaceScale: 1")).unwrap();
    let output = run(folder.path(), &["--from", "whole.mcap@4", "--frames", "1", "-o", "rest.mcap"]);
    assert_refused(
        &output,
        "the unit of length has changed, and `cloth1` has not: `whole.mcap` has 100 units per metre, and the scene 1, so in \
         metres the mesh is 100 times as large in the scene; give the scene the `spaceScale` 0.01 of the cache",
    );
}

#[test]
fn a_cache_that_does_not_match_the_scene_is_refused_with_the_reason() {
    let folder = folder();
    scene(folder.path(), 5, "");
    run(folder.path(), &["-o", "whole.mcap"]);
    let text = fs::read_to_string(folder.path().join("drape.ron")).unwrap();
    let changed = |from: &str, to: &str| {
        fs::write(folder.path().join("drape.ron"), text.replace(from, to)).unwrap();
        run(folder.path(), &["--from", "whole.mcap@5"])
    };
    assert_refused(
        &changed("cloth1", "curtain"),
        "`whole.mcap` has no cloth `curtain`: its cloth is `cloth1`, recorded from `drape.ron`",
    );
    assert_refused(
        &changed("(6, 6)", "(6, 7)"),
        "the mesh of `cloth1` has changed: it has 56 points, but 49 in `whole.mcap`",
    );
    assert_refused(
        &changed(
            "cloth1\": nCloth(inputMesh: \"sheet\", thickness: 1)",
            "cloth1\": nRigid(inputMesh: \"sheet\")",
        ),
        "the scene has no cloth that could start from a cache",
    );
    fs::write(folder.path().join("drape.ron"), &text).unwrap();
    assert_refused(
        &run(folder.path(), &["--from", "whole.mcap@80"]),
        "there is no frame 80; the cache has 1 to 5",
    );
    assert_refused(&run(folder.path(), &["--from", "none.mcap@3"]), "none.mcap");
    assert_refused(&run(folder.path(), &["--from", "whole.mcap@x"]), "write a cache and a frame of it");
    assert!(!folder.path().join("drape.mcap").exists(), "nothing is recorded");
}

#[test]
fn a_mesh_with_other_faces_and_equal_points_is_refused() {
    let folder = folder();
    let obj = |name: &str, faces: &str| {
        let points = "v 0 1 0\nv 1 1 0\nv 1 1 1\nv 0 1 1\n";
        fs::write(folder.path().join(name), format!("{points}{faces}")).unwrap();
    };
    obj("m.obj", "f 1 2 3 4\n");
    let text = r#"Scene(time: (start: 1, end: 3, fps: 24), nodes: {
        "n": nucleus(), "m": mesh(file: "m.obj"), "c": nCloth(inputMesh: "m")})"#;
    fs::write(folder.path().join("drape.ron"), text).unwrap();
    run(folder.path(), &["-o", "whole.mcap"]);
    obj("m.obj", "f 1 2 3\nf 1 3 4\n");
    assert_refused(
        &run(folder.path(), &["--from", "whole.mcap@2"]),
        "the mesh of `c` has changed: its faces differ from those in `whole.mcap`",
    );
}

#[test]
fn a_cache_that_is_cut_off_serves_up_to_its_last_complete_frame() {
    let folder = folder();
    scene(folder.path(), 12, "");
    run(folder.path(), &["-o", "whole.mcap", "--checkpoint", "0"]);
    let bytes = fs::read(folder.path().join("whole.mcap")).unwrap();
    let last_frame = bytes.len() / 2;
    fs::write(folder.path().join("cut.mcap"), &bytes[..last_frame]).unwrap();
    let output = run(folder.path(), &["--from", "cut.mcap@12"]);
    assert_refused(&output, "there is no frame 12; the cache has 1 to ");
    assert_eq!(run(folder.path(), &["--from", "cut.mcap@2", "-o", "rest.mcap"]).status.code(), Some(0));
    fs::write(folder.path().join("stub.mcap"), &bytes[..40]).unwrap();
    assert_refused(&run(folder.path(), &["--from", "stub.mcap@2"]), "cannot open `stub.mcap`");
}
