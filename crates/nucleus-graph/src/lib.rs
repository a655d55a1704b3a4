//! To come.

pub mod scene;
