//! Scene of a row: RON text, its meshes, and faults that a scene file cannot express.

use std::fs;
use std::io;
use std::path::Path;

use nucleus_core::FrameInput;
use nucleus_graph::checks::Check;
use nucleus_graph::compile::{Program, compile};
use nucleus_graph::scene::{Diagnostic, Severity, read_scene_text};

/// Changes the input of a frame before it is solved.
pub type FaultInjection = fn(frame: i64, input: &mut FrameInput);

/// A scene of the table.
#[derive(Debug, Clone)]
pub struct TestScene {
    /// The scene file.
    pub text: String,
    /// OBJ files: their names, and their text.
    pub meshes: Vec<(&'static str, &'static str)>,
    /// Faults to inject.
    pub inject: Option<FaultInjection>,
}

/// A scene after reading and compiling.
pub struct CompiledScene {
    /// The program, if there is no error.
    pub program: Option<Program>,
    /// The checks of the scene.
    pub checks: Vec<Check>,
    /// All diagnostics, in order.
    pub diagnostics: Vec<Diagnostic>,
}

impl TestScene {
    /// A scene without meshes and without faults.
    pub fn new(text: impl Into<String>) -> Self {
        Self { text: text.into(), meshes: Vec::new(), inject: None }
    }

    /// Adds an OBJ file, by its path in `scenes/extremes/`.
    pub fn mesh(mut self, path: &'static str, text: &'static str) -> Self {
        self.meshes.push((path.rsplit_once('/').map_or(path, |(_, name)| name), text));
        self
    }

    /// Sets the faults to inject.
    pub fn inject(mut self, inject: FaultInjection) -> Self {
        self.inject = Some(inject);
        self
    }

    /// Replaces a part of the text.
    pub fn replace(mut self, from: &str, to: &str) -> Self {
        debug_assert!(self.text.contains(from), "`{from}` is not in {}", self.text);
        self.text = self.text.replace(from, to);
        self
    }

    /// Writes the scene as `name.ron`, and its meshes to the same folder.
    ///
    /// # Errors
    /// When a file cannot be written.
    pub fn write(&self, folder: &Path, name: &str) -> io::Result<()> {
        fs::write(folder.join(name).with_extension("ron"), &self.text)?;
        self.meshes.iter().try_for_each(|(name, text)| fs::write(folder.join(name), text))
    }

    /// Reads and compiles the scene, as the command does.
    ///
    /// # Errors
    /// When its meshes cannot be written to a temporary folder.
    pub fn compile(&self) -> io::Result<CompiledScene> {
        let folder = tempfile::tempdir()?;
        self.write(folder.path(), "scene")?;
        let (scene, mut diagnostics) = match read_scene_text(&self.text, &folder.path().join("scene.ron")) {
            Ok(read) => read,
            Err(diagnostics) => {
                return Ok(CompiledScene { program: None, checks: Vec::new(), diagnostics });
            }
        };
        let checks = scene.checks.clone();
        let program = match compile(&scene) {
            Ok(program) => {
                diagnostics.extend(program.warnings().iter().cloned());
                Some(program)
            }
            Err(found) => {
                diagnostics.extend(found);
                None
            }
        };
        Ok(CompiledScene { program, checks, diagnostics })
    }
}

impl CompiledScene {
    /// All diagnostics of a severity with their help, one line each.
    pub fn messages(&self, severity: Severity) -> Vec<String> {
        let of_severity = self.diagnostics.iter().filter(|diagnostic| diagnostic.severity == severity);
        let message = |diagnostic: &Diagnostic| match &diagnostic.help {
            Some(help) => format!("{}: {help}", diagnostic.message),
            None => diagnostic.message.clone(),
        };
        of_severity.map(message).collect()
    }
}
