//! Watching a frame from outside: after each substep the solver shows its state to an observer.

use std::ops::ControlFlow;

use nalgebra::Vector3;

use crate::input::ids::{ClothId, ColliderId};

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

/// How contact stands at a point of cloth: the higher, the less is as it should be.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
#[repr(u8)]
pub enum ContactState {
    /// It touches nothing.
    #[default]
    Free = 0,
    /// It is held at its thickness.
    Touching = 1,
    /// It is nearer than nine tenths of its thickness, mostly for want of room.
    Compressed = 2,
    /// It is inside a closed collider, and is being led out.
    Depenetrating = 3,
    /// It is at an edge of cloth that goes through a face of cloth, and is being worked apart from it.
    Intersecting = 4,
}

/// What can be read of the state between substeps. Everything is in the user's order of points.
pub trait StateView {
    /// Replaces `out` by the positions of a cloth, in units of which `units_per_metre` make a metre.
    fn positions(&self, cloth: ClothId, units_per_metre: f64, out: &mut Vec<[f32; 3]>);
    /// Replaces `out` by the velocities of a cloth, in units per second.
    fn velocities(&self, cloth: ClothId, units_per_metre: f64, out: &mut Vec<[f32; 3]>);
    /// Replaces `out` by how contact stands at each point, cloth by cloth: of all at once, as what is found of one is half
    /// of what there is to know of another. A cloth has no row where no contact can be; who does not know gives nothing.
    fn contacts(&self, out: &mut Vec<Vec<ContactState>>) {
        out.clear();
    }
    /// Replaces `out` by the positions of a collider.
    fn collider_positions(&self, collider: ColliderId, units_per_metre: f64, out: &mut Vec<[f32; 3]>);
    /// Whether the collider has moved since the frame before.
    fn collider_moved(&self, collider: ColliderId) -> bool;
    /// One point of a cloth in metres and double precision; for tests and measures.
    fn point(&self, cloth: ClothId, point: usize) -> Vector3<f64>;
    /// Replaces `out` by the positions of a collider in metres and double precision when this share of the frame is over;
    /// for tests and measures. What does not know its motion gives the positions that it has.
    fn collider_points(&self, collider: ColliderId, share: f64, out: &mut Vec<Vector3<f64>>) {
        let _ = share;
        let mut single = Vec::new();
        self.collider_positions(collider, 1.0, &mut single);
        out.clear();
        out.extend(single.iter().map(|&point| Vector3::from(point.map(f64::from))));
    }
}

/// Something that is shown the state after each substep: a recorder, a meter, nothing (`()`).
pub trait StepObserver {
    /// Called once after each substep.
    fn substep(&mut self, moment: SubstepIndex, state: &dyn StateView);

    /// Called after each step within a substep, where the solver takes several; `share` of the frame is over. Points go
    /// straight from one of these states to the next.
    fn step(&mut self, share: f64, state: &dyn StateView) {
        let _ = (share, state);
    }

    /// Asked within a frame, between the rounds of each time step: an answer of `Break` ends the frame there. Its report
    /// then says so, and the state is within a time step: a run goes on from a state that was saved before the frame.
    fn should_continue(&self) -> ControlFlow<()> {
        ControlFlow::Continue(())
    }

    /// Called when the solver turns to another stage of its work. The solver has no clock; who wants to know
    /// how long a stage takes looks at one here.
    fn enter(&mut self, stage: Stage) {
        let _ = stage;
    }
}

/// The stages of a frame, in the order in which they come.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Stage {
    /// Animation is taken up; anchors, rows and trees follow it.
    FrameStart,
    /// Normals for the air.
    Normals,
    /// Forces, inertia, and the velocities of the step before.
    Predict,
    /// Sweeps over links and hinges.
    Constraints,
    /// The broad phase, and the ground plane.
    BroadPhase,
    /// Contacts.
    Contact,
    /// Velocities, damping.
    Velocity,
    /// Showing the state to the observer.
    Observe,
    /// The account of the frame.
    Report,
}

impl StepObserver for () {
    fn substep(&mut self, _moment: SubstepIndex, _state: &dyn StateView) {}
}
