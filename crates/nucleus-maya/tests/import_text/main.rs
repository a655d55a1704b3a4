//! Parts of Maya scenes, each written in its test, become the nodes and values that Maya computes.

mod animated;
mod constraints;
mod deformers;
mod events;
mod histories;
mod unknown;

use std::collections::BTreeMap;
use std::path::Path;

use nucleus_graph::attributes::{n_cloth, n_particle, nucleus, particle, point_emitter, transform};
use nucleus_graph::scene::{read_scene_text, write_scene};
use nucleus_maya::animation::Evaluator;
use nucleus_maya::ascii::SourceText;
use nucleus_maya::scene::MayaScene;
use nucleus_maya::{ImportOptions, Imported, import_text};

/// An imported scene, and the text of its mesh files.
struct Read {
    imported: Imported,
    files: BTreeMap<String, String>,
}

fn read(body: &str) -> Read {
    read_at(Path::new("a.ma"), body)
}

/// Imports a scene that would lie at a path.
fn read_at(path: &Path, body: &str) -> Read {
    let mut files = BTreeMap::new();
    let mut options = ImportOptions::new("meshes", |name, text| {
        files.insert(name.to_owned(), text);
        Ok(())
    });
    let text = format!("//Maya ASCII 2022 scene\n{body}");
    let text = SourceText::from_bytes(path, text.into_bytes()).unwrap();
    let imported = import_text(text, &path.with_extension("ron"), &mut options).unwrap();
    drop(options);
    Read { imported, files }
}

impl Read {
    /// The text of the scene file.
    fn text(&self) -> String {
        write_scene(&self.imported.scene)
    }

    /// Whether an omission names something and gives a reason with a word.
    fn omits(&self, what: &str, word: &str) -> bool {
        self.imported.omissions.iter().any(|(own, cause)| own.contains(what) && cause.reason().contains(word))
    }

    /// Where a point of a node is at a frame.
    fn placed(&self, name: &str, point: [f64; 3], frame: f64) -> [f64; 3] {
        let graph = &self.imported.scene.graph;
        let id = graph.find(name).unwrap_or_else(|| panic!("no `{name}` in\n{}", self.text()));
        graph.placement(id, frame).point(point.into()).into()
    }

    /// Where the origin of a node is at a frame.
    fn origin(&self, name: &str, frame: f64) -> [f64; 3] {
        self.placed(name, [0.0; 3], frame)
    }
}

/// The written scene reads back to the same scene, without errors.
fn assert_round_trip(read: &Read) {
    let text = read.text();
    let (again, _) = read_scene_text(&text, Path::new("a.ron")).unwrap_or_else(|e| panic!("{e:?}\n{text}"));
    assert!(again == read.imported.scene, "{text}");
}

fn near(found: [f64; 3], expected: [f64; 3]) {
    let is_near = found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-9);
    assert!(is_near, "{found:?} is not {expected:?}");
}

/// A mesh that moves, so that its transform is carried over.
fn mesh(name: &str) -> String {
    format!(
        "createNode transform -n \"{name}\";\ncreateNode mesh -n \"{name}Shape\" -p \"{name}\";\n\
         createNode polyPlane -n \"{name}Plane\";\nconnectAttr \"{name}Plane.out\" \"{name}Shape.i\";\n"
    )
}

/// A cloth with constraints, each with one component: type, elements, and further values of its component node.
fn constrained_cloth(constraints: &[&str]) -> String {
    let mut text = mesh("sheet");
    text += "createNode nucleus -n \"n\";\ncreateNode transform -n \"c\";\ncreateNode nCloth -n \"cShape\" -p \"c\";\n\
             connectAttr \"sheetShape.w[0]\" \"cShape.imsh\";\nconnectAttr \"cShape.cust\" \"n.niao[0]\";\n\
             connectAttr \"cShape.stst\" \"n.nias[0]\";\n";
    for (k, component) in constraints.iter().enumerate() {
        text += &format!(
            "createNode transform -n \"k{k}\";\ncreateNode dynamicConstraint -n \"k{k}Shape\" -p \"k{k}\";\n\
             setAttr \".crr\" 0;\ncreateNode nComponent -n \"part{k}\";\n{component}\n\
             connectAttr \"k{k}Shape.evs[0]\" \"n.is[{k}]\";\nconnectAttr \"k{k}Shape.evc[0]\" \"n.ic[{k}]\";\n\
             connectAttr \"cShape.nuid\" \"part{k}.obid\";\nconnectAttr \"part{k}.ocp\" \"k{k}Shape.cid[0]\";\n"
        );
    }
    text
}

