//! Particles: from node to solver.

use std::fs;
use std::path::Path;

use nucleus_core::Elements;
use nucleus_graph::compile::{Program, compile};
use nucleus_graph::scene::read_scene_text;

use super::scenes::{after, of_nodes, program};

/// Where the particles of `q` are after some frames, in scene units.
fn places(program: &Program, frames: usize) -> Vec<[f32; 3]> {
    after(program, frames, "q").into_iter().map(|place| place.map(f32::from_bits)).collect()
}

/// All warnings of a scene.
fn warnings(text: &str) -> Vec<String> {
    let (scene, mut diagnostics) = read_scene_text(text, Path::new("test.ron")).expect("it can be read");
    diagnostics.extend(compile(&scene).expect("it runs").warnings().iter().cloned());
    diagnostics.into_iter().map(|diagnostic| diagnostic.message).collect()
}

// EVIDENCE: N1.1-4  a particle is an object of the solver like cloth, without a face and without a link
#[test]
fn particles_start_where_their_node_says_and_fall() {
    let nodes = r#""n": nucleus(spaceScale: 0.01),
        "q": nParticle(position: [(1, 2, 3), (4, 5, 6)], velocity: [(0, 0, 24), (0, 0, 0)], drag: 0)"#;
    let program = program(&of_nodes(nodes, ""));
    assert_eq!(places(&program, 0), [[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]]);
    let moved = places(&program, 1);
    assert!((moved[0][2] - 4.0).abs() < 1e-4 && moved[1][2] == 6.0, "{moved:?}");
    assert!(moved.iter().zip([2.0, 5.0]).all(|(place, start)| place[1] < start), "{moved:?}");
    let cloth = &program.model().cloths()[0];
    assert!(cloth.surface.faces.is_empty() && !cloth.lists.stretch && !cloth.lists.bend);
}

#[test]
fn an_initial_position_has_precedence_over_a_position() {
    let nodes =
        r#""n": nucleus(), "q": nParticle(position: [(1, 2, 3)], pos0: [(7, 8, 9)], vel0: [(0, 0, 0)])"#;
    assert_eq!(places(&program(&of_nodes(nodes, "")), 0), [[7.0, 8.0, 9.0]]);
}

