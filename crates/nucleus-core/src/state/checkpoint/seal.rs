//! What stands round a checkpoint: what it is, and a checksum that no damage passes by chance.

/// Why a run cannot go on from a checkpoint.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum RestoreError {
    /// It is not as it was written.
    #[error("the checkpoint is damaged")]
    Damaged,
    /// It is none, or of another version of Nucleus.
    #[error("the checkpoint was written by another version of nucleus")]
    OtherVersion,
    /// It is of other objects: points, faces, masses or the order of objects differ.
    #[error("the checkpoint is of other objects: a mesh or its mass has changed")]
    OtherModel,
    /// It was made with another precision.
    #[error("the checkpoint is of a run in f{found}, not in f{wanted}")]
    Scalar {
        /// Bits of a number in it.
        found: u32,
        /// Bits of a number here.
        wanted: u32,
    },
}

/// Bytes with what they are before them, and a checksum behind.
pub fn sealed(kind: [u8; 8], bytes: &[u8]) -> Vec<u8> {
    let mut whole = Vec::with_capacity(bytes.len() + 16);
    whole.extend_from_slice(&kind);
    whole.extend_from_slice(bytes);
    whole.extend_from_slice(&checksum(&whole).to_le_bytes());
    whole
}

/// The bytes inside.
///
/// # Errors
/// When they are of another kind, or not as they were written.
pub fn unsealed(kind: [u8; 8], whole: &[u8]) -> Result<&[u8], RestoreError> {
    let (rest, found) = whole.split_last_chunk::<8>().ok_or(RestoreError::Damaged)?;
    if checksum(rest) != u64::from_le_bytes(*found) {
        return Err(RestoreError::Damaged);
    }
    match rest.split_first_chunk::<8>() {
        Some((found, inner)) if *found == kind => Ok(inner),
        _ => Err(RestoreError::OtherVersion),
    }
}

/// FNV-1a over words, with the length.
fn checksum(bytes: &[u8]) -> u64 {
    let words = bytes.chunks(8).map(|chunk| {
        let mut word = [0; 8];
        word[..chunk.len()].copy_from_slice(chunk);
        u64::from_le_bytes(word)
    });
    words.chain([bytes.len() as u64]).fold(0xcbf2_9ce4_8422_2325, mixed)
}

/// A hash with a word more in it. Every step can be undone, so no two words of one hash give the same.
pub fn mixed(hash: u64, word: u64) -> u64 {
    (hash ^ word).wrapping_mul(0x0000_0100_0000_01b3).rotate_left(23)
}
