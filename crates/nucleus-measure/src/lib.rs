//! How wrong a run is, and what it costs.
//!
//! | You want to know...                                        | Read                  |
//! |------------------------------------------------------------|-----------------------|
//! | what can be wrong with a run, and in which unit            | [`metrics`]           |
//! | how time is measured, in all and by stage                  | [`clock`]             |
//! | on which machine it was measured                          | [`machine`]           |
//! | what a run is held against, and until when                 | [`mod@reference`]         |
//! | which setting is how wrong, and what it costs              | [`trade`]             |
//! | how that is shown: a page, a table, JSON                   | [`report`]            |
//! | whether the advice of the paper holds                      | [`advice`]            |
//! | what holds where scenes leave the ordinary                 | [`extremes`]          |
//! | how far the solver is from exact physics                   | [`validation`]        |
//! | what a prototype promised, and what the solver does        | [`experiments`]       |
//! | where results are kept                                     | [`store`]             |
//!
//! **Invariant:** nothing here knows the terminal, and no result depends on how many runs go on side by side.

#![forbid(unsafe_code)]

pub mod advice;
pub mod clock;
pub mod experiments;
pub mod extremes;
pub mod fingerprint;
pub mod machine;
pub mod metrics;
pub mod reference;
pub mod report;
mod rig;
pub mod store;
pub mod trade;
pub mod trajectory;
pub mod validation;
