//! The invariants of a graph hold after any sequence of changes.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use nucleus_graph::animation::{Curve, Key, Tangent};
use nucleus_graph::attributes::{
    Attribute, Component, ElementKind, Kind, NodeType, Selection, Which, node_types,
};
use nucleus_graph::checks::Check;
use nucleus_graph::compile::compile;
use nucleus_graph::graph::{CLOCK, Connection, Creation, Graph, NodeId, Plug, Setting};
use nucleus_graph::scene::{Record, Scene, Source, TimeSpan, read_scene_text, write_scene};
use proptest::prelude::*;
use proptest::sample::Index;
use proptest_state_machine::{ReferenceStateMachine, StateMachineTest, prop_state_machine};

/// A change of a graph. Its nodes and attributes are chosen among the existing ones.
#[derive(Debug, Clone)]
enum Change {
    Add { name: String, node_type: Index },
    Create { node: Index, other: Index, nucleus: Index },
    Rename { node: Index, name: String },
    Remove { node: Index },
    Parent { node: Index, parent: Index },
    Connect { plugs: [PlugChoice; 2] },
    Disconnect { connection: Index },
    Set { node: Index, row: Index },
    Key { node: Index, row: Index, values: [f64; 2] },
    Unset { node: Index, setting: Index },
}

#[derive(Debug, Clone)]
struct PlugChoice {
    node: Index,
    row: Index,
    index: Option<u32>,
    part: Option<usize>,
}

