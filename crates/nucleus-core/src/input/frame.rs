//! The input of a frame: everything that may change from frame to frame. Metres, kilograms, seconds; world space.
//!
//! Animation is evaluated once per frame and interpolated linearly inside it (§2.4), so every moving thing has two
//! positions, at the start of the frame and at its end.

use std::sync::Arc;

use nalgebra::Vector3;

use crate::input::fields::Field;
use crate::input::links::{ConstraintFrame, Exclusion};
use crate::input::object_fields::{FALLOFF_SAMPLES, PointField, WindField};
use crate::input::{ClothId, PointId};

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
            wind_noise: 0.0,
            input_meshes: Vec::new(),
            constraints: Vec::new(),
            exclusions: Vec::new(),
            births: Vec::new(),
            fields: Vec::new(),
            fields_per_substep: false,
        }
    }
}

/// A particle that is born in a frame. Until the end of its substep it flies freely.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Birth {
    /// The object, which has room for particles.
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
    /// A point of the plane in metres.
    pub origin: Vector3<f64>,
    /// Its normal, of any length.
    pub normal: Vector3<f64>,
    /// `planeBounce`: 0 none, 1 all.
    pub bounce: f64,
    /// `planeFriction`, added to the cloth's own.
    pub friction: f64,
    /// `planeStickiness`, added to the cloth's own.
    pub stickiness: f64,
}

/// Measured stiffnesses of a cloth. One that is given replaces the resistance of the same effect; zero switches the
/// effect off. Only the Physical reading uses them: in the Classic reading stiffness follows from mesh and substeps.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Stiffness {
    /// Of links longer than at rest, in N/m: Young's modulus times the thickness of the cloth.
    pub stretch: Option<f64>,
    /// Of links shorter than at rest, in N/m.
    pub compression: Option<f64>,
    /// Against shear, in N/m, in addition to that of stretch through cross links.
    pub shear: Option<f64>,
    /// Against bending, in N·m: moment per width, over curvature.
    pub bend: Option<f64>,
}

/// The attributes of one cloth in one frame. A resistance counts evaluations in 1/24 s (Classic) or
/// stands for a stiffness (Physical); see [`ResistanceModel`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ClothFrame {
    /// Resistance of links longer than at rest.
    pub stretch_resistance: f64,
    /// Resistance of links shorter than at rest.
    pub compression_resistance: f64,
    /// Resistance of the cross links of quads.
    pub shear_resistance: f64,
    /// Resistance of the angle between faces.
    pub bend_resistance: f64,
    /// Measured stiffnesses that replace resistances.
    pub stiffness: Stiffness,
    /// Factor on all rest lengths.
    pub rest_length_scale: f64,
    /// Damping of the relative velocity along links.
    pub stretch_damp: f64,
    /// Averaging of velocities between linked points.
    pub damp: f64,
    /// Air drag along the normal, per 1/24 s.
    pub drag: f64,
    /// Share of `drag` that also acts along the surface, 0 to 1.
    pub tangential_drag: f64,
    /// Air force at right angles to the motion: acceleration over v² sin α cos α in 1/m, times the mass.
    pub lift: f64,
    /// Whether the solver's gravity acts on this cloth.
    pub feels_gravity: bool,
    /// Whether the solver's wind acts on this cloth.
    pub feels_wind: bool,
    /// Force on every point in newtons (`localForce`).
    pub local_force: Vector3<f64>,
    /// Wind for this cloth alone, in m/s (`localWind`).
    pub local_wind: Vector3<f64>,
    /// Whether it collides with colliders and the ground plane.
    pub collide: bool,
    /// Thickness in metres; two objects touch at the sum of theirs.
    pub thickness: f64,
    /// Friction; the two sides' values are added.
    pub friction: f64,
    /// Stickiness, 0 to 2; the two sides' values are added, and at 1 they never separate.
    pub stickiness: f64,
    /// Bounce, 0 to 1; the larger of the two sides' values counts.
    pub bounce: f64,
    /// Strength of contacts; the two sides' values are multiplied. From 1 on nothing passes through, below 1 objects
    /// may, at 0 there is no contact.
    pub collide_strength: f64,
    /// Moves points of other objects to a side of its surface.
    pub push_out: PushOut,
    /// Additional speed of untangling where it intersects other cloth; the two sides' values are added.
    pub crossover_push: f64,
    /// The same where it intersects itself.
    pub self_crossover_push: f64,
    /// Its elements of contact with other cloth (`collisionFlag`).
    pub elements: Elements,
    /// `collisionLayer`: in contacts the cloth in the lower layer is heavier, and from a difference of one on the other
    /// does not move it.
    pub layer: f64,
    /// Self-collision.
    pub self_collision: SelfCollision,
    /// Rest angles, their scale, and which bends stay.
    pub bending: Bending,
    /// Strain above which links lengthen permanently (`restitutionTension` over the stretch resistance);
    /// infinite for none.
    pub yield_strain: f64,
    /// Gas inside the mesh, or pressure set by hand.
    pub pressure: Pressure,
    /// `rigidity`: the mesh moves as one rigid body.
    pub rigidity: f64,
    /// `deformResistance`: the mesh keeps its shape.
    pub deform_resistance: f64,
    /// Attraction to the input mesh.
    pub input_attract: InputAttract,
    /// Its force field on other objects.
    pub field: Option<ForceField>,
    /// The force fields of its points.
    pub point_field: Option<PointField>,
    /// Its wind shadow, and the air that it pushes.
    pub wind_field: WindField,
    /// What makes its points a liquid; `None` where they are balls.
    pub liquid: Option<Liquid>,
}

