//! How wrong a run is, and what it costs.

#![forbid(unsafe_code)]

pub mod extremes;
