//! Why a file cannot be opened as a cache, or a frame of it not read.

use std::io;
use std::path::PathBuf;

/// Why a file cannot be opened as a cache.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum OpenError {
    /// The system does not let us read it.
    #[error("cannot read `{}`", path.display())]
    Io {
        /// The file.
        path: PathBuf,
        /// What the system says.
        source: io::Error,
    },
    /// Reading stopped half-way.
    #[error("reading failed")]
    Read(#[from] io::Error),
    /// It is a folder.
    #[error("`{}` is a folder, not a cache", path.display())]
    Folder {
        /// The folder.
        path: PathBuf,
    },
    /// A run is writing it.
    #[error("`{}` is being written by another run", path.display())]
    InUse {
        /// The file.
        path: PathBuf,
    },
    /// It holds nothing.
    #[error("the file is empty: the run that made it wrote nothing")]
    Empty,
    /// It is no MCAP file.
    #[error("this is not an MCAP file")]
    NotMcap,
    /// It ends within its first few bytes.
    #[error("the file ends before its first frame: nothing can be recovered")]
    TooShort,
    /// It is an MCAP file of another tool.
    #[error("this MCAP file was not written by nucleus (profile `{profile}`, written by `{library}`)")]
    OtherTool {
        /// The profile it names.
        profile: String,
        /// The library that wrote it.
        library: String,
    },
    /// It is of a later version.
    #[error("this cache has layout {format}, written by nucleus {version}; this nucleus reads up to {known}")]
    Newer {
        /// The layout of the file.
        format: u32,
        /// The version that wrote it.
        version: String,
        /// The highest layout known here.
        known: u32,
    },
    /// A record about the run is missing.
    #[error("the record `{name}` is missing or damaged, so the run cannot be read")]
    NoRecord {
        /// Its name.
        name: &'static str,
    },
    /// A value about the run makes no sense.
    #[error("the run's `{key}` cannot be `{value}`")]
    BadValue {
        /// Its key.
        key: &'static str,
        /// What the file says.
        value: String,
    },
    /// The meshes cannot be read.
    #[error("the mesh of {object} is damaged, and without it no frame can be shown")]
    Topology {
        /// The object, in backquotes, or all of them.
        object: String,
    },
}

impl From<ReadError> for OpenError {
    fn from(error: ReadError) -> Self {
        match error {
            ReadError::Io(error) => Self::Read(error),
            other => Self::Read(io::Error::other(other)),
        }
    }
}

/// Why a frame cannot be read from an open cache.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ReadError {
    /// The checksum or the content of the frame is wrong.
    #[error("frame {frame} is damaged and cannot be read")]
    Damaged {
        /// The frame.
        frame: i32,
    },
    /// There is no object of this number.
    #[error("there is no object {object}; the cache holds {objects}")]
    NoObject {
        /// What was asked for.
        object: usize,
        /// How many there are.
        objects: usize,
    },
    /// There is no moment of this number.
    #[error("there is no moment {moment}; the cache holds {moments}")]
    NoMoment {
        /// What was asked for.
        moment: usize,
        /// How many there are.
        moments: usize,
    },
    /// The mesh that an object has at this moment was in a frame that is damaged or missing.
    #[error("the mesh that `{object}` has at frame {frame} is lost with an earlier frame")]
    MeshLost {
        /// The object.
        object: String,
        /// The frame.
        frame: i32,
    },
    /// The object has no positions at or before this moment.
    #[error("`{object}` has no positions at frame {frame}")]
    Nothing {
        /// The object.
        object: String,
        /// The frame.
        frame: i32,
    },
    /// The system failed to read.
    #[error("reading failed")]
    Io(#[from] io::Error),
}
