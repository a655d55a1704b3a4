//! Exact continuous collision test of a pair, in integers. Every finite f64 is an integer times a power of two, and a
//! common power of two changes no sign.
//!
//! With x = t / (1 - t), times in (0, 1) become positive numbers, and the c_i of
//! [`FilteredPolynomial`](crate::float_filter::FilteredPolynomial) become the coefficients of x^i.

use std::cmp::Ordering;

use num_bigint::{BigInt, Sign};

use crate::coplanarity::{Coplanarity, Polynomial};
use crate::pair::{CcdResult, Corners, PairKind};
use crate::sturm::{IntegerPolynomial, Root};

/// Coefficients c_i, one more than the degree, including zeros.
type Coefficients = Vec<BigInt>;

impl Polynomial for Coefficients {
    fn plus(&self, other: &Self) -> Self {
        self.iter().zip(other).map(|(a, b)| a + b).collect()
    }

    fn minus(&self, other: &Self) -> Self {
        self.iter().zip(other).map(|(a, b)| a - b).collect()
    }

    fn times(&self, other: &Self) -> Self {
        let mut product = vec![BigInt::ZERO; self.len() + other.len() - 1];
        for (i, a) in self.iter().enumerate() {
            for (j, b) in other.iter().enumerate() {
                product[i + j] += a * b;
            }
        }
        product
    }
}

/// The result of a pair; all coordinates must be finite.
pub fn ccd(kind: PairKind, before: &Corners, after: &Corners) -> CcdResult {
    let pair = Coplanarity::new(kind, moving(kind, before, after));
    let volume = pair.volume();
    let conditions = Conditions { inside: pair.inside().to_vec(), area: pair.area() };
    if is_zero(&conditions.area) {
        return without_normal(kind, &pair);
    }
    if is_zero(&volume) {
        return conditions.in_plane();
    }
    conditions.at_roots(&volume)
}

/// The face has no area throughout, or the edges are parallel throughout.
fn without_normal(kind: PairKind, pair: &Coplanarity<Coefficients>) -> CcdResult {
    match kind {
        // A degenerate face has no sides; its edges are tested as edges.
        PairKind::PointFace => CcdResult::Separated,
        PairKind::EdgeEdge => {
            let offset = pair.offset_from_line();
            let ends = [0, offset.len() - 1].iter().any(|&end| offset[end].sign() == Sign::NoSign);
            let meets = ends || !polynomial(&offset).positive_roots().is_empty();
            if meets { CcdResult::Undecided } else { CcdResult::Separated }
        }
    }
}

/// Conditions for a pair to meet at a time of coplanarity.
struct Conditions {
    /// Must not be negative.
    inside: Vec<Coefficients>,
    /// Must be positive; otherwise the pair is degenerate.
    area: Coefficients,
}

/// Result of the conditions at one time of coplanarity.
#[derive(PartialEq, Eq, Clone, Copy)]
enum RootResult {
    Separated,
    Meets,
    Degenerate,
}

impl Conditions {
    fn judge(&self, sign: impl Fn(&Coefficients) -> Ordering) -> RootResult {
        if sign(&self.area) == Ordering::Equal {
            return RootResult::Degenerate;
        }
        let meets = self.inside.iter().all(|condition| sign(condition) != Ordering::Less);
        if meets { RootResult::Meets } else { RootResult::Separated }
    }

    /// At the start (`end` false) or the end of the motion.
    fn at_end_point(&self, end: bool) -> RootResult {
        self.judge(|form| sign(&form[if end { form.len() - 1 } else { 0 }]))
    }

    fn at_root(&self, polynomial: &IntegerPolynomial, root: &Root) -> RootResult {
        self.judge(|form| polynomial.sign_of(&IntegerPolynomial::new(form.clone()), root))
    }

    /// The four points are coplanar throughout. If the pair ever meets, it first does so at the start or where a
    /// condition is zero.
    fn in_plane(&self) -> CcdResult {
        let mut undecided = false;
        let mut times = vec![(self.at_end_point(false), 0.0), (self.at_end_point(true), 1.0)];
        for condition in self.inside.iter().map(polynomial) {
            for root in condition.positive_roots() {
                times.push((self.at_root(&condition, &root), time(root.approximation(&condition))));
            }
        }
        for (here, at) in times {
            match here {
                RootResult::Meets => return CcdResult::Touching { at },
                RootResult::Degenerate => undecided = true,
                RootResult::Separated => {}
            }
        }
        if undecided { CcdResult::Undecided } else { CcdResult::Separated }
    }

