//! `nucleus trade`, and `nucleus run --quality`.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::process::{Command, Output, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

use crate::sample::{folder, scene, stderr, stdout};

/// `nucleus` with these arguments, which stores results in `folder`.
fn nucleus(folder: &Path, arguments: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_nucleus"));
    command.env("NUCLEUS_CACHE", folder.join("kept")).args(arguments).current_dir(folder);
    command.output().unwrap()
}

/// A short sweep.
const SMALL: [&str; 8] = ["trade", "drape.ron", "--evaluations", "6,12", "--substeps", "1", "--frames", "8"];

/// The stored runs, one per line.
#[cfg(unix)]
fn kept_text(folder: &Path) -> String {
    let Ok(all) = fs::read_dir(folder.join("kept").join("trade")) else { return String::new() };
    all.map(|entry| fs::read_to_string(entry.unwrap().path().join("runs.jsonl")).unwrap_or_default())
        .collect()
}

/// Lines of a stored list, over all scenes.
fn kept_lines(folder: &Path, name: &str) -> usize {
    let all = fs::read_dir(folder.join("kept").join("trade")).unwrap();
    let lines = |folder: fs::DirEntry| fs::read_to_string(folder.path().join(name)).unwrap().lines().count();
    all.map(|entry| lines(entry.unwrap())).sum()
}

#[test]
fn a_sweep_writes_a_page_a_table_and_json_and_recommends_a_setting() {
    let folder = folder();
    scene(folder.path(), 24, "");
    let output = nucleus(folder.path(), &SMALL);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let said = stdout(&output);
    for words in [
        "position over frames 2 to ",
        " (the references diverge after)",
        "stretch and energy over frames 2 to 8",
        "The two references differ by: position ",
        "worst stretch",
        "silhouette",
        "an error of 1 %",
        "12 evaluations in 1 substep",
        "created energy",
        "to 0.1 %",
    ] {
        assert!(said.contains(words), "{words}: {said}");
    }
    let read = |end: &str| fs::read_to_string(folder.path().join(format!("drape.trade.{end}"))).unwrap();
    let html = read("html");
    assert!(html.matches("data:image/png;base64,").count() >= 2 && html.contains("<svg"));
    assert!(!html.contains("http://") && !html.contains("https://"), "the page is self-contained");
    // The header, two settings and that of the scene.
    assert_eq!(read("csv").lines().count(), 4);
    let json: serde_json::Value = serde_json::from_str(&read("json")).unwrap();
    assert_eq!(json["points"].as_array().unwrap().len(), 3);
    assert_eq!((json["scene"].as_str(), json["wanted"]["error"].as_f64()), (Some("drape"), Some(0.01)));
    let recommended = &json["recommendation"];
    let words = recommended["text"].as_str().unwrap();
    assert!(said.contains(words), "{words}: {said}");
    assert!(
        ["found", "nearest", "unresolved"].contains(&recommended["choice"].as_str().unwrap()),
        "{recommended}"
    );
    let is_recommended = |point: &serde_json::Value| *point == recommended["point"];
    assert!(json["points"].as_array().unwrap().iter().any(is_recommended));
    // Nothing measures the finer reference.
    assert_eq!(
        (&json["reference"]["error"], json["reference"]["errors"].as_array().unwrap().len()),
        (&serde_json::Value::Null, 0)
    );
}

/// A sheet that falls for 1.2 seconds, onto a ball.
const LATE: &str = r#"Scene(
    time: (start: 1, end: 48, fps: 24),
    nodes: {
        "nucleus1": nucleus(spaceScale: 0.01, evaluations: 24, subSteps: 1),
        "plane": polyPlane(width: 100, height: 100, subdivisions: (8, 8), translate: (0, 730, 0)),
        "sheet": nCloth(inputMesh: "plane", selfCollide: false),
        "sphere": polySphere(radius: 30, subdivisions: (12, 8)),
        "ball": nRigid(inputMesh: "sphere"),
    },
)
"#;

