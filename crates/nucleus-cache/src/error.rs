//! Errors of opening, reading and recording a cache.

use std::io;
use std::path::PathBuf;

use mcap::McapError;

/// Why a file cannot be opened as a cache.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum OpenError {
    /// The system denies reading.
    #[error("cannot read `{}`", path.display())]
    Io {
        /// The file.
        path: PathBuf,
        /// The system's error.
        source: io::Error,
    },
    /// Reading failed part-way.
    #[error("reading failed")]
    Read(#[from] io::Error),
    /// The path names a folder.
    #[error("`{}` is a folder, not a cache", path.display())]
    Folder {
        /// The folder.
        path: PathBuf,
    },
    /// The path names a pipe, a socket or a device.
    #[error("`{}` is not a regular file: a cache is read from a disk", path.display())]
    NotAFile {
        /// The path.
        path: PathBuf,
    },
    /// Another run writes the file.
    #[error("`{}` is being written by another run", path.display())]
    InUse {
        /// The file.
        path: PathBuf,
    },
    /// The file has no bytes.
    #[error("the file is empty: the run that made it wrote nothing")]
    Empty,
    /// The file is no MCAP file.
    #[error("this is not an MCAP file")]
    NotMcap,
    /// The file ends within its first bytes.
    #[error("the file ends before its first frame: nothing can be recovered")]
    TooShort,
    /// Another tool wrote the MCAP file.
    #[error("this MCAP file was not written by nucleus (profile `{profile}`, written by `{library}`)")]
    OtherTool {
        /// Its MCAP profile.
        profile: String,
        /// The library that wrote it.
        library: String,
    },
    /// A later version of Nucleus wrote the cache.
    #[error("this cache has layout {format}, written by nucleus {version}; this nucleus reads up to {known}")]
    Newer {
        /// Format version of the file.
        format: u32,
        /// The version of Nucleus that wrote it.
        version: String,
        /// The latest format version that this reader knows.
        known: u32,
    },
    /// A metadata record of the run is missing.
    #[error("the record `{name}` is missing or damaged, so the run cannot be read")]
    NoRecord {
        /// Name of the record.
        name: &'static str,
    },
    /// A metadata value of the run is invalid.
    #[error("the run's `{key}` cannot be `{value}`")]
    BadValue {
        /// Key of the value.
        key: &'static str,
        /// The value in the file.
        value: String,
    },
    /// The meshes cannot be read.
    #[error("the mesh of {object} is damaged, and without it no frame can be shown")]
    Topology {
        /// The object in backquotes, or "every object".
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
    /// The checksum or the contents of the frame are wrong.
    #[error("frame {frame} is damaged and cannot be read")]
    Damaged {
        /// The frame.
        frame: i32,
    },
    /// No object has this index.
    #[error("there is no object {object}; the cache holds {objects}")]
    NoObject {
        /// The requested index.
        object: usize,
        /// Number of objects.
        objects: usize,
    },
    /// No time sample has this index.
    #[error("there is no time sample {sample}; the cache holds {time_samples}")]
    NoTimeSample {
        /// The requested index.
        sample: usize,
        /// Number of time samples.
        time_samples: usize,
    },
    /// The object's mesh at this sample was in a frame that is damaged or missing.
    #[error("the mesh that `{object}` has at frame {frame} is lost with an earlier frame")]
    MeshLost {
        /// The object.
        object: String,
        /// The frame.
        frame: i32,
    },
    /// The object has no positions at or before this sample.
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

/// Why a run cannot be recorded.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum RecordError {
    /// The target is a file that is no cache.
    #[error("`{}` exists and is not a nucleus cache; remove it or choose another name", path.display())]
    NotOurs {
        /// The existing file.
        path: PathBuf,
    },
    /// The target is an existing cache.
    #[error("`{}` exists; `Recorder::replace` replaces it", path.display())]
    Exists {
        /// The existing cache.
        path: PathBuf,
    },
    /// A killed run has left a partial cache.
    #[error(
        "`{}` is left of a run that was killed; `Playback::recover` saves its frames, `Recorder::replace` replaces it",
        path.display()
    )]
    Unfinished {
        /// The partial cache.
        path: PathBuf,
    },
    /// Another run is writing this cache.
    #[error("`{}` is being written by another run", path.display())]
    InUse {
        /// The file it writes.
        path: PathBuf,
    },
    /// The target is a folder or a device.
    #[error("`{}` is not a file; give the name of a file to write", path.display())]
    NotAFile {
        /// The existing folder or device.
        path: PathBuf,
    },
    /// The file cannot be created.
    #[error("cannot write `{}`", path.display())]
    Create {
        /// The file.
        path: PathBuf,
        /// The system's error.
        source: io::Error,
    },
    /// The description of the run contradicts itself.
    #[error("nothing can be recorded: {fault}")]
    BadRun {
        /// The contradiction.
        fault: String,
    },
    /// Two objects have the same name.
    #[error("two objects are named `{name}`")]
    DuplicateName {
        /// The name.
        name: String,
    },
    /// A mesh change names an unknown object.
    #[error("there is no object `{name}` whose mesh could change")]
    NoObject {
        /// The name.
        name: String,
    },
    /// The solver lacks a cloth or a collider that is to be recorded.
    #[error("`{object}` is to be recorded, but the solver has no such cloth or collider")]
    NoSource {
        /// The object.
        object: String,
    },
    /// A face refers to a point that does not exist.
    #[error("a face of `{object}` names a point that is not there")]
    BadMesh {
        /// The object.
        object: String,
    },
    /// The solver has another number of points than the object was announced with.
    #[error("`{object}` has {found} points in the solver but was announced with {expected}")]
    PointCount {
        /// The object.
        object: String,
        /// Number of announced points.
        expected: usize,
        /// Number of points in the solver.
        found: usize,
    },
    /// A frame that is solved again differs from the recorded one.
    #[error("frame {frame} does not come out as it was recorded: `{object}` is elsewhere")]
    ReplayMismatch {
        /// The frame.
        frame: i32,
        /// The first object that differs.
        object: String,
    },
    /// A resumed run ended before it had replayed all recorded frames.
    #[error(
        "the replay ended at frame {frame}, before frame {until} of the existing cache, which is unchanged"
    )]
    ReplayIncomplete {
        /// The last solved frame.
        frame: i32,
        /// The last frame to replay.
        until: i32,
    },
    /// The cache to resume from cannot be read.
    #[error("the cache to resume from cannot be read")]
    Original {
        /// The cause.
        source: ReadError,
    },
    /// Every frame that the run solves must be recorded, in order, after the start frame.
    #[error("frame {frame} cannot follow frame {last}: frame {expected} is next")]
    FrameOrder {
        /// The frame to be recorded.
        frame: i32,
        /// The last recorded frame.
        last: i32,
        /// The frame after it.
        expected: i32,
    },
    /// The run was announced with an earlier end.
    #[error("frame {frame} cannot be recorded: the run was announced to end at frame {end}")]
    BeyondEnd {
        /// The frame to be recorded.
        frame: i32,
        /// The last frame of the run.
        end: i32,
    },
    /// A frame ended without a step.
    #[error(
        "no step of frame {expected} was recorded before its end: step the solver with `Recorder::frame({expected})`"
    )]
    NotStepped {
        /// The frame that a step was expected of.
        expected: i32,
    },
    /// The report of a frame cannot be represented as JSON.
    #[error("the report of frame {frame} cannot be written as JSON")]
    Report {
        /// The frame.
        frame: i32,
        /// The cause.
        source: serde_json::Error,
    },
    /// Writing a file for other viewers failed.
    #[error("writing failed")]
    Export {
        /// The system's error.
        source: io::Error,
    },
    /// Writing failed part-way, most likely because the disk is full.
    #[error("writing the cache failed; {frames} frames ({bytes} bytes) were written and can be played")]
    Write {
        /// Whole frames in the file, including the initial state.
        frames: u32,
        /// Bytes handed to the system.
        bytes: u64,
        /// The system's error.
        source: io::Error,
    },
}

/// The cause of a failed write: the system's error if there is one.
pub(crate) fn cause(error: McapError) -> io::Error {
    match error {
        McapError::Io(error) => error,
        other => io::Error::other(other),
    }
}
