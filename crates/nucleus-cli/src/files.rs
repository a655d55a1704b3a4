//! Scenes and caches named on the command line: reading, compiling and opening them, with errors that name the file.

use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use anyhow::{Context, Result, anyhow, ensure};
use nucleus_cache::{ObjectKind, OpenError, Playback, ReadError, shell_word};
use nucleus_graph::compile::{Program, compile};
use nucleus_graph::first_frame_warnings;
use nucleus_graph::memory::Memory;
use nucleus_graph::scene::{Assignment, Diagnostic, Scene, assigned, read_scene_within, read_text};
use nucleus_maya::is_maya_scene;

use crate::diagnostics;
use crate::options::FrameRange;
use crate::output::say;

/// The memory limit of scenes, where `--memory` sets one.
static MEMORY_LIMIT: OnceLock<Memory> = OnceLock::new();

/// Sets the memory limit of scenes. Called before any scene is opened.
pub fn set_memory_limit(memory: Memory) {
    // There is one command per process, so the first value is the only one.
    let _ = MEMORY_LIMIT.set(memory);
}

/// The memory limit of scenes.
pub fn memory_limit() -> Memory {
    *MEMORY_LIMIT.get_or_init(Memory::of_machine)
}

/// The text of a scene file.
pub fn scene_text(path: &Path) -> Result<String> {
    refuse_maya_scene(path)?;
    let (name, word) = (path.display(), shell_word(path));
    ensure!(!path.is_file() || !is_cache(path), "`{name}` is a cache: `nucleus play {word}` plays it");
    read_text(path, memory_limit()).map_err(|error| anyhow!(error))
}

/// Refuses a Maya scene where a scene or a cache is expected.
fn refuse_maya_scene(path: &Path) -> Result<()> {
    let (name, is_binary) =
        (path.display(), path.extension().is_some_and(|end| end.eq_ignore_ascii_case("mb")));
    ensure!(
        !is_maya_scene(path) || is_binary,
        "`{name}` is a Maya scene: `nucleus import {}` makes a scene (.ron) of it",
        shell_word(path)
    );
    ensure!(
        !is_binary,
        "`{name}` is a binary Maya scene: save it as Maya ASCII (.ma), which `nucleus import` reads"
    );
    Ok(())
}

/// A scene file after reading and compiling, with or without errors.
pub struct SceneFile {
    pub text: String,
    pub diagnostics: Vec<Diagnostic>,
    /// The scene and its program; `None` if there are errors.
    pub compiled: Option<(Scene, Program)>,
}

/// Reads and compiles a scene. `frames` replaces the frame range of the scene.
///
/// # Errors
/// Only if there is no text to read. Errors in the scene are diagnostics.
pub fn open_scene(path: &Path, frames: Option<FrameRange>) -> Result<SceneFile> {
    scene_from_text(scene_text(path)?, path, frames)
}

/// As [`open_scene`], with attributes set as by `--set`.
///
/// # Errors
/// Also if an assignment does not fit the scene.
pub fn open_scene_with(path: &Path, frames: Option<FrameRange>, set: &[Assignment]) -> Result<SceneFile> {
    let text = scene_text(path)?;
    match read_scene_within(&text, path, memory_limit()) {
        Ok((scene, _)) if !set.is_empty() => {
            let mut set = set.to_vec();
            for one in &mut set {
                let said = one.to_string();
                one.resolve(&scene.graph).with_context(|| format!("`--set {said}`"))?;
            }
            scene_from_text(assigned(&text, &set)?, path, frames)
        }
        _ => scene_from_text(text, path, frames),
    }
}

