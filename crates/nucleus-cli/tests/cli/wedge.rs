//! `nucleus wedge`, and `nucleus run --set`.

use std::fs;
use std::path::Path;
use std::process::{Command, Output};
use std::time::Instant;

use nucleus_cache::Playback;

use crate::sample::{assert_refused, folder, nucleus, scene, stderr, stdout};

/// Four runs over two values each.
const FOUR: [&str; 8] = [
    "wedge",
    "drape.ron",
    "--vary",
    "cloth1.bendResistance=0.1,10",
    "--vary",
    "nucleus1.windSpeed=0..5/2",
    "--out",
    "w",
];

fn wedge(folder: &Path, more: &[&str]) -> Output {
    nucleus(folder, &[&FOUR[..], more].concat())
}

/// The lines of the table, each split at its commas.
fn table(folder: &Path) -> Vec<Vec<String>> {
    let text = fs::read_to_string(folder.join("w/wedge.csv")).unwrap();
    text.lines().map(|line| line.split(',').map(str::to_owned).collect()).collect()
}

#[test]
fn a_wedge_runs_every_row_and_writes_a_page_and_a_table() {
    let folder = folder();
    scene(folder.path(), 5, "finite");
    let output = wedge(folder.path(), &[]);
    assert_eq!(output.status.code(), Some(0), "{}{}", stdout(&output), stderr(&output));
    assert!(stdout(&output).contains("4 runs: 4 success"), "{}", stdout(&output));
    let rows = table(folder.path());
    assert_eq!(rows[0][..4], ["run", "cloth1.bendResistance", "nucleus1.windSpeed", "outcome"]);
    let values: Vec<&[String]> = rows[1..].iter().map(|row| &row[..4]).collect();
    assert_eq!(values[0], ["0000", "0.1", "0", "success"]);
    assert_eq!(values[3], ["0003", "10", "5", "success"]);
    let page = fs::read_to_string(folder.path().join("w/wedge.html")).unwrap();
    assert_eq!(page.matches("<figure").count(), 4);
    let picture = |name: &str| fs::read(folder.path().join(format!("w/pictures/{name}.png"))).unwrap();
    assert!(picture("0000") != picture("0001"), "wind moves the cloth");
    let cache = Playback::open(folder.path().join("w/runs/0003.mcap")).unwrap();
    let set = &cache.run().extra["set"];
    assert_eq!(set, "cloth1.bendResistance=10 nucleus1.windSpeed=5");
    assert!(cache.run().scene_text.contains("bendResistance: 10"), "{}", cache.run().scene_text);
}

#[test]
fn the_table_has_the_volume_error_of_a_liquid_and_none_without_one() {
    let folder = folder();
    scene(folder.path(), 3, "finite");
    let column = |folder: &Path| {
        let table = table(folder);
        let at = table[0].iter().position(|head| head == "volume error").expect("the column is there");
        table[1..].iter().map(|row| row[at].clone()).collect::<Vec<_>>()
    };
    let dry = nucleus(folder.path(), &["wedge", "drape.ron", "--vary", "cloth1.friction=0.1", "--out", "w"]);
    assert!(dry.status.success(), "{}", stderr(&dry));
    assert_eq!(column(folder.path()), [""]);

    let water = r#"Scene(time: (start: 1, end: 12, fps: 24), nodes: {
        "nucleus1": nucleus(spaceScale: 0.01, usePlane: true, evaluations: 16),
        "water": nParticle(enableSPH: true, minimumCorner: (-2, 1, -2), maximumCorner: (2, 5, 2), radius: 0.6,
            pointMass: 0.00045, drag: 0),
    }, checks: [finite, volumeError(frame: 2, share: 0.5)])"#;
    let wet = folder.path().join("wet");
    fs::create_dir(&wet).unwrap();
    fs::write(wet.join("water.ron"), water).unwrap();
    let output = nucleus(&wet, &["wedge", "water.ron", "--vary", "water.viscosity=0,1", "--out", "w"]);
    assert!(output.status.success(), "{}", stderr(&output));
    let errors: Vec<f64> = column(&wet).iter().map(|error| error.parse().expect("a number")).collect();
    assert_eq!(errors.len(), 2);
    // The check reports the same figure.
    let run = nucleus(&wet, &["run", "water.ron", "--set", "water.viscosity=0", "--record", "none"]);
    let said = stdout(&run);
    let at = |before: &str| -> f64 {
        let rest = said.split(before).nth(1).unwrap_or_else(|| panic!("{before}: {said}"));
        rest.split(' ').next().unwrap().parse().unwrap()
    };
    let by_check = at("share: 0.5): passed with ");
    assert!((errors[0] / by_check - 1.0).abs() < 1e-3, "{errors:?} and {by_check}");
    assert!((at("worst volume error of liquids ") / (100.0 * by_check) - 1.0).abs() < 1e-2, "{said}");
}