#[test]
fn particles_can_be_the_points_of_a_file() {
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("a.obj"), "v 1 2 3\nv 4 5 6\n").expect("written");
    fs::write(folder.path().join("a.txt"), "1 2 3 # one\n4, 5, 6").expect("written");
    for file in ["a.obj", "a.txt"] {
        let text = of_nodes(&format!(r#""n": nucleus(), "q": nParticle(position: file("{file}"))"#), "");
        let (scene, _) = read_scene_text(&text, &folder.path().join("scene.ron")).expect("it can be read");
        let program = compile(&scene).unwrap_or_else(|found| panic!("{found:?}"));
        assert_eq!(places(&program, 0), [[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]], "{file}");
    }
}

#[test]
fn particles_fill_a_box_with_as_many_cubes_as_fit() {
    let fields = "minimumCorner: (0, 1, 0), maximumCorner: (1, 2, 0.75), particleSpacing: 0.25";
    let program = program(&of_nodes(&format!(r#""n": nucleus(), "q": nParticle({fields})"#), ""));
    let filled = places(&program, 0);
    assert_eq!((filled.len(), filled[0], filled[47]), (48, [0.125, 1.125, 0.125], [0.875, 1.875, 0.625]));
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

// EVIDENCE: N1.2-11  the node of a liquid becomes one for the solver
#[test]
fn a_liquid_at_rest_overlaps_as_often_as_its_rest_density_says() {
    let nodes = r#""n": nucleus(spaceScale: 0.01), "q": nParticle(enableSPH: true, radius: 2, radiusScaleSPH: 0.5,
        restDensity: 1.5, viscosity: 0.5, surfaceTension: 0.1, maximumCorner: (4, 4, 4))"#;
    let program = program(&of_nodes(nodes, ""));
    let liquid = program.first_input().cloths[0].liquid.expect("a liquid");
    let ball = 4.0 / 3.0 * std::f64::consts::PI * 0.01f64.powi(3);
    assert!((ball / liquid.spacing.powi(3) - 1.5).abs() < 1e-9, "{liquid:?}");
    assert!((liquid.viscosity - 0.0025).abs() < 1e-12 && (liquid.surface_tension - 1e-4).abs() < 1e-12);
    // Its grid has the distance at rest: 4 cm hold two cubes of 1.41 cm.
    assert_eq!(places(&program, 0).len(), 8);
    let dry = of_nodes(r#""n": nucleus(), "q": nParticle(position: [(0, 0, 0)])"#, "");
    assert_eq!(self::program(&dry).first_input().cloths[0].liquid, None);
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

// EVIDENCE: N2.3-2  a particle is as thick as its radius says
#[test]
fn a_particle_is_as_thick_as_its_radius_and_its_scales_say() {
    let nodes = r#""n": nucleus(spaceScale: 0.01), "q": nParticle(position: [(0, 0, 0)], radius: 3, collideWidthScale: 0.5,
        selfCollideWidthScale: 2, collisionFlag: face, pointMass: 0.25)"#;
    let program = program(&of_nodes(nodes, ""));
    let frame = &program.first_input().cloths[0];
    assert!((frame.thickness - 0.015).abs() < 1e-12 && (frame.self_collision.thickness - 0.03).abs() < 1e-12);
    assert_eq!((frame.elements, frame.self_collision.elements), (Elements::Points, Elements::Points));
    assert_eq!((frame.drag, frame.tangential_drag, frame.lift), (0.01, 1.0, 0.0));
    assert_eq!((program.mass(), program.objects()[0].radius), (0.25, Some(3.0)));
}

#[test]
fn a_particle_has_the_same_mass_in_both_resistance_models() {
    for model in ["classic", "physical"] {
        let nodes = format!(
            r#""n": nucleus(resistanceModel: {model}), "q": nParticle(position: [(0, 0, 0), (1, 0, 0)], pointMass: 3)"#
        );
        assert_eq!(program(&of_nodes(&nodes, "")).mass(), 6.0);
    }
}

#[test]
fn settings_without_effect_on_particles_give_a_warning() {
    let of = |fields: &str| warnings(&of_nodes(&format!(r#""n": nucleus(), "q": nParticle({fields})"#), ""));
    assert_eq!(of("position: [(0, 0, 0)]"), Vec::<String>::new());
    assert_eq!(of(""), ["`q` has no particles, and does nothing"]);
    for name in ["damp: 1", "parallelSPH: true", "opacity: 0.5", "stickinessRandomize: 1"] {
        let messages = of(&format!("position: [(0, 0, 0)], {name}"));
        assert!(messages.len() == 1 && messages[0].ends_with("has no effect yet"), "{name}: {messages:?}");
    }
    for name in ["thickness: 1", "startPositions: [(0, 0, 0)]", "restLengthScale: 2"] {
        let messages = of(&format!("position: [(0, 0, 0)], {name}"));
        assert!(
            messages.len() == 1 && messages[0].ends_with("has no effect on such a node"),
            "{name}: {messages:?}"
        );
    }
}

#[test]
fn the_names_of_nodes_do_not_change_the_motion_of_particles_and_cloth() {
    let run = |[sheet, q, r]: [&str; 3]| {
        let nodes = format!(
            r#""n": nucleus(evaluations: 24), "p": polyPlane(width: 2, height: 2, subdivisions: (6, 6)),
               "{sheet}": nCloth(inputMesh: "p"), "{q}": nParticle(position: [(0.1, 0.3, 0), (0.1, 0.8, 0.1)], pointMass: 0.1),
               "{r}": nParticle(position: [(0.2, 0.5, 0.2)], pointMass: 0.1, radius: 0.1)"#
        );
        let program = program(&of_nodes(&nodes, ""));
        [sheet, q, r].map(|name| after(&program, 12, name))
    };
    assert_eq!(run(["a", "b", "c"]), run(["z", "y", "x"]));
}

// EVIDENCE: N3.1-3  particles can ignore the solver's gravity
#[test]
fn particles_that_ignore_gravity_stay_and_pinned_particles_are_held() {
    let nodes = r#""n": nucleus(), "q": nParticle(position: [(0, 0, 0)], ignoreSolverGravity: true)"#;
    assert_eq!(places(&program(&of_nodes(nodes, "")), 5), [[0.0; 3]]);
    let nodes = r#""n": nucleus(), "q": nParticle(position: [(0, 0, 0), (3, 0, 0)]),
        "h": dynamicConstraint(components: ["q.vtx[0]"])"#;
    let held = places(&program(&of_nodes(nodes, "")), 5);
    assert!(held[0] == [0.0; 3] && held[1][1] < -0.1, "{held:?}");
}
