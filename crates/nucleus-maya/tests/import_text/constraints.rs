//! The type of a constraint, by what its attributes do.

use nucleus_graph::attributes::{Choice, dynamic_constraint as con};
use nucleus_graph::compile::defaults_by_type;

use super::{Read, assert_round_trip, read};

/// Two cloths, joined by a constraint between components: the values of the constraint, and for each component its cloth
/// and values.
fn joined(values: &str, parts: &[(&str, &str)]) -> Read {
    let mut text = "createNode nucleus -n \"n\";\n".to_owned();
    for (k, name) in ["a", "b"].iter().enumerate() {
        text += &format!(
            "createNode transform -n \"{name}Mesh\";\n\tsetAttr \".ty\" {k};\n\
             createNode mesh -n \"{name}MeshShape\" -p \"{name}Mesh\";\ncreateNode polyPlane -n \"{name}Plane\";\n\
             \tsetAttr \".sw\" 3; setAttr \".sh\" 3;\n\
             connectAttr \"{name}Plane.out\" \"{name}MeshShape.i\";\ncreateNode transform -n \"{name}\";\n\
             createNode nCloth -n \"{name}Shape\" -p \"{name}\";\n\
             connectAttr \"{name}MeshShape.w[0]\" \"{name}Shape.imsh\";\n\
             connectAttr \"{name}Shape.cust\" \"n.niao[{k}]\";\nconnectAttr \"{name}Shape.stst\" \"n.nias[{k}]\";\n"
        );
    }
    text += &format!(
        "createNode transform -n \"k\";\ncreateNode dynamicConstraint -n \"kShape\" -p \"k\";\n{values}\n\
         connectAttr \"kShape.evs[0]\" \"n.is[0]\";\nconnectAttr \"kShape.evc[0]\" \"n.ic[0]\";\n"
    );
    for (k, (cloth, part)) in parts.iter().enumerate() {
        text += &format!(
            "createNode nComponent -n \"part{k}\";\n{part}\nconnectAttr \"{cloth}Shape.nuid\" \"part{k}.obid\";\n\
             connectAttr \"part{k}.ocp\" \"kShape.cid[{k}]\";\n"
        );
    }
    read(&text)
}

const POINTS: &str = "setAttr \".ct\" 2; setAttr -s 4 \".ci[0:3]\" 0 1 2 3;";
const ALL_POINTS: &str = "setAttr \".ct\" 2; setAttr \".el\" 2;";
const BORDER: &str = "setAttr \".ct\" 3; setAttr \".el\" 1;";
const WHOLE: &str = "setAttr \".ct\" 6; setAttr \".el\" 2;";
const EDGES: &str = "setAttr \".ct\" 3; setAttr -s 2 \".ci[0:1]\" 1 2;";

fn type_of(read: &Read) -> String {
    let graph = &read.imported.scene.graph;
    let Choice(kind) = graph.node(graph.find("k").unwrap()).get(&con::CONSTRAINT_TYPE);
    let words = con::CONSTRAINT_TYPE.row.words();
    words.into_iter().find(|(index, _)| index.0 == kind).unwrap().1
}

#[test]
fn a_weld_between_components_joins_them_in_pairs_and_does_not_break() {
    for relation in [1, 2] {
        let values = format!("setAttr \".cm\" 0; setAttr \".cmr\" {relation}; setAttr \".cnm\" 2;");
        let read = joined(&values, &[("a", POINTS), ("b", POINTS)]);
        assert_eq!(type_of(&read), "pointToPoint");
        let graph = &read.imported.scene.graph;
        let node = graph.node(graph.find("k").unwrap());
        assert_eq!(node.get(&con::CONSTRAINT_METHOD), Choice(0));
        assert_eq!(node.get(&con::COMPONENT_RELATION), Choice(relation));
        assert_eq!(node.get(&con::CONNECTION_METHOD), Choice(2));
        assert_eq!((node.get(&con::GLUE_STRENGTH), node.get(&con::MAX_DISTANCE)), (1.0, 0.1));
        assert!(!node.get(&con::CONNECT_WITHIN_COMPONENT));
        assert_round_trip(&read);
    }
}

const TEARS: &str = "setAttr \".cm\" 0; setAttr \".cmr\" 1; setAttr \".cnm\" 1; setAttr \".cwc\" yes; \
                     setAttr \".gls\" 0.1; setAttr \".mds\" 0.01;";