const POINT: &str = "setAttr \".ct\" 2; setAttr \".el\" 0; setAttr -s 1 \".ci[0]\" 5;";
const EDGES: &str = "setAttr \".ct\" 3; setAttr \".el\" 0; setAttr -s 2 \".ci[0:1]\" 1 2;";
const BORDER: &str = "setAttr \".ct\" 3; setAttr \".el\" 1;";
const FACES: &str = "setAttr \".ct\" 4; setAttr \".el\" 0; setAttr -s 2 \".ci[0:1]\" 0 1;";
const WHOLE: &str = "setAttr \".ct\" 6; setAttr \".el\" 2;";
const WEAK: &str = "setAttr \".ct\" 2; setAttr \".el\" 0; setAttr -s 1 \".ci[0]\" 7; setAttr \".stn\" 0.5;";

#[test]
fn components_of_every_kind_are_listed_in_the_short_form() {
    let read = read(&constrained_cloth(&[EDGES, POINT, BORDER, FACES, WHOLE]));
    let text = read.text();
    for listed in ["[\"c.e[1:2]\"]", "[\"c.vtx[5]\"]", "[\"c.e[border]\"]", "[\"c.f[0:1]\"]", "[\"c\"]"] {
        assert!(text.contains(listed), "{listed} is missing in\n{text}");
    }
    assert!(!text.contains("connections:"), "{text}");
    assert_round_trip(&read);
}

#[test]
fn elements_beyond_the_mesh_are_left_out_of_a_component() {
    // A polyPlane of 10 by 10 faces has 100 faces, 121 points and 2 * 11 * 10 edges.
    let list = |kind: u8, last: u32| {
        format!("setAttr \".ct\" {kind}; setAttr \".el\" 0; setAttr -s 3 \".ci[0:2]\" 0 {last} {};", last + 1)
    };
    let all = [list(2, 120), list(3, 219), list(4, 99)];
    let read = read(&constrained_cloth(&[&all[0], &all[1], &all[2]]));
    let text = read.text();
    for listed in ["\"c.vtx[0]\", \"c.vtx[120]\"]", "\"c.e[0]\", \"c.e[219]\"]", "\"c.f[0]\", \"c.f[99]\"]"] {
        assert!(text.contains(listed), "{listed} is missing in\n{text}");
    }
    for (part, kind) in [("part0", "points"), ("part1", "edges"), ("part2", "faces")] {
        let why = format!("1 of its {kind} are not in the mesh");
        assert!(read.omits(part, &why), "{}", read.imported.omissions);
    }
    assert_round_trip(&read);
}

#[test]
fn edges_of_a_component_are_those_that_the_file_stores() {
    // The file stores the edge 2 3 of the quad 0 1 2 3 first; its face names it third.
    let quad = "createNode mesh -n \"sheetShape\" -p \"sheet\";\nsetAttr -s 4 \".vt[0:3]\" 0 0 0 1 0 0 1 0 1 0 0 1;\n\
                setAttr -s 4 \".ed[0:3]\" 2 3 0 0 1 0 1 2 0 3 0 0;\n\
                setAttr -s 1 \".fc[0]\" -type \"polyFaces\" f 4 1 2 0 3;\n";
    let edge = "setAttr \".ct\" 3; setAttr \".el\" 0; setAttr -s 2 \".ci[0:1]\" 0 9;";
    let scene = constrained_cloth(&[edge]);
    let start = scene.find("createNode mesh").unwrap();
    let end = scene.find("createNode nucleus").unwrap();
    let read = read(&format!("{}{quad}{}", &scene[..start], &scene[end..]));
    assert!(read.text().contains("[\"c.e[2]\"]"), "{}", read.text());
    assert!(read.omits("part0", "1 of its edges"), "{}", read.imported.omissions);
    assert_round_trip(&read);
}

#[test]
fn a_component_node_with_values_of_its_own_stands_beside_constraints_in_short_form() {
    for all in [[WEAK, POINT, WHOLE], [POINT, WEAK, WHOLE], [POINT, WHOLE, WEAK]] {
        let read = read(&constrained_cloth(&all));
        let text = read.text();
        assert!(text.contains("strength: 0.5") && text.contains("[\"c.vtx[5]\"]"), "{text}");
        assert!(read.imported.omissions.iter().all(|(what, _)| what == "c"), "{}", read.imported.omissions);
        assert_round_trip(&read);
    }
}

