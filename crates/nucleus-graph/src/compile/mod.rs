//! From a graph to what the solver takes: a model, and one input per frame.
//!
//! | You want to know...                                  | Read             |
//! |------------------------------------------------------|------------------|
//! | what comes out                                       | [`Program`]      |
//! | how cloth and colliders get their shape and mass     | `objects.rs`     |
//! | particles                                            | `particles.rs`   |
//! | which lists a cloth needs                            | `lists.rs`       |
//! | in which order objects are solved                    | `shaped.rs`      |
//! | what a frame brings                                  | `frame.rs`       |
//! | how meshes change their shape                        | `shape.rs`       |
//! | attributes that differ from point to point           | `maps.rs`, `column.rs` |
//! | how a cloth starts that does not start as its mesh   | `start.rs`       |
//! | what holds points, and where it takes hold of them   | `pins.rs`        |
//! | what an audit is to find kept apart                  | `apart.rs`       |
//! | where a run is seen from                             | `camera.rs`      |
//! | widths that no scene can mean                        | `widths.rs`      |
//! | where scene units become metres                      | `units.rs`       |
//! | how many points an object has at most                | `extent.rs`      |
//! | the thickness that nobody sets                       | `thickness.rs`   |
//!
//! **Invariant:** a scene pays only for what it uses, and whatever could go wrong in a run is refused
//! here: a program can only run.

mod apart;
mod camera;
mod column;
mod extent;
mod frame;
mod geometry;
mod lists;
mod maps;
mod objects;
mod particles;
mod pins;
mod program;
mod self_collision;
mod shape;
mod shaped;
mod start;
mod thickness;
mod time;
mod units;
mod widths;

use std::collections::BTreeSet;
use std::sync::Arc;

use crate::attributes::nucleus;
use crate::graph::NodeId;
use crate::scene::{Diagnostic, Findings, Scene};

use geometry::Geometry;
use objects::{Compiled, Compiler};
use program::Whole;

pub use camera::{Camera, FilmFit, View};
pub(crate) use extent::most_points;
pub(crate) use pins::Grips;
pub use program::{Object, ObjectKind, Program, Universe};

/// Compiles a scene.
///
/// # Errors
/// All mistakes that can be found: missing and broken meshes, points that are not there ...
pub fn compile(scene: &Scene) -> Result<Program, Vec<Diagnostic>> {
    let mut findings = Findings::new(scene.source.file().to_owned());
    let all = universes(scene, &BTreeSet::new(), &mut findings);
    if all.is_empty() {
        let error = findings.error(&(0..0), "there is nothing to solve: the scene has no nucleus");
        error.help("add `\"nucleus1\": nucleus()`");
    }
    if findings.errors() > 0 {
        return Err(findings.in_order());
    }
    let (mut universes, mut objects, mut mass) = (Vec::new(), Vec::new(), 0.0);
    for (universe, its_objects, its_mass) in all {
        universes.push(universe);
        objects.extend(its_objects);
        mass += its_mass;
    }
    // Cloths of all nuclei, then colliders of all nuclei.
    objects.sort_by_key(|object| matches!(object.kind, ObjectKind::Collider(_)));
    let starts = universes.iter().map(|universe| universe.start);
    let start = starts.min().unwrap_or(scene.time.start);
    let time = crate::scene::TimeSpan { start, ..scene.time };
    let whole = Whole {
        graph: scene.graph.clone(),
        time,
        every: scene.every,
        record: scene.record,
        checks: scene.checks.clone(),
        universes,
        objects,
        mass,
        warnings: findings.in_order(),
    };
    Ok(Program { whole: Arc::new(whole) })
}

/// What compiling would find in those parts of a scene that could be read.
pub(crate) fn survey(scene: &Scene, broken: &BTreeSet<NodeId>) -> Vec<Diagnostic> {
    let mut findings = Findings::new(scene.source.file().to_owned());
    universes(scene, broken, &mut findings);
    findings.in_order()
}

/// Each nucleus for itself, in the order of names. Of several, those without objects are left out.
fn universes(scene: &Scene, broken: &BTreeSet<NodeId>, findings: &mut Findings) -> Vec<Compiled> {
    let mut geometry = Geometry::new(scene);
    let mut nuclei: Vec<NodeId> = scene.graph.of_type(&nucleus::NUCLEUS).map(|(id, _)| id).collect();
    nuclei.sort_by_key(|id| scene.graph.node(*id).name());
    let mut all: Vec<Compiled> = Vec::new();
    for nucleus in nuclei {
        let before = all.last().map(|(universe, ..)| universe);
        let compiled = Compiler::new(scene, nucleus, broken, &mut geometry, before, findings).compile();
        all.push(compiled);
    }
    if all.iter().any(|(_, objects, _)| !objects.is_empty()) {
        all.retain(|(_, objects, _)| !objects.is_empty());
    } else {
        all.truncate(1);
    }
    all
}

#[cfg(test)]
mod tests;
