//! To come.

pub mod animation;
pub mod attributes;
pub mod mesh;
pub mod scene;
