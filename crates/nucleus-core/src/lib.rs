//! The Nucleus solver: points, links, hinges and contacts, advanced one frame at a time.
//!
//! It is position-based dynamics (Müller et al. 2007) with the interleaved constraint passes of Nucleus (§2.2),
//! compliant constraints (XPBD, Macklin et al. 2016) and small time steps (Macklin et al. 2019). A bare § names a
//! section of the Nucleus paper.
//!
//! ```
//! use nucleus_core::nalgebra::Vector3;
//! use nucleus_core::{Cloth, ClothLists, Collider, Mass, ModelBuilder, Solver, StateView, Surface};
//!
//! let sides = [Vector3::x(), Vector3::z()];
//! let sheet = Surface::sheet(Vector3::new(-0.5, 0.4, -0.5), sides, [10, 10]);
//! let mut builder = ModelBuilder::new();
//! let cloth = builder.cloth(Cloth::new(sheet, Mass::PerArea(0.2), ClothLists::DEFAULT))?;
//! builder.collider(Collider { surface: Surface::sphere(Vector3::zeros(), 0.3, 8) })?;
//!
//! let mut solver: Solver = Solver::new(builder, 1);
//! let mut frame = solver.default_frame();
//! frame.cloths[0].thickness = 0.01;
//! solver.check_frame(&frame)?;
//! for _ in 0..12 {
//!     solver.step(&frame, &mut ());
//! }
//! let middle = solver.point(cloth, 60);
//! assert!(middle.y > 0.3, "the sheet lies on the ball");
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! The whole of it, with a report per frame, is `examples/sheet_on_sphere.rs`.
//!
//! | To… | Use |
//! |---|---|
//! | describe objects | [`ModelBuilder`], [`Cloth`], [`Collider`], [`Surface`], [`VertexMaps`], [`Mass`], [`ClothLists`] |
//! | advance by a frame | [`Solver::step`], with a [`FrameInput`] from [`Solver::default_frame`] |
//! | set the attributes of a frame | [`ClothFrame`], [`ColliderFrame`], [`Pin`], [`GroundPlane`], [`ForceField`] |
//! | refuse bad input | [`BuildError`] from the builder, [`InvalidInput`] from [`Solver::check_frame`] |
//! | read positions, velocities and contacts | [`StateView`], which a [`Solver`] is, or a [`StepObserver`] at each substep |
//! | judge a frame | [`StepReport`] |
//! | save and continue | [`Solver::save`], [`Solver::restored`] |
//! | simulate in `f64` | `Solver<f64>` |
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
//! | particles that are born and die | `particles/` |
//! | force fields of the scene | `fields/` |
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
//! and `report` are on top.

// Unit tests compile only what they call, so that they take no second compilation of the whole solver.
#![cfg_attr(test, allow(dead_code))]
#![deny(unsafe_code)] // allowed where tasks share columns and in SIMD lanes, each time with its reason

mod bytes;
mod checkpoint;
#[cfg(not(test))]
mod compiled;
mod constraints;
mod contact;
mod fields;
mod input;
mod integrate;
mod math;
mod model;
mod output;
mod parallel;
mod particles;
mod report;
mod schedule;
mod solver;
mod state;
mod step;
mod union_find;

/// Vectors of the public interface.
pub use nalgebra;

pub use bytes::{Encode, Reader, RestoreError, add_checksum, verify_checksum};
pub use constraints::link::fold::fold_link;
pub use constraints::link::glue::{LOAD_OF_HALF, breaking_load};
pub use constraints::pressure::{BURST_STRETCH, PASCALS_PER_PRESSURE};
pub use input::fields::{Field, FieldKind, Noise, Reach, Volume, VolumeAxis, VolumeShape};
pub use input::frame::{
    BendSolver, Bending, Birth, COUNT_PERIOD, ClothFrame, ColliderFrame, Elements, FieldSide, ForceField,
    FrameInput, GroundPlane, InputAttract, InputMesh, Liquid, Pin, Pressure, PushOut, ResistanceModel,
    SelfCollision, StartVelocity, Stiffness,
};
pub use input::links::{
    ConstraintFrame, ExcludedSide, Exclusion, Falloff, Fold, Link, LinkForce, LinkKind, LinkMethod, LinkSide,
    MAX_EXCLUSIONS,
};
pub use input::object_fields::{PointField, WindField};
pub use input::particles::{
    CollisionEvent, ParticleChange, ParticleFacts, ParticleRamp, RampInput, RampTarget, unit_random,
};
pub use input::validation::{InputNumber, InputRange, InputSubject, InvalidInput, MAX_COORDINATE, Sanitized};
pub use input::{ClothId, ColliderId, PointId};
pub use model::build_error::BuildError;
pub use model::builder::ModelBuilder;
pub use model::lists::ClothLists;
pub use model::objects::{Cloth, Collider, LinkOrder, Mass, Particles, Start};
pub use model::surface::{Faces, Surface};
pub use model::vertex_maps::VertexMaps;
pub use output::{
    ContactState, Particle, ParticleLook, PassCost, Stage, StateView, StepObserver, StepReport, SubstepIndex,
};
pub use schedule::resistance::{
    BENDING_PER_RESISTANCE, PhysicalStiffness, STIFFNESS_PER_RESISTANCE, classic_stiffness,
};
// Other crates see the scalar with everything that is compiled for it.
pub use solver::{CompiledReal as Real, Solver};
