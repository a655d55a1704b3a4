//! Dynamic constraints: from components to what moves together.

use std::fs;
use std::path::Path;

use nucleus_graph::compile::{Program, compile};
use nucleus_graph::scene::read_scene_text;
use proptest::prelude::*;

use super::scenes::{after, of_nodes, program};

/// Where the points of an object are after some frames, in scene units.
fn places(program: &Program, frames: usize, name: &str) -> Vec<[f32; 3]> {
    after(program, frames, name).into_iter().map(|place| place.map(f32::from_bits)).collect()
}

/// The largest coordinate of the points of an object within a second, in scene units.
fn farthest(program: &Program, name: &str) -> f32 {
    let at = |frame| places(program, frame, name).iter().flatten().fold(0.0, |m: f32, x| m.max(x.abs()));
    [6, 12, 18, 24].map(at).into_iter().fold(0.0, f32::max)
}

/// The first error of a scene of these nodes, and its help.
fn error(nodes: &str) -> (String, Option<String>) {
    let text = of_nodes(nodes, "");
    let found = match read_scene_text(&text, Path::new("test.ron")) {
        Err(found) => found,
        Ok((scene, _)) => compile(&scene).expect_err("it has a mistake"),
    };
    (found[0].message.clone(), found[0].help.clone())
}

/// A sheet of two by two faces in metres, nine points.
const SHEET: &str = r#""n": nucleus(gravity: 0), "p": polyPlane(width: 2, height: 2, subdivisions: (2, 2)),
    "c": nCloth(inputMesh: "p", selfCollide: false), "#;

