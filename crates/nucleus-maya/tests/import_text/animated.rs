//! Animation that a scene of ours holds in another form, or not at all, and values that it does not take.

use nucleus_graph::attributes::n_base;

use super::*;

/// A curve with a linear tangent from a value at frame 1 to one at frame 11, connected to a plug.
fn curve(name: &str, [from, to]: [f64; 2], plug: &str) -> String {
    format!(
        "createNode animCurveTU -n \"{name}\";\nsetAttr \".tan\" 2; setAttr -s 2 \".ktv[0:1]\" 1 {from} 11 {to};\n\
         connectAttr \"{name}.o\" \"{plug}\";\n"
    )
}

#[test]
fn animated_shear_moves_a_mesh_as_in_maya() {
    let body = format!(
        "{}setAttr \"m.rp\" -type \"double3\" 1 0 0; setAttr \"m.sp\" -type \"double3\" 0 2 0;\n\
         setAttr \"m.s\" -type \"double3\" 2 1 0.5; setAttr \"m.shxz\" -0.25;\n{}{}",
        mesh("m"),
        curve("xy", [0.0, 3.0], "m.shxy"),
        curve("yz", [1.0, -1.0], "m.shyz"),
    );
    let text =
        SourceText::from_bytes(Path::new("a.ma"), format!("//Maya ASCII\n{body}").into_bytes()).unwrap();
    let maya = MayaScene::of_text(text).unwrap();
    let read = read(&body);
    let values = Evaluator::new(&maya);
    for (frame, point) in [(1.0, [1.0, 2.0, 3.0]), (4.0, [-1.0, 0.5, 2.0]), (11.0, [0.0, 3.0, -1.0])] {
        let world = values.world(maya.find("m").unwrap(), frame);
        near(read.placed("m", point, frame), world.point(point));
    }
    assert!(read.imported.omissions.is_empty(), "{}", read.imported.omissions);
    assert_round_trip(&read);
}

#[test]
fn animated_shear_that_starts_at_zero_is_carried_over() {
    let keys = curve("xy", [0.0, 1.0], "m.shxy") + &curve("yz", [0.0, 0.0], "m.shyz");
    let read = read(&format!("{}{keys}", mesh("m")));
    assert_eq!(read.text().matches("transform(").count(), 3, "none for keys of zero: {}", read.text());
    near(read.placed("m", [0.0, 2.0, 0.0], 1.0), [0.0, 2.0, 0.0]);
    near(read.placed("m", [0.0, 2.0, 0.0], 11.0), [2.0, 2.0, 0.0]);
    // Between two frames, the parts of the shear are interpolated.
    let [x, y, z] = read.placed("m", [0.0, 2.0, 0.0], 5.5);
    assert!((x - 0.9).abs() < 1e-3 && (y - 2.0).abs() < 1e-3 && z.abs() < 1e-9, "{x} {y} {z}");
}

#[test]
fn animated_pivots_that_start_at_zero_are_listed() {
    let read = read(&format!("{}{}", mesh("m"), curve("rx", [0.0, 1.0], "m.rpx")));
    assert!(read.omits("m.rotatePivot", "stay as they are"), "{}", read.imported.omissions);
}

#[test]
fn keys_on_an_attribute_that_is_read_once_are_listed() {
    let cloth = constrained_cloth(&[]);
    let read = read(&format!("{cloth}{}", curve("k", [-8.0, 2.0], "cShape.pmss")));
    assert!(read.omits("c.pointMass", "read once"), "{}", read.imported.omissions);
    let early = "playbackOptions -min 9 -max 11;\ncreateNode script -n \"sceneConfigurationScriptNode\";\n\
                 setAttr \".b\" -type \"string\" \"playbackOptions -min 9 -max 11 -ast 9 -aet 11 \";\n";
    let late = super::read(&format!(
        "{cloth}{early}setAttr \"n.stf\" 9;\n{}",
        curve("k", [1.0, 3.0], "cShape.pmss")
    ));
    let graph = &late.imported.scene.graph;
    let mass = graph.node(graph.find("c").unwrap()).get(&n_base::POINT_MASS);
    assert!((mass - 2.6).abs() < 1e-9, "{mass} in\n{}", late.text());
}

#[test]
fn values_outside_the_range_of_an_attribute_are_listed() {
    let read = read(&format!(
        "{}setAttr \"cShape.fron\" -0.5; setAttr \"cShape.pmss\" 0;\n\
         setAttr \"n.sstp\" 0; setAttr \"n.spsc\" 0; setAttr \"n.mcit\" 7;\n",
        constrained_cloth(&[])
    ));
    for (what, why) in [
        ("c.friction", "-0.5 is not valid here: 0 takes"),
        ("c.pointMass", "0 is not valid here: 0.001 takes"),
        ("n.subSteps", "0 is not valid here: 1 takes"),
        ("n.spaceScale", "0 is not valid here: 1 takes"),
    ] {
        assert!(read.omits(what, why), "{what}: {}", read.imported.omissions);
    }
    assert_eq!(read.imported.omissions.len(), 4, "{}", read.imported.omissions);
    assert!(!read.text().contains("liftInSceneUnits"), "a unit is a metre: {}", read.text());
    assert_round_trip(&read);
}

#[test]
fn keys_on_the_width_of_a_plane_make_a_mesh_for_each_frame() {
    let read = read(&format!("{}{}", mesh("m"), curve("k", [1.0, 3.0], "mPlane.w")));
    let first = |frame: u32| {
        let text = &read.files[&format!("meshes/m.{frame:04}.obj")];
        text.lines().find(|line| line.starts_with("v ")).unwrap().to_owned()
    };
    assert_eq!(first(1), "v -0.5 0 0.5");
    assert_eq!(first(11), "v -1.5 0 0.5");
    assert!(read.text().contains("meshes/m.####.obj"), "{}", read.text());
    assert!(read.imported.omissions.is_empty(), "{}", read.imported.omissions);
}

#[test]
fn keys_on_counts_and_operators_of_a_history_are_listed() {
    let body = format!("{}{}", mesh("m"), curve("k", [1.0, 3.0], "mPlane.sw"));
    let read = read(&body);
    assert!(read.omits("mPlane.sw", "animCurveTU"), "{}", read.imported.omissions);
    let extruded = "createNode polyPlane -n \"p\";\ncreateNode polyExtrudeFace -n \"e\";\n\
                    setAttr \".ics\" -type \"componentList\" 1 \"f[*]\";\nconnectAttr \"p.out\" \"e.ip\";\n\
                    createNode transform -n \"m\";\ncreateNode mesh -n \"mShape\" -p \"m\";\n\
                    connectAttr \"e.out\" \"mShape.i\";\n";
    let read = super::read(&format!("{extruded}{}", curve("k", [0.0, 1.0], "e.ltz")));
    assert!(read.omits("e.ltz", "animCurveTU"), "{}", read.imported.omissions);
}
