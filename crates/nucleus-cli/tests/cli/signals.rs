//! Runs that a signal or a limit of the system ends.
#![cfg(unix)]

use std::path::Path;
use std::process::{Child, Command, Output, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

use nucleus_cache::Playback;

use crate::sample::{assert_refused, folder, nucleus, scene, stderr, stdout};

/// A run of a million frames that has recorded at least four.
fn long_run(folder: &Path) -> Child {
    started(Command::new(env!("CARGO_BIN_EXE_nucleus")), folder, &[])
}

/// The same as the child of a given command, to which the arguments are added.
fn started(mut run: Command, folder: &Path, options: &[&str]) -> Child {
    scene(folder, 1_000_000, "");
    run.args(["run", "drape.ron", "--threads", "1"]).args(options).current_dir(folder);
    let child = run.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    let begin = Instant::now();
    // An unfinished cache can be read.
    let frames =
        || Playback::open(folder.join("drape.mcap.part")).map_or(0, |cache| cache.time_samples().len());
    while frames() < 4 {
        assert!(begin.elapsed() < Duration::from_secs(60), "the run does not begin");
        sleep(Duration::from_millis(5));
    }
    child
}

fn signal(child: &Child, name: &str) {
    let sent = Command::new("kill").args([format!("-{name}"), child.id().to_string()]).status().unwrap();
    assert!(sent.success());
}

#[test]
fn a_killed_run_leaves_an_unfinished_cache_that_plays() {
    let folder = folder();
    let mut run = long_run(folder.path());
    run.kill().unwrap();
    run.wait().unwrap();
    let mut cache = Playback::open(folder.path().join("drape.mcap.part")).unwrap();
    let last = cache.time_samples().len() - 1;
    assert!(last >= 3);
    assert!(cache.positions(0, last).unwrap().iter().flatten().all(|x| x.is_finite()));
    assert!(cache.corruption().truncated);
    assert_eq!(nucleus(folder.path(), &["info", "drape.mcap.part"]).status.code(), Some(1));
    let info = nucleus(folder.path(), &["info", "drape.mcap"]);
    assert_refused(&info, "`nucleus recover drape.mcap.part` writes them as a complete cache");
    let again = nucleus(folder.path(), &["run", "drape.ron"]);
    assert_refused(&again, "is left of a run that was killed");
    let recovered = nucleus(folder.path(), &["recover", "drape.mcap.part"]);
    assert_eq!(recovered.status.code(), Some(0), "{}", stderr(&recovered));
    let whole = Playback::open(folder.path().join("drape.mcap")).unwrap();
    assert_eq!((whole.time_samples().len(), whole.corruption().is_intact()), (last + 1, true));
}

#[test]
fn an_interrupted_run_closes_its_cache_and_says_so() {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let ignored = status.lines().find_map(|line| line.strip_prefix("SigIgn:")).unwrap_or("0").trim();
    // Below `nohup` a hangup is ignored, and stays so.
    let keeps_hangup = u64::from_str_radix(ignored, 16).unwrap() & 1 == 0;
    for name in ["INT", "TERM", "QUIT"].into_iter().chain(keeps_hangup.then_some("HUP")) {
        let folder = folder();
        let run = long_run(folder.path());
        signal(&run, name);
        let output = run.wait_with_output().unwrap();
        assert_eq!(output.status.code(), Some(130), "{}", stderr(&output));
        assert!(stdout(&output).contains("interrupted after frame "), "{}", stdout(&output));
        let info = nucleus(folder.path(), &["info", "drape.mcap", "--verify"]);
        assert_eq!(info.status.code(), Some(0), "{}", stdout(&info));
    }
}

#[test]
fn an_interrupted_run_does_not_replace_a_complete_cache() {
    let folder = folder();
    scene(folder.path(), 5, "");
    assert_eq!(nucleus(folder.path(), &["run", "drape.ron"]).status.code(), Some(0));
    let complete = std::fs::read(folder.path().join("drape.mcap")).unwrap();
    let run = started(Command::new(env!("CARGO_BIN_EXE_nucleus")), folder.path(), &["--force"]);
    signal(&run, "INT");
    let output = run.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(130), "{}", stderr(&output));
    let said = stdout(&output);
    assert!(said.contains("`drape.mcap` stays as it was"), "{said}");
    assert!(said.contains("continue it with `nucleus resume drape.mcap.part`"), "{said}");
    assert!(complete == std::fs::read(folder.path().join("drape.mcap")).unwrap());
    let recorded = Playback::open(folder.path().join("drape.mcap.part")).unwrap().time_samples().len();
    let to = recorded.max(5).to_string();
    let resumed = nucleus(folder.path(), &["resume", "drape.mcap.part", "--to", &to]);
    assert_eq!(resumed.status.code(), Some(0), "{}", stderr(&resumed));
    let whole = Playback::open(folder.path().join("drape.mcap")).unwrap();
    assert_eq!((whole.time_samples().len(), whole.corruption().is_intact()), (recorded.max(5), true));
}