#[test]
fn the_table_counts_the_frames_that_a_resumed_run_kept() {
    let folder = folder();
    scene(folder.path(), 12, "");
    assert_eq!(wedge(folder.path(), &["--checkpoint", "4"]).status.code(), Some(0));
    // After frame 9.
    cut_short(folder.path(), "0000", 0.8);
    let output = nucleus(folder.path(), &["wedge", "--continue", "--out", "w"]);
    assert_eq!(output.status.code(), Some(0), "{}{}", stdout(&output), stderr(&output));
    let rows = table(folder.path());
    let of = |run: usize, figure: &str| {
        let column = rows[0].iter().position(|name| name == figure).unwrap();
        rows[1 + run][column].parse::<f64>().unwrap()
    };
    assert_eq!((of(0, "frames"), of(1, "frames")), (11.0, 11.0));
    assert!(of(0, "frames timed") < 9.0, "{} frames were solved again", of(0, "frames timed"));
    assert_eq!(of(1, "frames timed"), 11.0);
}

/// Leaves the first `share` of the bytes of a run's cache, as if its process had been killed.
fn cut_short(folder: &Path, run: &str, share: f64) {
    let cache = folder.join(format!("w/runs/{run}.mcap"));
    let bytes = fs::read(&cache).unwrap();
    let kept = (bytes.len() as f64 * share) as usize;
    fs::write(folder.join(format!("w/runs/{run}.mcap.part")), &bytes[..kept]).unwrap();
    fs::remove_file(cache).unwrap();
    fs::remove_file(folder.join(format!("w/results/{run}.json"))).unwrap();
}

#[test]
fn an_error_of_the_system_costs_no_frames_and_a_cache_of_no_use_is_solved_again() {
    let folder = folder();
    scene(folder.path(), 12, "");
    assert_eq!(wedge(folder.path(), &["--checkpoint", "4"]).status.code(), Some(0));
    let read = |name: &str| fs::read(folder.path().join("w/runs").join(name)).unwrap();
    let whole = read("0000.mcap");
    cut_short(folder.path(), "0000", 0.8);
    cut_short(folder.path(), "0001", 0.8);
    let part = read("0000.mcap.part");
    fs::write(folder.path().join("w/runs/0001.mcap.part"), [0; 4096]).unwrap();
    // As on a full disk, the file of the resumed run cannot be created.
    let in_the_way = folder.path().join("w/runs/0000.mcap.resuming");
    fs::create_dir(&in_the_way).unwrap();
    let output = nucleus(folder.path(), &["wedge", "--continue", "--out", "w"]);
    assert!(stdout(&output).contains("4 runs: 3 success, 1 failed"), "{}", stdout(&output));
    assert!(read("0000.mcap.part") == part, "all frames are kept");
    fs::remove_dir(&in_the_way).unwrap();
    let output = nucleus(folder.path(), &["wedge", "--continue", "--out", "w"]);
    assert!(stdout(&output).contains("4 runs: 4 success"), "{}{}", stdout(&output), stderr(&output));
    assert!(read("0000.mcap") == whole);
}

#[test]
fn a_run_of_a_wedge_has_the_bytes_of_the_same_run_by_hand() {
    let folder = folder();
    scene(folder.path(), 5, "");
    assert_eq!(wedge(folder.path(), &[]).status.code(), Some(0));
    let by_hand = ["run", "drape.ron", "--set", "cloth1.bendResistance=10", "--set", "nucleus1.windSpeed=0"];
    let output = nucleus(folder.path(), &[&by_hand[..], &["-o", "hand.mcap"]].concat());
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let bytes = |name: &str| fs::read(folder.path().join(name)).unwrap();
    assert!(bytes("hand.mcap") == bytes("w/runs/0002.mcap"));
    // And an edited scene has the same result.
    let text = fs::read_to_string(folder.path().join("drape.ron")).unwrap();
    let text = text.replace("thickness: 1", "thickness: 1, bendResistance: 10");
    fs::write(folder.path().join("edited.ron"), text).unwrap();
    nucleus(folder.path(), &["run", "edited.ron"]);
    let diff = nucleus(folder.path(), &["diff", "edited.mcap", "hand.mcap"]);
    assert_eq!(diff.status.code(), Some(0), "{}", stdout(&diff));
}

