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
