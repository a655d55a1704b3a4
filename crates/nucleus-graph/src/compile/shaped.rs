//! The order in which objects are solved: from the ground up, by where they are at the start, so that names do not
//! matter.
//!
//! Contacts are swept one after another, so the order shows in the last bits, and where cloth is pressed in
//! more than those. Objects in the very same place are told apart by what is set on them; what is the same in all of
//! that is the same object twice.

use std::cmp::Ordering;

use nucleus_core::Surface;

use crate::graph::{Graph, NodeId};

use super::objects::Compiler;

/// An object with its mesh, where it stands at the start; lengths in scene units. Particles are their own mesh.
pub(super) struct Shaped {
    pub(super) id: NodeId,
    pub(super) mesh: NodeId,
    pub(super) surface: Surface,
}

impl Compiler<'_> {
    /// Those of some objects that have a mesh, in the order of their solution.
    pub(super) fn shaped(&mut self, objects: Vec<NodeId>) -> Vec<Shaped> {
        let shape = |id| self.world_surface(id).map(|(mesh, surface)| Shaped { id, mesh, surface });
        let shaped = objects.into_iter().filter_map(shape).collect();
        self.in_order(shaped)
    }

    /// Those of some particle nodes that have particles, in the order of their solution.
    pub(super) fn placed(&mut self, objects: Vec<NodeId>) -> Vec<Shaped> {
        let place = |id| self.initial_positions(id).map(|surface| Shaped { id, mesh: id, surface });
        let placed = objects.into_iter().filter_map(place).collect();
        self.in_order(placed)
    }

    fn in_order(&mut self, mut shaped: Vec<Shaped>) -> Vec<Shaped> {
        self.note_extent(&shaped);
        shaped.sort_by(|a, b| a.compare(b, &self.scene.graph));
        shaped
    }
}

impl Shaped {
    fn compare(&self, other: &Self, graph: &Graph) -> Ordering {
        let (a, b) = (&self.surface, &other.surface);
        let size = |surface: &Surface| [surface.positions.len(), surface.faces.len()];
        let place = |surface: &'_ Surface, point: usize| {
            let p = surface.positions[point];
            [p.y, p.z, p.x]
        };
        let points = a.positions.len().min(b.positions.len());
        let coordinates = (0..points).flat_map(|k| place(a, k).into_iter().zip(place(b, k)));
        let places = coordinates.map(|(a, b)| a.total_cmp(&b)).find(|order| order.is_ne());
        let settings = |id: NodeId| format!("{:?}", (graph.node(id).preset(), graph.node(id).settings()));
        places
            .unwrap_or(Ordering::Equal)
            .then_with(|| size(a).cmp(&size(b)))
            .then_with(|| a.faces.corners().cmp(b.faces.corners()))
            .then_with(|| settings(self.id).cmp(&settings(other.id)))
    }
}