#[test]
fn mistakes_are_refused_before_anything_is_written() {
    let folder = folder();
    scene(folder.path(), 5, "");
    let refusals: [(&[&str], &str); 7] = [
        (&["--vary", "cloth1.bendResistence=1,2"], "did you mean `bendResistance`?"),
        (&["--vary", "clth1.damp=1,2"], "no node `clth1`; did you mean `cloth1`?"),
        (&["--vary", "nucleus1.subSteps=0.5,1"], "a whole number"),
        (&["--vary", "cloth1.damp=0..1"], "--samples 20"),
        (&["--vary", "cloth1.thickness=1,-1"], "must be at least 0"),
        (&["--vary", "cloth1.inputMesh=\"none\",\"sheet\""], "cloth1.inputMesh"),
        (&[], "nothing varies"),
    ];
    for (arguments, words) in refusals {
        let output = nucleus(folder.path(), &[&["wedge", "drape.ron", "--out", "w"], arguments].concat());
        assert_refused(&output, words);
        assert!(!folder.path().join("w").exists(), "{arguments:?}");
    }
    let output = nucleus(folder.path(), &["run", "drape.ron", "--set", "cloth1.damp"]);
    assert!(stderr(&output).contains("node.attribute=value"), "{}", stderr(&output));
    let output = nucleus(folder.path(), &["run", "drape.ron", "--set", "cloth1.dampp=1"]);
    assert_refused(&output, "did you mean `damp`?");
}

#[test]
fn a_run_that_fails_is_named_and_the_others_go_on() {
    let folder = folder();
    scene(folder.path(), 5, "atRestBy(frame: 3, speed: 0)");
    // Where a folder is in its way, the second run cannot write its cache.
    fs::create_dir_all(folder.path().join("w/runs/0001.mcap/x")).unwrap();
    let output = wedge(folder.path(), &[]);
    let said = stdout(&output);
    assert_eq!(output.status.code(), Some(1), "{said}{}", stderr(&output));
    assert!(said.contains("4 runs: 3 problem, 1 failed"), "{said}");
    assert!(said.contains("run 0000: check atRestBy(") && said.contains("run 0001: "), "{said}");
    let page = fs::read_to_string(folder.path().join("w/wedge.html")).unwrap();
    assert!(page.contains("<li class=\"failed\"><a href=\"logs/0001.txt\">"), "{page}");
    // Only the failed run is done again.
    fs::remove_dir_all(folder.path().join("w/runs/0001.mcap")).unwrap();
    let first = fs::metadata(folder.path().join("w/results/0000.json")).unwrap().modified().unwrap();
    let output = nucleus(folder.path(), &["wedge", "--continue", "--out", "w"]);
    assert!(stdout(&output).contains("4 runs: 4 problem"), "{}", stdout(&output));
    let again = fs::metadata(folder.path().join("w/results/0000.json")).unwrap().modified().unwrap();
    assert_eq!(first, again);
}

#[test]
fn seeds_samples_and_tables_make_rows() {
    let folder = folder();
    scene(folder.path(), 3, "");
    let planned = |arguments: &[&str]| {
        let plan = ["wedge", "drape.ron", "--plan", "--out", "w"];
        let output = nucleus(folder.path(), &[&plan[..], arguments].concat());
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        let text = fs::read_to_string(folder.path().join("w/plan.json")).unwrap();
        fs::remove_dir_all(folder.path().join("w")).unwrap();
        let plan: serde_json::Value = serde_json::from_str(&text).unwrap();
        plan["runs"].as_array().unwrap().clone()
    };
    let samples = ["--vary", "cloth1.bendResistance=0.1..10:log", "--samples", "6", "--seeds", "2"];
    let runs = planned(&samples);
    assert_eq!((runs.len(), runs[0]["seed"].as_u64(), runs[1]["seed"].as_u64()), (12, Some(1), Some(2)));
    assert_ne!(runs[0]["values"], runs[1]["values"], "each seed samples anew");
    assert_eq!(runs, planned(&samples));
    fs::write(folder.path().join("t.csv"), "cloth1.damp,nucleus1.windSpeed\n0,1\n0.5,2\n").unwrap();
    let runs = planned(&["--table", "t.csv"]);
    assert_eq!(runs[1]["values"], serde_json::json!(["0.5", "2"]));
}

