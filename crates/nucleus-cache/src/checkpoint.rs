//! The bytes of a checkpoint: the message on `/checkpoint`. It has a chunk of its own behind that of its frame, so that
//! frames are read without it, and damage to the one costs nothing of the other. Everything is little-endian.

use std::io::{Read, Seek};

use crate::open_error::ReadError;
use crate::playback::Playback;

pub(crate) const TOPIC: &str = "/checkpoint";
pub(crate) const ENCODING: &str = "nucleus.checkpoint.v1";

/// What a stranger needs to know of a checkpoint message; stored in the file.
pub(crate) const SCHEMA: &str = "\
Little-endian. i32 frame, u32 flags (bit 0: made because the run ended here), u32 count, then a byte for each of count
objects, in the order of their channels (1: it has moved since it was last recorded). All that follows is the solver's
own: what it needs to go on from the end of the frame with the same bits.
";

/// The flag that says that the run ended here.
const IS_LAST: u32 = 1;
const HEAD: usize = 12;

/// What a run can be gone on with from the end of a frame.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Checkpoint {
    /// The frame.
    pub frame: i32,
    /// The solver's own bytes.
    pub bytes: Vec<u8>,
    /// It was made only because the run ended here.
    pub(crate) is_last: bool,
    /// Which objects have moved since they were last recorded.
    pub(crate) has_moved: Vec<bool>,
}

/// Replaces `out` by a checkpoint message.
pub(crate) fn write(
    frame: i32,
    is_last: bool,
    has_moved: impl ExactSizeIterator<Item = bool>,
    bytes: &[u8],
    out: &mut Vec<u8>,
) {
    out.clear();
    out.extend_from_slice(&frame.to_le_bytes());
    out.extend_from_slice(&(u32::from(is_last) * IS_LAST).to_le_bytes());
    out.extend_from_slice(&(has_moved.len() as u32).to_le_bytes());
    out.extend(has_moved.map(u8::from));
    out.extend_from_slice(bytes);
}

/// Reads a checkpoint message; nothing when it contradicts itself.
pub(crate) fn read(data: &[u8]) -> Option<Checkpoint> {
    let (head, rest) = data.split_at_checked(HEAD)?;
    let word = |k: usize| u32::from_le_bytes(head[4 * k..4 * k + 4].try_into().expect("four bytes"));
    let (has_moved, bytes) = rest.split_at_checked(word(2) as usize)?;
    Some(Checkpoint {
        frame: word(0).cast_signed(),
        bytes: bytes.to_vec(),
        is_last: word(1) & IS_LAST != 0,
        has_moved: has_moved.iter().map(|&byte| byte != 0).collect(),
    })
}

impl<R: Read + Seek> Playback<R> {
    /// The frames of all checkpoints, in order.
    pub fn checkpoints(&self) -> Vec<i32> {
        self.contents.checkpoints().map(|(time, _)| self.run().frame_at(time)).collect()
    }

    /// Bytes of all checkpoints in the file.
    pub fn checkpoint_bytes(&self) -> u64 {
        let bytes = |(_, chunk): (u64, usize)| &self.contents.chunks[chunk].bytes;
        self.contents.checkpoints().map(bytes).map(|bytes| bytes.end - bytes.start).sum()
    }

    /// What the run can be gone on with from the end of a frame; nothing where there is no checkpoint of it.
    ///
    /// # Errors
    /// When it is damaged, or the system fails to read.
    pub fn checkpoint(&mut self, frame: i32) -> Result<Option<Checkpoint>, ReadError> {
        let found = self.contents.checkpoints().find(|&(time, _)| self.run().frame_at(time) == frame);
        let Some((time, chunk)) = found else { return Ok(None) };
        self.load(chunk)?;
        let channel = self.contents.channel(TOPIC);
        let message = channel.and_then(|channel| self.chunk.message(channel, time));
        let read = message.and_then(read).filter(|checkpoint| checkpoint.frame == frame);
        read.map(Some).ok_or(ReadError::Damaged { frame })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn what_is_written_is_what_is_read(
            frame: i32, is_last: bool, has_moved: Vec<bool>, bytes: Vec<u8>, noise: Vec<u8>,
        ) {
            let mut message = Vec::new();
            write(frame, is_last, has_moved.iter().copied(), &bytes, &mut message);
            prop_assert_eq!(read(&message), Some(Checkpoint { frame, bytes, is_last, has_moved }));
            read(&noise);
        }
    }
}
