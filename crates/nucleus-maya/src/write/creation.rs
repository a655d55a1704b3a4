//! Values that Maya computes when it makes an object, written where the scene leaves them out; and those of presets.

use std::fmt::Write;

use nalgebra::Vector3;
use nucleus_graph::attributes::{Choice, n_base, n_cloth, n_rigid, nucleus};
use nucleus_graph::graph::NodeId;

use super::writer::Writer;

/// Thickness over the square root of the area of the bounding box, at most: cloth, collider.
const SHARES: [f64; 2] = [0.005, 0.003];
/// Thickness over the estimated edge length.
const EDGE_SHARE: f64 = 0.13;
/// The least thickness.
const MIN_THICKNESS: f64 = 1e-4;
/// Push-out radius over thickness.
const PUSH_OUT: f64 = 4.0;

impl Writer<'_> {
    /// Writes the values of creation that the scene leaves out; returns their names.
    pub(super) fn creation_values(&mut self, id: NodeId) -> Result<Vec<&'static str>, String> {
        let graph = self.graph();
        let node = graph.node(id);
        let is_cloth = node.node_type().is_a(&n_cloth::N_CLOTH);
        let is_collider = node.node_type().is_a(&n_rigid::N_RIGID);
        let mesh = graph.source(id, &n_base::INPUT_MESH);
        let (true, Some(mesh)) = (is_cloth || is_collider, mesh) else { return Ok(Vec::new()) };
        let mut lines: Vec<(&'static str, String)> = Vec::new();
        let (own, is_coarse) = self.thickness(mesh, SHARES[usize::from(is_collider)])?;
        let is_set = |name: &str| node.settings().contains_key(name) || node.preset().contains_key(name);
        let thickness = if is_set("thickness") { node.get(&n_base::THICKNESS) } else { own };
        lines.push(("thickness", format!("\".thss\" {own}")));
        lines.push(("pushOutRadius", format!("\".por\" {}", PUSH_OUT * thickness)));
        if is_collider {
            lines.push(("active", "\".actv\" no".to_owned()));
            lines.push(("selfCollide", "\".scld\" no".to_owned()));
            lines.push(("trappedCheck", "\".tpc\" yes".to_owned()));
        } else {
            let solver = graph.targets(id, &n_base::CURRENT_STATE).next().map(|plug| plug.node);
            let model = solver.map(|solver| graph.node(solver).get(&nucleus::RESISTANCE_MODEL));
            let (flag, scale) = match (model, is_coarse) {
                (Some(Choice(0)), true) => (3, 1),
                (Some(Choice(0)), false) => (1, 3),
                _ => (4, 1),
            };
            lines.push(("selfCollisionFlag", format!("\".scfl\" {flag}")));
            lines.push(("selfCollideWidthScale", format!("\".scws\" {scale}")));
        }
        lines.retain(|(name, _)| !is_set(name));
        for (_, line) in &lines {
            let _ = writeln!(self.text, "\tsetAttr {line};");
        }
        Ok(lines.into_iter().map(|(name, _)| name).collect())
    }

    /// The thickness of an object that Maya makes of a mesh, and whether its faces are coarse.
    fn thickness(&self, mesh: NodeId, share: f64) -> Result<(f64, bool), String> {
        let Some(surface) = self.surface_of(mesh)? else { return Ok((0.1, true)) };
        let placement = self.graph().placement(mesh, self.scene.time.start as f64);
        let points: Vec<Vector3<f64>> =
            surface.positions.iter().map(|point| placement.point(*point)).collect();
        let Some(first) = points.first() else { return Ok((0.1, true)) };
        let low = points.iter().fold(*first, |low, p| low.inf(p));
        let size = points.iter().fold(*first, |high, p| high.sup(p)) - low;
        let area = 2.0 * (size.x * size.y + size.y * size.z + size.z * size.x);
        let widest = area.sqrt() * share;
        let edge = EDGE_SHARE * (area / surface.faces.len().max(1) as f64).sqrt();
        let is_coarse = edge > widest;
        Ok((if is_coarse { widest } else { edge }.max(MIN_THICKNESS), is_coarse))
    }

    /// Writes the values of a node's preset; returns their names.
    pub(super) fn preset_values(&mut self, id: NodeId) -> Vec<&'static str> {
        let graph = self.graph();
        let node = graph.node(id);
        let [_, shape] = self.names[&id].clone();
        let mut names = Vec::new();
        for (name, setting) in node.preset() {
            if let (false, Some(row)) = (node.settings().contains_key(name), node.node_type().attribute(name))
            {
                self.setting(&shape, row, setting);
                names.push(*name);
            }
        }
        names
    }
}
