//! Connecting and disconnecting plugs, and the test for cycles.
//!
//! Maya's graphs have many cycles of nodes: a cloth feeds its nucleus, which feeds the cloth. They have no cycle
//! of plugs, because the state that a nucleus returns does not flow into the state that it receives. The test
//! therefore follows plugs: along connections between nodes, and from inputs to outputs inside a node.

use std::collections::HashSet;

use crate::attributes::{Attribute, Key, Kind, NodeType, n_base, n_cloth, n_particle, particle};

use super::error::GraphError;
use super::node::{Connection, NodeId, Plug};
use super::nodes::Graph;
use super::wires::Wires;

/// Inputs that Maya's creation commands connect.
const CREATED: [&str; 12] = [
    "currentTime",
    "inputMesh",
    "inMesh",
    "inputActive",
    "inputActiveStart",
    "inputPassive",
    "inputPassiveStart",
    "nextState",
    "inputStart",
    "inputCurrent",
    "objectId",
    "componentIds",
];

/// Whether a creation command may have connected an input.
pub fn may_be_from_creation(to: Plug) -> bool {
    CREATED.contains(&to.attribute.name) || to.attribute.name == particle::START_FRAME.row.name
}

/// Whether plugs of this attribute connect an object to its nucleus.
pub fn joins_a_nucleus(attribute: &str) -> bool {
    let plugs = [&n_base::CURRENT_STATE, &n_base::START_STATE, &n_base::NEXT_STATE];
    plugs.iter().any(|key| key.row.name == attribute)
}

impl Graph {
    /// Connects an output to an input.
    ///
    /// # Errors
    /// When a plug does not exist, has the wrong direction, is connected already or carries other data, or when
    /// the output depends on the input.
    pub fn connect(&mut self, from: Plug, to: Plug) -> Result<(), GraphError> {
        self.check_plug(from)?;
        self.check_plug(to)?;
        if !from.attribute.readable {
            return Err(GraphError::OnlyInput { plug: self.describe(from) });
        }
        if !to.attribute.writable {
            return Err(GraphError::OnlyOutput { plug: self.describe(to) });
        }
        let names = || [from, to].map(|plug| self.describe(plug));
        match (from.carries(), to.carries()) {
            (Some(one), Some(other)) if one == other => {}
            (Some(one), Some(other)) => {
                let [from, to] = names();
                return Err(GraphError::OtherData { from, carries: one.noun(), to, takes: other.noun() });
            }
            (carries, _) => {
                let plug = self.describe(if carries.is_none() { from } else { to });
                return Err(GraphError::NotPluggable { plug });
            }
        }
        if let Some(taken) = self.arriving.of_element(to).iter().find(|wire| wire.to.overlaps(&to)) {
            let (input, source) = (self.describe(taken.to), self.describe(taken.from));
            return Err(GraphError::InputTaken { input, source_plug: source });
        }
        if self.would_create_cycle(from, to) {
            let [from, to] = names();
            return Err(GraphError::Cycle { from, to });
        }
        self.insert_connection(Connection { from, to });
        Ok(())
    }

    /// Removes a connection; returns whether it existed. If a creation command made it, the command's other nodes
    /// and connections stay, as if made one by one.
    pub fn disconnect(&mut self, from: Plug, to: Plug) -> bool {
        let there = self.remove_connection(Connection { from, to });
        if there && may_be_from_creation(to) {
            for node in [from.node, to.node] {
                if self.is_member(node) || self.node(node).created_by().is_some() {
                    self.make_independent(node);
                }
            }
        }
        there
    }

    /// The node that an input is connected from.
    pub fn source<T>(&self, node: NodeId, input: &Key<T>) -> Option<NodeId> {
        self.sources(node, input.row.name).next().map(|wire| wire.from.node)
    }

    /// The plugs that an output is connected to.
    pub fn targets<T>(&self, node: NodeId, output: &Key<T>) -> impl Iterator<Item = Plug> {
        self.leaving.of_attribute(node, output.row.name).map(|wire| wire.to)
    }

    /// The sources of a multi input, in the order of its elements.
    pub fn elements<T>(&self, node: NodeId, input: &Key<T>) -> Vec<(u32, Plug)> {
        let wires = self.sources(node, input.row.name);
        wires.filter_map(|wire| Some((wire.to.index?, wire.from))).collect()
    }

    /// Refuses an index on an attribute that is not multi, a multi attribute without one, and components of
    /// anything but a vector.
    fn check_plug(&self, plug: Plug) -> Result<(), GraphError> {
        let node = self.check_node(plug.node)?;
        if node.node_type().attribute(plug.attribute.name) != Some(plug.attribute) {
            let (node, node_type) = (node.name().to_owned(), node.node_type().name);
            return Err(GraphError::NoAttribute { node, node_type, attribute: plug.attribute.name });
        }
        let is_vector = matches!(plug.attribute.kind, Kind::Vector(_));
        if plug.part.is_some_and(|part| part > 2 || !is_vector) {
            return Err(GraphError::NotPluggable { plug: self.describe(Plug { part: None, ..plug }) });
        }
        match (plug.attribute.multi, plug.index) {
            (true, None) => Err(GraphError::NeedsIndex { plug: self.describe(plug) }),
            (false, Some(_)) => Err(GraphError::HoldsOne { plug: self.describe(plug) }),
            _ => Ok(()),
        }
    }
}