#[test]
fn a_seed_changes_the_start_a_little_and_the_same_seed_gives_the_same_bytes() {
    let folder = folder();
    scene(folder.path(), 8, "");
    let run = |seed: &str, out: &str| {
        let output =
            nucleus(folder.path(), &["run", "drape.ron", "--seed", seed, "--checkpoint", "4", "-o", out]);
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        fs::read(folder.path().join(out)).unwrap()
    };
    let (one, two) = (run("1", "a.mcap"), run("2", "b.mcap"));
    assert!(one != two && one == run("1", "c.mcap"));
    let resumed = nucleus(folder.path(), &["resume", "c.mcap", "--at", "5"]);
    assert_eq!(resumed.status.code(), Some(0), "{}", stderr(&resumed));
    assert!(fs::read(folder.path().join("c.mcap")).unwrap() == one);
}

#[test]
fn other_schedulers_do_runs_by_their_number() {
    let folder = folder();
    scene(folder.path(), 3, "");
    assert_eq!(wedge(folder.path(), &["--plan"]).status.code(), Some(0));
    for runs in ["2", "0..1,3"] {
        let output = nucleus(folder.path(), &["wedge", "--out", "w", "--run", runs]);
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    }
    let output = nucleus(folder.path(), &["wedge", "--out", "w", "--collect"]);
    assert!(stdout(&output).contains("4 runs: 4 success"), "{}", stdout(&output));
    assert_refused(&nucleus(folder.path(), &["wedge", "--out", "w", "--run", "4"]), "there is no run 4");
    assert_refused(&nucleus(folder.path(), &["wedge", "--out", "w"]), "`--continue`");
    assert_refused(&nucleus(folder.path(), &["wedge", "--out", "x", "--continue"]), "holds no plan");
    assert_refused(&wedge(folder.path(), &[]), "holds a plan already");
}

#[test]
fn a_plan_of_another_scene_is_not_continued() {
    let folder = folder();
    scene(folder.path(), 3, "");
    assert_eq!(wedge(folder.path(), &["--plan"]).status.code(), Some(0));
    let path = folder.path().join("drape.ron");
    let text = fs::read_to_string(&path).unwrap();
    let changes = [
        ("radius: 20", "radius: 21"),
        ("end: 3", "end: 4"),
        ("fps: 24", "fps: 25"),
        ("nodes:", "record: substeps, nodes:"),
        ("checks: []", "checks: [finite]"),
    ];
    for (from, to) in changes {
        let changed = text.replacen(from, to, 1);
        assert!(changed != text, "there is no `{from}` in {text}");
        fs::write(&path, changed).unwrap();
        for how in [&["--continue"][..], &["--run", "1"]] {
            let output = nucleus(folder.path(), &[&["wedge", "--out", "w"], how].concat());
            assert_refused(&output, "has changed since the plan");
        }
    }
    fs::write(&path, text).unwrap();
    let other = ["wedge", "drape.ron", "--vary", "cloth1.damp=0,1", "--continue", "--out", "w"];
    assert_refused(&nucleus(folder.path(), &other), "has other runs");
    assert_eq!(wedge(folder.path(), &["--continue"]).status.code(), Some(0));
}

#[test]
fn a_plan_of_some_frames_is_continued_without_naming_them_again() {
    let folder = folder();
    scene(folder.path(), 9, "");
    assert_eq!(wedge(folder.path(), &["--frames", "2", "--plan"]).status.code(), Some(0));
    let output = nucleus(folder.path(), &["wedge", "--continue", "--out", "w"]);
    assert!(stdout(&output).contains("4 runs: 4 success"), "{}{}", stdout(&output), stderr(&output));
}

