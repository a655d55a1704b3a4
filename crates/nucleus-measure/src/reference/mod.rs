//! What a run is held against: the same model in double precision, with many more and smaller steps.
//!
//! Two of them are made, of steps h and h/2. Where they come apart, nothing can be said of positions any more:
//! a fold has fallen to one side in one of them, and to the other in the other. See [`horizon`].

pub mod horizon;
mod solve;

pub use horizon::Horizon;
pub use solve::{References, Solved, find};
pub(crate) use solve::{find_end, keep_end};
