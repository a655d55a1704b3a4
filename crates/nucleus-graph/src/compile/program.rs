//! A scene that can run.

use std::sync::Arc;

use nucleus_core::{ClothId, ColliderId, Faces, ModelBuilder};

use crate::checks::Check;
use crate::graph::{Graph, NodeId};
use crate::scene::{Diagnostic, Record, TimeSpan};

use super::camera::{self, Camera};
use super::objects::{ClothSource, ColliderSource};
use super::pins::PinSource;
use super::units::Units;

/// A compiled scene. Cheap to clone: clones share everything.
#[derive(Debug, Clone)]
pub struct Program {
    pub(super) whole: Arc<Whole>,
}

/// All of a program.
#[derive(Debug)]
pub(super) struct Whole {
    pub(super) graph: Graph,
    pub(super) time: TimeSpan,
    pub(super) every: f64,
    pub(super) record: Record,
    pub(super) checks: Vec<Check>,
    /// At least one.
    pub(super) universes: Vec<Universe>,
    pub(super) objects: Vec<Object>,
    pub(super) mass: f64,
    pub(super) warnings: Vec<Diagnostic>,
}

/// A nucleus with all that belongs to it: nothing in another one has any influence on it (N3.1-2).
#[derive(Debug)]
pub struct Universe {
    pub(super) nucleus: NodeId,
    pub(super) units: Units,
    pub(super) model: ModelBuilder,
    pub(super) cloths: Vec<ClothSource>,
    pub(super) colliders: Vec<ColliderSource>,
    pub(super) pins: Vec<PinSource>,
    /// The frame at which it begins.
    pub(super) start: i64,
    /// How many cloths and colliders the nuclei before have.
    pub(super) first_cloth: u32,
    pub(super) first_collider: u32,
}

/// An object of a program.
#[derive(Debug, Clone, PartialEq)]
pub struct Object {
    /// Name of its node.
    pub name: String,
    /// What it is to the solver. In a scene of several nuclei the ids count on from one to the next.
    pub kind: ObjectKind,
    /// How many points it has.
    pub points: usize,
    /// Its faces, which never change.
    pub faces: Faces,
    /// Radius of each of its particles in scene units; nothing for a mesh.
    pub radius: Option<f64>,
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
    /// The model that the solver of the first nucleus starts from. Metres, kilograms.
    pub fn model(&self) -> &ModelBuilder {
        &self.whole.universes[0].model
    }

    /// The nuclei, in the order of their names; nearly always one.
    pub fn universes(&self) -> &[Universe] {
        &self.whole.universes
    }

    /// All objects: cloths, then colliders, each in the order of their ids.
    pub fn objects(&self) -> &[Object] {
        &self.whole.objects
    }

    /// The cameras over all frames, in the order of their names.
    pub fn cameras(&self) -> Vec<Camera> {
        camera::cameras(self.graph(), self.time())
    }

    /// The frames of the run. It begins at the nucleus' `startFrame` if that is later than the scene's start.
    pub fn time(&self) -> TimeSpan {
        self.whole.time
    }

    /// Frames from one evaluation to the next.
    pub fn every(&self) -> f64 {
        self.whole.every
    }

    /// What is to be recorded.
    pub fn record(&self) -> Record {
        self.whole.record
    }

    /// What must hold.
    pub fn checks(&self) -> &[Check] {
        &self.whole.checks
    }

    /// Scene units in a metre, for the first nucleus.
    pub fn units_per_metre(&self) -> f64 {
        self.whole.universes[0].units.per_metre()
    }

    /// Mass of all cloth together, in kilograms.
    pub fn mass(&self) -> f64 {
        self.whole.mass
    }

    /// What runs, but perhaps not as meant.
    pub fn warnings(&self) -> &[Diagnostic] {
        &self.whole.warnings
    }

    /// The graph that it was compiled from.
    pub fn graph(&self) -> &Graph {
        &self.whole.graph
    }
}

impl Universe {
    /// The model that its solver starts from. Metres, kilograms.
    pub fn model(&self) -> &ModelBuilder {
        &self.model
    }

    /// The frame at which it begins.
    pub fn start(&self) -> i64 {
        self.start
    }

    /// Its nucleus.
    pub fn nucleus(&self) -> NodeId {
        self.nucleus
    }

    /// Scene units in a metre.
    pub fn units_per_metre(&self) -> f64 {
        self.units.per_metre()
    }

    /// The cloths that are its own, by their ids in the program.
    pub fn cloths(&self) -> std::ops::Range<u32> {
        self.first_cloth..self.first_cloth + self.cloths.len() as u32
    }

    /// The colliders that are its own, by their ids in the program.
    pub fn colliders(&self) -> std::ops::Range<u32> {
        self.first_collider..self.first_collider + self.colliders.len() as u32
    }
}
