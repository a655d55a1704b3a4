//! A cache as pictures and animations.

mod sample;

use nucleus_cache::{ObjectKind, Playback};
use nucleus_view::{Background, Bounds, Camera, Film, GifWriter, Ground, Image, Style, ViewError, draw};
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
fn a_film_has_a_picture_for_each_frame_with_or_without_recorded_substeps() {
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
fn the_floor_is_constant_while_objects_move() {
    let (_folder, mut cache) = recorded(Sample::default());
    let camera =
        Camera { eye: [1.0, 6.0, 30.0], target: [1.0, -1.0, 0.0], field_of_view: 20.0, ..Camera::default() };
    let mut film = Film::of(&mut cache, 1, small()).unwrap().seen_by(camera);
    let [first, last] = [0, 23].map(|place| film.picture(place).unwrap());
    let row = |image: &Image| (0..96).map(|x| image.pixel(x, 53)).collect::<Vec<_>>();
    assert_eq!(row(&first), row(&last), "in front of everything");
    assert_ne!(first, last);
    let bare = Style { ground: Ground::None, ..small() };
    let without = Film::of(&mut cache, 1, bare).unwrap().seen_by(camera).picture(0).unwrap();
    assert_ne!(row(&without), row(&first));
}

/// Whether the outermost pixels of a picture all show the background, so that no object is cropped.
fn has_margin(picture: &Image, background: &Image) -> bool {
    let [width, height] = picture.size();
    let is_border = |column: u32, row: u32| {
        [(column, width - 1), (row, height - 1)].iter().any(|(at, last)| at.is_multiple_of(*last))
    };
    (0..width * height)
        .map(|k| (k % width, k / width))
        .filter(|&(column, row)| is_border(column, row))
        .all(|(column, row)| picture.pixel(column, row) == background.pixel(column, row))
}

#[test]
fn the_automatic_camera_crops_neither_the_cloth_nor_the_colliders_near_it() {
    let (_folder, mut cache) = recorded(Sample::default());
    let style = Style { ground: Ground::None, ..small() };
    let background = draw(&[], &Camera::default(), &style);
    let mut cloth = Bounds::default();
    cloth.include(&cache.positions(0, 12).unwrap());
    let mut film = Film::of(&mut cache, 1, style.clone()).unwrap();
    assert!(has_margin(&film.picture(12).unwrap(), &background));
    let mut film = film.seen_by(Camera::framing(&cloth, style.size));
    assert!(
        !has_margin(&film.picture(12).unwrap(), &background),
        "a camera that frames the cloth crops a collider"
    );
}

#[test]
fn a_hidden_object_is_neither_drawn_nor_framed_and_the_others_keep_their_colours() {
    let (_folder, mut cache) = recorded(Sample::default());
    let names: Vec<(String, ObjectKind)> =
        cache.objects().iter().map(|object| (object.name.clone(), object.kind)).collect();
    let named = |kind: ObjectKind| -> Vec<String> {
        names.iter().filter(|(_, own)| *own == kind).map(|(name, _)| name.clone()).collect()
    };
    let (cloths, colliders) = (named(ObjectKind::Cloth), named(ObjectKind::Collider));
    let ground = Ground::None;
    let mut seen = |hidden: &[String]| {
        let style = Style { ground, hidden: hidden.to_vec(), ..small() };
        let mut film = Film::of(&mut cache, 1, style).unwrap();
        (film.camera(), film.picture(12).unwrap())
    };
    let reds = |picture: &Image| {
        let pixels = (0..96 * 54).map(|k| picture.pixel(k % 96, k / 96));
        pixels.filter(|[red, green, _]| *red > 80 && *red / 2 > *green).count()
    };
    let [whole, cloth, collider, nothing] =
        [&[][..], &colliders, &cloths, &[&cloths[..], &colliders].concat()].map(&mut seen);
    let background = draw(&[], &Camera::default(), &Style { ground, ..small() });
    assert!(reds(&whole.1) > 0 && reds(&cloth.1) > reds(&whole.1), "nearer without the colliders");
    assert!(reds(&collider.1) == 0 && collider.1 != background);
    assert!(nothing.1 == background && nothing.0 == whole.0, "the camera of all, where none is drawn");
}

#[test]
fn an_animation_plays_in_real_time() {
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
fn a_damaged_frame_is_an_error_of_its_own_picture() {
    let (folder, _) = recorded(Sample::default());
    let path = folder.path().join("run.mcap");
    let mut bytes = std::fs::read(&path).unwrap();
    let middle = bytes.len() / 2;
    bytes[middle] ^= 0xFF;
    std::fs::write(&path, bytes).unwrap();
    let mut cache = Playback::open(&path).unwrap();
    let mut film = Film::of(&mut cache, 1, small()).unwrap();
    let pictures: Vec<_> = (0..film.len()).map(|place| film.picture(place)).collect();
    let damaged = pictures.iter().filter(|picture| picture.is_err()).count();
    assert_eq!(damaged, 1, "of {} pictures", pictures.len());
    let error = pictures.into_iter().find_map(Result::err).unwrap();
    assert!(matches!(error, ViewError::Read { .. }), "{error}");
}

fn write_gif(film: &mut Film<impl std::io::Read + std::io::Seek>, path: &std::path::Path) {
    let mut file = GifWriter::create(path, small().size).unwrap();
    for place in 0..film.len() {
        file.push(&film.picture(place).unwrap(), film.duration(place)).unwrap();
    }
    file.finish().unwrap();
}

/// The durations of the frames of a GIF, in hundredths of a second.
fn gif_delays(path: &std::path::Path) -> Vec<u16> {
    let mut decoder = gif::DecodeOptions::new().read_info(std::fs::File::open(path).unwrap()).unwrap();
    std::iter::from_fn(|| decoder.read_next_frame().unwrap().map(|frame| frame.delay)).collect()
}

/// The durations of the frames of an animated PNG, in seconds.
fn png_delays(path: &std::path::Path) -> Vec<f64> {
    let bytes = std::fs::read(path).unwrap();
    let half = |at: usize| f64::from(u16::from_be_bytes([bytes[at], bytes[at + 1]]));
    let chunks = (0..bytes.len() - 4).filter(|at| &bytes[*at..at + 4] == b"fcTL");
    chunks.map(|at| half(at + 24) / half(at + 26)).collect()
}

#[test]
fn pictures_of_frames_recorded_at_intervals_are_shown_until_the_next_one() {
    let (folder, mut cache) = recorded(Sample { every: 10, ..Sample::default() });
    let path = folder.path().join("film");
    let mut film = Film::of(&mut cache, 1, small()).unwrap();
    assert_eq!((0..film.len()).map(|place| film.frame(place)).collect::<Vec<_>>(), [1, 11, 21, 24]);
    assert_eq!(film.fps(), 24.0, "1 is the greatest common divisor of 10 and 3");
    write_gif(&mut film, &path);
    // 10/24 s, 10/24 s, and 3/24 s for both ends of the last gap.
    assert_eq!(gif_delays(&path), [42, 41, 13, 12]);
    film.write(&path).unwrap();
    assert_eq!(png_delays(&path), [10.0 / 24.0, 10.0 / 24.0, 3.0 / 24.0, 3.0 / 24.0]);
}

#[test]
fn a_gif_of_a_high_frame_rate_has_fewer_pictures_and_plays_in_real_time() {
    for (fps, pictures) in [(50, 24), (60, 12), (120, 8)] {
        let (folder, mut cache) = recorded(Sample { fps, ..Sample::default() });
        let path = folder.path().join("film.gif");
        let mut film = Film::of(&mut cache, 1, small()).unwrap().at_most(GifWriter::MAX_FPS);
        write_gif(&mut film, &path);
        let delays = gif_delays(&path);
        assert_eq!(delays.len(), pictures, "at {fps} frames per second");
        assert!(delays.iter().all(|delay| *delay >= 2), "{delays:?}");
        assert_eq!(u32::from(delays.iter().sum::<u16>()), 2400 / fps, "24 frames at {fps} per second");
    }
}

#[test]
fn a_gif_has_every_frame_and_plays_in_real_time() {
    let (folder, mut cache) = recorded(Sample::default());
    let path = folder.path().join("film.gif");
    let mut film = Film::of(&mut cache, 1, small()).unwrap();
    write_gif(&mut film, &path);
    let mut options = gif::DecodeOptions::new();
    options.set_color_output(gif::ColorOutput::RGBA);
    let mut decoder = options.read_info(std::fs::File::open(&path).unwrap()).unwrap();
    let (mut frames, mut hundredths, mut worst) = (0, 0, 0.0_f64);
    while let Some(frame) = decoder.read_next_frame().unwrap() {
        hundredths += u32::from(frame.delay);
        let picture = film.picture(frames).unwrap();
        let shown = frame.buffer.chunks_exact(4).flat_map(|pixel| &pixel[..3]);
        let off: f64 = shown.zip(picture.bytes()).map(|(a, b)| f64::from(a.abs_diff(*b))).sum();
        worst = worst.max(off / picture.bytes().len() as f64);
        frames += 1;
    }
    assert_eq!((frames, hundredths), (24, 100), "24 frames of 1/24 s are a second");
    assert!(worst < 3.0, "256 colours are off by {worst} of 255 on average");
}

#[test]
fn the_floor_is_the_ground_plane_of_the_scene() {
    let (_folder, mut cache) = recorded(Sample { plane: Some(-1.5), ..Sample::default() });
    let camera =
        Camera { eye: [1.0, 6.0, 30.0], target: [1.0, -1.0, 0.0], field_of_view: 20.0, ..Camera::default() };
    let at = |cache: &mut Playback, ground| {
        let style = Style { ground, ..small() };
        Film::of(cache, 1, style).unwrap().seen_by(camera).picture(0).unwrap()
    };
    let found = at(&mut cache, Ground::Below);
    assert_eq!(found, at(&mut cache, Ground::At(-1.5)));
    assert_ne!(found, at(&mut cache, Ground::At(0.0)));
}

#[test]
fn the_automatic_camera_is_that_of_the_whole_run_for_any_selection_of_frames() {
    let (_folder, mut cache) = recorded(Sample::default());
    let whole = Film::of(&mut cache, 1, small()).unwrap().camera();
    let end = Film::of(&mut cache, 1, small()).unwrap().between(20, 24).unwrap().camera();
    assert_eq!(whole, end);
}

#[test]
fn every_nth_frame_of_a_range_is_counted_from_its_first() {
    let (_folder, mut cache) = recorded(Sample::default());
    let first = cache.time_samples()[0].frame;
    let mut film = Film::of(&mut cache, 10, small()).unwrap().between(first + 4, first + 20).unwrap();
    assert_eq!(film.len(), 2);
    let drawn = film.picture(0).unwrap();
    let expected =
        Film::of(&mut cache, 1, small()).unwrap().between(first + 4, first + 4).unwrap().picture(0).unwrap();
    assert_eq!(drawn, expected);
}

#[test]
fn the_floor_is_the_tilted_ground_plane_of_the_scene() {
    let (_folder, mut cache) = recorded(Sample { plane: Some(-1.5), tilt: 0.5, ..Sample::default() });
    let camera =
        Camera { eye: [1.0, 6.0, 30.0], target: [1.0, -1.0, 0.0], field_of_view: 20.0, ..Camera::default() };
    let at = |cache: &mut Playback, ground| {
        let style = Style { ground, ..small() };
        Film::of(cache, 1, style).unwrap().seen_by(camera).picture(0).unwrap()
    };
    let tilted = Ground::Plane { origin: [0.0, -1.5, 0.0], normal: [0.5, 1.0, 0.0] };
    let found = at(&mut cache, Ground::Below);
    assert_eq!(found, at(&mut cache, tilted));
    assert_ne!(found, at(&mut cache, Ground::At(-1.5)));
    assert_ne!(found, at(&mut cache, Ground::None));
}

#[test]
fn the_floor_moves_with_the_ground_plane() {
    let (_folder, mut cache) = recorded(Sample { plane: Some(-1.5), rise: 0.125, ..Sample::default() });
    let camera =
        Camera { eye: [1.0, 6.0, 30.0], target: [1.0, -1.0, 0.0], field_of_view: 20.0, ..Camera::default() };
    for (place, height) in [(0, -1.5), (8, -0.5)] {
        let at = |cache: &mut Playback, ground| {
            let style = Style { ground, ..small() };
            Film::of(cache, 1, style).unwrap().seen_by(camera).picture(place).unwrap()
        };
        assert_eq!(at(&mut cache, Ground::Below), at(&mut cache, Ground::At(height)), "picture {place}");
    }
}

#[test]
fn an_exr_holds_the_linear_colours_of_the_picture_and_its_opacities() {
    let (folder, mut cache) = recorded(Sample::default());
    let path = folder.path().join("a.exr");
    let style = Style { keeps_linear: true, samples: 2, background: Background::Transparent, ..small() };
    let picture = Film::of(&mut cache, 1, style.clone()).unwrap().picture(12).unwrap();
    picture.write_exr(&path).unwrap();
    let read = exr::prelude::read_first_rgba_layer_from_file(
        &path,
        |size, _| vec![[0.0_f32; 4]; size.width() * size.height()],
        |pixels, at, (red, green, blue, alpha): (f32, f32, f32, f32)| {
            pixels[at.y() * 96 + at.x()] = [red, green, blue, alpha];
        },
    );
    let pixels = read.unwrap().layer_data.channel_data.pixels;
    assert_eq!(pixels.len(), 96 * 54);
    let mut covered = [0; 3];
    for (place, [red, green, blue, alpha]) in pixels.into_iter().enumerate() {
        // Colours are multiplied by the opacity, and bytes are encoded with a square root.
        assert!((alpha * 255.0 - f32::from(picture.alpha()[place])).abs() < 0.7);
        covered[if alpha == 0.0 {
            0
        } else if alpha < 1.0 {
            1
        } else {
            2
        }] += 1;
        for (linear, byte) in [red, green, blue].into_iter().zip(&picture.bytes()[3 * place..]) {
            let encoded = (linear / alpha.max(1e-3)).min(1.0).sqrt() * 255.0;
            assert!((encoded - f32::from(*byte)).abs() < 1.0, "{encoded} and {byte} at {place}");
        }
    }
    assert!(covered.iter().all(|count| *count > 20), "nothing, edges and objects: {covered:?}");
    let style = Style { keeps_linear: false, ..style };
    let without = Film::of(&mut cache, 1, style).unwrap().picture(12).unwrap();
    assert_eq!(without.bytes(), picture.bytes());
    assert!(matches!(without.write_exr(&path), Err(ViewError::NoLinearColours { .. })));
}

/// The bytes of a picture are the same on every machine, so a hash of an inspected picture identifies it.
#[test]
fn the_picture_of_the_synthetic_run_is_the_inspected_one() {
    let (_folder, mut cache) = recorded(Sample::default());
    let image =
        Film::of(&mut cache, 1, Style { size: [320, 180], ..Style::default() }).unwrap().picture(12).unwrap();
    if let Some(kept) = std::env::var_os("NUCLEUS_SCREENS") {
        image.write_png(std::path::Path::new(&kept).join("golden.png")).unwrap();
    }
    let sum = image.bytes().iter().fold(0xcbf2_9ce4_8422_2325_u64, |sum, byte| {
        (sum ^ u64::from(*byte)).wrapping_mul(0x0000_0100_0000_01b3)
    });
    assert_eq!(
        sum, GOLDEN,
        "{sum:#018x}; after an intended change, inspect the picture and write the new hash here"
    );
}

const GOLDEN: u64 = 0x86d2_e5db_f90b_21c1;

#[test]
fn a_mesh_that_changes_is_drawn_with_the_topology_of_each_frame() {
    let (_a, mut whole) = recorded(Sample::default());
    let (_b, mut torn) = recorded(Sample { torn: true, ..Sample::default() });
    let tear = FRAMES as usize / 2;
    // Both films have the same camera, so only the mesh differs.
    let mut films = [Film::of(&mut whole, 1, small()).unwrap(), Film::of(&mut torn, 1, small()).unwrap()];
    for place in [0, tear - 2, tear - 1, FRAMES as usize - 1, 0] {
        let [whole, torn] = films.each_mut().map(|film| film.picture(place).unwrap());
        assert_eq!(whole == torn, place < tear - 1, "picture {place}");
    }
}
