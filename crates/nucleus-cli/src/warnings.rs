//! Warnings at the end of a run. Unresolved contact fails the run; large strain only warns.

use nucleus_graph::checks::{
    MAX_DEPENETRATING, MAX_INTERSECTIONS, MAX_STRETCH, MAX_UNRESOLVED, Outcome, VOLUME_ERROR,
};

use crate::figures;
use crate::run_statistics::{Count, RunStatistics};

/// Strain above which a run warns, unless a check of the scene sets a limit.
const MAX_STRAIN: f64 = 0.2;
/// Mean excess of density of a liquid above which a run warns, unless a check of the scene sets a limit.
const MAX_COMPRESSION: f64 = 0.1;

const ADVICE: &str = "try more `subSteps` or `evaluations` of the nucleus, a smaller `thickness`, or more room between \
                   colliders";

/// A count that must be zero unless a check of the scene allows more.
struct Rule {
    /// The check that allows more in each frame.
    check: &'static str,
    count: fn(&RunStatistics) -> &Count,
    /// The figure that is compared with the limit.
    judged: fn(&Count) -> u64,
    /// The finding in words.
    words: fn(&Count) -> String,
}

static RULES: [Rule; 3] = [
    Rule {
        check: MAX_UNRESOLVED,
        count: |statistics| &statistics.pairs_unresolved,
        judged: |count| count.most,
        words: |count| {
            let pairs = figures::count(count.total as usize, "pair");
            format!("{pairs} of elements unresolved, {}: they may have passed each other", worst(count))
        },
    },
    Rule {
        check: MAX_DEPENETRATING,
        count: |statistics| &statistics.depenetrating,
        judged: |count| count.end,
        words: |count| {
            let points = figures::count(count.end as usize, "point");
            format!("{points} inside a collider at the last frame, {}", worst(count))
        },
    },
    Rule {
        check: MAX_INTERSECTIONS,
        count: |statistics| &statistics.intersections,
        judged: |count| count.end,
        words: |count| {
            let intersections = figures::count(count.end as usize, "intersection");
            format!("{intersections} of cloth with cloth at the last frame, {}", worst(count))
        },
    },
];

/// `worst at frame 7 with 36`.
fn worst(count: &Count) -> String {
    format!("worst at frame {} with {}", count.frame, count.most)
}

impl Rule {
    fn is_broken(&self, statistics: &RunStatistics, checks: &[Outcome]) -> bool {
        let judged = (self.judged)((self.count)(statistics));
        judged as f64 > limit(checks, self.check).unwrap_or(0.0)
    }

    fn finding(&self, statistics: &RunStatistics) -> String {
        (self.words)((self.count)(statistics))
    }
}

/// Contact that is unresolved and that the scene does not allow, as lines of the report. Empty if there is none.
pub fn unresolved_contact(statistics: &RunStatistics, checks: &[Outcome], is_audited: bool) -> Vec<String> {
    let broken: Vec<&Rule> = RULES.iter().filter(|rule| rule.is_broken(statistics, checks)).collect();
    if broken.is_empty() {
        return Vec::new();
    }
    let found = broken.iter().map(|rule| format!("UNRESOLVED CONTACT: {}", rule.finding(statistics)));
    let audit = if is_audited { "" } else { "; `nucleus run --audit` names the pairs" };
    let allow = broken.iter().map(|rule| format!("{}({})", rule.check, (rule.count)(statistics).most));
    let allow = allow.collect::<Vec<_>>().join(", ");
    let advice = [
        format!("{ADVICE}{audit}"),
        format!("if it is intended, allow it in the scene with `checks: [{allow}]`"),
    ];
    found.chain(advice).collect()
}

/// Contact that was unresolved in some frame, but that the scene allows or that is resolved by the last frame.
pub fn tolerated(statistics: &RunStatistics, checks: &[Outcome]) -> Vec<String> {
    let is_tolerated =
        |rule: &&Rule| (rule.count)(statistics).most > 0 && !rule.is_broken(statistics, checks);
    RULES.iter().filter(is_tolerated).map(|rule| rule.finding(statistics)).collect()
}

