//! Work-precision curve of a scene: processor time against error at many settings.
//!
//! | Question                                                       | Module           |
//! |----------------------------------------------------------------|------------------|
//! | the attributes that are varied                                 | `setting.rs`     |
//! | the scene, its facts before a run, and the scene at a setting  | `benchmark.rs`   |
//! | which settings are run                                         | `plan.rs`        |
//! | one run, frame by frame, and its trajectory                    | [`run`]          |
//! | reference runs, predictability horizon, error measure          | `reference.rs`   |
//! | the curve: Pareto frontier, slope, recommended setting         | `curve.rs`       |
//! | parallel execution, progress and resumption                    | [`sweep`]        |

mod benchmark;
mod curve;
mod plan;
mod reference;
pub mod run;
mod setting;
pub mod sweep;

pub use benchmark::{Benchmark, TradeError, object_positions};
pub use curve::{Choice, Point, Trade, for_error, for_time};
pub use plan::SweepOptions;
pub use reference::{ErrorMeasure, References};
pub use setting::{Reading, Setting};
pub use sweep::{Progress, SweepControl, SweepResult, run_sweep};
