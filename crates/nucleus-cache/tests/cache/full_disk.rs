//! A full disk: the error states how far the run got, and the written frames play.

use std::io::Cursor;

use nucleus_cache::{Playback, RecordError, Recorder};

use crate::falling::{self, Shared};

#[test]
fn a_disk_full_at_any_byte_keeps_the_frames_that_the_error_states() {
    let (bytes, recorded) = falling::whole_run(&falling::run_info());
    for room in 0..bytes.len() as u64 {
        let disk = Shared::with_room(room);
        let run = falling::run_info();
        let result = Recorder::to_writer(disk.clone(), &run, falling::objects()).and_then(|mut recorder| {
            falling::record(&mut recorder, run.end)?;
            recorder.finish()
        });
        let Err(RecordError::Write { frames, bytes, .. }) = result else {
            panic!("{room} bytes of room: {result:?}");
        };
        assert!(bytes <= room);
        let playable =
            Playback::read(Cursor::new(disk.contents())).map_or(0, |cache| cache.time_samples().len());
        assert!(playable >= frames as usize, "{room} bytes of room: {frames} promised, {playable} there");
        assert!(frames <= recorded.frames);
    }
}

#[test]
fn a_full_disk_error_states_the_written_frames_and_bytes() {
    let (bytes, _) = falling::whole_run(&falling::run_info());
    let disk = Shared::with_room(bytes.len() as u64 / 2);
    let mut recorder = Recorder::to_writer(disk, &falling::run_info(), falling::objects()).unwrap();
    let error = falling::record(&mut recorder, falling::END).unwrap_err();
    let RecordError::Write { frames, bytes, .. } = &error else { panic!("{error}") };
    assert!(*frames > 0);
    let text = error.to_string();
    assert!(text.contains(&format!("{frames} frames ({bytes} bytes)")), "{text}");
}
