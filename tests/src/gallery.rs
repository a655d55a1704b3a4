//! The scenes of the gallery, and scenes given as text.

use std::fs;
use std::path::{Path, PathBuf};

use nucleus_graph::compile::{Program, compile};
use nucleus_graph::scene::{Scene, read_scene_text};

/// The root of the repository.
pub fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("this crate is in a folder of the repository")
}

/// The scene files of the gallery, sorted by path, without the stress tests that `nucleus extremes` evaluates.
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

/// Reads a scene.
///
/// # Panics
/// If there is an error or a warning.
pub fn scene(text: &str, file: &Path) -> Scene {
    match read_scene_text(text, file) {
        Ok((scene, warnings)) => {
            assert!(warnings.is_empty(), "{}: {warnings:#?}", file.display());
            scene
        }
        Err(errors) => panic!("{}: {errors:#?}", file.display()),
    }
}

/// Compiles a scene.
///
/// # Panics
/// If there is an error or a warning.
pub fn program(scene: &Scene) -> Program {
    match compile(scene) {
        Ok(program) => {
            assert!(program.warnings().is_empty(), "{:#?}", program.warnings());
            program
        }
        Err(errors) => panic!("{errors:#?}"),
    }
}

/// The program of a scene with these nodes and 24 frames of 1/24 s.
pub fn program_of(nodes: &str) -> Program {
    program_of_text(&format!("Scene(time: (start: 1, end: 24, fps: 24), nodes: {{{nodes}}})"))
}

/// The program of a scene in this text.
pub fn program_of_text(text: &str) -> Program {
    program(&scene(text, Path::new("test.ron")))
}

/// A scene of the gallery, such as `soft/can`, with parts of its text replaced.
///
/// # Panics
/// If a part is not in the text, or the scene has an error or a warning.
pub fn changed(name: &str, changes: &[(&str, &str)]) -> Program {
    let file = root().join("scenes").join(name).with_extension("ron");
    let mut text = fs::read_to_string(&file).expect("it is text");
    for (from, to) in changes {
        assert!(text.contains(from), "{name} has no `{from}`");
        text = text.replace(from, to);
    }
    program(&scene(&text, &file))
}
