//! Statistics of a run: the figures of each frame, their worst values over the run, and how the run ended.

use std::time::Duration;

use nucleus_core::{InvalidInput, StepReport};
use nucleus_graph::FrameReport;
use nucleus_graph::checks::measured_gap;
use serde::{Deserialize, Deserializer, Serialize};

/// The figures of one frame, as a cache stores them and `--json` prints them.
///
/// Older caches hold them under the names in `alias`. JSON has no NaN: a figure that is not finite is written as `null`.
#[derive(Debug, Clone, Copy, Serialize, Deserialize)]
pub struct FrameStatistics {
    pub frame: i32,
    /// See [`StepReport`] for this field and the following ones.
    #[serde(deserialize_with = "null_as_nan")]
    pub max_strain: f64,
    #[serde(deserialize_with = "null_as_nan")]
    pub strain_99: f64,
    /// At most 1, see [`measured_gap`]. `None` if no collider is near: JSON has no infinity.
    pub min_gap: Option<f64>,
    /// The same for cloth-cloth contacts.
    pub min_cloth_gap: Option<f64>,
    pub contacts: u64,
    #[serde(alias = "pairs")]
    pub candidate_pairs: u64,
    pub broad_phases: u32,
    #[serde(alias = "caught")]
    pub pairs_reverted: u64,
    #[serde(alias = "crossed")]
    pub pairs_unresolved: u64,
    /// Points inside a closed collider.
    #[serde(alias = "trapped")]
    pub depenetrating: u64,
    /// Edges of cloth that intersect faces of cloth.
    #[serde(alias = "tangled")]
    pub intersections: u64,
    /// Broken links of constraints. This and the next are left out where they are zero.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub broken_links: u64,
    /// Largest error of a weld, in metres.
    #[serde(default, skip_serializing_if = "is_zero", deserialize_with = "null_as_nan")]
    pub max_weld_gap: f64,
    /// Particles of objects in which they are born and die.
    #[serde(default)]
    pub particles: u64,
    /// Particles that were not born because there was no room.
    #[serde(default)]
    pub births_refused: u64,
    /// Particles that were not born because they would have overlapped others.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub births_pruned: u64,
    /// Mean excess of density of liquids.
    #[serde(default, deserialize_with = "null_as_nan")]
    pub density_error: f64,
    /// In joules.
    #[serde(deserialize_with = "null_as_nan")]
    pub kinetic_energy: f64,
    pub finite: bool,
    /// Input values that were not usable and were replaced.
    #[serde(alias = "refused")]
    pub sanitized: u64,
    #[serde(skip)]
    pub first_sanitized: Option<InvalidInput>,
    /// Penetrations that the audit found in the frame; `None` without an audit.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub passed_through: Option<u64>,
}

/// A figure that was not finite when it was written is NaN.
fn null_as_nan<'de, D: Deserializer<'de>>(from: D) -> Result<f64, D::Error> {
    Ok(Option::deserialize(from)?.unwrap_or(f64::NAN))
}

/// Whether a figure is zero.
fn is_zero<T: Default + PartialEq>(figure: &T) -> bool {
    *figure == T::default()
}

impl FrameStatistics {
    /// The figures of a frame from its report.
    pub fn of(report: &FrameReport, frame: i32) -> Self {
        Self { passed_through: report.passed_through, ..Self::new(frame, &report.report) }
    }

