//! How long constraints between two curtains take to form.
//!
//! ```text
//! cargo run --release -p nucleus-graph --example constraints -- 200
//! ```

use std::path::Path;
use std::time::Instant;

use nucleus_graph::compile::compile;
use nucleus_graph::scene::read_scene_text;

fn main() {
    let side: usize = std::env::args().nth(1).and_then(|side| side.parse().ok()).unwrap_or(200);
    let cells = side - 1;
    // Both hang in planes across x.
    let curtain = |x: f64| {
        format!("polyPlane(subdivisions: ({cells}, {cells}), rotate: (0, 0, 90), translate: ({x}, 0, 0))")
    };
    let reach = 0.9 / cells as f64;
    let cases = [
        (
            "nearest points",
            r#"constraintType: pointToPoint, components: ["a.vtx[*]", "b.vtx[*]"]"#.to_owned(),
        ),
        (
            "points to a surface",
            r#"constraintType: pointToSurface, components: ["b", "a.vtx[*]"]"#.to_owned(),
        ),
        (
            "borders that resist folding",
            format!(
                r#"constraintType: weldBorders, maxDistance: {reach}, bend: true, components: ["a.e[border]", "b.e[border]"]"#
            ),
        ),
        ("a tearable surface", r#"constraintType: tearableSurface, components: ["a"]"#.to_owned()),
    ];
    for (name, constraint) in cases {
        let text = format!(
            r#"Scene(time: (start: 1, end: 2, fps: 24), nodes: {{"n": nucleus(), "p": {}, "q": {}, "a": nCloth(inputMesh: "p"),
            "b": nCloth(inputMesh: "q"), "k": dynamicConstraint({constraint})}})"#,
            curtain(0.0),
            curtain(0.5 * reach)
        );
        let (scene, _) = read_scene_text(&text, Path::new("constraints.ron"))
            .unwrap_or_else(|mistakes| panic!("{name}: {mistakes:?}"));
        let begin = Instant::now();
        let program = compile(&scene).unwrap_or_else(|mistakes| panic!("{name}: {mistakes:?}"));
        let compiled = begin.elapsed();
        let begin = Instant::now();
        let frames = program.first_input().constraints;
        let links: usize = frames.iter().filter_map(|frame| frame.formed.as_ref()).map(Vec::len).sum();
        println!("{name}: {links} links, compiled in {compiled:?}, formed in {:?}", begin.elapsed());
    }
}
