//! The input of a frame: everything that may change from frame to frame. Metres, kilograms, seconds; world space.
//!
//! Animation is evaluated once per frame and interpolated linearly inside it (§2.4), so every moving thing has two
//! positions, at the start of the frame and at its end.
//!
//! | You want to know… | Read |
//! |---|---|
//! | the attributes of a cloth | [`ClothFrame`] |
//! | stiffness, bending, pressure, attraction and liquids | `material.rs` |
//! | self-collision, push out and the force field of a surface | `contact.rs` |
//! | the motion and attributes of a collider | [`ColliderFrame`] |

use std::sync::Arc;

use nalgebra::Vector3;

use crate::input::fields::Field;
use crate::input::links::{ConstraintFrame, Exclusion};
use crate::input::particles::ParticleChange;
use crate::input::{ClothId, PointId};

mod cloth;
mod collider;
mod contact;
mod material;

pub use cloth::ClothFrame;
pub use collider::ColliderFrame;
pub use contact::{Elements, FieldSide, ForceField, PushOut, SelfCollision};
pub use material::{BendSolver, Bending, InputAttract, Liquid, Pressure, Stiffness};

/// Resistances and iteration counts are given per this time, in seconds: one film frame (§2.2, §2.4).
pub const COUNT_PERIOD: f64 = 1.0 / 24.0;

/// The reading of a resistance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ResistanceModel {
    /// The paper's reading: a resistance is a count of evaluations in 1/24 s, shared among substeps. The stiffness
    /// follows from mesh and substeps.
    Classic,
    /// A resistance is a stiffness that depends on neither mesh nor substeps.
    Physical {
        /// The budget: evaluations in 1/24 s, each a small time step with one sweep over every list. More of them only
        /// reduce the error.
        evaluations: f64,
    },
}

/// One frame's input to the solver. [`Solver::default_frame`](crate::Solver::default_frame) makes one to start from.
#[derive(Debug, Clone, PartialEq)]
pub struct FrameInput {
    /// Simulated time of the frame in seconds (1/24 at 24 frames per second and `timeScale` 1).
    pub duration: f64,
    /// Substeps in the frame, at least 1: the paper's smallest unit of time.
    pub substeps: u32,
    /// Collision passes in 1/24 s (`maxCollisionIterations`).
    pub collision_iterations: f64,
    /// The reading of all resistances.
    pub resistance: ResistanceModel,
    /// Acceleration of gravity in m/s².
    pub gravity: Vector3<f64>,
    /// Velocity of the wind in m/s.
    pub wind: Vector3<f64>,
    /// `airDensity`: 0 is a vacuum, 1 is usual.
    pub air_density: f64,
    /// The ground plane, where the scene uses one.
    pub plane: Option<GroundPlane>,
    /// One entry per cloth, by [`ClothId`].
    pub cloths: Vec<ClothFrame>,
    /// One entry per collider, by [`ColliderId`](crate::ColliderId).
    pub colliders: Vec<ColliderFrame>,
    /// Two cloths whose `collisionLayer` differs by this much or more pass through each other
    /// (`collisionLayerRange`).
    pub layer_range: f64,
    /// Collision passes of cloth with itself and other cloth in 1/24 s (`maxSelfCollisionIterations`).
    pub self_collision_iterations: f64,
    /// The pinned points of this frame; all other points move freely.
    pub pins: Vec<Pin>,
    /// Velocities that free points start the frame with, in place of those that they have.
    pub velocities: Vec<StartVelocity>,
    /// `windNoise`: gusts as a multiple of the wind's speed; 0 is a steady wind.
    pub wind_noise: f64,
    /// Input meshes that attract or drag a cloth, at most one per cloth.
    pub input_meshes: Vec<InputMesh>,
    /// The dynamic constraints, in the same order in every frame.
    pub constraints: Vec<ConstraintFrame>,
    /// Elements that do not collide with each other, [`MAX_EXCLUSIONS`](crate::MAX_EXCLUSIONS) at most.
    pub exclusions: Vec<Arc<Exclusion>>,
    /// The particles that are born in this frame, in the order of their times.
    pub births: Vec<Birth>,
    /// Changes of living particles at the start of the frame.
    pub particle_changes: Vec<ParticleChange>,
    /// Force fields.
    pub fields: Vec<Field>,
    /// Evaluates fields in each substep, not once per frame.
    pub fields_per_substep: bool,
}

