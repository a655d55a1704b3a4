//! Truncation at every byte and a flipped bit in every byte: whole frames play, all others are reported.

use std::collections::BTreeMap;
use std::io::Cursor;

use nucleus_cache::{OpenError, Playback, Recorder, RunInfo, TextureCoordinates};

use crate::falling::{self, END, Falling, START, SUBSTEPS, Shared};

fn open(bytes: &[u8]) -> Result<Playback<Cursor<&[u8]>>, OpenError> {
    Playback::read(Cursor::new(bytes))
}

/// Reads everything; fails when a readable frame differs from the recorded one.
fn frames_that_play(cache: &mut Playback<Cursor<&[u8]>>) -> Vec<i32> {
    let mut played = Vec::new();
    for sample in 0..cache.time_samples().len() {
        let frame = cache.time_samples()[sample].frame;
        let state = if frame == START { Falling::INITIAL } else { Falling { frame, substep: SUBSTEPS } };
        if let Ok(positions) = cache.positions(0, sample) {
            assert_eq!(positions, state.cloth_positions(100.0), "frame {frame}");
            played.push(frame);
        }
    }
    played
}

/// End offsets of all chunks.
fn chunk_ends(bytes: &[u8]) -> Vec<u64> {
    let summary = mcap::Summary::read(bytes).unwrap().unwrap();
    summary.chunk_indexes.iter().map(|chunk| chunk.chunk_start_offset + chunk.chunk_length).collect()
}

#[test]
fn a_file_cut_off_at_any_byte_plays_every_whole_frame() {
    let (bytes, _) = falling::whole_run(&falling::run_info());
    let ends = chunk_ends(&bytes);
    for cut in 0..bytes.len() {
        let whole = ends.iter().filter(|&&end| end <= cut as u64).count();
        match open(&bytes[..cut]) {
            Ok(mut cache) => {
                assert_eq!(frames_that_play(&mut cache).len(), whole, "cut at {cut}");
                assert!(!cache.corruption().is_intact(), "cut at {cut}");
            }
            Err(error) => assert_eq!(whole, 0, "cut at {cut}: {error}"),
        }
    }
}

#[test]
fn a_flipped_bit_is_never_played_and_never_panics() {
    let (bytes, _) = falling::whole_run(&falling::run_info());
    for at in 0..bytes.len() {
        let mut flipped = bytes.clone();
        flipped[at] ^= 1 << (at % 8);
        let Ok(mut cache) = open(&flipped) else { continue };
        let played = frames_that_play(&mut cache);
        let lost = cache.verify().unwrap().frames.clone();
        let whole: Vec<i32> = (START..=END).filter(|frame| !lost.contains(frame)).collect();
        let tail_lost = whole.starts_with(&played);
        assert!(tail_lost, "byte {at}: played {played:?}, named as lost {lost:?}");
        assert!(
            played.len() == whole.len() || cache.corruption().truncated,
            "byte {at}: {}",
            cache.corruption()
        );
        assert!(played.len() as i32 >= END - START, "byte {at} costs more than one frame: {played:?}");
    }
}

#[test]
fn a_killed_run_with_a_damaged_length_loses_that_frame_only() {
    let (bytes, _) = falling::whole_run(&falling::run_info());
    let summary = mcap::Summary::read(&bytes).unwrap().unwrap();
    let begin = summary.chunk_indexes[3].chunk_start_offset as usize;
    let killed = &bytes[..chunk_ends(&bytes)[6] as usize];
    for at in begin..begin + 9 {
        for bit in 0..8 {
            let mut flipped = killed.to_vec();
            flipped[at] ^= 1 << bit;
            let mut cache = open(&flipped).unwrap();
            assert_eq!(cache.corruption().frames, [START + 3], "byte {at}, bit {bit}");
            assert_eq!(frames_that_play(&mut cache).len(), 6);
        }
    }
}

#[test]
fn a_flipped_bit_in_a_frame_costs_that_frame_only() {
    let (bytes, _) = falling::whole_run(&falling::run_info());
    let end = chunk_ends(&bytes)[4] as usize;
    let mut flipped = bytes.clone();
    flipped[end - 9] ^= 0x10;
    let mut cache = open(&flipped).unwrap();
    let sample = cache.end_of(START + 4).unwrap();
    let error = cache.positions(0, sample).unwrap_err();
    assert_eq!(error.to_string(), format!("frame {} is damaged and cannot be read", START + 4));
    assert_eq!(frames_that_play(&mut cache).len() as i32, END - START);
    assert_eq!(cache.verify().unwrap().to_string(), format!("missing or damaged: frame {}", START + 4));
}

#[test]
fn a_damaged_frame_of_a_killed_run_is_named_when_opened() {
    let (bytes, _) = falling::whole_run(&falling::run_info());
    let ends = chunk_ends(&bytes);
    let mut killed = bytes[..ends[6] as usize].to_vec();
    killed[ends[4] as usize - 9] ^= 0x10;
    let cache = open(&killed).unwrap();
    assert_eq!(cache.corruption().frames, [START + 4]);
    assert!(cache.corruption().truncated);
}

