//! The bytes of messages and metadata records.

pub(crate) mod attribute;
pub(crate) mod byte_shuffle;
pub(crate) mod checkpoint;
pub(crate) mod metadata;
pub(crate) mod points;
pub(crate) mod topology;
