//! Recovery of damaged files.

use std::io::Cursor;

use nucleus_cache::{Playback, compare};

use crate::falling::{self, Shared};

fn recovered(bytes: &[u8]) -> (Vec<u8>, nucleus_cache::Recovered, Playback<Cursor<Vec<u8>>>) {
    let mut damaged = Playback::read(Cursor::new(bytes.to_vec())).unwrap();
    let file = Shared::default();
    let recovered = damaged.recover(file.clone()).unwrap();
    (file.contents(), recovered, damaged)
}

#[test]
fn recovery_keeps_every_whole_frame_of_a_truncated_file() {
    let (bytes, _) = falling::whole_run(&falling::with_substeps());
    for cut in (0..bytes.len()).step_by(7) {
        let Ok(mut damaged) = Playback::read(Cursor::new(bytes[..cut].to_vec())) else { continue };
        let (saved, recovered, _) = recovered(&bytes[..cut]);
        let mut cache = Playback::read(Cursor::new(saved)).unwrap();
        assert!(
            !cache.corruption().truncated && !cache.corruption().index,
            "cut at {cut}: {}",
            cache.corruption()
        );
        let comparison = compare(&mut damaged, &mut cache, 0.0).unwrap();
        assert_eq!(comparison.differences, [], "cut at {cut}");
        assert_eq!(comparison.time_samples, damaged.time_samples().len());
        assert_eq!(cache.run(), damaged.run());
        assert_eq!(recovered.damaged, 0);
    }
}

#[test]
fn a_sound_file_is_recovered_byte_for_byte() {
    let (bytes, _) = falling::whole_run(&falling::with_substeps());
    let (saved, recovered, damaged) = recovered(&bytes);
    assert_eq!((recovered.bytes, saved.len() as u64), (bytes.len() as u64, bytes.len() as u64));
    assert!(saved == bytes && damaged.corruption().is_intact());
}

#[test]
fn recovery_leaves_out_damaged_frames_and_reports_them() {
    let (mut bytes, _) = falling::whole_run(&falling::run_info());
    let chunk = mcap::Summary::read(&bytes).unwrap().unwrap().chunk_indexes[4].clone();
    bytes[(chunk.chunk_start_offset + chunk.chunk_length) as usize - 9] ^= 1;
    let (saved, recovered, damaged) = recovered(&bytes);
    assert_eq!((recovered.frames as i32, recovered.damaged), (falling::END - falling::START, 1));
    assert_eq!(damaged.corruption().frames, [falling::START + 4]);
    let mut cache = Playback::read(Cursor::new(saved)).unwrap();
    assert_eq!(cache.verify().unwrap().frames, [falling::START + 4], "what is gone stays named");
}

/// A cache of a version without redundant copies.
const OLD: &[u8] = include_bytes!("../old/without_copies.mcap");

#[test]
fn a_cache_of_a_version_without_copies_opens() {
    let mut cache = Playback::read(Cursor::new(OLD.to_vec())).unwrap();
    assert!(cache.verify().unwrap().is_intact(), "{}", cache.corruption());
    assert_eq!((cache.time_samples().len(), cache.objects().len()), (5, 2));
    let (saved, ..) = recovered(OLD);
    let mut with_copies = Playback::read(Cursor::new(saved)).unwrap();
    assert_eq!(compare(&mut cache, &mut with_copies, 0.0).unwrap().differences, []);
}

/// A cache without copies and with zeroed bytes in `hole`, with its index and without.
fn without_start(bytes: &[u8], hole: std::ops::Range<usize>) -> [Vec<u8>; 2] {
    let mut holed = falling::without_copies(bytes);
    holed[hole].fill(0);
    let cut = holed[..holed.len() - 20].to_vec();
    [holed, cut]
}

#[test]
fn a_lost_record_of_the_run_costs_no_frame() {
    for run in [falling::run_info(), falling::with_all_channels()] {
        let bytes = falling::whole_run(&run).0;
        let first =
            mcap::Summary::read(&bytes).unwrap().unwrap().chunk_indexes[0].chunk_start_offset as usize;
        let mut sound = Playback::read(Cursor::new(bytes.clone())).unwrap();
        for holed in without_start(&bytes, 0..first) {
            let (saved, ..) = recovered(&holed);
            for file in [holed, saved] {
                let mut cache = Playback::read(Cursor::new(file)).unwrap();
                assert_eq!(compare(&mut cache, &mut sound, 0.0).unwrap().differences, []);
                let found = cache.run();
                assert_eq!((found.start, found.end, found.frames_per_second), (run.start, run.end, 24.0));
                assert_eq!((found.detail, found.velocities), (run.detail, run.velocities));
                assert_eq!(cache.time_samples(), sound.time_samples());
            }
        }
    }
}

#[test]
fn without_its_first_chunk_and_all_copies_a_cache_shows_points() {
    let bytes = falling::whole_run(&falling::with_all_channels()).0;
    let chunk = mcap::Summary::read(&bytes).unwrap().unwrap().chunk_indexes[0].clone();
    let end = (chunk.chunk_start_offset + chunk.chunk_length) as usize;
    let mut sound = Playback::read(Cursor::new(bytes.clone())).unwrap();
    for (holed, name) in without_start(&bytes, 0..end).into_iter().zip(["a|b:cloth/1 \u{e4}", "object 1"]) {
        let (saved, _, damaged) = recovered(&holed);
        assert!(damaged.corruption().run && !damaged.corruption().can_resume(), "{}", damaged.corruption());
        assert_eq!(damaged.corruption().meshes[0], name);
        for file in [holed, saved] {
            let mut cache = Playback::read(Cursor::new(file)).unwrap();
            assert_eq!(cache.objects()[0].faces.len(), 0);
            for sample in 1..sound.time_samples().len() {
                let time = sound.time_samples()[sample].time;
                let same = cache.time_samples().iter().position(|found| found.time == time).unwrap();
                assert_eq!(cache.positions(0, same).unwrap(), sound.positions(0, sample).unwrap());
                assert_eq!(cache.contacts(0, same).unwrap(), sound.contacts(0, sample).unwrap());
            }
        }
    }
}
