//! A compiled scene: one model per nucleus, and the sources of each frame's input.

use std::ops::Range;
use std::sync::Arc;

use nucleus_core::{Cloth, ClothId, ColliderId, Faces, InvalidInput, ModelBuilder, RampTarget};

use crate::attributes::{ElementKind, FromValue, Key, nucleus};
use crate::checks::Check;
use crate::diagnostic::Diagnostic;
use crate::graph::{EvalContext, Graph, NodeId};
use crate::memory::Memory;
use crate::scene::document::{Record, TimeSpan};

use super::camera::{self, Camera};
use super::constraints::member::ConstraintSource;
use super::sources::{AttachmentSource, ClothSource, ColliderSource, Emitter, FieldSource};
use super::units::Units;

/// A compiled scene. Cloning is cheap: clones share their data.
#[derive(Debug, Clone)]
pub struct Program {
    pub(super) data: Arc<ProgramData>,
}

/// The shared data of a program.
#[derive(Debug)]
pub(super) struct ProgramData {
    pub(super) graph: Graph,
    pub(super) time: TimeSpan,
    pub(super) every: f64,
    pub(super) record: Record,
    pub(super) checks: Vec<Check>,
    /// At least one.
    pub(super) nuclei: Vec<NucleusProgram>,
    pub(super) objects: Vec<Object>,
    pub(super) mass: f64,
    pub(super) memory: Memory,
    pub(super) warnings: Vec<Diagnostic>,
    /// By nucleus: the budget that `autoEvaluations` chose; empty where none does.
    pub(super) budgets: Vec<Option<f64>>,
}

/// One nucleus with its cloths, colliders and constraints. Nuclei do not influence each other (N3.1-2).
#[derive(Debug)]
pub struct NucleusProgram {
    pub(super) node: NodeId,
    pub(super) units: Units,
    pub(super) model: ModelBuilder,
    pub(super) cloths: Vec<ClothSource>,
    pub(super) colliders: Vec<ColliderSource>,
    pub(super) attachments: Vec<AttachmentSource>,
    pub(super) constraints: Vec<ConstraintSource>,
    pub(super) selections: Vec<NamedSelection>,
    pub(super) emitters: Vec<Emitter>,
    pub(super) fields: Vec<FieldSource>,
    /// Start frame.
    pub(super) start: i64,
    /// The time after which it is solved, in frames of its `currentTime`.
    pub(super) start_time: f64,
    /// Count of cloths in the nuclei before this one.
    pub(super) first_cloth: u32,
    /// Count of colliders in the nuclei before this one.
    pub(super) first_collider: u32,
}

/// An object of a program.
#[derive(Debug, Clone, PartialEq)]
pub struct Object {
    /// Name of its node.
    pub name: String,
    /// Its role and id in the solver. Ids are numbered on from one nucleus to the next.
    pub kind: ObjectKind,
    /// Count of its points.
    pub points: usize,
    /// Count of the points of its mesh, which come first: more follow where it is split to tear.
    pub mesh_points: usize,
    /// Its faces, constant during the run.
    pub faces: Faces,
    /// Radius of its particles in scene units; `None` for a mesh.
    pub radius: Option<f64>,
    /// `threshold` and `blobbyRadiusScale` of the surface of its particles.
    pub surface: [f64; 2],
    /// Distance of its particles at rest in scene units, if it is a liquid.
    pub rest_distance: Option<f64>,
    /// Whether its points are particles that are born and die; `points` is then their number at the start.
    pub varies: bool,
}

/// The elements of an object that a constraint names.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct NamedSelection {
    /// Name of the constraint.
    pub owner: String,
    /// Name of the object.
    pub object: String,
    /// The kind of elements.
    pub kind: ElementKind,
    /// Their numbers.
    pub elements: Vec<u32>,
    /// The points of these elements, each once, in order.
    pub points: Vec<u32>,
}

/// The role of an object in the solver.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ObjectKind {
    /// The solver moves it.
    Cloth(ClothId),
    /// The animation moves it.
    Collider(ColliderId),
}

