//! Connecting and disconnecting.

use crate::attributes::{Key, Kind, particle};

use super::error::GraphError;
use super::node::NodeId;
use super::nodes::Graph;
use super::plug::{Connection, Plug};

/// Inputs that creation commands connect.
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
fn is_from_creation(to: Plug) -> bool {
    CREATED.contains(&to.attribute.name) || to.attribute.name == particle::START_FRAME.row.name
}

impl Graph {
    /// Connects an output to an input.
    ///
    /// # Errors
    /// When a plug is not there, the wrong way round, taken, or of other data; or when the output depends on
    /// the input.
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
        if let Some(taken) = self.arriving(to.node).find(|wire| wire.to.overlaps(&to)) {
            let (input, source) = (self.describe(taken.to), self.describe(taken.from));
            return Err(GraphError::InputTaken { input, source_plug: source });
        }
        if self.would_circle(from, to) {
            let [from, to] = names();
            return Err(GraphError::Circle { from, to });
        }
        self.insert(Connection { from, to });
        Ok(())
    }

    /// Takes a connection away; whether it was there. If a creation command had made it, what else it has
    /// made stays, as if connected by hand.
    pub fn disconnect(&mut self, from: Plug, to: Plug) -> bool {
        let there = self.take(Connection { from, to });
        if there && is_from_creation(to) {
            for node in [from.node, to.node] {
                if self.is_member(node) || self.node(node).made_by().is_some() {
                    self.keep(node);
                }
            }
        }
        there
    }

    /// The node that an input is fed by.
    pub fn source<T>(&self, node: NodeId, input: &Key<T>) -> Option<NodeId> {
        let feeds = |wire: &&Connection| wire.to.attribute.name == input.row.name;
        self.arriving(node).find(feeds).map(|wire| wire.from.node)
    }

    /// The plugs that an output feeds.
    pub fn targets<T>(&self, node: NodeId, output: &Key<T>) -> impl Iterator<Item = Plug> {
        let name = output.row.name;
        self.leaving(node).filter(move |wire| wire.from.attribute.name == name).map(|wire| wire.to)
    }

    /// What is connected to an input that holds many, in the order of its elements.
    pub fn elements<T>(&self, node: NodeId, input: &Key<T>) -> Vec<(u32, Plug)> {
        let wires = self.arriving(node).filter(|wire| wire.to.attribute.name == input.row.name);
        let mut elements: Vec<_> = wires.filter_map(|wire| Some((wire.to.index?, wire.from))).collect();
        elements.sort_by_key(|(index, _)| *index);
        elements
    }

    /// A plug has an index just when it holds many, and a part only when it is a vector.
    fn check_plug(&self, plug: Plug) -> Result<(), GraphError> {
        let node = self.node(plug.node);
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