    /// The figures of a frame from the solver's report, without an audit.
    pub fn new(frame: i32, report: &StepReport) -> Self {
        let StepReport {
            max_strain,
            strain_99,
            min_gap,
            min_cloth_gap,
            contacts,
            candidate_pairs,
            broad_phases,
            pairs_reverted,
            pairs_unresolved,
            depenetrating,
            intersections,
            broken_links,
            max_weld_gap,
            particles,
            births_refused,
            births_pruned,
            density_error,
            kinetic_energy,
            finite,
            sanitized,
            ..
        } = *report;
        let [min_gap, min_cloth_gap] = [min_gap, min_cloth_gap].map(|gap| gap.is_finite().then_some(gap));
        let min_gap = min_gap.map(measured_gap);
        Self {
            frame,
            max_strain,
            strain_99,
            min_gap,
            min_cloth_gap,
            contacts,
            candidate_pairs,
            broad_phases,
            pairs_reverted,
            pairs_unresolved,
            depenetrating,
            intersections,
            broken_links,
            max_weld_gap,
            particles,
            births_refused,
            births_pruned,
            density_error,
            kinetic_energy,
            finite,
            sanitized: sanitized.count,
            first_sanitized: sanitized.first,
            passed_through: None,
        }
    }

    /// The solver's report, as far as it was stored. Checks of a resumed run need it.
    pub fn report(&self) -> FrameReport {
        let report = StepReport {
            max_strain: self.max_strain,
            strain_99: self.strain_99,
            min_gap: self.min_gap.unwrap_or(f64::INFINITY),
            contacts: self.contacts,
            candidate_pairs: self.candidate_pairs,
            broad_phases: self.broad_phases,
            pairs_reverted: self.pairs_reverted,
            pairs_unresolved: self.pairs_unresolved,
            depenetrating: self.depenetrating,
            intersections: self.intersections,
            broken_links: self.broken_links,
            max_weld_gap: self.max_weld_gap,
            particles: self.particles,
            births_refused: self.births_refused,
            births_pruned: self.births_pruned,
            density_error: self.density_error,
            kinetic_energy: self.kinetic_energy,
            finite: self.finite,
            ..StepReport::default()
        };
        FrameReport { frame: self.frame.into(), report, passed_through: self.passed_through }
    }
}

/// The worst figures of a run so far.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct RunStatistics {
    /// Frames that this process has simulated.
    pub frames: u32,
    /// Frames before those, which the cache of a resumed run holds.
    pub frames_before: u32,
    /// Wall-clock time of the frames that this process has simulated.
    pub time: Duration,
    /// Wall-clock time of the last frame.
    pub last_frame_time: Duration,
    /// The largest strain, and its frame.
    pub worst_strain: Option<(f64, i32)>,
    /// The largest strain that 1 % of the links exceed, and its frame.
    pub worst_strain_99: Option<(f64, i32)>,
    /// The largest mean excess of density of a liquid, and its frame.
    pub worst_compression: Option<(f64, i32)>,
    /// The smallest gap over thickness, and its frame. `None` if there was no contact.
    pub smallest_gap: Option<(f64, i32)>,
    /// Pairs of elements that the safeguard left unresolved, over all time steps.
    pub pairs_unresolved: Count,
    /// Points inside colliders.
    pub depenetrating: Count,
    /// Edges of cloth that intersect faces of cloth.
    pub intersections: Count,
    /// Particles of objects in which they are born and die.
    pub particles: Count,
    /// Particles that were not born because there was no room.
    pub births_refused: Count,
    /// Particles that were not born because they would have overlapped others.
    pub births_pruned: Count,
    /// The first frame with a position or velocity that is not finite.
    pub not_finite: Option<i32>,
    /// Input values that were replaced, over all frames.
    pub sanitized: u64,
    /// The first of them, and its frame.
    pub first_sanitized: Option<(InvalidInput, i32)>,
    /// Penetrations that an audit found in the frames before a resumed run.
    pub passed_through_before: u64,
}

/// A count per frame.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Count {
    /// Sum over all frames.
    pub total: u64,
    /// The largest count of a frame.
    pub most: u64,
    /// The first frame with that count.
    pub frame: i32,
    /// The count of the last frame.
    pub end: u64,
}

impl Count {
    fn add(&mut self, count: u64, frame: i32) {
        if count > self.most {
            (self.most, self.frame) = (count, frame);
        }
        self.total = self.total.saturating_add(count);
        self.end = count;
    }
}

