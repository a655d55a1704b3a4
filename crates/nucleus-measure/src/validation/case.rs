//! A case of validation: its figures, and their references.

use nucleus_core::BuildError;
use serde::{Deserialize, Serialize};

/// Double precision, so that the remaining error is that of the method.
pub(super) type Fixture = crate::fixture::Fixture<f64>;

/// A validation case.
#[derive(Debug, Clone, Copy)]
pub struct Case {
    /// Name, for `--only`.
    pub name: &'static str,
    /// The set-up, and the source of the reference solution.
    pub description: &'static str,
    /// Why figures are outside their tolerance, if they are known to be.
    pub known_failure: Option<&'static str>,
    pub(super) run: fn() -> Result<Vec<Comparison>, BuildError>,
}

/// A computed figure and its reference.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Comparison {
    /// The figure, with its unit.
    pub quantity: String,
    /// The reference, or the bound.
    #[serde(with = "crate::bits")]
    pub exact: f64,
    /// The figure of the solver.
    #[serde(with = "crate::bits")]
    pub found: f64,
    /// The tolerance.
    pub tolerance: Tolerance,
}

/// Tolerance of a figure.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum Tolerance {
    /// Maximum relative error.
    Relative(#[serde(with = "crate::bits")] f64),
    /// Maximum absolute error, in the unit of the figure.
    Absolute(#[serde(with = "crate::bits")] f64),
    /// The reference is an upper bound.
    AtMost,
    /// The reference is a lower bound.
    AtLeast,
}

impl Comparison {
    pub(super) fn new(quantity: impl Into<String>, exact: f64, found: f64, tolerance: Tolerance) -> Self {
        Self { quantity: quantity.into(), exact, found, tolerance }
    }

    /// The error: relative for [`Tolerance::Relative`], else in the unit of the figure; `None` for a bound.
    pub fn error(&self) -> Option<f64> {
        match self.tolerance {
            Tolerance::Relative(_) => Some((self.found - self.exact) / self.exact),
            Tolerance::Absolute(_) => Some(self.found - self.exact),
            Tolerance::AtMost | Tolerance::AtLeast => None,
        }
    }

    /// Whether the figure is within its tolerance.
    pub fn holds(&self) -> bool {
        match self.tolerance {
            Tolerance::Relative(most) | Tolerance::Absolute(most) => {
                self.error().is_some_and(|error| error.abs() <= most)
            }
            Tolerance::AtMost => self.found <= self.exact,
            Tolerance::AtLeast => self.found >= self.exact,
        }
    }
}

impl Case {
    /// Runs the case.
    ///
    /// # Errors
    /// When the solver rejects the mesh.
    pub fn run(&self) -> Result<Vec<Comparison>, BuildError> {
        (self.run)()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_comparison_holds_within_its_tolerance_only() {
        let comparison = |found, tolerance| Comparison::new("", 2.0, found, tolerance).holds();
        assert!(comparison(2.019, Tolerance::Relative(0.01)) && !comparison(2.03, Tolerance::Relative(0.01)));
        assert!(comparison(1.9, Tolerance::Absolute(0.11)) && !comparison(1.9, Tolerance::Absolute(0.09)));
        assert!(comparison(1.0, Tolerance::AtMost) && !comparison(2.1, Tolerance::AtMost));
        assert!(!comparison(1.0, Tolerance::AtLeast) && comparison(2.1, Tolerance::AtLeast));
        assert!(!comparison(f64::NAN, Tolerance::Relative(1.0)) && !comparison(f64::NAN, Tolerance::AtMost));
    }
}
