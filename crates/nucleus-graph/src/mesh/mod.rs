//! Meshes from files, and meshes from a few numbers.
//!
//! | You want to know...                              | Read                        |
//! |--------------------------------------------------|-----------------------------|
//! | what of an OBJ file is read, and what is refused | [`read_obj`]                |
//! | texture coordinates, which only textures ask for | [`read_obj_uvs`], [`poly_plane_uvs`] |
//! | what becomes of triangles without area           | [`drop_degenerate_faces`]   |
//! | how large a primitive is, before it is made      | [`Primitive::size`]         |
//! | in which order Maya counts the points of a plane, cube, sphere, cylinder | [`poly_plane`], [`poly_cube`], [`poly_sphere`], [`poly_cylinder`] |
//!
//! **Invariant:** the order and number of points is that of the file, or of Maya, and nothing here changes
//! it: weights, pins and caches name points by number. Lengths are in scene units, not yet in metres.

mod cube;
mod degenerate;
mod obj;
mod plane;
mod primitive;
mod round;
#[cfg(test)]
mod tests;

pub use cube::poly_cube;
pub use degenerate::drop_degenerate_faces;
pub use obj::{ObjError, ObjFault, read_obj, read_obj_uvs};
pub use plane::{poly_plane, poly_plane_uvs};
pub use primitive::{Primitive, PrimitiveError};
pub use round::{poly_cylinder, poly_sphere};
