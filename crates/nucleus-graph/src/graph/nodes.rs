//! The graph itself: its nodes, and what is set on them.

use std::collections::BTreeMap;

use crate::attributes::{Attribute, NodeType, dynamic_constraint, n_base, time};

use super::error::GraphError;
use super::node::{Node, NodeId};
use super::plug::Connection;
use super::setting::Setting;

/// The name of the clock.
pub const CLOCK: &str = "time1";

/// Nodes and connections. Every graph has a clock, as in Maya: `time1`.
///
/// Two graphs are equal when they hold the same nodes, with the same settings, and the same connections; the
/// order in which they came does not matter.
#[derive(Debug, Clone)]
pub struct Graph {
    /// A node that was deleted leaves its place empty.
    nodes: Vec<Option<Node>>,
    names: BTreeMap<String, NodeId>,
    /// Connections by the node they leave from, in the order in which they were made.
    leaving: BTreeMap<NodeId, Vec<Connection>>,
    /// The same connections by the node they arrive at.
    arriving: BTreeMap<NodeId, Vec<Connection>>,
}

impl Graph {
    /// A graph of nothing but the clock.
    pub fn new() -> Self {
        let mut graph = Self {
            nodes: Vec::new(),
            names: BTreeMap::new(),
            leaving: BTreeMap::new(),
            arriving: BTreeMap::new(),
        };
        graph.push(CLOCK.to_owned(), &time::TIME, None);
        graph
    }

    /// The clock.
    pub fn clock(&self) -> NodeId {
        NodeId(0)
    }

    /// Adds a node on which nothing is set.
    ///
    /// # Errors
    /// When the name is taken, or is none.
    pub fn add(&mut self, name: &str, node_type: &'static NodeType) -> Result<NodeId, GraphError> {
        self.check_name(name)?;
        Ok(self.push(name.to_owned(), node_type, None))
    }

    /// Gives a node another name. What a creation command has made is then a node like any other.
    ///
    /// # Errors
    /// When the name is taken by another node, or is none; or when the node is the clock.
    pub fn rename(&mut self, node: NodeId, name: &str) -> Result<(), GraphError> {
        if self.find(name) == Some(node) {
            return Ok(());
        }
        self.check_name(name)?;
        if node == self.clock() {
            return Err(GraphError::Clock);
        }
        let old = std::mem::replace(&mut self.node_mut(node).name, name.to_owned());
        self.names.remove(&old);
        self.names.insert(name.to_owned(), node);
        self.keep(node);
        Ok(())
    }

    /// Sets an attribute, whatever was set before.
    ///
    /// # Errors
    /// When the node's type does not have it or it cannot hold this.
    pub fn set(
        &mut self,
        node: NodeId,
        attribute: &'static Attribute,
        setting: Setting,
    ) -> Result<(), GraphError> {
        self.put(node, attribute, setting)?;
        self.keep_if_made(node);
        Ok(())
    }

    /// The same, where a creation command sets what it has made.
    pub(super) fn put(
        &mut self,
        node: NodeId,
        attribute: &'static Attribute,
        setting: Setting,
    ) -> Result<(), GraphError> {
        self.check_setting(node, attribute, &setting)?;
        self.node_mut(node).settings.insert(attribute.name, setting);
        Ok(())
    }

    /// Refuses an attribute that the node's type does not have, or that cannot hold a setting.
    fn check_setting(
        &self,
        node: NodeId,
        attribute: &'static Attribute,
        setting: &Setting,
    ) -> Result<(), GraphError> {
        let Node { name, node_type, .. } = self.node(node);
        if node_type.attribute(attribute.name) != Some(attribute) {
            let (node, node_type) = (name.clone(), node_type.name);
            return Err(GraphError::NoAttribute { node, node_type, attribute: attribute.name });
        }
        if !setting.fits(attribute) {
            return Err(GraphError::NotAdmitted { node: name.clone(), attribute: attribute.name });
        }
        Ok(())
    }

