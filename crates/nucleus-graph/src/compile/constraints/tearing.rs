//! Which edges of a cloth mesh can tear, by the tearable surfaces that have a part of it.

use std::collections::BTreeMap;

use nucleus_core::Surface;

use crate::attributes::{ElementKind, dynamic_constraint as con, n_component};
use crate::compile::compiler::Compiler;
use crate::compile::select::{Elements, Selected};
use crate::graph::NodeId;

use super::kinds::{self, Values};
use super::split_mesh::Tearing;

impl Compiler<'_> {
    /// How a cloth mesh is split by the tearable surfaces that have a part of it; `None` where nothing can tear.
    pub(crate) fn tearing(&mut self, cloth: NodeId, mesh: NodeId, surface: &Surface) -> Option<Tearing> {
        let mut tears: BTreeMap<([u32; 2], u32), NodeId> = BTreeMap::new();
        let given = self.geometry.surface(self.scene, mesh, self.findings)?.faces.clone();
        let elements = Elements::new(&given, surface.positions.len());
        for constraint in self.constraints() {
            if Values::new(&self.start, constraint).kind != kinds::TEARABLE {
                continue;
            }
            let graph = &self.scene.graph;
            for (_, plug) in graph.elements(constraint, &con::COMPONENT_IDS) {
                if graph.source(plug.node, &n_component::OBJECT_ID) != Some(cloth) {
                    continue;
                }
                let of = Selected { owner: constraint, object: cloth, mesh };
                let is_whole = graph.node(plug.node).get(&n_component::COMPONENT_TYPE) == n_component::OBJECT;
                let (kind, chosen) = self.selected(&of, plug.node, &elements);
                let mut points = vec![is_whole; surface.positions.len()];
                let mut edges = std::collections::BTreeSet::new();
                for corners in chosen.iter().map(|&at| elements.corners(kind, at)) {
                    match (kind, corners.as_slice()) {
                        (ElementKind::Edge, &[a, b]) => {
                            edges.insert([a.min(b), a.max(b)]);
                        }
                        (_, corners) => corners.iter().for_each(|&point| points[point as usize] = true),
                    }
                }
                for face in surface.faces.iter() {
                    for k in 0..face.len() {
                        let (a, b) = (face[k], face[(k + 1) % face.len()]);
                        let edge = [a.min(b), a.max(b)];
                        for end in
                            edge.into_iter().filter(|&end| points[end as usize] || edges.contains(&edge))
                        {
                            tears.entry((edge, end)).or_insert(constraint);
                        }
                    }
                }
            }
        }
        if tears.is_empty() {
            return None;
        }
        let points = surface.positions.len();
        Some(Tearing::new(&surface.faces, points, |edge, end| tears.get(&(edge, end)).copied()))
    }
}
