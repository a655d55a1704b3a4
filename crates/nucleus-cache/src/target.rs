//! The file a run is recorded to: made anew, or put in the place of an older cache, and of nothing else.

use std::fs::{self, File, TryLockError};
use std::io::{self, ErrorKind, Read};
use std::path::{Path, PathBuf};

use mcap::MAGIC;
use mcap::records::{Record, op};

use crate::provenance::PROFILE;
use crate::record_error::RecordError;

/// A file on its way to its place.
#[derive(Debug)]
pub(crate) struct Target {
    pub file: File,
    /// Where it is while it grows, and where it belongs.
    pub places: Places,
}

/// Where a growing file is, and where it belongs.
#[derive(Debug)]
pub(crate) struct Places {
    growing: PathBuf,
    whole: PathBuf,
}

/// Makes the file beside its place, after a look at what is there. With `replace` an older cache may be in
/// the way, and what a killed run has left behind.
pub(crate) fn create(path: &Path, replace: bool) -> Result<Target, RecordError> {
    look_at(path, replace)?;
    let growing = unfinished(path);
    let file = open(&growing, path)?;
    let length = file.metadata().map_err(|source| failed(path, source))?.len();
    if length > 0 && !replace {
        return Err(RecordError::Unfinished { path: growing });
    }
    file.set_len(0).map_err(|source| failed(path, source))?;
    Ok(Target { file, places: Places { growing, whole: path.to_owned() } })
}

/// Makes the file of a run that goes on, beside the one that grows. With `replace` an older cache may be in the way.
pub(crate) fn beside(path: &Path, replace: bool) -> Result<Target, RecordError> {
    look_at(path, replace)?;
    let mut growing = path.file_name().unwrap_or_default().to_owned();
    growing.push(".resuming");
    let growing = path.with_file_name(growing);
    let file = open(&growing, path)?;
    file.set_len(0).map_err(|source| failed(path, source))?;
    Ok(Target { file, places: Places { growing, whole: path.to_owned() } })
}

fn failed(path: &Path, source: io::Error) -> RecordError {
    RecordError::Create { path: path.to_owned(), source }
}

/// Opens a file to be written by this run alone.
fn open(growing: &Path, path: &Path) -> Result<File, RecordError> {
    let mut options = File::options();
    let options = options.read(true).write(true).create(true).truncate(false);
    let file = options.open(growing).map_err(|source| failed(path, source))?;
    if is_locked(&file) { Err(RecordError::InUse { path: growing.to_owned() }) } else { Ok(file) }
}

/// Whether another run has a file for itself; if not, this one has from now on.
pub(crate) fn is_locked(file: &File) -> bool {
    // A file system without locks is no reason not to record.
    matches!(file.try_lock(), Err(TryLockError::WouldBlock))
}

/// Looks at what is in the way.
fn look_at(path: &Path, replace: bool) -> Result<(), RecordError> {
    let failed = |source| failed(path, source);
    let path_buf = || path.to_owned();
    match path.metadata() {
        Err(error) if error.kind() == ErrorKind::NotFound => {}
        Err(error) => return Err(failed(error)),
        Ok(found) if !found.is_file() => return Err(RecordError::NotAFile { path: path_buf() }),
        Ok(found) if found.len() > 0 && !is_cache(path).map_err(failed)? => {
            return Err(RecordError::NotOurs { path: path_buf() });
        }
        Ok(_) if !replace => return Err(RecordError::Exists { path: path_buf() }),
        Ok(found) if found.permissions().readonly() => {
            return Err(failed(io::Error::from(ErrorKind::PermissionDenied)));
        }
        Ok(_) => {}
    }
    Ok(())
}

/// Where the cache of a run is while it grows: its name with `.part` behind it.
pub fn unfinished(path: &Path) -> PathBuf {
    let mut name = path.file_name().unwrap_or_default().to_owned();
    name.push(".part");
    path.with_file_name(name)
}

impl Places {
    /// Moves a file that was begun beside to where files grow.
    pub fn take_over(&mut self) -> io::Result<()> {
        let growing = unfinished(&self.whole);
        fs::rename(&self.growing, &growing)?;
        self.growing = growing;
        Ok(())
    }

    /// Removes what was begun. If it cannot be, its name says what it is.
    pub fn give_up(&self) {
        let _ = fs::remove_file(&self.growing);
    }

    /// Moves the file, which is whole now, to its place.
    pub fn settle(&self) -> io::Result<()> {
        fs::rename(&self.growing, &self.whole)
    }
}

/// Whether the file begins as a cache does.
fn is_cache(path: &Path) -> io::Result<bool> {
    let mut head = Vec::new();
    File::open(path)?.take(4096).read_to_end(&mut head)?;
    Ok(read_header(&head).is_some_and(|(profile, _)| profile == PROFILE))
}

/// Profile and library from the first bytes of an MCAP file.
pub(crate) fn read_header(head: &[u8]) -> Option<(String, String)> {
    let record = head.strip_prefix(MAGIC)?;
    let (&opcode, record) = record.split_first()?;
    let (length, body) = record.split_first_chunk::<8>()?;
    let body = body.get(..usize::try_from(u64::from_le_bytes(*length)).ok()?)?;
    match (opcode == op::HEADER).then(|| mcap::parse_record(opcode, body))? {
        Ok(Record::Header(header)) => Some((header.profile, header.library)),
        _ => None,
    }
}
