//! The Nucleus solver: points, links, hinges and contacts, advanced one frame at a time.
//!
//! It is position-based dynamics (Müller et al. 2007) with the interleaved constraint passes of Nucleus (§2.2),
//! compliant constraints (XPBD, Macklin et al. 2016) and small time steps (Macklin et al. 2019). A bare § names a
//! section of the Nucleus paper.
//!
//! | You want to know… | Read |
//! |---|---|
//! | the stages of a frame, in order | `step.rs` |
//! | the input of a frame, and how invalid values are replaced | `input/` |
//! | how meshes become coloured rows; vertex maps | `model/` |
//! | which columns change during a frame | `state/` |
//! | how often each effect is swept, what a resistance means, when steps are split | `schedule/` |
//! | gravity, inertia, drag, lift and wind | `integrate/` |
//! | stretch, shear, bend and damping | `constraints/` |
//! | how contact is found, resolved and certified | `contact/` |
//! | what an observer reads, and the report of a frame | `output.rs`, computed in `report/` |
//! | how a run is saved and continued | `checkpoint.rs`, encoded by `bytes.rs` |
//! | threads and disjoint writes | `parallel/` |
//! | scalars and SIMD lanes | `math/` |
//! | the public methods, and why the solver is monomorphized in this crate only | `solver.rs`, `compiled.rs` |
//!
//! **Invariant:** this crate knows no nodes, no files and no clock. The same input gives the same bits on any number of
//! threads. From [`ModelBuilder`] on, everything is in metres, kilograms and seconds.
//!
//! Imports point downwards: `math`, `bytes`, `parallel` and `input` know nothing of the solver; `step`, `checkpoint`
//! and `report` are on top, and only `compiled` calls them.

#![deny(unsafe_code)] // allowed where tasks share columns, each time with its reason

mod bytes;
mod checkpoint;
mod compiled;
mod constraints;
mod contact;
mod input;
mod integrate;
mod math;
mod model;
mod output;
mod parallel;
mod report;
mod schedule;
mod solver;
mod state;
mod step;

pub use bytes::{Encode, Reader, RestoreError, add_checksum, verify_checksum};
pub use constraints::pressure::PASCALS_PER_PRESSURE;
pub use input::frame::{
    BendSolver, Bending, COUNT_PERIOD, ClothFrame, ColliderFrame, Elements, FieldSide, ForceField,
    FrameInput, GroundPlane, InputAttract, InputMesh, Liquid, Pin, Pressure, PushOut, ResistanceModel,
    SelfCollision, Stiffness,
};
pub use input::validation::{InvalidInput, MAX_COORDINATE, Sanitized};
pub use input::{ClothId, ColliderId, PointId};
pub use model::build_error::BuildError;
pub use model::builder::{Cloth, ClothLists, Collider, Mass, ModelBuilder, Start};
pub use model::surface::{Faces, Surface};
pub use model::vertex_maps::VertexMaps;
pub use output::{ContactState, PassCost, Stage, StateView, StepObserver, StepReport, SubstepIndex};
pub use schedule::resistance::{
    BENDING_PER_RESISTANCE, PhysicalStiffness, STIFFNESS_PER_RESISTANCE, classic_stiffness,
};
// Other crates see the scalar with everything that is compiled for it.
pub use solver::{CompiledReal as Real, Solver};