/// The time from one evaluation to the next, which the solver advances in one call.
pub(crate) struct EvaluationInterval<'p> {
    pub(super) nucleus: &'p NucleusProgram,
    pub(super) graph: &'p Graph,
    pub(super) from: EvalContext<'p>,
    pub(super) to: EvalContext<'p>,
    /// Length in seconds of animation time.
    pub(super) seconds: f64,
    /// Frames per second.
    pub(super) fps: f64,
    /// The budget that `autoEvaluations` chose.
    pub(super) budget: Option<f64>,
    /// It begins at or before the start frame: objects are in their initial state.
    pub(super) is_first: bool,
    /// The solver's state is not that of `from`, because the interval before was not solved.
    pub(super) is_discontinuous: bool,
}

impl Program {
    /// The model that the solver of the first nucleus starts from. Metres, kilograms.
    pub fn model(&self) -> &ModelBuilder {
        &self.data.nuclei[0].model
    }

    /// The nuclei in the order of their names; usually one.
    pub fn nuclei(&self) -> &[NucleusProgram] {
        &self.data.nuclei
    }

    /// Whether any particles differ in their looks.
    pub fn has_looks(&self) -> bool {
        let ramps = |cloth: &Cloth| {
            cloth.particles.as_ref().is_some_and(|particles| {
                particles.ramps.iter().any(|ramp| ramp.target.is_look() || ramp.target == RampTarget::Radius)
            })
        };
        self.nuclei().iter().any(|nucleus| nucleus.model.cloths().iter().any(ramps))
    }

    /// Whether any particles have numbers, ages, lifespans and masses of their own.
    pub fn has_individual_particles(&self) -> bool {
        self.nuclei()
            .iter()
            .any(|nucleus| nucleus.model.cloths().iter().any(|cloth| cloth.particles.is_some()))
    }

    /// Whether contact turns any particles.
    pub fn has_rotation(&self) -> bool {
        let rotates = |cloth: &Cloth| cloth.particles.as_ref().is_some_and(|particles| particles.rotates);
        self.nuclei().iter().any(|nucleus| nucleus.model.cloths().iter().any(rotates))
    }

    /// All objects: cloths, then colliders, each in the order of their ids.
    pub fn objects(&self) -> &[Object] {
        &self.data.objects
    }

    /// The names of its fields. Fields are numbered on from one nucleus to the next.
    pub fn field_names(&self) -> impl Iterator<Item = &str> {
        let fields = self.nuclei().iter().flat_map(|nucleus| &nucleus.fields);
        fields.map(|field| self.graph().node(field.node).name())
    }

    /// An invalid input of a nucleus by the ids of the program.
    pub(crate) fn numbered_on(&self, nucleus: usize, input: InvalidInput) -> InvalidInput {
        let (before, own) = (&self.nuclei()[..nucleus], &self.nuclei()[nucleus]);
        let cloth = |id: ClothId| ClothId(own.first_cloth + id.0);
        let collider = |id: ColliderId| ColliderId(own.first_collider + id.0);
        let first_field = before.iter().map(|nucleus| nucleus.fields.len() as u32).sum::<u32>();
        match input {
            InvalidInput::ColliderPoint(id, point) => InvalidInput::ColliderPoint(collider(id), point),
            InvalidInput::ColliderMotion(id) => InvalidInput::ColliderMotion(collider(id)),
            InvalidInput::Collider(id) => InvalidInput::Collider(collider(id)),
            InvalidInput::Pin(id, point) => InvalidInput::Pin(cloth(id), point),
            InvalidInput::NoSuchPin(id, point) => InvalidInput::NoSuchPin(cloth(id), point),
            InvalidInput::StartVelocity(id) => InvalidInput::StartVelocity(cloth(id)),
            InvalidInput::InputMesh(id) => InvalidInput::InputMesh(cloth(id)),
            InvalidInput::Birth(id) => InvalidInput::Birth(cloth(id)),
            InvalidInput::ParticleChange(id) => InvalidInput::ParticleChange(cloth(id)),
            InvalidInput::Cloth(id) => InvalidInput::Cloth(cloth(id)),
            InvalidInput::CreationExpression(id) => InvalidInput::CreationExpression(cloth(id)),
            InvalidInput::RuntimeExpression(id) => InvalidInput::RuntimeExpression(cloth(id)),
            InvalidInput::Field(at) => InvalidInput::Field(first_field + at),
            other => other,
        }
    }

