//! The output of the solver: the state that an observer reads after each substep, the report of a frame, and the cost
//! of its passes. `report/` computes them.

use std::ops::ControlFlow;

use nalgebra::Vector3;

use crate::input::validation::Sanitized;
use crate::input::{ClothId, ColliderId};

/// Which substep of the frame has just ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SubstepIndex {
    /// The substep that has ended, counted from 1.
    pub substep: u32,
    /// How many the frame has.
    pub substeps: u32,
}

impl SubstepIndex {
    /// Whether this is the end of the frame.
    pub fn ends_frame(self) -> bool {
        self.substep == self.substeps
    }
}

/// The contact state of a point of cloth, ordered by severity.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
#[repr(u8)]
pub enum ContactState {
    /// No contact.
    #[default]
    Free = 0,
    /// In contact at its thickness.
    Touching = 1,
    /// In contact at less than nine tenths of its thickness, mostly because two bodies leave too little clearance.
    Compressed = 2,
    /// Inside a closed collider, in depenetration.
    Depenetrating = 3,
    /// At an edge of cloth that intersects a face of cloth, in untangling.
    Intersecting = 4,
}

impl ContactState {
    /// The state of a number; `None` if no state has it.
    pub(crate) fn from_byte(byte: u8) -> Option<Self> {
        let all = [Self::Free, Self::Touching, Self::Compressed, Self::Depenetrating, Self::Intersecting];
        all.get(usize::from(byte)).copied()
    }
}

/// A particle of an object in which particles are born and die.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Particle {
    /// Its number, counted from 0 over all particles that the object ever had.
    pub id: u64,
    /// Time since its birth in seconds.
    pub age: f64,
    /// Age at which it dies in seconds; infinite for never.
    pub lifespan: f64,
    /// In kilograms, without the ramp.
    pub mass: f64,
}

/// The looks of a particle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ParticleLook {
    /// Factor on the radius of the object.
    pub radius: f32,
    /// 0 is invisible, 1 opaque.
    pub opacity: f32,
    /// Red, green and blue from 0 to 1; `None` where the object has no colours of its own.
    pub color: Option<[f32; 3]>,
    /// Light that it gives off: red, green and blue.
    pub incandescence: [f32; 3],
}

/// Read access to the state between substeps. Points are in the order of their mesh.
///
/// # Panics
/// Objects and points are indices: a method panics when there is no such cloth, collider or point. Those about particles
/// give none instead.
pub trait StateView {
    /// How many cloths and how many colliders there are; the default implementation does not know.
    fn object_counts(&self) -> Option<[usize; 2]> {
        None
    }
    /// Replaces `out` by the positions of a cloth in world space, in units of which `units_per_metre` make a metre.
    fn positions(&self, cloth: ClothId, units_per_metre: f64, out: &mut Vec<[f32; 3]>);
    /// Replaces `out` by the velocities of a cloth, in units per second.
    fn velocities(&self, cloth: ClothId, units_per_metre: f64, out: &mut Vec<[f32; 3]>);
    /// Replaces `out` by the contact state of each point, cloth by cloth. All cloths come at once, because a contact
    /// between two cloths concerns both. A cloth's row is empty where contact is impossible; the default implementation
    /// knows of none.
    fn contacts(&self, out: &mut Vec<Vec<ContactState>>) {
        out.clear();
    }
    /// Replaces `out` by the particles of an object in the order of their positions; none where particles are not born
    /// and do not die.
    fn particles(&self, cloth: ClothId, out: &mut Vec<Particle>) {
        let _ = cloth;
        out.clear();
    }
    /// Replaces `out` by the looks of the particles of an object in the order of their positions; none where they all look
    /// the same.
    fn looks(&self, cloth: ClothId, out: &mut Vec<ParticleLook>) {
        let _ = cloth;
        out.clear();
    }
    /// Replaces `out` by the orientations of the particles of an object, in the order of their positions, as unit
    /// quaternions x, y, z, w; none where they do not rotate.
    fn orientations(&self, cloth: ClothId, out: &mut Vec<[f32; 4]>) {
        let _ = cloth;
        out.clear();
    }
    /// Replaces `out` by the positions of a collider.
    fn collider_positions(&self, collider: ColliderId, units_per_metre: f64, out: &mut Vec<[f32; 3]>);
    /// Whether the collider moved in this frame.
    fn collider_moved(&self, collider: ColliderId) -> bool;
    /// The position of a point of cloth in metres, in double precision; for tests and measurements.
    fn point(&self, cloth: ClothId, point: usize) -> Vector3<f64>;
    /// Replaces `out` by the positions of a collider at a time of the frame (0 to 1), in metres, in double precision;
    /// for tests and measurements. The default implementation ignores the time.
    fn collider_points(&self, collider: ColliderId, share: f64, out: &mut Vec<Vector3<f64>>) {
        let _ = share;
        let mut single = Vec::new();
        self.collider_positions(collider, 1.0, &mut single);
        out.clear();
        out.extend(single.iter().map(|&point| Vector3::from(point.map(f64::from))));
    }
}

/// Receives the state after each substep: a recorder, a meter, or `()`, which ignores it.
pub trait StepObserver {
    /// Called once after each substep.
    fn substep(&mut self, index: SubstepIndex, state: &dyn StateView);

    /// Called after each time step, at the time `share` of the frame (0 to 1). Points move on straight lines from one
    /// of these states to the next.
    fn step(&mut self, share: f64, state: &dyn StateView) {
        let _ = (share, state);
    }

    /// Whether it needs the substeps before the last of a frame. Several solvers of a scene keep their states for one
    /// that does, to show them in the order of time.
    fn observes_substeps(&self) -> bool {
        true
    }

