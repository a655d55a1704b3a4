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
    type Lanes: Lanes<Self, Array = [Self; 4]>;
    /// Two times four of them side by side.
    type Wide: Lanes<Self, Array = [[Self; 4]; 2]>;
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
    /// Whether this machine has registers for [`Real::Wide`].
    fn has_wide_lanes() -> bool;
}

/// Four scalars, or two times four; every operation gives each lane the bits that a scalar would have.
pub trait Lanes<R>:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self>
{
    /// The scalars in memory.
    type Array;
    /// How many groups of four scalars they are.
    const GROUPS: usize;
    /// The lanes of the groups of scalars that `group` gives for 0 to [`GROUPS`](Self::GROUPS) - 1.
    fn of_groups(group: impl Fn(usize) -> [R; 4]) -> Self;
    /// Calls `each` with every group of scalars and its number.
    fn for_groups(self, each: impl FnMut(usize, [R; 4]));
    /// The same scalar in all lanes.
    fn splat(x: R) -> Self;
    /// The lanes of these scalars.
    fn from_array(x: Self::Array) -> Self;
    /// The scalars of all lanes.
    fn to_array(self) -> Self::Array;
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
    /// The transposed 4 by 4 matrix, or two of them.
    fn transpose(rows: [Self; 4]) -> [Self; 4];
    /// The last lane of each four, four times.
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
    type Array = [R; 4];
    const GROUPS: usize = 1;
    #[inline(always)]
    fn of_groups(group: impl Fn(usize) -> [R; 4]) -> Self {
        Self(group(0))
    }
    #[inline(always)]
    fn for_groups(self, mut each: impl FnMut(usize, [R; 4])) {
        each(0, self.0);
    }
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

/// Two times four scalars in two registers, for machines and scalars without wider ones.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Two<L>(pub [L; 2]);

macro_rules! halfwise {
    ($($operator:ident $method:ident;)*) => {$(
        impl<L: Copy + $operator<Output = L>> $operator for Two<L> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                Self([self.0[0].$method(other.0[0]), self.0[1].$method(other.0[1])])
            }
        }
    )*};
}

halfwise! { Add add; Sub sub; Mul mul; Div div; }

impl<R: Real, L: Lanes<R, Array = [R; 4]>> Lanes<R> for Two<L> {
    type Array = [[R; 4]; 2];
    const GROUPS: usize = 2;
    #[inline(always)]
    fn of_groups(group: impl Fn(usize) -> [R; 4]) -> Self {
        Self::from_array([group(0), group(1)])
    }
    #[inline(always)]
    fn for_groups(self, mut each: impl FnMut(usize, [R; 4])) {
        let [low, high] = self.to_array();
        each(0, low);
        each(1, high);
    }
    #[inline(always)]
    fn splat(x: R) -> Self {
        Self([L::splat(x); 2])
    }
    #[inline(always)]
    fn from_array([low, high]: [[R; 4]; 2]) -> Self {
        Self([L::from_array(low), L::from_array(high)])
    }
    #[inline(always)]
    fn to_array(self) -> [[R; 4]; 2] {
        [self.0[0].to_array(), self.0[1].to_array()]
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        Self([self.0[0].sqrt(), self.0[1].sqrt()])
    }
    #[inline(always)]
    fn choose_by_sign(self, above: Self, below: Self) -> Self {
        let choose = |half: usize| self.0[half].choose_by_sign(above.0[half], below.0[half]);
        Self([choose(0), choose(1)])
    }
    #[inline(always)]
    fn least(self, other: Self) -> Self {
        Self([self.0[0].least(other.0[0]), self.0[1].least(other.0[1])])
    }
    #[inline(always)]
    fn most(self, other: Self) -> Self {
        Self([self.0[0].most(other.0[0]), self.0[1].most(other.0[1])])
    }
    #[inline(always)]
    fn above_zero(self) -> u32 {
        self.0[0].above_zero() | self.0[1].above_zero() << 4
    }
    #[inline(always)]
    fn transpose([a, b, c, d]: [Self; 4]) -> [Self; 4] {
        let half = |k: usize| L::transpose([a.0[k], b.0[k], c.0[k], d.0[k]]);
        let (low, high) = (half(0), half(1));
        let column = |k: usize| Self([low[k], high[k]]);
        [column(0), column(1), column(2), column(3)]
    }
    #[inline(always)]
    fn splat_last(self) -> Self {
        Self([self.0[0].splat_last(), self.0[1].splat_last()])
    }
}
