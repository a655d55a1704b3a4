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
    let failed = |source| RecordError::Create { path: path.to_owned(), source };
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
    let growing = unfinished(path);
    let mut options = File::options();
    let file = options.read(true).write(true).create(true).truncate(false).open(&growing).map_err(failed)?;
    // A file system without locks is no reason not to record.
    if matches!(file.try_lock(), Err(TryLockError::WouldBlock)) {
        return Err(RecordError::InUse { path: growing });
    }
    let length = file.metadata().map_err(failed)?.len();
    if length > 0 && !replace {
        return Err(RecordError::Unfinished { path: growing });
    }
    file.set_len(0).map_err(failed)?;
    Ok(Target { file, places: Places { growing, whole: path_buf() } })
}

/// Where the cache of a run is while it grows: its name with `.part` behind it.
pub fn unfinished(path: &Path) -> PathBuf {
    let mut name = path.file_name().unwrap_or_default().to_owned();
    name.push(".part");
    path.with_file_name(name)
}

impl Places {
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
