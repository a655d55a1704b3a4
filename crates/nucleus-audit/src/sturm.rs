//! Polynomials with integer coefficients: root isolation, and the sign of one at a root of another (Sturm's theorem,
//! and Tarski's query; Basu, Pollack and Roy 2006, §2.2).

use std::cmp::Ordering;

use num_bigint::{BigInt, Sign};

/// Coefficients, the constant first; the last is not zero.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct IntegerPolynomial(Vec<BigInt>);

/// A non-negative dyadic number `count / 2^halvings`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Dyadic {
    pub count: BigInt,
    pub halvings: u64,
}

/// An isolated root: the only one between two numbers that are no roots.
#[derive(Debug, Clone)]
pub struct Root {
    pub above: Dyadic,
    pub below: Dyadic,
}

impl IntegerPolynomial {
    /// Removes leading coefficients that are zero.
    pub fn new(mut coefficients: Vec<BigInt>) -> Self {
        while coefficients.last().is_some_and(|last| last.sign() == Sign::NoSign) {
            coefficients.pop();
        }
        Self(coefficients)
    }

    /// Whether this is the zero polynomial.
    pub fn is_zero(&self) -> bool {
        self.0.is_empty()
    }

    fn times(&self, other: &Self) -> Self {
        let mut product = vec![BigInt::ZERO; self.0.len() + other.0.len()];
        for (i, a) in self.0.iter().enumerate() {
            for (j, b) in other.0.iter().enumerate() {
                product[i + j] += a * b;
            }
        }
        Self::new(product)
    }

    fn derivative(&self) -> Self {
        Self::new(self.0.iter().enumerate().skip(1).map(|(k, c)| c * BigInt::from(k)).collect())
    }

    /// Negated remainder of a division, times a positive number.
    fn negated_pseudo_remainder(&self, divisor: &Self) -> Self {
        let mut rest = self.0.clone();
        let (size, last) = (divisor.0.len(), divisor.0[divisor.0.len() - 1].clone());
        while rest.len() >= size {
            let lead = rest.pop().expect("it is longer than the divisor");
            let shift = rest.len() + 1 - size;
            // Multiplied by
            // last
            //  instead of `last`, so that the sign stays.
            let factor = if last.sign() == Sign::Minus { -lead } else { lead };
            let scale = BigInt::from(last.magnitude().clone());
            for (k, c) in rest.iter_mut().enumerate() {
                *c *= &scale;
                if k >= shift {
                    *c -= &factor * &divisor.0[k - shift];
                }
            }
        }
        rest.iter_mut().for_each(|c| *c = -&*c);
        Self::new(rest)
    }

    /// The sign at a number.
    pub fn sign_at(&self, x: &Dyadic) -> Ordering {
        let mut sum = BigInt::ZERO;
        for (steps, c) in self.0.iter().rev().enumerate() {
            sum = sum * &x.count + (c << (x.halvings * steps as u64));
        }
        ordering(sum.sign())
    }

    /// Divided by x as often as zero is a root; positive roots stay.
    pub fn without_zero_roots(self) -> Self {
        let zeros = self.0.iter().take_while(|c| c.sign() == Sign::NoSign).count();
        Self(self.0[zeros..].to_vec())
    }

    /// Isolates the positive roots of a polynomial without a root at zero.
    pub fn positive_roots(&self) -> Vec<Root> {
        if self.0.len() < 2 {
            return Vec::new();
        }
        let chain = sturm_chain(self, self.derivative());
        let zero = Dyadic { count: BigInt::ZERO, halvings: 0 };
        let mut open = vec![Root { above: zero, below: self.bound() }];
        let mut roots = Vec::new();
        while let Some(span) = open.pop() {
            match sign_variations(&chain, &span.above) - sign_variations(&chain, &span.below) {
                0 => {}
                1 => roots.push(span),
                _ => open.extend(span.split(self)),
            }
        }
        roots
    }

    /// A power of two above all roots (Cauchy).
    fn bound(&self) -> Dyadic {
        let bits = self.0.iter().map(BigInt::bits).max().unwrap_or_default();
        let last = self.0.last().map_or(0, BigInt::bits);
        Dyadic { count: BigInt::from(1) << (bits - last + 2), halvings: 0 }
    }

    /// The sign of `other` at a root of this polynomial.
    pub fn sign_of(&self, other: &Self, root: &Root) -> Ordering {
        let chain = sturm_chain(self, self.derivative().times(other));
        (sign_variations(&chain, &root.above) - sign_variations(&chain, &root.below)).cmp(&0)
    }

    /// Whether the sign changes at a root.
    pub fn changes_sign(&self, root: &Root) -> bool {
        self.sign_at(&root.above) != self.sign_at(&root.below)
    }
}

