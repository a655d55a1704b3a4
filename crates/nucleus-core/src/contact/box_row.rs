//! Swept boxes in a structure of arrays, eight at a time: one box is tested against a whole row of others.
//!
//! With AVX all eight are tested at once, found at run time; elsewhere four and four. Both give the same bits.

#![allow(unsafe_code)]

use crate::contact::bvh::{Aabb, SweptBox};
use crate::math::{Lanes as _, Real};

type Lanes = <f32 as Real>::Lanes;

/// Swept boxes of some elements.
#[derive(Debug, Clone, Default)]
pub struct BoxRow {
    eights: Vec<Aabb8>,
    /// The number of boxes; the rest of the last eight is empty.
    len: usize,
}

/// Eight swept boxes: corners by end, axis and box.
#[derive(Debug, Clone, Copy)]
#[repr(C, align(32))]
struct Aabb8 {
    low: [[[f32; 8]; 3]; 2],
    high: [[[f32; 8]; 3]; 2],
}

/// Eights that are tested together: one bit for each box.
const EIGHTS_PER_TEST: usize = 8;

impl BoxRow {
    /// Replaces all by the boxes of some elements.
    pub fn fill<T>(&mut self, things: &[T], boxes: impl Fn(&T) -> SweptBox) {
        self.eights.clear();
        self.len = things.len();
        // Most rows are one or two long, where a vector would begin with a capacity of four.
        self.eights.reserve_exact(things.len().div_ceil(8));
        self.eights.extend(things.chunks(8).map(|things| {
            let mut eight = [[Aabb::EMPTY; 2]; 8];
            eight.iter_mut().zip(things).for_each(|(slot, thing)| *slot = boxes(thing));
            Aabb8::of(&eight)
        }));
    }

    /// Calls `found` with the index of each box that may overlap, as [`Aabb::may_overlap`] says.
    #[inline(always)]
    pub fn for_each_overlap(&self, ours: &SweptBox, mut found: impl FnMut(usize)) {
        for (chunk, eights) in self.eights.chunks(EIGHTS_PER_TEST).enumerate() {
            let mut met = overlap_mask(eights, ours);
            while met != 0 {
                let at = 8 * EIGHTS_PER_TEST * chunk + met.trailing_zeros() as usize;
                // An unbounded box overlaps even empty ones.
                if at < self.len {
                    found(at);
                }
                met &= met - 1;
            }
        }
    }
}

impl Aabb8 {
    /// Transposes eight boxes. With loops, because maps over arrays are not inlined.
    #[inline(always)]
    fn of(boxes: &[SweptBox; 8]) -> Self {
        let (mut low, mut high) = ([[[0.0; 8]; 3]; 2], [[[0.0; 8]; 3]; 2]);
        for half in [0, 4] {
            for end in 0..2 {
                for (side, all) in [&mut low, &mut high].into_iter().enumerate() {
                    let mut corners = [Lanes::splat(0.0); 4];
                    for (k, corner) in corners.iter_mut().enumerate() {
                        *corner = Lanes::from_array(boxes[half + k][end].corners()[side]);
                    }
                    let axes = Lanes::transpose(corners);
                    for axis in 0..3 {
                        all[end][axis][half..half + 4].copy_from_slice(&axes[axis].to_array());
                    }
                }
            }
        }
        Self { low, high }
    }
}

/// A bit for each box of up to eight eights that `ours` may overlap.
#[inline(always)]
fn overlap_mask(eights: &[Aabb8], ours: &SweptBox) -> u64 {
    #[cfg(target_arch = "x86_64")]
    if std::arch::is_x86_feature_detected!("avx") {
        // SAFETY: the processor has AVX.
        return unsafe { overlap_mask_avx(eights, ours) };
    }
    overlap_mask_in_fours(eights, ours)
}

