//! To come.

pub mod animation;
pub mod scene;
