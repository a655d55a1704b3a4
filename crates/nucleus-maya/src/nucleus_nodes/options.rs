//! Options of an import.

use std::path::{Path, PathBuf};

/// Writes a file: its name, and its text. The error is a message.
pub type WriteFile<'a> = dyn FnMut(&str, String) -> Result<(), String> + 'a;

/// How a scene is imported.
pub struct ImportOptions<'a> {
    /// Meshes that the artist gives: the name of a node and an OBJ file.
    pub meshes: Vec<(String, PathBuf)>,
    /// The folder of the meshes, relative to our scene file.
    pub folder: String,
    /// Reads resistances as stiffnesses in place of Maya's counts of iterations.
    pub physical: bool,
    /// Solves objects that the scene plays from a cache.
    pub simulate: bool,
    /// Writes a file of a mesh or a cache: its name relative to our scene file, and its text. The error is a message.
    pub write: Box<WriteFile<'a>>,
}

impl<'a> ImportOptions<'a> {
    /// Without meshes of the artist, in Maya's model of resistances, with caches where they are.
    pub fn new(folder: &str, write: impl FnMut(&str, String) -> Result<(), String> + 'a) -> Self {
        Self {
            meshes: Vec::new(),
            folder: folder.to_owned(),
            physical: false,
            simulate: false,
            write: Box::new(write),
        }
    }
}

/// The same options without their owner.
pub(crate) struct BorrowedOptions<'s> {
    pub(super) meshes: &'s [(String, PathBuf)],
    pub(super) folder: &'s str,
    pub(super) physical: bool,
    pub(super) simulate: bool,
    /// The folder of our scene file.
    pub(super) target: PathBuf,
    pub(super) write: &'s mut WriteFile<'s>,
}

impl<'s> BorrowedOptions<'s> {
    /// For a scene file that will be `ron`.
    pub(crate) fn of(options: &'s mut ImportOptions<'_>, ron: &Path) -> Self {
        let ImportOptions { meshes, folder, physical, simulate, write } = options;
        let target = ron.parent().unwrap_or(Path::new("")).to_owned();
        Self { meshes, folder, physical: *physical, simulate: *simulate, target, write: &mut **write }
    }
}
