//! Four `f32` in one register. SSE2 is part of every x86-64, so nothing is detected at run time. Written as intrinsics
//! because the compiler does not find these shuffles: the distance rows of a 129 x 129 sheet take 2.8 ns each with them
//! and 4.9 ns as plain Rust.

#![allow(unsafe_code)]

use super::real::Lanes;
use super::register::arithmetic;
use std::arch::x86_64::{
    __m128, _mm_add_ps, _mm_and_ps, _mm_andnot_ps, _mm_cmpgt_ps, _mm_div_ps, _mm_loadu_ps, _mm_max_ps,
    _mm_min_ps, _mm_movehl_ps, _mm_movelh_ps, _mm_movemask_ps, _mm_mul_ps, _mm_or_ps, _mm_set1_ps,
    _mm_setzero_ps, _mm_shuffle_ps, _mm_sqrt_ps, _mm_storeu_ps, _mm_sub_ps, _mm_unpackhi_ps, _mm_unpacklo_ps,
};

/// Four `f32`.
#[derive(Clone, Copy)]
#[repr(transparent)]
pub struct F32x4(__m128);

arithmetic! {
    F32x4:
    Add add _mm_add_ps;
    Sub sub _mm_sub_ps;
    Mul mul _mm_mul_ps;
    Div div _mm_div_ps;
}

// SAFETY of every block below: SSE is part of the x86-64 baseline, and the loads and stores go through
// references to four f32.
impl Lanes<f32> for F32x4 {
    type Array = [f32; 4];
    const GROUPS: usize = 1;
    #[inline(always)]
    fn of_groups(group: impl Fn(usize) -> [f32; 4]) -> Self {
        Self::from_array(group(0))
    }
    #[inline(always)]
    fn for_groups(self, mut each: impl FnMut(usize, [f32; 4])) {
        each(0, self.to_array());
    }
    #[inline(always)]
    fn splat(x: f32) -> Self {
        Self(unsafe { _mm_set1_ps(x) })
    }
    #[inline(always)]
    fn from_array(x: [f32; 4]) -> Self {
        Self(unsafe { _mm_loadu_ps(x.as_ptr()) })
    }
    #[inline(always)]
    fn to_array(self) -> [f32; 4] {
        let mut out = [0.0; 4];
        unsafe { _mm_storeu_ps(out.as_mut_ptr(), self.0) };
        out
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        Self(unsafe { _mm_sqrt_ps(self.0) })
    }
    #[inline(always)]
    fn choose_by_sign(self, above: Self, below: Self) -> Self {
        Self(unsafe {
            let mask = _mm_cmpgt_ps(self.0, _mm_setzero_ps());
            _mm_or_ps(_mm_and_ps(mask, above.0), _mm_andnot_ps(mask, below.0))
        })
    }
    #[inline(always)]
    fn least(self, other: Self) -> Self {
        Self(unsafe { _mm_min_ps(self.0, other.0) })
    }
    #[inline(always)]
    fn most(self, other: Self) -> Self {
        Self(unsafe { _mm_max_ps(self.0, other.0) })
    }
    #[inline(always)]
    fn above_zero(self) -> u32 {
        // Four bits.
        unsafe { _mm_movemask_ps(_mm_cmpgt_ps(self.0, _mm_setzero_ps())) as u32 }
    }
    #[inline(always)]
    fn transpose([a, b, c, d]: [Self; 4]) -> [Self; 4] {
        unsafe {
            let (ab_low, ab_high) = (_mm_unpacklo_ps(a.0, b.0), _mm_unpackhi_ps(a.0, b.0));
            let (cd_low, cd_high) = (_mm_unpacklo_ps(c.0, d.0), _mm_unpackhi_ps(c.0, d.0));
            [
                Self(_mm_movelh_ps(ab_low, cd_low)),
                Self(_mm_movehl_ps(cd_low, ab_low)),
                Self(_mm_movelh_ps(ab_high, cd_high)),
                Self(_mm_movehl_ps(cd_high, ab_high)),
            ]
        }
    }
    #[inline(always)]
    fn splat_last(self) -> Self {
        Self(unsafe { _mm_shuffle_ps::<0xff>(self.0, self.0) })
    }
}

#[cfg(test)]
mod tests {
    use super::super::real::Quad;
    use super::*;
    use proptest::prelude::*;

    fn four() -> impl Strategy<Value = [f32; 4]> {
        proptest::array::uniform4(proptest::num::f32::NORMAL | proptest::num::f32::ZERO)
    }

    proptest! {
        #[test]
        fn sse2_lanes_give_the_same_bits_as_plain_rust(a in four(), b in four(), c in four(), d in four()) {
            let (ra, rb) = (F32x4::from_array(a), F32x4::from_array(b));
            let (qa, qb) = (Quad(a), Quad(b));
            let same = |r: F32x4, q: Quad<f32>| r.to_array().map(f32::to_bits) == q.0.map(f32::to_bits);
            prop_assert!(same(ra + rb, qa + qb));
            prop_assert!(same(ra - rb, qa - qb));
            prop_assert!(same(ra * rb, qa * qb));
            prop_assert!(same(ra / rb, qa / qb));
            let positive = a.map(f32::abs);
            prop_assert!(same(F32x4::from_array(positive).sqrt(), Quad(positive).sqrt()));
            prop_assert!(same(ra.choose_by_sign(rb, ra), qa.choose_by_sign(qb, qa)));
            prop_assert!(same(ra.splat_last(), qa.splat_last()));
            prop_assert!(same(ra.least(rb), qa.least(qb)));
            prop_assert!(same(ra.most(rb), qa.most(qb)));
            prop_assert_eq!(ra.above_zero(), qa.above_zero());
            let rows = [a, b, c, d];
            let r = F32x4::transpose(rows.map(F32x4::from_array));
            let q = Quad::transpose(rows.map(Quad));
            prop_assert!(r.iter().zip(q).all(|(&r, q)| same(r, q)));
        }
    }
}
