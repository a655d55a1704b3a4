//! The Nucleus solver: points, links and collisions, advanced one frame at a time.
//!
//! | You want to know… | Read |
//! |---|---|
//! | what happens in a frame, in order | `step.rs` |
//! | what a frame brings, and how NaN and absurd sizes are sanitized | `input/` |
//! | how meshes become coloured rows; vertex maps | `model/` |
//! | which columns change, and how they are saved | `state/` |
//! | how often each effect is swept, what a resistance means, when steps are split | `schedule/` |
//! | gravity, inertia, drag, lift and wind | `integrate/` |
//! | where stretch, shear, bend and damping are computed | `constraints/` |
//! | how contact is found, resolved and certified | `contact/` |
//! | what an observer reads, and what a frame reports | `output/` |
//! | threads and disjoint writes | `parallel/` |
//! | scalars and four-lane vectors | `math/` |
//! | why the solver is monomorphized here alone | `compiled.rs` |
//!
//! **Invariant:** this crate knows no nodes, no files and no clock. Same input, same bits, on any number of
//! threads. From the door ([`ModelBuilder`]) on, everything is in metres, kilograms and seconds.

#![deny(unsafe_code)] // allowed where columns are shared among tasks, each time with its reason

mod compiled;
mod constraints;
mod contact;
mod input;
mod integrate;
mod math;
mod model;
mod output;
mod parallel;
mod schedule;
mod solver;
mod state;
mod step;

pub use constraints::pressure::PASCALS_PER_PRESSURE;
pub use input::frame::{
    BendSolver, Bending, COUNT_PERIOD, ClothFrame, ColliderFrame, Elements, FrameInput, GroundPlane,
    InputAttract, InputMesh, Pin, Pressure, PushOut, ResistanceModel, SelfCollision, Stiffness,
};
pub use input::ids::{ClothId, ColliderId, PointId};
pub use input::validation::{InvalidInput, MAX_COORDINATE, Sanitized};
pub use math::Real;
pub use model::builder::{BuildError, Cloth, ClothLists, Collider, Mass, ModelBuilder, Start};
pub use model::surface::{Faces, Surface};
pub use model::vertex_maps::VertexMaps;
pub use output::observer::{ContactState, Stage, StateView, StepObserver, SubstepIndex};
pub use output::passes::PassCost;
pub use output::report::StepReport;
pub use schedule::resistance::{
    BENDING_PER_RESISTANCE, PhysicalStiffness, STIFFNESS_PER_RESISTANCE, classic_stiffness,
};
pub use solver::Solver;
pub use state::checkpoint::{Item, Reader, RestoreError, sealed, unsealed};
