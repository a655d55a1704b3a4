//! Texture coordinates of the meshes of a program, for caches, exports and the directions of woven cloth; the
//! solver does not know them.

use std::collections::BTreeMap;

use crate::attributes::{mesh, n_base};
use crate::graph::Node;
use crate::mesh::{CornerUvs, MeshFile, MeshFormat, read_obj_corner_uvs};
use crate::scene::document::Scene;

use super::geometry::{file_of, plane_uvs};
use super::mesh_files::frames_of;
use super::program::{Object, Program};

/// Distinct texture coordinates, and their index at each corner of a face; the indices are empty where every point has one
/// value, in the order of the points.
pub type MeshCoordinates = CornerUvs;

/// The texture coordinates of each object whose mesh has any, by the name of the object. Files are read again.
pub fn texture_coordinates(scene: &Scene, program: &Program) -> BTreeMap<String, MeshCoordinates> {
    let of = |object: &Object| {
        let (node, _) = program.node_of(object.kind);
        let mesh = scene.graph.source(node, &n_base::INPUT_MESH)?;
        let (values, corners) = of_mesh(scene, scene.graph.node(mesh))?;
        // Where each point has one value, in the order of the points, an index says nothing.
        let is_per_point = corners.is_empty() || corners == object.faces.corners();
        let fits = match is_per_point {
            true => values.len() == object.points,
            // Degenerate faces were left out of the mesh.
            false => corners.len() == object.faces.corners().len(),
        };
        let corners = if is_per_point { Vec::new() } else { corners };
        fits.then(|| (object.name.clone(), (values, corners)))
    };
    program.objects().iter().filter_map(of).collect()
}

/// The texture coordinates of a mesh node. Files are read again.
pub(super) fn of_mesh(scene: &Scene, node: &Node) -> Option<MeshCoordinates> {
    if let Some(uvs) = plane_uvs(node) {
        return Some((uvs, Vec::new()));
    }
    let path = scene.source.path(&file_of(scene, node)?);
    match MeshFormat::of(&path) {
        MeshFormat::Obj => read_obj_corner_uvs(path).ok().flatten(),
        _ => {
            let opened = MeshFile::open(path, &node.get(&mesh::OBJECT), frames_of(scene)).ok()?;
            opened.mesh(scene.time.start).ok()?.uvs
        }
    }
}
