//! Compiles a graph to the solver's input: a model per nucleus, and one [`FrameInput`](nucleus_core::FrameInput) per
//! frame.
//!
//! | You want to know...                                  | Read                               |
//! |------------------------------------------------------|------------------------------------|
//! | what the result is                                   | [`Program`], `sources.rs`          |
//! | what compiling one nucleus shares                    | `compiler.rs`                      |
//! | shape, mass and constraint lists of cloth; colliders | `objects.rs`                       |
//! | bending, yielding, pressure, resistances that count  | `soft_body.rs`                     |
//! | attraction to the input mesh, the shape at rest      | `input_mesh.rs`                    |
//! | fields that objects exert                            | `force_fields.rs`                  |
//! | settings that another setting switches off           | `contradictions.rs`, `dependencies.rs` |
//! | nodes that nothing connects                          | `idle.rs`                          |
//! | stretch that a budget leaves, `autoEvaluations`      | [`budget`], `inflation.rs`         |
//! | particles                                            | `particles.rs`                     |
//! | the directions of woven cloth                        | `weave.rs`                         |
//! | a random perturbation of the start                   | `perturbation.rs`                  |
//! | emitters, and the particles born in a frame          | `emission/`                        |
//! | field nodes                                          | `fields.rs`                        |
//! | particles that fill a box or a mesh                  | `fill.rs`                          |
//! | initial positions, velocities, and the solve order   | `initial_state.rs`                 |
//! | state that depends on the past                       | [`past_state`]                     |
//! | the input of a frame                                 | `frame.rs`                         |
//! | meshes, and how many points they have                | `geometry.rs`                      |
//! | mesh sequences and blends                            | `animated_mesh.rs`                 |
//! | vertex maps                                          | `vertex_maps.rs`, `map_values.rs`  |
//! | recorded positions (`playFromCache`)                 | `recorded.rs`                      |
//! | pins of transform constraints                        | `attachments.rs`                   |
//! | selections of elements                               | `select.rs`                        |
//! | all other constraints                                | `constraints/`                     |
//! | thickness, self-collision, push-out                  | `thickness.rs`                     |
//! | cameras                                              | `camera.rs`                        |
//! | texture coordinates, for exports                     | `texture_coordinates.rs`           |
//! | groups and materials of faces                        | `face_sets.rs`                     |
//! | scene units to metres, start frames                  | `units.rs`                         |
//!
//! Modules use each other in one direction only: from `units.rs` up to `objects.rs`.
//!
//! **Invariant:** a scene pays only for the features it uses. Compiling reports every error, so a program always runs.

mod animated_mesh;
mod attachments;
pub mod budget;
mod camera;
mod compiler;
mod constraints;
mod contradictions;
mod dependencies;
mod emission;
mod face_sets;
mod fields;
mod fill;
mod force_fields;
mod frame;
mod geometry;
mod idle;
mod inflation;
mod initial_state;
mod input_mesh;
mod liquids;
mod map_values;
mod mesh_files;
mod objects;
mod particle_expressions;
mod particle_ramps;
mod particles;
pub mod past_state;
mod perturbation;
mod program;
mod recorded;
mod select;
mod soft_body;
mod sources;
mod texture_coordinates;
mod thickness;
mod units;
mod vertex_maps;
mod weave;

use std::collections::BTreeSet;
use std::sync::Arc;

use crate::attributes::nucleus;
use crate::diagnostic::{Diagnostic, Findings};
use crate::graph::NodeId;
use crate::memory::Memory;
use crate::scene::document::{Scene, TimeSpan};

use compiler::{CompiledNucleus, Compiler};
use geometry::Geometry;
use program::ProgramData;

pub(crate) use attachments::AttachmentState;
pub use camera::{Camera, FilmFit, View};
pub use constraints::kinds::defaults_by_type;
pub use face_sets::face_sets;
pub(crate) use geometry::max_points;
pub use geometry::primitive_surface;
pub(crate) use liquids::self_collides;
pub use mesh_files::file_mesh;
pub use particle_expressions::particle_variables;
pub(crate) use program::least_common_multiple;
pub use program::{NamedSelection, NucleusProgram, Object, ObjectKind, Program};
pub(crate) use sources::EmitterState;
pub use texture_coordinates::{MeshCoordinates, texture_coordinates};

