//! The table of extremes with a short time budget; `nucleus extremes` runs the rows to their ends.

use std::collections::HashSet;
use std::io;

use nucleus_measure::extremes::{
    Evaluation, Expectation, StressCase, TimeBudget, evaluate_all, failure_text, page, rows,
};

#[test]
fn no_row_fails_in_its_first_seconds_unless_it_is_known_to() {
    let rows: Vec<&StressCase> = rows().collect();
    let mut evaluations = Vec::new();
    let mut collect = |evaluation: Evaluation| {
        evaluations.push(evaluation);
        Ok::<(), io::Error>(())
    };
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    evaluate_all(&rows, threads, TimeBudget::Short, &mut collect).expect("meshes can be written");
    let mut wrong = Vec::new();
    // The command evaluates cost: a test must not depend on the load of the machine.
    let is_known = |row: &&Evaluation| row.holds_at_any_cost() || row.stress_case.known_failure.is_some();
    for evaluation in evaluations.iter().filter(|evaluation| !is_known(evaluation)) {
        let failures: Vec<String> = evaluation.failures().map(failure_text).collect();
        wrong.push(format!("{}: {}", evaluation.stress_case.name, failures.join("; ")));
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    let page = page(&evaluations);
    for evaluation in &evaluations {
        let name = evaluation.stress_case.name;
        assert!(page.contains(&format!("**`{name}`**")), "{name}");
    }
}

#[test]
fn rows_have_unique_names_and_descriptions_of_one_form() {
    let mut names = HashSet::new();
    for row in rows() {
        assert!(names.insert(row.name), "{} twice", row.name);
        assert!(row.known_failure.is_none_or(|reason| reason.ends_with('.')), "{}", row.name);
        assert!(row.expected.ends_with('.') && !row.summary.ends_with('.'), "{}", row.name);
    }
}

#[test]
fn a_scene_compiles_unless_it_is_to_be_rejected() {
    for row in rows() {
        let compiled = row.scene().compile().expect("meshes can be written");
        let runs = matches!(row.expectation, Expectation::Runs(_));
        assert_eq!(compiled.program.is_some(), runs, "{}: {:?}", row.name, compiled.diagnostics);
    }
}
