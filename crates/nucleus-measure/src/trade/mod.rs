//! Work-precision curve of a scene: processor time against error at many settings.
//!
//! | Question                                                       | Module           |
//! |----------------------------------------------------------------|------------------|
//! | the attributes that are varied                                 | `setting.rs`     |
//! | the scene, and its facts before a run                          | `benchmark.rs`   |
//! | the scene at a setting, and the edits that set its text        | `scene_at.rs`    |
//! | which frames are compared                                      | `survey.rs`      |
//! | which settings are run                                         | `plan.rs`        |
//! | one run, frame by frame, and its trajectory                    | [`run`]          |
//! | reference runs, predictability horizon                         | `reference.rs`   |
//! | the error of a run by quantity, and its noise floors           | `error.rs`       |
//! | wanted errors, and the rule by which a setting meets one       | `request.rs`     |
//! | the curve: Pareto frontier, slope, recommended setting         | `curve.rs`       |
//! | parallel execution, progress and resumption                    | [`sweep`]        |

mod benchmark;
mod curve;
mod error;
mod plan;
mod reference;
mod request;
pub mod run;
mod scene_at;
mod setting;
mod survey;
pub mod sweep;
#[cfg(test)]
mod tests;

pub use benchmark::{Benchmark, TradeError, object_positions};
pub use curve::{Choice, Point, Trade, Wish, for_error, for_time};
pub use error::{Component, ErrorMeasure, Quantity};
pub use plan::SweepOptions;
pub use reference::{ReferenceRun, References};
pub use request::{Request, least_promised};
pub use setting::{Reading, Setting};
pub use survey::Survey;
pub use sweep::{Elsewhere, Progress, RemoteRun, RemoteStage, SweepControl, SweepResult, run_sweep};