/// Virtual memory, of which the memory in use is a part.
#[test]
#[cfg(target_os = "linux")]
fn a_hundred_thousand_runs_are_planned_and_collected_in_two_hundred_megabytes() {
    let folder = folder();
    scene(folder.path(), 3, "");
    let nucleus = env!("CARGO_BIN_EXE_nucleus");
    let vary = "--vary cloth1.bendResistance=0..1/100000";
    let script = format!(
        "ulimit -v {}; '{nucleus}' wedge drape.ron {vary} --out w --plan && '{nucleus}' wedge --out w --collect",
        200_000_000 / 1024
    );
    let mut shell = Command::new("sh");
    let output = shell.args(["-c", &script]).current_dir(folder.path()).output().unwrap();
    assert!(stdout(&output).contains("100000 runs: 100000 open"), "{}", stderr(&output));
    let plan = fs::read(folder.path().join("w/plan.json")).unwrap();
    assert_eq!(plan.iter().filter(|byte| **byte == b'\n').count(), 100_002);
}

#[test]
#[ignore = "a measurement, for a quiet machine with two cores or more"]
fn forty_small_runs_two_at_once_are_at_least_1_9_times_as_fast_as_one_by_one() {
    let seconds = |jobs: &str| {
        let folder = folder();
        scene(folder.path(), 60, "");
        let plan = ["wedge", "drape.ron", "--vary", "cloth1.damp=0..0.5/40", "--out", "w", "--plan"];
        assert_eq!(nucleus(folder.path(), &plan).status.code(), Some(0));
        let begin = Instant::now();
        let output = nucleus(folder.path(), &["wedge", "--out", "w", "--run", "0..39", "--jobs", jobs]);
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        begin.elapsed().as_secs_f64()
    };
    // The better of two, because a quiet machine is seldom quite so.
    let [one, two] = ["1", "2"].map(|jobs| seconds(jobs).min(seconds(jobs)));
    assert!(one / two >= 1.9, "{one:.2} s, {two:.2} s: {:.2} times", one / two);
}

#[cfg(unix)]
mod killed {
    //! A wedge that is killed at any moment is finished by `--continue`, with the bytes of one that was not.

    use std::process::{Child, Stdio};
    use std::thread::sleep;
    use std::time::Duration;

    use super::*;

    fn start(folder: &Path) -> Child {
        let mut command = Command::new(env!("CARGO_BIN_EXE_nucleus"));
        command.args(FOUR).args(["--jobs", "2", "--checkpoint", "5"]).current_dir(folder);
        command.stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap()
    }

    fn wait_for(what: &str, is_there: impl Fn() -> bool) {
        let begin = Instant::now();
        while !is_there() {
            assert!(begin.elapsed() < Duration::from_secs(120), "{what}");
            sleep(Duration::from_millis(2));
        }
    }

    fn last_frame(folder: &Path, run: &str) -> i32 {
        let cache = Playback::open(folder.join(format!("w/runs/{run}.mcap.part"))).ok();
        cache.and_then(|cache| cache.time_samples().last().map(|moment| moment.frame)).unwrap_or(0)
    }

    fn bytes(folder: &Path) -> Vec<Vec<u8>> {
        (0..4).map(|run| fs::read(folder.join(format!("w/runs/{run:04}.mcap"))).unwrap()).collect()
    }

    #[test]
    fn a_killed_wedge_continues_to_the_same_bytes() {
        let whole = folder();
        scene(whole.path(), 40, "");
        assert_eq!(wedge(whole.path(), &["--checkpoint", "5"]).status.code(), Some(0));
        let expected = bytes(whole.path());
        // Before the first frame, within a run, and late.
        for frame in [0, 12, 30] {
            let folder = folder();
            scene(folder.path(), 40, "");
            let mut child = start(folder.path());
            wait_for("the wedge does not begin", || match frame {
                0 => folder.path().join("w/plan.json").exists(),
                _ => {
                    last_frame(folder.path(), "0001") >= frame
                        || folder.path().join("w/results/0001.json").exists()
                }
            });
            child.kill().unwrap();
            child.wait().unwrap();
            // The runs notice that their parent is gone; the next command waits for none of them.
            let mut said = String::new();
            let begin = Instant::now();
            while begin.elapsed() < Duration::from_secs(120) {
                let output = nucleus(folder.path(), &["wedge", "--continue", "--out", "w"]);
                said = format!("{}{}", stdout(&output), stderr(&output));
                if output.status.code() == Some(0) {
                    break;
                }
            }
            assert!(said.contains("4 runs: 4 success"), "frame {frame}: {said}");
            assert!(bytes(folder.path()) == expected, "frame {frame}");
        }
    }