/// A mesh whose transform is driven by a curve from 1 at frame 1 to 3 at frame 3, through a node.
fn driven(node: &str) -> Read {
    read(&format!(
        "{}createNode animCurveTU -n \"curve\";\nsetAttr \".tan\" 2; setAttr -s 2 \".ktv[0:1]\" 1 1 3 3;\n{node}",
        mesh("m")
    ))
}

#[test]
fn inputs_of_utility_nodes_may_be_stored_as_a_whole() {
    for (whole, kind) in [("i2", "float3"), ("input2", "double3")] {
        let read = driven(&format!(
            "createNode multiplyDivide -n \"md\";\nsetAttr \".{whole}\" -type \"{kind}\" 5 1 1;\n\
             connectAttr \"curve.o\" \"md.i1x\";\nconnectAttr \"md.ox\" \"m.tx\";"
        ));
        near(read.origin("m", 2.0), [10.0, 0.0, 0.0]);
    }
    let read = driven(
        "createNode clamp -n \"c\";\nsetAttr \".mx\" -type \"float3\" 9 2.5 9;\n\
         createNode reverse -n \"r\";\nsetAttr \".i\" -type \"float3\" 0 0 4;\nconnectAttr \"curve.o\" \"c.ipg\";\n\
         connectAttr \"c.opg\" \"m.ty\";\nconnectAttr \"r.oz\" \"m.tz\";",
    );
    near(read.origin("m", 2.0), [0.0, 2.0, -3.0]);
    near(read.origin("m", 3.0), [0.0, 2.5, -3.0]);
}

#[test]
fn outputs_of_utility_nodes_may_be_connected_as_a_whole() {
    let read = driven(
        "createNode multiplyDivide -n \"md\";\nsetAttr \".i1\" -type \"float3\" 1 7 1;\n\
         setAttr \".i2\" -type \"float3\" 5 1 1;\nconnectAttr \"curve.o\" \"md.i1x\";\nconnectAttr \"md.o\" \"m.t\";",
    );
    near(read.origin("m", 2.0), [10.0, 7.0, 1.0]);
    assert!(read.imported.omissions.is_empty(), "{}", read.imported.omissions);
}

#[test]
fn conversions_in_a_loop_are_listed_and_the_stored_value_stays() {
    let nodes = "createNode unitConversion -n \"a\";\ncreateNode unitConversion -n \"b\";\n\
                 createNode unitConversion -n \"own\";\nsetAttr \"m.t\" -type \"double3\" 3 4 5;\n\
                 connectAttr \"a.o\" \"b.i\";\nconnectAttr \"b.o\" \"a.i\";\nconnectAttr \"b.o\" \"m.tx\";\n\
                 connectAttr \"own.o\" \"own.i\";\nconnectAttr \"own.o\" \"m.ty\";\n";
    let read = read(&format!("{}{nodes}", mesh("m")));
    near(read.origin("m", 1.0), [3.0, 4.0, 5.0]);
    for driven in ["m.translateX", "m.translateY"] {
        assert!(read.omits(driven, "driven by a unitConversion"), "{}", read.imported.omissions);
    }
}

/// Forty nodes of a kind, each of which has the node before it at all its inputs: wires from `$a` to `$b`.
fn chain(kind: &str, wires: &str) -> String {
    let mut text = String::new();
    for k in 0..40 {
        text += &format!("createNode {kind} -n \"n{k}\";\n");
        if k > 0 {
            text += &wires.replace("$a", &format!("n{}", k - 1)).replace("$b", &format!("n{k}"));
        }
    }
    text
}