/// As [`open_scene`], for a text in memory. Relative file names in it are resolved beside `path`.
pub fn scene_from_text(text: String, path: &Path, frames: Option<FrameRange>) -> Result<SceneFile> {
    let (mut scene, mut diagnostics) = match read_scene_within(&text, path, memory_limit()) {
        Ok(read) => read,
        Err(diagnostics) => return Ok(SceneFile { text, diagnostics, compiled: None }),
    };
    if let Some(frames) = frames {
        let range = i32::try_from(scene.time.start).ok().and_then(|start| frames.within(start));
        let (start, end) = range.context("the frame range exceeds the largest frame number, 2147483647")?;
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

/// The path of the scene of a cache, beside which meshes are found. If it no longer exists, a scene of that name beside the
/// cache.
pub fn recorded_scene(cache: &Playback, file: &Path) -> PathBuf {
    let path = PathBuf::from(&cache.run().scene_path);
    let beside = file.with_file_name(path.file_name().unwrap_or_default());
    if !path.exists() && beside.exists() { beside } else { path }
}

impl SceneFile {
    /// Adds the warnings about the first frame.
    pub fn with_first_frame(mut self) -> Self {
        if let Some((scene, program)) = &self.compiled {
            self.diagnostics.extend(first_frame_warnings(scene, program));
            self.diagnostics.sort_by_key(|found| (found.span.start, found.span.end));
        }
        self
    }

    /// Prints the diagnostics. Returns scene, program and text, or `None` if there are errors.
    pub fn report(self) -> Result<Option<(Scene, Program, String)>> {
        diagnostics::print(&self.diagnostics, &self.text)?;
        Ok(self.compiled.map(|(scene, program)| (scene, program, self.text)))
    }
}

/// The path of a cache that is to be written.
///
/// # Errors
/// If its name does not end with `.mcap`: `nucleus render` would replace a cache that has the name of a picture.
pub fn named_as_cache(out: &Path) -> Result<&Path> {
    ensure!(
        out.file_name().is_some() && !out.is_dir(),
        "`{}` is a folder: write `-o {}`",
        out.display(),
        shell_word(&out.join("run.mcap"))
    );
    ensure!(
        out.extension().is_some_and(|end| end.eq_ignore_ascii_case("mcap")),
        "`{}` does not end with .mcap: the result of a run is a cache; write `-o {}`, and then `nucleus render` or \
         `nucleus export` makes other files of it",
        out.display(),
        shell_word(&out.with_extension("mcap"))
    );
    Ok(out)
}

/// Refuses an output that would replace its own input.
pub fn refuse_own_input(input: &Path, out: &Path) -> Result<()> {
    let real = |path: &Path| std::fs::canonicalize(path).ok();
    let is_same = real(input).is_some_and(|input| real(out) == Some(input));
    ensure!(!is_same, "`{}` is the file that is read; name another one with `-o`", out.display());
    Ok(())
}

/// Opens a cache.
pub fn open_cache(path: &Path) -> Result<Playback> {
    refuse_maya_scene(path)?;
    let (name, is_scene) = (path.display(), path.extension().is_some_and(|end| end == "ron"));
    ensure!(
        !is_scene || !path.is_file(),
        "`{name}` is a scene: `nucleus run {}` records its cache",
        shell_word(path)
    );
    Playback::open(path).map_err(|error| match error {
        OpenError::Io { .. } if nucleus_cache::part_path(path).exists() => {
            let part = shell_word(&nucleus_cache::part_path(path));
            anyhow!(
                "there is no `{}` yet: its run is still going or was killed; `nucleus play {part}` shows the frames so far, \
                 `nucleus resume {part}` continues it, `nucleus recover {part}` writes them as a complete cache",
                path.display()
            )
        }
        OpenError::Io { .. } | OpenError::Folder { .. } => anyhow!(error),
        other => anyhow!(other).context(format!("cannot open `{}`", path.display())),
    })
}

/// An error about a cache, with the remedy where a frame of it is damaged. `option` selects other frames.
pub fn with_remedy(error: anyhow::Error, path: &Path, option: &str) -> anyhow::Error {
    let is_damage = |cause: &(dyn std::error::Error + 'static)| {
        cause
            .downcast_ref()
            .is_some_and(|cause| matches!(cause, ReadError::Damaged { .. } | ReadError::MeshLost { .. }))
    };
    if !error.chain().any(is_damage) {
        return error;
    }
    anyhow!(
        "{error:#}; `{option}` selects other frames, and `nucleus recover {}` writes the intact ones as another cache",
        shell_word(path)
    )
}

/// First and last frame of a range of `--frames`; prints a warning if the cache ends before the range or begins after its start.
///
/// # Errors
/// If the cache holds no frame, or the range exceeds the largest number.
pub fn frames_of(range: FrameRange, cache: &Playback, path: &Path) -> Result<(i32, i32)> {
    let moments = cache.time_samples();
    let (begin, end) = moments.first().zip(moments.last()).context("the cache holds no frame")?;
    let (first, last) =
        range.within(begin.frame).context("the frame range exceeds the largest frame number, 2147483647")?;
    let overlaps = first <= end.frame && last >= begin.frame;
    if overlaps && (first < begin.frame || last > end.frame) {
        let (begin, end) = (begin.frame, end.frame);
        say!("warning: `{}` holds frames {begin} to {end} alone, not {first} to {last}", path.display());
    }
    Ok((first, last))
}

/// Opens a cache and prints a warning if parts of it are lost.
pub fn open_cache_and_warn(path: &Path) -> Result<Playback> {
    let cache = open_cache(path)?;
    if !cache.corruption().is_intact() {
        say!("warning: `{}`: {}", path.display(), cache.corruption());
    }
    Ok(cache)
}

/// Makes the folder of a file that is to be written, if there is none.
pub fn make_folder_of(path: &Path) -> Result<()> {
    let Some(folder) = path.parent().filter(|folder| !folder.as_os_str().is_empty()) else { return Ok(()) };
    std::fs::create_dir_all(folder).with_context(|| format!("cannot make the folder `{}`", folder.display()))
}

/// Whether a cache has an object of particles.
pub fn has_particles(cache: &Playback) -> bool {
    cache.objects().iter().any(|object| object.kind == ObjectKind::Particles)
}

/// The index of the last recorded state of `frame`, or of the cache.
pub fn moment(cache: &Playback, frame: Option<i32>) -> Result<usize> {
    let moments = cache.time_samples();
    let (first, last) = moments.first().zip(moments.last()).context("the cache holds no frame")?;
    match frame {
        None => Ok(moments.len() - 1),
        Some(frame) => cache.end_of(frame).with_context(|| {
            let has = format!("there is no frame {frame}; the cache has {} to {}", first.frame, last.frame);
            let frames = || moments.iter().map(|moment| moment.frame);
            match frames().filter(|&near| near < frame).max().zip(frames().filter(|&near| near > frame).min())
            {
                Some((before, after)) => format!("{has}, of those next to it {before} and {after}"),
                None => has,
            }
        }),
    }
}

/// Whether a file is a cache and not a scene, by its name or by its first bytes.
pub fn is_cache(path: &Path) -> bool {
    use std::io::Read;
    let mut head = [0; 5];
    // Killed and resumed runs leave a further extension.
    let name = path.file_name().unwrap_or_default().to_string_lossy().to_ascii_lowercase();
    let named = [".mcap", ".mcap.part", ".mcap.resuming"].iter().any(|end| name.ends_with(end));
    // Reading a pipe would block and consume its bytes.
    if named || !path.is_file() {
        return named;
    }
    let read = std::fs::File::open(path).and_then(|mut file| file.read_exact(&mut head));
    read.is_ok() && head == *b"\x89MCAP"
}