#[test]
fn by_default_the_frames_up_to_the_largest_strain_are_compared() {
    let folder = folder();
    fs::write(folder.path().join("late.ron"), LATE).unwrap();
    let sweep = ["trade", "late.ron", "--evaluations", "12", "--substeps", "1", "--json"];
    let output = nucleus(folder.path(), &sweep);
    let json: serde_json::Value =
        serde_json::from_str(&stdout(&output)).unwrap_or_else(|error| panic!("{error}: {}", stderr(&output)));
    let last = json["frames"][1].as_i64().unwrap();
    assert!((31..48).contains(&last), "{}", stderr(&output));
    let said = format!("comparing frames 1 to {last}: the cloth is stretched most at frame ");
    assert!(stderr(&output).contains(&said), "{}", stderr(&output));
    // Frames that are asked for are compared, and the survey is kept.
    let asked = nucleus(folder.path(), &[&sweep[..], &["--frames", "8"]].concat());
    assert!(!stderr(&asked).contains("comparing frames"), "{}", stderr(&asked));
    assert_eq!(kept_lines(folder.path(), "surveys.jsonl"), 1);
    nucleus(folder.path(), &sweep);
    assert_eq!(kept_lines(folder.path(), "surveys.jsonl"), 1);
}

#[test]
fn a_sweep_uses_the_stored_results_of_an_earlier_one() {
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

#[test]
fn a_run_in_double_precision_at_the_setting_of_the_reference_has_its_bits_and_resumes() {
    let folder = folder();
    scene(folder.path(), 8, "");
    let output = nucleus(folder.path(), &SMALL);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let json = fs::read_to_string(folder.path().join("drape.trade.json")).unwrap();
    let trade: serde_json::Value = serde_json::from_str(&json).unwrap();
    let (reference, setting) = (&trade["reference"], &trade["reference"]["setting"]);
    let path = folder.path().join("drape.ron");
    let quality = format!("subSteps: {}, evaluations: {}", setting["substeps"], setting["evaluations"]);
    let text = fs::read_to_string(&path).unwrap().replace("subSteps: 2", &quality);
    fs::write(&path, text).unwrap();

    let hash = |arguments: &[&str]| {
        let run = nucleus(folder.path(), arguments);
        assert_eq!(run.status.code(), Some(0), "{}", stderr(&run));
        let last = stdout(&run).lines().last().unwrap().to_owned();
        let summary: serde_json::Value = serde_json::from_str(&last).unwrap();
        summary["summary"]["state_hash"].clone()
    };
    let run = ["run", "drape.ron", "--scalar", "f64", "--checkpoint", "3", "--json", "-o", "x.mcap"];
    assert_eq!(hash(&run), reference["hash"]);
    assert_eq!(hash(&["resume", "x.mcap", "--at", "5", "--json"]), reference["hash"]);
    assert_ne!(hash(&["run", "drape.ron", "--json", "--record", "none"]), reference["hash"]);
}

#[cfg(unix)]
#[test]
fn an_interrupted_sweep_continues_with_its_stored_runs() {
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
        "--error",
        "1000%",
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
    assert!(stderr(&stopped).contains("finished runs are stored"), "{}", stderr(&stopped));
    assert!(!folder.path().join("drape.trade.html").exists(), "an interrupted sweep writes no page");

    let kept = kept_text(folder.path());
    // 30 requested settings, and that of the scene, which has 2 substeps.
    assert!(kept.lines().count() < 31, "the sweep was interrupted before its end");
    let again = nucleus(folder.path(), &sweep);
    assert_eq!(again.status.code(), Some(0), "{}", stderr(&again));
    let all = kept_text(folder.path());
    assert!(all.starts_with(&kept), "stored runs are unchanged");
    assert_eq!(all.lines().count(), 31);
}

#[test]
fn a_found_setting_serves_run_quality_and_is_written_into_the_scene() {
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
    let exact = nucleus(folder.path(), &["run", "drape.ron", "--quality", "0.0001%", "--record", "none"]);
    let said = stderr(&exact);
    assert_eq!(exact.status.code(), Some(2), "{said}");
    for part in [
        "do not resolve an error of 0.0001 %",
        "position below",
        "`nucleus trade drape.ron --error 0.0001% --thorough`",
    ] {
        assert!(said.contains(part), "{part}: {said}");
    }

    let read = |name: &str| fs::read_to_string(folder.path().join(name)).unwrap();
    let (scene, other) = (read("drape.ron"), read("other.ron"));
    let changed: Vec<_> = scene.lines().zip(other.lines()).filter(|(a, b)| a != b).collect();
    // Only the line of the nucleus may change, and only if the found setting differs from that of the scene.
    assert!(changed.len() <= 1, "{other}");
    assert!(changed.iter().all(|(_, line)| line.contains("nucleus(spaceScale: 0.01, subSteps: ")), "{other}");
    // The stored results of the scene apply to it at its new setting.
    let other = nucleus(folder.path(), &["run", "other.ron", "--quality", "50%", "--record", "none"]);
    assert_eq!(other.status.code(), Some(0), "{}", stderr(&other));
}

#[test]
fn a_run_with_quality_resumes_at_its_setting_without_the_stored_results() {
    let folder = folder();
    scene(folder.path(), 24, "");
    // The setting of the scene is in every sweep. Many evaluations make it more expensive than the others.
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
    assert_eq!(diff.status.code(), Some(1), "the setting differs from that of the scene: {}", stdout(&diff));

    fs::remove_dir_all(folder.path().join("kept")).unwrap();
    for at in ["5", "13", "24"] {
        let resumed = nucleus(folder.path(), &["resume", "x.mcap", "--at", at]);
        assert_eq!(resumed.status.code(), Some(0), "{}", stderr(&resumed));
        assert!(fs::read(folder.path().join("x.mcap")).unwrap() == whole, "from frame {at}");
    }
}

#[test]
fn an_error_or_time_that_no_setting_reaches_exits_with_1_and_the_nearest() {
    let folder = folder();
    scene(folder.path(), 24, "");
    let wishes = [
        (["--time", "0.00001ms"], "no setting reaches a time of 0.00001 ms; the nearest: "),
        (["--error", "0.0000001%"], "the references do not resolve an error of 0.0000001 %"),
        (["--strain", "0.0000001%"], "the references do not resolve stretch within 0.0000001 %"),
    ];
    for (wish, words) in wishes {
        let output = nucleus(folder.path(), &[&SMALL[..], &wish].concat());
        assert_eq!(output.status.code(), Some(1), "{}", stderr(&output));
        assert!(stdout(&output).contains(words), "{}", stdout(&output));
    }
}

#[test]
fn a_sweep_without_a_recommendation_exits_with_1_whatever_was_asked() {
    let folder = folder();
    fs::write(folder.path().join("drape.ron"), SWING).unwrap();
    let sweep = ["trade", "drape.ron", "--evaluations", "1", "--substeps", "1"];
    let output = nucleus(folder.path(), &[&sweep[..], &["--json"]].concat());
    let json: serde_json::Value =
        serde_json::from_str(&stdout(&output)).unwrap_or_else(|error| panic!("{error}: {}", stderr(&output)));
    assert_ne!(json["recommendation"]["choice"], "found");
    assert_eq!(output.status.code(), Some(1));
    let said = stdout(&nucleus(folder.path(), &sweep));
    assert!(!said.contains("within their noise"), "{said}");
    let met = nucleus(folder.path(), &[&sweep[..], &["--error", "1000%"]].concat());
    assert_eq!(met.status.code(), Some(0), "{}", stdout(&met));
}

#[test]
fn particles_whose_motions_diverge_get_no_recommendation_and_no_file() {
    let folder = folder();
    // Elastic beads that bounce off each other: the references differ by more than a bead after a few hits.
    let beads = r#"Scene(time: (start: 1, end: 48, fps: 24), nodes: {
        "n": nucleus(spaceScale: 0.01, usePlane: true),
        "beads": nParticle(
            position0: [(0, 8, 0), (0.3, 11, 0), (0, 14, 0.3), (0.1, 17, 0), (0, 20, 0.2), (0.2, 23, 0.1), (0, 26, 0),
                (0.1, 29, 0.2)],
            radius: 1.3, pointMass: 0.003, friction: 0, drag: 0, bounce: 1)})"#;
    fs::write(folder.path().join("beads.ron"), beads).unwrap();
    let sweep = ["trade", "beads.ron", "--evaluations", "6,12", "--substeps", "1"];
    for error in ["1%", "0.1%"] {
        let output =
            nucleus(folder.path(), &[&sweep[..], &["--error", error, "--apply", "other.ron"]].concat());
        assert_eq!(output.status.code(), Some(1), "{}", stderr(&output));
        let said = stdout(&output);
        assert!(said.contains("position in no frame"), "{said}");
        assert!(
            said.contains("position is not measured: there is no recommendation for an error of"),
            "{said}"
        );
        assert!(!said.contains("stretch") && said.contains("to 1 %: not resolved"), "{said}");
        assert!(!folder.path().join("other.ron").exists());
    }
}

