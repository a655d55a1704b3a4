//! Emission from curves and surfaces, and rate maps.

use std::fs;
use std::path::Path;

use nucleus_core::Birth;
use nucleus_graph::compile::compile;
use nucleus_graph::scene::read_scene_text;

use super::scenes::{of_nodes, png, program};

/// Births of the first frame, in scene units.
fn births(emitter: &str) -> Vec<Birth> {
    let nodes = format!(r#""n": nucleus(), "q": nParticle(), "e": pointEmitter(target: "q", {emitter})"#);
    program(&of_nodes(&nodes, "")).first_input().births
}

#[test]
fn a_curve_emits_evenly_along_its_length_and_across_it() {
    let born = births(
        "emitterType: curve, curvePoints: [(0, 0, 0), (3, 0, 0), (3, 1, 0)], rate: 2400, normalSpeed: 3",
    );
    // 2400 per unit of length and second, 4 units, 1/24 s.
    assert_eq!(born.len(), 400);
    let mut on_first = 0;
    for birth in &born {
        let (place, fast) = (birth.position, birth.velocity);
        let is_first = place.y == 0.0;
        on_first += usize::from(is_first);
        let across = if is_first { fast.x } else { fast.y };
        assert!(place.z == 0.0 && (is_first || place.x == 3.0), "{place}");
        assert!(across.abs() < 1e-9 && (fast.norm() - 3.0).abs() < 1e-9, "{fast}");
    }
    // Three quarters of the length, give or take three standard deviations of a binomial.
    assert!((274..=326).contains(&on_first), "{on_first}");
}

#[test]
fn a_curve_without_length_is_an_error_that_names_the_fix() {
    let nodes = r#""n": nucleus(), "q": nParticle(), "e": pointEmitter(target: "q", emitterType: curve)"#;
    let (scene, _) = read_scene_text(&of_nodes(nodes, ""), Path::new("test.ron")).expect("it can be read");
    let found = compile(&scene).expect_err("it is refused");
    let message = "`e` emits from a curve, and its `curvePoints` have no length";
    assert!(found.iter().any(|found| found.message == message), "{found:?}");
}

#[test]
fn the_rate_follows_the_speed_of_the_emitter() {
    let still = births("emitterType: omni, rate: 24, scaleRateBySpeed: true");
    let moving = births(
        "emitterType: omni, rate: 24, scaleRateBySpeed: true, translate: keys([(1, (0, 0, 0)), (11, (10, 0, 0))])",
    );
    // One unit a frame is 24 units a second.
    assert_eq!([still.len(), moving.len()], [0, 24]);
}

#[test]
fn a_rate_map_emits_where_the_texture_is_white_or_dark() {
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("rate.png"), png(2, &[0, 255])).expect("written");
    let mean = |dark: bool| {
        let nodes = format!(
            r#""n": nucleus(), "q": nParticle(), "p": polyPlane(width: 2, height: 2, subdivisions: (16, 1)),
            "e": pointEmitter(target: "q", emitterType: surface, parent: "p", rate: 6000, enableTextureRate: true,
            emitFromDark: {dark}, rateMap: texture("rate.png"))"#
        );
        let (scene, _) =
            read_scene_text(&of_nodes(&nodes, ""), &folder.path().join("scene.ron")).expect("it can be read");
        let program = compile(&scene).unwrap_or_else(|found| panic!("{found:?}"));
        let born = program.first_input().births;
        // Half of the thousand, give or take four standard deviations.
        assert!((437..=563).contains(&born.len()), "{}", born.len());
        born.iter().map(|birth| birth.position.x).sum::<f64>() / born.len() as f64
    };
    // Pixel centres are at -1/2 and 1/2: the rate is 0 up to the first, x + 1/2 between them, and 1 beyond. The integral of x
    // over it is 1/12 + 3/8, and that of 1 is 1.
    for (dark, middle) in [(false, 11.0 / 24.0), (true, -11.0 / 24.0)] {
        assert!((mean(dark) - middle).abs() < 0.1, "{dark}: {} for {middle}", mean(dark));
    }
}

