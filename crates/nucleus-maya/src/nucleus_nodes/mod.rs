//! From Maya's nodes to Nucleus nodes: which are carried over, under which names, with which values and connections.
//!
//! | You want to know...                                   | Read                |
//! |-------------------------------------------------------|---------------------|
//! | which nodes a simulation needs                        | `kept.rs`           |
//! | values of attributes, ramps, vertex maps              | `attributes.rs`     |
//! | transforms with pivots, joints, shear                 | `transforms.rs`     |
//! | meshes: Nucleus primitives, OBJ files, sequences      | `meshes.rs`         |
//! | recorded results that an object plays                 | `caches.rs`, `tracks.rs` |
//! | collision events of particles                         | `events.rs`         |
//! | objects, constraints, fields and their connections    | `wiring.rs`, `constraints.rs` |
//! | the menu type of a constraint                        | `constraint_type.rs` |
//! | all of it in order                                    | [`Importer`]        |
//!
//! **Invariant:** attributes are carried over by the tables of `nucleus_graph::attributes`; nothing here lists the
//! attributes of cloth.

mod attributes;
mod caches;
mod constraint_type;
mod constraints;
mod events;
mod importer;
mod kept;
mod meshes;
mod options;
mod plan;
mod tracks;
mod transforms;
mod wiring;

pub(crate) use importer::Importer;
pub(crate) use kept::{MARK_AUTOMATIC, MARK_NAME, MARK_PAINT, OWN_FILE};
pub use meshes::unknown_mesh;
pub(crate) use options::BorrowedOptions;
pub use options::{ImportOptions, WriteFile};
