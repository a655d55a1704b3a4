//! Playback returns what the recorder was given.

use std::io::Cursor;

use nucleus_cache::{Detail, Playback, Recorder, RunInfo};

use nucleus_core::ContactState;

use crate::falling::{self, END, Falling, SHOVE, START, SUBSTEPS, Shared};

fn open(run: &RunInfo) -> Playback<Cursor<Vec<u8>>> {
    Playback::read(Cursor::new(falling::whole_run(run).0)).unwrap()
}

#[test]
fn every_frame_comes_back_bit_for_bit() {
    let mut cache = open(&falling::run_info());
    assert_eq!(cache.time_samples().len() as i32, END - START + 1);
    assert_eq!(cache.positions(0, 0).unwrap(), Falling::INITIAL.cloth_positions(100.0));
    for frame in START + 1..=END {
        let sample = cache.end_of(frame).unwrap();
        let expected = Falling { frame, substep: SUBSTEPS }.cloth_positions(100.0);
        assert_eq!(cache.positions(0, sample).unwrap(), expected, "frame {frame}");
    }
    assert!(cache.corruption().is_intact(), "{}", cache.corruption());
}

#[test]
fn every_substep_comes_back_with_its_velocities() {
    let mut cache = open(&falling::with_substeps());
    assert_eq!(cache.time_samples().len() as i32, 1 + (END - START) * SUBSTEPS as i32);
    for sample in 1..cache.time_samples().len() {
        let (frame, substep) = (cache.time_samples()[sample].frame, cache.time_samples()[sample].substep);
        let state = Falling { frame, substep };
        assert_eq!(cache.positions(0, sample).unwrap(), state.cloth_positions(100.0));
        let velocities = cache.velocities(0, sample).unwrap().unwrap();
        assert_eq!(velocities[2], [0.0, -100.0 * frame as f32, 200.0]);
    }
}

#[test]
fn contacts_and_strain_come_back_where_they_were_recorded() {
    let mut cache = open(&falling::with_all_channels());
    assert_eq!(cache.run(), &falling::with_all_channels());
    for sample in 1..cache.time_samples().len() {
        let contacts = cache.contacts(0, sample).unwrap().unwrap();
        let first = if cache.time_samples()[sample].frame >= SHOVE {
            ContactState::Depenetrating
        } else {
            ContactState::Free
        };
        assert_eq!(
            contacts,
            [first, ContactState::Touching, ContactState::Compressed, ContactState::Intersecting]
        );
        // The cloth is recorded in centimetres, a hundred times as large as its rest mesh.
        assert_eq!(cache.strain(0, sample).unwrap().unwrap(), [99.0; 4]);
    }
    assert_eq!((cache.contacts(1, 3).unwrap(), cache.strain(1, 3).unwrap()), (None, None), "of a collider");
    let mut plain = open(&falling::run_info());
    assert_eq!((plain.contacts(0, 3).unwrap(), plain.strain(0, 3).unwrap()), (None, None));
    assert!(cache.contacts(7, 3).is_err() && cache.contacts(0, 99).is_err());
}

#[test]
fn a_time_sample_has_frame_substep_and_time() {
    let cache = open(&falling::with_substeps());
    let first = cache.time_samples()[0];
    assert_eq!((first.frame, first.substep, first.time), (START, 0, 0.0));
    let third = cache.time_samples()[1 + SUBSTEPS as usize];
    assert_eq!((third.frame, third.substep, third.substeps), (START + 2, 1, SUBSTEPS));
    assert!((third.time - (1.0 + 1.0 / f64::from(SUBSTEPS)) / 24.0).abs() < 1e-9);
}

#[test]
fn metadata_and_objects_come_back() {
    let cache = open(&falling::run_info());
    assert_eq!(cache.run(), &falling::run_info());
    let objects: Vec<_> = falling::objects().into_iter().map(|(_, object)| object).collect();
    assert_eq!(cache.objects(), objects);
}

#[test]
fn a_collider_is_recorded_only_when_it_moves() {
    let mut cache = open(&falling::run_info());
    let messages = cache.channels().find(|(topic, ..)| *topic == "/floor/points").unwrap().2;
    assert_eq!(messages, 2);
    let (before, after) = (cache.end_of(SHOVE - 1).unwrap(), cache.end_of(END).unwrap());
    assert_eq!(cache.positions(1, before).unwrap()[0], [0.0, -100.0, 0.0]);
    assert_eq!(cache.positions(1, after).unwrap()[0], [100.0, -100.0, 0.0]);
}

#[test]
fn a_run_of_colliders_alone_has_every_frame_though_nothing_moves_in_most() {
    let (file, run) = (Shared::default(), falling::run_info());
    let colliders = falling::objects().split_off(1);
    let mut recorder = Recorder::to_writer(file.clone(), &run, colliders).unwrap();
    falling::record(&mut recorder, run.end).unwrap();
    recorder.finish().unwrap();
    let mut cache = Playback::read(Cursor::new(file.contents())).unwrap();
    assert_eq!(cache.time_samples().len() as i32, END - START + 1);
    assert!(cache.corruption().is_intact(), "{}", cache.corruption());
    let after = cache.end_of(END).unwrap();
    assert_eq!(cache.positions(0, after).unwrap()[0], [100.0, -100.0, 0.0]);
}

