//! Plugs and connections between them.

use crate::attributes::{Attribute, Data, Key, Kind};

use super::node::NodeId;

/// An attribute of a node, one element of it where it holds many, or one part of a vector.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Plug {
    /// The node.
    pub node: NodeId,
    /// Its attribute.
    pub attribute: &'static Attribute,
    /// The element, for those that hold many: `inputActive[2]`.
    pub index: Option<u32>,
    /// The part of a vector, 0 to 2: `translateY`.
    pub part: Option<usize>,
}

/// Data that flows from an output to an input.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Connection {
    /// The output.
    pub from: Plug,
    /// The input.
    pub to: Plug,
}

impl Plug {
    /// A plug as a whole.
    pub fn new<T>(node: NodeId, key: &'static Key<T>) -> Self {
        Self { node, attribute: &key.row, index: None, part: None }
    }

    /// One element of a plug that holds many.
    pub fn element<T>(node: NodeId, key: &'static Key<T>, index: u32) -> Self {
        Self { index: Some(index), ..Self::new(node, key) }
    }

    /// What flows through it; nothing if it cannot be connected.
    pub fn carries(&self) -> Option<Data> {
        match (self.part, self.attribute.kind) {
            (Some(_), Kind::Vector(_)) => Some(Data::Number),
            (_, kind) => kind.carries(),
        }
    }

    /// Whether two plugs are the same, or one is a part or an element of the other.
    pub fn overlaps(&self, other: &Self) -> bool {
        let meet = |a: Option<usize>, b: Option<usize>| a.is_none() || b.is_none() || a == b;
        let index = |plug: &Self| plug.index.map(|index| index as usize);
        self.node == other.node
            && self.attribute.name == other.attribute.name
            && meet(index(self), index(other))
            && meet(self.part, other.part)
    }
}
