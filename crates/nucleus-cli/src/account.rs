//! What a run has come to so far: its worst figures, and when.

use std::time::Duration;

use nucleus_core::{InvalidInput, StepReport};
use nucleus_graph::FrameReport;
use serde::{Deserialize, Serialize};

/// The figures of one frame, as they are recorded and printed for machines.
#[derive(Debug, Clone, Copy, Serialize, Deserialize)]
pub struct FrameFigures {
    /// The frame.
    pub frame: i32,
    /// See [`StepReport`] for this and all that follow.
    pub max_strain: f64,
    pub strain_99: f64,
    /// Nothing where nothing is near: JSON has no infinity.
    pub min_gap: Option<f64>,
    /// The same among cloths.
    pub min_cloth_gap: Option<f64>,
    pub contacts: u64,
    pub pairs: u64,
    pub broad_phases: u32,
    #[serde(alias = "caught")]
    pub pairs_reverted: u64,
    #[serde(alias = "crossed")]
    pub pairs_unresolved: u64,
    /// Points inside colliders, which are being led out.
    pub trapped: u64,
    /// Edges of cloth through faces of cloth, which are being worked apart.
    pub tangled: u64,
    pub kinetic_energy: f64,
    pub finite: bool,
    /// How much of what the frame brought could not be used.
    pub refused: u64,
    /// The first of that.
    #[serde(skip)]
    pub first_refused: Option<InvalidInput>,
}

impl FrameFigures {
    /// What was reported of the frame, as far as it is kept.
    pub fn report(&self) -> FrameReport {
        let report = StepReport {
            max_strain: self.max_strain,
            strain_99: self.strain_99,
            min_gap: self.min_gap.unwrap_or(f64::INFINITY),
            contacts: self.contacts,
            candidate_pairs: self.pairs,
            broad_phases: self.broad_phases,
            pairs_reverted: self.pairs_reverted,
            pairs_unresolved: self.pairs_unresolved,
            depenetrating: self.trapped,
            intersections: self.tangled,
            kinetic_energy: self.kinetic_energy,
            finite: self.finite,
            ..StepReport::default()
        };
        FrameReport { frame: self.frame.into(), report, passed_through: None }
    }
}

impl FrameFigures {
    /// The figures of a frame from its report.
    pub fn new(frame: i32, report: &StepReport) -> Self {
        let StepReport {
            max_strain,
            strain_99,
            min_gap,
            min_cloth_gap,
            contacts,
            candidate_pairs: pairs,
            broad_phases,
            ..
        } = *report;
        let StepReport {
            pairs_reverted,
            pairs_unresolved,
            depenetrating: trapped,
            intersections: tangled,
            kinetic_energy,
            finite,
            sanitized: refused,
            ..
        } = *report;
        let [min_gap, min_cloth_gap] = [min_gap, min_cloth_gap].map(|gap| gap.is_finite().then_some(gap));
        Self {
            frame,
            max_strain,
            strain_99,
            min_gap,
            min_cloth_gap,
            contacts,
            pairs,
            broad_phases,
            pairs_reverted,
            pairs_unresolved,
            trapped,
            tangled,
            kinetic_energy,
            finite,
            refused: refused.count,
            first_refused: refused.first,
        }
    }
}

/// The worst figures of a run.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Account {
    /// Frames that were simulated.
    pub frames: u32,
    /// Time spent on them, recording included.
    pub spent: Duration,
    /// Time spent on the last of them.
    pub last: Duration,
    /// The largest strain, and its frame.
    pub worst_strain: Option<(f64, i32)>,
    /// The smallest gap over thickness, and its frame; nothing if nothing ever came near.
    pub smallest_gap: Option<(f64, i32)>,
    /// Pairs of elements that were not kept apart, over all time steps.
    pub pairs_unresolved: Count,
    /// Points inside colliders.
    pub trapped: Count,
    /// Edges of cloth through faces of cloth.
    pub tangled: Count,
    /// The first frame in which something was not a finite number.
    pub not_finite: Option<i32>,
    /// How much of what frames brought could not be used, over all frames.
    pub refused: u64,
    /// The first of that, and its frame.
    pub first_refused: Option<(InvalidInput, i32)>,
}

