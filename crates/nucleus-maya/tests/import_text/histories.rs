//! Construction histories.

use crate::*;

/// A mesh `m` that the last of these nodes, `end`, makes.
fn made(nodes: &str) -> Read {
    let shape = "createNode transform -n \"m\";\ncreateNode mesh -n \"mShape\" -p \"m\";\nconnectAttr \"end.out\" \"mShape.i\";\n";
    read(&format!("{nodes}{shape}"))
}

/// How many points and faces the mesh file has.
fn size_of_mesh(read: &Read) -> [usize; 2] {
    let text = read.files.get("meshes/m.obj").unwrap_or_else(|| panic!("{}", read.imported.omissions));
    ["v ", "f "].map(|start| text.lines().filter(|line| line.starts_with(start)).count())
}

const ONE_FACE: &str = "createNode polyPlane -n \"n0\";\nsetAttr \".sw\" 1; setAttr \".sh\" 1;\n";

#[test]
fn a_primitive_of_too_many_points_is_refused_before_they_are_made() {
    let primitives = [
        ("polyTorus", "setAttr \".sa\" 1000000; setAttr \".sh\" 1000000;"),
        ("polyCone", "setAttr \".sa\" 1000000; setAttr \".sh\" 1000000;"),
        ("polyPipe", "setAttr \".sa\" 1000000; setAttr \".sh\" 1000000;"),
        ("polyHelix", "setAttr \".sa\" 1000000; setAttr \".c\" 10000; setAttr \".sco\" 1000000;"),
    ];
    for (kind, values) in primitives {
        let read = made(&format!("createNode {kind} -n \"end\";\n{values}\n"));
        assert!(read.omits("m", "20 million points"), "{kind}: {}", read.imported.omissions);
    }
}

#[test]
fn a_mesh_that_flows_into_several_inputs_is_built_once() {
    // Forty unions of the mesh before with itself. Of the two faces of a union, one is deleted.
    let mut nodes = ONE_FACE.to_owned();
    for k in 1..=40 {
        let (before, name) = (k - 1, if k == 40 { "end".to_owned() } else { format!("n{k}") });
        nodes += &format!(
            "createNode polyUnite -n \"u{k}\";\nconnectAttr \"n{before}.out\" \"u{k}.ip[0]\";\n\
             connectAttr \"n{before}.out\" \"u{k}.ip[1]\";\ncreateNode deleteComponent -n \"{name}\";\n\
             setAttr \".dc\" -type \"componentList\" 1 \"f[1]\";\nconnectAttr \"u{k}.out\" \"{name}.ip\";\n"
        );
    }
    assert_eq!(size_of_mesh(&made(&nodes)), [4, 1]);
}

#[test]
fn a_history_that_leads_back_to_itself_is_refused() {
    let read = made(
        "createNode polyUnite -n \"end\";\nconnectAttr \"end.out\" \"end.ip[0]\";\nconnectAttr \"end.out\" \"end.ip[1]\";\n",
    );
    assert!(read.omits("m", "is a cycle"), "{}", read.imported.omissions);
}

#[test]
fn ten_thousand_faces_are_extruded_apart() {
    let nodes = "createNode polyPlane -n \"p\";\nsetAttr \".sw\" 100; setAttr \".sh\" 100;\n\
                 createNode polyExtrudeFace -n \"end\";\nsetAttr \".kft\" no; setAttr \".tk\" 1;\n\
                 setAttr \".ics\" -type \"componentList\" 1 \"f[*]\";\nconnectAttr \"p.out\" \"end.ip\";\n";
    assert_eq!(size_of_mesh(&made(nodes)), [101 * 101 + 4 * 10_000, 5 * 10_000]);
}

#[test]
fn an_edge_without_a_face_is_not_subdivided() {
    for operator in ["polySmoothFace", "polySubdFace"] {
        let read = made(&format!(
            "createNode mesh -n \"quad\"; setAttr \".vt[0:3]\" 0 0 0 1 0 0 1 0 1 0 0 1;\n\
             setAttr \".ed[0:4]\" 0 1 0 1 2 0 2 3 0 3 0 0 0 2 0; setAttr \".fc[0]\" -type \"polyFaces\" f 4 0 1 2 3;\n\
             createNode {operator} -n \"end\"; setAttr \".ics\" -type \"componentList\" 1 \"f[*]\";\n\
             connectAttr \"quad.o\" \"end.ip\";\n"
        ));
        assert_eq!(size_of_mesh(&read), [9, 4], "{operator}");
    }
}
