//! Attribute tables: one table per node type, one row per attribute.
//!
//! | You want to know...                          | Read                           |
//! |----------------------------------------------|--------------------------------|
//! | what a row holds                             | [`Attribute`]                  |
//! | the types of values                          | [`Value`], [`Kind`]            |
//! | the value of a ramp at a position            | [`Ramp`]                       |
//! | how a value is read as a Rust type           | [`Key`]                        |
//! | how node types inherit rows                  | [`NodeType`]                   |
//! | which node types exist                       | [`node_types`]                 |
//! | the attributes of a node type                | the module of its name         |
//! | transforms, cameras, meshes, primitives      | `scene_nodes.rs`               |
//! | fields                                       | `fields.rs`                    |
//!
//! **Invariant:** reading, writing, defaults, ranges, warnings and reference pages all use these rows. There are no
//! other attributes.

mod component;
pub mod dynamic_constraint;
mod fields;
mod key;
mod kind;
pub mod n_base;
pub mod n_cloth;
pub mod n_component;
pub mod n_particle;
pub mod n_rigid;
mod node_type;
pub mod nucleus;
pub mod particle;
pub mod point_emitter;
mod ramp;
mod row;
mod scene_nodes;
mod value;

pub use component::read_component;
pub(crate) use component::{SelectedValues, read_which};
pub use fields::{
    air_field, drag_field, dyn_base, field, gravity_field, newton_field, radial_field, turbulence_field,
    uniform_field, volume_axis_field, vortex_field,
};
pub use key::{FromValue, Key, Plugged};
pub use kind::{Data, Kind};
pub use node_type::NodeType;
pub use ramp::Ramp;
pub use row::{Attribute, Effect, Range};
pub use scene_nodes::{
    camera, mesh, poly_cube, poly_cylinder, poly_plane, poly_sphere, surface_shape, time, transform,
};
pub use value::{Choice, ColorPoint, Component, ElementKind, Painting, RampPoint, Selection, Value, Which};

/// All node types that a scene can name, in the order of the reference pages.
pub fn node_types() -> &'static [&'static NodeType] {
    &TYPES
}

/// The node type of a name, if a scene can name it.
pub fn node_type(name: &str) -> Option<&'static NodeType> {
    TYPES.iter().copied().find(|node_type| node_type.name == name)
}

static TYPES: [&NodeType; 24] = [
    &nucleus::NUCLEUS,
    &n_cloth::N_CLOTH,
    &n_rigid::N_RIGID,
    &n_particle::N_PARTICLE,
    &dynamic_constraint::DYNAMIC_CONSTRAINT,
    &n_component::N_COMPONENT,
    &point_emitter::POINT_EMITTER,
    &gravity_field::GRAVITY_FIELD,
    &turbulence_field::TURBULENCE_FIELD,
    &vortex_field::VORTEX_FIELD,
    &drag_field::DRAG_FIELD,
    &air_field::AIR_FIELD,
    &radial_field::RADIAL_FIELD,
    &uniform_field::UNIFORM_FIELD,
    &volume_axis_field::VOLUME_AXIS_FIELD,
    &newton_field::NEWTON_FIELD,
    &mesh::MESH,
    &poly_plane::POLY_PLANE,
    &poly_sphere::POLY_SPHERE,
    &poly_cube::POLY_CUBE,
    &poly_cylinder::POLY_CYLINDER,
    &camera::CAMERA,
    &transform::TRANSFORM,
    &time::TIME,
];

#[cfg(test)]
mod tests;