#[test]
fn a_scene_that_cannot_be_compared_exits_with_1_and_a_reason() {
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
    // A sheet under a hundred times its weight with one evaluation does not converge at two or at four.
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

/// The points of a sweep without their times, which no two sweeps share, by setting.
fn points(folder: &Path) -> Vec<serde_json::Value> {
    let text = fs::read_to_string(folder.join("drape.trade.json")).unwrap();
    let trade: serde_json::Value = serde_json::from_str(&text).unwrap();
    let mut points = trade["points"].as_array().unwrap().clone();
    for point in &mut points {
        point.as_object_mut().unwrap().retain(|name, _| name != "ms" && name != "on_frontier");
    }
    points.sort_by_key(|point| point["setting"].to_string());
    points.push(trade["measure"].clone());
    points.push(trade["apart"].clone());
    points
}

#[test]
fn a_sweep_as_runs_of_plans_has_the_bits_of_one_process() {
    let (one, many) = (folder(), folder());
    for folder in [&one, &many] {
        scene(folder.path(), 24, "");
    }
    assert_eq!(nucleus(one.path(), &SMALL).status.code(), Some(0));
    let planned = [&SMALL[..], &["--plan", "p", "--jobs", "2"]].concat();
    let output = nucleus(many.path(), &planned);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert!(stderr(&output).contains("each runs alone"), "{}", stderr(&output));
    assert_eq!(points(many.path()), points(one.path()));
    let result = |stage: &str, run: u32| -> serde_json::Value {
        let path = many.path().join(format!("p/{stage}/results/{run:04}.json"));
        serde_json::from_str(&fs::read_to_string(path).unwrap()).unwrap()
    };
    let at_once = [result("references", 1), result("settings", 2)].map(|found| found["at_once"].clone());
    assert_eq!(at_once, [2, 1]);
    // The store has them too, so nothing is left to do.
    let again = nucleus(many.path(), &SMALL);
    assert_eq!((again.status.code(), stdout(&again)), (Some(0), stdout(&output)));
    let rerun = nucleus(many.path(), &[&planned[..], &["--rerun"]].concat());
    assert!(stderr(&rerun).contains("name another folder"), "{}", stderr(&rerun));
}

#[test]
fn a_later_sweep_keeps_the_settings_of_an_earlier_one_for_run_quality() {
    let folder = folder();
    scene(folder.path(), 24, "");
    let evaluations = |list: &str| {
        let sweep = ["trade", "drape.ron", "--evaluations", list, "--substeps", "1", "--frames", "8"];
        let output = nucleus(folder.path(), &sweep);
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        let all = fs::read_dir(folder.path().join("kept").join("trade")).unwrap();
        let curves: Vec<_> = all.map(|entry| entry.unwrap().path().join("trade.json")).collect();
        let [curve] = &curves[..] else { panic!("{curves:?}") };
        let curve: serde_json::Value = serde_json::from_str(&fs::read_to_string(curve).unwrap()).unwrap();
        let mut found: Vec<f64> = curve["points"]
            .as_array()
            .unwrap()
            .iter()
            .map(|point| point["setting"]["evaluations"].as_f64().unwrap())
            .collect();
        found.sort_by(f64::total_cmp);
        found.dedup();
        found
    };
    let both = evaluations("6,12");
    assert!(both.contains(&6.0) && both.contains(&12.0), "{both:?}");
    assert_eq!(evaluations("12"), both);
}

#[test]
fn an_error_without_its_percent_sign_is_refused() {
    let folder = folder();
    scene(folder.path(), 24, "");
    for arguments in [["trade", "drape.ron", "--error", "2"], ["run", "drape.ron", "--quality", "2"]] {
        let output = nucleus(folder.path(), &arguments);
        assert_eq!(output.status.code(), Some(2));
        assert!(stderr(&output).contains("2 means 200 %: write `2%`"), "{}", stderr(&output));
    }
}

#[test]
fn another_scene_is_replaced_by_apply_only_when_forced() {
    let folder = folder();
    scene(folder.path(), 24, "");
    let other = folder.path().join("other.ron");
    fs::write(&other, "Scene(nodes: {})").unwrap();
    let apply = [&SMALL[..], &["--error", "50%", "--apply", "other.ron"]].concat();
    let refused = nucleus(folder.path(), &apply);
    assert_eq!(refused.status.code(), Some(2), "{}", stderr(&refused));
    assert!(
        stderr(&refused).contains("`other.ron` exists; replace it with `--force`"),
        "{}",
        stderr(&refused)
    );
    assert_eq!(fs::read_to_string(&other).unwrap(), "Scene(nodes: {})");
    assert!(!folder.path().join("kept").exists(), "it is refused before the runs");
    let forced = nucleus(folder.path(), &[&apply[..], &["--force"]].concat());
    assert_eq!(forced.status.code(), Some(0), "{}", stderr(&forced));
    let said = stderr(&forced);
    assert!(
        said.contains("wrote `drape.ron` with ") && said.contains(" to `other.ron`, which it replaces"),
        "{said}"
    );
    assert!(fs::read_to_string(&other).unwrap().contains("cloth1"));
    // The scene itself is what `--apply` is for, also by another path.
    let own = nucleus(folder.path(), &[&SMALL[..], &["--error", "50%", "--apply", "./drape.ron"]].concat());
    assert_eq!(own.status.code(), Some(0), "{}", stderr(&own));
    assert!(stderr(&own).contains("into `drape.ron`"), "{}", stderr(&own));
}

/// A sheet that swings down from two corners.
const SWING: &str = r#"Scene(
    time: (start: 1, end: 7, fps: 24),
    nodes: {
        "nucleus1": nucleus(spaceScale: 0.01),
        "plane": polyPlane(width: 30, height: 30, subdivisions: (4, 4)),
        "sheet": nCloth(inputMesh: "plane", selfCollide: false),
        "pins": dynamicConstraint(constraintType: transform, components: ["sheet.corners"]),
    },
)
"#;

