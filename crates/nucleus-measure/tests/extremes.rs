//! The table of extremes, each row for as long as a test can wait; `nucleus extremes` runs them to their ends.

use std::collections::HashSet;
use std::io;

use nucleus_measure::extremes::{
    Evaluation, Expectation, StressCase, TimeBudget, evaluate_all, failure_text, page, rows,
};

#[test]
fn no_extreme_does_in_its_first_seconds_what_it_is_not_known_to() {
    let rows: Vec<&StressCase> = rows().collect();
    let mut evaluations = Vec::new();
    let mut tell = |evaluation: Evaluation| {
        evaluations.push(evaluation);
        Ok::<(), io::Error>(())
    };
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    evaluate_all(&rows, threads, TimeBudget::Short, &mut tell).expect("meshes can be written");
    let mut wrong = Vec::new();
    // What it costs is judged by the command: a test does not depend on what else the machine does.
    let known = |evaluation: &&Evaluation| {
        evaluation.holds_at_any_cost() || evaluation.stress_case.known_failure.is_some()
    };
    for evaluation in evaluations.iter().filter(|evaluation| !known(evaluation)) {
        let misses: Vec<String> = evaluation.failures().map(failure_text).collect();
        wrong.push(format!("{}: {}", evaluation.stress_case.name, misses.join("; ")));
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    let page = page(&evaluations);
    for evaluation in &evaluations {
        assert!(
            page.contains(&format!("**`{}`**", evaluation.stress_case.name)),
            "{}",
            evaluation.stress_case.name
        );
    }
}

#[test]
fn a_row_that_fails_says_why_and_no_two_have_one_name() {
    let mut names = HashSet::new();
    for row in rows() {
        assert!(names.insert(row.name), "{} twice", row.name);
        assert!(row.known_failure.is_none_or(|reason| reason.ends_with('.')), "{}", row.name);
        assert!(row.expect.ends_with('.') && !row.what.ends_with('.'), "{}", row.name);
    }
}

#[test]
fn every_scene_of_the_table_is_a_file_that_can_be_read() {
    for row in rows() {
        let (Expectation::Runs { scene, .. } | Expectation::InvalidInput { scene, .. }) = row.expectation;
        let compiled = scene().compile().expect("meshes can be written");
        assert_eq!(
            compiled.program.is_some(),
            matches!(row.expectation, Expectation::Runs { .. }),
            "{}",
            row.name
        );
    }
}
