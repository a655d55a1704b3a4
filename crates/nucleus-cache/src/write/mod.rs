//! Writes caches: recorder, mesh changes, replay check, resume, and MCAP files in public schemas.

pub(crate) mod mesh_change;
pub(crate) mod recorder;
pub(crate) mod replay_check;
pub(crate) mod resume;
pub(crate) mod topic_file;