/// Something that is counted in each frame.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Count {
    /// Over all frames.
    pub total: u64,
    /// The most in a frame.
    pub most: u64,
    /// The first frame with that many.
    pub frame: i32,
    /// In the last frame.
    pub end: u64,
}

impl Count {
    fn add(&mut self, count: u64, frame: i32) {
        if count > self.most {
            (self.most, self.frame) = (count, frame);
        }
        self.total += count;
        self.end = count;
    }
}

impl Account {
    /// Adds a frame.
    pub fn add(&mut self, figures: &FrameFigures, spent: Duration) {
        self.frames += 1;
        self.spent += spent;
        self.last = spent;
        self.recall(figures);
    }

    /// Adds a frame that was simulated long ago.
    pub fn recall(&mut self, figures: &FrameFigures) {
        let frame = figures.frame;
        if self.worst_strain.is_none_or(|(worst, _)| figures.max_strain > worst) {
            self.worst_strain = Some((figures.max_strain, frame));
        }
        if let Some(gap) =
            figures.min_gap.filter(|&gap| self.smallest_gap.is_none_or(|(least, _)| gap < least))
        {
            self.smallest_gap = Some((gap, frame));
        }
        self.pairs_unresolved.add(figures.pairs_unresolved, frame);
        self.trapped.add(figures.trapped, frame);
        self.tangled.add(figures.tangled, frame);
        self.refused += figures.refused;
        self.first_refused = self.first_refused.or(figures.first_refused.map(|what| (what, frame)));
        if !figures.finite {
            self.not_finite = self.not_finite.or(Some(frame));
        }
    }

    /// Milliseconds to a frame so far.
    pub fn milliseconds(&self) -> f64 {
        1e3 * self.spent.as_secs_f64() / f64::from(self.frames.max(1))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn account(reports: &[StepReport]) -> Account {
        let mut account = Account::default();
        for (frame, report) in (2..).zip(reports) {
            account.add(&FrameFigures::new(frame, report), Duration::from_millis(10));
        }
        account
    }

    #[test]
    fn the_worst_of_each_kind_is_kept_with_its_frame() {
        let strain = |max_strain, min_gap| StepReport { max_strain, min_gap, ..StepReport::default() };
        let account = account(&[strain(0.1, f64::INFINITY), strain(0.3, 0.9), strain(0.2, 0.5)]);
        assert_eq!(account.worst_strain, Some((0.3, 3)));
        assert_eq!(account.smallest_gap, Some((0.5, 4)));
        assert_eq!((account.frames, account.milliseconds()), (3, 10.0));
    }

    #[test]
    fn a_gap_to_nothing_is_no_gap() {
        assert_eq!(account(&[StepReport::default()]).smallest_gap, None);
        let figures = FrameFigures::new(2, &StepReport::default());
        assert!(serde_json::to_value(figures).unwrap()["min_gap"].is_null());
    }

    #[test]
    fn the_first_frame_that_is_not_finite_is_named() {
        let bad = StepReport { finite: false, pairs_unresolved: 2, ..StepReport::default() };
        let account = account(&[StepReport::default(), bad, bad]);
        assert_eq!((account.not_finite, account.pairs_unresolved.total), (Some(3), 4));
    }

    #[test]
    fn counts_keep_their_first_worst_frame_and_the_last_one() {
        let trapped = |depenetrating| StepReport { depenetrating, ..StepReport::default() };
        let account = account(&[trapped(0), trapped(4), trapped(4), trapped(1)]);
        assert_eq!(account.trapped, Count { total: 9, most: 4, frame: 3, end: 1 });
        assert_eq!(account.tangled, Count::default());
    }

    #[test]
    fn figures_that_were_recorded_under_older_names_are_read() {
        let report = StepReport { pairs_reverted: 5, pairs_unresolved: 2, ..StepReport::default() };
        let now = serde_json::to_string(&FrameFigures::new(2, &report)).unwrap();
        assert!(now.contains("\"pairs_reverted\":5,\"pairs_unresolved\":2"), "{now}");
        let older = now.replace("pairs_reverted", "caught").replace("pairs_unresolved", "crossed");
        let read: FrameFigures = serde_json::from_str(&older).unwrap();
        assert_eq!((read.pairs_reverted, read.pairs_unresolved), (5, 2));
    }
}
