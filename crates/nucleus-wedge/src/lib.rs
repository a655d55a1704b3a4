//! Many runs at once: a plan of runs, their execution on this machine or on a farm, and a page of the results.
//!
//! ```text
//! --vary ─axes─▶ design ─▶ Plan ─plan.json─▶ Pool or Slurm ─a process a run─▶ results/*.json ─collect─▶ wedge.html, wedge.csv
//! ```
//!
//! | You want to know…                                   | Read                        |
//! |-----------------------------------------------------|-----------------------------|
//! | how `cloth1.damp=0..1/5` is read and checked        | [`Axis`]                    |
//! | how axes become rows: grid, random, Latin hypercube | [`Design`]                  |
//! | what a seed changes                                 | [`seed`]                    |
//! | the plan file, one line a run                       | [`Plan`]                    |
//! | which files a wedge consists of                     | [`WedgeFolder`]             |
//! | how a run ended, and whether it is run again        | [`RunResult`]               |
//! | runs as child processes of this machine             | [`Pool`]                    |
//! | runs as a job array of SLURM                        | [`slurm`]                   |
//! | the contact sheet                                   | `pictures.rs`               |
//! | the page and the table                              | [`collect`]                 |
//!
//! **Invariant:** the state of a wedge is in its files alone: the plan, one result per finished run, and the caches. Each
//! file gets its name when it is complete, so a wedge that is killed at any moment can be continued.

#![forbid(unsafe_code)]

mod axis;
pub mod collect;
mod design;
mod error;
mod folder;
mod pictures;
mod plan;
mod pool;
mod result;
pub mod seed;
pub mod slurm;

pub use axis::{Axis, AxisError, Spacing, Values};
pub use design::{Design, DesignError, Row, Sampling, read_table};
pub use error::WedgeError;
pub use folder::{RunLock, WedgeFolder};
pub use plan::{Plan, PlanHeader, PlannedRun, parse_selection, run_name};
pub use pool::{BUSY, Event, Pool, machine, when_parent_ends};
pub use result::{RunOutcome, RunResult, SolvedFrames};