#[test]
fn a_chain_of_nodes_with_shared_inputs_is_evaluated_once_per_node() {
    // 2^39 times the curve, which is 2 at frame 2, and back.
    let sums = chain("addDoubleLinear", "connectAttr \"$a.o\" \"$b.i1\";\nconnectAttr \"$a.o\" \"$b.i2\";\n");
    let ends = format!(
        "createNode multDoubleLinear -n \"end\";\nsetAttr \".i2\" {};\nconnectAttr \"curve.o\" \"n0.i1\";\n\
         connectAttr \"n39.o\" \"end.i1\";\nconnectAttr \"end.o\" \"m.tx\";\n",
        2f64.powi(-39)
    );
    near(driven(&format!("{sums}{ends}")).origin("m", 2.0), [2.0, 0.0, 0.0]);

    // As a whole, component by component, and in turn. A mean of equal values is that value.
    let whole = "connectAttr \"$a.ot\" \"$b.it1\";\nconnectAttr \"$a.ot\" \"$b.it2\";\n";
    let parts: String = ["x", "y", "z"]
        .map(|part| whole.replace(".ot", &format!(".ot{part}")).replace("it", &format!("it{part}")))
        .concat();
    let mixed = "connectAttr \"$a.ot\" \"$b.it1\";\nconnectAttr \"$a.otx\" \"$b.itx2\";\n\
                 connectAttr \"$a.outTranslateY\" \"$b.ity2\";\n";
    for wires in [whole, &parts, mixed] {
        let blends = chain("pairBlend", &format!("{wires}setAttr \"$b.w\" 0.5;\n"));
        let ends = "setAttr \"n0.w\" 0;\nconnectAttr \"curve.o\" \"n0.itx1\";\nconnectAttr \"curve.o\" \"n0.ity1\";\n\
                    connectAttr \"n39.ot\" \"m.t\";\n";
        near(driven(&format!("{blends}{ends}")).origin("m", 2.0), [2.0, 2.0, 0.0]);
    }
}

#[test]
fn nodes_that_are_their_own_inputs_end_the_chain_of_evaluation() {
    for (kind, wires) in [
        (
            "addDoubleLinear",
            "connectAttr \"$a.o\" \"$a.i1\";\nconnectAttr \"$a.o\" \"$a.i2\";\nconnectAttr \"$a.o\" \"m.tx\";\n",
        ),
        (
            "multiplyDivide",
            "connectAttr \"$a.o\" \"$a.i1\";\nconnectAttr \"$a.o\" \"$a.i2\";\nconnectAttr \"$a.o\" \"m.t\";\n",
        ),
    ] {
        let loops = wires.replace("$a", "n");
        near(driven(&format!("createNode {kind} -n \"n\";\n{loops}")).origin("m", 2.0), [0.0; 3]);
    }
}

#[test]
fn a_chain_of_long_expressions_is_evaluated() {
    let sum = format!(".I[0]{}", "+1".repeat(900));
    let mut nodes = String::new();
    for k in 0..60 {
        nodes += &format!(
            "createNode expression -n \"e{k}\";\nsetAttr \".ixp\" -type \"string\" \".O[0] = {sum};\";\n"
        );
        let from = if k == 0 { "curve.o".to_owned() } else { format!("e{}.out[0]", k - 1) };
        nodes += &format!("connectAttr \"{from}\" \"e{k}.in[0]\";\n");
    }
    let read = driven(&format!("{nodes}connectAttr \"e59.out[0]\" \"m.tx\";\n"));
    near(read.origin("m", 2.0), [2.0 + 60.0 * 900.0, 0.0, 0.0]);
}

/// The transform of the mesh at frames 1 to 3, in the units of a file.
fn converted(units: &str, nodes: &str) -> [[[f64; 3]; 2]; 3] {
    let read = read(&format!("currentUnit {units};\n{}{nodes}", mesh("m")));
    let graph = &read.imported.scene.graph;
    let id = graph.find("m").unwrap();
    [1.0, 2.0, 3.0].map(|frame| {
        let at = graph.at(frame);
        [at.get(id, &transform::TRANSLATE), at.get(id, &transform::ROTATE)]
    })
}

/// Maya computes in centimetres, radians and ticks of 1/6000 s, and its conversions keep 1 in one unit 1 in the other.
#[test]
fn a_conversion_keeps_a_number_in_the_unit_of_the_other_attribute() {
    let expression = "createNode expression -n \"e\"; setAttr \".ixp\" -type \"string\" \".O[0] = frame * 10\";\n\
                      createNode unitConversion -n \"uc\";\nconnectAttr \"e.out[0]\" \"uc.i\";\n";
    let turned =
        format!("{expression}setAttr \"uc.cf\" 0.017453292519943295; connectAttr \"uc.o\" \"m.ry\";\n");
    let moved = format!("{expression}setAttr \"uc.cf\" 100; connectAttr \"uc.o\" \"m.ty\";\n");
    let found = converted("-l centimeter -a degree -t film", &turned);
    (0..3).for_each(|k| near(found[k][1], [0.0, 10.0 * (k + 1) as f64, 0.0]));
    // Ten units of length are ten metres.
    let found = converted("-l meter -a degree -t film", &moved);
    (0..3).for_each(|k| near(found[k][0], [0.0, 1000.0 * (k + 1) as f64, 0.0]));
}

