//! Whether anything came too near, or went through.

use nucleus_core::StepReport;
use serde::{Deserialize, Serialize};

/// What contact was like over the frames of a run.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Contact {
    /// The smallest gap over the thickness held there: 1 is touching, below is pressed in. Nothing where nothing came
    /// near.
    pub least_gap: Option<f64>,
    /// Points that ended a substep on the wrong side, over all frames. Has to be 0.
    pub pairs_unresolved: u64,
}

impl Contact {
    /// Takes up a frame.
    pub fn add(&mut self, report: &StepReport) {
        if report.min_gap < f64::INFINITY {
            self.least_gap = Some(self.least_gap.map_or(report.min_gap, |least| least.min(report.min_gap)));
        }
        self.pairs_unresolved += report.pairs_unresolved;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_smallest_gap_is_kept_and_crossings_add_up() {
        let mut contact = Contact::default();
        for (min_gap, pairs_unresolved) in [(f64::INFINITY, 0), (1.2, 1), (0.7, 0), (0.9, 2)] {
            contact.add(&StepReport { min_gap, pairs_unresolved, ..StepReport::default() });
        }
        assert_eq!(contact, Contact { least_gap: Some(0.7), pairs_unresolved: 3 });
    }

    #[test]
    fn where_nothing_comes_near_there_is_no_gap() {
        let mut contact = Contact::default();
        contact.add(&StepReport::default());
        assert_eq!(contact.least_gap, None);
    }
}
