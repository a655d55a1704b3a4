//! Particles that fill boxes and meshes.

use std::path::Path;

use nucleus_graph::compile::compile;
use nucleus_graph::scene::read_scene_text;

use super::particles::places;
use super::scenes::{of_nodes, program};

#[test]
fn particles_fill_a_box_with_as_many_cubes_as_fit() {
    let fields = "minimumCorner: (0, 1, 0), maximumCorner: (1, 2, 0.75), particleSpacing: 0.25";
    let program = program(&of_nodes(&format!(r#""n": nucleus(), "q": nParticle({fields})"#), ""));
    let filled = places(&program, 0);
    assert_eq!((filled.len(), filled[0], filled[47]), (48, [0.125, 1.125, 0.125], [0.875, 1.875, 0.625]));
}

#[test]
fn the_grid_of_particles_stands_in_the_middle_of_its_box() {
    // Of 1, 0.7 and 0.1 scene units, cubes of 0.25 leave 0, 0.2 and -0.15.
    let fields = "minimumCorner: (0, 1, 0), maximumCorner: (1, 1.7, 0.1), particleSpacing: 0.25";
    let filled = places(&program(&of_nodes(&format!(r#""n": nucleus(), "q": nParticle({fields})"#), "")), 0);
    let near = |a: [f32; 3], b: [f32; 3]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-6);
    assert_eq!(filled.len(), 8);
    assert!(near(filled[0], [0.125, 1.225, 0.05]) && near(filled[7], [0.875, 1.475, 0.05]), "{filled:?}");
}

#[test]
fn particles_fill_the_volume_of_a_mesh_where_it_stands() {
    let nodes = r#""n": nucleus(), "c": polyCube(width: 2, height: 1, depth: 1, translate: (10, 0, 0)),
        "q": nParticle(fillMesh: "c", radius: 0.125)"#;
    let filled = places(&program(&of_nodes(nodes, "")), 0);
    assert_eq!(
        (filled.len(), filled[0], filled[127]),
        (128, [9.125, -0.375, -0.375], [10.875, 0.375, 0.375])
    );
}

#[test]
fn particles_that_fill_the_mesh_of_a_cloth_or_collider_begin_outside_of_its_contact_distance() {
    let filled = |object: &str, particles: &str| {
        let nodes = format!(
            r#""n": nucleus(), "c": polyCube(), "o": {object}(inputMesh: "c", thickness: 0.1),
               "q": nParticle(fillMesh: "c", radius: 0.05, {particles})"#
        );
        let program = program(&of_nodes(&nodes, ""));
        let particles = program.nuclei()[0].model().cloths().len() - 1;
        places(&program, particles).len()
    };
    // Cubes of 0.1: the outer layer has its centres 0.05 from the mesh, the next one 0.15.
    assert_eq!(filled("nCloth", ""), 512);
    assert_eq!(filled("nRigid", ""), 512);
    assert_eq!(filled("nCloth", "collide: false"), 1000);
    assert_eq!(filled("nRigid", "collideWidthScale: 2.1"), 216);
}

#[test]
fn a_volume_that_cannot_be_filled_is_an_error_that_names_the_fix() {
    let errors = |fields: &str| {
        let nodes = format!(
            r#""n": nucleus(), "ball": polySphere(), "sheet": polyPlane(), "q": nParticle({fields})"#
        );
        let (scene, _) =
            read_scene_text(&of_nodes(&nodes, ""), Path::new("test.ron")).expect("it can be read");
        let found = compile(&scene).expect_err("it is refused");
        found.into_iter().map(|found| found.message).collect::<Vec<_>>()
    };
    assert_eq!(errors(r#"fillMesh: "bal""#), ["there is no mesh `bal` to fill"]);
    assert_eq!(errors(r#"fillMesh: "sheet", radius: 0.1"#), ["no particle of `q` fits into `sheet`"]);
    assert_eq!(
        errors(r#"maximumCorner: (1, 1, 1), radius: 0"#),
        ["particles of `q` without radius cannot fill a volume"]
    );
    assert_eq!(errors("maximumCorner: (1, 0, 1)"), ["the box of `q` has no extent along y"]);
    let too_many = errors("maximumCorner: (1, 1, 1), particleSpacing: 1e-6");
    assert!(too_many[0].starts_with("`q`, of about 1000000000000000000 particles, takes"), "{too_many:?}");
}
