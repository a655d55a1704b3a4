//! Results kept between commands, one folder per fingerprint of a scene and a solver.

use std::fs::{self, OpenOptions};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use nucleus_cache::atomic_file;
use nucleus_graph::Simulation;
use nucleus_graph::compile::compile;
use nucleus_graph::scene::read_scene_text;
use serde::Serialize;
use serde::de::DeserializeOwned;

/// The results of one scene and one solver: a folder of files that are written atomically.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ResultCache {
    folder: PathBuf,
}

/// A file or folder that cannot be read or written.
#[derive(Debug, thiserror::Error)]
#[error("cannot read or write `{}`", path.display())]
pub struct ResultCacheError {
    /// The file or folder.
    pub path: PathBuf,
    /// The error of the system.
    pub source: io::Error,
}

impl ResultCache {
    /// The folder `name` below `all`. The first write creates it.
    pub fn new(all: &Path, name: &str) -> Self {
        Self { folder: all.join(name) }
    }

    /// Path of the folder.
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// The bytes of a file; `None` if it does not exist.
    ///
    /// # Errors
    /// When it exists and cannot be read.
    pub fn read(&self, name: &str) -> Result<Option<Vec<u8>>, ResultCacheError> {
        let path = self.folder.join(name);
        match fs::read(&path) {
            Ok(bytes) => Ok(Some(bytes)),
            Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(None),
            Err(source) => Err(ResultCacheError { path, source }),
        }
    }

    /// Writes a file atomically.
    ///
    /// # Errors
    /// When the folder or the file cannot be written.
    pub fn write(&self, name: &str, bytes: &[u8]) -> Result<(), ResultCacheError> {
        self.create()?;
        write_atomic(&self.folder.join(name), bytes)
    }

    /// The entries of a list, one JSON value per line. Skips lines that do not parse, such as the last line of a killed
    /// run.
    ///
    /// # Errors
    /// When the list exists and cannot be read.
    pub fn list<T: DeserializeOwned>(&self, name: &str) -> Result<Vec<T>, ResultCacheError> {
        let bytes = self.read(name)?.unwrap_or_default();
        let text = String::from_utf8_lossy(&bytes);
        Ok(text.lines().filter_map(|line| serde_json::from_str(line).ok()).collect())
    }

    /// Appends a line to a list. Terminates a truncated last line first, so that it invalidates no other line.
    ///
    /// # Errors
    /// When the folder or the list cannot be written.
    pub fn append(&self, name: &str, item: &impl Serialize) -> Result<(), ResultCacheError> {
        self.create()?;
        let path = self.folder.join(name);
        let add = || -> io::Result<()> {
            let is_truncated =
                fs::read(&path).is_ok_and(|bytes| bytes.last().is_some_and(|last| *last != b'\n'));
            let mut line = if is_truncated { vec![b'\n'] } else { Vec::new() };
            serde_json::to_writer(&mut line, item)?;
            line.push(b'\n');
            let mut file = OpenOptions::new().create(true).append(true).open(&path)?;
            file.write_all(&line)?;
            file.flush()
        };
        add().map_err(|source| ResultCacheError { path: path.clone(), source })
    }

    /// Removes all results.
    ///
    /// # Errors
    /// When the folder exists and cannot be removed.
    pub fn clear(&self) -> Result<(), ResultCacheError> {
        match fs::remove_dir_all(&self.folder) {
            Err(error) if error.kind() != io::ErrorKind::NotFound => {
                Err(ResultCacheError { path: self.folder.clone(), source: error })
            }
            _ => Ok(()),
        }
    }

    fn create(&self) -> Result<(), ResultCacheError> {
        fs::create_dir_all(&self.folder)
            .map_err(|source| ResultCacheError { path: self.folder.clone(), source })
    }
}

/// Writes a file atomically: to a temporary file in the same folder, which is then renamed.
///
/// # Errors
/// When it cannot be written.
pub fn write_atomic(path: &Path, bytes: &[u8]) -> Result<(), ResultCacheError> {
    atomic_file::write(path, bytes).map_err(|source| ResultCacheError { path: path.to_owned(), source })
}

/// FNV-1a hash over 64 bits.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Fingerprint(u64);

impl Default for Fingerprint {
    fn default() -> Self {
        Self(0xcbf2_9ce4_8422_2325)
    }
}

