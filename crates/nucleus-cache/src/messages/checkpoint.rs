//! Bytes of a checkpoint: the message on `/checkpoint`, little-endian. A checkpoint has its own chunk behind that of
//! its frame, so that frames are read without it and damage to one does not affect the other.

pub(crate) const TOPIC: &str = "/checkpoint";
pub(crate) const ENCODING: &str = "nucleus.checkpoint.v1";

/// Description of a checkpoint message for other readers; stored in the file.
pub(crate) const SCHEMA: &str = "\
Little-endian. i32 frame, u32 flags (bit 0: made because the run ended here), u32 count, then a byte for each of count
objects, in the order of their channels (1: it has moved since it was last recorded). All that follows is the solver's
own: what it needs to go on from the end of the frame with the same bits.
";

/// Flag: the checkpoint was made because the run ended here.
const IS_LAST: u32 = 1;
const HEAD: usize = 12;

/// The solver's state at the end of a frame, from which a run resumes with the same bits.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Checkpoint {
    /// The frame.
    pub frame: i32,
    /// The solver's state in the solver's own format.
    pub bytes: Vec<u8>,
    /// Whether it was made only because the run ended here.
    pub(crate) is_last: bool,
    /// For each object, whether it has moved since it was last recorded.
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

/// Reads a checkpoint message; `None` when its length contradicts its header.
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

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn a_checkpoint_message_comes_back(
            frame: i32, is_last: bool, has_moved: Vec<bool>, bytes: Vec<u8>, noise: Vec<u8>,
        ) {
            let mut message = Vec::new();
            write(frame, is_last, has_moved.iter().copied(), &bytes, &mut message);
            prop_assert_eq!(read(&message), Some(Checkpoint { frame, bytes, is_last, has_moved }));
            read(&noise);
        }
    }
}
