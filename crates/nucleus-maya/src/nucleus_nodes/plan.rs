//! How each mesh of a Maya scene is imported.

use std::collections::{HashMap, HashSet};
use std::path::PathBuf;

use nucleus_core::Surface;
use nucleus_graph::attributes::{ElementKind, NodeType};
use nucleus_graph::mesh::read_obj;

use crate::mesh::{Built, Poly};
use crate::scene::{MayaScene, NodeId};

/// How a mesh is imported.
pub(super) enum Plan {
    /// A Nucleus primitive, by its creation node.
    Primitive(NodeId, &'static NodeType),
    /// The file that a Nucleus scene names.
    File(String),
    /// The mesh in the Maya scene, since the file that a Nucleus scene names is not there.
    Embedded(Poly, String),
    /// The text of an OBJ file that the artist gives, and the file.
    Given(String, PathBuf),
    /// The mesh at the first frame, which may change over time.
    Built(Built),
    /// It cannot be built, and why.
    Missing(String),
}

/// The elements of a mesh: Maya's points and faces have the same numbers here, its edges others.
pub(super) struct Elements {
    pub(super) points: usize,
    /// Whether several points are in one place, as where a mesh is split to tear.
    pub(super) is_split: bool,
    faces: usize,
    /// Our number of each of Maya's edges; `None` for one that no face has.
    edges: Vec<Option<u32>>,
}

impl Plan {
    /// The elements of the mesh, as far as they are known.
    pub(super) fn elements(&self, scene: &MayaScene) -> Option<Elements> {
        match self {
            Self::Primitive(source, _) => {
                let stored = |names: &[&str], default| scene.stored_or(*source, names, default);
                Some(Elements::of_surface(
                    &crate::mesh::own_primitive(scene, *source, &stored)?.surface().ok()?,
                ))
            }
            Self::Embedded(mesh, _) => Some(Elements::of_poly(mesh)),
            Self::Built(built) => Some(Elements::of_poly(&built.mesh)),
            Self::Given(_, path) => Some(Elements::of_surface(&read_obj(path).ok()?)),
            Self::File(_) | Self::Missing(_) => None,
        }
    }
}

impl Elements {
    /// Those of particles.
    pub(super) fn of_points(points: usize) -> Self {
        Self { points, is_split: false, faces: 0, edges: Vec::new() }
    }

    fn of_surface(surface: &Surface) -> Self {
        let points: Vec<[f64; 3]> = surface.positions.iter().map(|point| (*point).into()).collect();
        Self::new(&points, surface.faces.iter(), &[])
    }

    fn of_poly(mesh: &Poly) -> Self {
        Self::new(&mesh.points, mesh.faces(), &mesh.stored_edges)
    }

    /// A mesh file has no edges, so ours are numbered in the order in which faces name them.
    fn new<'a>(points: &[[f64; 3]], all: impl Iterator<Item = &'a [u32]>, stored: &[[u32; 2]]) -> Self {
        let key = |a: u32, b: u32| [a.min(b), a.max(b)];
        let mut numbers: HashMap<[u32; 2], u32> = HashMap::new();
        let mut faces = 0;
        for face in all {
            faces += 1;
            for (k, &corner) in face.iter().enumerate() {
                let next = numbers.len() as u32;
                numbers.entry(key(corner, face[(k + 1) % face.len()])).or_insert(next);
            }
        }
        let edges = match stored {
            [] => (0..numbers.len() as u32).map(Some).collect(),
            stored => stored.iter().map(|[a, b]| numbers.get(&key(*a, *b)).copied()).collect(),
        };
        let mut places = HashSet::new();
        // The sum makes one zero of both.
        let is_split = !points.iter().all(|point| places.insert(point.map(|x| (x + 0.0).to_bits())));
        Self { points: points.len(), is_split, faces, edges }
    }

    /// Our number of one of Maya's elements; `None` if the mesh does not have it.
    pub(super) fn number(&self, kind: ElementKind, index: u32) -> Option<u32> {
        let below = |count: usize| ((index as usize) < count).then_some(index);
        match kind {
            ElementKind::Point => below(self.points),
            ElementKind::Edge => self.edges.get(index as usize).copied().flatten(),
            ElementKind::Face => below(self.faces),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn edges_are_numbered_as_faces_name_them() {
        // Two triangles on the diagonal 0 2, which the file stores first, and an edge without a face.
        let stored = [[2, 0], [3, 4], [0, 1], [1, 2], [2, 3], [3, 0]];
        let faces: [&[u32]; 2] = [&[0, 1, 2], &[0, 2, 3]];
        let points: [[f64; 3]; 5] = std::array::from_fn(|point| [point as f64, 0.0, 0.0]);
        let elements = Elements::new(&points, faces.into_iter(), &stored);
        let edges = [0, 1, 2, 3, 4, 5, 6].map(|edge| elements.number(ElementKind::Edge, edge));
        assert_eq!(edges, [Some(2), None, Some(0), Some(1), Some(3), Some(4), None]);
        assert_eq!([1, 2].map(|face| elements.number(ElementKind::Face, face)), [Some(1), None]);
    }
}
