//! Floating-point filter: polynomials in Bernstein form with certified error bounds.
//!
//! With s = 1 - t a polynomial of degree n is a sum of c_i s^(n-i) t^i. In this form products are plain convolutions,
//! and c_i / binomial(n, i) are the Bernstein coefficients: if all have one sign, so has the polynomial from t = 0 to 1
//! (Farouki 2012, §3).

use crate::coplanarity::Polynomial;

/// Twice the largest relative error of one operation; the second half bounds the rounding of the error bounds.
const ROUNDING: f64 = f64::EPSILON;

/// Bounds the rounding of propagated error bounds.
const SLACK: f64 = 1.0 + 1e-9;

/// Bounds the underflow of products.
const UNDERFLOW: f64 = f64::MIN_POSITIVE;

/// Coefficients c_i of a polynomial of degree up to 4, each with an absolute error of at most `error`.
#[derive(Debug, Clone, Copy)]
pub struct FilteredPolynomial {
    coefficients: [f64; 5],
    degree: usize,
    error: f64,
}

impl FilteredPolynomial {
    /// From `start` at t = 0 to `end` at t = 1, each rounded once.
    pub fn linear(start: f64, end: f64) -> Self {
        let error = ROUNDING * start.abs().max(end.abs());
        Self { coefficients: [start, end, 0.0, 0.0, 0.0], degree: 1, error }
    }

    fn size(&self) -> f64 {
        self.coefficients.iter().fold(0.0, |size: f64, c| size.max(c.abs()))
    }

    fn combine(&self, other: &Self, sum: impl Fn(f64, f64) -> f64) -> Self {
        debug_assert_eq!(self.degree, other.degree, "sums are of one degree");
        let coefficients = std::array::from_fn(|k| sum(self.coefficients[k], other.coefficients[k]));
        let error = SLACK * (self.error + other.error + ROUNDING * (self.size() + other.size()));
        Self { coefficients, degree: self.degree, error }
    }

    /// The Bernstein form on t from 0 to 1.
    pub fn bernstein(&self) -> Bernstein {
        const BINOMIALS: [[f64; 5]; 5] = [
            [1.0, 0.0, 0.0, 0.0, 0.0],
            [1.0, 1.0, 0.0, 0.0, 0.0],
            [1.0, 2.0, 1.0, 0.0, 0.0],
            [1.0, 3.0, 3.0, 1.0, 0.0],
            [1.0, 4.0, 6.0, 4.0, 1.0],
        ];
        let mut coefficients = self.coefficients;
        for k in 0..=self.degree {
            coefficients[k] /= BINOMIALS[self.degree][k];
        }
        Bernstein {
            coefficients,
            degree: self.degree,
            error: SLACK * (self.error + ROUNDING * self.size()) + UNDERFLOW,
        }
    }
}

impl Polynomial for FilteredPolynomial {
    fn plus(&self, other: &Self) -> Self {
        self.combine(other, |a, b| a + b)
    }

    fn minus(&self, other: &Self) -> Self {
        self.combine(other, |a, b| a - b)
    }

    fn times(&self, other: &Self) -> Self {
        let mut coefficients = [0.0; 5];
        for i in 0..=self.degree {
            for j in 0..=other.degree {
                coefficients[i + j] += self.coefficients[i] * other.coefficients[j];
            }
        }
        // No coefficient has more terms, and each term is rounded once and added once.
        let terms = (self.degree.min(other.degree) + 1) as f64;
        let (a, b) = (self.size(), other.size());
        let passed_on = a * other.error + b * self.error + self.error * other.error;
        let rounded = terms * ROUNDING * a * b;
        let error = SLACK * terms * (passed_on + rounded) + UNDERFLOW;
        Self { coefficients, degree: self.degree + other.degree, error }
    }
}

/// A polynomial on a time interval in Bernstein form; each coefficient has an absolute error of at most `error`.
#[derive(Debug, Clone, Copy)]
pub struct Bernstein {
    coefficients: [f64; 5],
    degree: usize,
    error: f64,
}

impl Bernstein {
    /// Certified positive on the whole interval.
    pub fn is_positive(&self) -> bool {
        self.coefficients[..=self.degree].iter().all(|&height| height > self.error)
    }

    /// Certified negative on the whole interval.
    pub fn is_negative(&self) -> bool {
        self.coefficients[..=self.degree].iter().all(|&height| height < -self.error)
    }

    /// Certified to have opposite signs at the ends of the interval.
    pub fn changes_sign(&self) -> bool {
        let (start, end) = (self.coefficients[0], self.coefficients[self.degree]);
        (start > self.error && end < -self.error) || (start < -self.error && end > self.error)
    }

    /// The first and the second half of the interval (de Casteljau).
    pub fn halves(&self) -> [Self; 2] {
        let mut row = self.coefficients;
        let mut first = [0.0; 5];
        let mut second = [0.0; 5];
        let n = self.degree;
        for k in 0..=n {
            first[k] = row[0];
            second[n - k] = row[n - k];
            for i in 0..n - k {
                row[i] = 0.5 * (row[i] + row[i + 1]);
            }
        }
        let size = self.coefficients.iter().fold(0.0, |size: f64, height| size.max(height.abs()));
        let error = SLACK * (self.error + n as f64 * ROUNDING * size);
        [first, second].map(|coefficients| Self { coefficients, degree: n, error })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// (1 - 2t)(1 + t), which is zero at one half.
    fn product() -> Bernstein {
        FilteredPolynomial::linear(1.0, -1.0).times(&FilteredPolynomial::linear(1.0, 2.0)).bernstein()
    }

    #[test]
    fn a_product_has_its_bernstein_coefficients() {
        // 1 - t - 2t²: coefficients 1, 1/2, -2.
        assert_eq!(product().coefficients[..3], [1.0, 0.5, -2.0]);
        assert!(product().changes_sign() && !product().is_positive() && !product().is_negative());
    }

    #[test]
    fn halves_meet_in_the_middle_and_keep_their_ends() {
        let [first, second] = product().halves();
        assert_eq!([first.coefficients[0], first.coefficients[2]], [1.0, 0.0]);
        assert_eq!([second.coefficients[0], second.coefficients[2]], [0.0, -2.0]);
        assert!(!first.is_positive(), "it ends at zero");
    }

    #[test]
    fn a_coefficient_below_its_error_bound_has_no_sign() {
        let tiny = FilteredPolynomial::linear(0.1 + 0.2, 0.1 + 0.2)
            .minus(&FilteredPolynomial::linear(0.3, 0.3))
            .bernstein();
        assert!(!tiny.is_positive() && !tiny.is_negative() && tiny.coefficients[0] != 0.0);
    }
}
