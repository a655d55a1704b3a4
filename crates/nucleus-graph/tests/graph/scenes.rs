//! Scenes to test with.

use std::fs;
use std::path::{Path, PathBuf};

use nucleus_graph::Simulation;
use nucleus_graph::compile::{ObjectKind, Program, compile};
use nucleus_graph::scene::{Scene, read_scene_text};

/// The scene of a text.
pub fn scene(text: &str) -> Scene {
    match read_scene_text(text, Path::new("test.ron")) {
        Ok((scene, _)) => scene,
        Err(diagnostics) => panic!("{text}\n{diagnostics:#?}"),
    }
}

/// A scene of these nodes and connections, over frames 1 to 24.
pub fn of_nodes(nodes: &str, connections: &str) -> String {
    format!("Scene(time: (start: 1, end: 24, fps: 24), nodes: {{{nodes}}}, connections: [{connections}])")
}

/// The program of a text.
pub fn program(text: &str) -> Program {
    compile(&scene(text)).unwrap_or_else(|diagnostics| panic!("{text}\n{diagnostics:#?}"))
}

/// An 8-bit grey PNG.
pub fn png(columns: u32, pixels: &[u8]) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, columns, pixels.len() as u32 / columns);
    encoder.set_color(png::ColorType::Grayscale);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.write_header().expect("a header").write_image_data(pixels).expect("a picture");
    bytes
}

/// The positions of the points of an object after some frames, as bits.
pub fn after(program: &Program, frames: usize, object: &str) -> Vec<[u32; 3]> {
    let mut run = Simulation::<f32>::new(program, 1);
    for _ in 0..frames {
        run.advance(&mut ());
    }
    let kind = program.objects().iter().find(|other| other.name == object).expect("it is there").kind;
    let mut points = Vec::new();
    match kind {
        ObjectKind::Cloth(id) => run.state().positions(id, run.units_per_metre(), &mut points),
        ObjectKind::Collider(id) => run.state().collider_positions(id, run.units_per_metre(), &mut points),
    }
    points.into_iter().map(|point| point.map(f32::to_bits)).collect()
}

/// All scenes of the repository.
pub fn gallery() -> Vec<(PathBuf, String)> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes");
    let mut open = vec![root];
    let mut scenes = Vec::new();
    while let Some(folder) = open.pop() {
        for entry in fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("an entry").path()) {
            if entry.is_dir() {
                open.push(entry);
            } else if entry.extension().is_some_and(|end| end == "ron") {
                let text = fs::read_to_string(&entry).expect("text");
                scenes.push((entry, text));
            }
        }
    }
    scenes.sort();
    assert!(!scenes.is_empty());
    scenes
}
