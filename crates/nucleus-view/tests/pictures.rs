//! Properties of pictures, for any input.

use std::fs::File;
use std::io::BufReader;

use nucleus_core::Faces;
use nucleus_view::{
    AnimationWriter, Background, Bounds, Camera, Colouring, Ground, Image, Kind, Object, Style, ViewError,
    draw,
};
use proptest::prelude::*;

const FROM_ABOVE: Camera =
    Camera { eye: [0.0, 10.0, 0.0], target: [0.0; 3], field_of_view: 40.0, up: [0.0, 1.0, 0.0] };

fn small() -> Style {
    Style { size: [64, 48], samples: 1, ground: Ground::None, ..Style::default() }
}

/// A horizontal square at a height, its front facing up.
fn square(height: f32, half: f32) -> Vec<[f32; 3]> {
    [[-half, half], [half, half], [half, -half], [-half, -half]].map(|[x, z]| [x, height, z]).to_vec()
}

fn one_face() -> Faces {
    Faces::from_iter([&[0u32, 1, 2, 3][..]])
}

fn object<'a>(kind: Kind, faces: &'a Faces, positions: &'a [[f32; 3]]) -> Object<'a> {
    Object { name: "thing", kind, faces, positions, rest: None, radius: None, looks: None }
}

fn brightness(pixel: [u8; 3]) -> u32 {
    pixel.iter().map(|channel| u32::from(*channel)).sum()
}

/// Coordinates of a broken run.
fn extreme() -> impl Strategy<Value = f32> {
    prop_oneof![
        4 => -3.0f32..3.0,
        1 => prop::sample::select(vec![f32::NAN, f32::INFINITY, f32::NEG_INFINITY, f32::MAX, -1e30, 1e-40, 1e8]),
    ]
}

fn kind() -> impl Strategy<Value = Kind> {
    prop::sample::select(vec![Kind::Cloth, Kind::Collider, Kind::Particles])
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn no_input_makes_drawing_fail(
        kind in kind(),
        positions in prop::collection::vec(prop::array::uniform3(extreme()), 0..12),
        rest in prop::collection::vec(prop::array::uniform3(extreme()), 0..12),
        faces in prop::collection::vec(prop::collection::vec(0u32..14, 0..6), 0..8),
        eye in prop::array::uniform3(extreme()),
        target in prop::array::uniform3(extreme()),
        field_of_view in extreme(),
        ground in prop_oneof![Just(Ground::None), Just(Ground::Below), extreme().prop_map(Ground::At)],
        full_scale in extreme(),
    ) {
        let faces: Faces = faces.iter().map(Vec::as_slice).collect();
        let object = Object { name: "extreme", kind, faces: &faces, positions: &positions, rest: Some(&rest), radius: None, looks: None };
        let style = Style { colouring: Colouring::Strain { full_scale }, wireframe: true, ground, ..small() };
        for camera in [
            Camera { eye, target, field_of_view, ..Camera::default() },
            Camera::framing(&Bounds::of_interest(&[object]), style.size),
        ] {
            prop_assert_eq!(draw(&[object], &camera, &style).size(), style.size);
        }
    }
}

#[test]
fn the_nearer_of_two_objects_is_visible_in_either_order() {
    let faces = one_face();
    let (low, high) = (square(0.0, 2.0), square(1.0, 1.0));
    let (cloth, collider) = (object(Kind::Cloth, &faces, &high), object(Kind::Collider, &faces, &low));
    let picture = draw(&[cloth, collider], &FROM_ABOVE, &small());
    assert_eq!(picture, draw(&[collider, cloth], &FROM_ABOVE, &small()));
    let [red, green, _] = picture.pixel(32, 24);
    assert!(red > 2 * green, "the cloth is red, and on top: {red}, {green}");
}

#[test]
fn a_point_that_is_not_finite_removes_only_its_own_faces() {
    let mut positions = square(0.0, 2.0);
    positions.extend(square(0.0, 1.0).iter().map(|[x, y, z]| [x + 1.5, *y, *z]));
    positions[0][1] = f32::NAN;
    let both = Faces::from_iter([&[0u32, 1, 2, 3][..], &[4, 5, 6, 7]]);
    let rest = Faces::from_iter([&[4u32, 5, 6, 7][..]]);
    let picture = |faces: &Faces| draw(&[object(Kind::Cloth, faces, &positions)], &FROM_ABOVE, &small());
    assert_eq!(picture(&both), picture(&rest));
    assert_ne!(picture(&rest), picture(&Faces::default()));
}

