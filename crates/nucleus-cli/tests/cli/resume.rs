//! `nucleus resume`: a resumed run gives the bytes of a run that never stopped.

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use nucleus_cache::Playback;

use crate::sample::{assert_refused, cache, folder, nucleus, scene, stderr, stdout};

/// The bytes of a cache of twelve frames with a checkpoint at every fourth.
fn whole(folder: &Path) -> Vec<u8> {
    scene(folder, 12, "noPenetration");
    let record = ["--record", "frames,contacts,strain"];
    let output = nucleus(
        folder,
        &[&["run", "drape.ron", "--checkpoint", "4", "-o", "whole.mcap"], &record[..]].concat(),
    );
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    fs::read(folder.join("whole.mcap")).unwrap()
}

fn resume(folder: &Path, arguments: &[&str]) -> Output {
    nucleus(folder, &[&["resume", "x.mcap"], arguments].concat())
}

/// Resumes and returns the bytes of the cache.
fn resumed(folder: &Path, arguments: &[&str]) -> Vec<u8> {
    let output = resume(folder, arguments);
    assert_eq!(output.status.code(), Some(0), "{}{}", stdout(&output), stderr(&output));
    fs::read(folder.join("x.mcap")).unwrap()
}

/// The end of the start frame: that of the first chunk, a record with opcode 6. A record is an opcode, its length in eight
/// bytes, and so many bytes; the first one follows the eight bytes of the magic.
fn end_of_start(cache: &[u8]) -> usize {
    let mut at = 8;
    loop {
        let length = u64::from_le_bytes(cache[at + 1..at + 9].try_into().unwrap());
        let is_chunk = cache[at] == 6;
        at += 9 + length as usize;
        if is_chunk {
            return at;
        }
    }
}

#[test]
fn a_cache_that_is_cut_off_anywhere_behind_its_start_resumes_to_the_same_bytes() {
    let folder = folder();
    let whole = whole(folder.path());
    let start = end_of_start(&whole);
    let part = folder.path().join("x.mcap.part");
    // The leftover of a resumed run that was killed is replaced.
    fs::write(folder.path().join("x.mcap.resuming"), "half a cache").unwrap();
    for cut in (0..20).map(|k| start + (whole.len() - start) * k / 20) {
        fs::write(&part, &whole[..cut]).unwrap();
        let threads = if cut % 2 == 0 { "1" } else { "2" };
        assert!(resumed(folder.path(), &["--threads", threads]) == whole, "cut off after {cut} bytes");
        assert!(!part.exists() && !folder.path().join("x.mcap.resuming").exists());
        fs::remove_file(folder.path().join("x.mcap")).unwrap();
    }
}

#[test]
fn a_cache_that_is_cut_off_before_its_start_says_that_the_run_must_start_again() {
    let folder = folder();
    let whole = whole(folder.path());
    let start = end_of_start(&whole);
    let part = folder.path().join("x.mcap.part");
    for cut in (1..8).map(|k| start * k / 8).chain([start - 1]) {
        fs::write(&part, &whole[..cut]).unwrap();
        let output = resume(folder.path(), &[]);
        assert_eq!(output.status.code(), Some(2), "cut off after {cut} of {start} bytes");
        assert!(stderr(&output).contains("start the run again with `nucleus run`"), "{}", stderr(&output));
        assert!(fs::read(&part).unwrap() == whole[..cut] && !folder.path().join("x.mcap").exists());
    }
}

#[cfg(unix)]
#[test]
fn a_link_stays_and_the_cache_that_it_names_is_replaced() {
    let folder = folder();
    let whole = whole(folder.path());
    fs::create_dir(folder.path().join("far")).unwrap();
    let target = folder.path().join("far/real.mcap");
    let link = folder.path().join("x.mcap");
    std::os::unix::fs::symlink("far/real.mcap", &link).unwrap();
    let record =
        ["run", "drape.ron", "--checkpoint", "4", "-o", "x.mcap", "--record", "frames,contacts,strain"];
    for force in [&[][..], &["--force"]] {
        let output = nucleus(folder.path(), &[&record[..], force].concat());
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        assert!(link.is_symlink() && fs::read(&target).unwrap() == whole);
    }
    // The unfinished cache of a killed run lies beside the file, not beside the link.
    fs::write(folder.path().join("far/real.mcap.part"), &whole[..whole.len() / 2]).unwrap();
    assert!(resumed(folder.path(), &[]) == whole);
    assert!(resumed(folder.path(), &["--at", "5"]) == whole);
    assert!(link.is_symlink() && fs::read(&target).unwrap() == whole);
    assert_eq!(fs::read_dir(folder.path().join("far")).unwrap().count(), 1);
}

