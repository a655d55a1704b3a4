//! The graph: its nodes, their settings and parents, and the stored connections.

use std::collections::BTreeMap;

use crate::attributes::{Attribute, NodeType, dynamic_constraint, n_base, surface_shape, time, transform};

use super::error::GraphError;
use super::node::{Connection, Node, NodeId, Plug};
use super::setting::Setting;
use super::wires::Wires;

/// The name of the clock node.
pub const CLOCK: &str = "time1";

/// Nodes and connections. Every graph has a clock node, as in Maya: `time1`.
///
/// Graphs are equal when they have the same nodes, settings and connections, in any order.
#[derive(Debug, Clone)]
pub struct Graph {
    /// Indexed by [`NodeId`]; `None` for deleted nodes.
    nodes: Vec<Option<Node>>,
    names: BTreeMap<String, NodeId>,
    /// The number from which on creation commands look for a free name, by the stem of the name.
    next_numbers: BTreeMap<String, u64>,
    /// Connections by their output.
    pub(super) leaving: Wires,
    /// The same connections by their input.
    pub(super) arriving: Wires,
}

impl Graph {
    /// A graph that has only the clock.
    pub fn new() -> Self {
        let mut graph = Self {
            nodes: Vec::new(),
            names: BTreeMap::new(),
            next_numbers: BTreeMap::new(),
            leaving: Wires::default(),
            arriving: Wires::default(),
        };
        graph.push(CLOCK.to_owned(), &time::TIME, None);
        graph
    }

    /// The clock node.
    pub fn clock(&self) -> NodeId {
        NodeId(0)
    }

    /// Adds a node without settings.
    ///
    /// # Errors
    /// When the name is taken or not a valid name.
    pub fn add(&mut self, name: &str, node_type: &'static NodeType) -> Result<NodeId, GraphError> {
        self.check_name(name)?;
        Ok(self.push(name.to_owned(), node_type, None))
    }

    /// Renames a node. A node that a creation command made becomes independent of it.
    ///
    /// # Errors
    /// When the name is taken by another node or not a valid name, when the node is the clock, or has been deleted.
    pub fn rename(&mut self, node: NodeId, name: &str) -> Result<(), GraphError> {
        self.check_node(node)?;
        if self.find(name) == Some(node) {
            return Ok(());
        }
        self.check_name(name)?;
        if node == self.clock() {
            return Err(GraphError::Clock);
        }
        let old = std::mem::replace(&mut self.node_mut(node).name, name.to_owned());
        self.free_name(&old);
        self.names.insert(name.to_owned(), node);
        self.make_independent(node);
        Ok(())
    }

    /// Sets an attribute. A node that a creation command made becomes independent of it.
    ///
    /// # Errors
    /// When the node's type has no such attribute, the setting does not fit it, or the node has been deleted.
    pub fn set(
        &mut self,
        node: NodeId,
        attribute: &'static Attribute,
        setting: Setting,
    ) -> Result<(), GraphError> {
        self.set_created(node, attribute, setting)?;
        self.make_independent_if_created(node);
        Ok(())
    }

    /// Sets an attribute of a node that stays part of its creation command.
    pub(super) fn set_created(
        &mut self,
        node: NodeId,
        attribute: &'static Attribute,
        setting: Setting,
    ) -> Result<(), GraphError> {
        self.check_setting(node, attribute, &setting)?;
        self.node_mut(node).settings.insert(attribute.name, setting);
        Ok(())
    }

    /// Refuses an attribute that the node's type does not have, and a setting that does not fit.
    fn check_setting(
        &self,
        node: NodeId,
        attribute: &'static Attribute,
        setting: &Setting,
    ) -> Result<(), GraphError> {
        let Node { name, node_type, .. } = self.check_node(node)?;
        if node_type.attribute(attribute.name) != Some(attribute) {
            let (node, node_type) = (name.clone(), node_type.name);
            return Err(GraphError::NoAttribute { node, node_type, attribute: attribute.name });
        }
        if !setting.fits(attribute) {
            return Err(GraphError::NotAdmitted { node: name.clone(), attribute: attribute.name });
        }
        Ok(())
    }

