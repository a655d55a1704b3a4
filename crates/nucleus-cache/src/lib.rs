//! A run as one MCAP file: recorded while it is simulated, found again frame by frame.
//!
//! | You want to know…                                   | Read                                |
//! |-----------------------------------------------------|-------------------------------------|
//! | how a run is written, and what a full disk does     | [`Recorder`]                        |
//! | how a frame is found and read back                  | [`Playback`]                        |
//! | what a killed run or a flipped byte costs           | [`Loss`]                            |
//! | where two runs differ first                         | [`compare`]                         |
//! | how the start of a file survives damage            | `copies.rs`                         |
//! | how an object gets another mesh on the way          | [`FrameRecorder::change_mesh`], [`Playback::object_at`] |
//! | how a damaged file becomes a sound one              | [`Playback::recover`]               |
//! | how a run goes on from its cache                    | [`Recorder::resume`]                |
//! | what is known of the run: scene, frames, units      | [`RunInfo`]                         |
//! | the bytes of a message                              | `points.rs`, `attribute.rs`, `topology.rs` |
//! | how one frame is kept from harming another          | `stream.rs`, `chunk.rs`             |
//! | why floats are stored byte by byte                  | `shuffle.rs`                        |
//!
//! Each frame is one compressed chunk with a checksum, closed and handed to the system before the next
//! begins. A run that is killed loses the frame in flight and nothing else, and a damaged chunk costs its own frame:
//! what holds beyond a frame (the run, meshes, colliders that stand still) has a copy behind the next.
//!
//! **Invariant:** this crate knows no scene and no node; a cache opens without them. Same run, same bytes.
//!
//! A cache in a few lines:
//!
//! ```
//! # use nucleus_cache::{ObjectInfo, ObjectKind, Recorder, RunInfo, Source};
//! # use nucleus_core::{Cloth, ClothLists, Faces, Mass, ModelBuilder, Solver, Surface};
//! # let folder = tempfile::tempdir()?;
//! # std::env::set_current_dir(&folder)?;
//! # let faces = Faces::from_iter([&[0_u32, 1, 2][..]]);
//! # let rest = vec![[0.0, 1.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 1.0]];
//! # let positions = rest.iter().map(|&p: &[f32; 3]| nalgebra::Vector3::from(p.map(f64::from))).collect();
//! # let surface = Surface { positions, faces: faces.clone() };
//! # let mut builder = ModelBuilder::new();
//! # let cloth = builder.cloth(Cloth::new(surface, Mass::PerPoint(1.0), ClothLists::NONE))?;
//! # let object = ObjectInfo { name: "sheet".to_owned(), kind: ObjectKind::Cloth, faces, rest };
//! # let mut recorder = Recorder::create("hang.mcap", &RunInfo::default(), vec![(Source::Cloth(cloth), object)])?;
//! # recorder.record_start(&Solver::<f32>::new(builder, 1))?;
//! # recorder.finish()?;
//! let mut cache = nucleus_cache::Playback::open("hang.mcap")?;
//! let last = cache.moments().len() - 1;
//! for object in 0..cache.objects().len() {
//!     let first = cache.positions(object, last)?[0];
//!     println!("{}: {first:?}", cache.objects()[object].name);
//! }
//! # assert_eq!(cache.positions(0, last)?[1], [1.0, 1.0, 0.0]);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

pub mod atomic_file;
mod attribute;
mod camera;
mod checkpoint;
mod chunk;
mod contents;
mod copies;
mod diff;
mod infer;
mod loss;
mod mesh;
mod moment;
mod object;
mod open_error;
mod playback;
mod points;
mod provenance;
mod record_error;
mod recorder;
mod recover;
mod resume;
mod run;
mod salvage;
mod shuffle;
mod strain;
mod stream;
mod summary;
mod tally;
mod target;
mod topic_file;
mod topology;
mod witness;

pub use camera::{Camera, CameraView, FilmFit};
pub use checkpoint::Checkpoint;
pub use diff::{Comparison, Difference, PointDifference, compare};
pub use loss::Loss;
pub use moment::RecordedMoment;
pub use object::{ObjectInfo, ObjectKind, Source};
pub use open_error::{OpenError, ReadError};
pub use playback::{Playback, Sizes};
pub use record_error::RecordError;
pub use recorder::{FrameRecorder, Recorded, Recorder};
pub use recover::{RecoverError, Recovered};
pub use resume::Kept;
pub use run::{Detail, Packing, Plane, RunInfo};
pub use target::unfinished;
pub use topic_file::TopicFile;
