//! A Nucleus node as Maya's: a transform and a shape, a node with a transform of its own, or a plain node.

use std::fmt::Write;

use nucleus_graph::attributes::{Attribute, mesh, n_base, n_cloth, nucleus, surface_shape};
use nucleus_graph::graph::NodeId;

use crate::nucleus_nodes::{MARK_AUTOMATIC, MARK_NAME};
use crate::omissions::Cause;

use super::writer::{Writer, is_of_transform, quoted};

impl Writer<'_> {
    /// Writes a node with its values.
    pub(super) fn node(&mut self, id: NodeId) -> Result<(), String> {
        let node = self.graph().node(id);
        let node_type = node.node_type();
        let [outer, shape] = self.names[&id].clone();
        let parent =
            node.parent().map(|parent| format!(" -p {}", quoted(&self.path(parent)))).unwrap_or_default();
        let is_surface = node_type.is_a(&surface_shape::SURFACE_SHAPE);
        let kind = if is_surface { "mesh" } else { node_type.name };
        if self.has_shape(id) {
            let _ = writeln!(self.text, "createNode transform -n \"{outer}\"{parent};");
            self.mark_name(id, &outer);
            self.settings(id, is_of_transform);
            let path = self.path(id);
            let _ = writeln!(self.text, "createNode {kind} -n \"{shape}\" -p {};", quoted(&path));
        } else {
            let _ = writeln!(self.text, "createNode {kind} -n \"{outer}\"{parent};");
            self.mark_name(id, &outer);
            self.settings(id, is_of_transform);
        }
        if is_surface {
            return self.surface(id);
        }
        self.settings(id, |row| !is_of_transform(row));
        let mut automatic = self.creation_values(id)?;
        automatic.extend(self.preset_values(id));
        if node_type == &nucleus::NUCLEUS && node.setting(&nucleus::START_FRAME).is_none() {
            let _ = writeln!(self.text, "\tsetAttr \".stf\" {};", self.scene.time.start);
            automatic.push(nucleus::START_FRAME.row.name);
        }
        if node_type == &nucleus::NUCLEUS && node.setting(&nucleus::RESISTANCE_MODEL).is_none() {
            self.add_enum(&nucleus::RESISTANCE_MODEL.row);
        }
        if !automatic.is_empty() {
            self.add_text(MARK_AUTOMATIC, &automatic.join(" "));
        }
        Ok(())
    }

    /// A mesh: with the values of the transform, and its points or its creation node.
    fn surface(&mut self, id: NodeId) -> Result<(), String> {
        let graph = self.graph();
        let node = graph.node(id);
        let feeds_cloth = graph.leaving(id).any(|wire| {
            wire.to.attribute == &n_base::INPUT_MESH.row
                && graph.node(wire.to.node).node_type().is_a(&n_cloth::N_CLOTH)
        });
        // The input mesh of a cloth is hidden, but stays live.
        if feeds_cloth {
            self.text.push_str("\tsetAttr \".io\" yes;\n");
        }
        if graph.blend_target(id).is_some() {
            self.omissions.add(node.name(), Cause::Operator("blendTarget".to_owned()));
        }
        if graph.source(id, &surface_shape::IN_MESH).is_some() {
            return Ok(());
        }
        if node.node_type() == &mesh::MESH {
            self.settings(id, |row| !is_of_transform(row));
            return self.embedded_mesh(id);
        }
        // The creation node has the attributes of the primitive, the shape all others.
        let is_own = |row: &Attribute| node.node_type().rows.contains(&row);
        self.settings(id, |row| !is_of_transform(row) && !is_own(row));
        let [_, shape] = self.names[&id].clone();
        let kind = node.node_type().name;
        let maker = self.free_name(&format!("{kind}_{}", node.name()));
        let _ = writeln!(self.text, "createNode {kind} -n \"{maker}\";");
        self.settings_of(id, &maker, is_own);
        let _ = writeln!(self.tail, "connectAttr \"{maker}.out\" \"{shape}.i\";");
        Ok(())
    }

    /// The DAG path of a node's transform.
    fn path(&self, id: NodeId) -> String {
        let mut parts = vec![self.names[&id][0].as_str()];
        let mut at = self.graph().node(id).parent();
        while let Some(parent) = at {
            parts.push(self.names[&parent][0].as_str());
            at = self.graph().node(parent).parent();
        }
        parts.reverse();
        format!("|{}", parts.join("|"))
    }

    /// Keeps a name that Maya does not allow.
    fn mark_name(&mut self, id: NodeId, written: &str) {
        let name = self.graph().node(id).name();
        if name != written {
            self.add_text(MARK_NAME, name);
        }
    }

    /// Adds an attribute of text with its value.
    pub(super) fn add_text(&mut self, name: &str, text: &str) {
        let _ = write!(
            self.text,
            "\taddAttr -ci true -sn \"{name}\" -ln \"{name}\" -dt \"string\";\n\tsetAttr \".{name}\" -type \"string\" {};\n",
            quoted(text)
        );
    }

    /// Adds an attribute that is an enum, at its default.
    pub(super) fn add_enum(&mut self, row: &Attribute) {
        let words: Vec<String> =
            row.words().into_iter().map(|(choice, word)| format!("{word}={}", choice.0)).collect();
        let default = match row.default {
            Some(nucleus_graph::attributes::Value::Choice(choice)) => choice.0,
            _ => 0,
        };
        let _ = writeln!(
            self.text,
            "\taddAttr -ci true -k true -sn \"{0}\" -ln \"{0}\" -dv {default} -at \"enum\" -en \"{1}\";",
            row.name,
            words.join(":")
        );
    }
}