/// A liquid of particles (Maya's Liquid Simulation).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Liquid {
    /// Distance of particles at rest in metres: each stands for a cube of this edge.
    pub spacing: f64,
    /// `incompressibility`: from 1 on the liquid keeps its volume, below it is soft, at 0 nothing resists.
    pub incompressibility: f64,
    /// Kinematic viscosity in m²/s.
    pub viscosity: f64,
    /// Surface tension over density in m³/s².
    pub surface_tension: f64,
}

/// A force field round a surface (`forceField`).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ForceField {
    /// On which side it acts, and in which direction.
    pub side: FieldSide,
    /// Acceleration at the surface in m/s²; above 0 it pushes away.
    pub magnitude: f64,
    /// How far it reaches, in metres.
    pub distance: f64,
    /// Factor from the surface (first) to the distance (last), evenly spaced.
    pub falloff: [f64; Self::SAMPLES],
}

impl ForceField {
    /// Samples of the falloff.
    pub const SAMPLES: usize = FALLOFF_SAMPLES;

    /// Whether it acts at all.
    pub fn is_on(&self) -> bool {
        self.magnitude != 0.0 && self.distance > 0.0
    }
}

/// Where the force field of a surface acts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FieldSide {
    /// On both sides, along the normals.
    AlongNormal,
    /// On the side that the normals point to, away from the surface.
    Single,
    /// On both sides, away from the surface.
    Double,
}

/// How a hinge measures its angle (`bendSolver`).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum BendSolver {
    /// The size of the angle alone: a crease has no side.
    Simple,
    /// The angle with its sign, up to 180° either way.
    Signed,
    /// The same, and a hinge that is folded past 180° is pushed back the way it came.
    FlipTracking,
}

/// What else bending knows beside its resistance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bending {
    /// Factor on rest angles (`bendAngleScale`): 0 is flat, 1 as modelled.
    pub angle_scale: f64,
    /// Share of the resistance that grows with the angle (`bendAngleDropoff`), 0 to 1.
    pub angle_dropoff: f64,
    /// How angles are measured.
    pub solver: BendSolver,
    /// Sine of half the angle beyond which bends become permanent (`restitutionAngle`); infinite for none.
    pub yield_sine: f64,
    /// Half that angle in radians, for a vertex map to scale; infinite for none.
    pub yield_half_angle: f64,
}

impl Bending {
    /// Maya's defaults, but for the sign of angles, which costs a little and matters only to cloth that is bent at rest.
    pub const DEFAULT: Self = Self {
        angle_scale: 1.0,
        angle_dropoff: 0.0,
        solver: BendSolver::Simple,
        yield_sine: f64::INFINITY,
        yield_half_angle: f64::INFINITY,
    };
}

/// Pressure inside a mesh.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Pressure {
    /// None.
    Off,
    /// A gauge pressure set by hand.
    Manual {
        /// In pascals, along the faces' normals.
        pascals: f64,
        /// Damping of the volume's rate of change, in Pa·s.
        damping: f64,
    },
    /// An ideal gas: gauge pressure `bulk` (n V_0 / V - 1) with n times the air that fills the volume at the start.
    Gas {
        /// n at the start, less one (`startPressure`).
        start: f64,
        /// Bulk modulus in pascals (`incompressibility`).
        bulk: f64,
        /// Start volumes of air pumped in per second (`pumpRate`).
        pump: f64,
        /// Share of the air that stays inside, 0 to 1 (`airTightness`).
        tightness: f64,
        /// Damping of the volume's rate of change, in Pa·s.
        damping: f64,
        /// Whether openings are closed (`sealHoles`); else air streams through them.
        sealed: bool,
    },
}

/// Attraction of a cloth to its live input mesh.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct InputAttract {
    /// `inputMeshAttract`: 0 none, 1 firm.
    pub strength: f64,
    /// `inputAttractDamp`: 0 springs, 1 does not overshoot.
    pub damp: f64,
    /// `inputMotionDrag`: how fast velocities take up those of the input mesh.
    pub motion_drag: f64,
}

