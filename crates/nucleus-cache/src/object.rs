//! The things a cache shows: a name, a mesh at rest.

use nucleus_core::{ClothId, ColliderId, Faces};

/// What an object is to the solver.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ObjectKind {
    /// A surface that is simulated.
    Cloth,
    /// A surface that others collide with.
    Collider,
    /// Points without faces that are simulated.
    Particles,
}

/// One object of a run.
#[derive(Debug, Clone, PartialEq)]
pub struct ObjectInfo {
    /// Its name in the scene; any characters, unique in the run.
    pub name: String,
    /// What it is to the solver.
    pub kind: ObjectKind,
    /// Its faces; corners index the points.
    pub faces: Faces,
    /// Positions at rest in scene units, one per point.
    pub rest: Vec<[f32; 3]>,
}

impl ObjectInfo {
    /// Whether every face names points that are there.
    pub(crate) fn is_sound(&self) -> bool {
        self.faces.corners().iter().all(|&point| (point as usize) < self.rest.len())
    }
}

/// Where the recorder finds an object's positions in the solver's state.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Source {
    /// Among the cloths.
    Cloth(ClothId),
    /// Among the colliders; recorded only in frames in which it moves.
    Collider(ColliderId),
}
