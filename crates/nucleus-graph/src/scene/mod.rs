//! Scene files: RON text to a graph and back.
//!
//! | You want to know...                          | Read                          |
//! |----------------------------------------------|-------------------------------|
//! | what a scene is, besides its graph           | [`Scene`]                     |
//! | how a file becomes a scene                   | [`read_scene`], `read/`       |
//! | how a scene becomes text                     | [`write_scene`]               |
//! | what is said about mistakes, and where       | [`Diagnostic`]                |
//! | how an attribute is changed in a text        | [`edit::edit`]                |
//! | what a material preset is                    | [`Preset`]                    |
//! | RON itself                                   | [`syntax`]                    |
//!
//! **Invariant:** nothing in a file is passed over in silence. Whatever is read has an effect, or is a
//! warning, or an error; and all of them are found in one go.

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
