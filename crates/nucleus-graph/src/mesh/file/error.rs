//! Errors of reading a PLY, glTF or USD file.

use std::io;
use std::path::{Path, PathBuf};

/// Reasons why a file is no mesh.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum MeshFileError {
    /// It, or a file that it refers to, cannot be read.
    #[error("cannot read `{}`: {source}", path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// The error of the system.
        source: io::Error,
    },
    /// It contradicts its format, or holds no mesh.
    #[error("`{}`: {fault}", path.display())]
    Malformed {
        /// The file.
        path: PathBuf,
        /// What is wrong, and where; never the content of the file.
        fault: String,
    },
}

/// A fault of a file whose path the caller knows.
#[derive(Debug)]
pub(super) enum Fault {
    /// It cannot be read.
    Io(io::Error),
    /// A file beside it cannot be read.
    Beside(PathBuf, io::Error),
    /// It is malformed.
    Malformed(String),
}

impl Fault {
    pub(super) fn in_file(self, path: &Path) -> MeshFileError {
        match self {
            Self::Io(source) => MeshFileError::Unreadable { path: path.to_owned(), source },
            Self::Beside(path, source) => MeshFileError::Unreadable { path, source },
            Self::Malformed(fault) => MeshFileError::Malformed { path: path.to_owned(), fault },
        }
    }
}

impl From<&str> for Fault {
    fn from(fault: &str) -> Self {
        Self::Malformed(fault.to_owned())
    }
}
