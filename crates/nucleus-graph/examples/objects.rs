//! How long a scene with many small objects of one nucleus takes to read, to compile and to evaluate.
//!
//! ```text
//! cargo run --release -p nucleus-graph --example objects -- 2000
//! ```

use std::fmt::Write as _;
use std::path::Path;
use std::time::Instant;

use nucleus_graph::compile::compile;
use nucleus_graph::scene::read_scene_text;

fn main() {
    let count: usize = std::env::args().nth(1).and_then(|count| count.parse().ok()).unwrap_or(2000);
    let text = scene(count);
    let begin = Instant::now();
    let (scene, _) =
        read_scene_text(&text, Path::new("objects.ron")).unwrap_or_else(|mistakes| panic!("{mistakes:?}"));
    let read = begin.elapsed();
    let begin = Instant::now();
    let program = compile(&scene).unwrap_or_else(|mistakes| panic!("{mistakes:?}"));
    let compiled = begin.elapsed();
    let begin = Instant::now();
    let cloths = program.first_input().cloths.len();
    println!(
        "{cloths} objects: read in {read:?}, compiled in {compiled:?}, a frame in {:?}",
        begin.elapsed()
    );
}

/// A grid of sheets of four points.
fn scene(count: usize) -> String {
    let mut nodes = String::from("\"n\": nucleus(),\n");
    for k in 0..count {
        let place = [3 * (k % 50), 3 * (k / 50)];
        let _ = writeln!(
            nodes,
            "\"p{k}\": polyPlane(subdivisions: (1, 1), translate: ({}, 0, {})), \"c{k}\": nCloth(inputMesh: \"p{k}\"),",
            place[0], place[1]
        );
    }
    format!("Scene(time: (start: 1, end: 2, fps: 24), nodes: {{{nodes}}})")
}
