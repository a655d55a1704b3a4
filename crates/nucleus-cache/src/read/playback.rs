//! Opens a cache and reads its metadata and meshes.

use std::collections::BTreeMap;
use std::fs::File;
use std::io::{BufReader, Read, Seek, SeekFrom};
use std::path::Path;

use crate::container::chunk::Chunk;
use crate::container::index::{FileIndex, rebuild, summary};
use crate::container::part_file;
use crate::corruption::CorruptionReport;
use crate::error::{OpenError, ReadError};
use crate::messages::metadata::PROFILE;
use crate::messages::topology;
use crate::read::time_index::{self, TimeSample};
use crate::run::{ObjectInfo, RunInfo};

/// An open cache.
///
/// A finished file is opened by its index, and only requested frames are read. Any other file is scanned once and
/// opened as far as it is whole; [`corruption`](Self::corruption) reports what is missing.
pub struct Playback<R = BufReader<File>> {
    pub(crate) file: R,
    bytes: u64,
    library: String,
    pub(crate) run: RunInfo,
    pub(crate) file_index: FileIndex,
    pub(crate) corruption: CorruptionReport,
    pub(crate) objects: Vec<ObjectInfo>,
    /// Placeholder names of objects whose names are lost.
    pub(crate) unnamed_objects: Vec<String>,
    pub(crate) points_channels: Vec<u16>,
    pub(crate) mesh_channels: Vec<u16>,
    /// For each object the last requested mesh, if it is not the first.
    pub(crate) meshes: Vec<Option<Mesh>>,
    pub(crate) time_samples: Vec<TimeSample>,
    pub(crate) chunk: Chunk,
    pub(crate) copy: Chunk,
    pub(crate) loaded: Option<usize>,
    pub(crate) loaded_copy: Option<usize>,
}

/// Sizes of a cache by channel.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Sizes {
    /// Uncompressed bytes of all messages of a channel, by topic.
    pub channels: BTreeMap<String, u64>,
    /// Compressed bytes of all frames.
    pub packed: u64,
}

impl Playback {
    /// Opens the cache at `path`.
    ///
    /// # Errors
    /// When it is no cache, or so damaged that no frame can be shown; see [`OpenError`].
    pub fn open(path: impl AsRef<Path>) -> Result<Self, OpenError> {
        Self::read(BufReader::new(file_at(path.as_ref())?))
    }
}

/// Opens the file of a cache.
pub(crate) fn file_at(path: &Path) -> Result<File, OpenError> {
    if path.is_dir() {
        return Err(OpenError::Folder { path: path.to_owned() });
    }
    // To open a pipe would wait for a writer.
    if path.metadata().is_ok_and(|found| !found.is_file()) {
        return Err(OpenError::NotAFile { path: path.to_owned() });
    }
    File::open(path).map_err(|source| OpenError::Io { path: path.to_owned(), source })
}

impl<R: Read + Seek> Playback<R> {
    /// Opens a cache from any seekable reader.
    ///
    /// # Errors
    /// As [`Playback::open`].
    pub fn read(mut file: R) -> Result<Self, OpenError> {
        let bytes = file.seek(SeekFrom::End(0))?;
        let head = Head::read(&mut file)?;
        let (file_index, corruption) = match summary::read(&mut file, bytes) {
            Some(file_index) => (file_index, CorruptionReport::default()),
            None => rebuild::read(&mut file, bytes)?,
        };
        let mut playback = Self {
            file,
            bytes,
            library: String::new(),
            run: RunInfo::default(),
            file_index,
            corruption,
            objects: Vec::new(),
            unnamed_objects: Vec::new(),
            points_channels: Vec::new(),
            mesh_channels: Vec::new(),
            meshes: Vec::new(),
            time_samples: Vec::new(),
            chunk: Chunk::default(),
            copy: Chunk::default(),
            loaded: None,
            loaded_copy: None,
        };
        playback.read_run(head)?;
        playback.read_objects()?;
        playback.time_samples =
            time_index::list(&playback.run, &playback.file_index, &playback.points_channels);
        playback.corruption.frames = time_index::missing(&playback.run, &playback.time_samples);
        Ok(playback)
    }

    /// Reads the metadata of the run, from a redundant copy where the record is damaged.
    fn read_run(&mut self, head: Head) -> Result<(), OpenError> {
        let is_ours = matches!(&head, Head::Of { profile, .. } if profile == PROFILE);
        let read = RunInfo::from_metadata(&self.file_index.metadata);
        let is_sound = matches!(&read, Ok((_, lost)) if lost.is_empty());
        if !is_ours || !is_sound {
            self.file_index.read_copies(&mut self.file, &mut self.copy)?;
        }
        if self.file_index.channels.is_empty() {
            self.infer_channels()?;
        }
        if !is_ours && !self.file_index.has_cache_records() {
            return Err(head.refusal());
        }
        let nothing = self.corruption.truncated && self.file_index.chunks.is_empty();
        let (run, lost) = match RunInfo::from_metadata(&self.file_index.metadata) {
            Err(OpenError::NoRecord { .. }) if nothing => return Err(OpenError::TooShort),
            Err(error @ OpenError::NoRecord { .. }) => {
                let [_, record] = self.infer_run()?.ok_or(error)?.to_metadata();
                self.file_index.set_metadata(record);
                self.corruption.run = true;
                RunInfo::from_metadata(&self.file_index.metadata)?
            }
            run => run?,
        };
        self.run = run;
        self.corruption.start = !is_ours || lost.is_empty() && !is_sound;
        self.corruption.records = lost;
        self.library = match head {
            Head::Of { library, .. } if is_ours => library,
            _ => self.file_index.copies.library.clone().unwrap_or_default(),
        };
        Ok(())
    }