/// The numbers that a component selects.
fn selected(component: &str) -> Vec<u32> {
    let constraint = format!(r#"{SHEET}"h": dynamicConstraint(components: ["{component}"])"#);
    let program = program(&of_nodes(&constraint, ""));
    program.nuclei()[0].selections()[0].elements.clone()
}

#[test]
fn elements_are_selected_by_number_border_and_meaning() {
    for (component, expected) in [
        ("c.vtx[3:5]", vec![3, 4, 5]),
        ("c.vtx[*]", (0..9).collect()),
        ("c.border", vec![0, 1, 2, 3, 5, 6, 7, 8]),
        ("c.corners", vec![0, 2, 6, 8]),
        ("c.f[corners]", vec![0, 1, 2, 3]),
        ("c.where(x > 0.5 && z > 0.5)", vec![2]),
        ("c.where(i % 4 == 0)", vec![0, 4, 8]),
        ("c.f[1]", vec![1]),
    ] {
        let mut found = selected(component);
        found.sort_unstable();
        if component.contains("x >") {
            assert_eq!(found.len(), 1, "{component}");
        } else {
            assert_eq!(found, expected, "{component}");
        }
    }
    assert_eq!(selected("c.e[border]").len(), 8);
    assert_eq!(selected("c.e[*]").len(), 12);
}

#[test]
fn elements_are_selected_by_a_group_of_their_file_and_by_an_image() {
    let folder = tempfile::tempdir().expect("a folder");
    let mesh =
        "v 0 0 0\nv 1 0 0\nv 1 0 1\nv 0 0 1\nv 2 0 0\nv 2 0 1\ng left\nf 1 2 3 4\ng right hem\nf 2 5 6 3\n";
    fs::write(folder.path().join("a.obj"), mesh).expect("written");
    let select = |component: &str| {
        let text = of_nodes(
            &format!(
                r#""n": nucleus(), "m": mesh(file: "a.obj"), "c": nCloth(inputMesh: "m"),
                "h": dynamicConstraint(components: ["{component}"])"#
            ),
            "",
        );
        let (scene, _) = read_scene_text(&text, &folder.path().join("scene.ron")).expect("it can be read");
        compile(&scene).map(|program| program.nuclei()[0].selections()[0].elements.clone())
    };
    assert_eq!(select("c.group(left)").expect("it runs"), [0, 1, 2, 3]);
    assert_eq!(select("c.f[group(hem)]").expect("it runs"), [1]);
    let found = select("c.group(sleeve)").expect_err("there is none");
    assert_eq!(
        found[0].message,
        "`h`: `c` cannot select `group(sleeve)`: `a.obj` has no group `sleeve`, but `hem`, `left` and `right`"
    );
}

#[test]
fn components_that_are_not_there_or_empty_are_errors_that_name_constraint_and_component() {
    let with = |component: &str| format!(r#"{SHEET}"h": dynamicConstraint(components: ["{component}"])"#);
    for (component, message) in [
        ("c.e[12]", "`h`: `c` has no edge 12"),
        ("c.f[3:9]", "`h`: `c` has no face 4"),
        ("c.where(y > 3)", "`h`: `c` has no points in `where(y > 3)`"),
        ("c.where(y >)", "`h`: `c` cannot select `where(y >)`: "),
        ("c.group(a)", "`h`: `c` cannot select `group(a)`: `p` is not read from a file"),
    ] {
        let (found, _) = error(&with(component));
        assert!(found.starts_with(message), "{component}: {found}");
    }
}

#[test]
fn an_expression_that_selects_nothing_names_the_space_of_its_places() {
    let nodes = SHEET.replace("subdivisions: (2, 2)", "subdivisions: (2, 2), translateY: 2");
    let (_, help) = error(&format!(r#"{nodes}"h": dynamicConstraint(components: ["c.where(y > 1.5)"])"#));
    assert!(help.is_some_and(|help| help.contains("in the space of the mesh, before its transform")));
}

#[test]
fn points_of_a_missing_mesh_are_reported_as_the_missing_file() {
    for file in ["none.obj", "none.ply"] {
        let nodes = format!(
            r#""n": nucleus(), "m": mesh(file: "{file}"), "c": nCloth(inputMesh: "m"),
            "h": dynamicConstraint(components: ["c.vtx[2]"])"#
        );
        let (found, _) = error(&nodes);
        assert!(found.contains(file) && !found.contains("has no point"), "{found}");
    }
}

#[test]
fn constraints_that_cannot_join_their_members_are_refused() {
    let collider = r#""b": polyCube(translate: (0, -3, 0)), "r": nRigid(inputMesh: "b"),"#;
    for (constraint, message) in [
        (
            r#"type: slideOnSurface, components: ["c", "c.vtx[0]"]"#,
            "`h` slides an object on itself: `c` and `c`",
        ),
        (
            r#"type: pointToSurface, components: ["c.vtx[0]", "r"]"#,
            "`h` needs a surface as its first component: `c` and `r`",
        ),
        (
            r#"type: pointToSurface, components: ["r"]"#,
            "`h` joins only passive objects, which nothing moves: `r`",
        ),
        (
            r#"type: match, components: ["c", "r"]"#,
            "`h` matches objects of different numbers of points: `c` and `r`",
        ),
        (
            r#"type: collisionExclusion, components: ["c"]"#,
            "`h` has one member, and this kind joins two: `c`",
        ),
        (r#"constraintRelation: objectToObject, components: ["c"]"#, "`h` joins a component to itself: `c`"),
    ] {
        let (found, help) = error(&format!(r#"{SHEET}{collider}"h": dynamicConstraint({constraint})"#));
        assert_eq!(found, message);
        assert!(help.is_some(), "{message}");
    }
}

#[test]
fn members_under_another_nucleus_are_refused() {
    let nodes = r#""n1": nucleus(), "n2": nucleus(), "p": polyPlane(), "q": polyPlane(),
        "a": nCloth(inputMesh: "p", nucleus: "n1"), "b": nCloth(inputMesh: "q", nucleus: "n2"),
        "s": dynamicConstraint(type: pointToPoint, components: ["a", "b"], nucleus: "n1")"#;
    let (message, help) = error(nodes);
    assert_eq!(message, "`s` on `n1` constrains `b` on `n2`");
    assert!(help.is_some());
}

/// Two sheets side by side, a gap of 0.1 between their borders.
const PAIR: &str = r#""n": nucleus(gravity: 0), "pa": polyPlane(subdivisions: (2, 2)),
    "pb": polyPlane(subdivisions: (2, 2), translate: (1.1, 0, 0)),
    "a": nCloth(inputMesh: "pa", selfCollide: false), "b": nCloth(inputMesh: "pb", selfCollide: false), "#;

// EVIDENCE: N2.4-3  a weld of borders closes the gap that its rest length leaves
#[test]
fn welded_borders_close_when_their_rest_length_shrinks() {
    let seam = r#""s": dynamicConstraint(type: weldBorders, components: ["a.e[border]", "b.e[border]"],
        maxDistance: 0.2, restLengthScale: 0)"#;
    let program = program(&of_nodes(&format!("{PAIR}{seam}"), ""));
    let [a, b] = ["a", "b"].map(|name| places(&program, 6, name));
    for row in [2, 5, 8] {
        let gap: f32 = (0..3).map(|k| (a[row][k] - b[row - 2][k]).powi(2)).sum::<f32>().sqrt();
        assert!(gap < 1e-4, "{gap}");
    }
}

// EVIDENCE: N2.4-5  links form on the frame that a constraint is switched on
#[test]
fn links_take_the_distance_of_the_frame_on_which_they_are_switched_on() {
    let nodes = |enable: &str| {
        format!(
            r#""n": nucleus(gravity: 0), "q": nParticle(position: [(0, 0, 0)], velocity: [(1, 0, 0)], drag: 0),
            "w": nParticle(position: [(1, 0, 0)], collide: false),
            "pin": dynamicConstraint(components: ["w"]),
            "s": dynamicConstraint(type: pointToPoint, constraintMethod: weld, components: ["q", "w"], {enable})"#
        )
    };
    let at_once = program(&of_nodes(&nodes("enable: true"), ""));
    assert!(places(&at_once, 12, "q")[0][0].abs() < 1e-3, "held at a metre's distance");
    let later = program(&of_nodes(&nodes("enable: keys([(1, false), (7, true)])"), ""));
    let x = places(&later, 12, "q")[0][0];
    assert!((x - 5.0 / 24.0).abs() < 0.05, "{x}: held where it was then");
}

#[test]
fn a_sheet_that_tears_in_flight_is_not_braked() {
    let text = r#""n": nucleus(gravity: 0, airDensity: 0),
        "p": polyPlane(subdivisions: (10, 10)),
        "c": nCloth(inputMesh: "p", thickness: 0.01, localForce: keys([(1, (0, 3, 0), stepped), (4, (0, 0, 0), stepped)])),
        "t": dynamicConstraint(constraintType: tearableSurface, components: ["c"], glueStrength: 0.1)"#;
    let program = program(&of_nodes(text, ""));
    let height = |frame: usize| {
        let points = places(&program, frame, "c");
        points.iter().map(|p| f64::from(p[1])).sum::<f64>() / points.len() as f64
    };
    // The force ends after the third frame.
    let [first, last] = [[4, 5], [10, 11]].map(|[from, to]| height(to) - height(from));
    assert!(first > 1.0 && (last / first - 1.0).abs() < 0.01, "{last} m a frame, not {first}");
}

#[test]
fn pins_follow_all_motion_of_their_constraint_though_the_solver_is_switched_on_late() {
    let nodes = |enable: &str| {
        format!(
            r#""n": nucleus(gravity: 0, enable: {enable}), "p": polyPlane(), "c": nCloth(inputMesh: "p"),
            "pin": dynamicConstraint(components: ["c.vtx[0]"], tx: keys([(1, 0), (5, 3), (9, 4)]))"#
        )
    };
    let way = |enable: &str| {
        let program = program(&of_nodes(&nodes(enable), ""));
        places(&program, 12, "c")[0][0] - places(&program, 0, "c")[0][0]
    };
    for enable in
        ["true", "keys([(1, false), (5, true)])", "keys([(1, true, stepped), (3, false), (5, true)])"]
    {
        assert!((way(enable) - 4.0).abs() < 1e-4, "{enable}: {}", way(enable));
    }
}

#[test]
fn a_constraint_that_is_off_or_excludes_nothing_costs_nothing() {
    let passes = |constraint: &str| {
        let text = of_nodes(&format!("{PAIR}{constraint}"), "");
        let program = program(&text);
        let input = program.first_input();
        (input.constraints.len(), input.exclusions.len())
    };
    assert_eq!(passes(r#""t": transform()"#), (0, 0));
    assert_eq!(passes(r#""s": dynamicConstraint(type: disableCollision, components: ["a"])"#), (0, 1));
    let off = r#""s": dynamicConstraint(type: disableCollision, components: ["a"], enable: false)"#;
    assert_eq!(passes(off), (0, 0));
    assert_eq!(passes(r#""s": dynamicConstraint(components: ["a.vtx[0]"])"#), (0, 0), "pins");
}

// EVIDENCE: N2.4-5  torn glue: mass is kept, and points of one face stay together
#[test]
fn a_tearable_sheet_has_the_mass_of_the_whole_one_and_holds_until_it_is_pulled() {
    let tear = r#""t": dynamicConstraint(type: tearableSurface, components: ["c"], glueStrength: 0.3)"#;
    let whole = program(&of_nodes(SHEET, ""));
    let torn = program(&of_nodes(&format!("{SHEET}{tear}"), ""));
    assert!((whole.mass() / torn.mass() - 1.0).abs() < 1e-9);
    assert_eq!(torn.model().cloths()[0].surface.positions.len(), 16);
    let still = places(&torn, 4, "c");
    let start = places(&torn, 0, "c");
    let most = still.iter().zip(&start).flat_map(|(a, b)| (0..3).map(move |k| (a[k] - b[k]).abs()));
    assert!(most.fold(0.0, f32::max) < 1e-4, "nothing pulls");
}

// Broken springs that were joined anew in every frame pulled the pieces back from wherever they were.
#[test]
fn a_torn_sheet_whose_connections_update_per_frame_falls_like_a_torn_sheet() {
    for method in ["weld", "spring", "rubberBand"] {
        let nodes = format!(
            r#""n": nucleus(), "p": polyPlane(subdivisions: (6, 6)), "c": nCloth(inputMesh: "p", selfCollide: false),
            "pin": dynamicConstraint(type: transform, components: ["c.vtx[0:3]"]),
            "t": dynamicConstraint(type: tearableSurface, components: ["c"], constraintMethod: {method},
                connectionUpdate: 1)"#
        );
        let program = program(&of_nodes(&nodes, ""));
        let most = farthest(&program, "c");
        assert!(most < 5.0, "{method}: {most} m, and a free fall is less than 5 m");
    }
}

#[test]
fn particles_that_slide_on_a_face_keep_their_distance_from_the_whole_mesh() {
    // Springs give way a little; rigid links do not.
    for (method, tolerance) in [("weld", 0.005), ("spring", 0.15), ("rubberBand", 0.15)] {
        for place in [1.0, -3.0] {
            let nodes = format!(
                r#""n": nucleus(gravity: 0), "box": polyCube(translate: (0, -1, 0)), "r": nRigid(inputMesh: "box"),
                "q": nParticle(position: [(0.1, {place}, 0.05)], radius: 0.1),
                "s": dynamicConstraint(type: slideOnSurface, components: ["r.f[0]", "q"], constraintMethod: {method})"#
            );
            for [x, y, z] in places(&program(&of_nodes(&nodes, "")), 5, "q") {
                let beyond = [x, y + 1.0, z].map(|x| (x.abs() - 0.5).max(0.0));
                let distance = beyond.iter().map(|x| x * x).sum::<f32>().sqrt();
                assert!((distance - 1.5).abs() < tolerance * 1.5, "{method} at {place}: {distance}");
            }
        }
    }
}

// The push on the foot alone turned the face, which moved the place where the foot was wanted.
#[test]
fn a_sheet_held_from_places_far_above_its_faces_does_not_feed_on_its_turning() {
    for method in ["weld", "spring", "rubberBand"] {
        let nodes = format!(
            r#""n": nucleus(), "pa": polyPlane(subdivisions: (4, 4)),
            "a": nCloth(inputMesh: "pa", selfCollide: false, collide: false),
            "box": polyCube(translate: (0, -1, 0)), "r": nRigid(inputMesh: "box", collide: false),
            "s": dynamicConstraint(type: pointToSurface, components: ["a", "r.f[0]"], constraintMethod: {method})"#
        );
        // It swings about the box within the diagonal of the sheet; before, its points flew 20 m apart.
        let program = program(&of_nodes(&nodes, ""));
        let most = farthest(&program, "a");
        assert!(most < 3.0, "{method}: {most} m");
    }
}

#[test]
fn points_beside_an_edge_or_a_corner_of_a_surface_are_held_along_it_as_points_above_a_face_are() {
    for place in ["(0.6, -1.1, 0.1)", "(0.6, -1.1, 0.6)", "(0.6, -0.4, 0.6)", "(0.2, -0.45, 0.55)"] {
        let nodes = format!(
            r#""n": nucleus(airDensity: 0), "box": polyCube(translate: (0, -1, 0)), "r": nRigid(inputMesh: "box", collide: false),
            "q": nParticle(position: [{place}], radius: 0.01),
            "s": dynamicConstraint(type: pointToSurface, components: ["r", "q"], strength: 10, tangentStrength: 10)"#
        );
        let program = program(&of_nodes(&nodes, ""));
        let [start] = places(&program, 0, "q")[..] else { panic!("one point") };
        // A strength of 10 is 5000 N/m, and each component halves it. A mass of 1 kg that is released sinks to twice its static
        // deflection.
        let most = 2.0 * 9.8 / 1250.0;
        for frames in [4, 8, 16, 24] {
            let [x, y, z] = places(&program, frames, "q")[0];
            let moved = [x - start[0], y - start[1], z - start[2]].map(f32::abs);
            assert!(
                moved.iter().all(|&moved| moved < 1.01 * most),
                "{place}: moved by {moved:?} m in {frames} frames"
            );
        }
    }
}

// An edge has no face that takes up the torque of friction: the pull along it fed the sheet.
#[test]
fn a_particle_that_slides_beside_a_falling_sheet_does_not_feed_it() {
    for friction in [0.0, 0.1, 1.0] {
        let nodes = format!(
            r#""n": nucleus(), "pa": polyPlane(subdivisions: (2, 2)), "a": nCloth(inputMesh: "pa", thickness: 0.01),
            "box": polyCube(translate: (0, -1, 0)), "r": nRigid(inputMesh: "box"),
            "q": nParticle(position: [(0.7, 0.3, 0), (2.2, 0.1, 0.7)], radius: 0.1),
            "s": dynamicConstraint(type: slideOnSurface, components: ["a.f[*]", "q"], constraintMethod: weld,
                friction: {friction})"#
        );
        let program = program(&of_nodes(&nodes, ""));
        // All fall by less than 5 m in a second; the sheet flew 10 m and more.
        let most = farthest(&program, "a");
        assert!(most < 5.0, "friction {friction}: {most} m");
    }
}

// Many rigid links to few faces, swept in one order, fed on their errors; so did friction where a foot crossed an edge.
#[test]
fn a_sheet_welded_over_a_part_of_another_falls_with_it() {
    for kind in ["pointToSurface", "slideOnSurface"] {
        for (friction, evaluations) in [(0.0, 48), (0.1, 96), (1.0, 96)] {
            let nodes = format!(
                r#""n": nucleus(evaluations: {evaluations}), "pa": polyPlane(subdivisions: (6, 6)),
                "pb": polyPlane(subdivisions: (3, 2), translate: (0.5, 0.05, 0)),
                "a": nCloth(inputMesh: "pa", collide: false), "b": nCloth(inputMesh: "pb", collide: false),
                "s": dynamicConstraint(type: {kind}, components: ["b.f[*]", "a"], constraintMethod: weld,
                    friction: {friction})"#
            );
            let program = program(&of_nodes(&nodes, ""));
            let most = farthest(&program, "a");
            assert!(most < 5.0, "{kind}, friction {friction}: {most} m, and a free fall is less than 5 m");
        }
    }
}

// The link and contact wanted different distances, and each undid the other in every step.
#[test]
fn a_sheet_welded_nearer_than_its_contact_thickness_falls_with_the_other() {
    for kind in ["pointToSurface", "slideOnSurface"] {
        for (method, height) in [("weld", 0.005), ("weld", 0.015), ("spring", 0.005)] {
            let nodes = format!(
                r#""n": nucleus(evaluations: 96), "pa": polyPlane(subdivisions: (6, 6)),
                "pb": polyPlane(subdivisions: (3, 2), translate: (0.5, {height}, 0)),
                "a": nCloth(inputMesh: "pa", thickness: 0.01), "b": nCloth(inputMesh: "pb", thickness: 0.01),
                "s": dynamicConstraint(type: {kind}, components: ["b.f[*]", "a"], constraintMethod: {method})"#
            );
            let program = program(&of_nodes(&nodes, ""));
            // It falls straight and keeps its shape.
            let start = places(&program, 0, "a");
            let end = places(&program, 23, "a");
            let moved = |k: usize| [0, 2].map(|axis| (end[k][axis] - start[k][axis]).abs());
            let most = (0..start.len()).flat_map(moved).fold(0.0, f32::max);
            assert!(most < 0.1, "{kind}, {method} at {height} m: moved by {most} m beside its fall");
        }
    }
}

/// Two sheets, a collider and particles, none of which touch.
const OBJECTS: &str = r#""n": nucleus(gravity: 0), "pa": polyPlane(subdivisions: (2, 2)),
    "pb": polyPlane(subdivisions: (2, 2), translate: (1.1, 0, 0)),
    "a": nCloth(inputMesh: "pa", selfCollide: false), "b": nCloth(inputMesh: "pb", selfCollide: false),
    "box": polyCube(translate: (0, -1, 0)), "r": nRigid(inputMesh: "box"),
    "q": nParticle(position: [(0, 1, 0), (0.3, 1, 0), (2.2, 0.1, 0.7)], radius: 0.1), "#;

proptest! {
    #![proptest_config(ProptestConfig::with_cases(20))]

    /// Above a face or beside it, a link has the length at which it begins.
    #[test]
    fn links_of_their_starting_length_move_nothing(
        kind in prop::sample::select(vec!["transform", "pointToPoint", "pointToSurface", "slideOnSurface"]),
        first in prop::sample::select(vec!["a", "a.vtx[0:3]", "a.e[border]", "a.f[*]", "a.f[0]", "r", "r.f[0]"]),
        second in prop::sample::select(vec!["b", "b.vtx[2]", "b.e[*]", "b.f[1:2]", "b.border", "q"]),
        method in prop::sample::select(vec!["weld", "spring", "rubberBand"]),
        connection in 0..3,
        update in 0..2,
    ) {
        let nodes = format!(r#"{OBJECTS}
            "s": dynamicConstraint(type: {kind}, components: ["{first}", "{second}"], constraintMethod: {method},
                connectionMethod: {connection}, connectionUpdate: {update}, maxDistance: 0.6)"#);
        let (scene, _) = read_scene_text(&of_nodes(&nodes, ""), Path::new("test.ron")).expect("it can be read");
        if let Ok(program) = compile(&scene) {
            for name in ["a", "b", "q"] {
                let [start, end] = [0, 3].map(|frames| places(&program, frames, name));
                for (from, to) in start.iter().flatten().zip(end.iter().flatten()) {
                    prop_assert!((from - to).abs() < 1e-3, "{name}: {from} to {to}");
                }
            }
        }
    }

    /// Whatever is joined with whatever, a scene compiles to an error or runs and stays finite.
    #[test]
    fn every_combination_of_kind_and_components_runs_or_is_refused(
        kind in prop::sample::select(vec!["transform", "pointToPoint", "pointToSurface", "slideOnSurface", "weldBorders",
            "force", "match", "tearableSurface", "disableCollision", "collisionExclusion"]),
        first in prop::sample::select(vec!["a", "a.vtx[0:3]", "a.e[border]", "a.f[*]", "a.corners", "r", "r.f[0]"]),
        second in prop::sample::select(vec!["b", "b.vtx[2]", "b.e[*]", "b.f[1:2]", "b.border", "q"]),
        method in prop::sample::select(vec!["weld", "spring", "rubberBand"]),
        connection in 0..3,
        glue in prop::sample::select(vec![0.0, 0.1, 1.0]),
        bend: bool,
    ) {
        let nodes = format!(r#"{OBJECTS}
            "s": dynamicConstraint(type: {kind}, components: ["{first}", "{second}"], constraintMethod: {method},
                connectionMethod: {connection}, maxDistance: 0.6, glueStrength: {glue}, bend: {bend}, bendBreakAngle: 40)"#);
        let (scene, _) = read_scene_text(&of_nodes(&nodes, ""), Path::new("test.ron")).expect("it can be read");
        if let Ok(program) = compile(&scene) {
            for name in ["a", "b", "q"] {
                prop_assert!(places(&program, 3, name).iter().flatten().all(|x| x.is_finite() && x.abs() < 100.0));
            }
        }
    }
}

/// The folds among the links of the first frame.
fn folds(nodes: &str) -> usize {
    let program = program(&of_nodes(nodes, ""));
    let constraints = program.first_input().constraints.clone();
    let links = constraints.iter().flat_map(|constraint| constraint.formed.iter().flatten());
    links.filter(|link| link.fold().is_some()).count()
}

// EVIDENCE: N2.3-5  edges that are joined hinge, and resist folding where `bend` says so
#[test]
fn joined_edges_resist_folding_only_with_bend() {
    let seam = |more: &str| {
        format!(
            r#"{PAIR}"s": dynamicConstraint(type: weldBorders, components: ["a.e[border]", "b.e[border]"],
            maxDistance: 0.2, connectWithinComponent: false {more})"#
        )
    };
    assert_eq!(folds(&seam("")), 0);
    // Two pairs of edges, with the corners of quads behind either end.
    assert_eq!(folds(&seam(", bend: true")), 4);
    let edges = r#""s": dynamicConstraint(type: pointToPoint, components: ["a.e[border]", "b.e[border]"],
        connectionMethod: withinMaxDistance, maxDistance: 0.2, bend: true)"#;
    assert!(folds(&format!("{PAIR}{edges}")) >= 4);
    let points = format!(
        r#"{PAIR}"s": dynamicConstraint(components: ["a.vtx[2]", "b.vtx[0]"], type: weldBorders, bend: true)"#
    );
    let warnings = |nodes: &str| {
        let compiled = program(&of_nodes(nodes, ""));
        compiled.warnings().iter().map(|warning| warning.message.clone()).collect::<Vec<_>>()
    };
    assert_eq!(warnings(&points), ["`bend` of `s` has no effect: none of its components are edges"]);
    assert!(warnings(&seam(", bend: true")).is_empty());
}

#[test]
fn a_tearable_surface_keeps_the_bend_resistance_of_stiff_cloth_as_maya_creates_it() {
    let sheet = |bend: f64, more: &str| {
        format!(
            r#""n": nucleus(), "p": polyPlane(subdivisions: (2, 2)),
            "c": nCloth(inputMesh: "p", selfCollide: false, bendResistance: {bend}),
            "t": dynamicConstraint(type: tearableSurface, components: ["c"] {more})"#
        )
    };
    assert_eq!(folds(&sheet(0.1, "")), 0);
    assert_eq!(folds(&sheet(0.5, "")), 8, "four inner edges of quads");
    assert_eq!(folds(&sheet(0.5, ", bend: false")), 0);
    assert_eq!(folds(&sheet(0.1, ", bend: true")), 8);
}
