//! An object whose mesh changes: torn twice, with more points than before.

use std::fs;
use std::io::Cursor;

use nucleus_cache::{
    Detail, Difference, Playback, ReadError, RecordError, Recorder, ResumeRange, RunInfo, compare,
};
use nucleus_core::{Faces, StepObserver, SubstepIndex};

use crate::falling::{self, END, Falling, START, SUBSTEPS, Shared};
use crate::torn::{CHECKPOINT, CLOTH, record, recorded, run_info, tears, torn};

fn open(bytes: &[u8]) -> Playback<Cursor<Vec<u8>>> {
    Playback::read(Cursor::new(bytes.to_vec())).unwrap()
}

const DETAILS: [Detail; 3] = [Detail::Frames, Detail::Substeps, Detail::Every(4)];

/// Number of tears at a recorded sample; without substeps a sample is the end of its frame.
fn tears_at(cache: &Playback<Cursor<Vec<u8>>>, sample: usize) -> usize {
    let found = cache.time_samples()[sample];
    tears(found.frame, if found.substeps == 1 { SUBSTEPS } else { found.substep })
}

#[test]
fn each_time_sample_has_its_mesh_and_as_many_points() {
    for detail in DETAILS {
        let mut cache = open(&recorded(&run_info(detail), END));
        assert!(cache.verify().unwrap().is_intact(), "{}", cache.corruption());
        // Forwards and backwards, to test the mesh cache.
        let samples = (0..cache.time_samples().len()).chain((0..cache.time_samples().len()).rev());
        for sample in samples.collect::<Vec<_>>() {
            let expected = torn(tears_at(&cache, sample));
            assert_eq!(cache.object_at(0, sample).unwrap(), &expected);
            assert_eq!(cache.objects_at(sample).unwrap()[0], &expected);
            let points = expected.rest.len();
            assert_eq!(cache.positions(0, sample).unwrap().len(), points);
            assert_eq!(cache.velocities(0, sample).unwrap().unwrap().len(), points);
            assert_eq!(cache.contacts(0, sample).unwrap().unwrap().len(), points);
            assert_eq!(cache.strain(0, sample).unwrap().unwrap().len(), points);
        }
        assert_eq!(cache.objects()[0], torn(0));
        let changes: Vec<i32> =
            cache.mesh_changes(0).iter().map(|&sample| cache.time_samples()[sample].frame).collect();
        let expected = match detail {
            Detail::Every(_) => vec![START + 4, START + 8],
            _ => vec![START + 3, START + 5],
        };
        assert_eq!((changes, cache.mesh_changes(1)), (expected, vec![]));
    }
}

#[test]
fn a_resumed_torn_run_writes_the_file_of_an_uninterrupted_one() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("x.mcap");
    for detail in DETAILS {
        let run = run_info(detail);
        let whole = recorded(&run, END);
        for last in CHECKPOINT..=END {
            fs::write(&path, recorded(&run, last)).unwrap();
            let old = Playback::open_to_resume(&path).unwrap();
            let compared = old.time_samples().last().unwrap().frame.max(CHECKPOINT);
            let kept = ResumeRange { copied: CHECKPOINT, compared };
            let mut recorder = Recorder::resume(&path, true, &run, falling::objects(), old, kept).unwrap();
            record(&mut recorder, CHECKPOINT, END).unwrap();
            recorder.finish().unwrap();
            assert!(fs::read(&path).unwrap() == whole, "{detail:?}, stopped at {last}");
        }
    }
}

