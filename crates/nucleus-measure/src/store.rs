//! Where results are kept: a folder per scene and solver, in which nothing is ever half written.

use std::fs::{self, OpenOptions};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use nucleus_cache::atomic_file;
use serde::Serialize;
use serde::de::DeserializeOwned;

/// The folder of one scene and one solver.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Store {
    folder: PathBuf,
}

/// A folder or file that could not be used.
#[derive(Debug, thiserror::Error)]
#[error("cannot use `{}`", path.display())]
pub struct StoreError {
    /// Which.
    pub path: PathBuf,
    /// What the system said.
    pub source: io::Error,
}

impl Store {
    /// The folder of this name below another; it is made when something is put into it.
    pub fn new(all: &Path, name: &str) -> Self {
        Self { folder: all.join(name) }
    }

    /// The folder.
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// The bytes of a file; nothing if there is none.
    ///
    /// # Errors
    /// When it is there and cannot be read.
    pub fn read(&self, name: &str) -> Result<Option<Vec<u8>>, StoreError> {
        let path = self.folder.join(name);
        match fs::read(&path) {
            Ok(bytes) => Ok(Some(bytes)),
            Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(None),
            Err(source) => Err(StoreError { path, source }),
        }
    }

    /// Writes a file: as a whole or not at all, whatever happens on the way.
    ///
    /// # Errors
    /// When the folder or the file cannot be written.
    pub fn write(&self, name: &str, bytes: &[u8]) -> Result<(), StoreError> {
        self.make()?;
        write_whole(&self.folder.join(name), bytes)
    }

    /// What a list holds, line by line. Lines that cannot be read, such as the last of a run that was killed, are
    /// left out.
    ///
    /// # Errors
    /// When the list is there and cannot be read.
    pub fn list<T: DeserializeOwned>(&self, name: &str) -> Result<Vec<T>, StoreError> {
        let bytes = self.read(name)?.unwrap_or_default();
        let text = String::from_utf8_lossy(&bytes);
        Ok(text.lines().filter_map(|line| serde_json::from_str(line).ok()).collect())
    }

    /// Adds a line to a list. Whatever was cut off at its end before is closed, so that it harms no other line.
    ///
    /// # Errors
    /// When the folder or the list cannot be written.
    pub fn append(&self, name: &str, item: &impl Serialize) -> Result<(), StoreError> {
        self.make()?;
        let path = self.folder.join(name);
        let add = || -> io::Result<()> {
            let is_cut = fs::read(&path).is_ok_and(|bytes| bytes.last().is_some_and(|last| *last != b'\n'));
            let mut line = if is_cut { vec![b'\n'] } else { Vec::new() };
            serde_json::to_writer(&mut line, item)?;
            line.push(b'\n');
            let mut file = OpenOptions::new().create(true).append(true).open(&path)?;
            file.write_all(&line)?;
            file.flush()
        };
        add().map_err(|source| StoreError { path: path.clone(), source })
    }

    /// Forgets everything.
    ///
    /// # Errors
    /// When the folder is there and cannot be removed.
    pub fn clear(&self) -> Result<(), StoreError> {
        match fs::remove_dir_all(&self.folder) {
            Err(error) if error.kind() != io::ErrorKind::NotFound => {
                Err(StoreError { path: self.folder.clone(), source: error })
            }
            _ => Ok(()),
        }
    }

    fn make(&self) -> Result<(), StoreError> {
        fs::create_dir_all(&self.folder).map_err(|source| StoreError { path: self.folder.clone(), source })
    }
}

/// Replaces a file as a whole, by way of a temporary file beside it.
///
/// # Errors
/// When it cannot be written.
pub fn write_whole(path: &Path, bytes: &[u8]) -> Result<(), StoreError> {
    atomic_file::write(path, bytes).map_err(|source| StoreError { path: path.to_owned(), source })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_written_is_read_and_nothing_is_left_beside_it() {
        let folder = tempfile::tempdir().unwrap();
        let store = Store::new(folder.path(), "scene");
        assert_eq!(store.read("a").unwrap(), None);
        store.write("a", b"one").unwrap();
        store.write("a", b"two").unwrap();
        assert_eq!(store.read("a").unwrap().as_deref(), Some(&b"two"[..]));
        assert_eq!(fs::read_dir(store.folder()).unwrap().count(), 1);
        store.clear().unwrap();
        store.clear().unwrap();
        assert_eq!(store.read("a").unwrap(), None);
    }

    #[test]
    fn a_list_that_was_cut_off_keeps_its_whole_lines_and_takes_more() {
        let folder = tempfile::tempdir().unwrap();
        let store = Store::new(folder.path(), "scene");
        store.append("runs", &"one").unwrap();
        store.append("runs", &"two").unwrap();
        let path = store.folder().join("runs");
        let bytes = fs::read(&path).unwrap();
        fs::write(&path, &bytes[..bytes.len() - 3]).unwrap(); // killed while it wrote
        store.append("runs", &"three").unwrap();
        assert_eq!(store.list::<String>("runs").unwrap(), ["one", "three"]);
    }

    #[test]
    fn a_folder_that_cannot_be_made_is_named() {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("scene"), "a file").unwrap();
        let error = Store::new(folder.path(), "scene").write("a", b"one").unwrap_err();
        assert!(error.to_string().contains("scene"), "{error}");
    }
}
