//! Refused files and runs, and their error messages.

use std::fs;
use std::io::Cursor;
use std::path::Path;

use nucleus_cache::{OpenError, Playback, ReadError, RecordError, Recorder, RunInfo, Source};
use nucleus_core::{ClothId, ColliderId};

use crate::falling;

fn refusal(path: &Path) -> OpenError {
    Playback::open(path).err().expect("it should be refused")
}

fn create_error(path: &Path) -> RecordError {
    Recorder::create(path, &falling::run_info(), falling::objects()).err().expect("it should be refused")
}

/// A cache of one frame, without copies, in which `from` is replaced by `to` of the same length.
fn forged(from: &str, to: &str) -> Result<Playback<Cursor<Vec<u8>>>, OpenError> {
    let (mut bytes, _) = falling::whole_run(&falling::run_info());
    let first = mcap::Summary::read(&bytes).unwrap().unwrap().chunk_indexes[0].clone();
    bytes.truncate((first.chunk_start_offset + first.chunk_length) as usize);
    let at = bytes.windows(from.len()).position(|window| window == from.as_bytes()).unwrap();
    bytes[at..at + to.len()].copy_from_slice(to.as_bytes());
    Playback::read(Cursor::new(bytes))
}

#[test]
fn a_missing_file_a_folder_and_an_empty_file_have_different_errors() {
    let folder = tempfile::tempdir().unwrap();
    let empty = folder.path().join("empty.mcap");
    fs::write(&empty, "").unwrap();
    assert!(matches!(refusal(&folder.path().join("none.mcap")), OpenError::Io { .. }));
    assert!(matches!(refusal(folder.path()), OpenError::Folder { .. }));
    assert!(matches!(refusal(&empty), OpenError::Empty));
}

#[test]
fn a_file_that_is_not_mcap_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scene.ron");
    fs::write(&path, "Scene(time: (start: 1))").unwrap();
    assert_eq!(refusal(&path).to_string(), "this is not an MCAP file");
}

#[test]
fn an_mcap_file_of_another_tool_is_refused_by_name() {
    let mut bytes = Cursor::new(Vec::new());
    mcap::WriteOptions::new().profile("ros2").library("bag 9").create(&mut bytes).unwrap().finish().unwrap();
    let error = Playback::read(bytes).err().unwrap();
    let OpenError::OtherTool { profile, library } = error else { panic!("{error}") };
    assert_eq!((profile.as_str(), library.as_str()), ("ros2", "bag 9"));
}

#[test]
fn a_later_format_version_is_refused_with_both_versions() {
    // Length of the key, key, length of the value, value.
    let error = forged("format\u{1}\0\0\x001", "format\u{1}\0\0\x007").err().unwrap();
    let OpenError::Newer { format, known, .. } = error else { panic!("{error}") };
    assert_eq!((format, known), (7, 1));
}

#[test]
fn a_cache_is_replaced_only_on_request_and_any_other_file_never() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.mcap");
    let older = falling::whole_run(&falling::with_substeps()).0;
    fs::write(&path, &older).unwrap();
    assert!(matches!(create_error(&path), RecordError::Exists { .. }));
    let mut recorder = Recorder::replace(&path, &falling::run_info(), falling::objects()).unwrap();
    falling::record(&mut recorder, falling::END).unwrap();
    assert_eq!(fs::read(&path).unwrap(), older, "the older one is there until the new one is whole");
    recorder.finish().unwrap();
    assert_eq!(Playback::open(&path).unwrap().run(), &falling::run_info());

    fs::write(&path, "my thesis").unwrap();
    let replaced = Recorder::replace(&path, &falling::run_info(), falling::objects());
    assert!(matches!(replaced, Err(RecordError::NotOurs { .. })));
    assert_eq!(fs::read_to_string(&path).unwrap(), "my thesis");
    assert!(matches!(create_error(folder.path()), RecordError::NotAFile { .. }));
    assert!(matches!(create_error(&folder.path().join("no/such/run.mcap")), RecordError::Create { .. }));
}

#[test]
fn a_cache_gets_its_name_only_when_it_is_whole() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.mcap");
    let growing = nucleus_cache::part_path(&path);
    let mut recorder = Recorder::create(&path, &falling::run_info(), falling::objects()).unwrap();
    falling::record(&mut recorder, falling::START + 3).unwrap();
    assert!(!path.exists());
    assert_eq!(Playback::open(&growing).unwrap().time_samples().len(), 4, "it can be read while it grows");
    assert!(matches!(create_error(&path), RecordError::InUse { .. }));
    drop(recorder); // like a kill
    assert!(matches!(create_error(&path), RecordError::Unfinished { .. }));
    let mut recorder = Recorder::replace(&path, &falling::run_info(), falling::objects()).unwrap();
    falling::record(&mut recorder, falling::END).unwrap();
    recorder.finish().unwrap();
    assert!(path.exists() && !growing.exists());
}

