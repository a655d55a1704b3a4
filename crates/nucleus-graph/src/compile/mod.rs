//! From a graph to what the solver takes: a model, and one input per frame.
//!
//! | You want to know...                                  | Read             |
//! |------------------------------------------------------|------------------|
//! | what comes out                                       | [`Program`]      |
//! | how cloth and colliders get their shape and mass     | `objects.rs`     |
//! | which lists a cloth needs                            | `lists.rs`       |
//! | what a frame brings                                  | `frame.rs`       |
//! | what holds points, and where it takes hold of them   | `pins.rs`        |
//! | what an audit is to find kept apart                  | `apart.rs`       |
//! | where scene units become metres                      | `units.rs`       |
//! | the thickness that nobody sets                       | `thickness.rs`   |
//!
//! **Invariant:** a scene pays only for what it uses, and whatever could go wrong in a run is refused
//! here: a program can only run.

mod apart;
mod frame;
mod geometry;
mod lists;
mod objects;
mod pins;
mod program;
mod self_collision;
mod thickness;
mod units;

use std::collections::BTreeSet;

use crate::graph::NodeId;
use crate::scene::{Diagnostic, Findings, Scene};

use objects::Compiler;

pub(crate) use pins::Grips;
pub use program::{Object, ObjectKind, Program};

/// Compiles a scene.
///
/// # Errors
/// All mistakes that can be found: missing and broken meshes, points that are not there ...
pub fn compile(scene: &Scene) -> Result<Program, Vec<Diagnostic>> {
    let mut findings = Findings::new(scene.source.file().to_owned());
    let program = Compiler::new(scene, &BTreeSet::new(), &mut findings).program();
    let errors = findings.errors();
    match program {
        Some(program) if errors == 0 => Ok(program.with_warnings(findings.in_order())),
        _ => Err(findings.in_order()),
    }
}

/// What compiling would find in those parts of a scene that could be read.
pub(crate) fn survey(scene: &Scene, broken: &BTreeSet<NodeId>) -> Vec<Diagnostic> {
    let mut findings = Findings::new(scene.source.file().to_owned());
    Compiler::new(scene, broken, &mut findings).objects();
    findings.in_order()
}

#[cfg(test)]
mod tests;