/// A warning if the largest strain is above the limit.
pub fn large_strain(statistics: &RunStatistics, checks: &[Outcome]) -> Option<String> {
    let (strain, frame) = statistics.worst_strain?;
    let allowed = limit(checks, MAX_STRETCH).unwrap_or(MAX_STRAIN);
    (strain > allowed.max(MAX_STRAIN)).then(|| {
        let (percent, above) = (figures::percent(strain), figures::number((100.0 * strain).ceil() / 100.0));
        format!(
            "warning: cloth is stretched by {percent} at frame {frame}: try more `evaluations` or `subSteps` of the \
             nucleus (`nucleus trade` measures how many are needed); a flat, symmetric sheet that cannot buckle folds with \
             a small `initialPerturbation` of the cloth; cloth that hangs by pins keeps its length with `tethers`; or \
             allow it with the check `{MAX_STRETCH}({above})`"
        )
    })
}

/// A warning if the largest mean excess of density of a liquid is above the limit.
pub fn large_compression(statistics: &RunStatistics, checks: &[Outcome]) -> Option<String> {
    let (compression, frame) = statistics.worst_compression?;
    let is_checked = limit(checks, VOLUME_ERROR).is_some();
    (!is_checked && compression > MAX_COMPRESSION).then(|| {
        format!(
            "warning: liquid is compressed by {} at frame {frame}: it may have too little room between what it touches; \
             allow it with the check `{VOLUME_ERROR}(frame: {frame}, share: {})`",
            figures::percent(compression),
            figures::number((100.0 * compression).ceil() / 100.0)
        )
    })
}

/// A hint at what lets cloths fold that are pressed together and stay flat.
pub fn flat(cloths: &[String]) -> Option<String> {
    let first = cloths.first()?;
    Some(format!(
        "hint: `{first}` is pressed together and stays flat, because it is perfectly flat at the start: give it an \
         `initialPerturbation`, say a tenth of its thickness, and it folds"
    ))
}