#[test]
fn a_surface_tears_where_its_own_points_are_welded_and_the_welds_break() {
    assert_eq!(type_of(&joined(TEARS, &[("a", ALL_POINTS)])), "tearableSurface");
    let without = |value: &str| {
        assert!(TEARS.contains(value));
        type_of(&joined(&TEARS.replace(value, ""), &[("a", ALL_POINTS)]))
    };
    for value in
        ["setAttr \".gls\" 0.1;", "setAttr \".cwc\" yes;", "setAttr \".cnm\" 1;", "setAttr \".cm\" 0;"]
    {
        assert_eq!(without(value), "pointToPoint", "without {value}");
    }
    assert_eq!(type_of(&joined(TEARS, &[("a", ALL_POINTS), ("b", ALL_POINTS)])), "pointToPoint");
}

#[test]
fn a_mesh_that_maya_has_split_to_tear_is_held_by_pairs() {
    let text = "createNode polySplitVert -n \"split\";\n\tsetAttr \".ics\" -type \"componentList\" 1 \"vtx[*]\";\n\
                connectAttr \"aPlane.out\" \"split.ip\";\nconnectAttr \"split.out\" \"aMeshShape.i\";\n";
    let read = joined(&format!("{TEARS}\n{text}"), &[("a", ALL_POINTS)]);
    assert_eq!(read.files["meshes/aMesh.obj"].lines().filter(|line| line.starts_with("v ")).count(), 36);
    assert_eq!(type_of(&read), "pointToPoint");
}

#[test]
fn surfaces_borders_and_matching_points_have_types_of_their_own() {
    let of = |values: &str, parts: &[(&str, &str)]| type_of(&joined(values, parts));
    assert_eq!(of("", &[("a", WHOLE), ("b", POINTS)]), "pointToSurface");
    assert_eq!(of("setAttr \".cu\" 1;", &[("a", WHOLE), ("b", POINTS)]), "slideOnSurface");
    assert_eq!(of("setAttr \".cu\" 1;", &[("a", WHOLE), ("a", POINTS)]), "pointToSurface");
    assert_eq!(of("setAttr \".cu\" 1; setAttr \".cmr\" 1;", &[("a", POINTS), ("b", POINTS)]), "pointToPoint");
    assert_eq!(of("", &[("a", EDGES), ("b", POINTS)]), "pointToPoint", "an edge is no surface");
    let weld = "setAttr \".cm\" 0; setAttr \".cmr\" 1; setAttr \".cnm\" 1;";
    assert_eq!(of(weld, &[("a", BORDER), ("b", BORDER)]), "weldBorders");
    assert_eq!(of("setAttr \".rls\" 0;", &[("a", ALL_POINTS), ("b", ALL_POINTS)]), "match");
    assert_eq!(of("setAttr \".rls\" 0;", &[("a", POINTS), ("b", ALL_POINTS)]), "pointToPoint");
    assert_eq!(of("setAttr \".excs\" yes; setAttr \".str\" 0;", &[("a", ALL_POINTS)]), "pointToPoint");
}

#[test]
fn what_a_file_leaves_out_has_the_default_of_the_node_in_every_type() {
    let scenes = [
        joined("", &[("a", POINTS), ("b", POINTS)]),
        joined("setAttr \".cu\" 1;", &[("a", WHOLE), ("b", POINTS)]),
        joined("setAttr \".crr\" 0; setAttr \".str\" 0; setAttr \".for\" 2;", &[("a", ALL_POINTS)]),
        joined("setAttr \".crr\" 0; setAttr \".str\" 0; setAttr \".excs\" yes;", &[("a", ALL_POINTS)]),
        joined("setAttr \".rls\" 0;", &[("a", ALL_POINTS), ("b", ALL_POINTS)]),
        joined(TEARS, &[("a", ALL_POINTS)]),
    ];
    for read in scenes {
        let (graph, kind) = (&read.imported.scene.graph, type_of(&read));
        let node = graph.node(graph.find("k").unwrap());
        for row in con::DYNAMIC_CONSTRAINT.attributes() {
            if defaults_by_type(&con::DYNAMIC_CONSTRAINT, row).iter().any(|(of, _)| *of == kind) {
                assert!(node.settings().contains_key(row.name), "{} of {kind}", row.name);
            }
        }
        assert_round_trip(&read);
    }
    let force = joined("setAttr \".crr\" 0; setAttr \".str\" 0; setAttr \".for\" 2;", &[("a", ALL_POINTS)]);
    assert!(force.text().contains("strengthDropoff: [(0, 1)]"), "{}", force.text());
}
