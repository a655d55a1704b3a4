//! Connections: those of Maya's creation commands, made again, and all others between nodes that are carried over.

use nucleus_graph::attributes::{Effect, Kind, n_base, surface_shape, transform};
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
        if let Some(wire) = source {
            self.report_instance(wire.from, to);
        }
        let mesh = source.and_then(|wire| self.own_of(wire.from.node));
        self.create(to, &Creation::Object { mesh, nucleus });
    }

    /// Notes a mesh that is not the first instance of its shape.
    fn report_instance(&mut self, mesh: PlugRef, to: OwnId) {
        if let Some((number @ 1.., _)) = self.scene.path(mesh).last().range
            && self.scene.kind(mesh.node) == "mesh"
        {
            let what = self.graph.node(to).name().to_owned();
            let which = format!("{}.worldMesh[{number}]", self.scene.name(mesh.node));
            self.omissions.add(what, Cause::Instance(which));
        }
    }

    /// Notes a mesh that Maya takes without the scale of its transform.
    fn report_object_space(&mut self, mesh: PlugRef, to: OwnId) {
        let is_local = matches!(self.scene.path(mesh).last().name, "o" | "outMesh");
        let placed = self.values.world(mesh.node, self.frames[0] as f64).decomposed(0);
        let is_scaled = placed.is_none_or(|[_, _, scale]| scale.iter().any(|s| (s - 1.0).abs() > 1e-9));
        if is_local && is_scaled {
            let why = format!("the scale of `{}` is applied to its `outMesh`", self.scene.name(mesh.node));
            self.omissions.add(self.graph.node(to).name(), Cause::Approximate(why));
        }
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

    /// Makes all other connections to nodes that are carried over; one that cannot be made is an omission.
    pub(super) fn connect_the_rest(&mut self) {
        for wire in &self.scene.wires {
            let Some(input) = self.plug(wire.to) else { continue };
            let placed = [&transform::TRANSLATE.row, &transform::ROTATE.row, &transform::SCALE.row];
            // Gaps in the indices of created inputs, which deletions leave, close up.
            if may_be_from_creation(input) || placed.contains(&input.attribute) {
                continue;
            }
            match self.plug(wire.from) {
                Some(out) if out.node == self.graph.clock() => {}
                Some(out) if out.attribute == &surface_shape::WORLD_MESH.row && !self.is_own => {
                    self.report_instance(wire.from, input.node);
                    self.report_object_space(wire.from, input.node);
                    self.join(Plug { index: Some(0), ..out }, input);
                }
                Some(out) => self.join(out, input),
                None if self.is_read_elsewhere(*wire, input) => {}
                None => self.report_unread(*wire, input),
            }
        }
    }

    /// Whether the values of an input follow its source, or nothing that is solved depends on it.
    fn is_read_elsewhere(&self, wire: Wire, input: Plug) -> bool {
        // Caches are reported with their object.
        let is_cache = matches!(self.scene.kind(wire.from.node), "cacheFile" | "cacheBlend");
        let is_number = input.part.is_some()
            || matches!(
                input.attribute.kind,
                Kind::Bool | Kind::Int | Kind::Float | Kind::Choice(_) | Kind::Texture
            );
        is_cache || is_number || !matches!(input.attribute.effect, Effect::Solved(_))
    }

    fn report_unread(&mut self, wire: Wire, input: Plug) {
        let (node, path) = (wire.from.node, self.scene.path(wire.from).0);
        let what = format!("{}.{path} to {}", self.scene.name(node), self.graph.describe(input));
        let why = format!("`{path}` of a {} is not read", self.scene.kind(node));
        self.omissions.add(what, Cause::Connection(why));
    }

    /// Connects two plugs. A connection that a creation command has already made is no omission.
    pub(super) fn join(&mut self, from: Plug, to: Plug) {
        if let Some(lack) = to.attribute.effect.lack_of_connection() {
            return self.omissions.add(self.graph.describe(to), Cause::NoEffect(lack));
        }
        match self.graph.connect(from, to) {
            Ok(()) | Err(GraphError::InputTaken { .. }) => {}
            Err(error) => {
                let what = format!("{} to {}", self.graph.describe(from), self.graph.describe(to));
                self.omissions.add(what, Cause::Connection(error.to_string()));
            }
        }
    }

    /// Our plug for a plug of Maya's; `None` if its node or its attribute is not carried over.
    pub(super) fn plug(&self, plug: PlugRef) -> Option<Plug> {
        let scene = self.scene;
        let node = match scene.kind(plug.node) {
            "time" => self.graph.clock(),
            _ => self.own_of(plug.node)?,
        };
        let node_type = self.graph.node(node).node_type();
        let last = scene.path(plug).last();
        let index = last.range.map(|range| range.0);
        let name = if scene.kind(plug.node) == "mesh" { shape_row(last.name) } else { last.name };
        if let Some(attribute) = node_type.attribute(name) {
            // The first element of a multi attribute may be written without its index.
            let index = if attribute.multi { index.or(Some(0)) } else { None };
            return Some(Plug { node, attribute, index, part: None });
        }
        let (attribute, part) = node_type.part(name)?;
        Some(Plug { node, attribute, index: None, part: Some(part) })
    }

    /// Whether a Nucleus object has its mesh and its nucleus.
    pub(super) fn is_joined(&self, to: OwnId) -> bool {
        self.graph.targets(to, &n_base::CURRENT_STATE).next().is_some()
    }
}

/// The row of a mesh node for an output of Maya's shape, whose `w` is not the width of a primitive.
fn shape_row(name: &str) -> &str {
    match name {
        // Files that this crate wrote before connect `wm`, which in Maya is the world matrix.
        "w" | "wm" | "o" | "outMesh" => surface_shape::WORLD_MESH.row.name,
        name => name,
    }
}
