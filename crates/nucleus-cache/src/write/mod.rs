//! Writes caches: recorder, frames, replay check, resume, and MCAP files in public schemas.

pub(crate) mod frame_recorder;
pub(crate) mod recorder;
pub(crate) mod replay_check;
pub(crate) mod resume;
pub(crate) mod topic_file;
