//! Meshes from OBJ, PLY, glTF and USD files, and Maya's primitives.
//!
//! | You want to know...                              | Read                        |
//! |--------------------------------------------------|-----------------------------|
//! | which statements of an OBJ file are read         | [`read_obj`]                |
//! | how PLY, glTF and USD files are read             | [`MeshFile`]                |
//! | texture coordinates                              | [`read_obj_uvs`], [`poly_plane_uvs`] |
//! | groups and materials of faces                    | [`read_obj_face_sets`]      |
//! | area, volume, bounding box, open edges           | `measures.rs`               |
//! | which faces are dropped as degenerate            | [`drop_degenerate_faces`]   |
//! | the size of a primitive, before it is made       | [`Primitive::size`]         |
//! | Maya's point order of plane, cube, sphere and cylinder | [`poly_plane`], [`poly_cube`], [`poly_sphere`], [`poly_cylinder`] |
//!
//! **Invariant:** the order and number of points is that of the file or of Maya, and nothing here changes it:
//! vertex maps, pins and caches refer to points by number; only points that glTF splits are merged again. Lengths are
//! in scene units, not in metres.

mod degenerate;
mod file;
mod measures;
mod obj;
mod primitive;

pub use degenerate::{KeptFaces, drop_degenerate_faces};
pub use file::{FileMesh, Frames, MeshFile, MeshFileError, MeshFormat};
pub(crate) use measures::{area, bounding_box, doubled_area, is_closed, is_open, sides, volume};
pub use obj::{
    CornerUvs, FaceSet, FaceSets, ObjError, ObjFault, read_obj, read_obj_corner_uvs, read_obj_face_sets,
    read_obj_points, read_obj_uvs,
};
pub use primitive::{
    Primitive, PrimitiveError, poly_cube, poly_cylinder, poly_plane, poly_plane_uvs, poly_sphere,
    rotation_to_axis,
};