    /// Metadata of the run.
    pub fn run(&self) -> &RunInfo {
        &self.run
    }

    /// The objects with their first meshes, in the order of the recording; [`object_at`](Self::object_at) has later
    /// meshes.
    pub fn objects(&self) -> &[ObjectInfo] {
        &self.objects
    }

    /// All recorded time samples in order of time; the first is the initial state.
    pub fn time_samples(&self) -> &[TimeSample] {
        &self.time_samples
    }

    /// The time sample at the end of `frame`.
    pub fn end_of(&self, frame: i32) -> Option<usize> {
        self.time_samples.iter().position(|sample| sample.frame == frame && sample.ends_frame())
    }

    /// The corruption found so far; [`verify`](Self::verify) finds all of it.
    pub fn corruption(&self) -> &CorruptionReport {
        &self.corruption
    }

    /// Size of the file in bytes.
    pub fn bytes(&self) -> u64 {
        self.bytes
    }

    /// The program that wrote the file, with its version.
    pub fn library(&self) -> &str {
        &self.library
    }

    /// Topic, encoding and number of messages of every channel.
    pub fn channels(&self) -> impl Iterator<Item = (&str, &str, usize)> {
        self.file_index.channels.values().map(|channel| {
            let messages = self.file_index.messages.get(&channel.id).map_or(0, Vec::len);
            (channel.topic.as_str(), channel.message_encoding.as_str(), messages)
        })
    }

    /// The first mesh of an object, from its chunk or from a redundant copy.
    fn first_mesh(&mut self, channel: u16, name: &str) -> Result<Option<ObjectInfo>, OpenError> {
        let latest = match self.load_latest(channel, 0) {
            Ok(Some(latest)) => latest,
            // Where the system fails to read, the file may be sound.
            Err(ReadError::Io(error)) => return Err(error.into()),
            Ok(None) | Err(_) => return Ok(None),
        };
        self.corruption.start |= latest.is_copy;
        let message = self.latest_message(channel, latest);
        let read = message.and_then(|message| topology::read(name, message));
        Ok(read.filter(|&(_, number)| number == 0).map(|(object, _)| object))
    }

    /// Reads the meshes.
    fn read_objects(&mut self) -> Result<(), OpenError> {
        let topologies: BTreeMap<u16, String> = self
            .file_index
            .channels
            .values()
            .filter(|channel| channel.message_encoding == topology::ENCODING)
            .filter_map(|channel| Some((channel.id, topology::object_name(&channel.topic)?.to_owned())))
            .collect();
        for (mesh_channel, name) in topologies {
            let damaged = || OpenError::Topology { object: format!("`{name}`") };
            let points = self.file_index.channel(&format!("/{name}/points")).ok_or_else(damaged)?;
            let object = match self.first_mesh(mesh_channel, &name)? {
                Some(object) => object,
                None => match self.points_without_mesh(points, &name)? {
                    Some(object) => {
                        self.corruption.meshes.push(name);
                        object
                    }
                    None => {
                        self.corruption.objects.push(name);
                        continue;
                    }
                },
            };
            self.objects.push(object);
            self.points_channels.push(points);
            self.mesh_channels.push(mesh_channel);
            self.meshes.push(None);
        }
        if self.file_index.channels.is_empty()
            && self.corruption.truncated
            && self.file_index.chunks.is_empty()
        {
            return Err(OpenError::TooShort);
        }
        if self.file_index.channels.is_empty()
            || self.objects.is_empty() && !self.corruption.objects.is_empty()
        {
            return Err(OpenError::Topology { object: "every object".to_owned() });
        }
        Ok(())
    }
}

/// Time of the first mesh of every object, in nanoseconds.
pub(crate) const FIRST: u64 = 0;

/// A later mesh of an object.
pub(crate) struct Mesh {
    /// When it was recorded, in nanoseconds.
    pub time: u64,
    pub number: u32,
    pub object: ObjectInfo,
}

/// The first bytes of a file.
enum Head {
    /// An MCAP header.
    Of { profile: String, library: String },
    /// Too few bytes for a header.
    Short,
    /// Anything else.
    Other,
}

impl Head {
    fn read(file: &mut (impl Read + Seek)) -> Result<Self, OpenError> {
        let mut head = Vec::new();
        file.seek(SeekFrom::Start(0))?;
        file.take(4096).read_to_end(&mut head)?;
        let magic = &mcap::MAGIC[..mcap::MAGIC.len().min(head.len())];
        Ok(match part_file::read_header(&head) {
            _ if head.is_empty() => return Err(OpenError::Empty),
            Some((profile, library)) => Self::Of { profile, library },
            None if head.len() < 64 && head.starts_with(magic) => Self::Short,
            None => Self::Other,
        })
    }

    /// The error for a file without any record of a cache.
    fn refusal(self) -> OpenError {
        match self {
            Self::Of { profile, library } => OpenError::OtherTool { profile, library },
            Self::Short => OpenError::TooShort,
            Self::Other => OpenError::NotMcap,
        }
    }
}
