//! Meshes of a scene: their points for the rule of thickness, and embedded in a shape.

use std::collections::HashMap;
use std::fmt::Write;

use nucleus_core::Surface;
use nucleus_graph::attributes::mesh;
use nucleus_graph::compile::{file_mesh, primitive_surface};
use nucleus_graph::graph::NodeId;
use nucleus_graph::scene::Diagnostic;

use crate::omissions::Cause;

use super::writer::Writer;

impl Writer<'_> {
    /// The surface of a mesh node at the first frame; `None` for a mesh that only displays another.
    pub(super) fn surface_of(&self, id: NodeId) -> Result<Option<Surface>, String> {
        let node = self.graph().node(id);
        match primitive_surface(node) {
            Some(surface) => surface.map(Some).map_err(|error| format!("`{}`: {error}", node.name())),
            None => self.file_surface(id),
        }
    }

    fn file_surface(&self, id: NodeId) -> Result<Option<Surface>, String> {
        Ok(self.file_mesh(id)?.map(|(surface, _)| surface))
    }

    /// The mesh of a file at the first frame, and whether the file moves it.
    fn file_mesh(&self, id: NodeId) -> Result<Option<(Surface, bool)>, String> {
        let node = self.graph().node(id);
        if !node.node_type().is_a(&mesh::MESH) || node.get(&mesh::FILE).is_empty() {
            return Ok(None);
        }
        let refused = |found: Vec<Diagnostic>| found.first().map_or(String::new(), |one| one.message.clone());
        file_mesh(self.scene, id).map(Some).map_err(refused)
    }

    /// Points, edges and faces of a mesh.
    pub(super) fn embedded_mesh(&mut self, id: NodeId) -> Result<(), String> {
        let Some((surface, moves)) = self.file_mesh(id)? else { return Ok(()) };
        if moves {
            let why = "its file moves it; the scene for Maya has its shape at the first frame".to_owned();
            self.omissions.add(self.graph().node(id).name(), Cause::Motion(why));
        }
        let count = surface.positions.len();
        let mut text = String::new();
        let _ = write!(text, "\tsetAttr -s {count} \".vt[0:{}]\"", count.saturating_sub(1));
        for p in &surface.positions {
            let _ = write!(text, "\n\t\t{} {} {}", p.x, p.y, p.z);
        }
        text.push_str(";\n");
        let mut numbers: HashMap<(u32, u32), i64> = HashMap::new();
        let (mut edges, mut faces) = (String::new(), String::new());
        for face in surface.faces.iter() {
            let _ = write!(faces, "\n\t\tf {}", face.len());
            for (k, &a) in face.iter().enumerate() {
                let b = face[(k + 1) % face.len()];
                let next = numbers.len() as i64;
                // An edge that is walked backwards has the number -1 - n.
                let number = match numbers.get(&(b, a)) {
                    Some(number) => -1 - number,
                    None => *numbers.entry((a, b)).or_insert_with(|| {
                        let _ = write!(edges, "\n\t\t{a} {b} 0");
                        next
                    }),
                };
                let _ = write!(faces, " {number}");
            }
        }
        let _ = writeln!(
            text,
            "\tsetAttr -s {} \".ed[0:{}]\"{edges};",
            numbers.len(),
            numbers.len().saturating_sub(1)
        );
        let faces_count = surface.faces.len();
        let _ = writeln!(
            text,
            "\tsetAttr -s {faces_count} \".fc[0:{}]\" -type \"polyFaces\"{faces};",
            faces_count.saturating_sub(1)
        );
        self.text.push_str(&text);
        Ok(())
    }
}