fn overlap_mask_in_fours(eights: &[Aabb8], ours: &SweptBox) -> u64 {
    let [start, end] = ours.map(|at| at.corners());
    let four = |row: &[f32; 8], half: usize| {
        Lanes::from_array([row[half], row[half + 1], row[half + 2], row[half + 3]])
    };
    let mut mask = 0;
    for (at, eight) in eights.iter().enumerate() {
        for half in [0, 4] {
            let mut gap = Lanes::splat(f32::NEG_INFINITY);
            for axis in 0..3 {
                let above = |ours: [[f32; 4]; 2], end: usize| {
                    Lanes::splat(ours[0][axis]) - four(&eight.high[end][axis], half)
                };
                let below = |ours: [[f32; 4]; 2], end: usize| {
                    four(&eight.low[end][axis], half) - Lanes::splat(ours[1][axis])
                };
                gap = gap.most(above(start, 0).least(above(end, 1)));
                gap = gap.most(below(start, 0).least(below(end, 1)));
            }
            mask |= u64::from(!gap.above_zero() & 0b1111) << (8 * at + half);
        }
    }
    mask
}

/// The same with AVX.
#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx")]
fn overlap_mask_avx(eights: &[Aabb8], ours: &SweptBox) -> u64 {
    use std::arch::x86_64::{
        _CMP_GT_OQ, _mm256_cmp_ps, _mm256_loadu_ps, _mm256_max_ps, _mm256_min_ps, _mm256_movemask_ps,
        _mm256_set1_ps, _mm256_setzero_ps, _mm256_sub_ps,
    };
    let [start, end] = ours.map(|at| at.corners());
    let mut mask = 0;
    for (at, eight) in eights.iter().enumerate() {
        // SAFETY: every load is of a row of eight.
        let row = |row: &[f32; 8]| unsafe { _mm256_loadu_ps(row.as_ptr()) };
        let mut gap = _mm256_set1_ps(f32::NEG_INFINITY);
        for axis in 0..3 {
            let above = _mm256_min_ps(
                _mm256_sub_ps(_mm256_set1_ps(start[0][axis]), row(&eight.high[0][axis])),
                _mm256_sub_ps(_mm256_set1_ps(end[0][axis]), row(&eight.high[1][axis])),
            );
            let below = _mm256_min_ps(
                _mm256_sub_ps(row(&eight.low[0][axis]), _mm256_set1_ps(start[1][axis])),
                _mm256_sub_ps(row(&eight.low[1][axis]), _mm256_set1_ps(end[1][axis])),
            );
            gap = _mm256_max_ps(gap, _mm256_max_ps(above, below));
        }
        let apart = _mm256_movemask_ps(_mm256_cmp_ps::<_CMP_GT_OQ>(gap, _mm256_setzero_ps())) as u8;
        mask |= u64::from(!apart) << (8 * at);
    }
    mask
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector3;
    use proptest::prelude::*;

    use super::*;

    fn swept() -> impl Strategy<Value = SweptBox> {
        let corner = || proptest::array::uniform3(-2.0..2.0f64).prop_map(Vector3::from);
        let one = (corner(), corner()).prop_map(|(a, b)| Aabb::new(a.inf(&b), a.sup(&b)));
        proptest::array::uniform2(one)
    }

    #[test]
    fn an_unbounded_box_overlaps_every_box_of_a_row_and_nothing_beyond_its_end() {
        let one = Aabb::new(Vector3::zeros(), Vector3::repeat(1.0));
        let everywhere = Aabb::ball([0.0; 3], f32::INFINITY);
        let mut row = BoxRow::default();
        row.fill(&[[one; 2]; 11], |boxes| *boxes);
        let mut found = Vec::new();
        row.for_each_overlap(&[everywhere; 2], |at| found.push(at));
        assert_eq!(found, (0..11).collect::<Vec<_>>());
    }

    proptest! {
        #[test]
        fn a_row_of_boxes_overlaps_as_each_alone(ours in swept(), theirs in proptest::collection::vec(swept(), 0..80)) {
            let mut row = BoxRow::default();
            row.fill(&theirs, |boxes| *boxes);
            let mut found = Vec::new();
            row.for_each_overlap(&ours, |at| found.push(at));
            let alone = (0..theirs.len()).filter(|&at| Aabb::may_overlap(&ours, &theirs[at]));
            prop_assert_eq!(found, alone.collect::<Vec<_>>());
        }

        #[test]
        fn eight_lanes_give_the_same_bits_as_four(ours in swept(), theirs in proptest::collection::vec(swept(), 0..64)) {
            let mut row = BoxRow::default();
            row.fill(&theirs, |boxes| *boxes);
            prop_assert_eq!(overlap_mask(&row.eights, &ours), overlap_mask_in_fours(&row.eights, &ours));
        }
    }
}