#[test]
fn a_rate_map_is_read_between_the_points_of_the_mesh() {
    let folder = tempfile::tempdir().expect("a folder");
    // A white disc of radius 0.25 in the middle, so all corners of a plane are black.
    let size = 128;
    let is_white = |k: i32| {
        let [x, y] = [k % size, k / size].map(|at| f64::from(at) + 0.5 - f64::from(size) / 2.0);
        x.hypot(y) <= 0.25 * f64::from(size)
    };
    let pixels: Vec<u8> = (0..size * size).map(|k| if is_white(k) { 255 } else { 0 }).collect();
    fs::write(folder.path().join("disc.png"), png(size as u32, &pixels)).expect("written");
    let share = std::f64::consts::PI / 16.0;
    for (quads, dark) in [(1, false), (4, false), (40, false), (1, true)] {
        let nodes = format!(
            r#""n": nucleus(), "q": nParticle(), "p": polyPlane(width: 2, height: 2, subdivisions: ({quads}, {quads})),
            "e": pointEmitter(target: "q", emitterType: surface, parent: "p", rate: 60000, enableTextureRate: true,
            emitFromDark: {dark}, rateMap: texture("disc.png"))"#
        );
        let file = folder.path().join("scene.ron");
        let (scene, _) = read_scene_text(&of_nodes(&nodes, ""), &file).expect("it can be read");
        let born = compile(&scene).unwrap_or_else(|found| panic!("{found:?}")).first_input().births;
        let expected = 10_000.0 * if dark { 1.0 - share } else { share };
        let deviation = (10_000.0 * share * (1.0 - share)).sqrt();
        let error = (born.len() as f64 - expected) / deviation;
        assert!(error.abs() < 4.0, "{quads} quads, {dark}: {} for {expected}", born.len());
        let is_inside = |birth: &Birth| birth.position.x.hypot(birth.position.z) < 0.51;
        let is_outside = |birth: &Birth| birth.position.x.hypot(birth.position.z) > 0.49;
        assert!(if dark { born.iter().all(is_outside) } else { born.iter().all(is_inside) }, "{quads} quads");
    }
}

#[test]
fn a_rate_map_follows_a_seam_of_the_texture_coordinates() {
    let folder = tempfile::tempdir().expect("a folder");
    let pixels: Vec<u8> = (0..64).map(|column| if (16..48).contains(&column) { 255 } else { 0 }).collect();
    fs::write(folder.path().join("rate.png"), png(64, &pixels)).expect("written");
    // Two quads side by side: the left one is black (u from 0 to 0.2), the right one white (from 0.4 to 0.6).
    let mesh = "v 0 0 0\nv 1 0 0\nv 2 0 0\nv 0 0 1\nv 1 0 1\nv 2 0 1\n\
        vt 0 0\nvt 0.2 0\nvt 0.2 1\nvt 0 1\nvt 0.4 0\nvt 0.6 0\nvt 0.6 1\nvt 0.4 1\n\
        f 1/1 4/4 5/3 2/2\nf 2/5 5/8 6/7 3/6\n";
    fs::write(folder.path().join("seam.obj"), mesh).expect("written");
    for mirror in ["", ", scaleX: -1"] {
        let nodes = format!(
            r#""n": nucleus(), "q": nParticle(), "p": mesh(file: "seam.obj"{mirror}),
            "e": pointEmitter(target: "q", emitterType: surface, parent: "p", rate: 2400, enableTextureRate: true,
            rateMap: texture("rate.png"))"#
        );
        let file = folder.path().join("scene.ron");
        let (scene, _) = read_scene_text(&of_nodes(&nodes, ""), &file).expect("it can be read");
        let born = compile(&scene).unwrap_or_else(|found| panic!("{found:?}")).first_input().births;
        assert!((70..=130).contains(&born.len()), "{mirror}: half of 200: {}", born.len());
        assert!(born.iter().all(|birth| birth.position.x.abs() > 1.0), "{mirror}");
    }
}
