//! `nucleus trade`, and `nucleus run --quality`.

use std::fs;
use std::path::Path;
use std::process::{Command, Output, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

use crate::sample::{folder, scene, stderr, stdout};

/// `nucleus` with these arguments; what it keeps is kept in the folder too.
fn nucleus(folder: &Path, arguments: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_nucleus"));
    command.env("NUCLEUS_CACHE", folder.join("kept")).args(arguments).current_dir(folder);
    command.output().unwrap()
}

/// A sweep that takes a moment.
const SMALL: [&str; 8] = ["trade", "drape.ron", "--evaluations", "6,12", "--substeps", "1", "--frames", "8"];

/// The runs that are kept so far, a line each.
#[cfg(unix)]
fn kept_text(folder: &Path) -> String {
    let Ok(all) = fs::read_dir(folder.join("kept").join("trade")) else { return String::new() };
    all.map(|entry| fs::read_to_string(entry.unwrap().path().join("runs.jsonl")).unwrap_or_default())
        .collect()
}

/// Lines of a list that is kept, in whichever folder.
fn kept_lines(folder: &Path, name: &str) -> usize {
    let all = fs::read_dir(folder.join("kept").join("trade")).unwrap();
    let lines = |folder: fs::DirEntry| fs::read_to_string(folder.path().join(name)).unwrap().lines().count();
    all.map(|entry| lines(entry.unwrap())).sum()
}

#[test]
fn a_sweep_writes_a_page_with_pictures_a_table_and_json_and_says_what_to_take() {
    let folder = folder();
    scene(folder.path(), 24, "");
    let output = nucleus(folder.path(), &SMALL);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let said = stdout(&output);
    for words in ["an error of 1 %", "12 evaluations in 1 substep", "created energy", "to 0.1 %"] {
        assert!(said.contains(words), "{words}: {said}");
    }
    let read = |end: &str| fs::read_to_string(folder.path().join(format!("drape.trade.{end}"))).unwrap();
    let html = read("html");
    assert!(html.matches("data:image/png;base64,").count() >= 2 && html.contains("<svg"));
    assert!(!html.contains("http://") && !html.contains("https://"), "the page needs nothing from elsewhere");
    // The head, two settings and the scene's own.
    assert_eq!(read("csv").lines().count(), 4);
    let json: serde_json::Value = serde_json::from_str(&read("json")).unwrap();
    assert_eq!(json["points"].as_array().unwrap().len(), 3);
}

#[test]
fn a_sweep_goes_on_where_it_was() {
    let folder = folder();
    scene(folder.path(), 24, "");
    let first = nucleus(
        folder.path(),
        &["trade", "drape.ron", "--evaluations", "12", "--substeps", "1", "--frames", "8"],
    );
    assert_eq!(first.status.code(), Some(0), "{}", stderr(&first));
    assert_eq!(
        (kept_lines(folder.path(), "runs.jsonl"), kept_lines(folder.path(), "references.jsonl")),
        (2, 2)
    );
    nucleus(folder.path(), &SMALL);
    assert_eq!(
        (kept_lines(folder.path(), "runs.jsonl"), kept_lines(folder.path(), "references.jsonl")),
        (3, 2)
    );
    let again = nucleus(folder.path(), &SMALL);
    assert_eq!((again.status.code(), kept_lines(folder.path(), "runs.jsonl")), (Some(0), 3));
}

/// A sweep that is stopped when its first run has been kept, and done again.
#[cfg(unix)]
#[test]
fn a_sweep_that_is_interrupted_says_so_and_goes_on_with_what_it_had() {
    let folder = folder();
    scene(folder.path(), 48, "");
    let evaluations: Vec<String> = (1..=30).map(|k| (3 * k).to_string()).collect();
    let evaluations = evaluations.join(",");
    let sweep = [
        "trade",
        "drape.ron",
        "--jobs",
        "1",
        "--substeps",
        "1",
        "--frames",
        "48",
        "--evaluations",
        &evaluations,
    ];
    let mut command = Command::new(env!("CARGO_BIN_EXE_nucleus"));
    command.env("NUCLEUS_CACHE", folder.path().join("kept")).args(sweep).current_dir(folder.path());
    let child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    let begin = Instant::now();
    while kept_text(folder.path()).lines().count() == 0 {
        assert!(begin.elapsed() < Duration::from_secs(120), "no run of the sweep ends");
        sleep(Duration::from_millis(2));
    }
    let sent = Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap();
    assert!(sent.success());
    let stopped = child.wait_with_output().unwrap();
    assert_eq!(stopped.status.code(), Some(130), "{}", stderr(&stopped));
    assert!(stderr(&stopped).contains("what was finished is kept"), "{}", stderr(&stopped));
    assert!(!folder.path().join("drape.trade.html").exists(), "half a sweep is no report");

    let kept = kept_text(folder.path());
    // 30 that were asked for; the scene's own has 96 evaluations too, but 2 substeps.
    assert!(kept.lines().count() < 31, "it was stopped before it ended");
    let again = nucleus(folder.path(), &sweep);
    assert_eq!(again.status.code(), Some(0), "{}", stderr(&again));
    let all = kept_text(folder.path());
    assert!(all.starts_with(&kept), "what was kept is as it was");
    assert_eq!(all.lines().count(), 31);
}

#[test]
fn what_is_found_serves_a_run_of_some_quality_and_is_written_into_the_scene() {
    let folder = folder();
    scene(folder.path(), 24, "");
    let before = nucleus(folder.path(), &["run", "drape.ron", "--quality", "50%"]);
    assert_eq!(before.status.code(), Some(2));
    assert!(stderr(&before).contains("run `nucleus trade drape.ron` first"), "{}", stderr(&before));

    let sweep = nucleus(folder.path(), &[&SMALL[..], &["--error", "50%", "--apply", "other.ron"]].concat());
    assert_eq!(sweep.status.code(), Some(0), "{}", stderr(&sweep));
    let run = nucleus(folder.path(), &["run", "drape.ron", "--quality", "50%", "--record", "none"]);
    assert_eq!(run.status.code(), Some(0), "{}", stderr(&run));
    assert!(stderr(&run).contains(" evaluations in "), "{}", stderr(&run));

    let read = |name: &str| fs::read_to_string(folder.path().join(name)).unwrap();
    let (scene, other) = (read("drape.ron"), read("other.ron"));
    let changed: Vec<_> = scene.lines().zip(other.lines()).filter(|(a, b)| a != b).collect();
    // At most the nucleus is another; nothing is where the setting found is the scene's own.
    assert!(changed.len() <= 1, "{other}");
    assert!(changed.iter().all(|(_, line)| line.contains("nucleus(spaceScale: 0.01, subSteps: ")), "{other}");
    // The scene at its new setting is still the same scene.
    let other = nucleus(folder.path(), &["run", "other.ron", "--quality", "50%", "--record", "none"]);
    assert_eq!(other.status.code(), Some(0), "{}", stderr(&other));
}

#[test]
fn a_run_of_some_quality_goes_on_at_the_setting_it_had_even_where_the_trade_is_forgotten() {
    let folder = folder();
    scene(folder.path(), 24, "");
    // The scene's own setting is in every sweep: it is made so dear that another is cheaper, however the clock runs.
    let path = folder.path().join("drape.ron");
    let dear = fs::read_to_string(&path).unwrap().replace("subSteps: 2", "subSteps: 2, evaluations: 960");
    fs::write(&path, dear).unwrap();
    let sweep = nucleus(folder.path(), &SMALL);
    assert_eq!(sweep.status.code(), Some(0), "{}", stderr(&sweep));
    let arguments = ["run", "drape.ron", "--quality", "90%", "--checkpoint", "8", "-o", "x.mcap"];
    let run = nucleus(folder.path(), &arguments);
    assert_eq!(run.status.code(), Some(0), "{}", stderr(&run));
    let whole = fs::read(folder.path().join("x.mcap")).unwrap();
    let plain = nucleus(folder.path(), &["run", "drape.ron", "-o", "plain.mcap"]);
    assert_eq!(plain.status.code(), Some(0), "{}", stderr(&plain));
    let diff = nucleus(folder.path(), &["diff", "x.mcap", "plain.mcap"]);
    assert_eq!(diff.status.code(), Some(1), "the setting is another than the scene's: {}", stdout(&diff));

    fs::remove_dir_all(folder.path().join("kept")).unwrap();
    for at in ["5", "13", "24"] {
        let resumed = nucleus(folder.path(), &["resume", "x.mcap", "--at", at]);
        assert_eq!(resumed.status.code(), Some(0), "{}", stderr(&resumed));
        assert!(fs::read(folder.path().join("x.mcap")).unwrap() == whole, "from frame {at}");
    }
}

#[test]
fn what_no_setting_reaches_ends_with_the_nearest_and_exit_code_1() {
    let folder = folder();
    scene(folder.path(), 24, "");
    let wishes = [
        (["--time", "0.00001ms"], "no setting reaches a time of 0.00001 ms; the nearest: "),
        (["--error", "0.0000001%"], "an error of 0.0000001 % cannot be told from none"),
    ];
    for (wish, words) in wishes {
        let output = nucleus(folder.path(), &[&SMALL[..], &wish].concat());
        assert_eq!(output.status.code(), Some(1), "{}", stderr(&output));
        assert!(stdout(&output).contains(words), "{}", stdout(&output));
    }
}

#[test]
fn what_cannot_be_compared_is_said_with_exit_code_1() {
    let folder = folder();
    scene(folder.path(), 24, "");
    let refused = |arguments: &[&str], words: &str| {
        let output = nucleus(folder.path(), arguments);
        assert_eq!(output.status.code(), Some(1), "{}", stderr(&output));
        assert!(stderr(&output).contains(words), "{}", stderr(&output));
    };
    refused(&["trade", "drape.ron", "--frames", "1"], "nothing to compare in 1 frame");
    let bare = "Scene(time: (start: 1, end: 9, fps: 24), nodes: {\"n\": nucleus()})";
    fs::write(folder.path().join("bare.ron"), bare).unwrap();
    refused(&["trade", "bare.ron"], "the scene has no cloth");
    let still = r#"Scene(time: (start: 1, end: 9, fps: 24), nodes: {
        "n": nucleus(gravity: 0), "p": polyPlane(), "c": nCloth(inputMesh: "p")})"#;
    fs::write(folder.path().join("still.ron"), still).unwrap();
    refused(&["trade", "still.ron", "--evaluations", "6"], "no cloth moves");
    // A hundred times its weight on a sheet that is given one sweep a frame: two and four are as far from an end.
    let loose = r#"Scene(time: (start: 1, end: 25, fps: 24), nodes: {
        "n": nucleus(gravity: 980, evaluations: 1, subSteps: 1), "p": polyPlane(subdivisions: (8, 8), rotate: (90, 0, 0)),
        "c": nCloth(inputMesh: "p"),
        "r": dynamicConstraint(constraintType: transform, components: ["c.vtx[0:8]"])})"#;
    fs::write(folder.path().join("loose.ron"), loose).unwrap();
    refused(
        &["trade", "loose.ron", "--evaluations", "1"],
        "the reference does not converge: with 2 and with 4",
    );
}
