//! Meshes: embedded in a shape, primitives, and the operators of construction history.
//!
//! | You want to know...                                 | Read               |
//! |-----------------------------------------------------|--------------------|
//! | points, faces and edges of a mesh                   | [`Poly`]           |
//! | `.vt`, `.ed`, `.fc` and `.pt` of a shape            | `embedded.rs`      |
//! | Maya's primitives                                   | `primitives.rs`    |
//! | operators: extrude, smooth, merge...                | `operators.rs`, `subdivide.rs`, `extrude.rs`, `bevel.rs` |
//! | the mesh of a shape at a frame                      | `history.rs`, one level up |
//! | the most points of a history                        | `budget.rs`        |
//! | a history while it is built                         | `under_way.rs`     |
//! | a mesh as an OBJ file                               | [`obj_text`]       |
//!
//! **Invariant:** points are in the space of the shape, in centimetres, and keep Maya's numbers as far as those are known.

mod bevel;
mod budget;
pub(crate) mod embedded;
mod extrude;
mod obj;
pub(crate) mod operators;
mod poly;
pub(crate) mod primitives;
mod subdivide;
mod under_way;

#[cfg(test)]
pub(crate) use budget::Budget;
pub use obj::obj_text;
pub use poly::{Built, Components, Poly};
pub(crate) use primitives::own_primitive;
pub(crate) use under_way::History;

use crate::scene::{MayaScene, NodeId, PlugRef};

/// Builds the mesh that flows from a plug, and notes what its history leaves out.
pub(crate) type InputMesh<'a> = dyn Fn(PlugRef, &mut History) -> Result<Poly, String> + 'a;

/// Whether a creation node makes a Nucleus primitive, along the same axis unless that does not matter.
pub(crate) fn is_own_primitive(scene: &MayaScene, id: NodeId, any_axis: bool) -> bool {
    let stored = |names: &[&str], default| scene.stored_or(id, names, default);
    own_primitive(scene, id, &stored).is_some() && (any_axis || primitives::is_upright(scene, id))
}