#[cfg(unix)]
#[test]
fn a_read_only_folder_gives_the_error_of_the_system() {
    use std::os::unix::fs::PermissionsExt;
    let folder = tempfile::tempdir().unwrap();
    fs::set_permissions(folder.path(), fs::Permissions::from_mode(0o555)).unwrap();
    let path = folder.path().join("run.mcap");
    // The superuser ignores permissions.
    if fs::write(folder.path().join("probe"), "").is_err() {
        assert!(matches!(create_error(&path), RecordError::Create { .. }));
    }
    fs::set_permissions(folder.path(), fs::Permissions::from_mode(0o755)).unwrap();
}

#[test]
fn an_invalid_run_is_refused_before_a_file_is_created() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.mcap");
    let run = RunInfo { frames_per_second: 0.0, ..falling::run_info() };
    assert!(matches!(Recorder::create(&path, &run, falling::objects()), Err(RecordError::BadRun { .. })));
    let twice = falling::objects().into_iter().chain(falling::objects()).collect();
    let doubled = Recorder::create(&path, &falling::run_info(), twice);
    assert!(matches!(doubled, Err(RecordError::DuplicateName { name }) if name.starts_with("a|b")));
    assert!(!path.exists());
}

#[test]
fn a_frame_out_of_order_is_refused() {
    let disk = falling::Shared::default();
    let mut recorder = Recorder::to_writer(disk, &falling::run_info(), falling::objects()).unwrap();
    falling::record(&mut recorder, falling::START + 2).unwrap();
    let error = recorder.frame(falling::START + 1).err().unwrap();
    assert_eq!(error.to_string(), "frame 11 cannot follow frame 12: frame 13 is next");
}

#[test]
fn a_frame_that_was_not_stepped_is_refused_with_the_frame_that_is_expected() {
    let run = RunInfo { end: falling::START + 5, interval: 2, ..falling::run_info() };
    let mut recorder = Recorder::to_writer(falling::Shared::default(), &run, falling::objects()).unwrap();
    let start = falling::START;
    falling::record_frames(&mut recorder, []).unwrap();
    let not_stepped = |recorder: &mut Recorder<_>, frame: i32| {
        let error = recorder.end_frame(&()).unwrap_err();
        assert!(matches!(error, RecordError::NotStepped { expected } if expected == frame), "{error}");
    };
    not_stepped(&mut recorder, start + 2);
    for frame in [start + 1, start + 4] {
        let error = recorder.frame(frame).err().unwrap();
        let is_next = matches!(error, RecordError::FrameOrder { expected, .. } if expected == start + 2);
        assert!(is_next, "{error}");
    }
    let error = recorder.frame(start + 100).err().unwrap();
    assert_eq!(error.to_string(), "frame 110 cannot be recorded: the run was announced to end at frame 15");
    recorder.frame(start + 2).unwrap();
    not_stepped(&mut recorder, start + 2);
}

#[test]
fn the_errors_of_a_recorder_name_functions_and_no_options_of_a_command() {
    let path = std::path::PathBuf::from("run.mcap");
    for error in [RecordError::Exists { path: path.clone() }, RecordError::Unfinished { path }] {
        let text = error.to_string();
        assert!(text.contains("`Recorder::replace`") && !text.contains("--"), "{text}");
    }
}

#[test]
fn an_object_with_another_number_of_points_is_named() {
    let disk = falling::Shared::default();
    let mut objects = falling::objects();
    objects[1].1.rest.push([0.0; 3]);
    let mut recorder = Recorder::to_writer(disk, &falling::run_info(), objects).unwrap();
    let error = falling::record(&mut recorder, falling::END).unwrap_err();
    assert_eq!(error.to_string(), "`floor` has 3 points in the solver but was announced with 4");
}

#[test]
fn an_object_that_a_cache_lacks_is_refused() {
    let (bytes, _) = falling::whole_run(&falling::run_info());
    let mut cache = Playback::read(Cursor::new(bytes)).unwrap();
    let is_refused = |error: ReadError| matches!(error, ReadError::NoObject { object: 99, .. });
    assert!(cache.surface_shape(99).is_err_and(is_refused));
    assert!(cache.particle_spacing(99).is_err_and(is_refused));
}

#[test]
fn an_object_that_the_solver_lacks_is_refused_when_it_is_recorded() {
    for source in [Source::Cloth(ClothId(1)), Source::Collider(ColliderId(u32::MAX))] {
        let mut objects = falling::objects();
        objects[0].0 = source;
        let mut recorder =
            Recorder::to_writer(Cursor::new(Vec::new()), &falling::run_info(), objects).unwrap();
        let error = recorder.record_start(&falling::Falling::INITIAL).unwrap_err();
        assert!(matches!(error, RecordError::NoSource { .. }), "{error}");
    }
}
