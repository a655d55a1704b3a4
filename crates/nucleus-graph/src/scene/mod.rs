//! Scene files: RON text to a graph and back.
//!
//! | You want to know...                          | Read                          |
//! |----------------------------------------------|-------------------------------|
//! | what a scene is, besides its graph           | [`Scene`]                     |
//! | how a file becomes a scene                   | [`read_scene`], `read/`       |
//! | how a scene becomes text                     | [`write_scene`]               |
//! | what is said about mistakes, and where       | [`Diagnostic`]                |
//! | how an attribute is changed in a text        | [`edit::edit`]                |
//! | RON itself                                   | [`syntax`]                    |
//!
//! **Invariant:** nothing in a file is passed over in silence. Whatever is read has an effect, or is a
//! warning, or an error; and all of them are found in one go.

mod diagnostic;
mod document;
pub mod edit;
mod findings;
mod nearest;
mod read;
mod source;
pub mod syntax;
mod write;

pub use diagnostic::{Diagnostic, Note, Severity};
pub use document::{Record, Scene, TimeSpan};
pub(crate) use findings::Findings;
pub(crate) use nearest::nearest;
pub use read::{read_scene, read_scene_text};
pub use source::Source;
pub use write::write_scene;

#[cfg(test)]
mod tests;
