//! Scalars and small vectors: `f32` or `f64`, and four of them side by side.
//!
//! Every operation is `+ - * /` or a square root, which IEEE 754 rounds in one way only. Four lanes therefore give the
//! same bits as four scalars, on any machine; there is no fused multiply-add and no libm here.

mod real;
#[cfg(target_arch = "x86_64")]
mod sse2;
mod vector;

use real::Quad;

pub use real::{Lanes, Real};
pub use vector::{Row4, add, clamp_length, cross, dot, max, scale, sub, unit};

impl Real for f32 {
    #[cfg(target_arch = "x86_64")]
    type Lanes = sse2::F32x4;
    #[cfg(not(target_arch = "x86_64"))]
    type Lanes = Quad<f32>;
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
}

impl Real for f64 {
    type Lanes = Quad<f64>;
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
}
