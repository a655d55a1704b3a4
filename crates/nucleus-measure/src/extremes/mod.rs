//! Stress tests: scenes with extreme inputs, and bounds that hold in them.
//!
//! | Question                                            | Read                |
//! |-----------------------------------------------------|---------------------|
//! | the rows                                            | [`rows()`], `rows/` |
//! | a row: scene, baseline, bounds                      | [`StressCase`]      |
//! | the scene of a row, with its meshes                 | [`TestScene`]       |
//! | a run, frame by frame                               | [`Timeline`]        |
//! | upper bound of the kinetic energy of a run          | `energy_budget.rs`  |
//! | evaluation of a row against its bounds              | [`Evaluation`]      |
//! | the Markdown page                                   | [`page`]            |
//!
//! **Invariant:** every bound is stated in the row before the run, and follows from the scene or from the needs of a
//! user; none is copied from the output of the solver.

mod energy_budget;
mod evaluation;
mod page;
mod row;
mod rows;
mod scene;
mod timeline;

pub use evaluation::{
    Baselines, Evaluation, Findings, Kind, Measurement, TimeBudget, evaluate, evaluate_all,
};
pub use page::{failure_text, page};
pub use row::{Assertion, CostUnit, Expectation, Recovery, Runs, Side, StressCase};
pub use rows::{named, rows};
pub use scene::{CompiledScene, FaultInjection, TestScene};
pub use timeline::{FrameRecord, Timeline};