    /// Replaces the preset of a node. The node's own settings keep precedence.
    ///
    /// # Errors
    /// When the node's type lacks an attribute of the preset, a setting does not fit, or the node has been deleted.
    pub fn apply_preset(
        &mut self,
        node: NodeId,
        preset: &[(&'static Attribute, Setting)],
    ) -> Result<(), GraphError> {
        self.check_node(node)?;
        preset.iter().try_for_each(|(row, setting)| self.check_setting(node, row, setting))?;
        self.make_independent_if_created(node);
        let taken = &mut self.node_mut(node).preset;
        taken.clear();
        taken.extend(preset.iter().map(|(row, setting)| (row.name, setting.clone())));
        Ok(())
    }

    /// Removes the setting of an attribute; returns whether there was one.
    ///
    /// # Panics
    /// When the node has been deleted.
    pub fn unset(&mut self, node: NodeId, attribute: &Attribute) -> bool {
        self.make_independent_if_created(node);
        self.node_mut(node).settings.remove(attribute.name).is_some()
    }

    /// Makes a transform the parent of a node.
    ///
    /// # Errors
    /// When the parent has no transform, when the node is an ancestor of it or the transform itself, when the node is the
    /// clock, or when one of them has been deleted.
    pub fn set_parent(&mut self, node: NodeId, parent: NodeId) -> Result<(), GraphError> {
        self.check_parent(node, parent)?;
        if self.self_and_ancestors(parent).any(|ancestor| ancestor == node) {
            let [node, parent] = [node, parent].map(|id| self.node(id).name.clone());
            return Err(GraphError::ParentCycle { node, parent });
        }
        self.make_independent_if_created(node);
        self.node_mut(node).parent = Some(parent);
        Ok(())
    }

    /// Refuses a parent without a transform, and any parent of the clock.
    fn check_parent(&self, node: NodeId, parent: NodeId) -> Result<(), GraphError> {
        let [child, above] = [self.check_node(node)?, self.check_node(parent)?];
        if node == self.clock() {
            return Err(GraphError::Clock);
        }
        if !above.node_type.is_a(&transform::TRANSFORM) {
            let [node, parent] = [child, above].map(|node| node.name.clone());
            return Err(GraphError::NoTransform { node, parent, node_type: above.node_type.name });
        }
        Ok(())
    }

    /// Removes the parent of a node.
    ///
    /// # Panics
    /// When the node has been deleted.
    pub fn unparent(&mut self, node: NodeId) {
        self.make_independent_if_created(node);
        self.node_mut(node).parent = None;
    }

    /// Sets the blend target of a mesh.
    ///
    /// # Errors
    /// When one of them is no mesh or has been deleted, or the chain of blend targets leads from the target back to the mesh.
    pub fn blend_into(&mut self, mesh: NodeId, target: NodeId) -> Result<(), GraphError> {
        for id in [mesh, target] {
            let Node { name, node_type, .. } = self.check_node(id)?;
            if !node_type.is_a(&surface_shape::SURFACE_SHAPE) {
                return Err(GraphError::NoMesh { node: name.clone(), node_type: node_type.name });
            }
        }
        let mut all = std::iter::successors(Some(target), |&mesh| self.node(mesh).blend_target);
        if all.any(|other| other == mesh) {
            let [mesh, target] = [mesh, target].map(|id| self.node(id).name.clone());
            return Err(GraphError::BlendCycle { mesh, target });
        }
        self.make_independent_if_created(mesh);
        self.node_mut(mesh).blend_target = Some(target);
        Ok(())
    }

    /// The blend target of a mesh.
    ///
    /// # Panics
    /// When the node has been deleted.
    pub fn blend_target(&self, mesh: NodeId) -> Option<NodeId> {
        self.node(mesh).blend_target
    }

    /// Deletes a node with its connections, its children, and the nodes that its creation command made. Does
    /// nothing for the clock, and for a node that this graph does not have.
    pub fn remove(&mut self, node: NodeId) {
        let mut gone = if node == self.clock() { Vec::new() } else { vec![node] };
        while let Some(node) = gone.pop() {
            if self.get(node).is_none() {
                continue;
            }
            let depends =
                |(_, other): &(NodeId, &Node)| other.parent == Some(node) || other.created_by == Some(node);
            gone.extend(self.iter().filter(depends).map(|(id, _)| id));
            let wires: Vec<Connection> = self.arriving(node).chain(self.leaving(node)).copied().collect();
            for Connection { from, to } in wires {
                self.disconnect(from, to);
            }
            for other in self.nodes.iter_mut().flatten().filter(|other| other.blend_target == Some(node)) {
                other.blend_target = None;
            }
            if let Some(old) = self.nodes[node.index()].take() {
                self.free_name(&old.name);
            }
        }
    }

    /// Frees a name. A creation command may then find a free number below its last one.
    fn free_name(&mut self, name: &str) {
        self.names.remove(name);
        self.next_numbers.clear();
    }

    /// A node.
    ///
    /// # Panics
    /// When it has been deleted.
    pub fn node(&self, id: NodeId) -> &Node {
        self.get(id).unwrap_or_else(|| unreachable!("the node has been deleted"))
    }

    /// A node; `None` if it has been deleted.
    pub fn get(&self, id: NodeId) -> Option<&Node> {
        self.nodes.get(id.index())?.as_ref()
    }

    /// The node of this name.
    pub fn find(&self, name: &str) -> Option<NodeId> {
        self.names.get(name).copied()
    }

    /// All nodes in the order of addition.
    pub fn iter(&self) -> impl Iterator<Item = (NodeId, &Node)> {
        (0..).map(NodeId).zip(&self.nodes).filter_map(|(id, node)| Some((id, node.as_ref()?)))
    }

    /// All nodes of a type, or of types that inherit from it, in the order of addition.
    pub fn of_type(&self, node_type: &'static NodeType) -> impl Iterator<Item = (NodeId, &Node)> {
        self.iter().filter(move |(_, node)| node.node_type.is_a(node_type))
    }

    /// A node, its parent, the parent of that, and so on.
    pub(super) fn self_and_ancestors(&self, node: NodeId) -> impl Iterator<Item = NodeId> {
        std::iter::successors(Some(node), |&node| self.node(node).parent)
    }

    /// Connections from outputs of a node.
    pub fn leaving(&self, node: NodeId) -> impl Iterator<Item = &Connection> {
        self.leaving.of_node(node).iter()
    }

    /// Connections to inputs of a node.
    pub fn arriving(&self, node: NodeId) -> impl Iterator<Item = &Connection> {
        self.arriving.of_node(node).iter()
    }

    /// Whether an output is connected to an input.
    pub fn has_connection(&self, from: Plug, to: Plug) -> bool {
        self.arriving.of_element(to).contains(&Connection { from, to })
    }

    /// All connections, by the node of their input, then in the order of connecting.
    pub fn connections(&self) -> impl Iterator<Item = &Connection> {
        self.arriving.all()
    }

    /// Adds a node for a creation command. Its name is `stem` and the first free number.
    pub(super) fn add_created(
        &mut self,
        stem: &str,
        node_type: &'static NodeType,
        created_by: NodeId,
    ) -> NodeId {
        let mut number = self.next_numbers.get(stem).copied().unwrap_or(1);
        while self.find(&format!("{stem}{number}")).is_some() {
            number += 1;
        }
        self.next_numbers.insert(stem.to_owned(), number + 1);
        self.push(format!("{stem}{number}"), node_type, Some(created_by))
    }

    /// Makes the nodes of a creation command independent: those that it made for this node, or for the owner of
    /// this node. The components of a constraint are then only in its connections.
    pub(super) fn make_independent(&mut self, node: NodeId) {
        let owner = self.node(node).created_by.unwrap_or(node);
        for other in self.nodes.iter_mut().flatten().filter(|other| other.created_by == Some(owner)) {
            other.created_by = None;
        }
        self.node_mut(owner).settings.remove(dynamic_constraint::COMPONENTS.row.name);
    }

    fn make_independent_if_created(&mut self, node: NodeId) {
        if self.node(node).created_by.is_some() {
            self.make_independent(node);
        }
    }

    /// Whether a node is an object or a constraint of a nucleus.
    pub fn is_member(&self, node: NodeId) -> bool {
        let node_type = self.node(node).node_type;
        node_type.is_a(&n_base::N_BASE) || node_type.is_a(&dynamic_constraint::DYNAMIC_CONSTRAINT)
    }

    pub(super) fn insert_connection(&mut self, connection: Connection) {
        self.leaving.insert(connection.from, connection);
        self.arriving.insert(connection.to, connection);
    }

    /// Returns whether the connection existed.
    pub(super) fn remove_connection(&mut self, connection: Connection) -> bool {
        self.leaving.remove(connection.from, connection);
        self.arriving.remove(connection.to, connection)
    }

    /// A node, unless this graph does not have it.
    pub(super) fn check_node(&self, id: NodeId) -> Result<&Node, GraphError> {
        self.get(id).ok_or(GraphError::NoNode)
    }

    pub(super) fn node_mut(&mut self, id: NodeId) -> &mut Node {
        self.nodes[id.index()].as_mut().unwrap_or_else(|| unreachable!("the node has been deleted"))
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

    fn push(&mut self, name: String, node_type: &'static NodeType, created_by: Option<NodeId>) -> NodeId {
        let id = NodeId(self.nodes.len() as u32);
        self.names.insert(name.clone(), id);
        self.nodes.push(Some(Node {
            name,
            node_type,
            settings: Default::default(),
            preset: Default::default(),
            parent: None,
            created_by,
            blend_target: None,
        }));
        id
    }
}

/// Whether a text is a valid name of a node: letters, digits, `_`, `-` and `:`, at least one.
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
                    let Node { name: own, node_type, settings, preset, parent, created_by, blend_target } =
                        node.clone();
                    (own, (node_type, settings, preset, [parent, created_by, blend_target].map(name)))
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
