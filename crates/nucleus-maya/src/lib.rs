//! Maya scenes, read and written without Maya.
//!
//! ```text
//! scene.ma ─SourceText─▶ Statements ─MayaScene─▶ nodes, wires ─Importer─▶ Scene ─▶ scene.ron, meshes
//! ```
//!
//! | You want to know...                                    | Read                          |
//! |--------------------------------------------------------|-------------------------------|
//! | how a scene is imported                                | [`import_scene`]              |
//! | how a Nucleus scene is written                         | [`maya_ascii`], `write/`      |
//! | Maya's attribute presets                               | [`read_maya_preset`]          |
//! | Maya's caches                                          | [`ncache`]                    |
//! | what is left out, and why                              | [`omissions`]                 |
//! | how Maya ASCII is split into statements                | [`ascii`]                     |
//! | nodes, the DAG, references, attributes                 | [`scene`]                     |
//! | meshes, primitives, operators                          | [`mesh`]                      |
//! | the mesh of a shape: construction history              | `history.rs`                  |
//! | curves, expressions, transforms                        | [`animation`]                 |
//! | blend shapes, skin clusters                            | `deform/`                     |
//! | paths of value files of a scene that moves             | [`value_files`]               |
//! | which attributes and connections are carried over      | `nucleus_nodes/`              |
//!
//! **Invariant:** nothing in a file is executed, and a path in a file never leads to writing. Everything that is not
//! carried over is listed.

#![forbid(unsafe_code)]

pub mod animation;
pub mod ascii;
mod deform;
mod history;
mod import;
pub mod mesh;
pub mod ncache;
mod nucleus_nodes;
pub mod omissions;
mod preset;
pub mod scene;
pub mod value_files;
mod write;

pub use ascii::ImportError;
pub use import::{Imported, import_scene, import_text, is_maya_scene};
pub use nucleus_nodes::{ImportOptions, WriteFile, unknown_mesh};
pub use preset::{maya_preset, preset_text, read_maya_preset};
pub use write::maya_ascii;