impl InputAttract {
    /// None.
    pub const OFF: Self = Self { strength: 0.0, damp: 0.0, motion_drag: 0.0 };

    /// Whether there is any.
    pub fn is_on(&self) -> bool {
        self.strength > 0.0 || self.motion_drag > 0.0
    }
}

/// The elements of a mesh that touch the points of another.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Elements {
    /// Points alone.
    Points,
    /// Edges too.
    Edges,
    /// Faces too.
    Faces,
}

/// Moves points of other objects to a side of the surface (`pushOut`).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PushOut {
    /// Share of the distance that points move in a substep, 0 to 1; negative towards the inner side.
    pub share: f64,
    /// Distance from the surface within which points are moved, in metres (`pushOutRadius`).
    pub radius: f64,
}

impl PushOut {
    /// Off.
    pub const OFF: Self = Self { share: 0.0, radius: 0.0 };
}

/// Self-collision of a cloth.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SelfCollision {
    /// Whether it is on (`selfCollide`).
    pub on: bool,
    /// Thickness of each side in metres: `thickness` times `selfCollideWidthScale`.
    pub thickness: f64,
    /// The elements that touch its points (`selfCollisionFlag`).
    pub elements: Elements,
    /// Whether edges touch edges too, so that nothing can pass through (`selfCollisionFlag` full surface).
    pub edges: bool,
}

impl SelfCollision {
    /// Off.
    pub const OFF: Self = Self { on: false, thickness: 0.0, elements: Elements::Faces, edges: true };
}

impl Default for ClothFrame {
    /// Maya's defaults of an nCloth, except `thickness`, which Maya computes from the mesh.
    fn default() -> Self {
        Self {
            stretch_resistance: 20.0,
            compression_resistance: 10.0,
            shear_resistance: 0.0,
            bend_resistance: 0.1,
            stiffness: Stiffness::default(),
            rest_length_scale: 1.0,
            stretch_damp: 0.1,
            damp: 0.0,
            drag: 0.05,
            tangential_drag: 0.0,
            lift: 0.05,
            feels_gravity: true,
            feels_wind: true,
            local_force: Vector3::zeros(),
            local_wind: Vector3::zeros(),
            collide: true,
            thickness: 0.0,
            friction: 0.1,
            stickiness: 0.0,
            bounce: 0.0,
            collide_strength: 1.0,
            push_out: PushOut::OFF,
            crossover_push: 0.0,
            self_crossover_push: 0.0,
            elements: Elements::Faces,
            layer: 0.0,
            self_collision: SelfCollision::OFF,
            bending: Bending::DEFAULT,
            yield_strain: f64::INFINITY,
            pressure: Pressure::Off,
            rigidity: 0.0,
            deform_resistance: 0.0,
            input_attract: InputAttract::OFF,
            field: None,
            point_field: None,
            wind_field: WindField::OFF,
            liquid: None,
        }
    }
}

/// One collider in one frame: its motion and contact attributes.
#[derive(Debug, Clone, PartialEq)]
pub struct ColliderFrame {
    /// Positions at the start of the frame in metres, in the mesh's order. Empty: those at the end of the frame before.
    pub start: Vec<Vector3<f64>>,
    /// Positions at the end of the frame in metres, in the mesh's order. Empty: it does not move.
    pub end: Vec<Vector3<f64>>,
    /// Whether cloth collides with it in this frame.
    pub collide: bool,
    /// Thickness in metres.
    pub thickness: f64,
    /// Friction; the two sides' values are added.
    pub friction: f64,
    /// Stickiness, 0 to 2; the two sides' values are added, and at 1 they never separate.
    pub stickiness: f64,
    /// Bounce, 0 to 1; the larger of the two sides' values counts.
    pub bounce: f64,
    /// Strength of contacts, as of a cloth.
    pub collide_strength: f64,
    /// Moves points of other objects to a side of its surface.
    pub push_out: PushOut,
    /// Whether points inside it, if it is closed, are depenetrated; otherwise they stay inside (`trappedCheck`).
    pub trapped_check: bool,
    /// Its force field on cloth.
    pub field: Option<ForceField>,
    /// The force fields of its points.
    pub point_field: Option<PointField>,
    /// Its wind shadow, and the air that it pushes.
    pub wind_field: WindField,
}

impl Default for ColliderFrame {
    /// Maya's defaults of an nRigid that does not move, except that `friction` and `thickness` are zero.
    fn default() -> Self {
        Self {
            start: Vec::new(),
            end: Vec::new(),
            collide: true,
            thickness: 0.0,
            friction: 0.0,
            stickiness: 0.0,
            bounce: 0.0,
            collide_strength: 1.0,
            push_out: PushOut::OFF,
            trapped_check: true,
            field: None,
            point_field: None,
            wind_field: WindField::OFF,
        }
    }
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
