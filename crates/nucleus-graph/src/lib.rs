//! To come.

pub mod animation;
pub mod attributes;
pub mod graph;
pub mod mesh;
pub mod scene;
