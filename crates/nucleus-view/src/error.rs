//! What can go wrong on the way to a picture or a page.

use std::io;
use std::path::PathBuf;

use nucleus_cache::ReadError;

/// Why a picture could not be written or a cache not be shown.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ViewError {
    /// The cache could not be opened for reading.
    #[error("cannot read `{}`", path.display())]
    Open {
        /// The cache.
        path: PathBuf,
        /// What the system said.
        source: io::Error,
    },
    /// The player could not be served, most often because the port is taken.
    #[error("cannot listen on port {port}")]
    Listen {
        /// The port that was asked for.
        port: u16,
        /// What the system said.
        source: io::Error,
    },
    /// The file could not be opened for writing.
    #[error("cannot write `{}`", path.display())]
    Create {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: io::Error,
    },
    /// The picture could not be encoded or its bytes not be written.
    #[error("cannot write the picture `{}`", path.display())]
    Encode {
        /// The file.
        path: PathBuf,
        /// What the encoder said.
        source: png::EncodingError,
    },
    /// The film could not be encoded or its bytes not be written.
    #[error("cannot write the film `{}`", path.display())]
    Gif {
        /// The file.
        path: PathBuf,
        /// What the encoder said.
        source: gif::EncodingError,
    },
    /// A frame of an animation has not the size of the others.
    #[error("`{}` has frames of {}x{}, not {}x{}", path.display(), expected[0], expected[1], found[0], found[1])]
    FrameSize {
        /// The animation.
        path: PathBuf,
        /// Width and height the animation was created with, in pixels.
        expected: [u32; 2],
        /// Width and height of the frame, in pixels.
        found: [u32; 2],
    },
    /// A frame of the cache cannot be read.
    #[error("cannot read the cache")]
    Read {
        /// What is wrong with it.
        source: ReadError,
    },
    /// The cache holds no frame.
    #[error("the cache holds no frame")]
    NoMoment,
    /// An animation without frames is not a picture.
    #[error("`{}` has no frame", path.display())]
    NoFrame {
        /// The animation.
        path: PathBuf,
    },
}
