//! A scene given on the command line: read, compiled, and everything said about it.

use std::path::Path;
use std::sync::OnceLock;

use anyhow::{Context, Result, anyhow};
use nucleus_graph::compile::{Program, compile};
use nucleus_graph::memory::Memory;
use nucleus_graph::scene::{Diagnostic, Scene, read_scene_within, read_text};

use crate::diagnostics;
use crate::frame_range::FrameRange;

/// What scenes may take, where `--memory` says so.
static MEMORY: OnceLock<Memory> = OnceLock::new();

/// Sets the memory that scenes may take, before any is opened.
pub fn set_memory(memory: Memory) {
    // Once for each command.
    let _ = MEMORY.set(memory);
}

fn memory() -> Memory {
    *MEMORY.get_or_init(Memory::of_machine)
}

/// Reads a size of memory as people write it: `8G`, `500M`, `1.5TB`, or bytes.
pub fn parse_memory(text: &str) -> Result<Memory> {
    let digits = text.trim_end_matches(|c: char| c.is_ascii_alphabetic());
    let unit = match text[digits.len()..].to_ascii_uppercase().trim_end_matches('B') {
        "" => 1.0,
        "K" => 1e3,
        "M" => 1e6,
        "G" => 1e9,
        "T" => 1e12,
        _ => 0.0,
    };
    let bytes = digits.trim().parse::<f64>().ok().map(|number| number * unit);
    let bytes = bytes.filter(|bytes| (1.0..1e18).contains(bytes));
    bytes.map(|bytes| Memory(bytes as u64)).context("a size is written as `8G` or `500M`")
}

/// The text of a scene file.
pub fn text(path: &Path) -> Result<String> {
    read_text(path, memory()).map_err(|error| anyhow!(error))
}

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
    of_text(text(path)?, path, frames)
}

/// The same for a text that is at hand; files that it names are looked for beside `path`.
pub fn of_text(text: String, path: &Path, frames: Option<FrameRange>) -> Result<SceneFile> {
    let (mut scene, mut diagnostics) = match read_scene_within(&text, path, memory()) {
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_of_memory_are_read_as_people_write_them() {
        for (text, bytes) in
            [("8G", 8_000_000_000), ("1.5gb", 1_500_000_000), ("500M", 500_000_000), ("64", 64)]
        {
            assert_eq!(parse_memory(text).unwrap(), Memory(bytes), "{text}");
        }
        for text in ["", "G", "-1G", "8X", "nan", "0", "1e30"] {
            assert!(parse_memory(text).is_err(), "{text}");
        }
    }
}