    #[test]
    fn an_interrupted_wedge_closes_its_caches_and_continues() {
        let folder = folder();
        scene(folder.path(), 4000, "");
        let child = start(folder.path());
        wait_for("the wedge does not begin", || last_frame(folder.path(), "0000") >= 3);
        Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap();
        let output = child.wait_with_output().unwrap();
        assert_eq!(output.status.code(), Some(130));
        // A signal to the coordinator alone reaches the runs, which have written what they have.
        let result = fs::read_to_string(folder.path().join("w/results/0000.json")).unwrap();
        assert!(result.contains("\"interrupted\""), "{result}");
        let verified = nucleus(folder.path(), &["info", "w/runs/0000.mcap", "--verify"]);
        assert_eq!(verified.status.code(), Some(0), "{}", stdout(&verified));
    }

    #[test]
    fn a_killed_run_is_named_and_the_others_go_on() {
        let folder = folder();
        scene(folder.path(), 1000, "");
        let child = start(folder.path());
        let lock = folder.path().join("w/runs/0000.mcap.part");
        wait_for("the run does not begin", || lock.exists());
        let found = Command::new("pgrep").args(["-P", &child.id().to_string()]).output().unwrap();
        let first = String::from_utf8(found.stdout).unwrap();
        let pid = first.lines().next().expect("a run is a child of the wedge");
        Command::new("kill").args(["-KILL", pid]).status().unwrap();
        child.wait_with_output().unwrap();
        let outcomes: Vec<String> = table(folder.path())[1..].iter().map(|row| row[3].clone()).collect();
        assert_eq!(outcomes.iter().filter(|word| *word == "killed").count(), 1, "{outcomes:?}");
        assert_eq!(outcomes.iter().filter(|word| *word == "success").count(), 3, "{outcomes:?}");
        let output = nucleus(folder.path(), &["wedge", "--continue", "--out", "w"]);
        assert!(stdout(&output).contains("4 runs: 4 success"), "{}", stdout(&output));
    }
}

#[test]
fn a_finished_run_without_its_cache_is_named_and_made_again_when_asked() {
    let folder = folder();
    scene(folder.path(), 5, "finite");
    assert_eq!(wedge(folder.path(), &[]).status.code(), Some(0));
    let cache = |name: &str| folder.path().join(format!("w/runs/{name}.mcap"));
    let whole = fs::read(cache("0002")).unwrap();
    fs::write(cache("0002"), &whole[..whole.len() / 2]).unwrap();
    fs::remove_file(cache("0001")).unwrap();
    for more in ["--continue", "--collect"] {
        let output = nucleus(folder.path(), &["wedge", more, "--out", "w"]);
        let said = stderr(&output);
        for words in [
            "run 0001 is finished, but its cache is missing, so it has no picture: \
             `nucleus wedge --out w --run 1` makes it again",
            &format!("run 0002 is finished, but its cache has {} of {} bytes", whole.len() / 2, whole.len()),
        ] {
            assert!(said.contains(words), "{words}: {said}");
        }
        assert!(!said.contains("run 0000") && !said.contains("run 0003"), "{said}");
        assert!(!cache("0001").exists(), "a run of hours is not done again unasked");
        let page = fs::read_to_string(folder.path().join("w/wedge.html")).unwrap();
        assert!(page.contains("its cache is missing") && page.matches("<figure").count() == 2, "{page}");
    }
    let again = nucleus(folder.path(), &["wedge", "--out", "w", "--run", "0..3"]);
    assert_eq!(again.status.code(), Some(0), "{}", stderr(&again));
    assert!(fs::read(cache("0002")).unwrap() == whole, "the same bits");
    let output = nucleus(folder.path(), &["wedge", "--collect", "--out", "w"]);
    assert!(!stderr(&output).contains("warning"), "{}", stderr(&output));
}

#[test]
fn the_reason_of_a_problem_is_printed_once() {
    let folder = folder();
    scene(folder.path(), 5, "maxStretch(0)");
    let output = wedge(folder.path(), &[]);
    assert_eq!(output.status.code(), Some(1));
    let said = stdout(&output) + &stderr(&output);
    assert_eq!(said.matches("check maxStretch(0) failed").count(), 4, "{said}");
    let figure =
        |line: &str| line.split(" with ").nth(1).and_then(|rest| rest.split(' ').next().map(str::len));
    let longest = stdout(&output).lines().filter_map(figure).max();
    assert!(longest.is_some_and(|length| length <= 9), "{said}");
    assert!(stderr(&output).contains("run 0003 has a problem"), "{said}");
}
