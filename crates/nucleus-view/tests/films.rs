//! A recorded run as pictures.

mod sample;

use nucleus_cache::Playback;
use nucleus_view::{Camera, Film, Ground, Style, ViewError};
use sample::{FRAMES, Sample};

fn small() -> Style {
    Style { size: [96, 54], samples: 1, ..Style::default() }
}

fn recorded(sample: Sample) -> (tempfile::TempDir, Playback) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.mcap");
    sample::write(&path, sample);
    let cache = Playback::open(&path).unwrap();
    (folder, cache)
}

#[test]
fn a_film_has_a_picture_for_each_frame_however_finely_time_was_recorded() {
    for substeps in [false, true] {
        let (_folder, mut cache) = recorded(Sample { substeps, ..Sample::default() });
        let mut film = Film::of(&mut cache, 1, small()).unwrap();
        assert_eq!(film.len(), FRAMES as usize);
        assert_ne!(film.picture(3).unwrap(), film.picture(4).unwrap());
        assert_eq!(Film::of(&mut cache, 10, small()).unwrap().len(), 3);
    }
}

#[test]
fn recording_substeps_changes_no_picture_of_a_frame() {
    let (_a, mut frames) = recorded(Sample::default());
    let (_b, mut substeps) = recorded(Sample { substeps: true, ..Sample::default() });
    let picture = |cache: &mut Playback| Film::of(cache, 1, small()).unwrap().picture(12).unwrap();
    assert_eq!(picture(&mut frames), picture(&mut substeps));
}

#[test]
fn the_floor_stands_still_while_things_move() {
    let (_folder, mut cache) = recorded(Sample::default());
    let camera = Camera { eye: [1.0, 6.0, 30.0], target: [1.0, -1.0, 0.0], field_of_view: 20.0 };
    let mut film = Film::of(&mut cache, 1, small()).unwrap().seen_by(camera);
    let [first, last] = [0, 23].map(|place| film.picture(place).unwrap());
    let row = |image: &nucleus_view::Image| (0..96).map(|x| image.pixel(x, 53)).collect::<Vec<_>>();
    assert_eq!(row(&first), row(&last), "in front of everything");
    assert_ne!(first, last);
    let bare = Style { ground: Ground::None, ..small() };
    let without = Film::of(&mut cache, 1, bare).unwrap().seen_by(camera).picture(0).unwrap();
    assert_ne!(row(&without), row(&first));
}

#[test]
fn a_written_film_plays_as_fast_as_the_run() {
    let (folder, mut cache) = recorded(Sample { broken: true, ..Sample::default() });
    let path = folder.path().join("film.png");
    Film::of(&mut cache, 2, small()).unwrap().write(&path).unwrap();
    let file = std::io::BufReader::new(std::fs::File::open(&path).unwrap());
    let mut reader = png::Decoder::new(file).read_info().unwrap();
    assert_eq!(reader.info().animation_control.unwrap().num_frames, 12);
    reader.next_frame(&mut vec![0; 96 * 54 * 3]).unwrap();
    let shown = reader.info().frame_control.unwrap();
    assert_eq!(f64::from(shown.delay_num) / f64::from(shown.delay_den), 2.0 / 24.0);
}

#[test]
fn a_damaged_frame_is_said_to_be_damaged() {
    let (folder, _) = recorded(Sample::default());
    let path = folder.path().join("run.mcap");
    let mut bytes = std::fs::read(&path).unwrap();
    let middle = bytes.len() / 2;
    bytes[middle] ^= 0xFF;
    std::fs::write(&path, bytes).unwrap();
    let mut cache = Playback::open(&path).unwrap();
    assert!(matches!(Film::of(&mut cache, 1, small()), Err(ViewError::Read { .. })));
}
