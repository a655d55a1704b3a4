//! Independence of nuclei, nodes, names and orders.

use nucleus_graph::attributes::{Kind, NodeType, Value, n_cloth, n_rigid, nucleus, poly_plane};
use nucleus_graph::compile::compile;
use nucleus_graph::graph::Setting;
use nucleus_graph::scene::read_scene_text;
use proptest::prelude::*;

use super::scenes::{after, gallery, of_nodes, program, scene};

/// A sheet over a ball. All names end in `end`.
fn sheet(end: &str, nucleus: &str, cloth: &str) -> String {
    format!(
        r#""n{end}": nucleus({nucleus}),
           "p{end}": polyPlane(width: 2, height: 2, subdivisions: (6, 6), translate: (0, 0.1, 0)),
           "c{end}": nCloth(inputMesh: "p{end}", nucleus: "n{end}", {cloth}),
           "b{end}": polySphere(radius: 0.5, subdivisions: (12, 8), translateY: keys([(1, -0.6), (6, -0.2)])),
           "r{end}": nRigid(inputMesh: "b{end}", nucleus: "n{end}"),
           "h{end}": dynamicConstraint(components: ["c{end}.vtx[0]"]),"#
    )
}

// EVIDENCE: N3.1-2  objects of another nucleus have no influence: every bit is the same without them
#[test]
fn objects_on_different_nuclei_never_affect_each_other() {
    let one = sheet("1", "windSpeed: 3", "");
    let alone = program(&of_nodes(&one, ""));
    let wild = "gravity: 50, subSteps: 7, spaceScale: 0.5, startFrame: 3, timeScale: 2";
    for other in [sheet("0", wild, "friction: 2"), sheet("2", wild, "thickness: 0.2")] {
        let both = program(&of_nodes(&(one.clone() + &other), ""));
        assert_eq!(both.nuclei().len(), 2);
        for object in ["c1", "r1"] {
            assert_eq!(after(&both, 6, object), after(&alone, 6, object), "{object}");
        }
    }
}

// EVIDENCE: N3.1-2  two cloths that would collide on one nucleus pass through each other on two
#[test]
fn each_nucleus_has_its_own_gravity_and_its_own_time() {
    let still = sheet("1", "gravity: 0, airDensity: 0", "");
    let falling = sheet("2", "", "ignoreSolverWind: true");
    let both = program(&of_nodes(&(still + &falling), ""));
    let height = |object: &str, frames| f32::from_bits(after(&both, frames, object)[20][1]);
    assert_eq!(height("c1", 1), height("c1", 0));
    assert!(height("c2", 3) < height("c2", 0));
}

// EVIDENCE: N3.1-3  an object can ignore the solver's gravity, and a field is connected to its target alone
#[test]
fn an_object_can_ignore_gravity_and_a_field_acts_on_one_object() {
    let nodes = r#""n": nucleus(airDensity: 0),
        "p1": polyPlane(), "c1": nCloth(inputMesh: "p1", ignoreSolverGravity: true),
        "p2": polyPlane(tx: 9), "c2": nCloth(inputMesh: "p2"), "f": turbulenceField(target: "c2")"#;
    let program = program(&of_nodes(nodes, ""));
    let (start, end) = (after(&program, 0, "c1"), after(&program, 2, "c1"));
    let moved = start.iter().flatten().zip(end.iter().flatten());
    // Rounding moves points at rest by less than a nanometre.
    assert!(moved.into_iter().all(|(a, b)| (f32::from_bits(*a) - f32::from_bits(*b)).abs() < 1e-9));
    assert_ne!(after(&program, 2, "c2"), after(&program, 0, "c2"));
    let graph = program.graph();
    let [field, c1, c2] = ["f", "c1", "c2"].map(|name| graph.find(name).expect(name));
    assert!(graph.leaving(field).all(|wire| wire.to.node == c2) && graph.leaving(field).count() == 1);
    assert!(graph.arriving(field).all(|wire| wire.from.node != c1));
}

// EVIDENCE: N3.1-7  objects are cloth, particles and colliders, and a collider is passive
#[test]
fn a_collider_is_moved_by_its_mesh_alone() {
    let nodes = r#""n": nucleus(), "p": polyCube(ty: 3), "r": nRigid(inputMesh: "p"), "q": nParticle()"#;
    let program = program(&of_nodes(nodes, ""));
    assert_eq!(after(&program, 3, "r"), after(&program, 0, "r"), "it does not fall");
    let wires: Vec<String> =
        program.graph().connections().map(|wire| program.graph().describe(wire.to)).collect();
    assert!(
        wires.contains(&"n.inputPassive[0]".to_owned()) && wires.contains(&"n.inputActive[0]".to_owned())
    );
}