impl Fingerprint {
    /// Hashes more bytes.
    pub fn bytes(mut self, bytes: &[u8]) -> Self {
        for byte in bytes {
            self.0 = (self.0 ^ u64::from(*byte)).wrapping_mul(0x0000_0100_0000_01b3);
        }
        self
    }

    /// Sixteen hexadecimal digits.
    pub fn name(self) -> String {
        format!("{:016x}", self.0)
    }
}

/// A scene that exercises all features, so that any change of the solver changes the bits of its last state.
const CANARY: &str = r#"Scene(
    time: (start: 1, end: 9, fps: 24),
    nodes: {
        "n": nucleus(spaceScale: 0.01, usePlane: true, windSpeed: 2, subSteps: 2, evaluations: 8, resistanceModel: MODEL),
        "p": polyPlane(width: 60, height: 60, subdivisions: (6, 6), translate: (3, 22, 0), rotate: (0, 10, 4)),
        "c": nCloth(inputMesh: "p", shearResistance: 2, bendResistance: 1, damp: 0.1, friction: 0.3, bounce: 0.2, thickness: 1),
        "d": dynamicConstraint(constraintType: transform, components: ["c.vtx[0]"], translateY: keys([(1, 22), (9, 30)])),
        "s": polySphere(radius: 18, subdivisions: (8, 6)),
        "r": nRigid(inputMesh: "s", friction: 0.2),
    },
)"#;

/// Fingerprint of the solver: its version, and the bits of the last state of a small scene. A build that computes
/// different bits is a different solver, whatever its version says.
pub fn solver_fingerprint() -> Fingerprint {
    let version = Fingerprint::default().bytes(env!("CARGO_PKG_VERSION").as_bytes());
    ["physical", "classic"].iter().fold(version, |print, model| {
        let text = CANARY.replace("MODEL", model);
        let scene = read_scene_text(&text, "canary.ron".as_ref());
        let program = scene.ok().and_then(|(scene, _)| compile(&scene).ok());
        let hash = program.map_or(0, |program| {
            let mut run: Simulation = Simulation::new(&program, 1);
            while !run.is_done() {
                run.advance(&mut ());
            }
            run.solver().state_hash()
        });
        print.bytes(&hash.to_le_bytes())
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_written_file_is_read_back_and_leaves_no_temporary_file() {
        let folder = tempfile::tempdir().unwrap();
        let cache = ResultCache::new(folder.path(), "scene");
        assert_eq!(cache.read("a").unwrap(), None);
        cache.write("a", b"one").unwrap();
        cache.write("a", b"two").unwrap();
        assert_eq!(cache.read("a").unwrap().as_deref(), Some(&b"two"[..]));
        assert_eq!(fs::read_dir(cache.folder()).unwrap().count(), 1);
        cache.clear().unwrap();
        cache.clear().unwrap();
        assert_eq!(cache.read("a").unwrap(), None);
    }

    #[test]
    fn a_truncated_list_keeps_its_complete_lines_and_accepts_more() {
        let folder = tempfile::tempdir().unwrap();
        let cache = ResultCache::new(folder.path(), "scene");
        cache.append("runs", &"one").unwrap();
        cache.append("runs", &"two").unwrap();
        let path = cache.folder().join("runs");
        let bytes = fs::read(&path).unwrap();
        fs::write(&path, &bytes[..bytes.len() - 3]).unwrap(); // killed while it wrote
        cache.append("runs", &"three").unwrap();
        assert_eq!(cache.list::<String>("runs").unwrap(), ["one", "three"]);
    }

    #[test]
    fn an_error_names_the_folder_that_cannot_be_created() {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("scene"), "a file").unwrap();
        let error = ResultCache::new(folder.path(), "scene").write("a", b"one").unwrap_err();
        assert!(error.to_string().contains("scene"), "{error}");
    }

    #[test]
    fn different_bytes_have_different_fingerprints() {
        let of = |text: &str| Fingerprint::default().bytes(text.as_bytes()).name();
        assert_eq!(of("a"), "af63dc4c8601ec8c"); // as published with the algorithm
        assert_ne!(of("ab"), of("ba"));
    }

    #[test]
    fn the_solver_fingerprint_is_reproducible_and_its_scene_compiles() {
        assert_eq!(solver_fingerprint(), solver_fingerprint());
        for model in ["physical", "classic"] {
            let (scene, _) = read_scene_text(&CANARY.replace("MODEL", model), "c".as_ref()).unwrap();
            assert!(compile(&scene).is_ok());
        }
    }
}
