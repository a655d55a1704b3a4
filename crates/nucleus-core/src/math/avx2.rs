//! Two times four `f32` in one register, for machines with AVX2: [`Real::has_wide_lanes`](super::Real::has_wide_lanes)
//! detects it at run time, and these lanes are used in functions that enable it. Without fused multiply-add their bits are
//! those of SSE2.

#![allow(unsafe_code)]

use super::real::Lanes;
use super::register::arithmetic;
use std::arch::x86_64::{
    __m256, _CMP_GT_OQ, _mm_loadu_ps, _mm_storeu_ps, _mm256_add_ps, _mm256_blendv_ps, _mm256_castpd_ps,
    _mm256_castps_pd, _mm256_castps128_ps256, _mm256_castps256_ps128, _mm256_cmp_ps, _mm256_div_ps,
    _mm256_extractf128_ps, _mm256_insertf128_ps, _mm256_max_ps, _mm256_min_ps, _mm256_movemask_ps,
    _mm256_mul_ps, _mm256_permute_ps, _mm256_set1_ps, _mm256_setzero_ps, _mm256_sqrt_ps, _mm256_sub_ps,
    _mm256_unpackhi_pd, _mm256_unpackhi_ps, _mm256_unpacklo_pd, _mm256_unpacklo_ps,
};

/// Two times four `f32`.
#[derive(Clone, Copy)]
#[repr(transparent)]
pub struct F32x8(__m256);

arithmetic! {
    F32x8:
    Add add _mm256_add_ps;
    Sub sub _mm256_sub_ps;
    Mul mul _mm256_mul_ps;
    Div div _mm256_div_ps;
}

// SAFETY of every block below: the machine has AVX2, and the loads and stores go through references to four f32.
impl Lanes<f32> for F32x8 {
    type Array = [[f32; 4]; 2];
    const GROUPS: usize = 2;
    #[inline(always)]
    fn of_groups(group: impl Fn(usize) -> [f32; 4]) -> Self {
        Self::from_array([group(0), group(1)])
    }
    #[inline(always)]
    fn for_groups(self, mut each: impl FnMut(usize, [f32; 4])) {
        let [low, high] = self.to_array();
        each(0, low);
        each(1, high);
    }
    #[inline(always)]
    fn splat(x: f32) -> Self {
        Self(unsafe { _mm256_set1_ps(x) })
    }
    #[inline(always)]
    fn from_array([low, high]: [[f32; 4]; 2]) -> Self {
        Self(unsafe {
            let low = _mm256_castps128_ps256(_mm_loadu_ps(low.as_ptr()));
            _mm256_insertf128_ps::<1>(low, _mm_loadu_ps(high.as_ptr()))
        })
    }
    #[inline(always)]
    fn to_array(self) -> [[f32; 4]; 2] {
        let mut out = [[0.0; 4]; 2];
        unsafe {
            _mm_storeu_ps(out[0].as_mut_ptr(), _mm256_castps256_ps128(self.0));
            _mm_storeu_ps(out[1].as_mut_ptr(), _mm256_extractf128_ps::<1>(self.0));
        }
        out
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        Self(unsafe { _mm256_sqrt_ps(self.0) })
    }
    #[inline(always)]
    fn choose_by_sign(self, above: Self, below: Self) -> Self {
        Self(unsafe {
            let mask = _mm256_cmp_ps::<_CMP_GT_OQ>(self.0, _mm256_setzero_ps());
            _mm256_blendv_ps(below.0, above.0, mask)
        })
    }
    #[inline(always)]
    fn least(self, other: Self) -> Self {
        Self(unsafe { _mm256_min_ps(self.0, other.0) })
    }
    #[inline(always)]
    fn most(self, other: Self) -> Self {
        Self(unsafe { _mm256_max_ps(self.0, other.0) })
    }
    #[inline(always)]
    fn above_zero(self) -> u32 {
        // Eight bits.
        unsafe { _mm256_movemask_ps(_mm256_cmp_ps::<_CMP_GT_OQ>(self.0, _mm256_setzero_ps())) as u32 }
    }
    #[inline(always)]
    fn transpose([a, b, c, d]: [Self; 4]) -> [Self; 4] {
        unsafe {
            let (ab_low, ab_high) = (_mm256_unpacklo_ps(a.0, b.0), _mm256_unpackhi_ps(a.0, b.0));
            let (cd_low, cd_high) = (_mm256_unpacklo_ps(c.0, d.0), _mm256_unpackhi_ps(c.0, d.0));
            let (ab_low, ab_high) = (_mm256_castps_pd(ab_low), _mm256_castps_pd(ab_high));
            let (cd_low, cd_high) = (_mm256_castps_pd(cd_low), _mm256_castps_pd(cd_high));
            [
                Self(_mm256_castpd_ps(_mm256_unpacklo_pd(ab_low, cd_low))),
                Self(_mm256_castpd_ps(_mm256_unpackhi_pd(ab_low, cd_low))),
                Self(_mm256_castpd_ps(_mm256_unpacklo_pd(ab_high, cd_high))),
                Self(_mm256_castpd_ps(_mm256_unpackhi_pd(ab_high, cd_high))),
            ]
        }
    }
    #[inline(always)]
    fn splat_last(self) -> Self {
        Self(unsafe { _mm256_permute_ps::<0xff>(self.0) })
    }
}

#[cfg(test)]
mod tests {
    use super::super::real::{Quad, Two};
    use super::*;
    use proptest::prelude::*;

    fn eight() -> impl Strategy<Value = [[f32; 4]; 2]> {
        let any = proptest::num::f32::NORMAL | proptest::num::f32::ZERO;
        proptest::array::uniform2(proptest::array::uniform4(any))
    }

    fn bits(all: [[f32; 4]; 2]) -> [[u32; 4]; 2] {
        all.map(|four| four.map(f32::to_bits))
    }

    fn wide(all: [[f32; 4]; 2]) -> (F32x8, Two<Quad<f32>>) {
        (F32x8::from_array(all), Two::from_array(all))
    }

    proptest! {
        #[test]
        fn avx2_lanes_give_the_same_bits_as_plain_rust(rows in proptest::array::uniform4(eight())) {
            if !std::arch::is_x86_feature_detected!("avx2") {
                return Ok(());
            }
            let ((ra, qa), (rb, qb)) = (wide(rows[0]), wide(rows[1]));
            let same = |r: F32x8, q: Two<Quad<f32>>| bits(r.to_array()) == bits(q.to_array());
            prop_assert!(same(ra, qa));
            prop_assert!(same(ra + rb, qa + qb));
            prop_assert!(same(ra - rb, qa - qb));
            prop_assert!(same(ra * rb, qa * qb));
            prop_assert!(same(ra / rb, qa / qb));
            let (r, q) = wide(rows[0].map(|four| four.map(f32::abs)));
            prop_assert!(same(r.sqrt(), q.sqrt()));
            prop_assert!(same(ra.choose_by_sign(rb, ra), qa.choose_by_sign(qb, qa)));
            prop_assert!(same(ra.splat_last(), qa.splat_last()));
            prop_assert!(same(ra.least(rb), qa.least(qb)));
            prop_assert!(same(ra.most(rb), qa.most(qb)));
            prop_assert_eq!(ra.above_zero(), qa.above_zero());
            let r = F32x8::transpose(rows.map(F32x8::from_array));
            let q = Two::transpose(rows.map(Two::<Quad<f32>>::from_array));
            prop_assert!(r.into_iter().zip(q).all(|(r, q)| same(r, q)));
        }
    }
}
