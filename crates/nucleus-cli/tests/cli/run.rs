//! `nucleus run`.

use std::fs;

use serde_json::Value;

use crate::sample::{assert_refused, folder, nucleus, scene, stderr, stdout};

#[test]
fn a_run_records_a_cache_and_prints_the_command_that_plays_it() {
    let folder = folder();
    scene(folder.path(), 5, "noPenetration, finite");
    let output = nucleus(folder.path(), &["run", "drape.ron"]);
    let said = stdout(&output);
    assert_eq!(output.status.code(), Some(0), "{said}{}", stderr(&output));
    assert!(said.starts_with("frames 1 to 5 in "), "{said}");
    assert!(said.contains("check noPenetration: passed") && said.contains("check finite: passed"), "{said}");
    assert!(said.contains("`nucleus play drape.mcap`"), "{said}");
    let cache = nucleus_cache::Playback::open(folder.path().join("drape.mcap")).unwrap();
    assert!(cache.corruption().is_intact());
    assert_eq!((cache.time_samples().len(), cache.run().scene_path.as_str()), (5, "drape.ron"));
    let names: Vec<_> = cache.objects().iter().map(|object| object.name.as_str()).collect();
    assert_eq!(names, ["cloth1", "rigid1"]);
}

#[test]
fn the_cache_holds_the_scene_it_was_made_from() {
    let folder = folder();
    scene(folder.path(), 2, "");
    nucleus(folder.path(), &["run", "drape.ron", "-o", "x.mcap"]);
    let cache = nucleus_cache::Playback::open(folder.path().join("x.mcap")).unwrap();
    assert_eq!(cache.run().scene_text, fs::read_to_string(folder.path().join("drape.ron")).unwrap());
}

#[test]
fn a_failed_check_exits_with_1_and_shows_its_figure() {
    let folder = folder();
    scene(folder.path(), 5, "atRestBy(frame: 3, speed: 0)");
    let output = nucleus(folder.path(), &["run", "drape.ron"]);
    assert_eq!(output.status.code(), Some(1));
    assert!(stdout(&output).contains("FAILED with "), "{}", stdout(&output));
}

#[test]
fn json_is_an_object_per_frame_and_one_for_the_run() {
    let folder = folder();
    scene(folder.path(), 5, "finite");
    let output = nucleus(folder.path(), &["run", "drape.ron", "--json"]);
    let lines: Vec<Value> =
        stdout(&output).lines().map(|line| serde_json::from_str(line).expect("a line of JSON")).collect();
    let frames: Vec<_> = lines.iter().filter_map(|line| line["frame"].as_i64()).collect();
    assert_eq!(frames, [2, 3, 4, 5]);
    for key in ["candidate_pairs", "pairs_reverted", "depenetrating", "intersections", "sanitized"] {
        assert!(lines[0][key].is_u64(), "{key}: {}", lines[0]);
    }
    let summary = &lines[4]["summary"];
    assert_eq!((&summary["ending"], &summary["last"]), (&Value::from("done"), &Value::from(5)));
    assert_eq!(summary["checks"][0]["passed"], true);
}

#[test]
fn options_select_the_frames_and_the_recorded_times() {
    let folder = folder();
    scene(folder.path(), 5, "");
    let moments = |arguments: &[&str]| {
        let output =
            nucleus(folder.path(), &[&["run", "drape.ron", "-o", "x.mcap", "--force"], arguments].concat());
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        nucleus_cache::Playback::open(folder.path().join("x.mcap")).unwrap().time_samples().len()
    };
    assert_eq!(moments(&["--frames", "3"]), 3);
    assert_eq!(moments(&["--frames", "2..9"]), 8);
    assert_eq!(moments(&["--frames", "3", "--record", "substeps"]), 1 + 2 * 2);
    assert_eq!(moments(&["--record", "every:3"]), 3, "frames 1, 4 and 5");
    let output = nucleus(folder.path(), &["run", "drape.ron", "--record", "none", "-o", "none.mcap"]);
    assert_eq!(output.status.code(), Some(0));
    assert!(!folder.path().join("none.mcap").exists());
}

#[test]
fn an_audit_says_that_nothing_passed_through_anything() {
    let folder = folder();
    scene(folder.path(), 5, "noSelfIntersection");
    let output = nucleus(folder.path(), &["run", "drape.ron", "--audit"]);
    let said = stdout(&output);
    assert_eq!(output.status.code(), Some(0), "{said}{}", stderr(&output));
    assert!(said.contains("audit of 384 steps: nothing passed through anything\n"), "{said}");
    assert!(said.contains("check noSelfIntersection: passed"), "{said}");
    let output = nucleus(folder.path(), &["run", "drape.ron", "--force"]);
    assert!(stdout(&output).contains("check noSelfIntersection: passed"), "{}", stdout(&output));
    assert!(!stdout(&output).contains("audit of"), "`--audit` is not given");
}

