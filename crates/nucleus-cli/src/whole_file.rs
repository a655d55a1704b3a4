//! Files that have their name only when they are whole.

use std::ffi::OsString;
use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result};

/// Has `write` make the file under its name with `.part` behind it, and names it when that is done. What has failed
/// leaves nothing.
pub fn write<T>(path: &Path, write: impl FnOnce(&Path) -> Result<T>) -> Result<T> {
    let part = part_of(path);
    let done = write(&part).and_then(|done| {
        fs::rename(&part, path).with_context(|| format!("cannot write `{}`", path.display()))?;
        Ok(done)
    });
    if done.is_err() {
        // It may never have been made; what went wrong is told either way.
        fs::remove_file(&part).ok();
    }
    done
}

fn part_of(path: &Path) -> PathBuf {
    let mut name = OsString::from(path);
    name.push(".part");
    name.into()
}

#[cfg(test)]
mod tests {
    use anyhow::bail;

    use super::*;

    #[test]
    fn a_file_that_fails_half_way_leaves_what_was_there() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.gif");
        write(&path, |part| Ok(fs::write(part, "old")?)).unwrap();
        let failed = write::<()>(&path, |part| {
            fs::write(part, "ne")?;
            bail!("the disk is full")
        });
        assert!(failed.is_err());
        assert_eq!(fs::read_to_string(&path).unwrap(), "old");
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
    }
}