    /// Called before each pass of a time step: `Break` ends the frame there. Its report is then `stopped`, and the
    /// state is in the middle of a time step: to continue, restore a checkpoint from before the frame.
    fn should_continue(&self) -> ControlFlow<()> {
        ControlFlow::Continue(())
    }

    /// Called when the solver enters another stage. The solver has no clock; an observer that measures stages reads one
    /// here.
    fn enter(&mut self, stage: Stage) {
        let _ = stage;
    }
}

/// The stages of a frame, in the order in which they come.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Stage {
    /// Start of the frame: animation is read; anchors, rows and bounding volumes are updated.
    FrameStart,
    /// Normals, for aerodynamic forces.
    Normals,
    /// Prediction: external forces and inertia.
    Predict,
    /// Gauss-Seidel sweeps over links and hinges.
    Constraints,
    /// Broad phase, and the ground plane.
    BroadPhase,
    /// Contact passes and the safeguard.
    Contact,
    /// Velocity update, restitution and damping.
    Velocity,
    /// The observer reads the state.
    Observe,
    /// The report of the frame.
    Report,
}

impl StepObserver for () {
    fn substep(&mut self, _index: SubstepIndex, _state: &dyn StateView) {}

    fn observes_substeps(&self) -> bool {
        false
    }
}

/// The report of one frame: counters over the frame, and worst values at its end.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StepReport {
    /// Largest strain of any link at the end of the frame: length over rest length, minus one.
    pub max_strain: f64,
    /// The 99th percentile of the strain of all links.
    pub strain_99: f64,
    /// Smallest gap ratio of a point to a collider or the ground plane at the end of the frame: distance over the
    /// contact thickness. 1 is touching, below 1 is compressed; infinite where nothing is near.
    pub min_gap: f64,
    /// Smallest gap ratio of two elements of cloth in contact at the end of the frame. Infinite where there is no
    /// contact.
    pub min_cloth_gap: f64,
    /// Self-collision pairs whose contact thickness is limited by their distance at rest.
    pub rest_limited: u64,
    /// Contacts that corrected a position, over all passes of the frame.
    pub contacts: u64,
    /// Candidate pairs of the broad phase, over all its runs in the frame.
    pub candidate_pairs: u64,
    /// Runs of the broad phase: one per candidate interval, and one more wherever a point violates its motion bounds.
    pub broad_phases: u32,
    /// Pairs of elements, of cloth and a collider or of two cloths, that would have passed through each other, and
    /// whose motion the safeguard reverted or truncated; counted each time.
    pub pairs_reverted: u64,
    /// Pairs that no fallback could certify, so that one may have passed through the other; counted once per time step.
    /// Pins or colliders leave them no feasible motion, or they touched when the time step began. A point that a pin carries
    /// through the ground plane is counted in that frame, and an edge and a face that intersect when a weld between them breaks
    /// once.
    pub pairs_unresolved: u64,
    /// Points inside a closed collider, in depenetration.
    pub depenetrating: u64,
    /// Edges of cloth that intersect faces of cloth at the end of the frame, in untangling.
    pub intersections: u64,
    /// Links of dynamic constraints that are broken at the end of the frame.
    pub broken_links: u64,
    /// Largest distance in metres of two places that are welded, beyond their distance at rest, at the end of the frame.
    pub max_weld_gap: f64,
    /// Particles at the end of the frame, of objects in which they are born and die.
    pub particles: u64,
    /// Particles born in the frame.
    pub births: u64,
    /// Particles that died in the frame.
    pub deaths: u64,
    /// Particles that were not born because their object was full, they would touch too many others, or their position was
    /// invalid.
    pub births_refused: u64,
    /// Particles that were not born because they would have overlapped others (`emissionOverlapPruning`).
    pub births_pruned: u64,
    /// Mean excess of density of the particles of a liquid over that at rest, at the end of the frame; of several liquids
    /// the largest.
    pub density_error: f64,
    /// Kinetic energy at the end of the frame in joules.
    pub kinetic_energy: f64,
    /// Whether every position and velocity is a finite number.
    pub finite: bool,
    /// Invalid values in the input of the frame, which were replaced.
    pub sanitized: Sanitized,
    /// Whether the observer stopped the frame before its end; the other fields are then meaningless.
    pub stopped: bool,
}

impl Default for StepReport {
    fn default() -> Self {
        Self {
            max_strain: 0.0,
            strain_99: 0.0,
            min_gap: f64::INFINITY,
            min_cloth_gap: f64::INFINITY,
            rest_limited: 0,
            contacts: 0,
            candidate_pairs: 0,
            broad_phases: 0,
            pairs_reverted: 0,
            pairs_unresolved: 0,
            depenetrating: 0,
            intersections: 0,
            broken_links: 0,
            max_weld_gap: 0.0,
            particles: 0,
            births: 0,
            deaths: 0,
            births_refused: 0,
            births_pruned: 0,
            density_error: 0.0,
            kinetic_energy: 0.0,
            finite: true,
            sanitized: Sanitized::default(),
            stopped: false,
        }
    }
}

/// The cost of one pass over a list of rows or over all points, per frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PassCost {
    /// The name of the pass: `predict`, `stretch`, `bend`, `collider contact`, `cloth contact` ...
    pub name: &'static str,
    /// Rows in its list; for the contact passes, the elements that can touch.
    pub rows: usize,
    /// Sweeps over the whole list per frame.
    pub sweeps: f64,
}

impl PassCost {
    /// Row evaluations per frame.
    pub fn evaluations(&self) -> f64 {
        self.rows as f64 * self.sweeps
    }
}
