//! The MCAP file: chunks, redundant copies, the index, and the writer.

pub(crate) mod chunk;
pub(crate) mod index;
pub(crate) mod part_file;
pub(crate) mod redundant_copies;
pub(crate) mod writer;
