//! A disk that fills up is told with how far the run got, and what is on it plays.

use std::io::Cursor;

use nucleus_cache::{Playback, RecordError, Recorder};

use crate::falling::{self, Shared};

#[test]
fn a_disk_full_at_any_byte_is_told_and_leaves_what_it_says() {
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
        let playable = Playback::read(Cursor::new(disk.contents())).map_or(0, |cache| cache.moments().len());
        assert!(playable >= frames as usize, "{room} bytes of room: {frames} promised, {playable} there");
        assert!(frames <= recorded.frames);
    }
}

#[test]
fn the_message_says_how_far_the_run_got() {
    let (bytes, _) = falling::whole_run(&falling::run_info());
    let disk = Shared::with_room(bytes.len() as u64 / 2);
    let mut recorder = Recorder::to_writer(disk, &falling::run_info(), falling::objects()).unwrap();
    let error = falling::record(&mut recorder, falling::END).unwrap_err();
    let RecordError::Write { frames, bytes, .. } = &error else { panic!("{error}") };
    assert!(*frames > 0);
    let text = error.to_string();
    assert!(text.contains(&format!("{frames} frames ({bytes} bytes)")), "{text}");
}
