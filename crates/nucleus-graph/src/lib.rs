//! Maya's nodes without Maya: scenes, their graph, and the loop that runs them.
//!
//! ```text
//! scene.ron ─read_scene─▶ Scene ─compile─▶ Program ─Simulation::advance─▶ solver
//! ```
//!
//! | You want to know...                              | Read                       |
//! |--------------------------------------------------|----------------------------|
//! | how a scene is written and read                  | [`scene::read_scene`]      |
//! | which attributes a node type has                 | [`attributes::node_types`] |
//! | which nodes and connections a scene has          | [`graph::Graph`]           |
//! | how nodes become the input of the solver         | [`compile::compile`]       |
//! | what happens in a frame                          | [`Simulation::advance`]    |
//! | which conditions a run has to meet               | [`checks::Judge`]          |
//! | whether anything passes through anything         | [`audit::Audit`]           |
//! | what looks wrong before the first step           | [`first_frame_warnings`]   |
//! | what looks wrong after the last step            | [`flat_cloths`]            |
//! | how values change over time                      | [`animation::Curve`]       |
//! | where meshes come from                           | [`mesh::read_obj`]         |
//! | values that differ from point to point           | [`paint`]                  |
//! | how errors and warnings are reported             | [`scene::Diagnostic`]      |
//! | which files are read                             | `files.rs`                 |
//! | how much memory a scene may take                 | [`memory`]                 |
//!
//! **Invariant:** nodes carry data to the solver and never act themselves (§1.1). The same scene gives the
//! same program for any order of its nodes.

#![forbid(unsafe_code)]

pub mod animation;
pub mod attributes;
pub mod audit;
pub mod checks;
pub mod compile;
mod diagnostic;
mod files;
mod first_frame;
pub mod graph;
mod last_frame;
pub mod memory;
pub mod mesh;
pub mod paint;
pub mod scene;
mod simulation;

pub use checks::FrameReport;
pub use files::LineSpan;
pub use first_frame::first_frame_warnings;
pub use last_frame::flat_cloths;
pub use simulation::Simulation;