/// The strictest limit of the checks with this name.
fn limit(checks: &[Outcome], name: &str) -> Option<f64> {
    let own = checks.iter().filter(|outcome| outcome.check.form().name == name);
    own.map(|outcome| outcome.check.limit().1).reduce(f64::min)
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use nucleus_core::StepReport;
    use nucleus_graph::checks::{Check, Judge};

    use super::*;
    use crate::run_statistics::FrameStatistics;

    fn statistics(reports: &[StepReport]) -> RunStatistics {
        let mut statistics = RunStatistics::default();
        for (frame, report) in (2..).zip(reports) {
            statistics.add(&FrameStatistics::new(frame, report), Duration::ZERO);
        }
        statistics
    }

    fn checks(name: &str, limit: f64) -> Vec<Outcome> {
        Judge::new(&[Check::new(name, &[limit]).unwrap()], 1.0).outcomes().to_vec()
    }

    #[test]
    fn an_unresolved_pair_in_any_frame_is_reported() {
        let pairs = |pairs_unresolved| StepReport { pairs_unresolved, ..StepReport::default() };
        let statistics = statistics(&[pairs(0), pairs(2), pairs(5), pairs(0)]);
        let said = unresolved_contact(&statistics, &[], false);
        assert_eq!(
            said[0],
            "UNRESOLVED CONTACT: 7 pairs of elements unresolved, worst at frame 4 with 5: they may have passed each other"
        );
        assert!(said[1].contains("`subSteps`") && said[1].contains("`nucleus run --audit`"), "{said:?}");
        assert!(said[2].contains("`checks: [maxUnresolved(5)]`"), "{said:?}");
        assert!(
            !unresolved_contact(&statistics, &[], true)[1].contains("--audit"),
            "the run is audited already"
        );
        let allowed = checks("maxUnresolved", 5.0);
        assert!(unresolved_contact(&statistics, &allowed, false).is_empty());
        let words = said[0].trim_start_matches("UNRESOLVED CONTACT: ");
        assert_eq!(
            (tolerated(&statistics, &allowed), tolerated(&statistics, &[])),
            (vec![words.to_owned()], vec![])
        );
        assert!(!unresolved_contact(&statistics, &checks("maxUnresolved", 4.0), false).is_empty());
        assert!(!unresolved_contact(&statistics, &checks(MAX_DEPENETRATING, 9.0), false).is_empty());
    }

    #[test]
    fn points_in_colliders_and_intersections_are_reported_only_if_the_last_frame_has_them() {
        let inside = |depenetrating, intersections| StepReport {
            depenetrating,
            intersections,
            ..StepReport::default()
        };
        let separated = statistics(&[inside(9, 0), inside(0, 0)]);
        assert!(unresolved_contact(&separated, &[], false).is_empty());
        let said = tolerated(&separated, &[]);
        assert_eq!(said, ["0 points inside a collider at the last frame, worst at frame 2 with 9"]);
        let statistics = statistics(&[inside(9, 8), inside(1, 3)]);
        let said = unresolved_contact(&statistics, &[], false);
        assert_eq!(
            said[..2],
            [
                "UNRESOLVED CONTACT: 1 point inside a collider at the last frame, worst at frame 2 with 9",
                "UNRESOLVED CONTACT: 3 intersections of cloth with cloth at the last frame, worst at frame 2 with 8"
            ]
        );
        let checks_to_add = format!("`checks: [{MAX_DEPENETRATING}(9), {MAX_INTERSECTIONS}(8)]`");
        assert!(said[3].contains(&checks_to_add), "{said:?}");
        let rest = unresolved_contact(&statistics, &checks(MAX_DEPENETRATING, 9.0), false);
        assert!(rest[0].contains("3 intersections") && rest.len() == 3, "{rest:?}");
    }

    #[test]
    fn liquid_that_is_compressed_by_a_tenth_is_a_warning_unless_the_scene_checks_its_volume() {
        let dense = |density_error| StepReport { density_error, ..StepReport::default() };
        let statistics = |worst| statistics(&[dense(0.01), dense(worst), dense(0.0)]);
        assert_eq!(large_compression(&statistics(0.1), &[]), None);
        let said = large_compression(&statistics(0.3456), &[]).unwrap();
        assert!(said.starts_with("warning: liquid is compressed by 34.56 % at frame 3: "), "{said}");
        assert!(said.ends_with("`volumeError(frame: 3, share: 0.35)`"), "{said}");
        let check = Check::new(VOLUME_ERROR, &[3.0, 0.5]).unwrap();
        assert_eq!(large_compression(&statistics(0.3456), Judge::new(&[check], 1.0).outcomes()), None);
    }

    #[test]
    fn a_strain_above_20_percent_is_a_warning_unless_the_scene_allows_it() {
        let strain = |max_strain| StepReport { max_strain, ..StepReport::default() };
        let statistics = |worst| statistics(&[strain(0.1), strain(worst), strain(0.05)]);
        assert_eq!(large_strain(&statistics(0.2), &[]), None);
        let said = large_strain(&statistics(1.3372), &[]).unwrap();
        assert!(said.starts_with("warning: cloth is stretched by 133.7 % at frame 3: "), "{said}");
        assert!(said.contains("`nucleus trade`") && said.ends_with("`maxStretch(1.34)`"), "{said}");
        assert_eq!(large_strain(&statistics(1.3372), &checks("maxStretch", 1.34)), None);
        assert!(large_strain(&statistics(1.3372), &checks("maxStretch", 1.3)).is_some());
        assert!(large_strain(&statistics(1.3372), &checks("maxStretch99", 2.0)).is_some());
    }
}
