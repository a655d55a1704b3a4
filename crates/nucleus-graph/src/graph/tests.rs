use super::*;
use crate::animation::{Curve, Key, Tangent};
use crate::attributes::{
    Choice, Component, Selection, Value, dynamic_constraint, mesh, n_cloth, n_component, n_rigid, nucleus,
    particle, poly_plane, transform,
};

fn keys(keys: &[(f64, f64)]) -> Curve {
    let key = |&(frame, value)| Key { frame, value, tangent: Tangent::Linear };
    Curve::new(keys.iter().map(key).collect()).expect("keys in order")
}

/// A nucleus, a plane and a cloth without connections.
fn sheet() -> (Graph, NodeId, NodeId, NodeId) {
    let mut graph = Graph::new();
    let cloth = graph.add("cloth1", &n_cloth::N_CLOTH).expect("free");
    let nucleus = graph.add("nucleus1", &nucleus::NUCLEUS).expect("free");
    let plane = graph.add("sheet", &poly_plane::POLY_PLANE).expect("free");
    (graph, cloth, nucleus, plane)
}

fn wires(graph: &Graph) -> Vec<(String, String)> {
    graph.connections().map(|wire| (graph.describe(wire.from), graph.describe(wire.to))).collect()
}

fn expect_wires(graph: &Graph, expected: &[(&str, &str)]) {
    let mut found = wires(graph);
    let mut expected: Vec<_> = expected.iter().map(|&(a, b)| (a.to_owned(), b.to_owned())).collect();
    found.sort();
    expected.sort();
    assert_eq!(found, expected);
}

#[test]
fn a_cloth_is_connected_as_maya_connects_it() {
    let (mut graph, cloth, nucleus, plane) = sheet();
    graph.create_cloth(cloth, plane, nucleus).expect("not wired yet");
    expect_wires(
        &graph,
        &[
            ("time1.outTime", "nucleus1.currentTime"),
            ("time1.outTime", "cloth1.currentTime"),
            ("sheet.worldMesh[0]", "cloth1.inputMesh"),
            ("cloth1.outputMesh", "outputCloth1.inMesh"),
            ("cloth1.currentState", "nucleus1.inputActive[0]"),
            ("cloth1.startState", "nucleus1.inputActiveStart[0]"),
            ("nucleus1.outputObjects[0]", "cloth1.nextState"),
            ("nucleus1.startFrame", "cloth1.startFrame"),
        ],
    );
}

#[test]
fn a_collider_is_connected_as_maya_connects_it() {
    let (mut graph, _, nucleus, plane) = sheet();
    let collider = graph.add("rigid1", &n_rigid::N_RIGID).expect("free");
    graph.create_collider(collider, plane, nucleus).expect("not wired yet");
    expect_wires(
        &graph,
        &[
            ("time1.outTime", "nucleus1.currentTime"),
            ("time1.outTime", "rigid1.currentTime"),
            ("sheet.worldMesh[0]", "rigid1.inputMesh"),
            ("rigid1.currentState", "nucleus1.inputPassive[0]"),
            ("rigid1.startState", "nucleus1.inputPassiveStart[0]"),
            ("nucleus1.startFrame", "rigid1.startFrame"),
        ],
    );
}

#[test]
fn a_constraint_gets_one_component_node_per_member() {
    let (mut graph, cloth, nucleus, plane) = sheet();
    graph.create_cloth(cloth, plane, nucleus).expect("not wired yet");
    let before = wires(&graph);
    let pin = graph.add("pin", &dynamic_constraint::DYNAMIC_CONSTRAINT).expect("free");
    let part = |first, last| Component { object: "cloth1".into(), selection: Selection::points(first, last) };
    graph.create_constraint(pin, &[part(4, 4), part(0, 2)], nucleus).expect("not wired yet");
    let found: Vec<_> = wires(&graph).into_iter().filter(|wire| !before.contains(wire)).collect();
    let mut expected = [
        ("cloth1.nucleusId", "nComponent1.objectId"),
        ("nComponent1.outComponent", "pin.componentIds[0]"),
        ("time1.outTime", "pin.currentTime"),
        ("pin.evalStart[0]", "nucleus1.inputStart[0]"),
        ("pin.evalCurrent[0]", "nucleus1.inputCurrent[0]"),
    ]
    .map(|(a, b)| (a.to_owned(), b.to_owned()));
    expected.sort();
    let mut found = found;
    found.sort();
    assert_eq!(found, expected);
    let member = graph.node(graph.find("nComponent1").expect("it was made"));
    assert_eq!(member.get(&n_component::COMPONENT_INDICES), [4, 0, 1, 2]);
    assert_eq!(member.get(&n_component::COMPONENT_TYPE), Choice(2));
    assert_eq!(member.created_by(), Some(pin));
}

