//! `nucleus validate`: its parts as runs of a plan. The measure crate tests the cases.

use std::fs;

use serde_json::Value;

use crate::sample::{assert_refused, folder, nucleus, stderr, stdout};

const CASES: [&str; 4] = ["validate", "--json", "--only", "incline,restitution"];

#[test]
fn cases_as_runs_of_a_plan_have_the_bits_of_cases_in_one_process() {
    let folder = folder();
    let one = nucleus(folder.path(), &CASES);
    let many = [&CASES[..], &["--plan", "p", "--jobs", "2"]].concat();
    let output = nucleus(folder.path(), &many);
    assert_eq!(
        (output.status.code(), stdout(&output)),
        (one.status.code(), stdout(&one)),
        "{}",
        stderr(&output)
    );
    let plan: Value =
        serde_json::from_str(&fs::read_to_string(folder.path().join("p/plan.json")).unwrap()).unwrap();
    assert_eq!(plan["runs"][1]["arguments"], serde_json::json!(["validate", "--only", "restitution"]));
}

#[test]
fn a_part_that_fails_is_named_and_its_folder_keeps_the_others() {
    let folder = folder();
    let many = [&CASES[..], &["--plan", "p", "--jobs", "1"]].concat();
    assert_eq!(nucleus(folder.path(), &many).status.code(), Some(0));
    // Where a folder is in its way, a part cannot write its result.
    let result = folder.path().join("p/results/0001.json");
    let kept = fs::read(&result).unwrap();
    fs::remove_file(&result).unwrap();
    fs::create_dir_all(result.join("x")).unwrap();
    let output = nucleus(folder.path(), &many);
    assert_eq!(output.status.code(), Some(2), "{}{}", stdout(&output), stderr(&output));
    assert!(stderr(&output).contains("0001.json"), "{}", stderr(&output));
    fs::remove_dir_all(&result).unwrap();
    fs::write(&result, kept).unwrap();
    assert_eq!(nucleus(folder.path(), &many).status.code(), Some(0));
}

#[test]
fn a_place_needs_a_plan() {
    let folder = folder();
    let output = nucleus(folder.path(), &["validate", "--on", "slurm"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("--plan <FOLDER>"), "{}", stderr(&output));
    assert_refused(&nucleus(folder.path(), &["validate", "--only", "none"]), "there is no case `none`");
}
