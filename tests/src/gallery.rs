//! The scenes of the gallery, and scenes given as text.

use std::fs;
use std::path::{Path, PathBuf};

use nucleus_graph::compile::{Program, compile};
use nucleus_graph::scene::{Scene, read_scene_text};

/// The repository.
pub fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("this crate is in a folder of the repository")
}

/// The files of all scenes, in order of their paths, without the stress tests that `nucleus extremes` evaluates.
pub fn scenes() -> Vec<PathBuf> {
    let mut found = Vec::new();
    let mut folders = vec![root().join("scenes")];
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(&folder).expect("scenes can be listed") {
            let path = entry.expect("scenes can be listed").path();
            if path.is_dir() && path.ends_with("extremes") {
                continue;
            }
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|end| end == "ron") {
                found.push(path);
            }
        }
    }
    found.sort();
    found
}

/// A scene from its text, which must be without mistakes and without warnings.
pub fn scene(text: &str, file: &Path) -> Scene {
    match read_scene_text(text, file) {
        Ok((scene, warnings)) => {
            assert!(warnings.is_empty(), "{}: {warnings:#?}", file.display());
            scene
        }
        Err(mistakes) => panic!("{}: {mistakes:#?}", file.display()),
    }
}

/// A compiled scene, likewise.
pub fn program(scene: &Scene) -> Program {
    match compile(scene) {
        Ok(program) => {
            assert!(program.warnings().is_empty(), "{:#?}", program.warnings());
            program
        }
        Err(mistakes) => panic!("{mistakes:#?}"),
    }
}

/// The program of a scene that is given as its nodes, in 24 frames of 1/24 s.
pub fn program_of(nodes: &str) -> Program {
    let text = format!("Scene(time: (start: 1, end: 24, fps: 24), nodes: {{{nodes}}})");
    program(&scene(&text, Path::new("test.ron")))
}