#[test]
fn a_sheet_casts_a_shadow_on_the_floor_below_it_only() {
    let style = Style { ground: Ground::At(0.0), size: [96, 96], ..small() };
    let faces = one_face();
    let camera = Camera { eye: [0.0, 4.0, 9.0], ..FROM_ABOVE };
    let sheet = square(1.0, 1.0);
    let with = draw(&[object(Kind::Cloth, &faces, &sheet)], &camera, &style);
    let without = draw(&[], &camera, &style);
    // The key light comes from the left, so the shadow lies to the right of the sheet.
    let darkened = |row: u32| brightness(without.pixel(56, row)).abs_diff(brightness(with.pixel(56, row)));
    assert!(darkened(50) > 100, "under the sheet: {}", darkened(50));
    assert!(darkened(94) < 12, "in front of it: {}", darkened(94));
}

#[test]
fn a_floor_that_is_seen_from_below_is_not_drawn() {
    let faces = one_face();
    let sheet = square(1.0, 1.0);
    let picture = |eye: [f32; 3], ground: Ground| {
        let camera = Camera { eye, ..FROM_ABOVE };
        draw(&[object(Kind::Cloth, &faces, &sheet)], &camera, &Style { ground, ..small() })
    };
    let (above, below) = ([0.0, 4.0, 9.0], [0.0, -2.0, 9.0]);
    assert_eq!(picture(below, Ground::At(0.0)), picture(below, Ground::None));
    assert_ne!(picture(above, Ground::At(0.0)), picture(above, Ground::None));
}

#[test]
fn moving_scene_and_camera_together_does_not_change_the_picture() {
    let faces = one_face();
    let far = |by: f32| square(0.5, 1.0).into_iter().map(|[x, y, z]| [x + by, y, z]).collect::<Vec<_>>();
    let picture = |by: f32| {
        let camera = Camera {
            eye: [by + 3.0, 4.0, 5.0],
            target: [by, 0.0, 0.0],
            field_of_view: 40.0,
            ..Camera::default()
        };
        draw(&[object(Kind::Cloth, &faces, &far(by))], &camera, &small())
    };
    assert_eq!(picture(0.0), picture(256.0), "a power of two is exact in f32");
}

#[test]
fn strain_is_red_where_longer_and_blue_where_shorter() {
    let faces = one_face();
    let (rest, pulled) = (square(0.0, 1.0), square(0.0, 1.2));
    let style = Style { colouring: Colouring::Strain { full_scale: 0.2 }, ..small() };
    let shown = Object { rest: Some(&rest), ..object(Kind::Cloth, &faces, &pulled) };
    let [red, _, blue] = draw(&[shown], &FROM_ABOVE, &style).pixel(32, 24);
    assert!(red > 2 * blue, "20 % longer is the deepest red: {red}, {blue}");
    let pressed = square(0.0, 0.8);
    let shown = Object { rest: Some(&rest), ..object(Kind::Cloth, &faces, &pressed) };
    let [red, _, blue] = draw(&[shown], &FROM_ABOVE, &style).pixel(32, 24);
    assert!(blue > 2 * red, "20 % shorter is the deepest blue: {red}, {blue}");
}

#[test]
fn a_png_file_holds_every_pixel() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("still.png");
    let (faces, positions) = (one_face(), square(0.0, 1.0));
    let image = draw(&[object(Kind::Cloth, &faces, &positions)], &FROM_ABOVE, &small());
    image.write_png(&path).unwrap();
    let mut reader = png::Decoder::new(BufReader::new(File::open(&path).unwrap())).read_info().unwrap();
    let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
    reader.next_frame(&mut bytes).unwrap();
    assert_eq!(bytes, image.bytes());
}