impl Default for FrameInput {
    /// One frame at 24 frames per second in a vacuum without gravity, with no objects.
    fn default() -> Self {
        Self {
            duration: COUNT_PERIOD,
            substeps: 1,
            collision_iterations: 4.0,
            resistance: ResistanceModel::Classic,
            gravity: Vector3::zeros(),
            wind: Vector3::zeros(),
            air_density: 0.0,
            plane: None,
            cloths: Vec::new(),
            colliders: Vec::new(),
            layer_range: 4.0,
            self_collision_iterations: 4.0,
            pins: Vec::new(),
            velocities: Vec::new(),
            wind_noise: 0.0,
            input_meshes: Vec::new(),
            constraints: Vec::new(),
            exclusions: Vec::new(),
            births: Vec::new(),
            particle_changes: Vec::new(),
            fields: Vec::new(),
            fields_per_substep: false,
        }
    }
}

/// A particle that is born in a frame. Until the end of its substep it flies freely.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Birth {
    /// The object, which has capacity for particles.
    pub cloth: ClothId,
    /// Time of birth as a share of the frame, 0 to 1.
    pub time: f64,
    /// Position at birth in metres.
    pub position: Vector3<f64>,
    /// Velocity at birth in m/s.
    pub velocity: Vector3<f64>,
    /// Age in seconds at which it dies; infinite for never.
    pub lifespan: f64,
}

/// Positions of a cloth's live input mesh in one frame, in metres, point by point in the mesh's order.
#[derive(Debug, Clone, PartialEq)]
pub struct InputMesh {
    /// The cloth.
    pub cloth: ClothId,
    /// Positions at the start of the frame.
    pub start: Vec<Vector3<f64>>,
    /// Positions at the end of the frame.
    pub end: Vec<Vector3<f64>>,
}

/// An infinite plane that cloth rests on (`usePlane`).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GroundPlane {
    /// A point of the plane at the end of the frame, in metres.
    pub origin: Vector3<f64>,
    /// Its normal at the end of the frame, of any length.
    pub normal: Vector3<f64>,
    /// A point of it and its normal at the start of the frame. `None`: where the last frame left it; a plane that appears
    /// does not move.
    pub start: Option<[Vector3<f64>; 2]>,
    /// `planeBounce`: 0 none, 1 all.
    pub bounce: f64,
    /// `planeFriction`, added to the cloth's own.
    pub friction: f64,
    /// `planeStickiness`, added to the cloth's own.
    pub stickiness: f64,
}

impl GroundPlane {
    /// A plane through a point in metres with a normal of any length, without bounce, friction or stickiness.
    pub const fn new(origin: Vector3<f64>, normal: Vector3<f64>) -> Self {
        Self { origin, normal, start: None, bounce: 0.0, friction: 0.0, stickiness: 0.0 }
    }
}

/// The velocity of a point at the start of a frame, from the motion before.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StartVelocity {
    /// The cloth the point belongs to.
    pub cloth: ClothId,
    /// The point, in the mesh's order.
    pub point: PointId,
    /// In m/s.
    pub velocity: Vector3<f64>,
    /// Its rate of change in the motion before, in m/s².
    pub acceleration: Vector3<f64>,
}

/// A pinned point, which moves along a straight line during the frame (a transform constraint).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pin {
    /// The cloth the point belongs to.
    pub cloth: ClothId,
    /// The point, in the mesh's order.
    pub point: PointId,
    /// Position at the start of the frame, in metres.
    pub start: Vector3<f64>,
    /// Position at the end of the frame, in metres.
    pub end: Vector3<f64>,
}