    fn at_roots(&self, volume: &Coefficients) -> CcdResult {
        let cubic = polynomial(volume);
        let (mut crossing, mut touching, mut undecided) = (None, None, false);
        for root in cubic.positive_roots() {
            let changes = cubic.changes_sign(&root);
            match self.at_root(&cubic, &root) {
                RootResult::Meets => {
                    let at = time(root.approximation(&cubic));
                    let found = if changes { &mut crossing } else { &mut touching };
                    *found = Some(found.map_or(at, |first: f64| first.min(at)));
                }
                RootResult::Degenerate => undecided = true,
                RootResult::Separated => {}
            }
        }
        for end in [false, true] {
            if sign(&volume[if end { 3 } else { 0 }]) == Ordering::Equal {
                match self.at_end_point(end) {
                    RootResult::Meets => touching = touching.or(Some(f64::from(u8::from(end)))),
                    RootResult::Degenerate => undecided = true,
                    RootResult::Separated => {}
                }
            }
        }
        match (crossing, undecided, touching) {
            (Some(at), _, _) => CcdResult::Crossing { at },
            (None, true, _) => CcdResult::Undecided,
            (None, false, Some(at)) => CcdResult::Touching { at },
            (None, false, None) => CcdResult::Separated,
        }
    }
}

/// The time t of a parameter x.
fn time(x: f64) -> f64 {
    if x.is_finite() { x / (1.0 + x) } else { 1.0 }
}

/// The vectors of [`Coplanarity`] in integers, each as its start and its end.
fn moving(kind: PairKind, before: &Corners, after: &Corners) -> [[Coefficients; 3]; 3] {
    let coordinates = before.iter().chain(after).flat_map(|corner| corner.iter().copied());
    let unit = coordinates.filter(|x| *x != 0.0).map(|x| parts(x).1).min().unwrap_or(0);
    let vector = |to: usize, from: usize| -> [Coefficients; 3] {
        std::array::from_fn(|axis| {
            let at =
                |corners: &Corners| integer(corners[to][axis], unit) - integer(corners[from][axis], unit);
            vec![at(before), at(after)]
        })
    };
    match kind {
        PairKind::PointFace => [vector(2, 1), vector(3, 1), vector(0, 1)],
        PairKind::EdgeEdge => [vector(1, 0), vector(3, 2), vector(2, 0)],
    }
}

/// A finite number as an integer times a power of two.
fn parts(x: f64) -> (i64, i32) {
    let bits = x.to_bits();
    let exponent = ((bits >> 52) & 0x7ff) as i32;
    let fraction = (bits & ((1 << 52) - 1)) as i64;
    let (count, power) =
        if exponent == 0 { (fraction, -1074) } else { (fraction | 1 << 52, exponent - 1075) };
    // Trailing zeros are removed, so that round numbers give small integers.
    let zeros = if count == 0 { 0 } else { count.trailing_zeros() };
    let count = count >> zeros;
    (if x < 0.0 { -count } else { count }, power + zeros as i32)
}

fn integer(x: f64, unit: i32) -> BigInt {
    let (count, power) = parts(x);
    if count == 0 { BigInt::ZERO } else { BigInt::from(count) << (power - unit) }
}

/// As a polynomial in x, for its positive roots.
fn polynomial(form: &Coefficients) -> IntegerPolynomial {
    IntegerPolynomial::new(form.clone()).without_zero_roots()
}

fn is_zero(form: &Coefficients) -> bool {
    form.iter().all(|c| c.sign() == Sign::NoSign)
}

fn sign(c: &BigInt) -> Ordering {
    c.cmp(&BigInt::ZERO)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn floats_convert_to_integers_exactly() {
        for x in [1.0, -0.1, 3.5e300, 5e-324, -2.2250738585072014e-308, 1e-310] {
            let (count, power) = parts(x);
            // Two steps, so that the power does not underflow.
            let half = power / 2;
            assert_eq!(count as f64 * 2_f64.powi(half) * 2_f64.powi(power - half), x);
        }
        assert_eq!(parts(0.0).0, 0);
        assert_eq!((integer(0.75, -3), integer(-4.0, -3)), (BigInt::from(6), BigInt::from(-32)));
    }
}