    /// The cameras over all frames, in the order of their names.
    pub fn cameras(&self) -> Vec<Camera> {
        camera::cameras(self.graph(), self.time())
    }

    /// The frames of the run. They begin at the earliest `startFrame` if all nuclei start after the scene.
    pub fn time(&self) -> TimeSpan {
        self.data.time
    }

    /// Frames between two evaluations.
    pub fn every(&self) -> f64 {
        self.data.every
    }

    /// Frames from one solved frame to the next: 1 where the graph is evaluated within frames.
    pub fn whole_frames(&self) -> i64 {
        (self.data.every as i64).max(1)
    }

    /// Frames from one frame that both this run and another solve to the next, given those of the other from one solved frame to
    /// the next.
    pub fn common_frames(&self, of_other: u32) -> u64 {
        least_common_multiple(self.whole_frames().unsigned_abs(), of_other.into())
    }

    /// The record options of the scene.
    pub fn record(&self) -> Record {
        self.data.record
    }

    /// The checks of the scene.
    pub fn checks(&self) -> &[Check] {
        &self.data.checks
    }

    /// Scene units per metre in the first nucleus.
    pub fn units_per_metre(&self) -> f64 {
        self.data.nuclei[0].units.per_metre()
    }

    /// Total mass of all cloths in kilograms.
    pub fn mass(&self) -> f64 {
        self.data.mass
    }

    /// The memory that the run takes, as estimated while the scene was compiled.
    pub fn memory(&self) -> Memory {
        self.data.memory
    }

    /// Findings that do not prevent the run.
    pub fn warnings(&self) -> &[Diagnostic] {
        &self.data.warnings
    }

    /// The evaluations in 1/24 s to which `autoEvaluations` raised those of a nucleus; `None` where they are given or
    /// suffice.
    pub fn budget(&self, nucleus: usize) -> Option<f64> {
        self.data.budgets.get(nucleus).copied().flatten()
    }

    /// Sets the budgets by nucleus. Only while the program is made: a clone has its own.
    pub(super) fn set_budgets(&mut self, budgets: Vec<Option<f64>>) {
        if let Some(data) = Arc::get_mut(&mut self.data) {
            data.budgets = budgets;
        }
    }

    /// Sets the warnings, under the same condition.
    pub(super) fn set_warnings(&mut self, warnings: Vec<Diagnostic>) {
        if let Some(data) = Arc::get_mut(&mut self.data) {
            data.warnings = warnings;
        }
    }

    /// The graph that it was compiled from.
    pub fn graph(&self) -> &Graph {
        &self.data.graph
    }

