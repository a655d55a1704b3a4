//! Nodes, names and connections.

use std::collections::HashMap;

use crate::ascii::{PlugPath, SourceText, Span};
use crate::omissions::Omissions;

use super::units::Units;

/// A node of a Maya scene.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct NodeId(pub u32);

/// A value that a file gives an attribute.
#[derive(Debug, Clone, Copy)]
pub struct Assigned {
    /// The path of the attribute inside its node.
    pub plug: Span,
    /// What `-type` says; empty if nothing.
    pub data_type: Span,
    /// The values.
    pub value: Span,
}

/// A node.
#[derive(Debug)]
pub struct MayaNode {
    /// The name with its namespaces, without the path.
    pub name: Box<str>,
    /// Maya's type.
    pub kind: Box<str>,
    /// The parent in the DAG.
    pub parent: Option<NodeId>,
    /// The file that creates it.
    pub file: u16,
    /// All values, in the order of the files.
    pub assigned: Vec<Assigned>,
    /// Attributes that a file adds: long and short name.
    pub added: Vec<(Box<str>, Box<str>)>,
}

/// An end of a connection.
#[derive(Debug, Clone, Copy)]
pub struct PlugRef {
    /// The node.
    pub node: NodeId,
    /// The path of the attribute inside it.
    pub path: Span,
}

/// A connection.
#[derive(Debug, Clone, Copy)]
pub struct Wire {
    /// The output.
    pub from: PlugRef,
    /// The input.
    pub to: PlugRef,
}

/// A scene of Maya, with all files that it refers to.
#[derive(Debug, Default)]
pub struct MayaScene {
    /// The files, the scene itself first; and values that edits of references hold.
    pub texts: Vec<SourceText>,
    /// The nodes in the order of creation.
    pub nodes: Vec<MayaNode>,
    by_name: HashMap<Box<str>, Vec<NodeId>>,
    /// The connections in the order of the files.
    pub wires: Vec<Wire>,
    arriving: HashMap<NodeId, Vec<u32>>,
    leaving: HashMap<NodeId, Vec<u32>>,
    /// The units of the scene.
    pub units: Units,
    /// The units of each file. Edits of references are in those of the scene.
    pub(super) file_units: Vec<Units>,
    /// First and last frame of the playback range.
    pub playback: Option<[f64; 2]>,
    /// `fileInfo` entries.
    pub file_info: Vec<(String, String)>,
    /// What could not be read.
    pub omissions: Omissions,
}

impl MayaScene {
    /// A node.
    pub fn node(&self, id: NodeId) -> &MayaNode {
        &self.nodes[id.0 as usize]
    }

    /// The type of a node.
    pub fn kind(&self, id: NodeId) -> &str {
        &self.node(id).kind
    }

    /// The name of a node.
    pub fn name(&self, id: NodeId) -> &str {
        &self.node(id).name
    }

    /// The units of the file that creates a node.
    pub fn units_of(&self, id: NodeId) -> Units {
        self.units_in(self.node(id).file)
    }

    /// The units of a file.
    pub(super) fn units_in(&self, file: u16) -> Units {
        self.file_units.get(usize::from(file)).copied().unwrap_or(self.units)
    }

    /// All nodes.
    pub fn ids(&self) -> impl Iterator<Item = NodeId> + use<> {
        (0..self.nodes.len() as u32).map(NodeId)
    }

    /// All nodes of a type.
    pub fn of_kind<'a>(&'a self, kind: &'a str) -> impl Iterator<Item = NodeId> + 'a {
        self.ids().filter(move |id| self.kind(*id) == kind)
    }

    /// The text of a place.
    pub fn text(&self, span: Span) -> &str {
        let text = self.texts.get(usize::from(span.file)).map_or("", |source| source.text.as_str());
        text.get(span.start as usize..span.end as usize).unwrap_or_default()
    }

