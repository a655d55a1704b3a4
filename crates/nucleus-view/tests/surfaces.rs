//! The surface of particles, in pictures and from the server of the player.

use std::collections::BTreeMap;
use std::io::{Read, Write};
use std::net::{SocketAddr, TcpStream};
use std::path::Path;

use nalgebra::Vector3;
use nucleus_cache::{ObjectInfo, ObjectKind, Playback, Recorder, RunInfo, Source};
use nucleus_core::{Cloth, ClothLists, Faces, Mass, ModelBuilder, Solver, Surface};
use nucleus_view::{Background, Camera, Film, Ground, Image, Style, serve};

const SIDE: u32 = 12;
const SPACING: f32 = 0.1;
const GREEN: [f32; 3] = [0.0, 1.0, 0.0];

/// Writes a cache of one frame: a cube of a liquid about the origin; balls of its particles leave gaps.
fn write(path: &Path) {
    write_with(path, Some(f64::from(SPACING)));
}

/// The same with this distance at rest; of balls that are no liquid, if there is none.
fn write_with(path: &Path, rest_distance: Option<f64>) {
    let at = |k: u32| (k as f32 - 0.5 * (SIDE - 1) as f32) * SPACING;
    let place = |k: u32| [at(k % SIDE), at(k / SIDE % SIDE), at(k / (SIDE * SIDE))];
    let rest: Vec<[f32; 3]> = (0..SIDE.pow(3)).map(place).collect();
    let positions = rest.iter().map(|place| Vector3::from(place.map(f64::from))).collect();
    let surface = Surface { positions, faces: Faces::default() };
    let mut builder = ModelBuilder::new();
    let cloth = builder.cloth(Cloth::new(surface, Mass::PerPoint(1.0), ClothLists::NONE)).unwrap();
    let (name, kind) = ("wa/ter".to_owned(), ObjectKind::Particles);
    let radii = BTreeMap::from([(name.clone(), f64::from(0.15 * SPACING))]);
    let object = ObjectInfo { name, kind, faces: Faces::default(), rest };
    let rest_distances = rest_distance.map(|distance| (object.name.clone(), distance)).into_iter().collect();
    let run = RunInfo { radii, rest_distances, ..RunInfo::default() };
    let mut recorder = Recorder::create(path, &run, vec![(Source::Cloth(cloth), object)]).unwrap();
    recorder.record_start(&Solver::<f32>::new(builder, 1)).unwrap();
    recorder.finish().unwrap();
}

fn picture(cache: &mut Playback, surfaces: bool) -> Image {
    let background = Background::Colour(GREEN);
    let style =
        Style { size: [64, 64], samples: 1, ground: Ground::None, background, surfaces, ..Style::default() };
    let camera = Camera { eye: [0.0, 0.0, 4.0], target: [0.0; 3], field_of_view: 25.0, ..Camera::default() };
    Film::of(cache, 1, style).unwrap().seen_by(camera).picture(0).unwrap()
}

/// The pixels of a square in the middle through which the background shows.
fn gaps(image: &Image) -> usize {
    let pixels = (24..40).flat_map(|x| (24..40).map(move |y| image.pixel(x, y)));
    pixels.filter(|[red, green, blue]| *green > 200 && *red < 50 && *blue < 50).count()
}

#[test]
fn a_surface_closes_the_gaps_between_particles() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.mcap");
    write(&path);
    let mut cache = Playback::open(&path).unwrap();
    let spacing = cache.particle_spacing(0).unwrap().unwrap();
    assert!((spacing / SPACING - 1.0).abs() < 1e-3, "{spacing}");
    assert!(gaps(&picture(&mut cache, false)) > 20, "one looks through between balls");
    assert_eq!(gaps(&picture(&mut cache, true)), 0);
}

#[test]
fn the_surface_of_a_liquid_has_the_spacing_of_its_rest_distance() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.mcap");
    // Its particles are nearer than at rest, as those that an emitter has just made.
    write_with(&path, Some(1.5 * f64::from(SPACING)));
    let spacing = Playback::open(&path).unwrap().particle_spacing(0).unwrap().unwrap();
    assert!((spacing / SPACING - 1.5).abs() < 1e-3, "{spacing}");
}

#[test]
fn the_surface_of_balls_that_are_no_liquid_encloses_their_volume() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.mcap");
    write_with(&path, None);
    let spacing = Playback::open(&path).unwrap().particle_spacing(0).unwrap().unwrap();
    let ball = 4.0 / 3.0 * std::f32::consts::PI * (0.15 * SPACING).powi(3);
    assert!((spacing.powi(3) / ball - 1.0).abs() < 1e-3, "{spacing}");
}

#[test]
fn balls_beside_a_liquid_have_no_surface() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.mcap");
    let mut builder = ModelBuilder::new();
    let objects = ["water", "balls"].map(|name| {
        let surface = Surface { positions: vec![Vector3::zeros(), Vector3::x()], faces: Faces::default() };
        let cloth = builder.cloth(Cloth::new(surface, Mass::PerPoint(1.0), ClothLists::NONE)).unwrap();
        let rest = vec![[0.0; 3], [1.0, 0.0, 0.0]];
        let (name, kind) = (name.to_owned(), ObjectKind::Particles);
        (Source::Cloth(cloth), ObjectInfo { name, kind, faces: Faces::default(), rest })
    });
    let radii = ["water", "balls"].map(|name| (name.to_owned(), 0.1)).into();
    let run = RunInfo { radii, rest_distances: [("water".to_owned(), 0.2)].into(), ..RunInfo::default() };
    let mut recorder = Recorder::create(&path, &run, objects.into()).unwrap();
    recorder.record_start(&Solver::<f32>::new(builder, 1)).unwrap();
    recorder.finish().unwrap();
    let mut cache = Playback::open(&path).unwrap();
    assert_eq!([0, 1].map(|object| cache.particle_spacing(object).unwrap()), [Some(0.2), None]);
}

fn get(address: SocketAddr, path: &str) -> (String, Vec<u8>) {
    let mut stream = TcpStream::connect(address).unwrap();
    write!(stream, "GET {path} HTTP/1.1\r\nHost: {address}\r\n\r\n").unwrap();
    let mut answer = Vec::new();
    stream.read_to_end(&mut answer).unwrap();
    let end = answer.windows(4).position(|bytes| bytes == b"\r\n\r\n").unwrap();
    let status = String::from_utf8_lossy(&answer[9..12]).into_owned();
    (status, answer[end + 4..].to_vec())
}

#[test]
fn the_player_gets_the_surface_of_a_recorded_time_and_nothing_else() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run.mcap");
    write(&path);
    let player = serve(&path, 0).unwrap();
    let frame = Playback::open(&path).unwrap().time_samples()[0].frame;
    let (status, body) = get(player.address(), &format!("/surface/wa%2Fter/{frame}/0"));
    assert_eq!(status, "200");
    let word = |at: usize| u32::from_le_bytes(body[4 * at..4 * at + 4].try_into().unwrap()) as usize;
    assert_eq!(body.len(), 8 + 12 * word(0) + 16 * word(1));
    assert!(word(1) > 100);
    for path in ["wa%2Fter/99/0", "wa%2Fter/1/7", "other/1/0", "wa%2Fter", "", "%/1/0", "../../secret/1/0"] {
        assert_eq!(get(player.address(), &format!("/surface/{path}")).0, "404", "{path}");
    }
}
