//! Bytes of an object's positions and velocities at a time sample: the message on `/<object>/points`, little-endian.

use mcap::records::MessageHeader;

use crate::messages::byte_shuffle::unshuffle;

pub(crate) const ENCODING: &str = "nucleus.points.v1";

/// Description of a points message for other readers; stored in the file.
pub(crate) const SCHEMA: &str = "\
Little-endian. i32 frame, u32 substep (counted from 1; 0 is the initial state), u32 substeps, u32 count,
u32 flags (bit 0: velocities follow), u32 mesh (how many other meshes the object had before), f64 time (seconds since
the start frame). Then positions in scene units as four planes of 3 * count bytes: plane k holds byte k of every f32 (0
is the lowest), in the order x0 y0 z0 x1 ... With bit 0 set, velocities (scene units per second) follow in the same way.
";

/// Flag: velocities follow.
const VELOCITIES: u32 = 1;
/// Bytes of the header that all per-point messages begin with.
pub(crate) const HEAD: usize = 32;

/// Frame, substep and time of a message.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Stamp {
    pub frame: i32,
    pub substep: u32,
    pub substeps: u32,
    pub time: f64,
}

impl Stamp {
    /// The initial state, at the start frame.
    pub fn start(frame: i32) -> Self {
        Self { frame, substep: 0, substeps: 1, time: 0.0 }
    }

    /// Reads the stamp and the number of points from the header of a message.
    pub fn read(head: &[u8]) -> Option<(Self, u32)> {
        let word = |k: usize| Some(u32::from_le_bytes(head.get(4 * k..4 * k + 4)?.try_into().ok()?));
        let time = f64::from_le_bytes(head.get(24..32)?.try_into().ok()?);
        let stamp = Self { frame: word(0)?.cast_signed(), substep: word(1)?, substeps: word(2)?, time };
        Some((stamp, word(3)?))
    }

    /// The time in nanoseconds, as in MCAP.
    pub fn log_time(&self) -> u64 {
        (self.time * 1e9).round() as u64
    }

    /// The MCAP header of a message with this stamp.
    pub fn header(&self, channel_id: u16, sequence: u32) -> MessageHeader {
        MessageHeader { channel_id, sequence, log_time: self.log_time(), publish_time: self.log_time() }
    }
}

/// Replaces `out` by the header of a points message for `count` points of an object's `mesh`; the caller appends
/// positions and velocities with [`shuffle`](crate::messages::byte_shuffle::shuffle).
pub(crate) fn write_head(stamp: &Stamp, count: usize, mesh: u32, velocities: bool, out: &mut Vec<u8>) {
    out.clear();
    out.reserve_exact(HEAD + 12 * count * (1 + usize::from(velocities)));
    out.extend_from_slice(&stamp.frame.to_le_bytes());
    for word in [stamp.substep, stamp.substeps, count as u32, u32::from(velocities) * VELOCITIES, mesh] {
        out.extend_from_slice(&word.to_le_bytes());
    }
    out.extend_from_slice(&stamp.time.to_le_bytes());
}

/// Copies the stamp of another message's header `head` into a message; `false` when either is too short.
pub(crate) fn set_stamp(message: &mut [u8], head: &[u8]) -> bool {
    if message.len() < HEAD || head.len() < HEAD {
        return false;
    }
    message[..12].copy_from_slice(&head[..12]);
    message[24..HEAD].copy_from_slice(&head[24..HEAD]);
    true
}

/// A points message; its values are still shuffled.
pub(crate) struct PointsMessage<'a> {
    pub stamp: Stamp,
    /// Number of the mesh that the points belong to: meshes that the object had before it.
    pub mesh: u32,
    positions: &'a [u8],
    velocities: Option<&'a [u8]>,
}

impl<'a> PointsMessage<'a> {
    /// Reads the header; `None` when it contradicts the length.
    pub fn read(data: &'a [u8]) -> Option<Self> {
        let (head, values) = data.split_at_checked(HEAD)?;
        let (stamp, count) = Stamp::read(head)?;
        let bytes = 12 * count as usize;
        let has_velocities = u32::from(head[16]) & VELOCITIES != 0;
        if values.len() != bytes * (1 + usize::from(has_velocities)) {
            return None;
        }
        let (positions, velocities) = values.split_at(bytes);
        let mesh = u32::from_le_bytes(head[20..24].try_into().ok()?);
        Some(Self { stamp, mesh, positions, velocities: has_velocities.then_some(velocities) })
    }

    pub fn count(&self) -> usize {
        self.positions.len() / 12
    }

    pub fn positions(&self, out: &mut Vec<[f32; 3]>) {
        rows(self.positions, out);
    }

    pub fn velocities(&self) -> Option<Vec<[f32; 3]>> {
        self.velocities.map(|planes| {
            let mut out = Vec::new();
            rows(planes, &mut out);
            out
        })
    }
}

/// Replaces `out` by rows of three floats from planes.
fn rows(planes: &[u8], out: &mut Vec<[f32; 3]>) {
    // `resize` without `clear`: `unshuffle` overwrites all rows.
    out.resize(planes.len() / 12, [0.0; 3]);
    unshuffle(planes, out.as_flattened_mut());
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::messages::byte_shuffle::shuffle;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn only_a_message_of_the_length_it_states_is_read(
            count in 0..9_u8, slack in prop_oneof![Just(12_usize), 0..20_usize], noise: u8,
        ) {
            let mut bytes = vec![noise; 12 * usize::from(count) + 20 + slack];
            bytes.resize(bytes.len().max(24), noise); // The header up to its flags exists.
            bytes[12..24].fill(0);
            bytes[12] = count;
            let points = PointsMessage::read(&bytes);
            prop_assert_eq!(points.is_some(), bytes.len() == HEAD + 12 * usize::from(count));
            let mut positions = Vec::new();
            let read = points.map(|points| points.positions(&mut positions));
            prop_assert!(read.is_none() || positions.len() == usize::from(count));
        }
    }

    #[test]
    fn a_points_message_is_laid_out_as_the_schema_says() {
        let stamp = Stamp { frame: -2, substep: 3, substeps: 4, time: 0.5 };
        let mut bytes = Vec::new();
        write_head(&stamp, 1, 6, false, &mut bytes);
        shuffle(&[1.0, 0.0, 0.0], &mut bytes);
        assert_eq!(bytes[..4], (-2_i32).to_le_bytes());
        assert_eq!(bytes[4..24], [3, 0, 0, 0, 4, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 6, 0, 0, 0]);
        assert_eq!(bytes[24..32], 0.5_f64.to_le_bytes());
        assert_eq!(bytes[32..], [0, 0, 0, 0, 0, 0, 0x80, 0, 0, 0x3f, 0, 0]);
    }
}
