//! Objects that play recorded positions (`playFromCache`), from files of points to the solved scene.

use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};

use nalgebra::Vector3;
use nucleus_core::{ClothId, Particle};
use nucleus_graph::Simulation;
use nucleus_graph::compile::{Program, compile};
use nucleus_graph::scene::read_scene_text;

type Vec3 = Vector3<f64>;

/// A folder of its own for a test.
fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = fs::remove_dir_all(&folder); // of an earlier run
    fs::create_dir_all(&folder).unwrap();
    folder
}

/// Writes the points of a frame.
fn write(folder: &Path, frame: i64, points: &[Vec3]) {
    let mut text = String::new();
    points.iter().for_each(|p| writeln!(text, "v {} {} {}", p.x, p.y, p.z).unwrap());
    fs::write(folder.join(format!("a.{frame:04}.obj")), text).unwrap();
}

/// The program of some nodes over 24 frames, or its errors.
fn compiled(folder: &Path, nodes: &str) -> Result<Program, String> {
    let text = format!("Scene(time: (start: 1, end: 24, fps: 24), nodes: {{{nodes}}})");
    let (scene, _) = read_scene_text(&text, &folder.join("scene.ron")).map_err(|e| format!("{e:?}"))?;
    compile(&scene).map_err(|errors| errors.iter().map(|error| error.message.clone() + "\n").collect())
}

fn points(run: &Simulation<f64>, cloth: u32, count: usize) -> Vec<Vec3> {
    (0..count).map(|point| run.state().point(ClothId(cloth), point)).collect()
}

/// A tray of 3 by 3 points at a height of 1 m, which has moved along x by 5 cm times the square of the time in frames over
/// ten.
fn tray(frame: f64) -> Vec<Vec3> {
    let x = 0.05 * (frame - 1.0).powi(2) / 10.0;
    let point = |k: usize| Vec3::new((k % 3) as f64 - 1.0 + x, 1.0, 1.0 - (k / 3) as f64);
    (0..9).map(point).collect()
}

const TRAY: &str = r#""n": nucleus(airDensity: 0), "t": polyPlane(width: 2, height: 2, subdivisions: (2, 2)),
    "a": nCloth(inputMesh: "t", thickness: 0.02, friction: 2, cacheFile: "a.####.obj", FIELDS)"#;

fn tray_scene(fields: &str) -> String {
    TRAY.replace("FIELDS", fields)
}

#[test]
fn a_cloth_plays_its_recording_and_carries_another() {
    let folder = folder("carries");
    (1..=24).for_each(|frame| write(&folder, frame, &tray(frame as f64)));
    let handkerchief = r#", "q": polyPlane(width: 0.4, height: 0.4, subdivisions: (4, 4), translateY: 1.05),
        "b": nCloth(inputMesh: "q", thickness: 0.02, friction: 2)"#;
    let program = compiled(&folder, &(tray_scene("playFromCache: true") + handkerchief)).unwrap();
    let mut run = Simulation::<f64>::new(&program, 1);
    let [tray_id, cloth_id] = ["a", "b"]
        .map(|name| program.objects().iter().position(|object| object.name == name).unwrap() as u32);
    for frame in 2..=16 {
        let report = run.advance(&mut ()).report;
        assert_eq!(report.pairs_unresolved, 0);
        for (ours, recorded) in points(&run, tray_id, 9).iter().zip(tray(frame as f64)) {
            assert!((ours - recorded).norm() < 1e-9, "frame {frame}: {ours:?}, {recorded:?}");
        }
    }
    let cloth = points(&run, cloth_id, 25);
    assert!(cloth.iter().all(|p| (p.y - 1.04).abs() < 0.01), "it lies on the tray: {cloth:?}");
    let way = cloth.iter().map(|p| p.x).sum::<f64>() / 25.0;
    assert!((way - 1.125).abs() < 0.1, "it went along by {way} of 1.125");
}

#[test]
fn a_cloth_is_solved_on_with_its_velocity_where_the_recording_ends() {
    let folder = folder("solved_on");
    // 0.24 m/s.
    let at = |frame: i64| -> Vec<Vec3> {
        tray(1.0).iter().map(|p| p + Vec3::x() * 0.01 * (frame - 1) as f64).collect()
    };
    (1..=6).for_each(|frame| write(&folder, frame, &at(frame)));
    let fields = "playFromCache: keys([(1, true), (7, false)])";
    let program = compiled(&folder, &tray_scene(fields).replace("nucleus(", "nucleus(gravity: 0, ")).unwrap();
    let mut run = Simulation::<f64>::new(&program, 1);
    (2..=12).for_each(|_| _ = run.advance(&mut ()));
    for (ours, expected) in points(&run, 0, 9).iter().zip(at(12)) {
        assert!((ours - expected).norm() < 1e-6, "{ours:?}, {expected:?}");
    }
}

