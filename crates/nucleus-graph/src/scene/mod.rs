//! Scene files: RON text to a graph and back.
//!
//! | You want to know...                          | Read                          |
//! |----------------------------------------------|-------------------------------|
//! | which parts a scene has besides its graph    | [`Scene`]                     |
//! | how a file becomes a scene                   | [`read_scene`], `read/`       |
//! | how a scene becomes text                     | [`write_scene`]               |
//! | how mistakes are reported                    | [`Diagnostic`]                |
//! | how an attribute is changed in a text        | [`edit::edit`]                |
//! | what a material preset is                    | [`Preset`]                    |
//! | RON itself                                   | [`syntax`]                    |
//!
//! **Invariant:** every part of a file has an effect, or gives a warning or an error. One reading reports all
//! mistakes.

mod comments;
mod document;
pub mod edit;
mod preset;
mod read;
mod short_form;
pub mod syntax;
mod write;

pub(crate) use crate::diagnostic::Findings;
pub use crate::diagnostic::{Diagnostic, Note, Severity};
pub use document::{Record, Scene, Source, TimeSpan};
pub use preset::{Preset, presets, read_preset};
pub use read::{TextError, read_scene, read_scene_text, read_scene_within, read_text};
pub use write::{format_scene, write_scene};

#[cfg(test)]
mod tests;
