//! Meshes that a negative scale mirrors: their outside stays outside, and their elements keep their numbers.

use std::fs;

use nucleus_core::Surface;
use nucleus_graph::compile::{Program, compile, texture_coordinates};
use nucleus_graph::scene::read_scene_text;

use super::scenes::{after, of_nodes, program};

/// The volume in m³ of a closed surface; negative where its faces point inwards.
fn volume(surface: &Surface) -> f64 {
    let of = |corners: [u32; 3]| {
        let [a, b, c] = corners.map(|corner| surface.positions[corner as usize]);
        a.dot(&b.cross(&c)) / 6.0
    };
    surface.faces.triangles().map(of).sum()
}

/// A cube of 1 m³ as a cloth and as a collider, with this transform and more nodes.
fn cubes(transform: &str, more: &str) -> Program {
    let cube = format!("polyCube(translate: (5, 0, 0), {transform})");
    let nodes = format!(
        r#""n": nucleus(), "m": {cube}, "c": nCloth(inputMesh: "m"), "k": {cube}, "r": nRigid(inputMesh: "k"), {more}"#
    );
    program(&of_nodes(&nodes, ""))
}

#[test]
fn the_outside_of_a_mirrored_mesh_stays_outside() {
    let group = r#""group": transform(scaleY: -1)"#;
    let cases = [
        ("", ""),
        ("scaleX: -1", ""),
        ("scale: (-1, -1, -1)", ""),
        ("scale: (-1, 1, -1)", ""),
        (r#"parent: "group""#, group),
        (r#"parent: "group", scaleX: -1"#, group),
    ];
    for (transform, more) in cases {
        let program = cubes(transform, more);
        let model = program.nuclei()[0].model();
        for surface in [&model.cloths()[0].surface, &model.colliders()[0].surface] {
            assert!((volume(surface) - 1.0).abs() < 1e-6, "{transform} {more}: {}", volume(surface));
        }
        let faces = &model.cloths()[0].surface.faces;
        assert!(program.objects().iter().all(|object| object.faces == *faces), "{transform} {more}");
    }
}

#[test]
fn a_mesh_that_is_mirrored_later_keeps_its_faces() {
    let [still, keyed] = ["", "scaleX: keys([(1, 1), (24, -1)])"].map(|transform| cubes(transform, ""));
    assert_eq!(still.objects()[0].faces, keyed.objects()[0].faces);
}

#[test]
fn elements_of_a_mirrored_mesh_keep_their_numbers() {
    let tear = r#"components: ["c.e[1]", "c.e[3:6]", "c.f[2]"], constraintType: tearableSurface"#;
    for held in [r#"components: ["c.e[1]", "c.e[3:6]"]"#, r#"components: ["c.f[2]", "c.f[4]"]"#, tear] {
        let [given, mirrored] = ["", "scaleX: -1"].map(|transform| {
            let program = cubes(transform, &format!(r#""d": dynamicConstraint({held})"#));
            let all: Vec<_> = program.nuclei()[0].selections().to_vec();
            let points = program.model().cloths()[0].surface.positions.len();
            (all, points)
        });
        assert!(!given.0.is_empty());
        assert_eq!(given, mirrored, "{held}");
    }
}

#[test]
fn corners_of_a_mirrored_mesh_keep_their_texture_coordinates() {
    let folder = tempfile::tempdir().expect("a folder");
    // A point has one value in each of its faces: a seam.
    let obj = "v 0 0 0\nv 1 0 0\nv 0 0 1\nv 1 0 1\nv 0 0 2\nv 1 0 2\n\
               vt 0 0\nvt 0.1 0\nvt 0.2 0\nvt 0.3 0\nvt 0.4 0\nvt 0.5 0\nvt 0.6 0\nvt 0.7 0\n\
               f 1/1 3/2 4/3 2/4\nf 3/5 5/6 6/7 4/8\n";
    fs::write(folder.path().join("a.obj"), obj).expect("written");
    let [given, mirrored] = ["", ", scaleX: -1"].map(|scale| {
        let nodes =
            format!(r#""n": nucleus(), "m": mesh(file: "a.obj"{scale}), "c": nCloth(inputMesh: "m")"#);
        let (scene, _) =
            read_scene_text(&of_nodes(&nodes, ""), &folder.path().join("a.ron")).expect("a scene");
        let program = compile(&scene).expect("a program");
        let (values, at) = texture_coordinates(&scene, &program).remove("c").expect("it has them");
        let corners = program.objects()[0].faces.corners().to_vec();
        assert_eq!(corners.len(), at.len());
        let mut pairs: Vec<_> = corners
            .into_iter()
            .zip(at)
            .map(|(point, at)| (point, values[at as usize].map(f64::to_bits)))
            .collect();
        let order: Vec<u32> = pairs.iter().map(|(point, _)| *point).collect();
        pairs.sort_unstable();
        (pairs, order)
    });
    assert_eq!(given.0, mirrored.0);
    assert_ne!(given.1, mirrored.1, "its faces are turned");
}

#[test]
fn a_mirrored_mesh_emits_outwards() {
    let nodes = r#""n": nucleus(gravity: 0), "q": nParticle(), "m": polySphere(scale: (1, -1, 1)),
        "e": pointEmitter(target: "q", emitterType: surface, parent: "m", rate: 240, normalSpeed: 4)"#;
    let places = after(&program(&of_nodes(nodes, "")), 12, "q");
    let distances =
        places.iter().map(|place| place.map(|x| f32::from_bits(x).powi(2)).iter().sum::<f32>().sqrt());
    let distances: Vec<f32> = distances.collect();
    assert!(!distances.is_empty() && distances.iter().all(|&distance| distance > 0.9), "{distances:?}");
    assert!(distances.iter().any(|&distance| distance > 2.0), "{distances:?}");
}
