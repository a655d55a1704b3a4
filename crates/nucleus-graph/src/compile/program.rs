//! A scene that can run.

use nucleus_core::{ClothId, ColliderId, Faces, ModelBuilder};

use crate::checks::Check;
use crate::graph::{Graph, NodeId};
use crate::scene::{Diagnostic, Record, TimeSpan};

use super::objects::{ClothSource, ColliderSource};
use super::pins::PinSource;
use super::units::Units;

/// A compiled scene.
#[derive(Debug, Clone)]
pub struct Program {
    pub(super) graph: Graph,
    pub(super) nucleus: NodeId,
    pub(super) units: Units,
    pub(super) time: TimeSpan,
    pub(super) record: Record,
    pub(super) checks: Vec<Check>,
    pub(super) model: ModelBuilder,
    pub(super) cloths: Vec<ClothSource>,
    pub(super) colliders: Vec<ColliderSource>,
    pub(super) pins: Vec<PinSource>,
    pub(super) objects: Vec<Object>,
    pub(super) mass: f64,
    pub(super) warnings: Vec<Diagnostic>,
}

/// An object of a program.
#[derive(Debug, Clone, PartialEq)]
pub struct Object {
    /// Name of its node.
    pub name: String,
    /// What it is to the solver.
    pub kind: ObjectKind,
    /// How many points it has.
    pub points: usize,
    /// Its faces, which never change.
    pub faces: Faces,
}

/// What an object is to the solver.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ObjectKind {
    /// It is solved.
    Cloth(ClothId),
    /// It moves as it is told.
    Collider(ColliderId),
}

impl Program {
    /// The model that the solver starts from. Metres, kilograms.
    pub fn model(&self) -> &ModelBuilder {
        &self.model
    }

    /// All objects: cloths, then colliders, each in the order of their ids.
    pub fn objects(&self) -> &[Object] {
        &self.objects
    }

    /// The frames of the run. It begins at the nucleus' `startFrame` if that is later than the scene's start.
    pub fn time(&self) -> TimeSpan {
        self.time
    }

    /// What is to be recorded.
    pub fn record(&self) -> Record {
        self.record
    }

    /// What must hold.
    pub fn checks(&self) -> &[Check] {
        &self.checks
    }

    /// Scene units in a metre.
    pub fn units_per_metre(&self) -> f64 {
        self.units.per_metre()
    }

    /// Mass of all cloth together, in kilograms.
    pub fn mass(&self) -> f64 {
        self.mass
    }

    /// What runs, but perhaps not as meant.
    pub fn warnings(&self) -> &[Diagnostic] {
        &self.warnings
    }

    pub(super) fn with_warnings(mut self, warnings: Vec<Diagnostic>) -> Self {
        self.warnings = warnings;
        self
    }
}
