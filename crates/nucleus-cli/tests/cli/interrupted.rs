//! Runs that are ended from outside.
#![cfg(unix)]

use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

use nucleus_cache::Playback;

use crate::sample::{assert_refused, folder, nucleus, scene, stderr, stdout};

/// A run that takes far longer than the test, some frames into it.
fn long_run(folder: &Path) -> Child {
    scene(folder, 1_000_000, "");
    let mut run = Command::new(env!("CARGO_BIN_EXE_nucleus"));
    run.args(["run", "drape.ron", "--threads", "1"]).current_dir(folder);
    let child = run.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    let begin = Instant::now();
    // A cache can be read while it is written.
    let frames = || Playback::open(folder.join("drape.mcap.part")).map_or(0, |cache| cache.moments().len());
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
fn a_killed_run_leaves_a_cache_that_plays() {
    let folder = folder();
    let mut run = long_run(folder.path());
    run.kill().unwrap();
    run.wait().unwrap();
    let mut cache = Playback::open(folder.path().join("drape.mcap.part")).unwrap();
    let last = cache.moments().len() - 1;
    assert!(last >= 3);
    assert!(cache.positions(0, last).unwrap().iter().flatten().all(|x| x.is_finite()));
    assert!(cache.loss().cut_off);
    assert_eq!(nucleus(folder.path(), &["info", "drape.mcap.part"]).status.code(), Some(1));
    let asked = nucleus(folder.path(), &["info", "drape.mcap"]);
    assert_refused(&asked, "`nucleus recover drape.mcap.part` makes it whole");
    let again = nucleus(folder.path(), &["run", "drape.ron"]);
    assert_refused(&again, "is left of a run that was killed");
    let recovered = nucleus(folder.path(), &["recover", "drape.mcap.part"]);
    assert_eq!(recovered.status.code(), Some(0), "{}", stderr(&recovered));
    let whole = Playback::open(folder.path().join("drape.mcap")).unwrap();
    assert_eq!((whole.moments().len(), whole.loss().is_none()), (last + 1, true));
}

#[test]
fn an_interrupted_run_closes_its_cache_and_says_so() {
    for name in ["INT", "TERM"] {
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