impl RunStatistics {
    /// Adds a frame that took `time`.
    pub fn add(&mut self, figures: &FrameStatistics, time: Duration) {
        self.frames += 1;
        self.time += time;
        self.last_frame_time = time;
        self.add_figures(figures);
    }

    /// Adds a frame that a cache holds; it takes no time, and the audit of this process does not see it.
    pub fn add_recorded(&mut self, figures: &FrameStatistics) {
        self.frames_before += 1;
        self.passed_through_before += figures.passed_through.unwrap_or_default();
        self.add_figures(figures);
    }

    /// The largest mean excess of density of liquids, and its frame; `None` where no liquid is compressed, as without any.
    pub fn volume_error(&self) -> Option<(f64, i32)> {
        self.worst_compression.filter(|(error, _)| *error > 0.0)
    }

    fn add_figures(&mut self, figures: &FrameStatistics) {
        let frame = figures.frame;
        if self.worst_strain.is_none_or(|(worst, _)| figures.max_strain > worst) {
            self.worst_strain = Some((figures.max_strain, frame));
        }
        if self.worst_strain_99.is_none_or(|(worst, _)| figures.strain_99 > worst) {
            self.worst_strain_99 = Some((figures.strain_99, frame));
        }
        if self.worst_compression.is_none_or(|(worst, _)| figures.density_error > worst) {
            self.worst_compression = Some((figures.density_error, frame));
        }
        if let Some(gap) =
            figures.min_gap.filter(|&gap| self.smallest_gap.is_none_or(|(least, _)| gap < least))
        {
            self.smallest_gap = Some((gap, frame));
        }
        self.pairs_unresolved.add(figures.pairs_unresolved, frame);
        self.depenetrating.add(figures.depenetrating, frame);
        self.intersections.add(figures.intersections, frame);
        self.particles.add(figures.particles, frame);
        self.births_refused.add(figures.births_refused, frame);
        self.births_pruned.add(figures.births_pruned, frame);
        self.sanitized += figures.sanitized;
        self.first_sanitized = self.first_sanitized.or(figures.first_sanitized.map(|input| (input, frame)));
        if !figures.finite {
            self.not_finite = self.not_finite.or(Some(frame));
        }
    }

    /// Mean milliseconds per frame.
    pub fn milliseconds(&self) -> f64 {
        1e3 * self.time.as_secs_f64() / f64::from(self.frames.max(1))
    }
}

/// Why a run ended.
#[derive(Debug)]
pub enum Ending {
    /// All frames are simulated.
    Done,
    /// A signal arrived between two frames.
    Interrupted,
    /// A signal arrived within a frame, which is dropped.
    Stopped(Stopped),
    /// A position or velocity is not a finite number, so further frames mean nothing.
    NotFinite,
    /// The cache could not be written.
    Lost(anyhow::Error),
}

/// A run that was stopped within a frame.
#[derive(Debug)]
pub struct Stopped {
    /// The checkpoint of the previous frame, if it was kept.
    pub state: Option<Vec<u8>>,
    /// Whether the cache holds nothing of the dropped frame.
    pub is_clean: bool,
}

#[cfg(test)]
mod tests {
    use super::*;

    fn statistics(reports: &[StepReport]) -> RunStatistics {
        let mut statistics = RunStatistics::default();
        for (frame, report) in (2..).zip(reports) {
            statistics.add(&FrameStatistics::new(frame, report), Duration::from_millis(10));
        }
        statistics
    }

    #[test]
    fn the_worst_value_of_each_figure_is_kept_with_its_frame() {
        let strain = |max_strain, min_gap| StepReport { max_strain, min_gap, ..StepReport::default() };
        let statistics = statistics(&[strain(0.1, f64::INFINITY), strain(0.3, 0.9), strain(0.2, 0.5)]);
        assert_eq!(statistics.worst_strain, Some((0.3, 3)));
        assert_eq!(statistics.smallest_gap, Some((0.5, 4)));
        assert_eq!((statistics.frames, statistics.milliseconds()), (3, 10.0));
    }

