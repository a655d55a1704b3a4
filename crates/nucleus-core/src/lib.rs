//! The Nucleus solver: points, links and collisions, advanced one frame at a time.
//!
//! | You want to know… | Read |
//! |---|---|
//! | what happens in a frame, in order | `step.rs` |
//! | what a frame brings | `frame.rs` |
//! | how fast colliders are kept from leaping over cloth | `impact.rs` |
//! | what becomes of a NaN in it | `refuse.rs` |
//! | what an artist's resistance means | `resistance.rs` |
//! | how often each effect is swept, and when | `schedule.rs` |
//! | where stretch, shear, bend and damping are computed | `constraints/` |
//! | attributes that differ from point to point | `factors.rs`, `constraints/shares.rs` |
//! | gravity and inertia; drag, lift and wind | `predict.rs`, `air.rs` |
//! | how lists are laid out in blocks and colours | `model/rows.rs` |
//! | how contact is found and proven | `collision/`, `collide.rs`, `broad_phase.rs`, `meet.rs` |
//! | what sticks, bounces, is pushed out | `collision/stick.rs`, `bounce.rs`, `push_out.rs` |
//! | how contact is seen to stand at each point | `ladder.rs` |
//! | how a run goes on from where it was saved | `checkpoint/` |
//! | why the solver is compiled here alone | `compiled.rs` |
//! | how threads share the work | `team.rs`, `columns.rs` |
//!
//! **Invariant:** this crate knows no nodes, no files and no clock. Same input, same bits, on any number of
//! threads. From the door ([`ModelBuilder`]) on, everything is in metres, kilograms and seconds.

#![deny(unsafe_code)] // allowed where columns are shared among tasks, each time with its reason

mod air;
mod bounce;
mod broad_phase;
mod builder;
mod checkpoint;
mod collide;
mod collision;
mod columns;
mod compiled;
mod constraints;
mod factors;
mod frame;
mod frame_start;
mod ids;
mod impact;
mod ladder;
mod measure;
mod meet;
mod model;
mod observe;
mod passes;
mod predict;
mod push_out;
mod refuse;
mod relax;
mod report;
mod resistance;
mod scalar;
mod schedule;
mod settle;
mod solver;
mod state;
mod step;
mod surface;
mod team;
mod velocity;

pub use builder::{BuildError, Cloth, ClothLists, Collider, Mass, ModelBuilder, Start};
pub use checkpoint::{Item, Reader, RestoreError, sealed, unsealed};
pub use factors::PointFactors;
pub use frame::{
    COUNT_PERIOD, ClothFrame, ColliderFrame, Elements, FrameInput, GroundPlane, Pin, PushOut,
    ResistanceModel, SelfCollision, Stiffness,
};
pub use ids::{ClothId, ColliderId, PointId};
pub use observe::{Contact, Moment, Stage, StateView, StepObserver};
pub use passes::PassCost;
pub use refuse::{FARTHEST, Refusals, Refused};
pub use report::StepReport;
pub use resistance::{
    BENDING_PER_RESISTANCE, PhysicalStiffness, STIFFNESS_PER_RESISTANCE, classic_stiffness,
};
pub use scalar::Real;
pub use solver::Solver;
pub use surface::{Faces, Surface};
