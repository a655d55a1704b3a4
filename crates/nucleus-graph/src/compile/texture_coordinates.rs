//! Texture coordinates of the meshes of a program, for caches, exports and the directions of woven cloth; the
//! solver does not know them.

use std::collections::BTreeMap;

use nucleus_core::Faces;

use crate::attributes::{mesh, n_base};
use crate::graph::Node;
use crate::mesh::{CornerUvs, KeptFaces, MeshFile, MeshFormat, read_obj, read_obj_corner_uvs};
use crate::scene::document::Scene;

use super::geometry::{file_of, plane_uvs, primitive};
use super::mesh_files::frames_of;
use super::program::{Object, Program};

/// Distinct texture coordinates, and their index at each corner of a face; the indices are empty where every point has one
/// value, in the order of the points.
pub type MeshCoordinates = CornerUvs;

/// The texture coordinates of each object whose mesh has any, by the name of the object. Files are read again.
pub fn texture_coordinates(scene: &Scene, program: &Program) -> BTreeMap<String, MeshCoordinates> {
    let of = |object: &Object| {
        let (node, nucleus) = program.node_of(object.kind);
        let mesh = scene.graph.source(node, &n_base::INPUT_MESH)?;
        let (mut values, mut corners) = of_mesh(scene, scene.graph.node(mesh), &object.faces)?;
        // A mirrored mesh has its faces turned.
        let is_mirrored = scene.graph.at(nucleus.start as f64).placement(mesh).mirrors();
        if is_mirrored && corners.len() == object.faces.corners().len() {
            object.faces.reverse(&mut corners);
        }
        let tearing =
            nucleus.cloths.iter().find(|cloth| cloth.node == node).and_then(|cloth| cloth.tearing.as_ref());
        // The points of the mesh as it was given, before it was split where it can tear.
        let given = |&point: &u32| {
            let twin = (point as usize).checked_sub(object.mesh_points);
            twin.and_then(|twin| tearing?.twins.get(twin).copied()).unwrap_or(point)
        };
        // Where each point has one value, in the order of the points, an index says nothing.
        let is_per_point =
            corners.is_empty() || corners.iter().copied().eq(object.faces.corners().iter().map(given));
        if let Some(tearing) = tearing.filter(|_| is_per_point && values.len() == object.mesh_points) {
            tearing.extend(&mut values);
        }
        let fits = match is_per_point {
            true => values.len() == object.points,
            // A glTF file may have faces that were left out when its points were merged.
            false => corners.len() == object.faces.corners().len(),
        };
        let corners = if is_per_point { Vec::new() } else { corners };
        fits.then(|| (object.name.clone(), (values, corners)))
    };
    program.objects().iter().filter_map(of).collect()
}

/// The texture coordinates of a mesh node, of which these faces are left. Files are read again.
pub(super) fn of_mesh(scene: &Scene, node: &Node, faces: &Faces) -> Option<MeshCoordinates> {
    if let Some(uvs) = plane_uvs(node) {
        return Some((uvs, Vec::new()));
    }
    if let Some((primitive, _)) = primitive(node) {
        return primitive.corner_uvs();
    }
    let path = scene.source.path(&file_of(scene, node)?);
    match MeshFormat::of(&path) {
        MeshFormat::Obj => {
            let (values, mut corners) = read_obj_corner_uvs(&path).ok().flatten()?;
            if corners.len() != faces.corners().len() {
                let kept = KeptFaces::of(&read_obj(path).ok()?).corners;
                let given = |corner: u32| corners.get(corner as usize).copied();
                corners = kept.into_iter().map(given).collect::<Option<_>>()?;
            }
            Some((values, corners))
        }
        _ => {
            let opened = MeshFile::open(path, &node.get(&mesh::OBJECT), frames_of(scene)).ok()?;
            opened.mesh(scene.time.start).ok()?.uvs
        }
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use crate::compile::compile;
    use crate::scene::read_scene_text;

    /// The texture coordinates of the only cloth of a scene, and the places of its points in the scene.
    fn of_cloth(mesh: &str, more: &str, folder: &Path) -> (MeshCoordinates, Vec<[f64; 2]>) {
        let nodes = format!(
            r#""n": nucleus(gravity: 0), "m": {mesh}, "c": nCloth(inputMesh: "m", selfCollide: false), {more}"#
        );
        let text = format!("Scene(time: (start: 1, end: 2, fps: 24), nodes: {{{nodes}}})");
        let (scene, _) = read_scene_text(&text, &folder.join("scene.ron")).expect("it reads");
        let program = compile(&scene).expect("it compiles");
        let places = &program.model().cloths()[0].surface.positions;
        let found = texture_coordinates(&scene, &program).remove("c").expect("it has texture coordinates");
        (found, places.iter().map(|place| [place.x, place.z]).collect())
    }

    #[test]
    fn points_that_are_split_to_tear_keep_the_texture_coordinates_of_their_points() {
        let folder = tempfile::tempdir().expect("a folder");
        let tear = r#""t": dynamicConstraint(type: tearableSurface, components: ["c"])"#;
        let quads = "v 0 0 0\nv 1 0 0\nv 0 0 1\nv 1 0 1\nv 0 0 2\nv 1 0 2\n\
                     vt 0 1\nvt 1 1\nvt 0 0.5\nvt 1 0.5\nvt 0 0\nvt 1 0\n";
        let obj = format!("{quads}f 1/1 3/3 4/4 2/2\nf 3/3 5/5 6/6 4/4\n");
        std::fs::write(folder.path().join("a.obj"), obj).expect("written");
        for (mesh, split) in
            [("polyPlane(width: 2, height: 2, subdivisions: (2, 2))", 16), (r#"mesh(file: "a.obj")"#, 8)]
        {
            let ((whole, _), at) = of_cloth(mesh, "", folder.path());
            let ((torn, corners), places) = of_cloth(mesh, tear, folder.path());
            assert_eq!((torn.len(), places.len(), corners.len()), (split, split, 0), "{mesh}");
            for (uv, place) in torn.iter().zip(&places) {
                let given = at.iter().position(|given| given == place).expect("a point of the whole mesh");
                assert_eq!(*uv, whole[given], "{mesh}, at {place:?}");
            }
        }
    }
}
