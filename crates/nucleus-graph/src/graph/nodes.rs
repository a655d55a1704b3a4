//! The graph itself.

use crate::attributes::{Attribute, Key, NodeType};

use super::error::GraphError;
use super::node::{Node, NodeId};
use super::plug::{Connection, Plug};
use super::setting::Setting;

/// Nodes and connections.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Graph {
    nodes: Vec<Node>,
    connections: Vec<Connection>,
}

impl Graph {
    /// An empty graph.
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds a node on which nothing is set.
    ///
    /// # Errors
    /// When the name is taken.
    pub fn add(&mut self, name: &str, node_type: &'static NodeType) -> Result<NodeId, GraphError> {
        if self.find(name).is_some() {
            return Err(GraphError::NameTaken { name: name.to_owned() });
        }
        Ok(self.push(name.to_owned(), node_type, None))
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
        let Node { name, node_type, settings, .. } = &mut self.nodes[node.0 as usize];
        if node_type.attribute(attribute.name) != Some(attribute) {
            let (node, node_type) = (name.clone(), node_type.name);
            return Err(GraphError::NoAttribute { node, node_type, attribute: attribute.name });
        }
        if !setting.fits(attribute) {
            return Err(GraphError::NotAdmitted { node: name.clone(), attribute: attribute.name });
        }
        settings.insert(attribute.name, setting);
        Ok(())
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
        self.nodes[node.0 as usize].parent = Some(parent);
        Ok(())
    }

    /// Connects an output to an input.
    ///
    /// # Errors
    /// When the input is connected already.
    pub fn connect(&mut self, from: Plug, to: Plug) -> Result<(), GraphError> {
        if self.connections.iter().any(|connection| connection.to == to) {
            return Err(GraphError::InputTaken { input: self.describe(to) });
        }
        self.connections.push(Connection { from, to });
        Ok(())
    }

    /// A node.
    pub fn node(&self, id: NodeId) -> &Node {
        &self.nodes[id.0 as usize]
    }

    /// The node of this name.
    pub fn find(&self, name: &str) -> Option<NodeId> {
        self.iter().find(|(_, node)| node.name == name).map(|(id, _)| id)
    }

    /// All nodes, in the order in which they were added.
    pub fn iter(&self) -> impl Iterator<Item = (NodeId, &Node)> {
        (0..).map(NodeId).zip(&self.nodes)
    }

    /// All nodes of a type, or of types that inherit from it, in the order in which they were added.
    pub fn of_type(&self, node_type: &'static NodeType) -> impl Iterator<Item = (NodeId, &Node)> {
        self.iter().filter(move |(_, node)| node.node_type.is_a(node_type))
    }

    /// All connections, in the order in which they were made.
    pub fn connections(&self) -> &[Connection] {
        &self.connections
    }

    /// The node that an input is fed by.
    pub fn source<T>(&self, node: NodeId, input: &Key<T>) -> Option<NodeId> {
        let feeds = |c: &&Connection| c.to.node == node && c.to.attribute.name == input.row.name;
        self.connections.iter().find(feeds).map(|connection| connection.from.node)
    }

    /// The nodes that an output feeds.
    pub fn targets<T>(&self, node: NodeId, output: &Key<T>) -> impl Iterator<Item = Plug> {
        let name = output.row.name;
        let fed = move |c: &&Connection| c.from.node == node && c.from.attribute.name == name;
        self.connections.iter().filter(fed).map(|connection| connection.to)
    }

    /// A plug as Maya writes it: `nucleus1.inputActive[0]`.
    pub fn describe(&self, plug: Plug) -> String {
        let name = &self.node(plug.node).name;
        let index = plug.index.map(|index| format!("[{index}]")).unwrap_or_default();
        format!("{name}.{}{index}", plug.attribute.name)
    }

    /// A node, the one it hangs from, and so on up.
    pub(super) fn and_ancestors(&self, node: NodeId) -> impl Iterator<Item = NodeId> {
        std::iter::successors(Some(node), |&node| self.node(node).parent)
    }

    /// Adds a node that a creation command makes; `stem` and the first free number are its name.
    pub(super) fn make(&mut self, stem: &str, node_type: &'static NodeType, made_by: NodeId) -> NodeId {
        let free = (1..).map(|n| format!("{stem}{n}")).find(|name| self.find(name).is_none());
        self.push(free.unwrap_or_default(), node_type, Some(made_by))
    }

    fn push(&mut self, name: String, node_type: &'static NodeType, made_by: Option<NodeId>) -> NodeId {
        self.nodes.push(Node { name, node_type, settings: Default::default(), parent: None, made_by });
        NodeId(self.nodes.len() as u32 - 1)
    }
}
