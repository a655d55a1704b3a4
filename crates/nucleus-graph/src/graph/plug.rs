//! Connections between attributes of nodes.

use crate::attributes::Attribute;

use super::node::NodeId;

/// An attribute of a node, or one element of it where it holds many.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Plug {
    /// The node.
    pub node: NodeId,
    /// Its attribute.
    pub attribute: &'static Attribute,
    /// The element, for those that hold many: `inputActive[2]`.
    pub index: Option<u32>,
}

/// Data that flows from an output to an input.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Connection {
    /// The output.
    pub from: Plug,
    /// The input.
    pub to: Plug,
}
