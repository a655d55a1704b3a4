//! The passage of a pair decided in integers. The bits of the input are taken as they are: every finite f64 is an
//! integer times a power of two, and a common power of two changes no sign.
//!
//! With x = t / (1 - t) the time from 0 to 1 becomes a number above nought, and the c_i of
//! [`Estimate`](crate::estimate::Estimate) become the coefficients of x^i.

use std::cmp::Ordering;

use num_bigint::{BigInt, Sign};

use crate::coplanarity::{Coplanarity, Polynomial};
use crate::passage::{Corners, Kind, Passage};
use crate::sturm::{Integers, Root};

/// Coefficients c_i, as many as the degree says, noughts and all.
type Form = Vec<BigInt>;

impl Polynomial for Form {
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

/// What a pair does; all coordinates are finite.
pub fn passage(kind: Kind, before: &Corners, after: &Corners) -> Passage {
    let pair = Coplanarity::new(kind, moving(kind, before, after));
    let volume = pair.volume();
    let conditions = Conditions { inside: pair.inside().to_vec(), area: pair.area() };
    if is_nought(&conditions.area) {
        return without_normal(kind, &pair);
    }
    if is_nought(&volume) {
        return conditions.in_plane();
    }
    conditions.at_roots(&volume)
}

/// The face has no area throughout, or the edges are parallel throughout.
fn without_normal(kind: Kind, pair: &Coplanarity<Form>) -> Passage {
    match kind {
        // It has no sides. Its edges meet others as edges do.
        Kind::PointFace => Passage::Apart,
        Kind::EdgeEdge => {
            let offset = pair.offset_from_line();
            let ends = [0, offset.len() - 1].iter().any(|&end| offset[end].sign() == Sign::NoSign);
            let meets = ends || !polynomial(&offset).roots_above_nought().is_empty();
            if meets { Passage::Undecided } else { Passage::Apart }
        }
    }
}

/// What must hold where a pair meets.
struct Conditions {
    /// Not negative there.
    inside: Vec<Form>,
    /// Above nought there, or nothing can be said.
    area: Form,
}

/// What the conditions say at a time at which the four points lie in a plane.
#[derive(PartialEq, Eq, Clone, Copy)]
enum Here {
    Apart,
    Meets,
    Degenerate,
}

impl Conditions {
    fn judge(&self, sign: impl Fn(&Form) -> Ordering) -> Here {
        if sign(&self.area) == Ordering::Equal {
            return Here::Degenerate;
        }
        let meets = self.inside.iter().all(|condition| sign(condition) != Ordering::Less);
        if meets { Here::Meets } else { Here::Apart }
    }

    /// At the start (`end` false) or the end of the motion.
    fn at_an_end(&self, end: bool) -> Here {
        self.judge(|form| sign(&form[if end { form.len() - 1 } else { 0 }]))
    }

    fn at_root(&self, polynomial: &Integers, root: &Root) -> Here {
        self.judge(|form| polynomial.sign_of(&Integers::new(form.clone()), root))
    }

    /// The four points lie in a plane throughout. If the two ever meet, then first at the start or where
    /// a condition becomes nought.
    fn in_plane(&self) -> Passage {
        let mut undecided = false;
        let mut times = vec![(self.at_an_end(false), 0.0), (self.at_an_end(true), 1.0)];
        for condition in self.inside.iter().map(polynomial) {
            for root in condition.roots_above_nought() {
                times.push((self.at_root(&condition, &root), time(root.approximation(&condition))));
            }
        }
        for (here, at) in times {
            match here {
                Here::Meets => return Passage::Touches { at },
                Here::Degenerate => undecided = true,
                Here::Apart => {}
            }
        }
        if undecided { Passage::Undecided } else { Passage::Apart }
    }