#[test]
fn a_mesh_lost_with_its_copy_is_reported_and_never_confused_with_another() {
    let run = RunInfo { checkpoint: 0, ..run_info(Detail::Frames) };
    let mut bytes = falling::without_copies(&recorded(&run, END));
    let chunk = mcap::Summary::read(&bytes).unwrap().unwrap().chunk_indexes[3].clone();
    let end = (chunk.chunk_start_offset + chunk.chunk_length) as usize;
    bytes[end - 9] ^= 1;
    let file = Shared::default();
    open(&bytes).recover(file.clone()).unwrap();
    // With the index, without it, and recovered.
    let cut = bytes.len() - 20;
    for bytes in [&bytes[..], &bytes[..cut], &file.contents()] {
        let mut cache = open(bytes);
        for sample in 0..cache.time_samples().len() {
            let frame = cache.time_samples()[sample].frame;
            match cache.positions(0, sample) {
                Ok(positions) => {
                    assert_eq!(positions.len(), cache.object_at(0, sample).unwrap().rest.len());
                    assert!(!(START + 3..START + 5).contains(&frame), "{frame}");
                }
                Err(ReadError::MeshLost { object, .. }) => assert_eq!(object, CLOTH),
                Err(ReadError::Damaged { frame }) => assert_eq!(frame, START + 3),
                Err(error) => panic!("{error}"),
            }
        }
        assert_eq!(cache.verify().unwrap().frames, [START + 3, START + 4]);
    }
}

#[test]
fn recovery_keeps_every_whole_frame_of_a_truncated_torn_run() {
    let bytes = recorded(&run_info(Detail::Substeps), END);
    let file = Shared::default();
    open(&bytes).recover(file.clone()).unwrap();
    assert!(file.contents() == bytes, "a sound file is recovered byte for byte");
    for cut in (0..bytes.len()).step_by(11) {
        let Ok(mut damaged) = Playback::read(Cursor::new(bytes[..cut].to_vec())) else { continue };
        let file = Shared::default();
        damaged.recover(file.clone()).unwrap();
        let comparison = compare(&mut damaged, &mut open(&file.contents()), 0.0).unwrap();
        assert_eq!((comparison.differences, comparison.time_samples), (vec![], damaged.time_samples().len()));
    }
}

#[test]
fn a_torn_run_differs_from_a_whole_one_where_it_tears() {
    let run = falling::run_info();
    let mut whole = open(&falling::whole_run(&run).0);
    let mut torn = open(&recorded(&run_info(Detail::Frames), END));
    let comparison = compare(&mut whole, &mut torn, 0.0).unwrap();
    let mesh = Difference::Mesh { name: CLOTH.to_owned(), frame: START + 3, substep: 1 };
    assert_eq!(comparison.differences, [mesh]);
    assert_eq!(
        compare(&mut torn, &mut open(&recorded(&run_info(Detail::Frames), END)), 0.0).unwrap().differences,
        []
    );
}

#[test]
fn invalid_meshes_and_unknown_objects_are_refused() {
    let sample = SubstepIndex { substep: 1, substeps: 1 };
    let refusal = |name: &str, corner: u32| {
        let mut recorder =
            Recorder::to_writer(Shared::default(), &falling::run_info(), falling::objects()).unwrap();
        recorder.record_start(&Falling::INITIAL).unwrap();
        let faces = Faces::from_iter([&[0, 1, corner][..]]);
        let mut observer = recorder.frame(START + 1).unwrap();
        observer.change_mesh(sample, name, faces, vec![[0.0; 3]; 3]);
        observer.substep(sample, &Falling { frame: START + 1, substep: SUBSTEPS });
        recorder.end_frame(&()).map_err(|error| error.to_string())
    };
    assert_eq!(refusal("floor", 2), Ok(()));
    assert_eq!(refusal("flour", 2), Err("there is no object `flour` whose mesh could change".to_owned()));
    assert_eq!(refusal("floor", 3), Err("a face of `floor` names a point that is not there".to_owned()));
    let mut objects = falling::objects();
    objects[0].1.rest.pop();
    let error = Recorder::to_writer(Shared::default(), &falling::run_info(), objects).err().unwrap();
    assert!(matches!(error, RecordError::BadMesh { object } if object == CLOTH));
}
