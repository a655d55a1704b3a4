//! To come.

pub mod animation;
pub mod attributes;
pub mod checks;
pub mod compile;
pub mod graph;
pub mod mesh;
pub mod scene;
mod simulation;

pub use simulation::{FrameReport, Simulation};
