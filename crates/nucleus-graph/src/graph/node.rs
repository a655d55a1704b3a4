//! Nodes, their plugs, and the connections between plugs, as data.

use std::collections::BTreeMap;

use crate::attributes::{Attribute, Data, FromValue, Key, Kind, NodeType, Value};

use super::setting::Setting;

/// Identifies a node of one graph: its number in the order of addition.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct NodeId(pub(super) u32);

impl NodeId {
    pub(super) fn index(self) -> usize {
        self.0 as usize
    }
}

/// A node: its type, its settings and its parent.
#[derive(Debug, Clone, PartialEq)]
pub struct Node {
    pub(super) name: String,
    pub(super) node_type: &'static NodeType,
    pub(super) settings: BTreeMap<&'static str, Setting>,
    /// Settings from a preset. `settings` has precedence.
    pub(super) preset: BTreeMap<&'static str, Setting>,
    pub(super) parent: Option<NodeId>,
    pub(super) created_by: Option<NodeId>,
    pub(super) blend_target: Option<NodeId>,
}

impl Node {
    /// The name, unique in its graph.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The type.
    pub fn node_type(&self) -> &'static NodeType {
        self.node_type
    }

    /// The transform that this node inherits its placement from.
    pub fn parent(&self) -> Option<NodeId> {
        self.parent
    }

    /// The node whose creation command added this one. Scene files leave such nodes out.
    pub fn created_by(&self) -> Option<NodeId> {
        self.created_by
    }

    /// The settings by long name, without those of the preset. Defaults are not listed.
    pub fn settings(&self) -> &BTreeMap<&'static str, Setting> {
        &self.settings
    }

    /// The setting of one attribute, from the node or else from its preset.
    pub fn setting<T>(&self, key: &Key<T>) -> Option<&Setting> {
        self.set_or_preset(key.row.name)
    }

    /// The settings of the preset by long name.
    pub fn preset(&self) -> &BTreeMap<&'static str, Setting> {
        &self.preset
    }

    pub(super) fn set_or_preset(&self, name: &str) -> Option<&Setting> {
        self.settings.get(name).or_else(|| self.preset.get(name))
    }

    /// The value of an attribute that cannot be keyed.
    pub fn get<T: FromValue>(&self, key: &Key<T>) -> T {
        self.at(key, 0.0)
    }

    /// The value of an attribute at a frame: its setting, else the default of the nearest row. Connections do
    /// not count; see [`EvalContext::get`](super::EvalContext::get).
    ///
    /// # Panics
    /// When the node's type has no such attribute.
    pub fn at<T: FromValue>(&self, key: &Key<T>, frame: f64) -> T {
        let row = self.row(key);
        let value = match self.set_or_preset(row.name) {
            Some(setting) => T::from_value(&setting.at(frame, row)),
            None => row.default.as_ref().and_then(T::from_value),
        };
        value.unwrap_or_else(|| unreachable!("`{}` holds values of its own kind", row.name))
    }

    /// The value of an attribute at a frame. `None` for attributes that have no value and are only connected.
    pub(super) fn value_at(&self, row: &'static Attribute, frame: f64) -> Option<Value> {
        match self.set_or_preset(row.name) {
            Some(setting) => Some(setting.at(frame, row)),
            None => row.default.clone(),
        }
    }

    /// Whether the setting of an attribute changes from frame to frame.
    pub fn changes<T>(&self, key: &Key<T>) -> bool {
        self.setting(key).is_some_and(Setting::changes)
    }

    /// Whether a number is nonzero at any frame.
    pub fn is_ever_nonzero<T>(&self, key: &Key<T>) -> bool {
        match self.setting(key) {
            Some(setting) => setting.is_ever_nonzero(),
            None => {
                let is_zero = |default: &Value| match default {
                    Value::Vector(parts) => *parts == [0.0; 3],
                    other => matches!(other, Value::Float(0.0) | Value::Int(0) | Value::Bool(false)),
                };
                !self.row(key).default.as_ref().is_some_and(is_zero)
            }
        }
    }

    /// The row of the attribute in the table of this node's type.
    fn row<T>(&self, key: &Key<T>) -> &'static Attribute {
        let row = self.node_type.attribute(key.row.name);
        row.unwrap_or_else(|| unreachable!("a {} has no `{}`", self.node_type.name, key.row.name))
    }
}

/// An attribute of a node, one element of a multi attribute, or one component of a vector.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Plug {
    /// The node.
    pub node: NodeId,
    /// The attribute.
    pub attribute: &'static Attribute,
    /// The element of a multi attribute: `inputActive[2]`.
    pub index: Option<u32>,
    /// The component of a vector, 0 to 2: `translateY`.
    pub part: Option<usize>,
}

/// Data flow from an output to an input.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Connection {
    /// The output.
    pub from: Plug,
    /// The input.
    pub to: Plug,
}

impl Plug {
    /// The plug of a whole attribute.
    pub fn new<T>(node: NodeId, key: &'static Key<T>) -> Self {
        Self { node, attribute: &key.row, index: None, part: None }
    }

    /// One element of a multi attribute.
    pub fn element<T>(node: NodeId, key: &'static Key<T>, index: u32) -> Self {
        Self { index: Some(index), ..Self::new(node, key) }
    }

    /// The data that flows through the plug. `None` if it cannot be connected.
    pub fn carries(&self) -> Option<Data> {
        match (self.part, self.attribute.kind) {
            (Some(_), Kind::Vector(_)) => Some(Data::Number),
            (_, kind) => kind.carries(),
        }
    }

    /// Whether the plugs are equal, or one is a component or an element of the other.
    pub fn overlaps(&self, other: &Self) -> bool {
        let agree = |a: Option<usize>, b: Option<usize>| a.is_none() || b.is_none() || a == b;
        let index = |plug: &Self| plug.index.map(|index| index as usize);
        self.node == other.node
            && self.attribute.name == other.attribute.name
            && agree(index(self), index(other))
            && agree(self.part, other.part)
    }
}