#[test]
fn an_angle_that_drives_a_number_is_converted_to_the_unit_of_the_file() {
    let nodes = "createNode transform -n \"drv\"; setAttr \".r\" -type \"double3\" 0 90 0;\n\
                 createNode unitConversion -n \"uc\"; setAttr \".cf\" 57.295779513082323;\n\
                 createNode multiplyDivide -n \"md\"; setAttr \".i2\" -type \"float3\" 0.1 1 1;\n\
                 connectAttr \"drv.ry\" \"uc.i\"; connectAttr \"uc.o\" \"md.i1x\"; connectAttr \"md.ox\" \"m.ty\";\n";
    near(converted("-l centimeter -a degree -t film", nodes)[0][0], [0.0, 9.0, 0.0]);
    let whole = nodes.replace("md.ox\" \"m.ty", "uc2.o\" \"m.r").replace(
        "connectAttr \"drv.ry\"",
        "createNode unitConversion -n \"uc2\"; setAttr \".cf\" 0.017453292519943295; connectAttr \"md.o\" \"uc2.i\"; connectAttr \"drv.ry\"",
    );
    near(converted("-l centimeter -a degree -t film", &whole)[0][1], [9.0, 0.0, 0.0]);
}

#[test]
fn a_keyed_angle_keeps_its_degrees_through_a_conversion() {
    let nodes = "createNode animCurveTA -n \"a\"; setAttr \".tan\" 2; setAttr -s 2 \".ktv[0:1]\" 1 0 3 90;\n\
                 createNode unitConversion -n \"uc\"; setAttr \".cf\" 57.295779513082323;\n\
                 connectAttr \"a.o\" \"uc.i\"; connectAttr \"uc.o\" \"m.ty\";\n";
    near(converted("-l centimeter -a degree -t film", nodes)[1][0], [0.0, 45.0, 0.0]);
}

#[test]
fn a_time_that_drives_a_number_is_converted_to_frames() {
    for (rate, ticks) in [("film", 250.0), ("pal", 240.0)] {
        let nodes = format!(
            "createNode timeToUnitConversion -n \"tu\"; setAttr \".cf\" {};\n\
             createNode multiplyDivide -n \"md\"; setAttr \".i2\" -type \"float3\" 10 1 1;\n\
             connectAttr \":time1.o\" \"tu.i\"; connectAttr \"tu.o\" \"md.i1x\"; connectAttr \"md.ox\" \"m.ty\";\n",
            1.0 / ticks
        );
        let found = converted(&format!("-l centimeter -a degree -t {rate}"), &nodes);
        (0..3).for_each(|k| near(found[k][0], [0.0, 10.0 * (k + 1) as f64, 0.0]));
    }
}

#[test]
fn gaps_of_a_sparse_list_of_components_are_no_elements() {
    let sparse = "setAttr \".ct\" 2; setAttr \".el\" 0; setAttr -s 3 \".ci\"; setAttr \".ci[2]\" 3; setAttr \".ci[5:6]\" 5 6;";
    let read = read(&constrained_cloth(&[sparse]));
    assert!(read.text().contains("[\"c.vtx[3]\", \"c.vtx[5:6]\"]"), "{}", read.text());
}

/// A scene with a reference `A` to an asset, each given by its text.
fn referring(main: &str, asset: &str) -> Read {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("asset.ma"), format!("//Maya ASCII 2022 scene\n{asset}")).unwrap();
    let reference = "file -r -ns \"A\" -rfn \"ARN\" -typ \"mayaAscii\" \"asset.ma\";\n";
    read_at(&folder.path().join("main.ma"), &format!("{reference}{main}"))
}

/// A mesh `s` that a curve moves along x, from 1 at frame 0 to 3 at frame 24.
fn moving() -> String {
    format!(
        "{}setAttr \"s.ty\" 2;\nsetAttr \"s.rz\" 0.5;\ncreateNode animCurveTL -n \"s_tx\";\n\
         setAttr \".tan\" 2; setAttr -s 2 \".ktv[0:1]\" 0 1 24 3;\nconnectAttr \"s_tx.o\" \"s.tx\";\n",
        mesh("s")
    )
}

