//! A node: its type, what is set on it, and how a value is read.

use std::collections::BTreeMap;

use crate::attributes::{Attribute, FromValue, Key, NodeType, Value};

use super::setting::Setting;

/// A node of a graph, counted in the order in which nodes were added.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct NodeId(pub(super) u32);

impl NodeId {
    pub(super) fn place(self) -> usize {
        self.0 as usize
    }
}

/// A node.
#[derive(Debug, Clone, PartialEq)]
pub struct Node {
    pub(super) name: String,
    pub(super) node_type: &'static NodeType,
    pub(super) settings: BTreeMap<&'static str, Setting>,
    /// What a preset sets, where nothing is set here.
    pub(super) preset: BTreeMap<&'static str, Setting>,
    pub(super) parent: Option<NodeId>,
    pub(super) made_by: Option<NodeId>,
    pub(super) blend_target: Option<NodeId>,
}

impl Node {
    /// Its name.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Its type.
    pub fn node_type(&self) -> &'static NodeType {
        self.node_type
    }

    /// The transform it moves along with.
    pub fn parent(&self) -> Option<NodeId> {
        self.parent
    }

    /// The node it was made for, if a creation command made it. Such nodes are not written to scenes.
    pub fn made_by(&self) -> Option<NodeId> {
        self.made_by
    }

    /// What is set on it, by long name; defaults are not listed.
    pub fn settings(&self) -> &BTreeMap<&'static str, Setting> {
        &self.settings
    }

    /// What is set on one attribute, here or by a preset.
    pub fn setting<T>(&self, key: &Key<T>) -> Option<&Setting> {
        self.set_or_preset(key.row.name)
    }

    /// What its preset sets, by long name.
    pub fn preset(&self) -> &BTreeMap<&'static str, Setting> {
        &self.preset
    }

    pub(super) fn set_or_preset(&self, name: &str) -> Option<&Setting> {
        self.settings.get(name).or_else(|| self.preset.get(name))
    }

    /// The value of an attribute that cannot change from frame to frame.
    pub fn get<T: FromValue>(&self, key: &Key<T>) -> T {
        self.at(key, 0.0)
    }

    /// The value of an attribute at a frame: what is set, else the default of the nearest row.
    ///
    /// # Panics
    /// When the node's type has no such attribute.
    pub fn at<T: FromValue>(&self, key: &Key<T>, frame: f64) -> T {
        let row = self.row(key);
        let value = match self.set_or_preset(row.name) {
            Some(setting) => T::from_value(&setting.at(frame, row)),
            None => row.default.as_ref().and_then(T::from_value),
        };
        value.unwrap_or_else(|| unreachable!("`{}` is read as what it holds", row.name))
    }

    /// What one of its attributes holds at a frame; nothing for what is only connected.
    pub(super) fn value_at(&self, row: &'static Attribute, frame: f64) -> Option<Value> {
        match self.set_or_preset(row.name) {
            Some(setting) => Some(setting.at(frame, row)),
            None => row.default.clone(),
        }
    }

    /// Whether an attribute changes from frame to frame.
    pub fn changes<T>(&self, key: &Key<T>) -> bool {
        self.setting(key).is_some_and(Setting::changes)
    }

    /// Whether a number is other than zero at any time.
    pub fn is_ever_nonzero<T>(&self, key: &Key<T>) -> bool {
        match self.setting(key) {
            Some(setting) => setting.is_ever_nonzero(),
            None => {
                !matches!(self.row(key).default, Some(Value::Float(0.0) | Value::Int(0) | Value::Bool(false)))
            }
        }
    }

    /// The row that holds for this node's type.
    fn row<T>(&self, key: &Key<T>) -> &'static Attribute {
        let row = self.node_type.attribute(key.row.name);
        row.unwrap_or_else(|| unreachable!("a {} has no `{}`", self.node_type.name, key.row.name))
    }
}
