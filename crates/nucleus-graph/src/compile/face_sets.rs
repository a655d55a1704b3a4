//! Groups and materials of the faces of a program's meshes, for selections, caches and exports; the solver does not know them.

use std::collections::BTreeMap;

use crate::attributes::n_base;
use crate::graph::Node;
use crate::mesh::{FaceSets, KeptFaces, MeshFormat, ObjError, read_obj, read_obj_face_sets};
use crate::scene::document::Scene;

use super::geometry::file_of;
use super::program::{Object, Program};

/// The groups and materials of each object whose mesh has any, by the name of the object. Files are read again.
pub fn face_sets(scene: &Scene, program: &Program) -> BTreeMap<String, FaceSets> {
    let of = |object: &Object| {
        let (node, _) = program.node_of(object.kind);
        let mesh = scene.graph.source(node, &n_base::INPUT_MESH)?;
        // The mesh itself was read before.
        let sets = of_mesh(scene, scene.graph.node(mesh), object.faces.len()).ok()??;
        (!sets.is_empty()).then(|| (object.name.clone(), sets))
    };
    program.objects().iter().filter_map(of).collect()
}

/// The groups and materials of a mesh node of which so many faces are left; `None` if its faces are not those of an OBJ file.
///
/// # Errors
/// When its file cannot be read.
pub(super) fn of_mesh(scene: &Scene, node: &Node, faces: usize) -> Result<Option<FaceSets>, ObjError> {
    let file = file_of(scene, node).filter(|file| MeshFormat::of(file) == MeshFormat::Obj);
    let Some(path) = file.map(|file| scene.source.path(&file)) else { return Ok(None) };
    let (mut sets, mut count) = read_obj_face_sets(&path)?;
    if count != faces {
        let kept = KeptFaces::of(&read_obj(path)?).faces;
        count = kept.len();
        sets = sets.only(&kept);
    }
    Ok(Some(sets).filter(|_| count == faces))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compile::{compile, texture_coordinates};
    use crate::scene::read_scene_text;

    /// Two quads with a face without area between them, in two groups and of two materials, and texture coordinates.
    const STRIP: &str = "v 0 0 0\nv 1 0 0\nv 0 0 1\nv 1 0 1\nv 0 0 2\nv 1 0 2\nvt 0 0\nvt 0.5 0.25\nvt 0.5 0.75\nvt 1 1\n\
        g near\nusemtl silk\nf 1/1 3/2 4/3 2/4\nf 1/4 2/4 2/4\ng far hem\nusemtl wool\nf 3/2 5/1 6/4 4/3\n";

    /// The groups and materials of the cloth of this mesh, by name, with the mean z of their faces; and its texture
    /// coordinates at the corners of its last face.
    fn of_cloth(transform: &str, more: &str) -> (Vec<(String, f64)>, Vec<[f64; 2]>) {
        let folder = tempfile::tempdir().expect("a folder");
        std::fs::write(folder.path().join("a.obj"), STRIP).expect("written");
        let nodes = format!(
            r#""n": nucleus(gravity: 0), "m": mesh(file: "a.obj"{transform}), "c": nCloth(inputMesh: "m"), {more}"#
        );
        let text = format!("Scene(time: (start: 1, end: 2, fps: 24), nodes: {{{nodes}}})");
        let (scene, _) = read_scene_text(&text, &folder.path().join("scene.ron")).expect("it reads");
        let program = compile(&scene).expect("it compiles");
        let surface = &program.model().cloths()[0].surface;
        let sets = face_sets(&scene, &program).remove("c").expect("it has some");
        let (values, corners) = texture_coordinates(&scene, &program).remove("c").expect("it has some");
        assert_eq!(corners.len(), 8);
        let mean = |faces: &[u32]| {
            let corners: Vec<u32> =
                faces.iter().flat_map(|&face| surface.faces.face(face as usize)).copied().collect();
            let sum: f64 = corners.iter().map(|&point| surface.positions[point as usize].z).sum();
            sum / corners.len() as f64
        };
        let all = sets.groups.iter().chain(&sets.materials);
        let uvs = corners[4..].iter().map(|&corner| values[corner as usize]).collect();
        (all.map(|set| (set.name.clone(), mean(&set.faces))).collect(), uvs)
    }

    #[test]
    fn faces_keep_their_sets_and_texture_coordinates_where_others_are_left_out_and_where_cloth_is_split_to_tear()
     {
        let tear = r#""t": dynamicConstraint(type: tearableSurface, components: ["c"])"#;
        for (transform, more) in [("", ""), ("", tear), (", scaleX: -1", "")] {
            let (sets, mut uvs) = of_cloth(transform, more);
            let names: Vec<(&str, f64)> = sets.iter().map(|(name, z)| (name.as_str(), *z)).collect();
            let expected = [("near", 0.5), ("far", 1.5), ("hem", 1.5), ("silk", 0.5), ("wool", 1.5)];
            assert_eq!(names, expected, "{transform} {more}");
            if !transform.is_empty() {
                // Seen from behind, from the same corner on.
                uvs[1..].reverse();
            }
            assert_eq!(uvs, [[0.5, 0.25], [0.0, 0.0], [1.0, 1.0], [0.5, 0.75]], "{transform} {more}");
        }
    }
}
