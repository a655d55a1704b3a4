//! Why a cache cannot be exported.

use std::io;
use std::path::PathBuf;

use nucleus_cache::{ReadError, RecordError};

/// Why a cache cannot be exported.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ExportError {
    /// The destination exists.
    #[error("`{}` exists; `--force` replaces it", path.display())]
    Exists {
        /// The existing file or folder.
        path: PathBuf,
    },
    /// A file or folder cannot be written.
    #[error("cannot write `{}`", path.display())]
    Write {
        /// The file or folder.
        path: PathBuf,
        /// The error of the system.
        source: io::Error,
    },
    /// A frame of the cache cannot be read.
    #[error("cannot read the cache")]
    Read(#[from] ReadError),
    /// The MCAP file for other viewers cannot be written.
    #[error("cannot write the MCAP file for other viewers")]
    Record(#[from] RecordError),
    /// The cache has no object of this name.
    #[error("the cache has no object `{name}`; it has {}", known.join(", "))]
    NoObject {
        /// The requested name.
        name: String,
        /// The names in the cache, in backquotes.
        known: Vec<String>,
    },
    /// No recorded frame lies in the requested range.
    #[error("no recorded frame lies between {first} and {last}; the cache has {} to {}", has.0, has.1)]
    NoFrame {
        /// First requested frame.
        first: i32,
        /// Last requested frame.
        last: i32,
        /// First and last frame of the cache.
        has: (i32, i32),
    },
    /// The cache has no frame.
    #[error("the cache holds no frame")]
    Empty,
    /// Positions that other tools cannot read.
    #[error("{points} points of `{object}` are not finite at frame {frame}; export the frames before it")]
    NotFinite {
        /// The object.
        object: String,
        /// The frame.
        frame: i32,
        /// The number of points with such a coordinate.
        points: usize,
    },
    /// The topology changes, and the format stores it once.
    #[error(
        "the topology of `{object}` changes at frame {frame}, and {format} stores one topology; export the frames before \
         it, or write obj, ply, vtu, usda or foxglove"
    )]
    MeshChanges {
        /// The object.
        object: String,
        /// The frame.
        frame: i32,
        /// The format.
        format: &'static str,
    },
    /// Samples at uneven times, and the format states one rate.
    #[error(
        "the samples up to frame {frame} are not evenly spaced in time, and {format} states one rate; select frames with \
         `--frames` and `--every`, or write mdd, which stores the time of each sample"
    )]
    Uneven {
        /// The frame of the first sample that is not where the rate puts it.
        frame: i32,
        /// The format.
        format: &'static str,
    },
    /// Surfaces of liquids change their topology from frame to frame.
    #[error("{format} cannot hold surfaces of liquids; write obj or ply")]
    NoSurface {
        /// The format.
        format: &'static str,
    },
    /// A frame whose time the format cannot state.
    #[error(
        "frame {frame} is beyond {largest}, the largest that {format} can state at {frames_per_second} frames per second; \
         export frames from -{largest} to {largest}, or write usda"
    )]
    FrameTooLarge {
        /// The first such frame.
        frame: i32,
        /// The largest frame, which is also that of the largest negative number.
        largest: i32,
        /// Frames per second of the run.
        frames_per_second: f64,
        /// The format.
        format: &'static str,
    },
    /// Another unit of length is wanted, and the format is in metres.
    #[error("{format} is in metres by its specification, so a scale has no effect; write usda, usdc or obj")]
    FixedUnit {
        /// The format.
        format: &'static str,
    },
    /// A quantity exceeds the limit of the format.
    #[error("{quantity} is more than {format} can hold; export fewer frames, or write usda")]
    TooLarge {
        /// The format.
        format: &'static str,
        /// The quantity, with its unit.
        quantity: String,
    },
}
