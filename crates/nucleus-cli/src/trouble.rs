//! What a run says at its end without being asked: contact that has not separated everything, which is trouble, and
//! cloth that is stretched far, which is a warning.

use nucleus_graph::checks::{MAX_DEPENETRATING, MAX_INTERSECTIONS, MAX_STRETCH, MAX_UNRESOLVED, Outcome};

use crate::account::{Account, Count};
use crate::figures;

/// Strain above which the end of a run warns, unless the scene has a limit of its own.
const STRETCHED: f64 = 0.2;

const TRY: &str = "try more `subSteps` or `evaluations` of the nucleus, a smaller `thickness`, or more room between \
                   colliders";

/// A count that has to be zero, unless a check of the scene allows more.
struct Rule {
    /// The check that allows more in any frame.
    check: &'static str,
    count: fn(&Account) -> &Count,
    /// The figure that is held to the limit.
    judged: fn(&Count) -> u64,
    /// What there is, in words.
    words: fn(&Count) -> String,
}

static RULES: [Rule; 3] = [
    Rule {
        check: MAX_UNRESOLVED,
        count: |account| &account.pairs_unresolved,
        judged: |count| count.most,
        words: |count| {
            let pairs = figures::count(count.total as usize, "pair");
            format!("{pairs} of elements unresolved, {}: they may have passed each other", worst(count))
        },
    },
    Rule {
        check: MAX_DEPENETRATING,
        count: |account| &account.trapped,
        judged: |count| count.end,
        words: |count| {
            let points = figures::count(count.end as usize, "point");
            format!("{points} inside a collider at the last frame, {}", worst(count))
        },
    },
    Rule {
        check: MAX_INTERSECTIONS,
        count: |account| &account.tangled,
        judged: |count| count.end,
        words: |count| {
            let edges = figures::count(count.end as usize, "edge");
            format!("{edges} of cloth through cloth at the last frame, {}", worst(count))
        },
    },
];

/// `worst at frame 7 with 36`.
fn worst(count: &Count) -> String {
    format!("worst at frame {} with {}", count.frame, count.most)
}

impl Rule {
    fn is_broken(&self, account: &Account, checks: &[Outcome]) -> bool {
        let judged = (self.judged)((self.count)(account));
        judged as f64 > limit(checks, self.check).unwrap_or(0.0)
    }

    fn say(&self, account: &Account) -> String {
        (self.words)((self.count)(account))
    }
}

/// What contact has not separated and the scene does not allow: lines for people; empty if there is nothing.
pub fn unseparated(account: &Account, checks: &[Outcome], is_audited: bool) -> Vec<String> {
    let broken: Vec<&Rule> = RULES.iter().filter(|rule| rule.is_broken(account, checks)).collect();
    if broken.is_empty() {
        return Vec::new();
    }
    let found = broken.iter().map(|rule| format!("NOT SEPARATED: {}", rule.say(account)));
    let audit = if is_audited { "" } else { "; `nucleus run --audit` names the pairs" };
    let allow = broken.iter().map(|rule| format!("{}({})", rule.check, (rule.count)(account).most));
    let allow = allow.collect::<Vec<_>>().join(", ");
    let advice = [format!("{TRY}{audit}"), format!("if that is meant, allow it with `checks: [{allow}]`")];
    found.chain(advice).collect()
}

/// The same where the scene allows it, or where it was separated by the last frame.
pub fn tolerated(account: &Account, checks: &[Outcome]) -> Vec<String> {
    let is_tolerated = |rule: &&Rule| (rule.count)(account).most > 0 && !rule.is_broken(account, checks);
    RULES.iter().filter(is_tolerated).map(|rule| rule.say(account)).collect()
}

/// A warning of cloth that is stretched farther than the scene allows.
pub fn stretched(account: &Account, checks: &[Outcome]) -> Option<String> {
    let (strain, frame) = account.worst_strain?;
    let allowed = limit(checks, MAX_STRETCH).unwrap_or(STRETCHED);
    (strain > allowed.max(STRETCHED)).then(|| {
        let (percent, above) = (figures::percent(strain), figures::number((100.0 * strain).ceil() / 100.0));
        format!(
            "warning: cloth is stretched by {percent} at frame {frame}: try more `evaluations` or `subSteps` of the \
             nucleus (`nucleus trade` measures how many it takes), or allow it with the check `{MAX_STRETCH}({above})`"
        )
    })
}