    /// The path of an end of a connection.
    pub fn path(&self, plug: PlugRef) -> PlugPath<'_> {
        PlugPath(self.text(plug.path))
    }

    pub(super) fn add(&mut self, name: &str, kind: &str, parent: Option<NodeId>, file: u16) -> NodeId {
        let id = NodeId(self.nodes.len() as u32);
        self.nodes.push(MayaNode {
            name: name.into(),
            kind: kind.into(),
            parent,
            file,
            assigned: Vec::new(),
            added: Vec::new(),
        });
        self.by_name.entry(name.into()).or_default().push(id);
        id
    }

    pub(super) fn rename(&mut self, id: NodeId, name: &str) {
        let old = std::mem::replace(&mut self.nodes[id.0 as usize].name, name.into());
        if let Some(all) = self.by_name.get_mut(&old) {
            all.retain(|other| *other != id);
        }
        self.by_name.entry(name.into()).or_default().push(id);
    }

    /// The node of a name or of a full or partial DAG path. Of several, the last one created.
    pub fn find(&self, path: &str) -> Option<NodeId> {
        let mut parts = path.rsplit('|');
        let last = parts.next()?;
        let last = last.strip_prefix(':').unwrap_or(last);
        let candidates = self.by_name.get(last)?;
        if candidates.len() == 1 && !path.contains('|') {
            return candidates.first().copied();
        }
        let parents: Vec<&str> = parts.map(|part| part.strip_prefix(':').unwrap_or(part)).collect();
        let fits = |id: &&NodeId| {
            let mut at = self.node(**id).parent;
            for parent in &parents {
                match (parent.is_empty(), at) {
                    // A path that begins with `|` ends at the world.
                    (true, at) => return at.is_none(),
                    (false, Some(node)) if self.name(node) == *parent => at = self.node(node).parent,
                    _ => return false,
                }
            }
            true
        };
        // A path through an instance does not fit the parents; its last part then still says enough.
        candidates.iter().rev().find(fits).or(candidates.last()).copied()
    }

    pub(super) fn connect(&mut self, from: PlugRef, to: PlugRef) {
        let index = self.wires.len() as u32;
        self.wires.push(Wire { from, to });
        self.leaving.entry(from.node).or_default().push(index);
        self.arriving.entry(to.node).or_default().push(index);
    }

    /// Removes the connections between two attributes. Returns whether no connection between their nodes is left over that
    /// may have been meant.
    pub(super) fn disconnect(&mut self, [from, to]: [NodeId; 2], [out, input]: [PlugPath; 2]) -> bool {
        let joins = |wire: &Wire| wire.from.node == from && wire.to.node == to;
        let is_it = |wire: &Wire| {
            joins(wire) && self.path(wire.from).is_same(out) && self.path(wire.to).is_same(input)
        };
        let kept: Vec<Wire> = self.wires.iter().copied().filter(|wire| !is_it(wire)).collect();
        if kept.len() == self.wires.len() {
            return !kept.iter().any(joins);
        }
        self.wires.clear();
        self.arriving.clear();
        self.leaving.clear();
        kept.into_iter().for_each(|wire| self.connect(wire.from, wire.to));
        true
    }

    /// Connections to inputs of a node.
    pub fn arriving(&self, id: NodeId) -> impl DoubleEndedIterator<Item = Wire> + '_ {
        self.arriving.get(&id).into_iter().flatten().map(|index| self.wires[*index as usize])
    }

    /// Connections from outputs of a node.
    pub fn leaving(&self, id: NodeId) -> impl DoubleEndedIterator<Item = Wire> + '_ {
        self.leaving.get(&id).into_iter().flatten().map(|index| self.wires[*index as usize])
    }

    /// The node and its ancestors.
    pub fn self_and_ancestors(&self, id: NodeId) -> Vec<NodeId> {
        let mut all = vec![id];
        while let Some(parent) = self.node(all[all.len() - 1]).parent {
            if all.contains(&parent) {
                break;
            }
            all.push(parent);
        }
        all
    }

    /// The children of every node, in the order of creation.
    pub fn children(&self) -> HashMap<NodeId, Vec<NodeId>> {
        let mut children: HashMap<NodeId, Vec<NodeId>> = HashMap::new();
        for id in self.ids() {
            if let Some(parent) = self.node(id).parent {
                children.entry(parent).or_default().push(id);
            }
        }
        children
    }
}