#[test]
fn a_killed_recorder_leaves_all_its_whole_frames() {
    let file = Shared::default();
    let mut recorder = Recorder::to_writer(file.clone(), &falling::run_info(), falling::objects()).unwrap();
    falling::record(&mut recorder, START + 3).unwrap();
    std::mem::forget(recorder); // Like a kill: no destructor runs.
    let bytes = file.contents();
    let mut cache = open(&bytes).unwrap();
    assert_eq!(frames_that_play(&mut cache), [START, START + 1, START + 2, START + 3]);
    assert_eq!(cache.corruption().to_string(), "the file was cut off before its index");
}

#[test]
fn a_run_that_ends_early_but_is_closed_has_lost_nothing() {
    let file = Shared::default();
    let mut recorder = Recorder::to_writer(file.clone(), &falling::run_info(), falling::objects()).unwrap();
    falling::record(&mut recorder, START + 2).unwrap();
    recorder.finish().unwrap();
    let bytes = file.contents();
    let cache = open(&bytes).unwrap();
    assert!(cache.corruption().is_intact(), "{}", cache.corruption());
    assert_eq!((cache.time_samples().len(), cache.run().end), (3, END));
}

/// The corpus has one cache for each outcome of the example `fuzz`.
#[test]
fn no_cache_of_the_corpus_makes_the_reader_panic() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/corpus");
    let mut count = 0;
    for entry in std::fs::read_dir(folder).unwrap() {
        let bytes = std::fs::read(entry.unwrap().path()).unwrap();
        count += 1;
        let Ok(mut cache) = open(&bytes) else { continue };
        for object in 0..cache.objects().len() {
            for sample in 0..cache.time_samples().len() {
                let _ = cache.velocities(object, sample).map(drop);
                let _ = cache.contacts(object, sample).map(drop);
                let _ = cache.strain(object, sample).map(drop);
                if let Ok(positions) = cache.positions(object, sample) {
                    assert_eq!(cache.object_at(object, sample).unwrap().rest.len(), positions.len());
                }
            }
        }
        for frame in cache.checkpoints() {
            let _ = cache.checkpoint(frame).map(drop);
        }
        cache.verify().unwrap();
        cache.reports().unwrap();
        cache.sizes().unwrap();
    }
    assert!(count > 20, "the corpus is there: {count}");
}

/// A run with texture coordinates, which are in a record of their own and in the redundant copies.
fn textured() -> RunInfo {
    let uvs = TextureCoordinates { values: vec![[0.125, 0.5]; 4], corners: Vec::new() };
    RunInfo { texture_coordinates: BTreeMap::from([("cloth".to_owned(), uvs)]), ..falling::run_info() }
}

#[test]
fn a_damaged_record_of_the_run_is_read_from_a_copy_and_reported() {
    let (bytes, _) = falling::whole_run(&textured());
    let record = b"uv cloth";
    let at =
        bytes.windows(record.len()).position(|part| part == record).expect("a record outside the copies");
    for at in at..at + record.len() + 8 {
        let mut flipped = bytes.clone();
        flipped[at] ^= 1;
        let cache = open(&flipped).unwrap();
        assert_eq!(cache.run().texture_coordinates, textured().texture_coordinates, "byte {at}");
        assert!(!cache.corruption().is_intact() && cache.corruption().unrecoverable().is_none(), "byte {at}");
    }
}

#[test]
fn a_record_of_the_run_without_a_sound_copy_is_lost_and_named() {
    let (bytes, _) = falling::whole_run(&textured());
    let mut damaged = falling::without_copies(&bytes);
    let at = damaged.windows(8).position(|part| part == b"uv cloth").expect("a record");
    damaged[at] ^= 1;
    let mut cache = open(&damaged).unwrap();
    assert!(cache.run().texture_coordinates.is_empty());
    let lost = cache.corruption().unrecoverable().expect("a loss");
    assert_eq!(lost, "damaged and left out: the texture coordinates");
    let mut saved = Vec::new();
    cache.recover(Cursor::new(&mut saved)).unwrap();
    assert!(open(&saved).unwrap().verify().unwrap().is_intact(), "the recovered cache has no such record");
}

#[test]
fn damaged_copies_are_reported_and_cost_nothing() {
    let (bytes, _) = falling::whole_run(&textured());
    let copies = mcap::Summary::read(&bytes).unwrap().unwrap().attachment_indexes;
    let mut damaged = bytes.clone();
    for copy in &copies {
        damaged[(copy.offset + copy.length) as usize - 20] ^= 1;
    }
    let mut cache = open(&damaged).unwrap();
    let report = cache.verify().unwrap();
    assert_eq!((report.copies, report.unrecoverable()), (copies.len(), None));
}

#[cfg(unix)]
#[test]
fn a_pipe_is_refused_without_waiting_for_a_writer() {
    let folder = tempfile::tempdir().unwrap();
    let pipe = folder.path().join("pipe.mcap");
    assert!(std::process::Command::new("mkfifo").arg(&pipe).status().unwrap().success());
    assert!(matches!(Playback::open(&pipe), Err(OpenError::NotAFile { .. })));
}
