//! The table of extremes: what the solver does where scenes leave the ordinary.
//!
//! | You want to know…                                   | Read                |
//! |-----------------------------------------------------|---------------------|
//! | which extremes there are                            | [`rows()`], `rows/` |
//! | what a row is, and when it holds                    | [`Extreme`]         |
//! | how a scene is given                                | [`Case`]            |
//! | how it is run, and what is measured                 | [`Course`]          |
//! | how much energy a run may have                      | `energy.rs`         |
//! | how a row is judged                                 | [`Outcome`]         |
//! | how the page is written                             | [`page`]            |
//!
//! **Invariant:** every bound is stated in the row, before anything is run, and follows from the scene or from what
//! a user needs; none is a copy of what the solver happened to do.

mod case;
mod cost;
mod course;
mod energy;
mod meshes;
mod page;
mod row;
mod rows;
mod verdict;

pub use case::{Case, Compiled, Tamper};
pub use course::{Course, Seen};
pub use page::{miss, page};
pub use row::{Cost, Demand, Extreme, Recovery, Trial};
pub use rows::{named, rows};
pub use verdict::{Figure, Kind, Nominals, Outcome, Patience, Side, judge, judge_all};
