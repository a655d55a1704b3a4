//! Values pulled along connections.

use nucleus_graph::attributes::{n_base, n_cloth, nucleus, transform};

use super::scenes::{of_nodes, program, scene};

#[test]
fn an_input_has_the_value_of_its_source_converted_to_its_own_kind() {
    let scene = scene(&of_nodes(
        r#""a": transform(tx: keys([(1, 0), (11, 5)]), ty: 0.6, tz: -3),
           "n": nucleus(), "p": polyPlane(), "c": nCloth(inputMesh: "p", friction: 9)"#,
        r#"("a.tx", "c.friction"), ("a.tx", "n.subSteps"), ("a.ty", "c.collide"), ("a.tz", "c.bounce"),
           ("a.t", "n.windDirection"), ("a.tx", "p.rotateY"), ("a.tz", "c.scalingRelation")"#,
    ));
    let node = |name| scene.graph.find(name).expect(name);
    let at = scene.graph.at(5.0);
    assert_eq!(at.get(node("c"), &n_base::FRICTION), 2.0);
    assert_eq!(at.get(node("n"), &nucleus::SUB_STEPS), 2);
    assert!(at.get(node("c"), &n_base::COLLIDE));
    assert_eq!(at.get(node("c"), &n_base::BOUNCE), 0.0, "kept in its hard range");
    assert_eq!(at.get(node("n"), &nucleus::WIND_DIRECTION), [2.0, 0.6, -3.0]);
    assert_eq!(at.get(node("p"), &transform::ROTATE), [0.0, 2.0, 0.0]);
    assert_eq!(at.get(node("c"), &n_cloth::SCALING_RELATION).0, 0, "the nearest word");
    assert_eq!(scene.graph.at(1.0).get(node("n"), &nucleus::SUB_STEPS), 1);
    assert!(scene.graph.moves(node("p")) && scene.graph.changes(node("c"), &n_base::FRICTION));
}

#[test]
fn values_pass_along_chains_of_nodes() {
    let long: String = (0..500).map(|k| format!("\"t{k}\": transform(), ")).collect();
    let wires: String = (1..500).map(|k| format!("(\"t{}.tx\", \"t{k}.tx\"), ", k - 1)).collect();
    let scene = scene(&of_nodes(
        &format!("\"n\": nucleus(), {long}"),
        &format!("(\"time1.outTime\", \"t0.tx\"), {wires}"),
    ));
    let last = scene.graph.find("t499").expect("it is there");
    assert_eq!(scene.graph.at(7.25).get(last, &transform::TRANSLATE)[0], 7.25);
}

// EVIDENCE: N2.4-6  animation is evaluated once per frame, and only where a value is needed
#[test]
fn a_frame_evaluates_only_the_nodes_that_it_needs() {
    let nodes = r#""n": nucleus(), "p": polyPlane(), "c": nCloth(inputMesh: "p"),
        "b": polySphere(ty: keys([(1, -3), (9, -2)])), "r": nRigid(inputMesh: "b"),
        "pin": dynamicConstraint(components: ["c.vtx[0]"], tx: keys([(1, 0), (9, 1)])),
        "idle": transform(tx: keys([(1, 0), (9, 1)]), parent: "alone"), "alone": transform(ty: keys([(1, 0), (9, 1)]))"#;
    let program = program(&of_nodes(nodes, ""));
    let names: Vec<String> =
        program.pulled(3).iter().map(|id| program.graph().node(*id).name().to_owned()).collect();
    // The solver's own values first, then colliders, then cloth, then constraints.
    assert_eq!(names, ["n", "b", "r", "c", "pin"]);
}
