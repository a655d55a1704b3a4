//! What a cloth has beyond links: the rest shape by name, the perturbed start, the order of links, the air and fields of
//! objects, and what is said about settings that make no sense.

use std::path::Path;

use nucleus_graph::Simulation;
use nucleus_graph::compile::compile;
use nucleus_graph::scene::{Severity, read_scene_text, write_scene};

use super::scenes::{of_nodes, program, scene};

fn sheet(nucleus: &str, cloth: &str) -> String {
    of_nodes(
        &format!(
            r#""n": nucleus({nucleus}), "p": polyPlane(subdivisions: (4, 4)), "r": polyPlane(), "c": nCloth(inputMesh: "p", {cloth}),
               "h": dynamicConstraint(components: ["c.vtx[20:24]"])"#
        ),
        "",
    )
}

#[test]
fn a_rest_shape_is_named_like_the_input_mesh_and_survives_writing() {
    let nodes = r#""n": nucleus(), "p": polyPlane(subdivisions: (2, 2)), "r": polyPlane(width: 2, subdivisions: (2, 2)),
        "c": nCloth(inputMesh: "p""#;
    let named = of_nodes(&format!("{nodes}, restShapeMesh: \"r\")"), "");
    let wired = of_nodes(&format!("{nodes})"), r#"("r.worldMesh[0]", "c.restShapeMesh")"#);
    assert_eq!(write_scene(&scene(&named)), write_scene(&scene(&wired)));
    let written = write_scene(&scene(&wired));
    assert!(written.contains("restShapeMesh: \"r\"") && !written.contains("connections"), "{written}");
    assert_eq!(write_scene(&scene(&written)), written);
    let start = |text: &str| program(text).model().cloths()[0].clone();
    assert_eq!(start(&named), start(&wired));
    assert_ne!(start(&named).start.positions, start(&named).surface.positions);
}

#[test]
fn a_perturbation_moves_the_start_by_at_most_its_length_and_not_the_rest_shape() {
    let cloth = |fields: &str| program(&sheet("spaceScale: 0.1", fields)).model().cloths()[0].clone();
    let plain = cloth("");
    assert!(plain.start.positions.is_empty(), "nothing is perturbed unless it is asked for");
    let moved = cloth("initialPerturbation: 0.2");
    assert_eq!(moved.surface, plain.surface);
    let away = moved.start.positions.iter().zip(&plain.surface.positions).map(|(a, b)| a - b);
    let away: Vec<_> = away.collect();
    assert!(
        away.iter().all(|d| d.x == 0.0 && d.z == 0.0 && d.y.abs() <= 0.02),
        "along the normals, in metres"
    );
    assert!(away.iter().any(|d| d.y.abs() > 0.01) && away.iter().any(|d| d.y < 0.0));
    assert_eq!(cloth("initialPerturbation: 0.2").start, moved.start, "the same seed, the same start");
    assert_ne!(cloth("initialPerturbation: 0.2, initialPerturbationSeed: 1").start, moved.start);
}

#[test]
fn the_air_and_the_fields_of_objects_are_in_metres() {
    let fields = "windShadowDistance: 50, windShadowDiffusion: 0.5, windSelfShadow: true, airPushDistance: 20, \
        airPushVorticity: 0.25, thickness: 0.5, pointForceField: worldspace, pointFieldMagnitude: 2, selfAttract: 3, \
        pointFieldDistance: 4";
    let input = program(&sheet("spaceScale: 0.01", fields)).first_input();
    let cloth = &input.cloths[0];
    let (wind, field) = (cloth.wind_field, cloth.point_field.expect("it is on"));
    assert_eq!((wind.shadow_distance, wind.push_distance), (0.5, 0.2));
    assert_eq!((wind.shadow_diffusion, wind.push_vorticity, wind.self_shadow), (0.5, 0.25, true));
    assert_eq!(
        (field.magnitude, field.self_attract, field.radius, field.distance),
        (20.0, 30.0, 0.005, 0.04)
    );
    let relative = fields.replace("worldspace", "thicknessRelative");
    let input = program(&sheet("spaceScale: 0.01", &relative)).first_input();
    let field = input.cloths[0].point_field.expect("it is on");
    assert_eq!(
        (field.magnitude, field.distance),
        (0.1, 0.02),
        "times the thickness of 5 mm, and of 0.5 units"
    );
    let metres = relative.replace("thickness: 0.5", "thickness: 0.005");
    let same = program(&sheet("", &metres)).first_input().cloths[0].point_field.expect("it is on");
    assert_eq!((same.magnitude, same.self_attract), (field.magnitude, field.self_attract));
    assert_eq!((same.radius, same.distance), (field.radius, field.distance));
}

// EVIDENCE: N1.3-4  lift does not depend on the scene unit, and a switch keeps the original's, which does
#[test]
fn lift_in_scene_units_is_stronger_by_the_inverse_of_the_space_scale() {
    let lift = |nucleus: &str| program(&sheet(nucleus, "lift: 0.5")).first_input().cloths[0].lift;
    assert_eq!([lift(""), lift("spaceScale: 0.01")], [0.5, 0.5]);
    assert_eq!(lift("spaceScale: 0.01, liftInSceneUnits: true"), 50.0);
    assert_eq!(lift("liftInSceneUnits: true"), 0.5);
}

#[test]
fn minimal_resistances_are_one_iteration_in_a_substep() {
    let counts = |fields: &str| {
        let text = sheet("resistanceModel: classic, subSteps: 4", &format!("bendResistance: 9, {fields}"));
        let cloth = program(&text).first_input().cloths[0];
        [
            cloth.stretch_resistance,
            cloth.compression_resistance,
            cloth.shear_resistance,
            cloth.bend_resistance,
        ]
    };
    let plain = counts("shearResistance: 8");
    assert_eq!(plain, [20.0, 10.0, 8.0, 9.0]);
    let close =
        |found: [f64; 4], expected: [f64; 4]| found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-9);
    assert!(close(counts("shearResistance: 8, minimalStretch: true"), [4.0, 4.0, 8.0, 9.0]));
    assert!(close(
        counts("shearResistance: 8, minimalShear: true, minimalBend: true"),
        [20.0, 10.0, 4.0, 4.0]
    ));
    assert!(close(counts("shearResistance: 1, minimalShear: true"), [20.0, 10.0, 1.0, 9.0]));
}

/// Severity, place, message and help of everything that is said about a scene.
fn said(text: &str) -> Vec<String> {
    let (mut all, warnings) = match read_scene_text(text, Path::new("test.ron")) {
        Err(errors) => (errors, Vec::new()),
        Ok((scene, warnings)) => match compile(&scene) {
            Ok(program) => (program.warnings().to_vec(), warnings),
            Err(errors) => (errors, warnings),
        },
    };
    all.extend(warnings);
    let line = |found: &nucleus_graph::scene::Diagnostic| {
        let severity = if found.severity == Severity::Error { "error" } else { "warning" };
        let help = found.help.as_deref().unwrap_or("");
        format!("{severity} at {}: {} | {help}", &text[found.span.clone()], found.message)
    };
    all.iter().map(line).collect()
}

#[test]
fn settings_that_make_no_sense_are_named_with_what_to_do() {
    for (cloth, expected) in [
        (
            "pressureMethod: volumeTrackingModel",
            "warning at volumeTrackingModel: `c` encloses no volume, so no air is held in it | use a closed mesh, or \
             `pressureMethod: manualPressureSetting`",
        ),
        (
            "pressure: 0.5",
            "warning at 0.5: `c` has open edges: pressure set by hand pushes its faces along their normals, and the whole \
             of it away | close the mesh, hold it by a constraint, or write `pressureMethod: volumeTrackingModel`, which \
             seals holes",
        ),
        (
            "pumpRate: 1",
            "warning at 1: `pumpRate` of `c` has no effect: `pressureMethod` is manualPressureSetting | write \
             `pressureMethod: volumeTrackingModel`",
        ),
        (
            "windShadowDiffusion: 0.5",
            "warning at 0.5: `windShadowDiffusion` of `c` has no effect: `windShadowDistance` is 0 | give \
             `windShadowDistance`",
        ),
        (
            "selfAttract: 2",
            "warning at 2: `selfAttract` of `c` has no effect: `pointForceField` is off | write `pointForceField: \
             worldspace` or `thicknessRelative`",
        ),
        (
            "minimalBend: true",
            "warning at true: `minimalBend` of `c` has no effect: `resistanceModel` is physical | it is about counts: \
             write `resistanceModel: classic`",
        ),
        ("pointMass: -1", "error at -1: `pointMass` of `c` must be at least 0, found -1 | "),
        ("pointMass: 0", "error at 0: `pointMass` of `c` must be above 0, found 0 | "),
        (
            "initialPerturbation: -1",
            "error at -1: `initialPerturbation` of `c` must be at least 0, found -1 | ",
        ),
        (
            "bendAngleDropoffPerVertex: [1, 2]",
            "error at [1, 2]: `bendAngleDropoffPerVertex` of `c` has 2 values, but `p` has 25 points | ",
        ),
        (
            r#"restShapeMesh: "n""#,
            "error at \"n\": `restShapeMesh` of `c` takes a mesh, but `n` is of type nucleus | ",
        ),
        (
            r#"restShapeMesh: "r""#,
            "error at \"r\": `r` cannot be the rest shape of `c`: it has 121 points and 100 faces, the input mesh 25 and 16 | a \
             rest shape has the points and faces of the input mesh, elsewhere",
        ),
        (
            "massPerVertex: [1, 2, 3]",
            "error at [1, 2, 3]: `massPerVertex` of `c` has 3 values, but `p` has 25 points | ",
        ),
        (
            "sealHoles: false, pressureMethod: manualPressureSetting",
            "warning at false: `sealHoles` of `c` has no effect: `pressureMethod` is manualPressureSetting | write \
             `pressureMethod: volumeTrackingModel`",
        ),
        (r#"restShapeMesh: "q""#, "error at \"q\": there is no node `q` | did you mean `p`?"),
    ] {
        assert_eq!(said(&sheet("", cloth)), [expected], "{cloth}");
    }
}

#[test]
fn pressure_in_a_mesh_that_is_inside_out_is_a_warning() {
    let folder = tempfile::tempdir().expect("a folder");
    // A tetrahedron, its faces clockwise.
    let obj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 4 2\nf 1 3 4\nf 2 4 3\n";
    let file = folder.path().join("inward.obj");
    std::fs::write(&file, obj).expect("written");
    let mesh = format!("mesh(file: {:?})", file.display().to_string());
    let cloth = r#""c": nCloth(inputMesh: "p", pressureMethod: volumeTrackingModel)"#;
    let text = of_nodes(&format!(r#""n": nucleus(), "p": {mesh}, {cloth}"#), "");
    let expected = "warning at volumeTrackingModel: the faces of `c` face inwards | its air is kept inside all the \
        same; drag and push-out see it reversed";
    assert_eq!(said(&text), [expected]);
    let by_hand = text.replace("pressureMethod: volumeTrackingModel", "pressure: keys([(1, 0), (9, 1)])");
    let expected = "warning at keys([(1, 0), (9, 1)]): the faces of `c` face inwards: a pressure above 0 turns it inside \
        out | reverse its normals, or the sign of `pressure`";
    assert_eq!(said(&by_hand), [expected]);
    // Mirrored, its faces are turned, and look inwards still.
    assert_eq!(said(&by_hand.replace(".obj\")", ".obj\", scaleX: -1)")), [expected]);
    assert_eq!(said(&by_hand.replace(&mesh, "polyCube(scaleX: -1)")), Vec::<String>::new());
}

#[test]
fn sorting_links_from_nothing_is_a_warning() {
    let text =
        of_nodes(r#""n": nucleus(), "p": polyPlane(), "c": nCloth(inputMesh: "p", sortLinks: true)"#, "");
    assert_eq!(
        said(&text),
        ["warning at true: `sortLinks` of `c` has no effect: no constraint holds a point of it | "]
    );
}

#[test]
fn cloth_that_is_not_dynamic_follows_its_input_mesh_through_a_collider_without_a_contact() {
    let nodes = |dynamic: &str| {
        format!(
            r#""n": nucleus(), "m": polyPlane(translate: keys([(1, (0, 0.6, 0)), (9, (0, -0.6, 0))])),
            "c": nCloth(inputMesh: "m", isDynamic: {dynamic}, inputMeshAttract: 10, inputAttractMethod: 1),
            "box": polyCube(scale: (0.3, 0.3, 0.3)), "r": nRigid(inputMesh: "box")"#
        )
    };
    let unresolved = |dynamic: &str| {
        let program = program(&of_nodes(&nodes(dynamic), ""));
        let mut run = Simulation::<f32>::new(&program, 1);
        (0..10).map(|_| run.advance(&mut ()).report.pairs_unresolved).sum::<u64>()
    };
    assert_eq!(unresolved("false"), 0);
    assert!(unresolved("true") > 0, "dynamic cloth whose points are all locked is carried through the box");
}

#[test]
fn hanging_cloth_takes_the_evaluations_that_the_weight_of_its_content_needs() {
    let budget = |content: f64, place: f64| {
        let nodes = format!(
            r#""n": nucleus(), "m": polyPlane(width: 0.1, height: 0.1, subdivisions: (20, 20), rotateX: 90),
            "q": nCloth(inputMesh: "m", pointMass: 0.2), "rail": dynamicConstraint(constraintType: transform,
            components: ["q.vtx[0]", "q.vtx[20]"]), "p": nParticle(position: [(0, {place}, 0)], pointMass: {content})"#
        );
        program(&of_nodes(&nodes, "")).budget(0).expect("more than the default")
    };
    let own = 0.2 * 0.01;
    let empty = budget(1e-9, 0.0);
    // The strain at the pins is the load times h².
    let full = budget(3.0 * own, 0.0);
    assert!((full / empty - 2.0).abs() < 0.05, "{full} for {empty}");
    assert_eq!(budget(3.0 * own, 1.0), empty, "what starts above it may fall elsewhere");
}
