//! Byte shuffle: stores words of four bytes as four planes, plane k with byte k of every word.
//!
//! Neighbouring points share sign, exponent and the first bits of the mantissa. In planes these bytes compress;
//! interleaved with the noise of the low bits they do not.

use std::io::{self, Read, Write};

use zstd::stream::write::Encoder;

/// Bytes per word.
const PLANES: usize = 4;
/// Bytes that [`PlaneEncoder`] shuffles at once.
const BLOCK: usize = 1 << 20;
/// Compression level of [`PlaneEncoder`]. It does not depend on the level of the chunks, so that all recorders write
/// the same copies.
const LEVEL: i32 = 3;

/// Appends `floats` to `out` as four planes of one byte per float; plane 0 holds the lowest byte of every float.
pub(crate) fn shuffle(floats: &[f32], out: &mut Vec<u8>) {
    let begin = out.len();
    out.resize(begin + 4 * floats.len(), 0);
    let (low, high) = out[begin..].split_at_mut(2 * floats.len());
    let (plane_0, plane_1) = low.split_at_mut(floats.len());
    let (plane_2, plane_3) = high.split_at_mut(floats.len());
    let planes = plane_0.iter_mut().zip(plane_1).zip(plane_2.iter_mut().zip(plane_3));
    for (float, ((a, b), (c, d))) in floats.iter().zip(planes) {
        [*a, *b, *c, *d] = float.to_le_bytes();
    }
}

/// Inverse of [`shuffle`]; fills `floats` from four bytes each.
pub(crate) fn unshuffle(planes: &[u8], floats: &mut [f32]) {
    let count = floats.len();
    let (low, high) = planes[..4 * count].split_at(2 * count);
    let (plane_0, plane_1) = low.split_at(count);
    let (plane_2, plane_3) = high.split_at(count);
    let planes = plane_0.iter().zip(plane_1).zip(plane_2.iter().zip(plane_3));
    for (float, ((&a, &b), (&c, &d))) in floats.iter_mut().zip(planes) {
        *float = f32::from_le_bytes([a, b, c, d]);
    }
}

/// Writer that shuffles and compresses blocks of [`BLOCK`] bytes.
pub(crate) struct PlaneEncoder {
    block: Vec<u8>,
    packed: Encoder<'static, Vec<u8>>,
}

impl PlaneEncoder {
    pub fn new() -> io::Result<Self> {
        Ok(Self { block: Vec::new(), packed: Encoder::new(Vec::new(), LEVEL)? })
    }

    fn end_block(&mut self) -> io::Result<()> {
        let mut planes = Vec::with_capacity(self.block.len());
        for plane in 0..PLANES {
            planes.extend(self.block.iter().skip(plane).step_by(PLANES));
        }
        self.block.clear();
        self.packed.write_all(&planes)
    }

    pub fn finish(mut self) -> io::Result<Vec<u8>> {
        self.end_block()?;
        self.packed.finish()
    }
}

impl Write for PlaneEncoder {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let room = (BLOCK - self.block.len()).min(bytes.len());
        self.block.extend_from_slice(&bytes[..room]);
        if self.block.len() == BLOCK {
            self.end_block()?;
        }
        Ok(room)
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

/// Replaces `out` by the inverse of [`PlaneEncoder`], at most `most` bytes.
pub(crate) fn unpack(packed: &[u8], most: u64, out: &mut Vec<u8>) -> io::Result<()> {
    out.clear();
    zstd::Decoder::new(packed)?.take(most).read_to_end(out)?;
    let mut planes = Vec::new();
    for block in out.chunks_mut(BLOCK) {
        planes.clear();
        planes.extend_from_slice(block);
        let mut bytes = planes.iter();
        for plane in 0..PLANES {
            let places = block.iter_mut().skip(plane).step_by(PLANES);
            places.zip(bytes.by_ref()).for_each(|(place, &byte)| *place = byte);
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn planes_go_from_the_lowest_byte_to_the_highest() {
        let mut out = Vec::new();
        shuffle(&[f32::from_bits(0x0403_0201), f32::from_bits(0x1413_1211), 0.0], &mut out);
        assert_eq!(out, [0x01, 0x11, 0, 0x02, 0x12, 0, 0x03, 0x13, 0, 0x04, 0x14, 0]);
    }

    #[test]
    fn plane_encoding_is_lossless() {
        for length in [0, 1, 2, 3, 4, 7, BLOCK - 1, BLOCK, BLOCK + 1, 2 * BLOCK + 3] {
            let bytes: Vec<u8> = (0..length).map(|k| ((k * k) >> 5) as u8).collect();
            let mut planes = PlaneEncoder::new().unwrap();
            bytes.chunks(9973).for_each(|part| planes.write_all(part).unwrap());
            let mut back = vec![1; 5];
            unpack(&planes.finish().unwrap(), u64::MAX, &mut back).unwrap();
            assert!(back == bytes, "{length}");
        }
    }

    proptest! {
        #[test]
        fn byte_shuffle_is_lossless(bits in prop::collection::vec(any::<u32>(), 0..200)) {
            let values: Vec<f32> = bits.iter().copied().map(f32::from_bits).collect();
            let mut out = vec![7; 5];
            shuffle(&values, &mut out);
            let mut back = vec![0.0; values.len()];
            unshuffle(&out[5..], &mut back);
            let back: Vec<u32> = back.into_iter().map(f32::to_bits).collect();
            prop_assert_eq!(back, bits);
        }
    }
}
