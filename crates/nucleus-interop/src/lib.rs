//! Caches as files of other tools: meshes, point caches, scenes with time samples.
//!
//! | You want to know…                                      | Read                                   |
//! |--------------------------------------------------------|----------------------------------------|
//! | which formats exist, and which files they write        | [`Format`]                             |
//! | how to request an export, and which files result       | [`export()`]                           |
//! | which objects and frames are selected, in which units  | [`Clip`]                               |
//! | how names are made valid, and files appear complete    | `output.rs`                            |
//! | OBJ and PLY; PC2 and MDD                               | `mesh_files.rs`; `point_caches.rs`     |
//! | USD as text and as binary                              | `usd/`                                 |
//! | materials and normals, for the formats that have them  | `materials.rs`, `normals.rs`           |
//! | the bytes of another format                            | its file: `glb.rs`, `vtu.rs`, …        |
//!
//! **Invariant:** but for surfaces of liquids, in every format the points have the order and count of the cache, and a position differs from the
//! recorded one by no more than the rounding of one `f32`.

#![forbid(unsafe_code)]

mod clip;
mod error;
mod export;
mod foxglove;
mod glb;
mod materials;
mod mesh_files;
mod ncache;
mod output;
mod point_caches;
mod usd;
mod vertices;
mod vtu;

pub use clip::{Clip, Sample, Selection};
pub use error::ExportError;
pub use export::{Exported, Format, Request, export};
