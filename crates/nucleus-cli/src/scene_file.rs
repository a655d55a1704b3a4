//! A scene given on the command line: read, compiled, and everything said about it.

use std::fs;
use std::path::Path;

use anyhow::{Context, Result, ensure};
use nucleus_graph::compile::{Program, compile};
use nucleus_graph::scene::{Diagnostic, Scene, read_scene_text};

use crate::diagnostics;
use crate::frame_range::FrameRange;

/// A scene file that was read, whether it makes sense or not.
pub struct SceneFile {
    /// Its text.
    pub text: String,
    /// What is to be said about it.
    pub diagnostics: Vec<Diagnostic>,
    /// The scene and its program, if there is no error.
    pub compiled: Option<(Scene, Program)>,
}

/// Reads and compiles a scene, for `frames` if they are given. Fails only where there is no text to read.
pub fn open(path: &Path, frames: Option<FrameRange>) -> Result<SceneFile> {
    ensure!(!path.is_dir(), "`{}` is a folder, not a scene", path.display());
    let bytes = fs::read(path).with_context(|| format!("cannot read `{}`", path.display()))?;
    let text = String::from_utf8(bytes);
    let text = text.ok().with_context(|| format!("`{}` is not text: scenes are UTF-8", path.display()))?;
    of_text(text, path, frames)
}

/// The same for a text that is at hand; files that it names are looked for beside `path`.
pub fn of_text(text: String, path: &Path, frames: Option<FrameRange>) -> Result<SceneFile> {
    let (mut scene, mut diagnostics) = match read_scene_text(&text, path) {
        Ok(read) => read,
        Err(diagnostics) => return Ok(SceneFile { text, diagnostics, compiled: None }),
    };
    if let Some(frames) = frames {
        let span = i32::try_from(scene.time.start).ok().and_then(|start| frames.within(start));
        let (start, end) = span.context("there are not so many frames")?;
        (scene.time.start, scene.time.end) = (start.into(), end.into());
    }
    match compile(&scene) {
        Ok(program) => {
            diagnostics.extend(program.warnings().iter().cloned());
            Ok(SceneFile { text, diagnostics, compiled: Some((scene, program)) })
        }
        Err(found) => {
            diagnostics.extend(found);
            Ok(SceneFile { text, diagnostics, compiled: None })
        }
    }
}

impl SceneFile {
    /// Prints what is to be said; gives scene and program, if there is no error.
    pub fn told(self) -> Result<Option<(Scene, Program, String)>> {
        diagnostics::print(&self.diagnostics, &self.text)?;
        Ok(self.compiled.map(|(scene, program)| (scene, program, self.text)))
    }
}
