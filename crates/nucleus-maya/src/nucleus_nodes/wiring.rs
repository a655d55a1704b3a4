//! Connections: those of Maya's creation commands, made again, and all others between nodes that are carried over.

use nucleus_graph::attributes::{n_base, transform};
use nucleus_graph::graph::{Creation, GraphError, NodeId as OwnId, Plug, may_be_from_creation};

use crate::omissions::Cause;
use crate::scene::{NodeId, PlugRef, Wire};

use super::importer::Importer;
use super::kept::nucleus_of;

impl Importer<'_> {
    /// Connects an object to its mesh and its nucleus.
    pub(super) fn connect_object(&mut self, from: NodeId, to: OwnId) {
        let Some(nucleus) = nucleus_of(self.scene, from).and_then(|id| self.own_of(id)) else { return };
        let source = self.scene.source(from, &["imsh", "inputMesh"], None);
        if let Some(wire) = source
            && let Some((number @ 1.., _)) = self.scene.path(wire.from).last().range
            && self.scene.kind(wire.from.node) == "mesh"
        {
            let what = self.graph.node(to).name().to_owned();
            let which = format!("{}.worldMesh[{number}]", self.scene.name(wire.from.node));
            self.omissions.add(what, Cause::Instance(which));
        }
        let mesh = source.and_then(|wire| self.own_of(wire.from.node));
        self.create(to, &Creation::Object { mesh, nucleus });
    }

    /// Makes the connections of a creation command.
    pub(super) fn create(&mut self, to: OwnId, creation: &Creation) {
        if let Err(error) = self.graph.create(to, creation) {
            self.omissions.add(self.graph.node(to).name(), Cause::Connection(error.to_string()));
        }
    }

    /// Connects a field or an emitter to the first of its objects; further ones by their own connections.
    pub(super) fn connect_effect(&mut self, from: NodeId, to: OwnId) {
        let outputs = ["of", "outputForce", "ot", "output"];
        let leaving =
            self.scene.leaving(from).filter(|wire| outputs.contains(&self.scene.path(wire.from).last().name));
        let index = |wire: &Wire| self.scene.path(wire.from).last().range.map_or(0, |range| range.0);
        let Some(wire) = leaving.min_by_key(index) else { return };
        let Some(target) = self.own_of(wire.to.node) else { return };
        // An emitter is driven by time, a field is not.
        self.create(to, &Creation::Effect { target });
    }

    /// Makes all other connections between nodes that are carried over.
    pub(super) fn connect_the_rest(&mut self) {
        for wire in &self.scene.wires {
            let (Some(out), Some(input)) = (self.plug(wire.from), self.plug(wire.to)) else { continue };
            let placed = [&transform::TRANSLATE.row, &transform::ROTATE.row, &transform::SCALE.row];
            // Gaps in the indices of created inputs, which deletions leave, close up.
            let is_created = may_be_from_creation(input)
                || placed.contains(&input.attribute)
                || out.node == self.graph.clock();
            if !is_created {
                self.join(out, input);
            }
        }
    }

    /// Connects two plugs. A connection that a creation command has already made is no omission.
    pub(super) fn join(&mut self, from: Plug, to: Plug) {
        match self.graph.connect(from, to) {
            Ok(()) | Err(GraphError::InputTaken { .. }) => {}
            Err(error) => {
                let what = format!("{} to {}", self.graph.describe(from), self.graph.describe(to));
                self.omissions.add(what, Cause::Connection(error.to_string()));
            }
        }
    }

    /// Our plug for a plug of Maya's; `None` if its node or its attribute is not carried over.
    fn plug(&self, plug: PlugRef) -> Option<Plug> {
        let scene = self.scene;
        let node = match scene.kind(plug.node) {
            "time" => self.graph.clock(),
            _ => self.own_of(plug.node)?,
        };
        let node_type = self.graph.node(node).node_type();
        let last = scene.path(plug).last();
        let index = last.range.map(|range| range.0);
        if let Some(attribute) = node_type.attribute(last.name) {
            // The first element of a multi attribute may be written without its index.
            let index = if attribute.multi { index.or(Some(0)) } else { None };
            return Some(Plug { node, attribute, index, part: None });
        }
        let (attribute, part) = node_type.part(last.name)?;
        Some(Plug { node, attribute, index: None, part: Some(part) })
    }

    /// Whether a Nucleus object has its mesh and its nucleus.
    pub(super) fn is_joined(&self, to: OwnId) -> bool {
        self.graph.targets(to, &n_base::CURRENT_STATE).next().is_some()
    }
}