/// The strictest limit that the scene sets by a check of this name.
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
    use crate::account::FrameFigures;

    fn account(reports: &[StepReport]) -> Account {
        let mut account = Account::default();
        for (frame, report) in (2..).zip(reports) {
            account.add(&FrameFigures::new(frame, report), Duration::ZERO);
        }
        account
    }

    fn checks(name: &str, limit: f64) -> Vec<Outcome> {
        Judge::new(&[Check::new(name, &[limit]).unwrap()], 1.0).outcomes().to_vec()
    }

    #[test]
    fn a_pair_left_unresolved_in_any_frame_is_trouble() {
        let pairs = |pairs_unresolved| StepReport { pairs_unresolved, ..StepReport::default() };
        let account = account(&[pairs(0), pairs(2), pairs(5), pairs(0)]);
        let said = unseparated(&account, &[], false);
        assert_eq!(
            said[0],
            "NOT SEPARATED: 7 pairs of elements unresolved, worst at frame 4 with 5: they may have passed each other"
        );
        assert!(said[1].contains("`subSteps`") && said[1].contains("`nucleus run --audit`"), "{said:?}");
        assert!(said[2].contains("`checks: [maxUnresolved(5)]`"), "{said:?}");
        assert!(!unseparated(&account, &[], true)[1].contains("--audit"), "it is audited already");
        let allowed = checks("maxUnresolved", 5.0);
        assert!(unseparated(&account, &allowed, false).is_empty());
        let words = said[0].trim_start_matches("NOT SEPARATED: ");
        assert_eq!(
            (tolerated(&account, &allowed), tolerated(&account, &[])),
            (vec![words.to_owned()], vec![])
        );
        assert!(!unseparated(&account, &checks("maxUnresolved", 4.0), false).is_empty());
        assert!(!unseparated(&account, &checks("maxDepenetrating", 9.0), false).is_empty());
    }

    #[test]
    fn points_in_colliders_and_edges_through_faces_are_trouble_only_at_the_last_frame() {
        let inside = |trapped, tangled| StepReport {
            depenetrating: trapped,
            intersections: tangled,
            ..StepReport::default()
        };
        let separated = account(&[inside(9, 0), inside(0, 0)]);
        assert!(unseparated(&separated, &[], false).is_empty());
        let said = tolerated(&separated, &[]);
        assert_eq!(said, ["0 points inside a collider at the last frame, worst at frame 2 with 9"]);
        let account = account(&[inside(9, 8), inside(1, 3)]);
        let said = unseparated(&account, &[], false);
        assert_eq!(
            said[..2],
            [
                "NOT SEPARATED: 1 point inside a collider at the last frame, worst at frame 2 with 9",
                "NOT SEPARATED: 3 edges of cloth through cloth at the last frame, worst at frame 2 with 8"
            ]
        );
        assert!(said[3].contains("`checks: [maxDepenetrating(9), maxIntersections(8)]`"), "{said:?}");
        let trapped = unseparated(&account, &checks("maxDepenetrating", 9.0), false);
        assert!(trapped[0].contains("edges") && trapped.len() == 3, "{trapped:?}");
    }

    #[test]
    fn cloth_that_is_stretched_by_more_than_a_fifth_is_warned_of_unless_the_scene_allows_it() {
        let strain = |max_strain| StepReport { max_strain, ..StepReport::default() };
        let account = |worst| account(&[strain(0.1), strain(worst), strain(0.05)]);
        assert_eq!(stretched(&account(0.2), &[]), None);
        let said = stretched(&account(1.3372), &[]).unwrap();
        assert!(said.starts_with("warning: cloth is stretched by 133.7 % at frame 3: "), "{said}");
        assert!(said.contains("`nucleus trade`") && said.ends_with("`maxStretch(1.34)`"), "{said}");
        assert_eq!(stretched(&account(1.3372), &checks("maxStretch", 1.34)), None);
        assert!(stretched(&account(1.3372), &checks("maxStretch", 1.3)).is_some());
        assert!(stretched(&account(1.3372), &checks("maxStretch99", 2.0)).is_some());
    }
}
