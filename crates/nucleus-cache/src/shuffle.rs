//! Byte shuffling: all lowest bytes first, then all second ones, and so on.
//!
//! Neighbouring points share sign, exponent and the first bits of the mantissa. Laid side by side these
//! bytes compress; mixed with the noise of the last bits, as floats lie in memory, they do not.

/// Appends `values` to `out` as four planes of `3 * values.len()` bytes; plane 0 holds the lowest byte of
/// every float, in the order x0 y0 z0 x1 ...
pub(crate) fn shuffle(values: &[[f32; 3]], out: &mut Vec<u8>) {
    let floats = values.as_flattened();
    let begin = out.len();
    out.resize(begin + 4 * floats.len(), 0);
    let (low, high) = out[begin..].split_at_mut(2 * floats.len());
    let (plane_0, plane_1) = low.split_at_mut(floats.len());
    let (plane_2, plane_3) = high.split_at_mut(floats.len());
    for (i, float) in floats.iter().enumerate() {
        [plane_0[i], plane_1[i], plane_2[i], plane_3[i]] = float.to_le_bytes();
    }
}

/// Undoes [`shuffle`]: `planes` holds `12 * n` bytes for `n` values; bytes past the last whole value are ignored.
pub(crate) fn unshuffle(planes: &[u8]) -> Vec<[f32; 3]> {
    let count = planes.len() / 12;
    let mut values = vec![[0.0; 3]; count];
    let floats = values.as_flattened_mut();
    let (low, high) = planes[..12 * count].split_at(6 * count);
    let (plane_0, plane_1) = low.split_at(3 * count);
    let (plane_2, plane_3) = high.split_at(3 * count);
    for (i, float) in floats.iter_mut().enumerate() {
        *float = f32::from_le_bytes([plane_0[i], plane_1[i], plane_2[i], plane_3[i]]);
    }
    values
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn planes_go_from_the_lowest_byte_to_the_highest() {
        let mut out = Vec::new();
        shuffle(&[[f32::from_bits(0x0403_0201), f32::from_bits(0x1413_1211), 0.0]], &mut out);
        assert_eq!(out, [0x01, 0x11, 0, 0x02, 0x12, 0, 0x03, 0x13, 0, 0x04, 0x14, 0]);
    }

    proptest! {
        #[test]
        fn shuffling_loses_no_bit(bits in prop::collection::vec(any::<[u32; 3]>(), 0..200)) {
            let values: Vec<[f32; 3]> = bits.iter().map(|row| row.map(f32::from_bits)).collect();
            let mut out = vec![7; 5];
            shuffle(&values, &mut out);
            let back: Vec<[u32; 3]> = unshuffle(&out[5..]).iter().map(|row| row.map(f32::to_bits)).collect();
            prop_assert_eq!(back, bits);
        }
    }
}
