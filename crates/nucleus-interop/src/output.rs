//! The files of an export: their names, and writing them so that each appears only when it is complete.

use std::collections::HashSet;
use std::fs;
use std::io::{self, BufWriter, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use nucleus_cache::atomic_file::AtomicFile;

use crate::error::ExportError;

/// The destination of an export, and the files that it has written.
pub(crate) struct Output {
    replaces: bool,
    written: Vec<PathBuf>,
    /// Those of the files that are in the place of no older one.
    new: Vec<PathBuf>,
}

/// An unfinished file. Dropped before [`Output::finish`], it leaves nothing behind.
///
/// The first error is kept and reported by `finish`, so that loops over points need not check each write.
pub(crate) struct OutFile {
    file: BufWriter<AtomicFile>,
    failed: Option<io::Error>,
}

impl Output {
    /// An export that may replace files if `replaces` is set.
    pub fn new(replaces: bool) -> Self {
        Self { replaces, written: Vec::new(), new: Vec::new() }
    }

    /// Begins a file.
    ///
    /// # Errors
    /// When something exists there that may not be replaced, or the folder cannot be written.
    pub fn file(&mut self, path: PathBuf) -> Result<OutFile, ExportError> {
        let is_replaceable = self.replaces && !path.is_dir();
        if path.exists() && !is_replaceable {
            return Err(ExportError::Exists { path });
        }
        match AtomicFile::create(&path) {
            Ok(file) => Ok(OutFile { file: BufWriter::with_capacity(1 << 18, file), failed: None }),
            Err(source) => Err(ExportError::Write { path, source }),
        }
    }

    /// Makes a folder, with its parents.
    pub fn folder(&self, path: &Path) -> Result<(), ExportError> {
        fs::create_dir_all(path).map_err(|source| ExportError::Write { path: path.to_owned(), source })
    }

    /// Completes a file and gives it its name.
    ///
    /// # Errors
    /// When any write to it has failed.
    pub fn finish(&mut self, file: OutFile) -> Result<(), ExportError> {
        let path = file.file.get_ref().destination().to_owned();
        let is_new = !path.exists();
        file.close().map_err(|source| ExportError::Write { path: path.clone(), source })?;
        self.new.extend(is_new.then(|| path.clone()));
        self.written.push(path);
        Ok(())
    }

    /// All files, in the order in which they were finished.
    pub fn written(self) -> Vec<PathBuf> {
        self.written
    }

    /// Removes the new files of an export that has failed, so that they are not in the way of the next one.
    pub fn remove_new(self) {
        for path in self.new {
            // What cannot be removed stays, beside the error that is reported.
            let _ = fs::remove_file(path);
        }
    }
}

impl OutFile {
    /// Writes bytes.
    pub fn bytes(&mut self, bytes: &[u8]) {
        if self.failed.is_none() {
            self.failed = self.file.write_all(bytes).err();
        }
    }

    /// Writes text.
    pub fn text(&mut self, text: impl AsRef<str>) {
        self.bytes(text.as_ref().as_bytes());
    }

    /// Writes little-endian floats.
    pub fn floats_le(&mut self, values: &[[f32; 3]]) {
        values.as_flattened().iter().for_each(|x| self.bytes(&x.to_le_bytes()));
    }

    /// Writes big-endian floats.
    pub fn floats_be(&mut self, values: &[[f32; 3]]) {
        values.as_flattened().iter().for_each(|x| self.bytes(&x.to_be_bytes()));
    }

    /// Keeps an error that is not one of writing.
    pub fn fail(&mut self, error: io::Error) {
        self.failed.get_or_insert(error);
    }

    /// Whether a write has failed, after which all further work on the file is wasted.
    pub fn has_failed(&self) -> bool {
        self.failed.is_some()
    }

    fn close(self) -> io::Result<()> {
        match self.failed {
            Some(error) => Err(error),
            None => self.file.into_inner().map_err(io::IntoInnerError::into_error)?.commit(),
        }
    }
}

impl Write for OutFile {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.file.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.flush()
    }
}

impl Seek for OutFile {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        self.file.seek(to)
    }
}

/// Names of files: characters other than letters, digits, `_`, `-` and `.` become `_`, and no two names are equal,
/// whatever the case of their letters.
pub(crate) fn file_names<'a>(names: impl IntoIterator<Item = &'a str>) -> Vec<String> {
    unique(names, |c| c.is_ascii_alphanumeric() || matches!(c, '_' | '-' | '.'))
}

/// Names of nodes: letters, digits and `_`, not beginning with a digit.
pub(crate) fn node_names<'a>(names: impl IntoIterator<Item = &'a str>) -> Vec<String> {
    unique(names, |c| c.is_ascii_alphanumeric() || c == '_')
}

fn unique<'a>(names: impl IntoIterator<Item = &'a str>, is_allowed: impl Fn(char) -> bool) -> Vec<String> {
    let mut taken = HashSet::new();
    let made = names.into_iter().map(|name| {
        let plain: String = name.chars().map(|c| if is_allowed(c) { c } else { '_' }).collect();
        let needs_letter = plain.chars().next().is_none_or(|c| !c.is_ascii_alphabetic() && c != '_');
        let plain = if needs_letter { format!("_{plain}") } else { plain };
        let mut name = plain.clone();
        let mut copy = 1;
        while !taken.insert(name.to_ascii_lowercase()) {
            copy += 1;
            name = format!("{plain}_{copy}");
        }
        name
    });
    made.collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_have_allowed_characters_and_are_unique() {
        let names = ["cloth1", "ns:cloth|1", "ns_cloth_1", "Cloth1", "1st", "ä", ""];
        let expected = ["cloth1", "ns_cloth_1", "ns_cloth_1_2", "Cloth1_2", "_1st", "_", "__2"];
        assert_eq!(node_names(names), expected);
        assert_eq!(file_names(["a-b.c", "a/b"]), ["a-b.c", "a_b"]);
    }
}