#[test]
fn a_refined_sweep_as_runs_of_plans_has_the_rounds_the_references_and_the_bits_of_one_process() {
    let (one, many) = (folder(), folder());
    for folder in [&one, &many] {
        fs::write(folder.path().join("drape.ron"), SWING).unwrap();
    }
    let plain = nucleus(one.path(), &["trade", "drape.ron"]);
    let planned = nucleus(many.path(), &["trade", "drape.ron", "--plan", "p", "--jobs", "2"]);
    assert_eq!([plain.status.code(), planned.status.code()], [Some(0); 2], "{}", stderr(&planned));
    let rounds = ["references", "settings", "settings-1"];
    for stage in rounds {
        assert!(many.path().join("p").join(stage).join("plan.json").exists(), "{stage}");
    }
    let references = [&one, &many].map(|folder| kept_lines(folder.path(), "references.jsonl"));
    assert_eq!(references, [2, 2], "no reference is finer than needed");
    // Which settings the rounds add depends on times, which differ; what both have tried has the same bits.
    let (ours, theirs) = (points(one.path()), points(many.path()));
    assert_eq!(ours[ours.len() - 2..], theirs[theirs.len() - 2..], "the noise and the horizon");
    let setting = |point: &serde_json::Value| point["setting"].clone();
    let shared = ours.iter().filter(|point| point["setting"].is_object());
    let shared = shared
        .filter_map(|point| Some((point, theirs.iter().find(|other| setting(other) == setting(point))?)));
    let shared: Vec<_> = shared.collect();
    assert!(shared.len() >= 10, "{} of {} and {}", shared.len(), ours.len(), theirs.len());
    assert!(shared.iter().all(|(ours, theirs)| ours == theirs));
    // Finished stages are read, not done again, by a machine without the store.
    fs::rename(many.path().join("kept"), many.path().join("gone")).unwrap();
    let again = nucleus(many.path(), &["trade", "drape.ron", "--plan", "p", "--jobs", "2"]);
    assert_eq!(again.status.code(), Some(0), "{}", stderr(&again));
    assert_eq!(points(many.path()), theirs);
}

