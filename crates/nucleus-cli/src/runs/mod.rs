//! Runs of a plan: as child processes of this one, as jobs of a cluster, and as the parts of a command.

mod farm;
mod local;
mod parts;

pub use farm::{FarmOptions, Place};
pub use local::execute;
pub use parts::{PartOptions, part_report};
