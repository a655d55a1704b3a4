//! The solver against exact physics: cases with a closed form or a table, each with its error.
//!
//! | You want to know… | Read |
//! |---|---|
//! | how strips bend, buckle and stand | `bending.rs` |
//! | the exact elastica | `elastica.rs` |
//! | how sheets stretch and chains hang | `membrane.rs` |
//! | falls, swings and what is conserved | `motion.rs` |
//! | friction, bounce and ropes round a cylinder | `contact.rs` |
//! | how a disc of cloth drapes | `drape.rs` |

mod bending;
mod contact;
mod drape;
mod elastica;
mod membrane;
mod motion;
mod page;

use nucleus_core::BuildError;

pub use page::page;

/// What is left of an error in double precision is the method's.
type Fixture = crate::fixture::Fixture<f64>;

/// A body of physics that the solver is held against.
#[derive(Debug, Clone, Copy)]
pub struct Case {
    /// A word to ask for it by.
    pub name: &'static str,
    /// What is built, and where the exact figure comes from.
    pub description: &'static str,
    /// Why figures of it are outside what is allowed, where they are known to be.
    pub known_failure: Option<&'static str>,
    run: fn() -> Result<Vec<Comparison>, BuildError>,
}

/// One figure of a case beside the exact one.
#[derive(Debug, Clone, PartialEq)]
pub struct Comparison {
    /// What it is, with its unit.
    pub quantity: String,
    /// What it ought to be.
    pub exact: f64,
    /// What the solver gives.
    pub found: f64,
    /// How the two are held against each other.
    pub tolerance: Tolerance,
}

/// What counts as right.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Tolerance {
    /// The error over the exact figure is at most this.
    Relative(f64),
    /// The error is at most this, in the unit of the figure.
    Absolute(f64),
    /// The figure is at most the exact one.
    AtMost,
    /// The figure is at least the exact one.
    AtLeast,
}

impl Comparison {
    fn new(quantity: impl Into<String>, exact: f64, found: f64, tolerance: Tolerance) -> Self {
        Self { quantity: quantity.into(), exact, found, tolerance }
    }

    /// The error: over the exact figure where that is what counts, else in the unit of the figure; nothing for a
    /// bound.
    pub fn error(&self) -> Option<f64> {
        match self.tolerance {
            Tolerance::Relative(_) => Some((self.found - self.exact) / self.exact),
            Tolerance::Absolute(_) => Some(self.found - self.exact),
            Tolerance::AtMost | Tolerance::AtLeast => None,
        }
    }

    /// Whether it is right.
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
    /// Builds it, runs it and measures.
    ///
    /// # Errors
    /// When the solver refuses what is built.
    pub fn run(&self) -> Result<Vec<Comparison>, BuildError> {
        (self.run)()
    }
}

/// All cases, in the order of the page.
pub fn cases() -> impl Iterator<Item = Case> {
    [bending::CASES, membrane::CASES, motion::CASES, contact::CASES, drape::CASES]
        .into_iter()
        .flatten()
        .copied()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_finding_is_right_within_what_is_allowed_and_wrong_beyond() {
        let comparison = |found, tolerance| Comparison::new("", 2.0, found, tolerance).holds();
        assert!(comparison(2.019, Tolerance::Relative(0.01)) && !comparison(2.03, Tolerance::Relative(0.01)));
        assert!(comparison(1.9, Tolerance::Absolute(0.11)) && !comparison(1.9, Tolerance::Absolute(0.09)));
        assert!(comparison(1.0, Tolerance::AtMost) && !comparison(2.1, Tolerance::AtMost));
        assert!(!comparison(1.0, Tolerance::AtLeast) && comparison(2.1, Tolerance::AtLeast));
        assert!(!comparison(f64::NAN, Tolerance::Relative(1.0)) && !comparison(f64::NAN, Tolerance::AtMost));
    }

    #[test]
    fn falls_slopes_and_bounces_are_as_exact_as_the_page_allows() {
        for case in
            cases().filter(|case| ["terminal-velocity", "incline", "restitution"].contains(&case.name))
        {
            for comparison in case.run().expect("sheets of ours") {
                assert!(comparison.holds(), "{}: {comparison:?}", case.name);
            }
        }
    }

    #[test]
    fn no_two_cases_have_one_name() {
        let mut names: Vec<_> = cases().map(|case| case.name).collect();
        names.sort_unstable();
        names.dedup();
        assert_eq!(names.len(), cases().count());
    }
}
