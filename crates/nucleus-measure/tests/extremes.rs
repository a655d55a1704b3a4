//! The table of extremes, each row for as long as a test can wait; `nucleus extremes` runs them to their ends.

use std::collections::HashSet;
use std::io;

use nucleus_measure::extremes::{Extreme, Outcome, Patience, Trial, judge_all, miss, page, rows};

#[test]
fn no_extreme_does_in_its_first_seconds_what_it_is_not_known_to() {
    let rows: Vec<&Extreme> = rows().collect();
    let mut outcomes = Vec::new();
    let mut tell = |outcome: Outcome| {
        outcomes.push(outcome);
        Ok::<(), io::Error>(())
    };
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    judge_all(&rows, threads, Patience::Short, &mut tell).expect("meshes can be written");
    let mut wrong = Vec::new();
    // What it costs is judged by the command: a test does not depend on what else the machine does.
    let known = |outcome: &&Outcome| outcome.holds_at_any_cost() || outcome.extreme.fails.is_some();
    for outcome in outcomes.iter().filter(|outcome| !known(outcome)) {
        let misses: Vec<String> = outcome.failures().map(miss).collect();
        wrong.push(format!("{}: {}", outcome.extreme.name, misses.join("; ")));
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    let page = page(&outcomes);
    for outcome in &outcomes {
        assert!(page.contains(&format!("**`{}`**", outcome.extreme.name)), "{}", outcome.extreme.name);
    }
}

#[test]
fn a_row_that_fails_says_why_and_no_two_have_one_name() {
    let mut names = HashSet::new();
    for row in rows() {
        assert!(names.insert(row.name), "{} twice", row.name);
        assert!(row.fails.is_none_or(|reason| reason.ends_with('.')), "{}", row.name);
        assert!(row.expect.ends_with('.') && !row.what.ends_with('.'), "{}", row.name);
    }
}

#[test]
fn every_scene_of_the_table_is_a_file_that_can_be_read() {
    for row in rows() {
        let (Trial::Runs { case, .. } | Trial::InvalidInput { case, .. }) = row.trial;
        let compiled = case().compile().expect("meshes can be written");
        assert_eq!(compiled.program.is_some(), matches!(row.trial, Trial::Runs { .. }), "{}", row.name);
    }
}
