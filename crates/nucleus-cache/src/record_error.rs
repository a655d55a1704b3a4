//! Why a run cannot be recorded, or no further.

use std::io;
use std::path::PathBuf;

use mcap::McapError;

/// Why a run cannot be recorded, or no further.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum RecordError {
    /// A cache would replace a file that is none.
    #[error("`{}` exists and is not a nucleus cache; remove it or choose another name", path.display())]
    NotOurs {
        /// The file in the way.
        path: PathBuf,
    },
    /// A cache would replace another.
    #[error("`{}` exists; `--force` replaces it, `-o` names another file", path.display())]
    Exists {
        /// The cache in the way.
        path: PathBuf,
    },
    /// A run that was killed has left its cache behind.
    #[error(
        "`{0}` is left of a run that was killed; `nucleus recover {0}` saves its frames, `--force` replaces it",
        path.display()
    )]
    Unfinished {
        /// What it has left behind.
        path: PathBuf,
    },
    /// Another run is writing this cache.
    #[error("`{}` is being written by another run", path.display())]
    InUse {
        /// The file it writes.
        path: PathBuf,
    },
    /// A cache would replace a folder or a device.
    #[error("`{}` is not a file; give the name of a file to write", path.display())]
    NotAFile {
        /// What is in the way.
        path: PathBuf,
    },
    /// The file cannot be made.
    #[error("cannot write `{}`", path.display())]
    Create {
        /// The file.
        path: PathBuf,
        /// What the system says.
        source: io::Error,
    },
    /// The description of the run contradicts itself.
    #[error("nothing can be recorded: {fault}")]
    BadRun {
        /// What is wrong with it.
        fault: String,
    },
    /// Two objects have the same name.
    #[error("two objects are named `{name}`")]
    DuplicateName {
        /// The name.
        name: String,
    },
    /// There is no object whose mesh could change.
    #[error("there is no object `{name}` whose mesh could change")]
    NoObject {
        /// The name.
        name: String,
    },
    /// A face names a point that is not there.
    #[error("a face of `{object}` names a point that is not there")]
    BadMesh {
        /// The object.
        object: String,
    },
    /// An object has another number of points than it was announced with.
    #[error("`{object}` has {found} points in the solver but was announced with {expected}")]
    PointCount {
        /// The object.
        object: String,
        /// Points announced.
        expected: usize,
        /// Points in the solver.
        found: usize,
    },
    /// A frame that is solved again is not what was recorded before.
    #[error("frame {frame} does not come out as it was recorded: `{object}` is elsewhere")]
    Differs {
        /// The frame.
        frame: i32,
        /// The first object that differs.
        object: String,
    },
    /// A run that goes on was ended before it had come as far as the cache that it goes on from.
    #[error(
        "ended at frame {frame}, before frame {until}, up to which the cache is kept: it is left as it was"
    )]
    NotCaughtUp {
        /// The last frame that was solved.
        frame: i32,
        /// The frame up to which the older cache is kept.
        until: i32,
    },
    /// The cache that a run goes on from cannot be read.
    #[error("the cache to go on from cannot be read")]
    Original {
        /// Why not.
        source: crate::open_error::ReadError,
    },
    /// Frames must come in order, after the start frame.
    #[error("frame {frame} cannot follow frame {last}")]
    FrameOrder {
        /// The frame that was to be recorded.
        frame: i32,
        /// The last one recorded.
        last: i32,
    },
    /// The report of a frame has no JSON form.
    #[error("the report of frame {frame} cannot be written as JSON")]
    Report {
        /// The frame.
        frame: i32,
        /// Why not.
        source: serde_json::Error,
    },
    /// Writing a file for other viewers failed.
    #[error("writing failed")]
    Export {
        /// What the system says.
        source: io::Error,
    },
    /// Writing failed on the way: a full disk, most likely.
    #[error("writing the cache failed; {frames} frames ({bytes} bytes) were written and can be played")]
    Write {
        /// Whole frames in the file, the initial state among them.
        frames: u32,
        /// Bytes handed to the system.
        bytes: u64,
        /// What the system says.
        source: io::Error,
    },
}

/// The cause of a failed write: what the system said, where it said anything.
pub(crate) fn cause(error: McapError) -> io::Error {
    match error {
        McapError::Io(error) => error,
        other => io::Error::other(other),
    }
}