#[test]
fn the_next_object_takes_the_next_index_on_all_three_plugs() {
    let (mut graph, cloth, nucleus, plane) = sheet();
    let second = graph.add("cloth2", &n_cloth::N_CLOTH).expect("free");
    graph.create_cloth(cloth, plane, nucleus).expect("not wired yet");
    graph.create_cloth(second, plane, nucleus).expect("not wired yet");
    let found = wires(&graph);
    for (from, to) in [
        ("cloth2.currentState", "nucleus1.inputActive[1]"),
        ("cloth2.startState", "nucleus1.inputActiveStart[1]"),
        ("nucleus1.outputObjects[1]", "cloth2.nextState"),
        ("cloth2.outputMesh", "outputCloth2.inMesh"),
    ] {
        assert!(found.contains(&(from.to_owned(), to.to_owned())), "{from} -> {to}");
    }
    let clocks = found.iter().filter(|(_, to)| to == "nucleus1.currentTime").count();
    assert_eq!(clocks, 1);
}

#[test]
fn created_nodes_take_the_next_free_name() {
    let (mut graph, cloth, nucleus, plane) = sheet();
    graph.add("outputCloth1", &mesh::MESH).expect("free");
    graph.create_cloth(cloth, plane, nucleus).expect("not wired yet");
    assert!(wires(&graph).contains(&("cloth1.outputMesh".into(), "outputCloth2.inMesh".into())));
}

#[test]
fn an_input_takes_one_connection() {
    let (mut graph, cloth, nucleus, plane) = sheet();
    graph.create_cloth(cloth, plane, nucleus).expect("not wired yet");
    let error = graph.create_cloth(cloth, plane, nucleus).expect_err("it is wired");
    assert_eq!(
        error,
        GraphError::InputTaken { input: "cloth1.currentTime".into(), source_plug: "time1.outTime".into() }
    );
}

#[test]
fn a_setting_that_does_not_fit_its_attribute_is_refused() {
    let (mut graph, cloth, ..) = sheet();
    let row = &n_cloth::BEND_RESISTANCE.row;
    for value in [Value::Bool(true), Value::Float(-1.0), Value::Float(f64::NAN), Value::Int(2)] {
        let error = graph.set(cloth, row, Setting::Fixed(value)).expect_err("does not fit");
        assert_eq!(error, GraphError::NotAdmitted { node: "cloth1".into(), attribute: "bendResistance" });
    }
    let error = graph.set(cloth, &nucleus::GRAVITY.row, Setting::Fixed(Value::Float(1.0)));
    assert!(matches!(error, Err(GraphError::NoAttribute { .. })), "{error:?}");
    assert!(matches!(graph.add("cloth1", &n_cloth::N_CLOTH), Err(GraphError::NameTaken { .. })));
}

// EVIDENCE: N3.1-9  an inherited attribute that is hidden on cloth can be set and read
#[test]
fn hidden_attributes_can_be_set_and_read() {
    let (mut graph, cloth, ..) = sheet();
    let row = &particle::LIFESPAN_MODE.row;
    assert!(graph.node(cloth).node_type().keeps_from_view(row));
    graph.set(cloth, row, Setting::Fixed(Value::Choice(Choice(2)))).expect("it can be written");
    assert_eq!(graph.node(cloth).get(&particle::LIFESPAN_MODE), Choice(2));
}

#[test]
fn a_cycle_of_parents_is_refused() {
    let mut graph = Graph::new();
    let [a, b, c] = ["a", "b", "c"].map(|name| graph.add(name, &transform::TRANSFORM).expect("free"));
    graph.set_parent(b, a).expect("no cycle");
    graph.set_parent(c, b).expect("no cycle");
    assert!(matches!(graph.set_parent(a, c), Err(GraphError::ParentCycle { .. })));
    assert!(matches!(graph.set_parent(a, a), Err(GraphError::ParentCycle { .. })));
}

#[test]
fn a_parent_has_a_transform_and_the_clock_has_none() {
    let (mut graph, cloth, _, mesh) = sheet();
    let node = graph.add("node", &transform::TRANSFORM).expect("free");
    let error = graph.set_parent(node, cloth);
    assert!(matches!(error, Err(GraphError::NoTransform { .. })), "{error:?}");
    assert_eq!(graph.set_parent(graph.clock(), node), Err(GraphError::Clock));
    assert_eq!(graph.node(node).parent(), None);
    graph.set_parent(mesh, node).expect("a mesh in a transform");
}

#[test]
fn only_meshes_are_blended() {
    let (mut graph, cloth, _, mesh) = sheet();
    for [one, other] in [[mesh, cloth], [cloth, mesh]] {
        let error = graph.blend_into(one, other);
        assert!(matches!(error, Err(GraphError::NoMesh { .. })), "{error:?}");
    }
}

#[test]
fn a_change_of_a_node_that_is_gone_is_refused() {
    let (mut graph, cloth, nucleus, mesh) = sheet();
    graph.create_cloth(cloth, mesh, nucleus).expect("not wired yet");
    let wire = *graph.leaving(cloth).next().expect("a cloth is connected to its nucleus");
    graph.remove(cloth);
    let row = &n_cloth::BEND_RESISTANCE.row;
    assert_eq!(graph.set(cloth, row, Value::Float(1.0).into()), Err(GraphError::NoNode));
    assert_eq!(graph.rename(cloth, "other"), Err(GraphError::NoNode));
    assert_eq!(graph.apply_preset(cloth, &[]), Err(GraphError::NoNode));
    assert_eq!(graph.set_parent(cloth, mesh), Err(GraphError::NoNode));
    assert_eq!(graph.set_parent(mesh, cloth), Err(GraphError::NoNode));
    assert_eq!(graph.blend_into(mesh, cloth), Err(GraphError::NoNode));
    assert_eq!(graph.connect(wire.from, wire.to), Err(GraphError::NoNode));
    let mut other = Graph::new();
    other.remove(nucleus);
    assert_eq!(other, Graph::new(), "a node of another graph is none of this one");
}

