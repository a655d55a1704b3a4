//! `nucleus extremes`: its output and exit codes. The measure crate tests the table itself.

use std::fs;

use serde_json::Value;

use crate::sample::{assert_refused, folder, nucleus, stderr, stdout};

#[test]
fn a_row_that_holds_is_a_success_and_shows_its_figures() {
    let folder = folder();
    let output = nucleus(folder.path(), &["extremes", "--only", "gravity-0", "--only", "no-points"]);
    let said = stdout(&output);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert!(
        said.contains("Forces") && said.contains("ok   gravity-0") && said.contains("2 rows: all hold"),
        "{said}"
    );
    assert!(!said.contains('\u{1b}'), "no colours where there is no terminal: {said}");
}

#[test]
fn json_has_a_line_per_row_with_figures_and_limits() {
    let folder = folder();
    let output = nucleus(folder.path(), &["extremes", "--json", "--only", "nan-in-a-file"]);
    let row: Value = serde_json::from_str(&stdout(&output)).unwrap();
    assert_eq!((row["name"].as_str(), row["holds"].as_bool()), (Some("nan-in-a-file"), Some(true)));
    assert!(row["reported"][0].as_str().unwrap().contains("`nan.obj`, line 5"), "{row}");
    assert_eq!(row["figures"][0]["limit"], 0.0);
}

#[test]
fn scenes_of_rows_can_be_written_out_and_run() {
    let folder = folder();
    let output = nucleus(folder.path(), &["extremes", "--save", "out", "--only", "one-face"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert!(folder.path().join("out/one-face/triangle.obj").is_file());
    let run = nucleus(folder.path(), &["run", "out/one-face/one-face.ron", "--record", "none"]);
    assert_eq!(run.status.code(), Some(0), "{}", stderr(&run));
}

#[test]
fn the_page_has_an_entry_for_each_row() {
    let folder = folder();
    let output =
        nucleus(folder.path(), &["extremes", "--write", "page.md", "--only", "mass-0", "--only", "no-area"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let page = fs::read_to_string(folder.path().join("page.md")).unwrap();
    assert!(page.contains("2 of 2 rows hold.") && page.contains("**`mass-0`**: `pointMass: 0`."), "{page}");
}

#[test]
fn rows_are_listed_and_an_unknown_one_is_refused() {
    let folder = folder();
    let list = nucleus(folder.path(), &["extremes", "--list"]);
    assert!(stdout(&list).lines().any(|line| line.starts_with("wind-1e3 ")));
    assert_refused(
        &nucleus(folder.path(), &["extremes", "--only", "nothing-like-it"]),
        "there is no row `nothing-like-it`",
    );
}

#[test]
fn a_former_option_name_works_with_a_note() {
    let folder = folder();
    let output = nucleus(folder.path(), &["extremes", "--list", "--threads", "1"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert_eq!(stderr(&output), "note: `--threads` of `nucleus extremes` is now `--jobs`\n");
}

/// Everything of a row but its cost, which is not measured where rows run side by side.
fn without_cost(output: &str) -> Vec<Value> {
    let row = |line: &str| {
        let mut row: Value = serde_json::from_str(line).unwrap();
        let figures = row["figures"].as_array_mut().unwrap();
        figures.retain(|figure| !figure["what"].as_str().unwrap().starts_with("cost "));
        row
    };
    output.lines().map(row).collect()
}

#[test]
fn rows_as_runs_of_a_plan_have_the_bits_of_rows_in_one_process() {
    let folder = folder();
    let rows = ["extremes", "--json", "--only", "gravity-0", "--only", "no-points", "--only", "mass-0"];
    let one = nucleus(folder.path(), &rows);
    let many = [&rows[..], &["--plan", "p", "--jobs", "2"]].concat();
    let output = nucleus(folder.path(), &many);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert!(stderr(&output).contains("cost of rows is not measured"), "{}", stderr(&output));
    assert!(!stdout(&output).contains("cost per"), "{}", stdout(&output));
    assert_eq!(without_cost(&stdout(&output)), without_cost(&stdout(&one)));
    assert!(folder.path().join("p/wedge.html").is_file());
    // A result that is lost is computed again, and only that one.
    let modified = |run: &str| {
        let path = folder.path().join(format!("p/results/{run}.json"));
        fs::metadata(path).unwrap().modified().unwrap()
    };
    let before = [modified("0000"), modified("0002")];
    fs::remove_file(folder.path().join("p/results/0001.json")).unwrap();
    let again = nucleus(folder.path(), &many);
    assert_eq!((stdout(&again), again.status.code()), (stdout(&output), Some(0)));
    assert_eq!(before, [modified("0000"), modified("0002")]);
    // Alone, a row is timed.
    let alone = ["extremes", "--json", "--only", "gravity-0", "--plan", "alone", "--jobs", "1"];
    assert!(stdout(&nucleus(folder.path(), &alone)).contains("cost per frame over baseline"));
    // A plan of other rows, or a result of another solver, is refused.
    let refusal = |arguments: &[&str]| {
        let output = nucleus(folder.path(), arguments);
        assert_eq!(output.status.code(), Some(2), "{}", stdout(&output));
        stderr(&output)
    };
    let said = refusal(&["extremes", "--only", "gravity-0", "--plan", "p"]);
    assert!(said.contains("has other parts"), "{said}");
    let path = folder.path().join("p/results/0000.json");
    let mut result: Value = serde_json::from_str(&fs::read_to_string(&path).unwrap()).unwrap();
    result["report"]["solver"] = "0123456789abcdef".into();
    fs::write(&path, result.to_string()).unwrap();
    let said = refusal(&many);
    assert!(said.contains("computed by another build"), "{said}");
}