#[test]
fn a_referenced_file_has_its_own_units() {
    let main = "currentUnit -l centimeter -a degree -t film;\n";
    let read = referring(main, &format!("currentUnit -l meter -a radian -t ntscf;\n{}", moving()));
    near(read.origin("A:s", 0.0), [100.0, 200.0, 0.0]);
    // 24 frames of 1/60 s are 9.6 frames of 1/24 s.
    near(read.origin("A:s", 9.6), [300.0, 200.0, 0.0]);
    let tip = read.placed("A:s", [1.0, 0.0, 0.0], 0.0);
    near(tip, [100.0 + 0.5_f64.cos(), 200.0 + 0.5_f64.sin(), 0.0]);
}

#[test]
fn edits_and_curves_of_a_scene_are_in_its_own_units() {
    let main = "currentUnit -l centimeter -a degree -t film;\ncreateNode reference -n \"ARN\";\n\
                setAttr \".ed\" -type \"dataReferenceEdits\" \"ARN\" \"ARN\" 0 \"ARN\" 2\n\
                2 \"|A:s\" \"translateY\" \" 7\"\n5 4 \"ARN\" \"|A:s.translateZ\" \"ARN.placeHolderList[1]\" \"\";\n\
                createNode animCurveTL -n \"z\";\nsetAttr \".tan\" 2; setAttr -s 2 \".ktv[0:1]\" 0 4 10 4;\n\
                connectAttr \"z.o\" \"ARN.phl[1]\";\n";
    let read = referring(main, &format!("currentUnit -l meter -a degree -t film;\n{}", moving()));
    near(read.origin("A:s", 0.0), [100.0, 7.0, 4.0]);
}

#[test]
fn an_edit_of_a_reference_may_disconnect() {
    let edits = |edit: &str| {
        format!(
            "createNode reference -n \"ARN\";\nsetAttr \".ed\" -type \"dataReferenceEdits\" \"ARN\" \"ARN\" 0 \"ARN\" 1\n{edit};\n"
        )
    };
    let read = referring(&edits("3 \"A:s_tx.output\" \"|A:s.translateX\" \"\""), &moving());
    near(read.origin("A:s", 24.0), [0.0, 2.0, 0.0]);
    let read = referring(&edits("3 \"A:s_tx.message\" \"|A:s.translateX\" \"\""), &moving());
    near(read.origin("A:s", 24.0), [3.0, 2.0, 0.0]);
    assert!(read.omits("|A:s.translateX", "connection that no file holds"), "{}", read.imported.omissions);
}

#[test]
fn lengths_and_angles_of_emitters_and_cloths_are_converted() {
    let body = "currentUnit -l meter -a radian -t film;\ncreateNode nucleus -n \"n\";\n\
        createNode transform -n \"p\";\ncreateNode nParticle -n \"pShape\" -p \"p\";\n\
        connectAttr \"pShape.cust\" \"n.niao[0]\";\nconnectAttr \"pShape.stst\" \"n.nias[0]\";\n\
        createNode pointEmitter -n \"e\";\nsetAttr \".max\" 0.5; setAttr \".min\" 0.25; setAttr \".vsr\" 2; setAttr \".vsw\" 1;\n\
        connectAttr \"e.ot[0]\" \"pShape.npt[0]\";\n";
    let cloth = constrained_cloth(&[]).replace("createNode nucleus -n \"n\";\n", "");
    let cloth = cloth.replace("\"n.niao[0]\"", "\"n.niao[1]\"").replace("\"n.nias[0]\"", "\"n.nias[1]\"");
    let read = read(&format!("{body}{cloth}setAttr \"cShape.reae\" 2;\n"));
    let graph = &read.imported.scene.graph;
    let node = |name: &str| graph.node(graph.find(name).unwrap_or_else(|| panic!("{}", read.text())));
    assert_eq!(node("e").get(&point_emitter::MAX_DISTANCE), 50.0);
    assert_eq!(node("e").get(&point_emitter::MIN_DISTANCE), 25.0);
    assert_eq!(node("e").get(&point_emitter::SECTION_RADIUS), 200.0);
    assert_eq!(node("e").get(&point_emitter::VOLUME_SWEEP), 1.0_f64.to_degrees());
    assert_eq!(node("c").get(&n_cloth::RESTITUTION_ANGLE), 2.0_f64.to_degrees());
}

