//! To come.

pub mod animation;
pub mod mesh;
pub mod scene;
