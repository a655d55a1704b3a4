//! Output of the solver: the state for an observer after each substep, and the report of a frame.
//!
//! | You want to know… | Read |
//! |---|---|
//! | what an observer reads, and when | [`observer`] |
//! | the counters and worst values of a frame | [`report`] |
//! | how they are computed | [`diagnostics`] |
//! | the passes that a scene compiles to | [`passes`] |

pub mod diagnostics;
pub mod observer;
pub mod passes;
pub mod report;
