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
type Rig = crate::rig::Rig<f64>;

/// A body of physics that the solver is held against.
#[derive(Debug, Clone, Copy)]
pub struct Case {
    /// A word to ask for it by.
    pub name: &'static str,
    /// What is built, and where the exact figure comes from.
    pub about: &'static str,
    /// Why figures of it are outside what is allowed, where they are known to be.
    pub fails: Option<&'static str>,
    run: fn() -> Result<Vec<Finding>, BuildError>,
}

/// One figure of a case beside the exact one.
#[derive(Debug, Clone, PartialEq)]
pub struct Finding {
    /// What it is, with its unit.
    pub quantity: String,
    /// What it ought to be.
    pub exact: f64,
    /// What the solver gives.
    pub found: f64,
    /// How the two are held against each other.
    pub allowed: Allowed,
}

/// What counts as right.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Allowed {
    /// The error over the exact figure is at most this.
    Share(f64),
    /// The error is at most this, in the unit of the figure.
    Margin(f64),
    /// The figure is at most the exact one.
    AtMost,
    /// The figure is at least the exact one.
    AtLeast,
}

impl Finding {
    fn new(quantity: impl Into<String>, exact: f64, found: f64, allowed: Allowed) -> Self {
        Self { quantity: quantity.into(), exact, found, allowed }
    }

    /// The error: over the exact figure where that is what counts, else in the unit of the figure; nothing for a
    /// bound.
    pub fn error(&self) -> Option<f64> {
        match self.allowed {
            Allowed::Share(_) => Some((self.found - self.exact) / self.exact),
            Allowed::Margin(_) => Some(self.found - self.exact),
            Allowed::AtMost | Allowed::AtLeast => None,
        }
    }

    /// Whether it is right.
    pub fn holds(&self) -> bool {
        match self.allowed {
            Allowed::Share(most) | Allowed::Margin(most) => {
                self.error().is_some_and(|error| error.abs() <= most)
            }
            Allowed::AtMost => self.found <= self.exact,
            Allowed::AtLeast => self.found >= self.exact,
        }
    }
}

impl Case {
    /// Builds it, runs it and measures.
    ///
    /// # Errors
    /// When the solver refuses what is built.
    pub fn run(&self) -> Result<Vec<Finding>, BuildError> {
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
        let finding = |found, allowed| Finding::new("", 2.0, found, allowed).holds();
        assert!(finding(2.019, Allowed::Share(0.01)) && !finding(2.03, Allowed::Share(0.01)));
        assert!(finding(1.9, Allowed::Margin(0.11)) && !finding(1.9, Allowed::Margin(0.09)));
        assert!(finding(1.0, Allowed::AtMost) && !finding(2.1, Allowed::AtMost));
        assert!(!finding(1.0, Allowed::AtLeast) && finding(2.1, Allowed::AtLeast));
        assert!(!finding(f64::NAN, Allowed::Share(1.0)) && !finding(f64::NAN, Allowed::AtMost));
    }

    #[test]
    fn falls_slopes_and_bounces_are_as_exact_as_the_page_allows() {
        for case in
            cases().filter(|case| ["terminal-velocity", "incline", "restitution"].contains(&case.name))
        {
            for finding in case.run().expect("sheets of ours") {
                assert!(finding.holds(), "{}: {finding:?}", case.name);
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
