//! Scalars and small vectors: `f32` or `f64`, and four or eight of them side by side.
//!
//! Every operation is `+ - * /` or a square root, which IEEE 754 rounds in one way only. Lanes therefore give the
//! same bits as scalars, on any machine; there is no fused multiply-add and no libm here.

#[cfg(target_arch = "x86_64")]
mod avx2;
pub mod kernel;
mod real;
#[cfg(target_arch = "x86_64")]
mod register;
#[cfg(target_arch = "x86_64")]
mod sse2;
mod vector;

pub use real::{Lanes, Quad, Real, Two};
pub use vector::{Row4, add, by_axis, clamp_length, cross, dot, max, min, scale, sub, unit};

#[cfg(target_arch = "x86_64")]
use {avx2::F32x8, sse2::F32x4};
#[cfg(not(target_arch = "x86_64"))]
type F32x4 = Quad<f32>;
#[cfg(not(target_arch = "x86_64"))]
type F32x8 = Two<F32x4>;

impl Real for f32 {
    type Lanes = F32x4;
    type Wide = F32x8;
    const ZERO: Self = 0.0;
    const ONE: Self = 1.0;
    const MIN_DENOMINATOR: Self = 1e-20;
    const EPSILON: Self = f32::EPSILON;
    fn from_f64(x: f64) -> Self {
        x as f32
    }
    fn to_f64(self) -> f64 {
        f64::from(self)
    }
    fn sqrt(self) -> Self {
        self.sqrt()
    }
    fn to_bits(self) -> u64 {
        u64::from(self.to_bits())
    }
    #[cfg(target_arch = "x86_64")]
    fn has_wide_lanes() -> bool {
        std::arch::is_x86_feature_detected!("avx2")
    }
    #[cfg(not(target_arch = "x86_64"))]
    fn has_wide_lanes() -> bool {
        false
    }
}

impl Real for f64 {
    type Lanes = Quad<f64>;
    type Wide = Two<Quad<f64>>;
    const ZERO: Self = 0.0;
    const ONE: Self = 1.0;
    const MIN_DENOMINATOR: Self = 1e-300;
    const EPSILON: Self = f64::EPSILON;
    fn from_f64(x: f64) -> Self {
        x
    }
    fn to_f64(self) -> f64 {
        self
    }
    fn sqrt(self) -> Self {
        self.sqrt()
    }
    fn to_bits(self) -> u64 {
        self.to_bits()
    }
    fn has_wide_lanes() -> bool {
        false
    }
}
