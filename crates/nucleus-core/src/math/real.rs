//! The scalar that the solver computes with, and four of them side by side (SIMD lanes).

use std::iter::Sum;
use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

use crate::bytes::Encode;

/// A scalar that the solver computes with: `f32` for speed, `f64` for reference solutions.
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
    + Encode
    + 'static
{
    /// Four of them side by side.
    type Lanes: Lanes<Self>;
    /// Zero.
    const ZERO: Self;
    /// One.
    const ONE: Self;
    /// Added to denominators so that 0 / 0 is 0; too small to change any other quotient.
    const MIN_DENOMINATOR: Self;
    /// The distance from one to the next larger number.
    const EPSILON: Self;
    /// The nearest value.
    fn from_f64(x: f64) -> Self;
    /// The same value, exactly.
    fn to_f64(self) -> f64;
    /// Square root.
    fn sqrt(self) -> Self;
    /// The bits, for hashes.
    fn to_bits(self) -> u64;
}

/// Four scalars; every operation gives each lane the bits that a scalar would have.
pub trait Lanes<R>:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self>
{
    /// The same scalar four times.
    fn splat(x: R) -> Self;
    /// Four scalars.
    fn from_array(x: [R; 4]) -> Self;
    /// Four scalars.
    fn to_array(self) -> [R; 4];
    /// The square root of each.
    fn sqrt(self) -> Self;
    /// Lane by lane: `above` where `self` is above zero, else `below`.
    fn choose_by_sign(self, above: Self, below: Self) -> Self;
    /// The smaller of each two.
    fn least(self, other: Self) -> Self;
    /// The larger of each two.
    fn most(self, other: Self) -> Self;
    /// One bit per lane, set where the lane is above zero.
    fn above_zero(self) -> u32;
    /// The transposed 4 by 4 matrix.
    fn transpose(rows: [Self; 4]) -> [Self; 4];
    /// The last lane, four times.
    fn splat_last(self) -> Self;
}

/// Four scalars in plain Rust, for machines and scalars without SIMD lanes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Quad<R>(pub [R; 4]);

impl<R: Real> Quad<R> {
    #[inline(always)]
    fn zip(self, other: Self, f: impl Fn(R, R) -> R) -> Self {
        let (a, b) = (self.0, other.0);
        Self([f(a[0], b[0]), f(a[1], b[1]), f(a[2], b[2]), f(a[3], b[3])])
    }
}

impl<R: Real> Add for Quad<R> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        self.zip(other, |a, b| a + b)
    }
}

impl<R: Real> Sub for Quad<R> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        self.zip(other, |a, b| a - b)
    }
}

impl<R: Real> Mul for Quad<R> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        self.zip(other, |a, b| a * b)
    }
}

impl<R: Real> Div for Quad<R> {
    type Output = Self;
    #[inline(always)]
    fn div(self, other: Self) -> Self {
        self.zip(other, |a, b| a / b)
    }
}

impl<R: Real> Lanes<R> for Quad<R> {
    #[inline(always)]
    fn splat(x: R) -> Self {
        Self([x; 4])
    }
    #[inline(always)]
    fn from_array(x: [R; 4]) -> Self {
        Self(x)
    }
    #[inline(always)]
    fn to_array(self) -> [R; 4] {
        self.0
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        Self(self.0.map(R::sqrt))
    }
    #[inline(always)]
    fn choose_by_sign(self, above: Self, below: Self) -> Self {
        let pick = |k: usize| if self.0[k] > R::ZERO { above.0[k] } else { below.0[k] };
        Self([pick(0), pick(1), pick(2), pick(3)])
    }
    #[inline(always)]
    fn least(self, other: Self) -> Self {
        self.zip(other, |a, b| if a < b { a } else { b })
    }
    #[inline(always)]
    fn most(self, other: Self) -> Self {
        self.zip(other, |a, b| if a > b { a } else { b })
    }
    #[inline(always)]
    fn above_zero(self) -> u32 {
        (0..4).map(|k| u32::from(self.0[k] > R::ZERO) << k).sum()
    }
    #[inline(always)]
    fn transpose(rows: [Self; 4]) -> [Self; 4] {
        let column = |k: usize| Self([rows[0].0[k], rows[1].0[k], rows[2].0[k], rows[3].0[k]]);
        [column(0), column(1), column(2), column(3)]
    }
    #[inline(always)]
    fn splat_last(self) -> Self {
        Self([self.0[3]; 4])
    }
}
