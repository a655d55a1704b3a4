use super::*;

fn judge(check: &str, arguments: &[f64], reports: &[StepReport]) -> Outcome {
    let check = Check::new(check, arguments).expect("a known check");
    let mut judge = Judge::new(&[check], 2.0);
    for (frame, report) in (2..).zip(reports) {
        judge.see(&FrameReport { frame, report: *report, passed_through: None });
    }
    judge.outcomes()[0].clone()
}

#[test]
fn the_worst_figure_decides_and_its_first_frame_is_reported() {
    let strain = |max_strain| StepReport { max_strain, ..StepReport::default() };
    let outcome = judge("maxStretch", &[0.02], &[strain(0.01), strain(0.03), strain(0.03), strain(0.02)]);
    assert_eq!((outcome.passed, outcome.worst), (false, Some((0.03, 3))));
    assert!(judge("maxStretch", &[0.02], &[strain(0.02)]).passed);
}

#[test]
fn a_gap_below_the_limit_fails() {
    let gap = |min_gap| StepReport { min_gap, ..StepReport::default() };
    let outcome = judge("minGap", &[0.9], &[gap(f64::INFINITY), gap(0.95), gap(0.99)]);
    assert_eq!((outcome.passed, outcome.worst), (true, Some((0.95, 3))));
    assert!(!judge("minGap", &[0.9], &[gap(0.89)]).passed);
}

#[test]
fn a_gap_above_the_thickness_is_not_measured() {
    let gap = |min_gap| StepReport { min_gap, ..StepReport::default() };
    for distant in [1.5, 106.0, f64::INFINITY] {
        let outcome = judge("minGap", &[1.0], &[gap(distant)]);
        assert_eq!((outcome.passed, outcome.worst), (true, Some((1.0, 2))), "{distant}");
    }
    assert!(!judge("minGap", &[0.9], &[gap(f64::NAN)]).passed);
}

#[test]
fn one_unresolved_pair_is_a_penetration() {
    let unresolved = StepReport { pairs_unresolved: 1, ..StepReport::default() };
    assert!(!judge("noPenetration", &[], &[StepReport::default(), unresolved, StepReport::default()]).passed);
    assert!(judge("noPenetration", &[], &[StepReport::default()]).passed);
}

#[test]
fn a_limit_on_counts_applies_to_each_frame() {
    let count = |pairs_unresolved, trapped, tangled| StepReport {
        pairs_unresolved,
        depenetrating: trapped,
        intersections: tangled,
        ..StepReport::default()
    };
    let frames = [count(3, 5, 7), count(3, 5, 7), count(0, 0, 0)];
    for (check, most) in [("maxUnresolved", 3.0), ("maxDepenetrating", 5.0), ("maxIntersections", 7.0)] {
        let outcome = judge(check, &[most], &frames);
        assert_eq!((outcome.passed, outcome.worst), (true, Some((most, 2))), "{check}");
        assert!(!judge(check, &[most - 1.0], &frames).passed, "{check}");
    }
}

#[test]
fn nan_fails_and_remains_the_worst_figure() {
    let strain = |max_strain| StepReport { max_strain, ..StepReport::default() };
    let outcome = judge("maxStretch", &[0.02], &[strain(f64::NAN), strain(0.0)]);
    assert!(!outcome.passed && outcome.worst.is_some_and(|(worst, frame)| worst.is_nan() && frame == 2));
}

#[test]
fn rests_by_limits_the_root_mean_square_speed_from_its_frame_on() {
    // 4 J in 2 kg are 2 m/s.
    let moving = |kinetic_energy| StepReport { kinetic_energy, ..StepReport::default() };
    let outcome = judge("atRestBy", &[3.0, 2.0], &[moving(100.0), moving(4.0), moving(1.0)]);
    assert_eq!((outcome.passed, outcome.worst), (true, Some((2.0, 3))));
    assert!(!judge("atRestBy", &[3.0, 1.9], &[moving(0.0), moving(4.0)]).passed);
}

#[test]
fn untangled_by_fails_for_intersections_from_its_frame_on() {
    let tangled = |tangled| StepReport { intersections: tangled, ..StepReport::default() };
    assert!(judge("noIntersectionsAfter", &[3.0], &[tangled(9), tangled(0), tangled(0)]).passed);
    let outcome = judge("noIntersectionsAfter", &[3.0], &[tangled(9), tangled(1), tangled(0)]);
    assert_eq!((outcome.passed, outcome.worst), (false, Some((1.0, 3))));
}

#[test]
fn a_check_that_applies_to_no_frame_fails() {
    let outcome = judge("atRestBy", &[100.0, 1.0], &[StepReport::default()]);
    assert_eq!((outcome.passed, outcome.worst), (false, None));
}

#[test]
fn unknown_names_and_wrong_counts_of_arguments_are_refused() {
    assert_eq!(Check::new("noPenetration", &[1.0]), None);
    assert_eq!(Check::new("maxStretch", &[]), None);
    assert_eq!(Check::new("maxStrech", &[1.0]), None);
}

#[test]
fn settled_strain_ignores_the_frames_before_it() {
    let strain = |strain_99| StepReport { strain_99, ..StepReport::default() };
    let outcome = judge("settledStretch99", &[3.0, 0.02], &[strain(0.5), strain(0.01), strain(0.015)]);
    assert_eq!((outcome.passed, outcome.worst), (true, Some((0.015, 4))));
    assert!(!judge("settledStretch99", &[3.0, 0.02], &[strain(0.0), strain(0.03)]).passed);
}