    /// Lets a node take from a preset what is not set on it.
    ///
    /// # Errors
    /// When the node's type does not have an attribute, or it cannot hold what the preset sets.
    pub fn apply_preset(
        &mut self,
        node: NodeId,
        preset: &[(&'static Attribute, Setting)],
    ) -> Result<(), GraphError> {
        preset.iter().try_for_each(|(row, setting)| self.check_setting(node, row, setting))?;
        self.keep_if_made(node);
        let taken = &mut self.node_mut(node).preset;
        taken.clear();
        taken.extend(preset.iter().map(|(row, setting)| (row.name, setting.clone())));
        Ok(())
    }

    /// Sets an attribute back to its default. Whether anything was set.
    pub fn unset(&mut self, node: NodeId, attribute: &Attribute) -> bool {
        self.keep_if_made(node);
        self.node_mut(node).settings.remove(attribute.name).is_some()
    }

    /// Hangs a node from a transform.
    ///
    /// # Errors
    /// When the transform hangs from the node.
    pub fn set_parent(&mut self, node: NodeId, parent: NodeId) -> Result<(), GraphError> {
        if self.and_ancestors(parent).any(|ancestor| ancestor == node) {
            let [node, parent] = [node, parent].map(|id| self.node(id).name.clone());
            return Err(GraphError::ParentCircle { node, parent });
        }
        self.keep_if_made(node);
        self.node_mut(node).parent = Some(parent);
        Ok(())
    }

    /// Lets a node stand on its own again.
    pub fn unparent(&mut self, node: NodeId) {
        self.keep_if_made(node);
        self.node_mut(node).parent = None;
    }

    /// Lets a mesh be blended into another.
    ///
    /// # Errors
    /// When the other is blended into it, or into what is ...
    pub fn blend_into(&mut self, mesh: NodeId, target: NodeId) -> Result<(), GraphError> {
        let mut all = std::iter::successors(Some(target), |&mesh| self.node(mesh).blend_target);
        if all.any(|other| other == mesh) {
            let [mesh, target] = [mesh, target].map(|id| self.node(id).name.clone());
            return Err(GraphError::BlendCircle { mesh, target });
        }
        self.keep_if_made(mesh);
        self.node_mut(mesh).blend_target = Some(target);
        Ok(())
    }

    /// What a mesh is blended into.
    pub fn blend_target(&self, mesh: NodeId) -> Option<NodeId> {
        self.node(mesh).blend_target
    }

    /// Deletes a node with its connections and all that hangs on it: what hangs from it as a transform, and
    /// what was made for it. The clock cannot be deleted.
    pub fn remove(&mut self, node: NodeId) {
        let mut gone = if node == self.clock() { Vec::new() } else { vec![node] };
        while let Some(node) = gone.pop() {
            if self.nodes[node.place()].is_none() {
                continue;
            }
            let hangs =
                |(_, other): &(NodeId, &Node)| other.parent == Some(node) || other.made_by == Some(node);
            gone.extend(self.iter().filter(hangs).map(|(id, _)| id));
            let wires: Vec<Connection> = self.arriving(node).chain(self.leaving(node)).copied().collect();
            for Connection { from, to } in wires {
                self.disconnect(from, to);
            }
            for other in self.nodes.iter_mut().flatten().filter(|other| other.blend_target == Some(node)) {
                other.blend_target = None;
            }
            if let Some(old) = self.nodes[node.place()].take() {
                self.names.remove(&old.name);
            }
        }
    }

    /// A node.
    ///
    /// # Panics
    /// When it has been deleted.
    pub fn node(&self, id: NodeId) -> &Node {
        self.get(id).unwrap_or_else(|| unreachable!("the node has been deleted"))
    }

    /// A node, if it has not been deleted.
    pub fn get(&self, id: NodeId) -> Option<&Node> {
        self.nodes.get(id.place())?.as_ref()
    }

    /// The node of this name.
    pub fn find(&self, name: &str) -> Option<NodeId> {
        self.names.get(name).copied()
    }

    /// All nodes, in the order in which they were added.
    pub fn iter(&self) -> impl Iterator<Item = (NodeId, &Node)> {
        (0..).map(NodeId).zip(&self.nodes).filter_map(|(id, node)| Some((id, node.as_ref()?)))
    }

    /// All nodes of a type, or of types that inherit from it, in the order in which they were added.
    pub fn of_type(&self, node_type: &'static NodeType) -> impl Iterator<Item = (NodeId, &Node)> {
        self.iter().filter(move |(_, node)| node.node_type.is_a(node_type))
    }

    /// A node, the one it hangs from, and so on up.
    pub(super) fn and_ancestors(&self, node: NodeId) -> impl Iterator<Item = NodeId> {
        std::iter::successors(Some(node), |&node| self.node(node).parent)
    }

    /// Connections that leave from a node.
    pub fn leaving(&self, node: NodeId) -> impl Iterator<Item = &Connection> {
        self.leaving.get(&node).into_iter().flatten()
    }

    /// Connections that arrive at a node.
    pub fn arriving(&self, node: NodeId) -> impl Iterator<Item = &Connection> {
        self.arriving.get(&node).into_iter().flatten()
    }

    /// All connections: by the node they arrive at, and there in the order in which they were made.
    pub fn connections(&self) -> impl Iterator<Item = &Connection> {
        self.arriving.values().flatten()
    }

    /// Adds a node that a creation command makes; `stem` and the first free number are its name.
    pub(super) fn make(&mut self, stem: &str, node_type: &'static NodeType, made_by: NodeId) -> NodeId {
        let free = (1..).map(|n| format!("{stem}{n}")).find(|name| self.find(name).is_none());
        self.push(free.unwrap_or_default(), node_type, Some(made_by))
    }

    /// Makes all that creation commands have made for a node, or for the same node as this one, nodes like
    /// any others. What the node was created from is then only in its connections.
    pub(super) fn keep(&mut self, node: NodeId) {
        let owner = self.node(node).made_by.unwrap_or(node);
        for other in self.nodes.iter_mut().flatten().filter(|other| other.made_by == Some(owner)) {
            other.made_by = None;
        }
        self.node_mut(owner).settings.remove(dynamic_constraint::COMPONENTS.row.name);
    }

    fn keep_if_made(&mut self, node: NodeId) {
        if self.node(node).made_by.is_some() {
            self.keep(node);
        }
    }

    /// Whether a node is an object or a constraint.
    pub fn is_member(&self, node: NodeId) -> bool {
        let node_type = self.node(node).node_type;
        node_type.is_a(&n_base::N_BASE) || node_type.is_a(&dynamic_constraint::DYNAMIC_CONSTRAINT)
    }

    pub(super) fn insert(&mut self, connection: Connection) {
        self.leaving.entry(connection.from.node).or_default().push(connection);
        self.arriving.entry(connection.to.node).or_default().push(connection);
    }

    /// Whether it was there.
    pub(super) fn take(&mut self, connection: Connection) -> bool {
        let there = self.arriving(connection.to.node).any(|other| *other == connection);
        if let Some(leaving) = self.leaving.get_mut(&connection.from.node) {
            leaving.retain(|other| *other != connection);
        }
        if let Some(arriving) = self.arriving.get_mut(&connection.to.node) {
            arriving.retain(|other| *other != connection);
        }
        there
    }

    pub(super) fn node_mut(&mut self, id: NodeId) -> &mut Node {
        self.nodes[id.place()].as_mut().unwrap_or_else(|| unreachable!("the node has been deleted"))
    }

    fn check_name(&self, name: &str) -> Result<(), GraphError> {
        let name = name.to_owned();
        if !is_a_name(&name) {
            return Err(GraphError::NoName { name });
        }
        if self.find(&name).is_some() {
            return Err(GraphError::NameTaken { name });
        }
        Ok(())
    }

    fn push(&mut self, name: String, node_type: &'static NodeType, made_by: Option<NodeId>) -> NodeId {
        let id = NodeId(self.nodes.len() as u32);
        self.names.insert(name.clone(), id);
        self.nodes.push(Some(Node {
            name,
            node_type,
            settings: Default::default(),
            preset: Default::default(),
            parent: None,
            made_by,
            blend_target: None,
        }));
        id
    }
}

/// Whether a node can have this name: letters, digits, `_`, `-` and `:`.
pub fn is_a_name(name: &str) -> bool {
    !name.is_empty() && name.chars().all(|c| c.is_alphanumeric() || matches!(c, '_' | '-' | ':'))
}

impl Default for Graph {
    fn default() -> Self {
        Self::new()
    }
}

impl PartialEq for Graph {
    fn eq(&self, other: &Self) -> bool {
        let parts = |graph: &Self| {
            let name = |id: Option<NodeId>| id.map(|id| graph.node(id).name.clone());
            let nodes: BTreeMap<String, _> = graph
                .iter()
                .map(|(_, node)| {
                    let Node { name: own, node_type, settings, preset, parent, made_by, blend_target } =
                        node.clone();
                    (own, (node_type, settings, preset, [parent, made_by, blend_target].map(name)))
                })
                .collect();
            let plugs = |wire: &Connection| [graph.describe(wire.from), graph.describe(wire.to)];
            let mut wires: Vec<[String; 2]> = graph.connections().map(plugs).collect();
            wires.sort_unstable();
            (nodes, wires)
        };
        parts(self) == parts(other)
    }
}
