//! Scene files: RON text to a graph and back.
//!
//! | You want to know...                          | Read                          |
//! |----------------------------------------------|-------------------------------|
//! | which parts a scene has besides its graph    | [`Scene`]                     |
//! | how a file becomes a scene                   | [`read_scene`], `read/`       |
//! | how a scene becomes text                     | [`write_scene`]               |
//! | how mistakes are reported                    | [`Diagnostic`]                |
//! | how an attribute is changed in a text        | [`edit::edit`]                |
//! | how `cloth1.damp=0.1` changes a scene        | [`Assignment`]                |
//! | what a material preset is                    | [`Preset`]                    |
//! | RON itself                                   | [`syntax`]                    |
//!
//! **Invariant:** every part of a file has an effect, or gives a warning or an error. One reading reports all
//! mistakes.

mod assignment;
mod comments;
pub(crate) mod document;
pub mod edit;
mod file_text;
mod layout;
mod preset;
mod read;
mod short_form;
pub mod syntax;
mod write;

pub use crate::diagnostic::{Diagnostic, Note, Severity, nearest};
pub use assignment::{AssignError, Assignment, assigned};
pub use document::{Record, Scene, Source, TimeSpan};
pub use file_text::{TextError, read_text};
pub use preset::Preset;
pub use read::preset::{presets, read_preset};
pub use read::{read_scene, read_scene_text, read_scene_within};
pub use write::{format_scene, write_scene};

#[cfg(test)]
mod tests;