    #[test]
    fn a_frame_without_contacts_has_no_gap() {
        assert_eq!(statistics(&[StepReport::default()]).smallest_gap, None);
        let figures = FrameStatistics::new(2, &StepReport::default());
        assert!(serde_json::to_value(figures).unwrap()["min_gap"].is_null());
    }

    #[test]
    fn a_gap_above_the_thickness_is_the_thickness() {
        let distant = StepReport { min_gap: 106.0, ..StepReport::default() };
        assert_eq!(statistics(&[distant]).smallest_gap, Some((1.0, 2)));
    }

    #[test]
    fn the_first_frame_that_is_not_finite_is_named() {
        let bad = StepReport { finite: false, pairs_unresolved: 2, ..StepReport::default() };
        let statistics = statistics(&[StepReport::default(), bad, bad]);
        assert_eq!((statistics.not_finite, statistics.pairs_unresolved.total), (Some(3), 4));
    }

    #[test]
    fn counts_keep_their_first_worst_frame_and_the_last_one() {
        let inside = |depenetrating| StepReport { depenetrating, ..StepReport::default() };
        let statistics = statistics(&[inside(0), inside(4), inside(4), inside(1)]);
        assert_eq!(statistics.depenetrating, Count { total: 9, most: 4, frame: 3, end: 1 });
        assert_eq!(statistics.intersections, Count::default());
    }

    #[test]
    fn figures_that_are_not_finite_are_read_back_as_nan() {
        let bad = StepReport {
            max_strain: f64::NAN,
            strain_99: f64::INFINITY,
            max_weld_gap: f64::NAN,
            density_error: f64::NAN,
            kinetic_energy: f64::INFINITY,
            finite: false,
            ..StepReport::default()
        };
        let line = serde_json::to_value(FrameStatistics::new(2, &bad)).unwrap();
        let read: FrameStatistics = serde_json::from_value(line).unwrap();
        let figures = [read.max_strain, read.strain_99, read.max_weld_gap, read.density_error];
        assert!(figures.iter().all(|figure| figure.is_nan()) && read.kinetic_energy.is_nan());
        let mut statistics = RunStatistics::default();
        statistics.add_recorded(&read);
        assert_eq!(statistics.not_finite, Some(2));
    }

    #[test]
    fn findings_of_an_audit_are_read_back() {
        let report = |passed_through| FrameReport { frame: 2, report: StepReport::default(), passed_through };
        for passed_through in [None, Some(0), Some(3)] {
            let line = serde_json::to_value(FrameStatistics::of(&report(passed_through), 2)).unwrap();
            let read: FrameStatistics = serde_json::from_value(line).unwrap();
            assert_eq!(read.report().passed_through, passed_through);
        }
    }

    #[test]
    fn figures_recorded_under_older_names_are_read() {
        let names = [
            ("pairs_reverted", "caught"),
            ("pairs_unresolved", "crossed"),
            ("candidate_pairs", "pairs"),
            ("depenetrating", "trapped"),
            ("intersections", "tangled"),
            ("sanitized", "refused"),
        ];
        let report = StepReport {
            pairs_reverted: 5,
            pairs_unresolved: 2,
            candidate_pairs: 7,
            depenetrating: 3,
            intersections: 4,
            ..StepReport::default()
        };
        let now = serde_json::to_string(&FrameStatistics::new(2, &report)).unwrap();
        let older = names.iter().fold(now, |text, (present, former)| {
            let [present, former] = [present, former].map(|name| format!("\"{name}\":"));
            assert!(text.contains(&present), "{present} is not in {text}");
            text.replace(&present, &former)
        });
        let read: FrameStatistics = serde_json::from_str(&older).unwrap();
        let FrameStatistics { pairs_reverted, pairs_unresolved, candidate_pairs, .. } = read;
        assert_eq!((pairs_reverted, pairs_unresolved, candidate_pairs), (5, 2, 7));
        assert_eq!((read.depenetrating, read.intersections, read.sanitized), (3, 4, 0));
    }
}
