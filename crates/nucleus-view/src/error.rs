//! Errors of pictures and of the player.

use std::io;
use std::path::PathBuf;

use nucleus_cache::ReadError;

/// An error of a picture or of the player.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ViewError {
    /// The cache could not be opened for reading.
    #[error("cannot read `{}`", path.display())]
    Open {
        /// The cache.
        path: PathBuf,
        /// The error of the system.
        source: io::Error,
    },
    /// The server could not start, most often because the port is taken.
    #[error("cannot listen on port {port}; `--port 0` takes a free one")]
    Listen {
        /// The requested port.
        port: u16,
        /// The error of the system.
        source: io::Error,
    },
    /// The file could not be created or replaced.
    #[error("cannot write `{}`", path.display())]
    Create {
        /// The file.
        path: PathBuf,
        /// The error of the system.
        source: io::Error,
    },
    /// The picture could not be encoded or written.
    #[error("cannot write the picture `{}`", path.display())]
    Encode {
        /// The file.
        path: PathBuf,
        /// The error of the encoder.
        source: png::EncodingError,
    },
    /// The EXR picture could not be encoded.
    #[error("cannot write the picture `{}`", path.display())]
    Exr {
        /// The file.
        path: PathBuf,
        /// The error of the encoder.
        source: exr::error::Error,
    },
    /// An EXR picture needs linear colours, which the style did not ask for.
    #[error("`{}` needs a picture with linear colours", path.display())]
    NoLinearColours {
        /// The file.
        path: PathBuf,
    },
    /// The GIF could not be encoded or written.
    #[error("cannot write the film `{}`", path.display())]
    Gif {
        /// The file.
        path: PathBuf,
        /// The error of the encoder.
        source: gif::EncodingError,
    },
    /// A frame of an animation has another size than the file.
    #[error("`{}` has frames of {}x{}, not {}x{}", path.display(), expected[0], expected[1], found[0], found[1])]
    FrameSize {
        /// The animation.
        path: PathBuf,
        /// Width and height of the file, in pixels.
        expected: [u32; 2],
        /// Width and height of the frame, in pixels.
        found: [u32; 2],
    },
    /// A frame of the cache cannot be read.
    #[error("cannot read the cache")]
    Read {
        /// The error of the cache.
        source: ReadError,
    },
    /// The cache holds none of the requested frames.
    #[error("the cache holds none of these frames")]
    NoRecordedFrame,
    /// An animation was finished without a frame.
    #[error("`{}` has no frame", path.display())]
    NoFrame {
        /// The animation.
        path: PathBuf,
    },
}

impl ViewError {
    /// Whether a frame of the cache is damaged or lost, which does not concern the other frames.
    pub(crate) fn is_damage(&self) -> bool {
        let Self::Read { source } = self else { return false };
        !matches!(source, ReadError::Io(_))
    }

    /// A PNG that could not be encoded or written. An error of the system becomes the source, which the encoder's error
    /// does not name.
    pub(crate) fn encode(path: impl Into<PathBuf>, source: png::EncodingError) -> Self {
        let path = path.into();
        match source {
            png::EncodingError::IoError(source) => Self::Create { path, source },
            source => Self::Encode { path, source },
        }
    }
}
