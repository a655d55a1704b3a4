//! Records a simulation run as one MCAP file, and reads it back by frame.
//!
//! | You want to know…                                  | Read                                      |
//! |----------------------------------------------------|-------------------------------------------|
//! | how a run is recorded, and what a full disk does   | [`Recorder`]                              |
//! | how a frame is read                                | [`Playback`]                              |
//! | what a killed run or a flipped byte costs          | [`CorruptionReport`]                      |
//! | where two runs differ first                        | [`compare`]                               |
//! | how metadata survives a damaged start of the file  | `container/redundant_copies.rs`           |
//! | how the mesh of an object changes                  | [`FrameRecorder::change_mesh`], [`Playback::object_at`] |
//! | how a damaged file is recovered                    | [`Playback::recover`]                     |
//! | how a run is resumed from its cache                | [`Recorder::resume`]                      |
//! | the surface of particles as a mesh                 | [`LiquidSurface`]                         |
//! | the metadata of a run: scene, frames, units        | [`RunInfo`]                               |
//! | the bytes of a message                             | `messages/`                               |
//! | how chunks isolate frames from each other          | `container/writer.rs`, `container/chunk.rs` |
//! | why floats are stored in byte planes               | `messages/byte_shuffle.rs`                |
//!
//! ```text
//! messages ─▶ container ─▶ read ─▶ write
//! ```
//!
//! Each frame is one compressed chunk with a checksum. The recorder closes the chunk and hands it to the system before
//! the next frame begins. A killed run loses only the frame in flight. A damaged chunk costs only its own frame: the
//! run metadata, meshes and positions of resting colliders, which hold for later frames, have a redundant copy behind
//! the next frame.
//!
//! **Invariant:** this crate knows no scene and no node; a cache opens without its scene. The same run gives the same
//! bytes.
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
//! let last = cache.time_samples().len() - 1;
//! for object in 0..cache.objects().len() {
//!     let first = cache.positions(object, last)?[0];
//!     println!("{}: {first:?}", cache.objects()[object].name);
//! }
//! # assert_eq!(cache.positions(0, last)?[1], [1.0, 1.0, 0.0]);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

#![forbid(unsafe_code)]

pub mod atomic_file;
mod camera;
mod container;
mod corruption;
mod error;
mod face_sets;
mod liquid_surface;
mod messages;
mod read;
mod run;
mod selections;
mod shell;
mod texture_coordinates;
mod write;

pub use camera::{Camera, CameraView, FilmFit};
pub use container::part_file::part_path;
pub use corruption::{CorruptionReport, frame_ranges};
pub use error::{OpenError, ReadError, RecordError};
pub use face_sets::{FaceSet, FaceSets};
pub use liquid_surface::LiquidSurface;
pub use messages::checkpoint::Checkpoint;
pub use read::diff::{Comparison, Difference, PointDifference, compare};
pub use read::playback::{Playback, Sizes};
pub use read::recover::{RecoverError, Recovered};
pub use read::time_index::TimeSample;
pub use run::{COS_HARD_EDGE, Detail, ObjectInfo, ObjectKind, Packing, Plane, RunInfo, Source, SurfaceShape};
pub use selections::SelectedPoints;
pub use shell::shell_word;
pub use texture_coordinates::TextureCoordinates;
pub use write::frame_recorder::FrameRecorder;
pub use write::recorder::{Recorded, Recorder};
pub use write::resume::ResumeRange;
pub use write::topic_file::TopicFile;
