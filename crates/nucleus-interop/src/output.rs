//! Files that are whole or not there: written beside their place, and moved there when they are done.

use std::fs::{self, File};
use std::io::{self, BufWriter, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use crate::error::ExportError;

/// Where an export goes, and what it has written.
pub(crate) struct Output {
    force: bool,
    written: Vec<PathBuf>,
}

/// A file on its way. Dropped before it is finished, it leaves nothing behind.
pub(crate) struct OutFile {
    place: PathBuf,
    beside: PathBuf,
    file: BufWriter<File>,
    failed: Option<io::Error>,
    finished: bool,
}

impl Output {
    pub fn new(force: bool) -> Self {
        Self { force, written: Vec::new() }
    }

    /// Begins a file.
    pub fn file(&mut self, place: PathBuf) -> Result<OutFile, ExportError> {
        self.check(&place)?;
        let mut name = place.file_name().unwrap_or_default().to_owned();
        name.push(".part");
        let beside = place.with_file_name(name);
        match File::create(&beside) {
            Ok(file) => {
                let file = BufWriter::with_capacity(1 << 18, file);
                Ok(OutFile { place, beside, file, failed: None, finished: false })
            }
            Err(source) => Err(ExportError::Write { path: place, source }),
        }
    }

    /// Refuses to replace anything without being told to.
    pub fn check(&self, place: &Path) -> Result<(), ExportError> {
        let replaceable = self.force && !place.is_dir();
        if place.exists() && !replaceable {
            return Err(ExportError::Exists { path: place.to_owned() });
        }
        Ok(())
    }

    /// Makes a folder, with those above it.
    pub fn folder(&self, place: &Path) -> Result<(), ExportError> {
        fs::create_dir_all(place).map_err(|source| ExportError::Write { path: place.to_owned(), source })
    }

    /// Moves a file to its place.
    pub fn finish(&mut self, mut file: OutFile) -> Result<(), ExportError> {
        let result = file.close();
        result.map_err(|source| ExportError::Write { path: file.place.clone(), source })?;
        self.written.push(file.place.clone());
        Ok(())
    }

    /// All files, in the order in which they were finished.
    pub fn written(self) -> Vec<PathBuf> {
        self.written
    }
}

/// Writing is told of at the end, so that the loops over points need not ask.
impl OutFile {
    pub fn bytes(&mut self, bytes: &[u8]) {
        if self.failed.is_none() {
            self.failed = self.file.write_all(bytes).err();
        }
    }

    pub fn text(&mut self, text: impl AsRef<str>) {
        self.bytes(text.as_ref().as_bytes());
    }

    /// Floats, lowest byte first.
    pub fn floats_le(&mut self, values: &[[f32; 3]]) {
        values.as_flattened().iter().for_each(|x| self.bytes(&x.to_le_bytes()));
    }

    /// Floats, highest byte first.
    pub fn floats_be(&mut self, values: &[[f32; 3]]) {
        values.as_flattened().iter().for_each(|x| self.bytes(&x.to_be_bytes()));
    }

    /// Whether anything has failed: there is no sense in going on.
    pub fn has_failed(&self) -> bool {
        self.failed.is_some()
    }

    fn close(&mut self) -> io::Result<()> {
        if let Some(error) = self.failed.take() {
            return Err(error);
        }
        self.file.flush()?;
        fs::rename(&self.beside, &self.place)?;
        self.finished = true;
        Ok(())
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

impl Drop for OutFile {
    fn drop(&mut self) {
        if !self.finished {
            // What cannot be removed either is at least not under the final name.
            let _ = fs::remove_file(&self.beside);
        }
    }
}
