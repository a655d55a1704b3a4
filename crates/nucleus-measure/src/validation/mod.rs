//! Validation: the solver compared with closed-form and tabulated solutions.
//!
//! | Question | Read |
//! |---|---|
//! | a case, its figures and their tolerances | `case.rs` |
//! | bending and buckling of strips | `bending.rs` |
//! | the elastica, by shooting | `elastica.rs` |
//! | sag of sheets and chains | `membrane.rs` |
//! | falls, swings and conserved quantities | `motion.rs` |
//! | friction, restitution and the capstan equation | `contact.rs` |
//! | the drape coefficient of a disc | `drape.rs` |

mod bending;
mod case;
mod contact;
mod drape;
mod elastica;
mod membrane;
mod motion;
mod page;

pub use case::{Case, Comparison, Tolerance};
pub use page::page;

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
    fn falls_slopes_and_bounces_are_within_tolerance() {
        for case in
            cases().filter(|case| ["terminal-velocity", "incline", "restitution"].contains(&case.name))
        {
            for comparison in case.run().expect("valid meshes") {
                assert!(comparison.holds(), "{}: {comparison:?}", case.name);
            }
        }
    }

    #[test]
    fn cases_have_unique_names() {
        let mut names: Vec<_> = cases().map(|case| case.name).collect();
        names.sort_unstable();
        names.dedup();
        assert_eq!(names.len(), cases().count());
    }
}
