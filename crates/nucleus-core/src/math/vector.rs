//! Triples, and the max of two numbers: just what contact needs.

use super::{Real, dot};

/// The sum of two triples.
#[inline(always)]
pub fn add<R: Real>(a: [R; 3], b: [R; 3]) -> [R; 3] {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

/// The difference of two triples.
#[inline(always)]
pub fn sub<R: Real>(a: [R; 3], b: [R; 3]) -> [R; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

/// A triple times a number.
#[inline(always)]
pub fn scale<R: Real>(a: [R; 3], by: R) -> [R; 3] {
    [a[0] * by, a[1] * by, a[2] * by]
}

/// The cross product.
#[inline(always)]
pub fn cross<R: Real>(a: [R; 3], b: [R; 3]) -> [R; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// The direction of a triple; nothing if it is no longer than `least`.
#[inline(always)]
pub fn unit<R: Real>(a: [R; 3], least: R) -> Option<[R; 3]> {
    let length = dot(a, a).sqrt();
    (length > least).then(|| scale(a, R::ONE / length))
}

/// A triple, no longer than `most`.
#[inline(always)]
pub fn clamp_length<R: Real>(a: [R; 3], most: R) -> [R; 3] {
    let length = dot(a, a).sqrt();
    if length > most { scale(a, most / length) } else { a }
}

/// The max of two numbers.
#[inline(always)]
pub fn max<R: Real>(x: R, y: R) -> R {
    if y > x { y } else { x }
}
