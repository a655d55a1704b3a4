//! Caches as files of other tools: meshes, point caches, scenes with time samples.
//!
//! | You want to know…                                  | Read                             |
//! |----------------------------------------------------|----------------------------------|
//! | which formats there are, and what they can hold    | [`Format`]                       |
//! | how an export is asked for, and what it writes     | [`export()`]                     |
//! | which frames and objects are taken, in which units | [`Clip`]                         |
//! | why a file is never half written                   | `output.rs`                      |
//! | the bytes of a format                              | its file: `usda.rs`, `glb.rs`, … |
//!
//! **Invariant:** order and number of points are those of the cache in every format, and a position differs
//! from the recorded one by no more than the rounding of one `f32`.

#![forbid(unsafe_code)]

mod clip;
mod error;
mod export;
mod format;
mod foxglove;
mod glb;
mod mdd;
mod name;
mod ncache;
mod obj;
mod output;
mod pc2;
mod ply;
mod usda;
mod vtu;

pub use clip::{Clip, Sample, Selection};
pub use error::ExportError;
pub use export::{Exported, Request, export};
pub use format::Format;