/// Two particles below a group at (0, 10, 0), whose own transform is at (5, 0, 0) and twice as large.
const PARTICLES: &str = "createNode nucleus -n \"n\";\ncreateNode transform -n \"grp\"; setAttr \".t\" -type \"double3\" 0 10 0;\n\
    createNode transform -n \"p\" -p \"grp\"; setAttr \".t\" -type \"double3\" 5 0 0; setAttr \".s\" -type \"double3\" 2 2 2;\n\
    createNode nParticle -n \"pShape\" -p \"p\"; setAttr \".pos0\" -type \"vectorArray\" 2 1 2 3 4 5 6;\n\
    setAttr \".vel0\" -type \"vectorArray\" 2 1 0 0 0 3 0;\n\
    connectAttr \"pShape.cust\" \"n.niao[0]\";\nconnectAttr \"pShape.stst\" \"n.nias[0]\";\n";

#[test]
fn particles_start_in_world_space() {
    let read = read(PARTICLES);
    let graph = &read.imported.scene.graph;
    let particles = graph.node(graph.find("p").unwrap());
    // Scaled by 2, then moved by 5 and by 10; a velocity is only scaled.
    assert_eq!(particles.get(&n_particle::POSITION0), [[7.0, 14.0, 6.0], [13.0, 20.0, 12.0]]);
    assert_eq!(particles.get(&n_particle::VELOCITY0), [[2.0, 0.0, 0.0], [0.0, 6.0, 0.0]]);
    assert!(read.imported.omissions.is_empty(), "{}", read.imported.omissions);
}

#[test]
fn particles_below_an_animated_transform_start_at_its_first_placement_and_are_listed() {
    let keys = "createNode animCurveTL -n \"a\"; setAttr \".tan\" 2; setAttr -s 2 \".ktv[0:1]\" 1 10 3 90;\n\
                connectAttr \"a.o\" \"grp.ty\";\n";
    let read = read(&format!("{PARTICLES}{keys}"));
    let graph = &read.imported.scene.graph;
    let particles = graph.node(graph.find("p").unwrap());
    assert_eq!(particles.get(&n_particle::POSITION0)[0], [7.0, 14.0, 6.0]);
    assert!(read.omits("p", "is animated"), "{}", read.imported.omissions);
}

#[test]
fn the_pivot_of_an_emitter_is_part_of_its_placement_and_no_omission() {
    let body = "createNode pointEmitter -n \"e\"; setAttr \".rp\" -type \"double3\" 1 0 0; setAttr \".sp\" -type \"double3\" 1 0 0;\n\
                setAttr \".rz\" 180; connectAttr \"e.ot[0]\" \"pShape.npt[0]\";\n";
    let read = read(&format!("{PARTICLES}{body}"));
    // Half a turn about (1, 0, 0) takes the origin to (2, 0, 0).
    near(read.origin("e", 1.0), [2.0, 0.0, 0.0]);
    assert!(read.imported.omissions.is_empty(), "{}", read.imported.omissions);
}

#[test]
fn a_field_or_an_emitter_that_particles_own_is_an_omission() {
    let others = "createNode transform -n \"q\";\ncreateNode nParticle -n \"qShape\" -p \"q\";\n\
        connectAttr \"qShape.cust\" \"n.niao[1]\";\nconnectAttr \"qShape.stst\" \"n.nias[1]\";\n\
        createNode radialField -n \"f\"; connectAttr \"f.of[0]\" \"qShape.ifc[0]\";\n\
        createNode pointEmitter -n \"e\"; connectAttr \"e.ot[0]\" \"qShape.npt[0]\";\n";
    let free = read(&format!("{PARTICLES}{others}"));
    assert!(free.imported.omissions.is_empty(), "{}", free.imported.omissions);
    for node in ["f", "e"] {
        let owned = format!(
            "connectAttr \"pShape.wps\" \"{node}.opd\"; connectAttr \"pShape.wvl\" \"{node}.ovd\";\n"
        );
        let owned = read(&format!("{PARTICLES}{others}{owned}"));
        let what = format!("{node}.ownerPosData");
        assert!(owned.omits(&what, "points of another object"), "{}", owned.imported.omissions);
    }
}

#[test]
fn instances_are_omissions() {
    let parent =
        "createNode transform -n \"second\";\nparent -s -nc -r -add \"|sheet|sheetShape\" \"second\";\n";
    let scene = constrained_cloth(&[]).replace("sheetShape.w[0]", "|sheet|sheetShape.w[1]");
    let read = read(&format!("{scene}{parent}"));
    assert!(read.omits("sheetShape", "the instance `second` is not read"), "{}", read.imported.omissions);
    assert!(
        read.omits("c", "the instance `sheetShape.worldMesh[1]` is not read"),
        "{}",
        read.imported.omissions
    );
}

