//! What the solver reports about a frame and about its own work.
//!
//! | You want to know… | Read |
//! |---|---|
//! | counters, strain, gaps and energy at the end of a frame | [`diagnostics`] |
//! | the passes that a frame consists of, and their cost | [`passes`] |

pub mod diagnostics;
pub mod passes;
