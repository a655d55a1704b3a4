//! Points as rows of four numbers, and the vector algebra that contact needs.

use std::ops::{Add, Mul, Sub};

use crate::bytes::{Encode, Reader};
use crate::math::real::{Lanes, Real};

/// A point's x, y, z and one number more, laid out for one aligned load.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[repr(C, align(16))]
pub struct Row4<R>(pub [R; 4]);

impl<R: Real> Row4<R> {
    /// All zero.
    pub const ZERO: Self = Self([R::ZERO; 4]);

    /// x, y, z as the nearest scalars, and a fourth number.
    pub fn new(xyz: [f64; 3], fourth: R) -> Self {
        let [x, y, z] = xyz.map(R::from_f64);
        Self([x, y, z, fourth])
    }

    /// The four numbers as lanes.
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

impl<R: Real> Encode for Row4<R> {
    const SIZE: usize = 4 * R::SIZE;
    fn encode(&self, out: &mut Vec<u8>) {
        self.0.encode(out);
    }
    fn decode(from: &mut Reader<'_>) -> Option<Self> {
        Encode::decode(from).map(Self)
    }
}

/// The dot product of two triples of numbers or lanes, summed left to right.
#[inline(always)]
pub fn dot<T: Copy + Add<Output = T> + Mul<Output = T>>(a: [T; 3], b: [T; 3]) -> T {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// A value for each axis. Not an array's `map`, which is not inlined where the lanes are those of [`Kernel`]: each operation
/// would then be a call.
///
/// [`Kernel`]: super::kernel::Kernel
#[inline(always)]
pub fn by_axis<T>(of: impl Fn(usize) -> T) -> [T; 3] {
    [of(0), of(1), of(2)]
}

/// The sum of two triples.
#[inline(always)]
pub fn add<R: Real>(a: [R; 3], b: [R; 3]) -> [R; 3] {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

/// The difference of two triples of numbers or lanes.
#[inline(always)]
pub fn sub<T: Copy + Sub<Output = T>>(a: [T; 3], b: [T; 3]) -> [T; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

/// A triple times a number.
#[inline(always)]
pub fn scale<R: Real>(a: [R; 3], by: R) -> [R; 3] {
    [a[0] * by, a[1] * by, a[2] * by]
}

/// The cross product of two triples of numbers or lanes.
#[inline(always)]
pub fn cross<T: Copy + Mul<Output = T> + Sub<Output = T>>(a: [T; 3], b: [T; 3]) -> [T; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// The unit vector along a triple; `None` where its length is at most `least`.
#[inline(always)]
pub fn unit<R: Real>(a: [R; 3], least: R) -> Option<[R; 3]> {
    let length = dot(a, a).sqrt();
    (length > least).then(|| scale(a, R::ONE / length))
}

/// The triple, shortened to the length `most` where it is longer.
#[inline(always)]
pub fn clamp_length<R: Real>(a: [R; 3], most: R) -> [R; 3] {
    let length = dot(a, a).sqrt();
    if length > most { scale(a, most / length) } else { a }
}

/// The smaller of two numbers.
#[inline(always)]
pub fn min<R: Real>(x: R, y: R) -> R {
    if y < x { y } else { x }
}

/// The larger of two numbers.
#[inline(always)]
pub fn max<R: Real>(x: R, y: R) -> R {
    if y > x { y } else { x }
}
