//! Error and cost of a run.
//!
//! | Question                                                        | Module              |
//! |-----------------------------------------------------------------|---------------------|
//! | error measures, each with its unit                              | [`metrics`]         |
//! | wall time, processor time, time by stage, the machine           | [`clock`]           |
//! | error and cost of a scene at many settings                      | [`trade`]           |
//! | reports of a trade: HTML page, table, CSV                       | [`report`]          |
//! | whether the paper's advice on settings holds                    | [`advice`]          |
//! | stress tests: scenes with extreme inputs, and bounds on them    | [`extremes`]        |
//! | the solver against closed-form and tabulated solutions          | [`validation`]      |
//! | design experiments: prototype against solver                    | [`experiments`]     |
//! | sheets, frame inputs and runs that those four share             | [`fixture`]         |
//! | results kept between commands                                   | [`result_cache`]    |
//! | numbers that pass between processes with all their bits         | [`bits`]            |
//!
//! **Invariant:** nothing here writes to the terminal, and no result depends on the number of runs that execute in
//! parallel.

#![forbid(unsafe_code)]

pub mod advice;
pub mod bits;
pub mod clock;
pub mod experiments;
pub mod extremes;
pub mod fixture;
pub mod metrics;
pub mod report;
pub mod result_cache;
pub mod trade;
pub mod validation;
