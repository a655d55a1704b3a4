//! Reports: the figures of a frame, and the passes that a scene compiles to.
//!
//! | You want to know… | Read |
//! |---|---|
//! | counters, strain, gaps and energy at the end of a frame | [`diagnostics`] |
//! | the passes that a frame consists of, and their cost | [`passes`] |

pub mod diagnostics;
pub mod memory;
pub mod passes;