#[test]
fn each_frame_has_its_report() {
    let reports = open(&falling::run_info()).reports().unwrap();
    let frames: Vec<i64> = reports.iter().map(|report| report["frame"].as_i64().unwrap()).collect();
    assert_eq!(frames, (i64::from(START) + 1..=i64::from(END)).collect::<Vec<_>>());
    assert_eq!(reports[0]["max_strain"], 0.5);
    assert!(reports[0]["min_gap"].is_null(), "JSON has no infinity");
}

#[test]
fn a_report_counts_points_by_contact_state_where_contacts_are_recorded() {
    for report in open(&falling::with_all_channels()).reports().unwrap() {
        assert_eq!((&report["touching"], &report["compressed"]), (&1.into(), &1.into()), "{report}");
    }
    assert!(open(&falling::run_info()).reports().unwrap()[0].get("touching").is_none());
}

#[test]
fn the_same_run_gives_the_same_bytes() {
    let run = falling::with_substeps();
    assert_eq!(falling::whole_run(&run).0, falling::whole_run(&run).0);
}

#[test]
fn the_returned_size_is_the_size_of_the_file() {
    let (bytes, recorded) = falling::whole_run(&falling::run_info());
    assert_eq!(recorded.bytes, bytes.len() as u64);
    assert_eq!(recorded.frames as i32, END - START + 1);
}

/// The browser's player relies on this; read with the `mcap` crate only.
#[test]
fn any_mcap_reader_finds_channels_schemas_and_one_chunk_per_frame() {
    let (bytes, _) = falling::whole_run(&falling::run_info());
    let summary = mcap::Summary::read(&bytes).unwrap().unwrap();
    assert_eq!(summary.chunk_indexes.len() as i32, END - START + 1);
    let mut topics: Vec<_> = summary.channels.values().map(|channel| channel.topic.as_str()).collect();
    topics.sort_unstable();
    let cloth = "/a|b:cloth/1 \u{e4}";
    let expected = [&*format!("{cloth}/points"), &*format!("{cloth}/topology"), "/floor/points"];
    assert_eq!(topics[..3], expected);
    assert_eq!(topics[3..], ["/floor/topology", "/report"]);
    let schema = |name: &str| summary.schemas.values().any(|s| s.name == name && s.encoding == "text");
    assert!(schema("nucleus.points.v1") && schema("nucleus.topology.v1"));
}

#[test]
fn every_nth_frame_and_the_last_are_recorded_with_all_motion_between_them() {
    // The collider moves in the third frame after the start: in a recorded frame, or in one before or after it.
    for n in [2, 3, 4, 5] {
        let run = RunInfo { detail: Detail::Every(n), ..falling::run_info() };
        let mut cache = open(&run);
        let frames: Vec<i32> = cache.time_samples().iter().map(|sample| sample.frame).collect();
        let mut expected: Vec<i32> = (START..=END).step_by(n as usize).collect();
        if expected.last() != Some(&END) {
            expected.push(END);
        }
        assert_eq!(frames, expected);
        assert!(cache.corruption().is_intact(), "{}", cache.corruption());
        for sample in 0..frames.len() {
            let shoved = if frames[sample] >= SHOVE { 100.0 } else { 0.0 };
            assert_eq!(
                cache.positions(1, sample).unwrap()[0][0],
                shoved,
                "every {n}, frame {}",
                frames[sample]
            );
        }
        assert_eq!(cache.reports().unwrap().len() as i32, END - START, "reports are of every frame");
    }
}

#[test]
fn frames_that_a_run_does_not_solve_are_not_missing() {
    for detail in [Detail::Frames, Detail::Substeps, Detail::Every(3)] {
        let run = RunInfo { detail, interval: 2, ..falling::run_info() };
        let file = Shared::default();
        let mut recorder = Recorder::to_writer(file.clone(), &run, falling::objects()).unwrap();
        falling::record_frames(
            &mut recorder,
            (START + 1..=END).filter(|k| (k - START) % 2 == 0 || *k == END),
        )
        .unwrap();
        recorder.finish().unwrap();
        let mut cache = Playback::read(Cursor::new(file.contents())).unwrap();
        assert!(cache.verify().unwrap().is_intact(), "{detail:?}: {}", cache.corruption());
    }
}

#[test]
fn substeps_of_a_run_that_solves_every_second_frame_share_both_frames() {
    let run = RunInfo { interval: 2, end: START + 5, ..falling::with_substeps() };
    let file = Shared::default();
    let mut recorder = Recorder::to_writer(file.clone(), &run, falling::objects()).unwrap();
    falling::record_frames(&mut recorder, [START + 2, START + 4, START + 5]).unwrap();
    recorder.finish().unwrap();
    let cache = Playback::read(Cursor::new(file.contents())).unwrap();
    let found: Vec<_> =
        cache.time_samples().iter().map(|sample| (sample.frame - START, sample.time * 24.0)).collect();
    let thirds = [0.0, 2.0, 4.0, 6.0, 8.0, 10.0, 12.0, 13.0, 14.0, 15.0];
    for ((frame, time), (expected, third)) in
        found.iter().zip([0, 2, 2, 2, 4, 4, 4, 5, 5, 5].into_iter().zip(thirds))
    {
        assert_eq!(*frame, expected);
        assert!((time - third / 3.0).abs() < 1e-6, "{time} {third}");
    }
    assert_eq!(found.len(), thirds.len());
}
