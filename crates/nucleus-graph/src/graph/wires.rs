//! The connections of a graph at one of their ends, indexed by node, attribute and element.

use std::collections::BTreeMap;

use super::node::{Connection, NodeId, Plug};

/// All connections by their plug at one end.
#[derive(Debug, Clone, Default)]
pub(super) struct Wires {
    /// By node, in the order of connecting.
    by_node: BTreeMap<NodeId, Vec<Connection>>,
    /// By attribute and element, in the order of connecting. No entry is empty.
    by_element: BTreeMap<(NodeId, &'static str, Option<u32>), Vec<Connection>>,
    /// The first element of each multi attribute without a connection; a missing entry means 0.
    first_free: BTreeMap<(NodeId, &'static str), u32>,
}

impl Wires {
    /// Adds a connection whose end is `plug`.
    pub(super) fn insert(&mut self, plug: Plug, connection: Connection) {
        let (node, name) = (plug.node, plug.attribute.name);
        self.by_node.entry(node).or_default().push(connection);
        self.by_element.entry((node, name, plug.index)).or_default().push(connection);
        let free = self.first_free.entry((node, name)).or_default();
        while self.by_element.contains_key(&(node, name, Some(*free))) {
            *free += 1;
        }
    }

    /// Removes a connection whose end is `plug`; returns whether it existed.
    pub(super) fn remove(&mut self, plug: Plug, connection: Connection) -> bool {
        let (node, name) = (plug.node, plug.attribute.name);
        let key = (node, name, plug.index);
        let Some(wires) = self.by_element.get_mut(&key) else { return false };
        let before = wires.len();
        wires.retain(|other| *other != connection);
        if wires.len() == before {
            return false;
        }
        if wires.is_empty() {
            self.by_element.remove(&key);
            let free = self.first_free.entry((node, name)).or_default();
            *free = plug.index.map_or(*free, |index| index.min(*free));
        }
        if let Some(wires) = self.by_node.get_mut(&node) {
            wires.retain(|other| *other != connection);
        }
        true
    }

    /// The connections of a node, in the order of connecting.
    pub(super) fn of_node(&self, node: NodeId) -> &[Connection] {
        self.by_node.get(&node).map_or(&[], Vec::as_slice)
    }

    /// The connections of an attribute, by element, then in the order of connecting.
    pub(super) fn of_attribute(&self, node: NodeId, name: &'static str) -> impl Iterator<Item = &Connection> {
        let elements = (node, name, None)..=(node, name, Some(u32::MAX));
        self.by_element.range(elements).flat_map(|(_, wires)| wires)
    }

    /// The connections of an element, or of an attribute that is not multi.
    pub(super) fn of_element(&self, plug: Plug) -> &[Connection] {
        let key = (plug.node, plug.attribute.name, plug.index);
        self.by_element.get(&key).map_or(&[], Vec::as_slice)
    }

    /// The first element without a connection on all of these multi attributes.
    pub(super) fn first_free(&self, node: NodeId, names: &[&'static str]) -> u32 {
        let free = |name: &&'static str| self.first_free.get(&(node, *name)).copied().unwrap_or_default();
        let least = names.iter().map(free).max().unwrap_or_default();
        let is_free = |element: &u32| {
            names.iter().all(|name| !self.by_element.contains_key(&(node, *name, Some(*element))))
        };
        (least..).find(is_free).unwrap_or_default()
    }

    /// All connections, by node, then in the order of connecting.
    pub(super) fn all(&self) -> impl Iterator<Item = &Connection> {
        self.by_node.values().flatten()
    }
}
