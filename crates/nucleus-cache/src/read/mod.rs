//! Reads caches: playback, time index, reconstruction, recovery, comparison.

pub(crate) mod diff;
pub(crate) mod load;
pub(crate) mod mesh;
pub(crate) mod playback;
pub(crate) mod reconstruct;
pub(crate) mod recover;
pub(crate) mod time_index;
pub(crate) mod values;
