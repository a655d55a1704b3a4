//! What every node type holds: one table per type, one row per attribute.
//!
//! | You want to know...                          | Read                           |
//! |----------------------------------------------|--------------------------------|
//! | what a row says                              | [`Attribute`]                  |
//! | what an attribute can hold                   | [`Value`], [`Kind`]            |
//! | how a value is read with its type            | [`Key`]                        |
//! | how a type inherits, and which row wins      | [`NodeType`]                   |
//! | which types there are                        | [`node_types`]                 |
//! | what one type holds                          | the module of its name         |
//!
//! **Invariant:** reading, writing, defaults, ranges, warnings and reference pages all come from these
//! rows. An attribute that is not here does not exist.

pub mod air_field;
pub mod camera;
pub mod drag_field;
pub mod dyn_base;
pub mod dynamic_constraint;
pub mod field;
pub mod gravity_field;
mod key;
mod kind;
pub mod mesh;
pub mod n_base;
pub mod n_cloth;
pub mod n_component;
pub mod n_particle;
pub mod n_rigid;
pub mod newton_field;
mod node_type;
pub mod nucleus;
pub mod particle;
pub mod point_emitter;
pub mod poly_cube;
pub mod poly_cylinder;
pub mod poly_plane;
pub mod poly_sphere;
pub mod radial_field;
mod row;
pub mod surface_shape;
mod table;
pub mod time;
pub mod transform;
pub mod turbulence_field;
pub mod uniform_field;
mod value;
pub mod volume_axis_field;
pub mod vortex_field;

pub use key::{FromValue, Key, Plugged};
pub use kind::{Data, Kind};
pub use node_type::{NodeType, node_type, node_types};
pub use row::{Attribute, Effect, Range};
pub use value::{Choice, ColorPoint, Component, Painting, RampPoint, Selection, Value};

#[cfg(test)]
mod tests;