#[test]
fn frames_that_a_scene_does_not_solve_are_not_missing() {
    let folder = folder();
    scene(folder.path(), 12, "");
    let path = folder.path().join("drape.ron");
    let text = fs::read_to_string(&path).unwrap();
    fs::write(&path, text.replacen("fps: 24", "fps: 24, every: 2", 1)).unwrap();
    let said = |arguments: &[&str]| {
        let output = nucleus(folder.path(), arguments);
        (output.status.code(), stdout(&output) + &stderr(&output))
    };
    for record in ["frames", "substeps", "every:3"] {
        for (frames, more) in
            [("1..6", &["resume", "x.mcap", "--to", "11"][..]), ("1..11", &["info", "x.mcap"])]
        {
            let run = ["run", "drape.ron", "-o", "x.mcap", "--force", "--record", record, "--frames", frames];
            assert_eq!(said(&run).0, Some(0));
            assert_eq!(said(more).0, Some(0), "{record}: {}", said(more).1);
            let info = said(&["info", "x.mcap", "--verify"]);
            assert!(info.0 == Some(0) && !info.1.contains("missing"), "{record}: {}", info.1);
            assert_eq!(said(&["recover", "x.mcap", "-o", "y.mcap", "--force"]).0, Some(0), "{record}");
        }
    }
}

#[test]
fn a_damaged_checkpoint_or_frame_is_solved_again() {
    let folder = folder();
    let whole = whole(folder.path());
    let mut damaged_checkpoints = 0;
    for at in (1..40).map(|k| whole.len() * k / 40) {
        let mut damaged = whole.clone();
        damaged[at] ^= 0x20;
        fs::write(folder.path().join("x.mcap"), &damaged).unwrap();
        let info = stdout(&nucleus(folder.path(), &["info", "x.mcap"]));
        let is_damaged = info.contains("damaged: the checkpoint of");
        assert_eq!(info.contains("checkpoints 3 of 4 intact"), is_damaged, "byte {at}: {info}");
        damaged_checkpoints += u32::from(is_damaged);
        let output = resume(folder.path(), &["--at", "11"]);
        match output.status.code() {
            Some(0) => {
                // A damaged checkpoint before the one that is used stays lost; no frame does.
                let info = nucleus(folder.path(), &["info", "x.mcap", "--verify"]);
                assert_eq!(info.status.code(), Some(0), "byte {at}: {}", stdout(&info));
                let diff = nucleus(folder.path(), &["diff", "x.mcap", "whole.mcap"]);
                assert_eq!(diff.status.code(), Some(0), "byte {at}: {}", stdout(&diff));
            }
            // Without the start, the run or its scene no run can resume.
            _ => assert!(stderr(&output).contains("error: "), "byte {at}: {}", stderr(&output)),
        }
    }
    assert!(damaged_checkpoints > 0);
}

