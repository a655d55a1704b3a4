//! Byte shuffling: all lowest bytes first, then all second ones, and so on.
//!
//! Neighbouring points share sign, exponent and the first bits of the mantissa. Laid side by side these
//! bytes compress; mixed with the noise of the last bits, as floats lie in memory, they do not.

/// Appends `floats` to `out` as four planes of a byte per float; plane 0 holds the lowest byte of every float.
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

/// Undoes [`shuffle`] into as many floats as there are room for; `planes` holds four bytes for each.
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

    proptest! {
        #[test]
        fn shuffling_loses_no_bit(bits in prop::collection::vec(any::<u32>(), 0..200)) {
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