#[test]
fn a_fall_goes_on_as_if_it_had_never_been_played() {
    for (name, nucleus) in
        [("physical", "nucleus("), ("classic", "nucleus(subSteps: 2, resistanceModel: classic, ")]
    {
        let folder = folder(&format!("falls_on_{name}"));
        let scene = |fields: &str| tray_scene(fields).replace("nucleus(", nucleus);
        let mut solved =
            Simulation::<f64>::new(&compiled(&folder, &scene("playFromCache: false")).unwrap(), 1);
        write(&folder, 1, &points(&solved, 0, 9));
        for frame in 2..=12 {
            solved.advance(&mut ());
            if frame <= 6 {
                write(&folder, frame, &points(&solved, 0, 9));
            }
        }
        let program = compiled(&folder, &scene("playFromCache: keys([(1, true), (7, false)])")).unwrap();
        let mut run = Simulation::<f64>::new(&program, 1);
        (2..=12).for_each(|_| _ = run.advance(&mut ()));
        // A velocity that is half a frame old would be 0.05 m off.
        for (ours, expected) in points(&run, 0, 9).iter().zip(points(&solved, 0, 9)) {
            assert!((ours - expected).norm() < 1e-5, "{name}: {ours:?}, {expected:?}");
        }
    }
}

#[test]
fn particles_are_born_as_recorded_and_move_as_recorded() {
    let folder = folder("born");
    let at = |frame: i64| -> Vec<Vec3> {
        (0..frame / 3).map(|k| Vec3::new(k as f64, 0.1 * frame as f64, 0.0)).collect()
    };
    (1..=24).for_each(|frame| write(&folder, frame, &at(frame)));
    // The emitter is silent and the box stays empty while the recording is played.
    let nodes = r#""n": nucleus(usePlane: true, planeOrigin: (0, 1, 0)), "e": pointEmitter(target: "a", rate: 500),
        "a": nParticle(cacheFile: "a.####.obj", playFromCache: true, lifespanMode: constant, lifespan: 0.1,
            minimumCorner: (5, 5, 5), maximumCorner: (6, 6, 6), radius: 0.1)"#;
    let program = compiled(&folder, nodes).unwrap();
    let mut run = Simulation::<f64>::new(&program, 1);
    let mut ages: Vec<Particle> = Vec::new();
    for frame in 2..=24 {
        let report = run.advance(&mut ()).report;
        assert_eq!((report.births_refused, report.deaths), (0, 0));
        run.state().particles(ClothId(0), &mut ages);
        let recorded = at(frame);
        assert_eq!(ages.len(), recorded.len(), "frame {frame}");
        for (ours, recorded) in points(&run, 0, recorded.len()).iter().zip(&recorded) {
            assert!((ours - recorded).norm() < 1e-9, "frame {frame}: {ours:?}, {recorded:?}");
        }
    }
}

#[test]
fn a_missing_cache_is_an_error_that_names_file_and_object() {
    let folder = folder("missing");
    (1..=24).filter(|frame| *frame != 7).for_each(|frame| write(&folder, frame, &tray(frame as f64)));
    let errors = |nodes: &str| compiled(&folder, nodes).unwrap_err();
    let gap = errors(&tray_scene("playFromCache: true"));
    assert!(gap.contains("a.0007.obj"), "{gap}");
    let none = errors(&tray_scene("playFromCache: true").replace("cacheFile: \"a.####.obj\",", ""));
    assert!(none.contains("`a` plays a cache, but has no `cacheFile`"), "{none}");
    let single = errors(&tray_scene("playFromCache: true").replace("####", "0001"));
    assert!(single.contains("no `####` in place of the frame"), "{single}");
    write(&folder, 7, &tray(7.0)[..8]);
    let shorter = errors(&tray_scene("playFromCache: true"));
    assert!(shorter.contains("8 points at frame 7, but `t` has 9"), "{shorter}");
    let dead = errors(r#""n": nucleus(), "a": nParticle(cacheFile: "a.####.obj", playFromCache: true)"#);
    assert!(dead.contains("8 particles at frame 7 after 9: deaths are not played"), "{dead}");
    // Where it is off, no file is read.
    assert!(compiled(&folder, &tray_scene("playFromCache: false")).is_ok());
}
