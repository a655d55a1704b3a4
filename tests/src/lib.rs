//! What the tests over the whole pipeline stand on; they themselves are in `tests/tests/`.
//!
//! | You want to know…                         | Read             |
//! |-------------------------------------------|------------------|
//! | where the scenes of the gallery come from | [`gallery`]      |
//! | how a test runs and records a scene       | [`record`]       |
//!
//! **Invariant:** nothing here is used by the program.

pub mod gallery;
mod recording;

pub use recording::{Recording, record};
