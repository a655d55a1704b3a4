//! Why a cache cannot be exported.

use std::io;
use std::path::PathBuf;

use nucleus_cache::{ReadError, RecordError};

/// Why a cache cannot be exported.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ExportError {
    /// Something stands where a file is to be written.
    #[error("`{}` exists; `--force` replaces it", path.display())]
    Exists {
        /// What is in the way.
        path: PathBuf,
    },
    /// A file or folder cannot be written.
    #[error("cannot write `{}`", path.display())]
    Write {
        /// The file or folder.
        path: PathBuf,
        /// What the system says.
        source: io::Error,
    },
    /// A frame of the cache cannot be read.
    #[error("cannot read the cache")]
    Read(#[from] ReadError),
    /// The cache that is written for other viewers cannot be recorded.
    #[error("cannot write the file for other viewers")]
    Record(#[from] RecordError),
    /// No object of that name.
    #[error("the cache has no object `{name}`; it has {}", known.join(", "))]
    NoObject {
        /// The name that was asked for.
        name: String,
        /// The names that there are, in backquotes.
        known: Vec<String>,
    },
    /// No recorded frame lies in the range that was asked for.
    #[error("no recorded frame lies between {first} and {last}; the cache has {} to {}", has.0, has.1)]
    NoFrame {
        /// First frame that was asked for.
        first: i32,
        /// Last frame that was asked for.
        last: i32,
        /// First and last frame of the cache.
        has: (i32, i32),
    },
    /// The cache holds nothing.
    #[error("the cache holds no frame")]
    Empty,
    /// Positions that no other tool takes.
    #[error("{points} points of `{object}` are not finite at frame {frame}; export the frames before it")]
    NotFinite {
        /// The object.
        object: String,
        /// The frame.
        frame: i32,
        /// How many points.
        points: usize,
    },
    /// A mesh that changes, in a format that has one for all time.
    #[error(
        "`{object}` gets another mesh at frame {frame}, and {format} has one for all time; export the frames before it, or \
         write obj, ply, vtu, usda or foxglove"
    )]
    MeshChanges {
        /// The object.
        object: String,
        /// The frame.
        frame: i32,
        /// The format.
        format: &'static str,
    },
    /// More than the format can count.
    #[error("{what} is more than {format} can hold; export fewer frames, or write usda")]
    TooLarge {
        /// The format.
        format: &'static str,
        /// What there is too much of.
        what: String,
    },
}
