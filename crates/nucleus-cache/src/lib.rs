//! A run as one MCAP file: recorded while it is simulated, found again frame by frame.
//!
//! | You want to know…                                   | Read                                |
//! |-----------------------------------------------------|-------------------------------------|
//! | how a run is written, and what a full disk does     | [`Recorder`]                        |
//! | how a frame is found and read back                  | [`Playback`]                        |
//! | what a killed run or a flipped byte costs           | [`Loss`]                            |
//! | what is known of the run: scene, frames, units      | [`RunInfo`]                         |
//! | the bytes of a message                              | `points.rs` and `topology.rs`       |
//! | how one frame is kept from harming another          | `stream.rs`, `chunk.rs`             |
//! | why floats are stored byte by byte                  | `shuffle.rs`                        |
//!
//! Each frame is one compressed chunk with a checksum, closed and handed to the system before the next
//! begins. A run that is killed loses the frame in flight and nothing else.
//!
//! **Invariant:** this crate knows no scene and no node; a cache opens without them. Same run, same bytes.
//!
//! ```no_run
//! let mut cache = nucleus_cache::Playback::open("hang.mcap")?;
//! let last = cache.moments().len() - 1;
//! for object in 0..cache.objects().len() {
//!     let points = cache.positions(object, last)?;
//!     println!("{}: {:?}", cache.objects()[object].name, points[0]);
//! }
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod chunk;
mod contents;
mod loss;
mod moment;
mod object;
mod open_error;
mod playback;
mod points;
mod provenance;
mod record_error;
mod recorder;
mod run;
mod salvage;
mod shuffle;
mod stream;
mod summary;
mod tally;
mod target;
mod topic_file;
mod topology;

pub use loss::Loss;
pub use moment::RecordedMoment;
pub use object::{ObjectInfo, ObjectKind, Source};
pub use open_error::{OpenError, ReadError};
pub use playback::Playback;
pub use record_error::RecordError;
pub use recorder::{FrameRecorder, Recorded, Recorder};
pub use run::{Detail, RunInfo};
pub use topic_file::TopicFile;