#[test]
fn a_finding_of_the_audit_exits_with_1_and_is_named() {
    let folder = folder();
    scene(folder.path(), 5, "");
    // All points of the sheet but one are pinned and the ball is driven through it, so penetration cannot be prevented.
    let path = folder.path().join("drape.ron");
    let text = fs::read_to_string(&path).unwrap();
    let text = text.replace("radius: 20", "radius: 20, translateY: keys([(1, 0), (5, 60)])");
    let held = r#""k": dynamicConstraint(constraintType: transform, components: ["cloth1.vtx[0:23]", "cloth1.vtx[25:48]"]),
        "sheet""#;
    fs::write(&path, text.replacen(r#""sheet""#, held, 1)).unwrap();
    let output = nucleus(folder.path(), &["run", "drape.ron", "--audit", "--json"]);
    let last =
        stdout(&output).lines().last().map(|line| serde_json::from_str::<Value>(line).unwrap()).unwrap();
    // The audit sees each time step of four frames: 96 evaluations per frame, some of which adaptive substepping splits
    // into up to eight.
    let audit = &last["summary"]["audit"];
    let steps = audit["steps"].as_u64().expect("a count");
    assert!(steps > 384 && steps <= 8 * 384, "{audit}");
    assert_eq!(output.status.code(), Some(1), "{audit}");
    let first = audit["first"].as_str().expect("there is a first");
    assert!(
        first.starts_with("frame ") && first.contains("cloth1.vtx[") && first.contains("rigid1.vtx["),
        "{first}"
    );
}

#[test]
fn every_number_of_threads_gives_the_same_file() {
    let folder = folder();
    scene(folder.path(), 12, "");
    let file = |threads: &str| {
        nucleus(folder.path(), &["run", "drape.ron", "--threads", threads, "-o", "x.mcap"]);
        fs::read(folder.path().join("x.mcap")).unwrap()
    };
    assert!(file("1") == file("3"));
}

#[test]
fn a_file_that_is_no_cache_is_not_overwritten() {
    let folder = folder();
    scene(folder.path(), 5, "");
    fs::write(folder.path().join("drape.mcap"), "something dear").unwrap();
    let output = nucleus(folder.path(), &["run", "drape.ron"]);
    assert_refused(&output, "`drape.mcap` exists and is not a nucleus cache");
    assert_eq!(fs::read_to_string(folder.path().join("drape.mcap")).unwrap(), "something dear");
}

#[test]
fn a_cache_that_cannot_be_created_is_refused_with_one_reason() {
    let folder = folder();
    scene(folder.path(), 5, "");
    let output = nucleus(folder.path(), &["run", "drape.ron", "-o", "drape.ron/x.mcap"]);
    assert_refused(&output, "cannot make the folder `drape.ron`");
    assert_eq!(stderr(&output).matches("drape.ron").count(), 1);
    let output = nucleus(folder.path(), &["run", "drape.ron", "-o", "made/here/x.mcap"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert!(folder.path().join("made/here/x.mcap").exists());
}

#[test]
fn invalid_option_values_are_refused() {
    let folder = folder();
    scene(folder.path(), 5, "");
    for arguments in [["--frames", "0"], ["--frames", "9..3"], ["--threads", "0"], ["--record", "all"]] {
        let output = nucleus(folder.path(), &[&["run", "drape.ron"], arguments.as_slice()].concat());
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
    }
}

#[test]
fn a_check_of_a_run_of_the_start_frame_alone_is_not_evaluated_and_the_run_ended_as_asked() {
    let folder = folder();
    scene(folder.path(), 9, "finite");
    fs::rename(folder.path().join("drape.ron"), folder.path().join("-dash.ron")).unwrap();
    let output = nucleus(folder.path(), &["run", "./-dash.ron", "--frames", "1"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let said = stdout(&output);
    assert!(said.contains("check finite: not evaluated, the run is the start frame alone"), "{said}");
    assert!(
        said.contains("`nucleus play ./-dash.mcap`"),
        "a name that begins with a dash is no option: {said}"
    );
    let info = nucleus(folder.path(), &["info", "./-dash.mcap"]);
    assert_eq!(info.status.code(), Some(0), "{}", stderr(&info));
}

#[test]
fn a_cache_with_the_name_of_a_picture_is_refused() {
    let folder = folder();
    scene(folder.path(), 2, "");
    let output = nucleus(folder.path(), &["run", "drape.ron", "-o", "drape.png"]);
    assert_refused(&output, "`drape.png` does not end with .mcap");
    assert!(stderr(&output).contains("write `-o drape.mcap`"), "{}", stderr(&output));
    assert!(!folder.path().join("drape.png").exists());
    let output = nucleus(folder.path(), &["run", "drape.ron", "-o", "."]);
    assert_refused(&output, "`.` is a folder: write `-o ./run.mcap`");
}

/// Limits the size of files that the command writes, as a full disk does.
#[cfg(target_os = "linux")]
fn within_blocks(folder: &std::path::Path, blocks: u32, arguments: &str) -> std::process::Output {
    let command = format!("ulimit -f {blocks}; exec {} {arguments}", env!("CARGO_BIN_EXE_nucleus"));
    std::process::Command::new("bash").args(["-c", &command]).current_dir(folder).output().unwrap()
}

#[cfg(target_os = "linux")]
#[test]
fn a_check_of_frames_that_a_full_disk_prevents_is_not_evaluated() {
    let folder = folder();
    scene(folder.path(), 400, "atRestBy(frame: 390, speed: 0.1)");
    let output = within_blocks(folder.path(), 40, "run drape.ron");
    let said = stdout(&output);
    assert_eq!(output.status.code(), Some(1), "{said}{}", stderr(&output));
    assert!(said.contains("atRestBy(frame: 390, speed: 0.1): not evaluated, the run ended before"), "{said}");
    assert!(!said.contains("FAILED"), "{said}");
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_is_a_problem_and_no_wrong_command() {
    let folder = folder();
    scene(folder.path(), 60, "");
    assert_eq!(nucleus(folder.path(), &["run", "drape.ron"]).status.code(), Some(0));
    for command in ["export drape.mcap -o a.usda", "render drape.mcap -o a.png", "render drape.mcap -o a.exr"]
    {
        let output = within_blocks(folder.path(), 2, command);
        assert_eq!(output.status.code(), Some(1), "{command}: {}", stderr(&output));
    }
    assert_eq!(nucleus(folder.path(), &["render", "no.mcap"]).status.code(), Some(2));
}