#[test]
fn a_range_of_frames_is_compared_after_the_frames_that_lead_to_it() {
    let folder = folder();
    scene(folder.path(), 24, "");
    let sweep = |frames: &str| {
        let arguments =
            ["trade", "drape.ron", "--evaluations", "12", "--substeps", "1", "--frames", frames, "--json"];
        let output = nucleus(folder.path(), &arguments);
        let json: serde_json::Value = serde_json::from_str(&stdout(&output))
            .unwrap_or_else(|error| panic!("{error}: {}", stderr(&output)));
        json
    };
    let (whole, late) = (sweep("1..12"), sweep("9..12"));
    assert_eq!(
        (&whole["frames"], &late["frames"]),
        (&serde_json::json!([1, 12]), &serde_json::json!([8, 12]))
    );
    // The runs are the same, so they end with the same bits. Their order follows from errors and times.
    let hashes = |json: &serde_json::Value| -> BTreeMap<String, String> {
        let points = json["points"].as_array().unwrap().iter();
        points.map(|point| (point["setting"].to_string(), point["hash"].to_string())).collect()
    };
    assert_eq!(hashes(&whole).len(), 2, "the setting that is asked for, and that of the scene");
    assert_eq!(hashes(&late), hashes(&whole));
    // A frame of the range has the distance from the reference that it has in the whole.
    let apart = |json: &serde_json::Value| json["apart"].as_array().unwrap().clone();
    assert_eq!(apart(&late)[..], apart(&whole)[7..]);
}