// EVIDENCE: N3.1-2  only what is connected to the nucleus is solved
#[test]
fn nodes_that_are_not_connected_are_not_solved_and_change_nothing() {
    let nodes = sheet("1", "", "");
    let plain = program(&of_nodes(&nodes, ""));
    let more = nodes
        + r#""t": transform(tx: keys([(1, 0), (9, 9)])), "q": polyCube(), "f": turbulenceField(), "e": pointEmitter(),"#;
    let with_more = program(&of_nodes(&more, ""));
    assert_eq!(with_more.objects(), plain.objects());
    assert_eq!(after(&with_more, 4, "c1"), after(&plain, 4, "c1"));
}

#[test]
fn a_disconnected_graph_equals_one_that_was_never_connected() {
    let mut wired = scene(&of_nodes(&sheet("1", "", ""), r#"("b1.translateY", "c1.friction")"#));
    let plain = scene(&of_nodes(&sheet("1", "", ""), ""));
    assert_ne!(wired, plain);
    let [from, to] =
        ["b1.translateY", "c1.friction"].map(|plug| wired.graph.plug(plug).expect("it is there"));
    assert!(wired.graph.disconnect(from, to));
    assert_eq!(wired, plain);
    // A collider that is disconnected from its nucleus has no influence.
    for [from, to] in
        [["r1.currentState", "n1.inputPassive[0]"], ["r1.startState", "n1.inputPassiveStart[0]"]]
    {
        let [from, to] = [from, to].map(|plug| wired.graph.plug(plug).expect("it is there"));
        assert!(wired.graph.disconnect(from, to));
    }
    let never = sheet("1", "", "").replace(r#""r1": nRigid(inputMesh: "b1", nucleus: "n1"),"#, "");
    let (without, never) = (compile(&wired).expect("it runs"), program(&of_nodes(&never, "")));
    assert_eq!(after(&without, 4, "c1"), after(&never, 4, "c1"));
}

/// A scene in which an attribute of a node type is set to its default.
fn at_default(node_type: &'static NodeType, name: &str, value: &Value) -> Option<String> {
    let mut scene = scene(&of_nodes(&sheet("1", "", ""), ""));
    let (id, row) = {
        let (id, node) = scene.graph.iter().find(|(_, node)| node.node_type() == node_type)?;
        (id, node.node_type().attribute(name)?)
    };
    // Without a setting, these are computed from the mesh or the scene's time.
    if ["thickness", "startFrame", "selfCollisionFlag", "selfCollideWidthScale"].contains(&name)
        || scene.graph.node(id).settings().contains_key(name)
    {
        return None;
    }
    scene.graph.set(id, row, Setting::from(value.clone())).expect("a default fits");
    let program = compile(&scene).expect("it runs");
    Some(format!("{:?} {:?}", program.model(), program.first_input()))
}

#[test]
fn an_attribute_at_its_default_equals_the_attribute_left_out() {
    let plain = program(&of_nodes(&sheet("1", "", ""), ""));
    let plain = format!("{:?} {:?}", plain.model(), plain.first_input());
    let mut compared = 0;
    for node_type in [&nucleus::NUCLEUS, &n_cloth::N_CLOTH, &n_rigid::N_RIGID, &poly_plane::POLY_PLANE] {
        for row in node_type.attributes() {
            let Some(value) = &row.default else { continue };
            if matches!(row.kind, Kind::Components) || row.name == "preset" {
                continue;
            }
            let Some(set) = at_default(node_type, row.name, value) else { continue };
            assert!(set == plain, "{}.{}", node_type.name, row.name);
            compared += 1;
        }
    }
    assert!(compared > 500, "{compared}");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn names_and_orders_do_not_change_a_bit(
        names in prop::collection::hash_set("[a-z][a-zA-Z0-9_]{0,6}", 7),
        order in Just((0..7).collect::<Vec<usize>>()).prop_shuffle(),
        turned in any::<bool>(),
    ) {
        let names: Vec<String> = names.into_iter().filter(|name| name != "time1").collect();
        prop_assume!(names.len() == 7);
        let [n, p, c, b, r, h, t] = [0, 1, 2, 3, 4, 5, 6].map(|k| names[k].as_str());
        let text = |names: [&str; 7], order: &[usize], turned: bool| {
            let [n, p, c, b, r, h, t] = names;
            let nodes = [
                format!(r#""{n}": nucleus()"#),
                format!(r#""{p}": polyPlane(width: 2, height: 2, subdivisions: (5, 5), parent: "{t}")"#),
                format!(r#""{c}": nCloth(inputMesh: "{p}")"#),
                format!(r#""{b}": polySphere(radius: 0.5, translateY: keys([(1, -0.6), (5, -0.3)]))"#),
                format!(r#""{r}": nRigid(inputMesh: "{b}")"#),
                format!(r#""{h}": dynamicConstraint(components: ["{c}.vtx[0:2]"], parent: "{t}")"#),
                format!(r#""{t}": transform(ty: keys([(1, 0.1), (9, 0.5)]))"#),
            ];
            let nodes: Vec<&str> = order.iter().map(|&k| nodes[k].as_str()).collect();
            let mut wires =
                [format!(r#"("{b}.translateY", "{c}.lift")"#), format!(r#"("{t}.tx", "{r}.friction")"#)];
            if turned {
                wires.reverse();
            }
            of_nodes(&nodes.join(", "), &wires.join(", "))
        };
        let given = program(&text([n, p, c, b, r, h, t], &order, turned));
        let plain = program(&text(["n", "p", "c", "b", "r", "h", "t"], &[0, 1, 2, 3, 4, 5, 6], false));
        prop_assert_eq!(after(&given, 4, c), after(&plain, 4, "c"));
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(5))]

    #[test]
    fn names_of_cloths_that_collide_do_not_change_a_bit(
        names in Just(["a", "b", "c", "d", "e", "f"].to_vec()).prop_shuffle()
    ) {
        let text = |names: &[&str]| {
            // Two sheets fall on a third, which lies on a ball and in a bowl; and one is twice in the same place.
            let cloth = |k: usize, nodes: &str| format!(r#""m{0}": {nodes}, "{0}": nCloth(inputMesh: "m{0}""#, names[k]);
            let sheet = |y: f64| format!("polyPlane(width: 1, height: 1, subdivisions: (5, 5), translate: (0, {y}, 0), rotate: (0, {}, 0))", 90.0 * y);
            let nodes = [
                cloth(0, &sheet(0.31)) + ")",
                cloth(1, &sheet(0.34)) + ")",
                cloth(2, &sheet(0.37)) + ", friction: 0.4)",
                cloth(3, &sheet(0.37)) + ", friction: 0.2, thickness: 0.01, collisionLayer: 9)",
            ];
            let rigid = |k: usize, mesh: &str| format!(r#""m{0}": {mesh}, "{0}": nRigid(inputMesh: "m{0}")"#, names[k]);
            let rigids = [
                rigid(4, "polySphere(radius: 0.3)"),
                rigid(5, "polyCube(width: 0.3, height: 0.3, depth: 0.3, translate: (0.3, 0.12, 0))"),
            ];
            of_nodes(&format!(r#""n": nucleus(evaluations: 12), {}, {}"#, nodes.join(", "), rigids.join(", ")), "")
        };
        let plain = ["a", "b", "c", "d", "e", "f"];
        let (given, known) = (program(&text(&names)), program(&text(&plain)));
        for k in 0..4 {
            prop_assert_eq!(after(&given, 6, names[k]), after(&known, 6, plain[k]), "{}", plain[k]);
        }
    }
}

#[test]
fn the_scenes_of_the_gallery_are_written_in_short_form_and_read_back_equal() {
    for (path, text) in gallery() {
        let (scene, _) = read_scene_text(&text, &path).unwrap_or_else(|mistakes| panic!("{mistakes:#?}"));
        let written = nucleus_graph::scene::format_scene(&scene, &text);
        assert!(!written.contains("connections:"), "{written}");
        let (again, _) = read_scene_text(&written, &path).unwrap_or_else(|mistakes| panic!("{mistakes:#?}"));
        assert_eq!(again, scene, "{}", path.display());
        let comments = |text: &str| text.matches("//").count();
        assert_eq!(comments(&written), comments(&text), "{}: no comment is lost", path.display());
    }
}