/// Plays an animated PNG: each rectangle is drawn over the frame before.
fn play(path: &std::path::Path) -> Vec<Vec<u8>> {
    let mut reader = png::Decoder::new(BufReader::new(File::open(path).unwrap())).read_info().unwrap();
    let frames = reader.info().animation_control.unwrap().num_frames;
    let mut canvas = vec![0; reader.output_buffer_size().unwrap()];
    let row_bytes = 3 * reader.info().width as usize;
    let mut shown = Vec::new();
    for _ in 0..frames {
        let mut part = vec![0; canvas.len()];
        let read = reader.next_frame(&mut part).unwrap();
        let place = *reader.info().frame_control.as_ref().unwrap();
        for row in 0..read.height as usize {
            let start = (place.y_offset as usize + row) * row_bytes + 3 * place.x_offset as usize;
            canvas[start..start + 3 * read.width as usize]
                .copy_from_slice(&part[row * read.line_size..row * read.line_size + 3 * read.width as usize]);
        }
        shown.push(canvas.clone());
    }
    shown
}

#[test]
fn an_animation_holds_every_frame() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("film.png");
    let faces = one_face();
    let frame = |height: f32| -> Image {
        draw(&[object(Kind::Cloth, &faces, &square(height, 1.0))], &FROM_ABOVE, &small())
    };
    let images = [frame(0.0), frame(1.0), frame(1.0), frame(2.0), frame(-1.0)];
    let mut film = AnimationWriter::create(&path, small().size).unwrap();
    images.iter().for_each(|image| film.push(image, 1.0 / 24.0).unwrap());
    film.finish().unwrap();
    let shown = play(&path);
    assert_eq!(shown.len(), images.len());
    for (frame, image) in images.iter().enumerate() {
        assert_eq!(shown[frame], image.bytes(), "frame {frame}");
    }
}

#[test]
fn an_animation_refuses_frames_of_another_size_and_needs_a_frame() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("film.png");
    let image = draw(&[], &FROM_ABOVE, &small());
    let mut film = AnimationWriter::create(&path, [10, 10]).unwrap();
    assert!(matches!(film.push(&image, 1.0), Err(ViewError::FrameSize { found: [64, 48], .. })));
    assert!(matches!(film.finish(), Err(ViewError::NoFrame { .. })));
    let nowhere = folder.path().join("missing").join("still.png");
    assert!(matches!(image.write_png(nowhere), Err(ViewError::Create { .. })));
}

#[test]
fn a_transparent_background_has_opacities_that_follow_the_objects() {
    let faces = one_face();
    let sheet = square(0.0, 1.0);
    let style = Style { background: Background::Transparent, ground: Ground::Below, samples: 4, ..small() };
    let picture = draw(&[object(Kind::Cloth, &faces, &sheet)], &FROM_ABOVE, &style);
    let [width, height] = picture.size();
    let at = |column: u32, row: u32| picture.alpha()[(row * width + column) as usize];
    assert_eq!((at(width / 2, height / 2), at(0, 0)), (255, 0), "the sheet is opaque, and there is no floor");
    let partly = picture.alpha().iter().filter(|alpha| !matches!(alpha, 0 | 255)).count();
    assert!(partly > 0, "supersampling gives the edge opacities in between");
    assert!(draw(&[], &FROM_ABOVE, &small()).alpha().is_empty(), "other pictures are opaque");
}

#[test]
fn the_back_of_a_cloth_is_lit() {
    let faces = one_face();
    let sheet = square(0.0, 1.0);
    let from_below = Camera { eye: [0.0, -10.0, 0.1], ..FROM_ABOVE };
    let side = |camera: &Camera| {
        let picture = draw(&[object(Kind::Cloth, &faces, &sheet)], camera, &small());
        brightness(picture.pixel(32, 24))
    };
    let [front, back] = [side(&FROM_ABOVE), side(&from_below)];
    assert!(3 * back > front && back < front, "{back} of {front}");
}

#[test]
fn a_tint_replaces_the_colour_of_the_object_with_its_name() {
    let faces = one_face();
    let sheet = square(0.0, 1.0);
    let tinted = |name: &str| {
        let tints = vec![(name.to_owned(), [0.0, 0.0, 1.0])];
        let style = Style { tints, background: Background::Colour([1.0; 3]), ..small() };
        draw(&[object(Kind::Cloth, &faces, &sheet)], &FROM_ABOVE, &style).pixel(32, 24)
    };
    let [red, _, blue] = tinted("thing");
    assert!(blue > 2 * red, "{red} {blue}");
    assert!(tinted("other")[0] > tinted("other")[2], "madder, the first colour of cloths");
}
