//! Speed against accuracy: a scene at many settings, each with its cost and its error.
//!
//! | You want to know...                                     | Read                 |
//! |---------------------------------------------------------|----------------------|
//! | what is looked at, and what it is held against          | [`Subject`]          |
//! | what a setting is                                       | [`Setting`]          |
//! | which settings are run                                  | [`plan`]             |
//! | one run                                                 | [`run`]              |
//! | how many go on side by side, and how they are resumed   | [`sweep`]            |
//! | what error means for a scene                            | [`Measure`]          |
//! | what is found: frontier, slope, time to an error        | [`Trade`]            |
//! | which setting to take                                   | [`recommend`]        |
//! | where that is kept for later runs                       | `curve.rs`           |

mod curve;
mod found;
mod measure;
pub mod plan;
pub mod recommend;
pub mod run;
mod setting;
mod subject;
pub mod sweep;

pub use found::{Point, Trade};
pub use measure::Measure;
pub use setting::{Reading, Setting};
pub use subject::{Subject, TradeError};
pub use sweep::{Found, Progress, Watch, measure};
