//! The scalar the solver works in, and four of them side by side.
//!
//! Everything is made of `+ - * /` and square roots, which IEEE 754 rounds in one way only, so four lanes
//! give the same bits as four scalars, on any machine. There is no fused multiply-add and no libm here.

mod lanes;
#[cfg(target_arch = "x86_64")]
mod sse2;
mod vector;

use std::iter::Sum;
use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

use crate::compiled::Compiled;
use crate::state::checkpoint::Item;

pub use lanes::{Lanes, Quad};
pub use vector::{add, clamp_length, cross, max, scale, sub, unit};

/// A scalar the solver can work in: `f32` to be fast, `f64` for references.
pub trait Real:
    Copy
    + Send
    + Sync
    + PartialOrd
    + PartialEq
    + Default
    + std::fmt::Debug
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + AddAssign
    + SubAssign
    + Sum
    + Item
    + Compiled
    + 'static
{
    /// Four of them.
    type Lanes: Lanes<Self>;
    /// Nought.
    const ZERO: Self;
    /// One.
    const ONE: Self;
    /// The smallest number that a denominator may be: keeps 0 / 0 from arising, changes nothing else.
    const MIN_DENOMINATOR: Self;
    /// The distance from one to the next max number.
    const EPSILON: Self;
    /// The nearest value.
    fn from_f64(x: f64) -> Self;
    /// Exact.
    fn to_f64(self) -> f64;
    /// Square root.
    fn sqrt(self) -> Self;
    /// Bits, for fingerprints.
    fn to_bits(self) -> u64;
}

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

/// A point's x, y, z and one number more, laid out for one aligned load.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[repr(C, align(16))]
pub struct Row4<R>(pub [R; 4]);

impl<R: Real> Row4<R> {
    /// All nought.
    pub const ZERO: Self = Self([R::ZERO; 4]);

    /// x, y, z as the nearest scalars, and a fourth number.
    pub fn new(xyz: [f64; 3], fourth: R) -> Self {
        let [x, y, z] = xyz.map(R::from_f64);
        Self([x, y, z, fourth])
    }

    /// The four as lanes.
    #[inline(always)]
    pub fn lanes(self) -> R::Lanes {
        R::Lanes::from_array(self.0)
    }

    /// x, y, z.
    #[inline(always)]
    pub fn xyz(self) -> [R; 3] {
        [self.0[0], self.0[1], self.0[2]]
    }
}

/// The dot product of two triples, summed left to right.
#[inline(always)]
pub fn dot<R: Real>(a: [R; 3], b: [R; 3]) -> R {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}