/// The row of a list for this error, without `to 1 %: `.
fn row<'a>(said: &'a str, error: &str) -> &'a str {
    let start = format!("to {error}: ");
    said.lines().find_map(|line| line.strip_prefix(&start)).unwrap_or_else(|| panic!("{start}{said}"))
}

#[test]
fn the_recommendation_and_the_list_are_the_same_whatever_error_was_asked_for() {
    let folder = folder();
    fs::write(folder.path().join("drape.ron"), SWING).unwrap();
    let trade = |error: &str| {
        let output = nucleus(folder.path(), &["trade", "drape.ron", "--error", error]);
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        let text = fs::read_to_string(folder.path().join("drape.trade.json")).unwrap();
        let json: serde_json::Value = serde_json::from_str(&text).unwrap();
        (stdout(&output), json["points"].clone(), json["recommendation"]["point"].clone())
    };
    trade("1%");
    trade("10%");
    let (one, ten, again) = (trade("1%"), trade("10%"), trade("1%"));
    assert_eq!(one.1, ten.1, "both show the runs of both");
    assert_eq!(one, again);
    for error in ["10 %", "1 %", "0.1 %"] {
        assert_eq!(row(&one.0, error), row(&ten.0, error));
    }
    for (error, (said, _, point)) in [("1 %", &one), ("10 %", &ten)] {
        let (_, with) = row(said, error).split_once(" ms per frame with ").unwrap();
        let evaluations = format!(
            "{} evaluations in {} substep",
            point["setting"]["evaluations"], point["setting"]["substeps"]
        );
        assert!(with.starts_with(&evaluations.replace(".0 ", " ")), "{with}: {point}");
    }
}

#[test]
fn a_recommendation_and_its_page_say_what_the_references_do_not_resolve() {
    let folder = folder();
    fs::write(folder.path().join("drape.ron"), SWING).unwrap();
    let output = nucleus(folder.path(), &["trade", "drape.ron"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let said = stdout(&output);
    let percent = |text: &str, after: &str| -> f64 {
        let found = text.split_once(after).unwrap_or_else(|| panic!("{after}: {said}")).1;
        found.split_once(" %").unwrap().0.parse().unwrap()
    };
    let floors = said.lines().find(|line| line.starts_with("The two references differ by: ")).unwrap();
    let words = "as far as the references resolve it (not silhouette below ";
    let sentence = said.lines().find(|line| line.starts_with("recommended for an error of 1 %, ")).unwrap();
    let (floor, bound) = (percent(floors, "silhouette "), percent(sentence, words));
    assert!((bound - 4.0 * floor).abs() < 0.01, "four times {floor} are not {bound}");
    assert!(row(&said, "1 %").ends_with(&format!(", {words}{bound} %)")), "{said}");
    let html = fs::read_to_string(folder.path().join("drape.trade.html")).unwrap();
    assert!(html.contains(words), "the page says so too");
    assert!(html.contains("<tr><th>setting</th><th>ms</th>"), "the setting is the first column");
    // The recommended setting has a resolved error far below the bound of its silhouette.
    assert!(html.contains("<path class=\"reach\"") && html.contains("may be as large"), "{html}");
}
