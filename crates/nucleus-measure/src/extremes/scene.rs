//! A scene of the table: text, the meshes it names, and what no text can say.

use std::fs;
use std::io;
use std::path::Path;

use nucleus_core::FrameInput;
use nucleus_graph::compile::{Program, compile};
use nucleus_graph::scene::{Diagnostic, Severity, read_scene_text};

/// What a scene cannot say: a change to what the frame of this number brings.
pub type FaultInjection = fn(frame: i64, input: &mut FrameInput);

/// A scene of the table.
#[derive(Debug, Clone)]
pub struct TestScene {
    /// Its nodes, as RON.
    pub nodes: String,
    /// Frames that are solved; the run begins at frame 0.
    pub frames: i64,
    /// Frames per second.
    pub fps: f64,
    /// OBJ files by name.
    pub meshes: Vec<(&'static str, String)>,
    /// What the text cannot say.
    pub inject: Option<FaultInjection>,
}

/// What became of a scene.
pub struct CompiledScene {
    /// The program, if there is no error.
    pub program: Option<Program>,
    /// Everything that was said, in order.
    pub said: Vec<Diagnostic>,
}

impl TestScene {
    /// A scene of these nodes that runs for so many frames of 1/24 s.
    pub fn new(frames: i64, nodes: impl Into<String>) -> Self {
        Self { nodes: nodes.into(), frames, fps: 24.0, meshes: Vec::new(), inject: None }
    }

    /// With an OBJ file beside it.
    pub fn mesh(mut self, name: &'static str, text: String) -> Self {
        self.meshes.push((name, text));
        self
    }

    /// At another frame rate.
    pub fn fps(mut self, fps: f64) -> Self {
        self.fps = fps;
        self
    }

    /// With something that no text can say.
    pub fn inject(mut self, inject: FaultInjection) -> Self {
        self.inject = Some(inject);
        self
    }

    /// With other words in the text of its nodes.
    pub fn replace(mut self, from: &str, to: &str) -> Self {
        debug_assert!(self.nodes.contains(from), "`{from}` is nowhere in {}", self.nodes);
        self.nodes = self.nodes.replace(from, to);
        self
    }

    /// The scene as a file would have it.
    pub fn text(&self) -> String {
        let Self { nodes, frames, fps, .. } = self;
        format!(
            "Scene(\n    time: (start: 0, end: {frames}, fps: {fps}),\n    nodes: {{\n{nodes}    }},\n)\n"
        )
    }

    /// Writes the scene as `name.ron`, and its meshes beside it.
    ///
    /// # Errors
    /// When a file cannot be written.
    pub fn write(&self, folder: &Path, name: &str) -> io::Result<()> {
        fs::write(folder.join(name).with_extension("ron"), self.text())?;
        self.meshes.iter().try_for_each(|(name, text)| fs::write(folder.join(name), text))
    }

    /// Reads and compiles it, as the command would.
    ///
    /// # Errors
    /// When its meshes cannot be written to a folder of their own.
    pub fn compile(&self) -> io::Result<CompiledScene> {
        let folder = tempfile::tempdir()?;
        self.write(folder.path(), "scene")?;
        let (scene, mut said) = match read_scene_text(&self.text(), &folder.path().join("scene.ron")) {
            Ok(read) => read,
            Err(said) => return Ok(CompiledScene { program: None, said }),
        };
        Ok(match compile(&scene) {
            Ok(program) => {
                said.extend(program.warnings().iter().cloned());
                CompiledScene { program: Some(program), said }
            }
            Err(found) => {
                said.extend(found);
                CompiledScene { program: None, said }
            }
        })
    }
}

impl CompiledScene {
    /// Everything of a kind that was said, help and notes too, a line each.
    pub fn words(&self, severity: Severity) -> Vec<String> {
        let said = self.said.iter().filter(|diagnostic| diagnostic.severity == severity);
        let words = |diagnostic: &Diagnostic| match &diagnostic.help {
            Some(help) => format!("{}: {help}", diagnostic.message),
            None => diagnostic.message.clone(),
        };
        said.map(words).collect()
    }
}