#[test]
#[cfg(target_os = "linux")]
fn a_run_below_nohup_outlives_its_terminal() {
    let folder = folder();
    let mut command = Command::new("nohup");
    command.arg(env!("CARGO_BIN_EXE_nucleus"));
    let run = started(command, folder.path(), &[]);
    let frames = || {
        let part = Playback::open(folder.path().join("drape.mcap.part"));
        part.map_or(0, |cache| cache.time_samples().len())
    };
    signal(&run, "HUP");
    let (begin, before) = (Instant::now(), frames());
    while frames() < before + 20 {
        assert!(begin.elapsed() < Duration::from_secs(60), "the run has ended");
        sleep(Duration::from_millis(5));
    }
    signal(&run, "TERM");
    assert_eq!(run.wait_with_output().unwrap().status.code(), Some(130));
}

/// Writes a scene of eight frames, the sixth of which takes long enough to receive a signal.
fn slow_frame(folder: &Path, substeps: u32) {
    let text = r#"Scene(
    time: (start: 1, end: 8, fps: 24),
    nodes: {
        "nucleus1": nucleus(spaceScale: 0.01, subSteps: keys([(5, 2), (6, SUBSTEPS), (7, 2)])),
        "sheet": polyPlane(width: 50, height: 50, subdivisions: (6, 6), translate: (0, 25, 0)),
        "cloth1": nCloth(inputMesh: "sheet", thickness: 1),
        "ball": polySphere(radius: 20),
        "rigid1": nRigid(inputMesh: "ball"),
    },
)
"#;
    std::fs::write(folder.join("slow.ron"), text.replace("SUBSTEPS", &substeps.to_string())).unwrap();
}

/// Runs that scene and interrupts it within its sixth frame.
fn stopped_within_a_frame(folder: &Path, substeps: u32, record: &str) -> Output {
    slow_frame(folder, substeps);
    let mut run = Command::new(env!("CARGO_BIN_EXE_nucleus"));
    run.args(["run", "slow.ron", "--threads", "1", "--record", record]).current_dir(folder);
    let child = run.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    let begin = Instant::now();
    let at_last = || Playback::open(folder.join("slow.mcap.part")).map_or(0, |cache| last_frame(&cache));
    while at_last() < 5 {
        assert!(begin.elapsed() < Duration::from_secs(60), "the run does not begin");
        sleep(Duration::from_millis(5));
    }
    signal(&child, "INT");
    child.wait_with_output().unwrap()
}

fn last_frame(cache: &Playback) -> i32 {
    cache.time_samples().last().map_or(0, |moment| moment.frame)
}

/// Resumes an interrupted run and compares its cache with that of an uninterrupted run.
fn assert_resumes_to_the_same_bytes(folder: &Path, left: &str, record: &str) {
    let resumed = nucleus(folder, &["resume", left]);
    assert_eq!(resumed.status.code(), Some(0), "{}", stderr(&resumed));
    let whole = nucleus(folder, &["run", "slow.ron", "-o", "whole.mcap", "--record", record]);
    assert_eq!(whole.status.code(), Some(0), "{}", stderr(&whole));
    let bytes = |name: &str| std::fs::read(folder.join(name)).unwrap();
    assert!(bytes("slow.mcap") == bytes("whole.mcap"));
}

#[test]
fn an_interrupt_within_a_frame_drops_it_and_the_resumed_cache_has_the_same_bytes() {
    let folder = folder();
    let output = stopped_within_a_frame(folder.path(), 100_000, "frames");
    assert_eq!(output.status.code(), Some(130), "{}", stderr(&output));
    assert!(stdout(&output).contains("interrupted after frame 5"), "{}", stdout(&output));
    assert_eq!(last_frame(&Playback::open(folder.path().join("slow.mcap")).unwrap()), 5);
    assert_resumes_to_the_same_bytes(folder.path(), "slow.mcap", "frames");
}

/// The file already holds substeps of the unfinished frame, and they cannot be removed from it.
#[test]
fn an_interrupt_within_a_frame_whose_substeps_are_recorded_leaves_a_part_to_resume() {
    let folder = folder();
    let output = stopped_within_a_frame(folder.path(), 30_000, "substeps");
    assert_eq!(output.status.code(), Some(130), "{}", stderr(&output));
    assert!(stdout(&output).contains("`nucleus resume"), "{}", stdout(&output));
    assert!(!folder.path().join("slow.mcap").exists());
    assert_resumes_to_the_same_bytes(folder.path(), "slow.mcap.part", "substeps");
}

#[test]
fn the_file_size_limit_ends_a_run_like_a_full_disk() {
    let folder = folder();
    scene(folder.path(), 400, "");
    let mut run = Command::new("sh");
    let limited = format!("ulimit -f 64; exec '{}' run drape.ron --threads 1", env!("CARGO_BIN_EXE_nucleus"));
    let output = run.args(["-c", &limited]).current_dir(folder.path()).output().unwrap();
    assert_eq!(output.status.code(), Some(1), "{output:?}");
    assert!(stdout(&output).contains("File too large"), "{}", stdout(&output));
    let resumed = nucleus(folder.path(), &["resume", "drape.mcap.part", "--to", "60"]);
    assert_eq!(resumed.status.code(), Some(0), "{}", stderr(&resumed));
    assert_eq!(last_frame(&Playback::open(folder.path().join("drape.mcap")).unwrap()), 60);
}
