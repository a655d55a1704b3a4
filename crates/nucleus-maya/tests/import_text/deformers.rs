//! Joints and blend shapes.

use crate::*;

/// A mesh below a joint at (3, 0, 0) of its parent, whose scale is 2. The joint leaves that scale out.
fn jointed(more: &str) -> String {
    let below =
        mesh("m").replace("createNode transform -n \"m\";", "createNode transform -n \"m\" -p \"j2\";");
    format!(
        "createNode joint -n \"j1\"; setAttr \".s\" -type \"double3\" 2 2 2;\n\
         createNode joint -n \"j2\" -p \"j1\"; setAttr \".t\" -type \"double3\" 3 0 0;\n{below}\
         connectAttr \"j1.s\" \"j2.is\";\n{more}"
    )
}

#[test]
fn a_joint_leaves_out_the_scale_of_its_parent() {
    // The translation is scaled by the parent, what is below the joint is not: 2 * 3 + 1.
    near(read(&jointed("")).placed("m", [1.0, 0.0, 0.0], 1.0), [7.0, 0.0, 0.0]);
    let off = read(&jointed("setAttr \"j2.ssc\" no;\n"));
    near(off.placed("m", [1.0, 0.0, 0.0], 1.0), [8.0, 0.0, 0.0]);
    let oriented = read(&jointed("setAttr \"j2.jo\" -type \"double3\" 0 0 90;\n"));
    near(oriented.placed("m", [1.0, 0.0, 0.0], 1.0), [6.0, 1.0, 0.0]);
}

#[test]
fn a_joint_leaves_out_an_animated_scale_of_its_parent_below_an_animated_rotation() {
    let curve = |kind: &str, name: &str, keys: &str| {
        format!(
            "createNode animCurve{kind} -n \"{name}\"; setAttr \".tan\" 2; setAttr -s 2 \".ktv[0:1]\" {keys};\n"
        )
    };
    let more = format!(
        "setAttr \"j2.jo\" -type \"double3\" 0 0 90;\n{}{}connectAttr \"r.o\" \"j2.rz\"; connectAttr \"s.o\" \"j1.sx\";\n",
        curve("TA", "r", "1 0 3 90"),
        curve("TU", "s", "1 2 3 4")
    );
    let read = read(&jointed(&more));
    // Only along x is the parent scaled by 2, 3 and 4; the joint turns by 90, 135 and 180 degrees.
    let half = 0.5_f64.sqrt();
    for (frame, expected) in [(1.0, [6.0, 1.0, 0.0]), (2.0, [9.0 - half, half, 0.0]), (3.0, [11.0, 0.0, 0.0])]
    {
        near(read.placed("m", [1.0, 0.0, 0.0], frame), expected);
    }
    assert!(read.imported.omissions.is_empty(), "{}", read.imported.omissions);
    assert_round_trip(&read);
}

/// A quad whose blend shape has a weight from 0 at frame 0 to 1 at frame 4.
fn blended(targets: &str) -> Read {
    read(&format!(
        "setAttr \"s.b\" -type \"string\" \"playbackOptions -min 0 -max 4 \";\n\
         createNode transform -n \"q\";\ncreateNode mesh -n \"base\" -p \"q\";\nsetAttr \".io\" yes;\n\
         setAttr -s 3 \".vt[0:2]\" 0 0 0 1 0 0 0 0 1;\nsetAttr -s 3 \".ed[0:2]\" 0 1 0 1 2 0 2 0 0;\n\
         setAttr -s 1 \".fc[0]\" -type \"polyFaces\" f 3 0 1 2;\ncreateNode mesh -n \"shown\" -p \"q\";\n\
         createNode blendShape -n \"bs\";\nsetAttr \".w[0]\" 0;\n{targets}\ncreateNode animCurveTU -n \"w\";\n\
         setAttr \".tan\" 2; setAttr -s 2 \".ktv[0:1]\" 0 0 4 1;\nconnectAttr \"w.o\" \"bs.w[0]\";\n\
         connectAttr \"base.w\" \"bs.ip[0].ig\";\nconnectAttr \"bs.og[0]\" \"shown.i\";\n"
    ))
}

/// The height of the first two points at a frame.
fn heights(read: &Read, frame: usize) -> [f64; 2] {
    let name = format!("meshes/q.{frame:04}.obj");
    let text = read.files.get(&name).unwrap_or_else(|| panic!("no {name} in {:?}", read.files.keys()));
    let points = text.lines().filter_map(|line| line.strip_prefix("v "));
    let all: Vec<f64> = points.map(|line| line.split(' ').nth(1).unwrap().parse().unwrap()).collect();
    [all[0], all[1]]
}

#[test]
fn a_blend_shape_passes_through_its_in_betweens() {
    let read = blended(
        "setAttr \".it[0].itg[0].iti[6000].ipt\" -type \"pointArray\" 1 0 2 0 1;\n\
         setAttr \".it[0].itg[0].iti[6000].ict\" -type \"componentList\" 1 \"vtx[0]\";\n\
         setAttr \".it[0].itg[0].iti[5500].ipt\" -type \"pointArray\" 1 0 5 0 1;\n\
         setAttr \".it[0].itg[0].iti[5500].ict\" -type \"componentList\" 1 \"vtx[0]\";",
    );
    let found: Vec<f64> = (1..=4).map(|frame| heights(&read, frame)[0]).collect();
    assert_eq!(found, [2.5, 5.0, 3.5, 2.0]);
}

#[test]
fn painted_weights_of_a_blend_shape_scale_its_targets() {
    let read = blended(
        "setAttr -s 2 \".it[0].itg[0].tw[0:1]\" 0.5 1;\nsetAttr \".it[0].bw[1]\" 0.25;\n\
         setAttr \".it[0].itg[0].iti[6000].ipt\" -type \"pointArray\" 2 0 2 0 1 0 2 0 1;\n\
         setAttr \".it[0].itg[0].iti[6000].ict\" -type \"componentList\" 1 \"vtx[0:1]\";",
    );
    assert_eq!(heights(&read, 4), [1.0, 0.5]);
}