/// The names of nodes and their types: the reference model.
#[derive(Debug, Clone)]
struct Names(BTreeMap<String, &'static str>);

fn names() -> impl Strategy<Value = String> {
    // Few enough to collide often.
    "[a-d][1-3]?"
}

fn plugs() -> impl Strategy<Value = PlugChoice> {
    let index = prop::option::weighted(0.4, 0..3u32);
    (any::<Index>(), any::<Index>(), index, prop::option::weighted(0.2, 0..3usize))
        .prop_map(|(node, row, index, part)| PlugChoice { node, row, index, part })
}

fn changes() -> impl Strategy<Value = Change> {
    let i = any::<Index>;
    prop_oneof![
        4 => (names(), i()).prop_map(|(name, node_type)| Change::Add { name, node_type }),
        4 => (i(), i(), i()).prop_map(|(node, other, nucleus)| Change::Create { node, other, nucleus }),
        1 => (i(), names()).prop_map(|(node, name)| Change::Rename { node, name }),
        1 => i().prop_map(|node| Change::Remove { node }),
        1 => (i(), i()).prop_map(|(node, parent)| Change::Parent { node, parent }),
        6 => [plugs(), plugs()].prop_map(|plugs| Change::Connect { plugs }),
        2 => i().prop_map(|connection| Change::Disconnect { connection }),
        2 => (i(), i()).prop_map(|(node, row)| Change::Set { node, row }),
        2 => (i(), i(), [-9.0..9.0, -9.0..9.0]).prop_map(|(node, row, values)| Change::Key { node, row, values }),
        1 => (i(), i()).prop_map(|(node, setting)| Change::Unset { node, setting }),
    ]
}

impl ReferenceStateMachine for Names {
    type State = Self;
    type Transition = Change;

    fn init_state() -> BoxedStrategy<Self> {
        Just(Self(BTreeMap::from([(CLOCK.to_owned(), "time")]))).boxed()
    }

    fn transitions(_: &Self) -> BoxedStrategy<Change> {
        changes().boxed()
    }

    fn apply(mut state: Self, change: &Change) -> Self {
        if let Change::Add { name, node_type } = change {
            state.0.entry(name.clone()).or_insert(node_type.get(node_types()).name);
        }
        state
    }
}

/// The graph under test.
struct Whole(Graph);

fn pick(graph: &Graph, index: &Index) -> NodeId {
    let all: Vec<NodeId> = graph.iter().map(|(id, _)| id).collect();
    *index.get(&all)
}

fn plug(graph: &Graph, choice: &PlugChoice) -> Plug {
    let node = pick(graph, &choice.node);
    let rows: Vec<&'static Attribute> = graph.node(node).node_type().attributes();
    Plug {
        node,
        attribute: choice.row.get::<&'static Attribute>(&rows),
        index: choice.index,
        part: choice.part,
    }
}

impl StateMachineTest for Whole {
    type SystemUnderTest = Self;
    type Reference = Names;

    fn init_test(_: &Names) -> Self {
        Self(Graph::new())
    }

    fn apply(Self(mut graph): Self, names: &Names, change: Change) -> Self {
        let before = graph.clone();
        let refused = match change {
            Change::Add { name, node_type } => {
                let added = graph.add(&name, node_type.get::<&'static NodeType>(node_types()));
                assert!(added.is_ok() || before.find(&name).is_some());
                assert!(names.0.contains_key(&name));
                added.is_err()
            }
            Change::Create { node, other, nucleus } => {
                let [node, other, nucleus] = [&node, &other, &nucleus].map(|index| pick(&graph, index));
                create(&mut graph, node, other, nucleus);
                false
            }
            Change::Rename { node, name } => {
                let node = pick(&graph, &node);
                graph.rename(node, &name).is_err()
            }
            Change::Remove { node } => {
                let node = pick(&graph, &node);
                graph.remove(node);
                assert!(graph.get(node).is_none() || node == graph.clock());
                false
            }
            Change::Parent { node, parent } => {
                let [node, parent] = [&node, &parent].map(|index| pick(&graph, index));
                let transform = |id| graph.node(id).node_type().lineage().any(|t| t.name == "transform");
                if transform(node) && transform(parent) {
                    graph.set_parent(node, parent).is_err()
                } else {
                    false
                }
            }
            Change::Connect { plugs } => {
                let [from, to] = plugs.each_ref().map(|choice| plug(&graph, choice));
                let done = graph.connect(from, to).is_ok();
                if done {
                    let mut undone = graph.clone();
                    assert!(undone.disconnect(from, to));
                    let wires = |graph: &Graph| pairs(graph).into_iter().collect::<Vec<_>>();
                    assert_eq!(wires(&undone), wires(&before), "as if never connected");
                }
                !done
            }
            Change::Disconnect { connection } => {
                let all: Vec<Connection> = graph.connections().copied().collect();
                if !all.is_empty() {
                    let wire = connection.get(&all);
                    assert!(graph.disconnect(wire.from, wire.to));
                    assert!(!graph.disconnect(wire.from, wire.to));
                }
                false
            }
            Change::Set { node, row } => {
                let node = pick(&graph, &node);
                let row = *row.get(&graph.node(node).node_type().attributes());
                match &row.default {
                    Some(value) if is_settable(row) => {
                        graph.set(node, row, Setting::from(value.clone())).expect("a default fits");
                        false
                    }
                    _ => false,
                }
            }
            Change::Key { node, row, values } => {
                let node = pick(&graph, &node);
                let row = *row.get(&graph.node(node).node_type().attributes());
                let key = |frame, value| Key { frame, value, tangent: Tangent::Auto };
                let curve = Curve::new(vec![key(1.0, values[0]), key(9.0, values[1])]).expect("in order");
                is_settable(row) && graph.set(node, row, Setting::Keyed(curve)).is_err()
            }
            Change::Unset { node, setting } => {
                let node = pick(&graph, &node);
                let set: Vec<&'static str> = graph.node(node).settings().keys().copied().collect();
                if !set.is_empty() {
                    let row = graph
                        .node(node)
                        .node_type()
                        .attribute(setting.get::<&'static str>(&set))
                        .expect("it is set");
                    assert!(graph.unset(node, row));
                }
                false
            }
        };
        if refused {
            assert_eq!(graph, before, "a refused change changes nothing");
        }
        Self(graph)
    }

    fn check_invariants(Self(graph): &Self, _: &Names) {
        names_are_found(graph);
        inputs_have_one_source(graph);
        connections_fit(graph);
        no_plug_depends_on_itself(graph);
        reads_back(graph);
    }
}

/// All attributes but those that need a creation command or name a file.
fn is_settable(row: &Attribute) -> bool {
    !matches!(row.kind, Kind::Components | Kind::Together(_))
        && !["preset", "file", "startFrame"].contains(&row.name)
}

/// Runs the creation command that fits the node.
fn create(graph: &mut Graph, node: NodeId, other: NodeId, nucleus: NodeId) {
    let is = |id: NodeId, name: &str| {
        graph.node(id).node_type().lineage().any(|base: &NodeType| base.name == name)
    };
    let creation = if is(node, "dynBase") && is(other, "nParticle") {
        Creation::Effect { target: other }
    } else if !is(nucleus, "nucleus") {
        return;
    } else if is(node, "nParticle") {
        Creation::Object { mesh: None, nucleus }
    } else if is(node, "nBase") && is(other, "surfaceShape") {
        Creation::Object { mesh: Some(other), nucleus }
    } else if is(node, "dynamicConstraint") && is(other, "nBase") {
        let object = graph.node(other).name().to_owned();
        let kinds = ElementKind::WORDS.map(|(_, kind)| kind);
        let which = [Which::All, Which::Border, Which::Range(0, 2), Which::Where("x > 0".to_owned())];
        let choice = graph.iter().count();
        let selection = Selection::Elements(kinds[choice % 3], which[choice % 4].clone());
        let components = vec![Component { object, selection }];
        Creation::Constraint { components, nucleus }
    } else {
        return;
    };
    if let Creation::Constraint { components, .. } = &creation {
        let row = graph.node(node).node_type().attribute("components").expect("a constraint has it");
        let held = nucleus_graph::attributes::Value::Components(components.clone());
        graph.set(node, row, Setting::Fixed(held)).expect("it fits");
    }
    // A creation that fails halfway leaves ordinary connections.
    let _ = graph.create(node, &creation);
}

fn pairs(graph: &Graph) -> BTreeSet<[String; 2]> {
    graph.connections().map(|wire| [graph.describe(wire.from), graph.describe(wire.to)]).collect()
}

fn names_are_found(graph: &Graph) {
    let mut seen = BTreeSet::new();
    for (id, node) in graph.iter() {
        assert!(seen.insert(node.name().to_owned()), "{} exists twice", node.name());
        assert_eq!(graph.find(node.name()), Some(id));
        let ancestors: Vec<_> =
            std::iter::successors(Some(id), |&id| graph.node(id).parent()).take(200).collect();
        assert!(ancestors.len() < 200, "parents form a cycle");
        assert!(node.settings().iter().all(|(name, setting)| {
            node.node_type().attribute(name).is_some_and(|row| setting.fits(row))
        }));
    }
}

fn inputs_have_one_source(graph: &Graph) {
    let wires: Vec<&Connection> = graph.connections().collect();
    for (k, wire) in wires.iter().enumerate() {
        assert!(wires[..k].iter().all(|other| !other.to.overlaps(&wire.to)), "{}", graph.describe(wire.to));
    }
    let leaving: usize = graph.iter().map(|(id, _)| graph.leaving(id).count()).sum();
    assert_eq!(leaving, wires.len());
}

fn connections_fit(graph: &Graph) {
    for Connection { from, to } in graph.connections() {
        assert!(from.attribute.readable && to.attribute.writable);
        assert!(from.carries().is_some() && from.carries() == to.carries());
        for plug in [from, to] {
            assert_eq!(plug.attribute.multi, plug.index.is_some());
            let text = graph.describe(*plug);
            assert_eq!(graph.plug(&text).expect("it can be written"), *plug, "{text}");
        }
    }
}

/// No plug reaches itself along connections. This follows all connections from every plug, without the search of
/// the graph itself.
fn no_plug_depends_on_itself(graph: &Graph) {
    let wires: Vec<&Connection> = graph.connections().collect();
    for start in &wires {
        let (mut open, mut seen) = (vec![start.to], BTreeSet::new());
        while let Some(plug) = open.pop() {
            assert!(!plug.overlaps(&start.from), "{} depends on itself", graph.describe(start.from));
            for next in wires.iter().filter(|wire| wire.from.overlaps(&plug)) {
                if seen.insert(graph.describe(next.to)) {
                    open.push(next.to);
                }
            }
        }
    }
}

/// A scene of the graph, written and read again, has the same graph. Cloth without a mesh is refused by name.
fn reads_back(graph: &Graph) {
    let scene = Scene {
        time: TimeSpan { start: 1, end: 3, fps: 24.0 },
        every: 1.0,
        record: Record::Frames,
        graph: graph.clone(),
        checks: Vec::<Check>::new(),
        source: Source::new("test.ron"),
    };
    let text = write_scene(&scene);
    match read_scene_text(&text, Path::new("test.ron")) {
        Ok((read, _)) => {
            assert_eq!(pairs(&read.graph), pairs(graph), "{text}");
            assert!(read == scene, "{text}\n{:#?}\n{:#?}", read.graph, graph);
            assert_eq!(write_scene(&read), text);
        }
        Err(mistakes) => {
            let expected = |message: &str| message.contains("has no `inputMesh`");
            assert!(mistakes.iter().any(|mistake| expected(&mistake.message)), "{text}\n{mistakes:#?}");
        }
    }
    // The scene compiles or is refused with a message.
    if let Err(mistakes) = compile(&scene) {
        assert!(mistakes.iter().all(|mistake| !mistake.message.is_empty()));
    }
}

prop_state_machine! {
    #![proptest_config(ProptestConfig { cases: 64, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn any_sequence_of_changes_keeps_the_graph_whole(sequential 1..40 => Whole);
}

fn type_named(name: &str) -> &'static NodeType {
    node_types().iter().copied().find(|of| of.name == name).expect("a type of Maya's")
}

/// A nucleus `a` with particles `b`.
fn particles_of_a_nucleus() -> (Graph, NodeId) {
    let mut graph = Graph::new();
    let nucleus = graph.add("a", type_named("nucleus")).expect("a free name");
    let particles = graph.add("b", type_named("nParticle")).expect("a free name");
    graph.create(particles, &Creation::Object { mesh: None, nucleus }).expect("it joins the nucleus");
    (graph, nucleus)
}

#[test]
fn a_nucleus_without_a_clock_is_written_without_one() {
    let (mut graph, nucleus) = particles_of_a_nucleus();
    let clock = graph.connections().find(|wire| wire.to.node == nucleus && wire.from.node == graph.clock());
    let Connection { from, to } = *clock.expect("creating an object gives its nucleus the clock");
    assert!(graph.disconnect(from, to));
    reads_back(&graph);
}

#[test]
fn particles_with_explicit_connections_stay_on_their_nucleus() {
    let (mut graph, _) = particles_of_a_nucleus();
    let [from, to] = ["b.meshTriangleSize", "a.evaluations"].map(|plug| graph.plug(plug).expect("a plug"));
    graph.connect(from, to).expect("two numbers");
    reads_back(&graph);
}

#[test]
fn a_refused_setting_keeps_the_components_of_a_constraint() {
    let (mut graph, nucleus) = particles_of_a_nucleus();
    let constraint = graph.add("c", type_named("dynamicConstraint")).expect("a free name");
    let components = vec![Component {
        object: "b".to_owned(),
        selection: Selection::Elements(ElementKind::Point, Which::All),
    }];
    graph.create(constraint, &Creation::Constraint { components, nucleus }).expect("it has a member");
    let before = graph.clone();
    let (member, node) =
        graph.iter().find(|(_, node)| node.created_by() == Some(constraint)).expect("a member");
    let row = node.node_type().attribute("componentIndices").expect("it lists points");
    let curve = Curve::new(vec![Key { frame: 1.0, value: 0.0, tangent: Tangent::Auto }]);
    let keyed = Setting::Keyed(curve.expect("one key"));
    assert!(graph.set(member, row, keyed).is_err(), "a list of points has no keys");
    assert_eq!(graph, before);
}