#[test]
fn a_part_of_a_run_that_is_solved_again_gives_the_same_bytes() {
    let folder = folder();
    let whole = whole(folder.path());
    for at in ["1", "4", "7", "12"] {
        fs::copy(folder.path().join("whole.mcap"), folder.path().join("x.mcap")).unwrap();
        assert!(resumed(folder.path(), &["--at", at]) == whole, "from frame {at}");
    }
    let output = resume(folder.path(), &[]);
    assert!(stdout(&output).contains("is complete: its last frame is 12"), "{}", stdout(&output));
    assert_eq!(output.status.code(), Some(0));
    // Beyond its end, and back to it.
    assert!(resumed(folder.path(), &["--to", "20"]) != whole);
    assert!(resumed(folder.path(), &["--at", "12", "--to", "12"]) == whole);
    // To another file.
    let output = resume(folder.path(), &["--at", "6", "-o", "y.mcap"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert!(fs::read(folder.path().join("y.mcap")).unwrap() == whole);
    assert_refused(
        &resume(folder.path(), &["--at", "6", "-o", "y.mcap"]),
        "`y.mcap` exists; `--force` replaces it",
    );
}

#[test]
fn a_run_without_checkpoints_is_solved_again_from_its_start() {
    let folder = folder();
    scene(folder.path(), 6, "");
    nucleus(folder.path(), &["run", "drape.ron", "--checkpoint", "0", "-o", "x.mcap"]);
    let whole = fs::read(folder.path().join("x.mcap")).unwrap();
    let output = resume(folder.path(), &["--at", "4"]);
    assert!(stderr(&output).contains("every frame is solved again from frame 1"), "{}", stderr(&output));
    assert!(fs::read(folder.path().join("x.mcap")).unwrap() == whole);
}

/// Runs emitted particles with these attributes up to a frame, with a checkpoint at every fifth.
fn emit(folder: &Path, attributes: &str, end: u32, out: &str) {
    let text = format!(
        "Scene(time: (start: 1, end: {end}, fps: 24), nodes: {{ \"n\": nucleus(gravity: 0), \
         \"p\": nParticle({attributes}), \"e\": pointEmitter(target: \"p\", rate: 60) }})"
    );
    fs::write(folder.join("drops.ron"), text).unwrap();
    let output = nucleus(folder, &["run", "drops.ron", "--checkpoint", "5", "-o", out]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
}

/// The positions of the only object at the end of a frame.
fn positions(folder: &Path, cache: &str, frame: i32) -> Vec<[f32; 3]> {
    let mut cache = Playback::open(folder.join(cache)).unwrap();
    let moment = cache.end_of(frame).unwrap();
    cache.positions(0, moment).unwrap()
}

#[test]
fn a_run_that_is_continued_beyond_its_end_emits_as_a_longer_run_does() {
    let folder = folder();
    emit(folder.path(), "selfCollide: false", 10, "x.mcap");
    emit(folder.path(), "selfCollide: false", 60, "whole.mcap");
    let output = resume(folder.path(), &["--to", "60"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert!(stderr(&output).contains("the checkpoint has a capacity of 32 particles"), "{}", stderr(&output));
    let whole = positions(folder.path(), "whole.mcap", 60);
    assert!(whole.len() > 140 && positions(folder.path(), "x.mcap", 60) == whole, "{}", whole.len());
    // Now there is room for some more frames.
    let output = resume(folder.path(), &["--to", "62"]);
    assert!(!stderr(&output).contains("solved again"), "{}", stderr(&output));
}

#[test]
fn an_expression_that_reads_velocities_resumes_with_the_same_bytes() {
    let folder = folder();
    emit(folder.path(), "runtimeExpression: \"vx = 1\"", 20, "x.mcap");
    let whole = fs::read(folder.path().join("x.mcap")).unwrap();
    assert!(resumed(folder.path(), &["--at", "17"]) == whole);
}

#[test]
fn a_run_with_an_initial_state_resumes_without_the_cache_of_that_state() {
    let folder = folder();
    scene(folder.path(), 9, "");
    nucleus(folder.path(), &["run", "drape.ron", "-o", "before.mcap", "--velocities"]);
    nucleus(
        folder.path(),
        &["run", "drape.ron", "--from", "before.mcap@5", "-o", "x.mcap", "--checkpoint", "4"],
    );
    let whole = fs::read(folder.path().join("x.mcap")).unwrap();
    fs::remove_file(folder.path().join("before.mcap")).unwrap();
    assert!(resumed(folder.path(), &["--at", "3"]) == whole);
}

#[test]
fn particles_displaced_by_a_seed_or_taken_from_a_cache_resume_with_the_same_bytes() {
    let folder = folder();
    let emitted =
        r#""p": nParticle(lifespanMode: constant, lifespan: 0.3), "e": pointEmitter(target: "p", rate: 60)"#;
    let filled = r#""q": nParticle(minimumCorner: (0, 0, 0), maximumCorner: (1, 1, 1), radius: 0.2)"#;
    let text = format!(
        r#"Scene(time: (start: 1, end: 20, fps: 24), nodes: {{ "n": nucleus(gravity: 0), {emitted}, {filled} }})"#
    );
    fs::write(folder.path().join("drops.ron"), text).unwrap();
    let run = |more: &[&str], out: &str| {
        let begin = ["run", "drops.ron", "--force", "-o", out];
        let output = nucleus(folder.path(), &[&begin[..], more].concat());
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    };
    run(&["--velocities"], "before.mcap");
    let from = ["--from", "before.mcap@10", "--frames", "10..20"];
    for (more, checkpointless) in [(&["--seed", "2"][..], true), (&from, false)] {
        run(&[more, &["--checkpoint", "5"]].concat(), "x.mcap");
        let whole = fs::read(folder.path().join("x.mcap")).unwrap();
        assert!(resumed(folder.path(), &["--at", "17"]) == whole, "{more:?}");
        if checkpointless {
            run(&[more, &["--checkpoint", "0"]].concat(), "x.mcap");
            let whole = fs::read(folder.path().join("x.mcap")).unwrap();
            assert!(resumed(folder.path(), &["--at", "4"]) == whole, "{more:?}");
        }
    }
}

#[test]
fn a_changed_scene_resumes_only_from_a_frame_that_it_reproduces() {
    let folder = folder();
    whole(folder.path());
    fs::copy(folder.path().join("whole.mcap"), folder.path().join("x.mcap")).unwrap();
    let before = fs::read(folder.path().join("x.mcap")).unwrap();
    let path = folder.path().join("drape.ron");
    let text = fs::read_to_string(&path).unwrap();
    fs::write(&path, text.replace("subSteps: 2", "subSteps: 3")).unwrap();
    // Frames 10 and 11 are to be kept, but the changed scene does not reproduce them.
    let output = resume(folder.path(), &["--at", "11", "--scene", "drape.ron"]);
    assert_refused(&output, "frame 10 does not come out as it was recorded");
    assert!(
        stderr(&output).contains("--scene drape.ron --at 9` solves the frames after 9"),
        "{}",
        stderr(&output)
    );
    assert!(fs::read(folder.path().join("x.mcap")).unwrap() == before, "the cache is unchanged");
    assert!(!folder.path().join("x.mcap.resuming").exists());
    assert!(resumed(folder.path(), &["--at", "9", "--scene", "drape.ron"]) != before);
    // Changed objects are refused.
    fs::write(&path, text.replace("(6, 6)", "(7, 6)")).unwrap();
    let output = resume(folder.path(), &["--at", "9", "--scene", "drape.ron"]);
    assert_refused(&output, "the mesh of `cloth1` differs from that in `x.mcap`");
    fs::write(&path, text.replace("\"cloth1\"", "\"silk\"")).unwrap();
    assert_refused(
        &resume(folder.path(), &["--at", "9", "--scene", "drape.ron"]),
        "`silk` is not in `x.mcap`",
    );
}

#[test]
fn a_mesh_file_that_has_changed_is_refused() {
    let folder = folder();
    let mesh = |height: f64| {
        let text = format!("v 0 {height} 0\nv 10 25 0\nv 10 25 10\nv 0 25 10\nf 1 2 3 4\n");
        fs::write(folder.path().join("sheet.obj"), text).unwrap();
    };
    mesh(25.0);
    scene(folder.path(), 6, "");
    let path = folder.path().join("drape.ron");
    let text = fs::read_to_string(&path).unwrap();
    let plane = "polyPlane(width: 50, height: 50, subdivisions: (6, 6), translate: (0, 25, 0))";
    fs::write(&path, text.replace(plane, "mesh(file: \"sheet.obj\")")).unwrap();
    let run = nucleus(folder.path(), &["run", "drape.ron", "-o", "x.mcap"]);
    assert_eq!(run.status.code(), Some(0), "{}", stderr(&run));
    mesh(25.5);
    assert_refused(&resume(folder.path(), &["--at", "4"]), "a mesh or map that the scene reads");
    mesh(25.0);
    resumed(folder.path(), &["--at", "4"]);
}

#[test]
fn a_cache_that_cannot_be_resumed_is_refused_with_advice() {
    let folder = folder();
    let path = folder.path();
    assert_refused(&resume(path, &[]), "cannot resume `x.mcap`");
    fs::write(path.join("x.mcap"), "").unwrap();
    assert_refused(&resume(path, &[]), "start the run again with `nucleus run`");
    fs::write(path.join("x.mcap"), "my thesis, chapter one").unwrap();
    assert_refused(&resume(path, &[]), "not an MCAP file");
    fs::remove_file(path.join("x.mcap")).unwrap();
    fs::create_dir(path.join("x.mcap")).unwrap();
    assert_refused(&resume(path, &[]), "is a folder, not a cache");
    fs::remove_dir(path.join("x.mcap")).unwrap();
    // A cache without a scene.
    fs::rename(cache(path), path.join("x.mcap")).unwrap();
    assert_refused(&resume(path, &[]), "holds no scene: name it with `--scene`");
    let whole = whole(path);
    fs::write(path.join("x.mcap"), whole).unwrap();
    assert_refused(
        &resume(path, &["--at", "13"]),
        "there is no frame 13 to resume from; `x.mcap` has 1 to 12",
    );
    assert_refused(&resume(path, &["--to", "5"]), "drop the later frames with `--at`");
}

/// Writes a scene of five frames in which a ball is driven through a held sheet, and runs it.
fn penetrated(folder: &Path, checks: &str, arguments: &[&str]) -> Output {
    scene(folder, 5, checks);
    let path = folder.join("drape.ron");
    let text = fs::read_to_string(&path).unwrap();
    let text = text.replace("radius: 20", "radius: 20, translateY: keys([(1, 0), (5, 60)])");
    let held = r#""k": dynamicConstraint(constraintType: transform, components: ["cloth1.vtx[0:23]", "cloth1.vtx[25:48]"]),
        "sheet""#;
    fs::write(&path, text.replacen(r#""sheet""#, held, 1)).unwrap();
    nucleus(folder, &[&["run", "drape.ron", "--force", "-o", "x.mcap"], arguments].concat())
}

#[test]
fn a_check_of_intersections_that_failed_before_the_run_was_resumed_fails_after_it_too() {
    let folder = folder();
    let failed = "check noSelfIntersection: FAILED";
    let output = penetrated(folder.path(), "noSelfIntersection", &[]);
    assert!(stdout(&output).contains(failed), "{}", stdout(&output));
    let output = resume(folder.path(), &["--to", "6"]);
    assert!(stdout(&output).contains(failed), "{}", stdout(&output));
    assert_eq!(output.status.code(), Some(1));
}

#[test]
fn an_audited_run_is_resumed_with_its_audit_and_the_findings_of_earlier_frames() {
    let folder = folder();
    let output = penetrated(folder.path(), "maxUnresolved(pairs: 100000)", &["--audit"]);
    assert_eq!(output.status.code(), Some(1), "{}", stdout(&output));
    let output = resume(folder.path(), &["--to", "6"]);
    assert!(stdout(&output).contains("audit of "), "{}", stdout(&output));
    assert!(stdout(&output).contains(" in the frames before the run was resumed\n"), "{}", stdout(&output));
    assert_eq!(output.status.code(), Some(1));
    // A run without an audit is not audited when it is resumed.
    penetrated(folder.path(), "maxUnresolved(pairs: 100000)", &[]);
    let output = resume(folder.path(), &["--to", "6"]);
    assert!(!stdout(&output).contains("audit"), "{}", stdout(&output));
}

#[test]
fn info_lists_the_checkpoints() {
    let folder = folder();
    whole(folder.path());
    let said = stdout(&nucleus(folder.path(), &["info", "whole.mcap"]));
    assert!(said.contains("checkpoints 4, the last of frame 12, "), "{said}");
    assert!(said.contains("channel /checkpoint: nucleus.checkpoint.v1, 4 messages"), "{said}");
}

#[cfg(unix)]
mod killed {
    use std::process::{Child, Stdio};
    use std::thread::sleep;
    use std::time::{Duration, Instant};

    use nucleus_cache::Playback;

    use super::*;

    /// Starts a command and waits until its cache has this many frames.
    fn until(folder: &Path, arguments: &[&str], frames: usize) -> Child {
        let mut run = Command::new(env!("CARGO_BIN_EXE_nucleus"));
        run.args(arguments).current_dir(folder).stdout(Stdio::piped()).stderr(Stdio::piped());
        let child = run.spawn().unwrap();
        let begin = Instant::now();
        let count =
            || Playback::open(folder.join("x.mcap.part")).map_or(0, |cache| cache.time_samples().len());
        while count() < frames {
            assert!(begin.elapsed() < Duration::from_secs(60), "the run does not reach {frames} frames");
            sleep(Duration::from_millis(2));
        }
        child
    }

    #[test]
    fn a_run_that_is_killed_repeatedly_loses_nothing_and_ends_with_the_same_bytes() {
        let folder = folder();
        scene(folder.path(), 1_000_000, "");
        let last = || {
            let cache = Playback::open(folder.path().join("x.mcap.part")).unwrap();
            cache.time_samples().last().unwrap().frame
        };
        let run = ["run", "drape.ron", "--checkpoint", "5", "-o", "x.mcap"];
        let mut child = until(folder.path(), &run, 8);
        for more in [12, 12, 0] {
            child.kill().unwrap();
            child.wait().unwrap();
            let reached = last();
            if more > 0 {
                let frames = reached as usize + more;
                child = until(folder.path(), &["resume", "x.mcap"], frames);
                let busy = resume(folder.path(), &[]);
                assert_refused(&busy, "is being written by another run");
                assert!(last() >= reached, "no recorded frame is lost");
            }
        }
        let end = (last() + 7).to_string();
        let resumed = resumed(folder.path(), &["--to", &end]);
        nucleus(
            folder.path(),
            &["run", "drape.ron", "--frames", &end, "--checkpoint", "5", "-o", "whole.mcap"],
        );
        assert!(resumed == fs::read(folder.path().join("whole.mcap")).unwrap());
    }
}
