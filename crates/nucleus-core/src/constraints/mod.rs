//! The effects that hold cloth together, one file each, named as the artist names them.
//! Each has its rows, and a `relax` that sweeps them once.

pub mod angle;
pub mod attract;
pub mod bend;
pub mod damp;
pub mod hinge;
pub mod plastic;
pub mod pressure;
pub mod shape;
pub mod strength_map;
pub mod stretch;
pub mod sweep;
pub mod whole;