    fn at_roots(&self, volume: &Form) -> Passage {
        let cubic = polynomial(volume);
        let (mut crossing, mut touching, mut undecided) = (None, None, false);
        for root in cubic.roots_above_nought() {
            let changes = cubic.changes_sign(&root);
            match self.at_root(&cubic, &root) {
                Here::Meets => {
                    let at = time(root.approximation(&cubic));
                    let found = if changes { &mut crossing } else { &mut touching };
                    *found = Some(found.map_or(at, |first: f64| first.min(at)));
                }
                Here::Degenerate => undecided = true,
                Here::Apart => {}
            }
        }
        for end in [false, true] {
            if sign(&volume[if end { 3 } else { 0 }]) == Ordering::Equal {
                match self.at_an_end(end) {
                    Here::Meets => touching = touching.or(Some(f64::from(u8::from(end)))),
                    Here::Degenerate => undecided = true,
                    Here::Apart => {}
                }
            }
        }
        match (crossing, undecided, touching) {
            (Some(at), _, _) => Passage::Crosses { at },
            (None, true, _) => Passage::Undecided,
            (None, false, Some(at)) => Passage::Touches { at },
            (None, false, None) => Passage::Apart,
        }
    }
}

/// From x back to t.
fn time(x: f64) -> f64 {
    if x.is_finite() { x / (1.0 + x) } else { 1.0 }
}

/// The vectors of [`Coplanarity`] in integers, each as its start and its end.
fn moving(kind: Kind, before: &Corners, after: &Corners) -> [[Form; 3]; 3] {
    let coordinates = before.iter().chain(after).flat_map(|corner| corner.iter().copied());
    let unit = coordinates.filter(|x| *x != 0.0).map(|x| parts(x).1).min().unwrap_or(0);
    let vector = |to: usize, from: usize| -> [Form; 3] {
        std::array::from_fn(|axis| {
            let at =
                |corners: &Corners| integer(corners[to][axis], unit) - integer(corners[from][axis], unit);
            vec![at(before), at(after)]
        })
    };
    match kind {
        Kind::PointFace => [vector(2, 1), vector(3, 1), vector(0, 1)],
        Kind::EdgeEdge => [vector(1, 0), vector(3, 2), vector(2, 0)],
    }
}

/// A finite number as an integer times a power of two.
fn parts(x: f64) -> (i64, i32) {
    let bits = x.to_bits();
    let exponent = ((bits >> 52) & 0x7ff) as i32;
    let fraction = (bits & ((1 << 52) - 1)) as i64;
    let (count, power) =
        if exponent == 0 { (fraction, -1074) } else { (fraction | 1 << 52, exponent - 1075) };
    // Without noughts at its end, so that round numbers make small integers.
    let noughts = if count == 0 { 0 } else { count.trailing_zeros() };
    let count = count >> noughts;
    (if x < 0.0 { -count } else { count }, power + noughts as i32)
}

fn integer(x: f64, unit: i32) -> BigInt {
    let (count, power) = parts(x);
    if count == 0 { BigInt::ZERO } else { BigInt::from(count) << (power - unit) }
}

/// In x, for its roots above nought.
fn polynomial(form: &Form) -> Integers {
    Integers::new(form.clone()).without_roots_at_nought()
}

fn is_nought(form: &Form) -> bool {
    form.iter().all(|c| c.sign() == Sign::NoSign)
}

fn sign(c: &BigInt) -> Ordering {
    c.cmp(&BigInt::ZERO)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_keep_their_value_as_integers() {
        for x in [1.0, -0.1, 3.5e300, 5e-324, -2.2250738585072014e-308, 1e-310] {
            let (count, power) = parts(x);
            // In two steps, so that the power itself does not underflow.
            let half = power / 2;
            assert_eq!(count as f64 * 2_f64.powi(half) * 2_f64.powi(power - half), x);
        }
        assert_eq!(parts(0.0).0, 0);
        assert_eq!((integer(0.75, -3), integer(-4.0, -3)), (BigInt::from(6), BigInt::from(-32)));
    }
}