/// Compiles a scene.
///
/// # Errors
/// All errors of the scene: missing or invalid meshes, points that do not exist, values outside their range.
pub fn compile(scene: &Scene) -> Result<Program, Vec<Diagnostic>> {
    let mut findings = Findings::new(scene.source.file().to_owned());
    for fault in scene.time_faults() {
        findings.error(&(0..0), fault);
    }
    // Without valid times nothing has a start.
    if findings.errors() > 0 {
        return Err(findings.in_order());
    }
    let mut geometry = Geometry::new(scene);
    let compiled = compile_nuclei(scene, &BTreeSet::new(), &mut geometry, &mut findings);
    if compiled.is_empty() {
        let error = findings.error(&(0..0), "there is nothing to solve: the scene has no nucleus");
        error.help("add `\"nucleus1\": nucleus()`");
    }
    if findings.errors() > 0 {
        return Err(findings.in_order());
    }
    let mut program = link(scene, compiled, geometry.budget.taken());
    warn_of_late_start(scene, program.nuclei(), &mut findings);
    budget::choose(scene, &mut program, &mut findings);
    program.set_warnings(findings.in_order());
    Ok(program)
}

/// Warns of frames of the scene before the first one of any nucleus: a run begins there.
fn warn_of_late_start(scene: &Scene, nuclei: &[NucleusProgram], findings: &mut Findings) {
    let Some(first) = nuclei.iter().min_by_key(|nucleus| nucleus.start()) else { return };
    let (start, name) = (first.start(), scene.graph.node(first.node()).name());
    if start > scene.time.start {
        let message = format!(
            "the run begins at frame {start}, where `{name}` starts, and not at frame {}",
            scene.time.start
        );
        let warning = findings.warning(&scene.source.place(&format!("{name}.startFrame")), message);
        warning.help(format!("write `time: (start: {start}, ...)`, or `startFrame: {}`", scene.time.start));
    }
}

/// The diagnostics of compiling the valid part of a scene. Nothing is reported about `broken` nodes.
pub(crate) fn survey(scene: &Scene, broken: &BTreeSet<NodeId>) -> Vec<Diagnostic> {
    let mut findings = Findings::new(scene.source.file().to_owned());
    compile_nuclei(scene, broken, &mut Geometry::new(scene), &mut findings);
    findings.in_order()
}

/// Joins the nuclei to one program.
fn link(scene: &Scene, compiled: Vec<CompiledNucleus>, memory: Memory) -> Program {
    let (mut nuclei, mut objects, mut mass) = (Vec::new(), Vec::new(), 0.0);
    for nucleus in compiled {
        nuclei.push(nucleus.program);
        objects.extend(nucleus.objects);
        mass += nucleus.mass;
    }
    // Cloths of all nuclei, then colliders of all nuclei.
    objects.sort_by_key(|object| matches!(object.kind, ObjectKind::Collider(_)));
    let start = nuclei.iter().map(NucleusProgram::start).min().unwrap_or(scene.time.start);
    let data = ProgramData {
        graph: scene.graph.clone(),
        time: TimeSpan { start, ..scene.time },
        every: scene.every,
        record: scene.record,
        checks: scene.checks.clone(),
        nuclei,
        objects,
        mass,
        memory,
        warnings: Vec::new(),
        budgets: Vec::new(),
    };
    Program { data: Arc::new(data) }
}

/// Each nucleus separately, in the order of names. Of several, those without objects are left out.
fn compile_nuclei(
    scene: &Scene,
    broken: &BTreeSet<NodeId>,
    geometry: &mut Geometry,
    findings: &mut Findings,
) -> Vec<CompiledNucleus> {
    let mut nuclei: Vec<NodeId> = scene.graph.of_type(&nucleus::NUCLEUS).map(|(id, _)| id).collect();
    nuclei.sort_by_key(|id| scene.graph.node(*id).name());
    let mut all: Vec<CompiledNucleus> = Vec::new();
    for nucleus in nuclei {
        let previous = all.last().map(|compiled| &compiled.program);
        let compiled = Compiler::new(scene, nucleus, broken, geometry, previous, findings).compile();
        all.push(compiled);
    }
    idle::warn_of_idle_nodes(scene, broken, findings);
    if all.iter().any(|compiled| !compiled.objects.is_empty()) {
        all.retain(|compiled| !compiled.objects.is_empty());
    } else {
        all.truncate(1);
    }
    all
}

#[cfg(test)]
mod tests;
