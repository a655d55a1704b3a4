//! Shared code of the tests over the whole pipeline. The tests themselves are in `tests/pipeline/`.
//!
//! | You want to know…                         | Read             |
//! |-------------------------------------------|------------------|
//! | where the scenes of the gallery come from | [`gallery`]      |
//! | how a run is audited in a test            | [`audited`]      |
//! | how a test runs and records a scene       | [`record`]       |
//!
//! **Invariant:** no other crate depends on this one.

#![forbid(unsafe_code)]

mod audit;
pub mod gallery;
mod recording;

pub use audit::{Audited, audited};
pub use recording::{Recording, record};
