//! The schedule of a frame, as data: substeps, time steps, and the passes of each.
//!
//! A resistance has two readings, chosen by [`ResistanceModel`]:
//!
//! * **Classic** (§2.2, §2.4 of the Nucleus paper): a count of evaluations in 1/24 s, shared among the substeps. A
//!   substep is one time step. Its sweeps of all effects are interleaved, not run one effect after the other: the k-th
//!   of n sweeps of an effect is due in the middle of the k-th of n equal parts of the substep.
//! * **Physical** (small steps: Macklin et al. 2019): a stiffness. A substep has many time steps, each with one sweep
//!   of every effect, which converges faster than as many sweeps of one step.
//!
//! A time step ends with the contact passes and, where cloth collides with cloth or colliders, with the safeguard. All time
//! steps of a frame have the same passes, because passes that change from step to step feed energy in. Adaptive substepping
//! splits single time steps ([`SplitPlans`]): `adaptive.rs` finds how often, and the schedule says which passes and intervals
//! that gives.
//!
//! | You want to know… | Read |
//! |---|---|
//! | the substeps, time steps and passes of a frame | [`Schedule`] |
//! | the kinds of passes and sweeps | [`Pass`] |
//! | the order of the passes, Classic and Physical | `classic.rs`, `physical.rs` |
//! | the passes over the links of a dynamic constraint | `links.rs` |
//! | what a resistance means, how counts are shared among substeps | [`resistance`] |
//! | when a time step is split | [`adaptive`] |
//! | which cloths alternate the direction of their sweeps | `sweep_direction.rs` |

pub mod adaptive;
mod classic;
mod links;
mod pass;
mod physical;
mod plan;
pub mod resistance;
pub mod sweep_direction;

pub use pass::{
    Direction, Effect, Pass, PassTime, StepInterval, Sweep, TimeInterval, WholeEffect, WholeSweep,
};
pub use plan::{Schedule, SplitPlans, TimeStep};
