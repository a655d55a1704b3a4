//! A file that gets its final name only when it is whole. It replaces an older cache on request, and no other file.

use std::fs::{self, File, TryLockError};
use std::io::{self, ErrorKind, Read};
use std::path::{Path, PathBuf};

use mcap::MAGIC;
use mcap::records::{Record, op};

use crate::atomic_file::follow_links;
use crate::error::RecordError;
use crate::messages::metadata::PROFILE;

/// A file under its temporary name.
#[derive(Debug)]
pub(crate) struct PartFile {
    pub file: File,
    /// Its temporary and its final path.
    pub paths: PartPaths,
}

/// Temporary and final path of a file.
#[derive(Debug)]
pub(crate) struct PartPaths {
    partial: PathBuf,
    final_path: PathBuf,
    /// Another handle to the file: it keeps the lock until the file has its final name, after the writer is closed.
    locked: File,
}

/// Creates the temporary file beside the file that `path` names. With `replace` it may overwrite an older cache, and the
/// partial cache of a killed run.
pub(crate) fn create(path: &Path, replace: bool) -> Result<PartFile, RecordError> {
    check_existing(path, replace)?;
    let (partial, final_path) = (part_path(path), follow_links(path));
    let file = open(&partial, path, replace)?;
    let length = file.metadata().map_err(|source| failed(path, source))?.len();
    if length > 0 && !replace {
        return Err(RecordError::Unfinished { path: partial });
    }
    empty(file, partial, final_path).map_err(|source| failed(path, source))
}

/// Creates the temporary file of a resumed run, beside the partial cache. With `replace` it may overwrite an older
/// cache.
pub(crate) fn create_for_resume(path: &Path, replace: bool) -> Result<PartFile, RecordError> {
    check_existing(path, replace)?;
    let final_path = follow_links(path);
    let partial = with_end(&final_path, ".resuming");
    let file = open(&partial, path, replace)?;
    empty(file, partial, final_path).map_err(|source| failed(path, source))
}

/// The locked file without its bytes.
fn empty(file: File, partial: PathBuf, final_path: PathBuf) -> io::Result<PartFile> {
    file.set_len(0)?;
    let locked = file.try_clone()?;
    Ok(PartFile { file, paths: PartPaths { partial, final_path, locked } })
}

fn failed(path: &Path, source: io::Error) -> RecordError {
    RecordError::Create { path: path.to_owned(), source }
}

/// Opens a file for writing and locks it.
fn open(partial: &Path, path: &Path, replace: bool) -> Result<File, RecordError> {
    let mut options = File::options();
    let options = options.read(true).write(true).create(true).truncate(false);
    loop {
        let file = options.open(partial).map_err(|source| failed(path, source))?;
        if is_locked(&file) {
            return Err(RecordError::InUse { path: partial.to_owned() });
        }
        // Another run may have renamed the file before it was locked: it is a finished cache then.
        if is_at(&file, partial).map_err(|source| failed(path, source))? {
            return check_again(file, partial, path, replace);
        }
    }
}

/// Checks a second time whether an existing file may be replaced: until the lock, another run could finish.
fn check_again(file: File, partial: &Path, path: &Path, replace: bool) -> Result<File, RecordError> {
    let checked = check_existing(path, replace);
    if checked.is_err() && file.metadata().is_ok_and(|found| found.len() == 0) {
        let _ = fs::remove_file(partial);
    }
    checked.map(|()| file)
}

/// Whether the path still names the open file.
#[cfg(unix)]
fn is_at(file: &File, path: &Path) -> io::Result<bool> {
    use std::os::unix::fs::MetadataExt;
    let opened = file.metadata()?;
    match path.metadata() {
        Ok(named) => Ok((named.dev(), named.ino()) == (opened.dev(), opened.ino())),
        Err(error) if error.kind() == ErrorKind::NotFound => Ok(false),
        Err(error) => Err(error),
    }
}

/// Whether the path still names the open file; unknown, and taken as yes, where files have no number.
#[cfg(not(unix))]
fn is_at(_: &File, _: &Path) -> io::Result<bool> {
    Ok(true)
}

/// Whether another run has locked the file; if not, this call locks it.
pub(crate) fn is_locked(file: &File) -> bool {
    // A file system without locks must not prevent recording.
    matches!(file.try_lock(), Err(TryLockError::WouldBlock))
}

/// Checks whether an existing file may be replaced.
fn check_existing(path: &Path, replace: bool) -> Result<(), RecordError> {
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

/// Path of a partial cache: that of the file that `path` names, with symbolic links followed and `.part` appended.
pub fn part_path(path: &Path) -> PathBuf {
    with_end(&follow_links(path), ".part")
}

/// A path with text appended to its name.
fn with_end(path: &Path, end: &str) -> PathBuf {
    let mut name = path.file_name().unwrap_or_default().to_owned();
    name.push(end);
    path.with_file_name(name)
}

impl PartPaths {
    /// Renames the file of a resumed run to the path of a partial cache. Its bytes are on disk before, because the rename
    /// removes those of the older cache.
    pub fn promote(&mut self) -> io::Result<()> {
        let partial = part_path(&self.final_path);
        self.locked.sync_all()?;
        fs::rename(&self.partial, &partial)?;
        self.partial = partial;
        Ok(())
    }

    /// Removes the temporary file. A failure is ignored: the name marks it as temporary.
    pub fn remove(&self) {
        let _ = fs::remove_file(&self.partial);
    }

    /// Renames the whole file to its final path. Its bytes are on disk before, so a power failure leaves no empty cache.
    pub fn commit(self) -> io::Result<()> {
        self.locked.sync_all()?;
        fs::rename(&self.partial, &self.final_path)
    }
}

/// Whether the file begins like a cache.
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_is_locked_until_it_has_its_final_name() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.mcap");
        let PartFile { file, paths } = create(&path, true).unwrap();
        drop(file);
        assert!(matches!(create(&path, true), Err(RecordError::InUse { .. })));
        paths.commit().unwrap();
        assert!(path.exists() && create(&path, true).is_ok());
    }

    #[test]
    fn a_cache_that_is_finished_before_the_lock_is_not_replaced_unasked() {
        let folder = tempfile::tempdir().unwrap();
        let [part, path] = ["a.mcap.part", "a.mcap"].map(|name| folder.path().join(name));
        File::create(&path).unwrap();
        assert!(matches!(open(&part, &path, false), Err(RecordError::Exists { .. })));
        assert!(!part.exists());
        assert!(open(&part, &path, true).is_ok());
    }

    #[cfg(unix)]
    #[test]
    fn a_file_that_another_run_has_renamed_is_no_longer_at_its_path() {
        let folder = tempfile::tempdir().unwrap();
        let [part, whole] = ["a.part", "a"].map(|name| folder.path().join(name));
        let file = File::create(&part).unwrap();
        assert!(is_at(&file, &part).unwrap());
        fs::rename(&part, &whole).unwrap();
        assert!(!is_at(&file, &part).unwrap(), "the path names nothing");
        let next = File::create(&part).unwrap();
        assert!(!is_at(&file, &part).unwrap(), "the path names the file of the next run");
        assert!(is_at(&next, &part).unwrap());
    }
}