/// A cloth whose rest shape is a second mesh, connected from an output of its shape.
fn with_rest_shape(output: &str, values: &str) -> Read {
    let wire = format!("connectAttr \"restShape.{output}\" \"cShape.rsmh\";\n{values}");
    read(&format!("{}{}{wire}", constrained_cloth(&[]), mesh("rest")))
}

#[test]
fn a_rest_shape_is_read_from_every_output_of_a_mesh() {
    let outputs = ["w", "w[0]", "worldMesh", "worldMesh[0]", "o", "outMesh", "wm[0]"];
    for output in outputs {
        let read = with_rest_shape(output, "");
        assert!(read.text().contains("restShapeMesh: \"rest\""), "{output}:\n{}", read.text());
        assert!(read.imported.omissions.is_empty(), "{output}: {}", read.imported.omissions);
        assert_round_trip(&read);
    }
}

#[test]
fn an_added_attribute_of_a_node_that_is_kept_drives_others() {
    let control = "addAttr -sn \"wind\" -ln \"wind\" -at \"double\" \"sheet\"; setAttr \"sheet.wind\" 7;\n\
                   connectAttr \"sheet.wind\" \"n.wisp\";\n";
    let read = read(&format!("{}{control}", constrained_cloth(&[])));
    let graph = &read.imported.scene.graph;
    assert_eq!(graph.node(graph.find("n").unwrap()).get(&nucleus::WIND_SPEED), 7.0, "{}", read.text());
    assert!(read.imported.omissions.is_empty(), "{}", read.imported.omissions);
}

#[test]
fn a_connection_that_cannot_be_made_is_an_omission() {
    let read = with_rest_shape("dispMap", "");
    assert!(read.omits("restShape.dispMap to c.restShapeMesh", "is not read"), "{}", read.imported.omissions);
    let second = with_rest_shape("w[1]", "");
    assert!(second.omits("c", "instance `restShape.worldMesh[1]`"), "{}", second.imported.omissions);
    let scaled = with_rest_shape("o", "setAttr \"rest.sx\" 2;\n");
    assert!(scaled.omits("c", "the scale of `restShape`"), "{}", scaled.imported.omissions);
}

#[test]
fn a_cache_that_is_switched_off_is_not_played_and_its_cycles_are_omissions() {
    let cache = |values: &str| {
        format!(
            "{}createNode cacheFile -n \"cf\";\n{values}\nconnectAttr \"cf.ir\" \"cShape.pfc\";\n",
            constrained_cloth(&[])
        )
    };
    let effect = |read: &Read| read.imported.omissions.to_string();
    let off = read(&cache("setAttr \".enable\" no;"));
    assert!(effect(&off).contains("it is simulated instead: its cache is switched off"), "{}", effect(&off));
    let cycles = read(&cache("setAttr \".hold\" 5; setAttr \".postCycle\" 1; setAttr \".reverse\" yes;"));
    for name in ["cf.hold", "cf.postCycle", "cf.reverse"] {
        assert!(cycles.omits(name, "forwards, once"), "{}", effect(&cycles));
    }
}

#[test]
fn shear_is_kept_where_rotation_and_scale_are_animated() {
    let body = format!(
        "{}setAttr \"m.rp\" -type \"double3\" 1 0 0; setAttr \"m.sp\" -type \"double3\" 0 2 0;\n\
         setAttr \"m.sh\" -type \"double3\" 0.5 -0.25 1;\ncreateNode animCurveTA -n \"rz\";\n\
         setAttr \".tan\" 2; setAttr -s 2 \".ktv[0:1]\" 1 0 11 90;\ncreateNode animCurveTU -n \"sx\";\n\
         setAttr \".tan\" 2; setAttr -s 2 \".ktv[0:1]\" 1 1 11 3;\n\
         connectAttr \"rz.o\" \"m.rz\";\nconnectAttr \"sx.o\" \"m.sx\";\n",
        mesh("m")
    );
    let text =
        SourceText::from_bytes(Path::new("a.ma"), format!("//Maya ASCII\n{body}").into_bytes()).unwrap();
    let maya = MayaScene::of_text(text).unwrap();
    let read = read(&body);
    for (frame, point) in [(1.0, [1.0, 2.0, 3.0]), (6.0, [-1.0, 0.5, 2.0]), (11.0, [0.0, 3.0, -1.0])] {
        let world = Evaluator::new(&maya).world(maya.find("m").unwrap(), frame);
        near(read.placed("m", point, frame), world.point(point));
    }
    assert!(read.imported.omissions.is_empty(), "{}", read.imported.omissions);
}