#[test]
fn keyed_values_are_converted_to_the_kind_of_the_attribute() {
    let (mut graph, cloth, nucleus, _) = sheet();
    let ramp = Setting::Keyed(keys(&[(1.0, 1.0), (5.0, 3.0)]));
    graph.set(nucleus, &nucleus::SUB_STEPS.row, ramp).expect("fits");
    graph
        .set(cloth, &n_cloth::IGNORE_SOLVER_WIND.row, Setting::Keyed(keys(&[(1.0, 0.0), (3.0, 1.0)])))
        .expect("fits");
    let at = |frame| graph.node(nucleus).at(&nucleus::SUB_STEPS, frame);
    assert_eq!([at(0.0), at(3.0), at(9.0)], [1, 2, 3]);
    let at = |frame| graph.node(cloth).at(&n_cloth::IGNORE_SOLVER_WIND, frame);
    assert_eq!([at(1.0), at(1.5), at(2.0), at(3.0)], [false, false, true, true]);
}

#[test]
fn a_spline_that_overshoots_the_hard_range_is_clamped() {
    let (mut graph, cloth, ..) = sheet();
    let spline = |frame, value| Key { frame, value, tangent: Tangent::Spline };
    let curve =
        Curve::new(vec![spline(0.0, 9.0), spline(1.0, 0.0), spline(9.0, 0.0)]).expect("keys in order");
    assert!((20..80).any(|tenth| curve.value_at(f64::from(tenth) / 10.0) < 0.0));
    graph.set(cloth, &n_cloth::BEND_RESISTANCE.row, Setting::Keyed(curve)).expect("its keys fit");
    for tenth in 0..90 {
        assert!(graph.node(cloth).at(&n_cloth::BEND_RESISTANCE, f64::from(tenth) / 10.0) >= 0.0);
    }
}

#[test]
fn a_child_is_placed_in_the_space_of_its_parent() {
    let mut graph = Graph::new();
    let arm = graph.add("arm", &transform::TRANSFORM).expect("free");
    let hand = graph.add("hand", &transform::TRANSFORM).expect("free");
    graph.set_parent(hand, arm).expect("no cycle");
    graph.set(hand, &transform::TRANSLATE.row, Value::Vector([2.0, 0.0, 0.0]).into()).expect("fits");
    let turn = [Channel::Fixed(0.0), Channel::Fixed(0.0), Channel::Keyed(keys(&[(0.0, 0.0), (10.0, 90.0)]))];
    graph.set(arm, &transform::ROTATE.row, Setting::Parts(turn)).expect("fits");
    assert_eq!(graph.placement(hand, 0.0).offset.as_slice(), [2.0, 0.0, 0.0]);
    assert_eq!(graph.placement(hand, 10.0).offset.as_slice(), [0.0, 2.0, 0.0]);
    assert!(graph.moves(hand) && graph.moves(arm));
}

#[test]
fn a_creation_command_takes_the_first_free_number_and_the_first_free_index() {
    let mut graph = Graph::new();
    let nucleus = graph.add("nucleus1", &nucleus::NUCLEUS).expect("free");
    let cloths: Vec<NodeId> = (0..4)
        .map(|k| {
            let cloth = graph.add(&format!("cloth{k}"), &n_cloth::N_CLOTH).expect("free");
            let plane = graph.add(&format!("sheet{k}"), &poly_plane::POLY_PLANE).expect("free");
            graph.create_cloth(cloth, plane, nucleus).expect("not wired yet");
            cloth
        })
        .collect();
    let of = |graph: &Graph| -> Vec<(String, u32)> {
        let objects = graph.elements(nucleus, &nucleus::INPUT_ACTIVE).into_iter();
        objects.map(|(index, plug)| (graph.node(plug.node).name().to_owned(), index)).collect()
    };
    let all = |names: [&str; 4]| names.iter().map(|name| (*name).to_owned()).zip(0..).collect::<Vec<_>>();
    assert_eq!(of(&graph), all(["cloth0", "cloth1", "cloth2", "cloth3"]));
    graph.remove(cloths[1]);
    assert!(graph.find("outputCloth2").is_none());
    let cloth = graph.add("late", &n_cloth::N_CLOTH).expect("free");
    let plane = graph.find("sheet1").expect("it is not removed with the cloth");
    graph.create_cloth(cloth, plane, nucleus).expect("not wired yet");
    assert_eq!(of(&graph), all(["cloth0", "late", "cloth2", "cloth3"]));
    let output = graph.find("outputCloth2").expect("the free number is taken again");
    assert_eq!(graph.node(output).created_by(), Some(cloth));
}