/// The state of a search: plugs already visited, those still to expand, and the connections looked at.
#[derive(Default)]
struct Frontier {
    visited: HashSet<(NodeId, &'static str, Option<u32>, Option<usize>)>,
    open: Vec<Plug>,
    work: usize,
}

impl Frontier {
    fn add(&mut self, plug: Plug) {
        if self.visited.insert((plug.node, plug.attribute.name, plug.index, plug.part)) {
            self.open.push(plug);
        }
    }
}

impl Graph {
    /// Whether the output `from` depends on the input `to`. Searches from both ends, and goes on where fewer connections
    /// have been looked at: one of the two searches is nearly always short.
    pub(super) fn would_create_cycle(&self, from: Plug, to: Plug) -> bool {
        let (mut downward, mut upward) = (Frontier::default(), Frontier::default());
        downward.add(to);
        upward.add(from);
        loop {
            let [Some(&low), Some(&high)] = [downward.open.last(), upward.open.last()] else { return false };
            let work = [
                downward.work + 1 + self.count_of(low, low.attribute.writable, &self.leaving),
                upward.work + 1 + self.count_of(high, !high.attribute.writable, &self.arriving),
            ];
            if work[0] < work[1] {
                (downward.work, _) = (work[0], downward.open.pop());
                if self.reaches(low, from) {
                    return true;
                }
                self.downstream(low).for_each(|next| downward.add(next));
            } else {
                (upward.work, _) = (work[1], upward.open.pop());
                if self.reaches(to, high) {
                    return true;
                }
                self.upstream(high).for_each(|next| upward.add(next));
            }
        }
    }

    /// The number of connections that a step of a search looks at: those of the attribute, or all of the node if it may
    /// compute other attributes from this one or this one from others.
    fn count_of(&self, plug: Plug, is_through_node: bool, wires: &Wires) -> usize {
        match is_through_node {
            true => wires.of_node(plug.node).len(),
            false => wires.of_attribute(plug.node, plug.attribute.name).count(),
        }
    }

    /// Whether the plugs overlap, or their node computes the second from the first.
    fn reaches(&self, one: Plug, other: Plug) -> bool {
        let inside = || feeds(self.node(one.node).node_type(), one.attribute, other.attribute);
        one.overlaps(&other) || one.node == other.node && inside()
    }

    /// The plugs that a plug flows into directly.
    fn downstream(&self, plug: Plug) -> impl Iterator<Item = Plug> {
        let node_type = self.node(plug.node).node_type();
        let own = self.leaving.of_attribute(plug.node, plug.attribute.name);
        let own = own.filter(move |wire| wire.from.overlaps(&plug)).map(|wire| wire.to);
        // Only from inputs a node computes outputs.
        let others = plug.attribute.writable.then(|| self.leaving(plug.node)).into_iter().flatten();
        let others = others.map(|wire| wire.from);
        own.chain(others.filter(move |from| feeds(node_type, plug.attribute, from.attribute)))
    }

    /// The plugs that flow into a plug directly.
    fn upstream(&self, plug: Plug) -> impl Iterator<Item = Plug> {
        let node_type = self.node(plug.node).node_type();
        let own = self.sources(plug.node, plug.attribute.name);
        let own = own.filter(move |wire| wire.to.overlaps(&plug)).map(|wire| wire.from);
        // An attribute that is writable is not computed from others.
        let others = (!plug.attribute.writable).then(|| self.arriving(plug.node)).into_iter().flatten();
        let others = others.map(|wire| wire.to);
        own.chain(others.filter(move |to| feeds(node_type, to.attribute, plug.attribute)))
    }
}

/// Whether a node computes an output from an input. An attribute that is both readable and writable only passes
/// on its own value.
fn feeds(node_type: &'static NodeType, input: &Attribute, output: &Attribute) -> bool {
    if output.writable || !input.writable {
        return false;
    }
    if !node_type.is_a(&n_base::N_BASE) {
        return true;
    }
    let back = input.name == n_base::NEXT_STATE.row.name;
    match output.name {
        // The state sent to the nucleus does not depend on the state that it returns.
        "currentState" | "startState" => !back,
        name if name == n_cloth::OUTPUT_MESH.row.name || name == n_particle::OUT_MESH.row.name => {
            back || input.name == n_base::INPUT_MESH.row.name
        }
        name if name == n_cloth::OUTPUT_START_MESH.row.name => !back,
        // All other outputs hold the result of the previous evaluation.
        _ => false,
    }
}
