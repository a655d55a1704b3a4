//! Scene files.

pub mod syntax;
