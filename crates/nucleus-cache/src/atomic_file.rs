//! Atomic files: written to a temporary file in the same folder, then renamed over the destination.
//!
//! A destination that is a symbolic link is followed: the file that it names is replaced, and the link stays.
//! A reader of the destination sees the old file or the complete new one. The temporary file is removed when the
//! writer fails. A process that is killed leaves it behind, as `<name>.<random>.part`.

use std::fs::{self, File};
use std::io::{self, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use tempfile::{Builder, NamedTempFile};

/// A file that gets its name when it is complete. Dropped before [`commit`](Self::commit), it leaves nothing behind.
#[derive(Debug)]
pub struct AtomicFile {
    temporary: NamedTempFile,
    destination: PathBuf,
    /// The destination with its symbolic links followed.
    target: PathBuf,
}

/// Symbolic links that are followed from one path; the limit of Linux.
const MAX_LINKS: usize = 40;

/// The path of the file that `path` names: symbolic links at its end are followed, also to a file that does not exist.
pub(crate) fn follow_links(path: &Path) -> PathBuf {
    let mut path = path.to_owned();
    for _ in 0..MAX_LINKS {
        // Any path that is no link, or does not exist, is an error here.
        let Ok(target) = fs::read_link(&path) else { break };
        // An absolute target replaces the folder.
        path = path.parent().unwrap_or(Path::new("")).join(target);
    }
    path
}

impl AtomicFile {
    /// Creates the temporary file beside the file that the destination names, with the permissions of any new file.
    ///
    /// # Errors
    /// When the path names no file, or its folder cannot be written.
    pub fn create(destination: impl Into<PathBuf>) -> io::Result<Self> {
        let destination = destination.into();
        let target = follow_links(&destination);
        let missing_name = || io::Error::new(io::ErrorKind::InvalidInput, "the path names no file");
        let mut prefix = target.file_name().ok_or_else(missing_name)?.to_owned();
        prefix.push(".");
        let folder = target.parent().filter(|folder| !folder.as_os_str().is_empty());
        let mut builder = Builder::new();
        builder.prefix(&prefix).suffix(".part");
        // The default of `tempfile`, readable by the owner alone, would outlive the rename.
        #[cfg(unix)]
        builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
        let temporary = builder.tempfile_in(folder.unwrap_or(Path::new(".")))?;
        Ok(Self { temporary, destination, target })
    }

    /// The path of the complete file.
    pub fn destination(&self) -> &Path {
        &self.destination
    }

    /// The path of the temporary file, for a writer that opens files by path.
    pub fn temporary(&self) -> &Path {
        self.temporary.path()
    }

    /// Another handle to the temporary file, for a writer that consumes its output.
    ///
    /// # Errors
    /// When the system has no handle left.
    pub fn handle(&self) -> io::Result<File> {
        self.temporary.as_file().try_clone()
    }

    /// Renames the temporary file over the destination. Its bytes are on disk before the rename, so a power failure leaves
    /// the old file or the new one.
    ///
    /// # Errors
    /// When the bytes cannot be written or the destination cannot be replaced; it is then as before.
    pub fn commit(self) -> io::Result<()> {
        self.temporary.as_file().sync_all()?;
        self.temporary.persist(self.target).map(drop).map_err(|failed| failed.error)
    }
}

impl Write for AtomicFile {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.temporary.as_file_mut().write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.temporary.as_file_mut().flush()
    }
}

impl Seek for AtomicFile {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        self.temporary.as_file_mut().seek(to)
    }
}

/// Replaces a file by these bytes.
///
/// # Errors
/// When the file cannot be written; the destination is then as before.
pub fn write(destination: &Path, bytes: &[u8]) -> io::Result<()> {
    let mut file = AtomicFile::create(destination)?;
    file.write_all(bytes)?;
    file.commit()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_that_is_not_committed_leaves_the_old_one_and_nothing_else() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.gif");
        write(&path, b"old").unwrap();
        let mut file = AtomicFile::create(&path).unwrap();
        file.write_all(b"ne").unwrap();
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 2);
        drop(file);
        assert_eq!(fs::read(&path).unwrap(), b"old");
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
    }

    #[test]
    fn a_committed_file_replaces_the_old_one() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.gif");
        write(&path, b"a longer old file").unwrap();
        write(&path, b"new").unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"new");
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
    }

    #[test]
    fn a_folder_is_never_replaced_and_a_path_without_a_name_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        let taken = folder.path().join("taken");
        fs::create_dir_all(taken.join("inside")).unwrap();
        assert!(write(&taken, b"new").is_err());
        assert!(taken.join("inside").is_dir());
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
        assert_eq!(write(Path::new("/"), b"new").unwrap_err().kind(), io::ErrorKind::InvalidInput);
    }

    #[cfg(unix)]
    #[test]
    fn the_target_of_a_link_is_replaced_and_the_link_stays() {
        use std::os::unix::fs::symlink;
        let folder = tempfile::tempdir().unwrap();
        let [target, link, second] = ["far/a.gif", "link", "second"].map(|name| folder.path().join(name));
        fs::create_dir(folder.path().join("far")).unwrap();
        symlink("far/a.gif", &link).unwrap();
        symlink(&link, &second).unwrap();
        for (path, bytes) in [(&link, b"new"), (&second, b"two")] {
            // At first the target does not exist.
            write(path, bytes).unwrap();
            assert_eq!(fs::read(&target).unwrap(), bytes);
            assert!(path.is_symlink() && !target.is_symlink());
        }
        symlink("round", folder.path().join("round")).unwrap();
        assert!(write(&folder.path().join("round/a"), b"new").is_err());
    }

    #[cfg(unix)]
    #[test]
    fn the_permissions_are_those_of_any_new_file() {
        use std::os::unix::fs::PermissionsExt;
        let folder = tempfile::tempdir().unwrap();
        let [plain, atomic] = ["plain", "atomic"].map(|name| folder.path().join(name));
        fs::write(&plain, b"a").unwrap();
        write(&atomic, b"a").unwrap();
        let mode = |path: &Path| fs::metadata(path).unwrap().permissions().mode();
        assert_eq!(mode(&atomic), mode(&plain));
    }

    #[test]
    fn a_missing_folder_is_an_error() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("missing").join("a.png");
        assert_eq!(AtomicFile::create(path).unwrap_err().kind(), io::ErrorKind::NotFound);
    }
}
