//! Checkpoints in a cache: found, damaged, recovered, and resumed from.

use std::fs;
use std::io::Cursor;

use nucleus_cache::{Detail, Playback, RecordError, Recorder, ResumeRange, RunInfo, compare};
use nucleus_core::{StepObserver, SubstepIndex};

use crate::falling::{self, END, Falling, START, SUBSTEPS, Shared, state_bytes as bytes};

/// A checkpoint at every third frame, and at the end of the run.
fn run_info() -> RunInfo {
    RunInfo { checkpoint: 3, ..falling::run_info() }
}

/// Records the frames after `from`, with a checkpoint wherever one is due.
fn record<W: std::io::Write + std::io::Seek>(
    recorder: &mut Recorder<W>,
    from: i32,
    last: i32,
) -> Result<(), RecordError> {
    for frame in from + 1..=last {
        let mut observer = recorder.frame(frame)?;
        for substep in 1..=SUBSTEPS {
            observer.substep(SubstepIndex { substep, substeps: SUBSTEPS }, &Falling { frame, substep });
        }
        recorder.end_frame(&serde_json::json!({ "max_strain": 0.5 }))?;
        if recorder.checkpoint_due() {
            recorder.record_checkpoint(&bytes(frame))?;
        }
    }
    if recorder.final_checkpoint_due() {
        recorder.record_checkpoint(&bytes(last))?;
    }
    Ok(())
}

fn begin<W: std::io::Write + std::io::Seek>(recorder: &mut Recorder<W>) {
    recorder.record_start(&Falling::INITIAL).unwrap();
    recorder.record_checkpoint(&bytes(START)).unwrap();
}

fn whole_run(run: &RunInfo, last: i32) -> Vec<u8> {
    let file = Shared::default();
    let mut recorder = Recorder::to_writer(file.clone(), run, falling::objects()).unwrap();
    begin(&mut recorder);
    record(&mut recorder, START, last).unwrap();
    recorder.finish().unwrap();
    file.contents()
}

fn read(bytes: &[u8]) -> Playback<Cursor<Vec<u8>>> {
    Playback::read(Cursor::new(bytes.to_vec())).unwrap()
}

#[test]
fn checkpoints_are_found_and_change_no_recorded_frame() {
    let whole = whole_run(&run_info(), END);
    let mut cache = read(&whole);
    assert_eq!(cache.checkpoints(), [START, START + 3, START + 6, END]);
    assert_eq!(cache.checkpoint(START + 3).unwrap().unwrap().bytes, bytes(START + 3));
    assert_eq!(cache.checkpoint(START + 4).unwrap(), None);
    assert!(cache.verify().unwrap().is_intact());
    let (plain, recorded) = falling::whole_run(&falling::run_info());
    assert_eq!(cache.time_samples().len() as u64, recorded.time_samples);
    assert_eq!(compare(&mut cache, &mut read(&plain), 0.0).unwrap().differences, []);
}

#[test]
fn damage_to_a_checkpoint_costs_no_frame_and_recovery_keeps_the_others() {
    let whole = whole_run(&run_info(), END);
    let file = Shared::default();
    let recovered = read(&whole).recover(file.clone()).unwrap();
    assert!(file.contents() == whole && recovered.frames as i32 == END - START + 1);
    // The start and its checkpoint, then three frames and theirs.
    let chunk = mcap::Summary::read(&whole).unwrap().unwrap().chunk_indexes[5].clone();
    let mut damaged = whole.clone();
    damaged[(chunk.chunk_start_offset + chunk.chunk_length) as usize - 9] ^= 1;
    let mut cache = read(&damaged);
    assert_eq!(
        cache.verify().unwrap().to_string(),
        format!("damaged: the checkpoint of frame {}", START + 3)
    );
    assert!(cache.checkpoint(START + 3).is_err());
    let file = Shared::default();
    let recovered = cache.recover(file.clone()).unwrap();
    assert_eq!((recovered.frames as i32, recovered.damaged), (END - START + 1, 1));
    assert_eq!(read(&file.contents()).checkpoints(), [START, START + 6, END]);
}

#[test]
fn a_resumed_run_writes_the_file_of_an_uninterrupted_one() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("x.mcap");
    for detail in [Detail::Frames, Detail::Substeps, Detail::Every(4)] {
        let run = RunInfo { detail, ..run_info() };
        let whole = whole_run(&run, END);
        for last in START..=END {
            fs::write(&path, whole_run(&run, last)).unwrap();
            let mut old = Playback::open_to_resume(&path).unwrap();
            let last_recorded = old.time_samples().last().unwrap().frame;
            let copied = old.checkpoints().into_iter().rfind(|&frame| frame <= last).unwrap();
            assert_eq!(old.checkpoint(copied).unwrap().unwrap().bytes, bytes(copied));
            let kept = ResumeRange { copied, compared: last_recorded.max(copied) };
            let mut recorder = Recorder::resume(&path, true, &run, falling::objects(), old, kept).unwrap();
            record(&mut recorder, copied, END).unwrap();
            recorder.finish().unwrap();
            assert!(fs::read(&path).unwrap() == whole, "{detail:?}, stopped at {last}");
        }
    }
}

#[test]
fn a_run_resumes_behind_a_damaged_checkpoint() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("x.mcap");
    let mut damaged = whole_run(&run_info(), END);
    let chunk = mcap::Summary::read(&damaged).unwrap().unwrap().chunk_indexes[5].clone();
    damaged[(chunk.chunk_start_offset + chunk.chunk_length) as usize - 9] ^= 1;
    fs::write(&path, &damaged).unwrap();
    let old = Playback::open_to_resume(&path).unwrap();
    let kept = ResumeRange { copied: START + 6, compared: END };
    let mut recorder = Recorder::resume(&path, true, &run_info(), falling::objects(), old, kept).unwrap();
    record(&mut recorder, START + 6, END).unwrap();
    recorder.finish().unwrap();
    let mut cache = read(&fs::read(&path).unwrap());
    assert!(cache.verify().unwrap().is_intact(), "{}", cache.corruption());
    assert_eq!(cache.checkpoints(), [START, START + 6, END], "what is lost stays lost, and nothing else");
    let mut undamaged = read(&whole_run(&run_info(), END));
    assert_eq!(compare(&mut cache, &mut undamaged, 0.0).unwrap().differences, []);
}

#[test]
fn a_replay_mismatch_is_refused_and_leaves_the_cache_unchanged() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("x.mcap");
    let whole = whole_run(&run_info(), END);
    fs::write(&path, &whole).unwrap();
    let old = Playback::open_to_resume(&path).unwrap();
    let kept = ResumeRange { copied: START + 3, compared: END };
    let mut recorder = Recorder::resume(&path, true, &run_info(), falling::objects(), old, kept).unwrap();
    let frame = START + 4;
    let elsewhere = Falling { frame: frame + 1, substep: SUBSTEPS };
    recorder
        .frame(frame)
        .unwrap()
        .substep(SubstepIndex { substep: SUBSTEPS, substeps: SUBSTEPS }, &elsewhere);
    let error = recorder.end_frame(&serde_json::json!({})).unwrap_err();
    assert!(matches!(error, RecordError::ReplayMismatch { frame: found, .. } if found == frame), "{error}");
    assert!(fs::read(&path).unwrap() == whole);
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1, "what was begun is gone");
}