impl Root {
    /// Splits the interval at a number that is no root.
    fn split(self, polynomial: &IntegerPolynomial) -> [Self; 2] {
        let [above, below] = level([self.above, self.below]);
        let halvings = above.halvings + 3;
        let width = &below.count - &above.count;
        // More candidates than a quartic has roots.
        let places =
            [4, 3, 5, 2, 6, 1, 7].map(|eighths| (&above.count << 3) + &width * BigInt::from(eighths));
        let mut places = places.into_iter().map(|count| Dyadic { count, halvings });
        let middle = places
            .find(|place| polynomial.sign_at(place) != Ordering::Equal)
            .expect("it has fewer roots than there are places");
        [Self { above, below: middle.clone() }, Self { above: middle, below }]
    }

    /// The root to about seven digits, for display.
    pub fn approximation(&self, polynomial: &IntegerPolynomial) -> f64 {
        let chain = sturm_chain(polynomial, polynomial.derivative());
        let mut span = self.clone();
        for _ in 0..24 {
            let [low, high] = span.split(polynomial);
            let is_low = sign_variations(&chain, &low.above) > sign_variations(&chain, &low.below);
            span = if is_low { low } else { high };
        }
        span.above.to_f64()
    }
}

impl Dyadic {
    fn to_f64(&self) -> f64 {
        // An f64 holds no more than 64 bits of the count.
        let spare = self.count.bits().saturating_sub(64);
        let lead = u64::try_from(&self.count >> spare).unwrap_or(u64::MAX) as f64;
        lead * 2_f64.powi(spare.min(4000) as i32 - self.halvings.min(4000) as i32)
    }
}

/// Both with the same number of halvings.
fn level(pair: [Dyadic; 2]) -> [Dyadic; 2] {
    let halvings = pair[0].halvings.max(pair[1].halvings);
    pair.map(|number| Dyadic { count: number.count << (halvings - number.halvings), halvings })
}

fn sturm_chain(first: &IntegerPolynomial, second: IntegerPolynomial) -> Vec<IntegerPolynomial> {
    let mut chain = vec![first.clone(), second];
    while let [.., before, last] = chain.as_slice() {
        if last.is_zero() {
            break;
        }
        let next = before.negated_pseudo_remainder(last);
        chain.push(next);
    }
    chain
}

/// Number of sign changes along a Sturm sequence, ignoring zeros.
fn sign_variations(chain: &[IntegerPolynomial], x: &Dyadic) -> i32 {
    let signs = chain.iter().map(|link| link.sign_at(x)).filter(|sign| *sign != Ordering::Equal);
    let signs: Vec<Ordering> = signs.collect();
    signs.windows(2).filter(|pair| pair[0] != pair[1]).count() as i32
}

fn ordering(sign: Sign) -> Ordering {
    match sign {
        Sign::Minus => Ordering::Less,
        Sign::NoSign => Ordering::Equal,
        Sign::Plus => Ordering::Greater,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn polynomial(coefficients: &[i64]) -> IntegerPolynomial {
        IntegerPolynomial::new(coefficients.iter().map(|&c| BigInt::from(c)).collect())
    }

    #[test]
    fn roots_are_isolated_and_counted_once() {
        // (x - 1)² (x - 2) (2x - 3)
        let f = polynomial(&[-1, 1]);
        let f = f.times(&f).times(&polynomial(&[-2, 1])).times(&polynomial(&[-3, 2]));
        let roots = f.positive_roots();
        let mut found: Vec<f64> = roots.iter().map(|root| root.approximation(&f)).collect();
        assert_eq!(roots.len(), 3);
        found.sort_by(f64::total_cmp);
        assert_eq!(roots.iter().filter(|root| f.changes_sign(root)).count(), 2);
        assert!((found[2] - 2.0).abs() < 1e-6 && (found[1] - 1.5).abs() < 1e-6, "{found:?}");
    }

    #[test]
    fn roots_at_zero_and_below_are_left_out() {
        // x (x + 1) (x - 5)
        let f = polynomial(&[0, 1]).times(&polynomial(&[1, 1])).times(&polynomial(&[-5, 1]));
        let f = f.without_zero_roots();
        let roots = f.positive_roots();
        assert_eq!(roots.len(), 1);
        assert!((roots[0].approximation(&f) - 5.0).abs() < 1e-6);
    }

    #[test]
    fn signs_at_an_irrational_root_are_exact() {
        // At the root of two: x² - 2 is zero, x - 1.41421356 is above, x - 1.41421357 below.
        let f = polynomial(&[-2, 0, 1]);
        let [root] = &f.positive_roots()[..] else { panic!("it has one root above zero") };
        let sign = |g: &IntegerPolynomial| f.sign_of(g, root);
        assert_eq!(sign(&polynomial(&[-141_421_356, 100_000_000])), Ordering::Greater);
        assert_eq!(sign(&polynomial(&[-141_421_357, 100_000_000])), Ordering::Less);
        assert_eq!(sign(&polynomial(&[-2, 0, 1]).times(&polynomial(&[7, 3]))), Ordering::Equal);
    }
}