    /// The interval of a nucleus between two frames, which may be fractions. `elapsed` is its length in frames of
    /// the nucleus' own time.
    pub(crate) fn interval(
        &self,
        nucleus: usize,
        frames: [f64; 2],
        elapsed: f64,
        is_discontinuous: bool,
    ) -> EvaluationInterval<'_> {
        let budget = self.budget(nucleus);
        let nucleus = &self.data.nuclei[nucleus];
        let graph = &self.data.graph;
        let [from, to] = frames.map(|frame| graph.at(frame));
        let fps = self.data.time.fps;
        let seconds = elapsed / fps;
        let is_first = frames[0] <= nucleus.start as f64;
        EvaluationInterval { nucleus, graph, from, to, seconds, fps, budget, is_first, is_discontinuous }
    }

    /// Solver seconds of a nucleus per second of the scene, on the average between two frames of the scene.
    pub fn time_rate(&self, nucleus: usize, [from, to]: [f64; 2]) -> f64 {
        let (node, graph) = (self.nuclei()[nucleus].node(), self.graph());
        let [before, now] = [from, to].map(|frame| graph.at(frame).get(node, &nucleus::CURRENT_TIME));
        let rate = graph.at(to).get(node, &nucleus::TIME_SCALE) * ((now - before) / (to - from));
        rate.max(0.0)
    }

    /// The index of the nucleus that solves a cloth.
    pub fn nucleus_of(&self, cloth: ClothId) -> usize {
        self.locate_cloth(cloth).0
    }

    /// The nucleus of a cloth, by its index, and the id of the cloth in that nucleus.
    pub(crate) fn locate_cloth(&self, cloth: ClothId) -> (usize, ClothId) {
        let owner = self.nuclei().iter().position(|nucleus| nucleus.cloths().contains(&cloth.0));
        let owner = owner.unwrap_or_default();
        (owner, ClothId(cloth.0 - self.nuclei()[owner].first_cloth))
    }

    /// The nucleus of a collider, by its index, and the id of the collider in that nucleus.
    pub(crate) fn locate_collider(&self, collider: ColliderId) -> (usize, ColliderId) {
        let owner = self.nuclei().iter().position(|nucleus| nucleus.colliders().contains(&collider.0));
        let owner = owner.unwrap_or_default();
        (owner, ColliderId(collider.0 - self.nuclei()[owner].first_collider))
    }

    /// The node of an object, and its nucleus.
    pub(crate) fn node_of(&self, object: ObjectKind) -> (NodeId, &NucleusProgram) {
        match object {
            ObjectKind::Cloth(cloth) => {
                let (owner, own) = self.locate_cloth(cloth);
                let nucleus = &self.nuclei()[owner];
                (nucleus.cloths[own.0 as usize].node, nucleus)
            }
            ObjectKind::Collider(collider) => {
                let (owner, own) = self.locate_collider(collider);
                let nucleus = &self.nuclei()[owner];
                (nucleus.colliders[own.0 as usize].node, nucleus)
            }
        }
    }
}

impl EvaluationInterval<'_> {
    /// The value of an attribute at the end of the interval, if it is set or connected.
    pub(super) fn given<T: FromValue>(&self, node: NodeId, key: &Key<T>) -> Option<T> {
        self.graph.is_given(node, key).then(|| self.to.get(node, key))
    }
}

impl NucleusProgram {
    /// The model that its solver starts from. Metres, kilograms.
    pub fn model(&self) -> &ModelBuilder {
        &self.model
    }

    /// The elements that its constraints name, in the order of the constraints and their components.
    pub fn selections(&self) -> &[NamedSelection] {
        &self.selections
    }

    /// Its start frame.
    pub fn start(&self) -> i64 {
        self.start
    }

    /// The time after which it is solved, in frames of its `currentTime`.
    pub(crate) fn start_time(&self) -> f64 {
        self.start_time
    }

    /// Its nucleus node.
    pub fn node(&self) -> NodeId {
        self.node
    }

    /// Scene units per metre.
    pub fn units_per_metre(&self) -> f64 {
        self.units.per_metre()
    }

    /// The largest number of particles that an object of particles can have.
    pub(super) fn room_of(&self, cloth: ClothId) -> u64 {
        let particles = self.model.cloths()[cloth.index()].particles.as_ref();
        particles.map_or(0, |particles| particles.capacity as u64)
    }

    /// The ids of its cloths in the program.
    pub fn cloths(&self) -> Range<u32> {
        self.first_cloth..self.first_cloth + self.cloths.len() as u32
    }

    /// The ids of its colliders in the program.
    pub fn colliders(&self) -> Range<u32> {
        self.first_collider..self.first_collider + self.colliders.len() as u32
    }
}

/// The least common multiple of two numbers, or the largest number if it is larger.
pub(crate) fn least_common_multiple(a: u64, b: u64) -> u64 {
    (a / greatest_common_divisor(a, b).max(1)).saturating_mul(b)
}

fn greatest_common_divisor(a: u64, b: u64) -> u64 {
    if b == 0 { a } else { greatest_common_divisor(b, a % b) }
}
