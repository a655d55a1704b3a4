//! Reads a cache: what it holds, and any moment of it.

use std::collections::BTreeMap;
use std::fs::File;
use std::io::{BufReader, Read, Seek, SeekFrom};
use std::path::Path;

use nucleus_core::ContactState;
use serde_json::Value;

use crate::attribute::{self, Attribute};
use crate::chunk::{Chunk, ChunkFault};
use crate::contents::Contents;
use crate::loss::Loss;
use crate::mesh::Mesh;
use crate::moment::{self, RecordedMoment};
use crate::object::ObjectInfo;
use crate::open_error::{OpenError, ReadError};
use crate::points::PointsMessage;
use crate::provenance::PROFILE;
use crate::run::RunInfo;
use crate::shuffle::unshuffle;
use crate::{salvage, summary, target, topology};

/// An open cache.
///
/// A finished file is found by its index and only the frames that are asked for are read. Any other file is
/// walked through once, and opened as far as it is whole; [`loss`](Self::loss) says what is missing.
pub struct Playback<R = BufReader<File>> {
    file: R,
    bytes: u64,
    library: String,
    pub(crate) run: RunInfo,
    pub(crate) contents: Contents,
    pub(crate) loss: Loss,
    pub(crate) objects: Vec<ObjectInfo>,
    /// The names of objects whose own are lost.
    pub(crate) nameless: Vec<String>,
    pub(crate) points_channels: Vec<u16>,
    pub(crate) mesh_channels: Vec<u16>,
    /// Of each object the mesh that was asked for last, if it is not the first.
    pub(crate) meshes: Vec<Option<Mesh>>,
    moments: Vec<RecordedMoment>,
    pub(crate) chunk: Chunk,
    copy: Chunk,
    loaded: Option<usize>,
    loaded_copy: Option<usize>,
}

/// How the bytes of a cache are shared out.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Sizes {
    /// Bytes of all messages of a channel, unpacked, by topic.
    pub channels: BTreeMap<String, u64>,
    /// Bytes of all frames in the file.
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

/// The file of a cache.
pub(crate) fn file_at(path: &Path) -> Result<File, OpenError> {
    if path.is_dir() {
        return Err(OpenError::Folder { path: path.to_owned() });
    }
    File::open(path).map_err(|source| OpenError::Io { path: path.to_owned(), source })
}

impl<R: Read + Seek> Playback<R> {
    /// Opens a cache from anything that can be read and sought.
    ///
    /// # Errors
    /// As [`Playback::open`].
    pub fn read(mut file: R) -> Result<Self, OpenError> {
        let bytes = file.seek(SeekFrom::End(0))?;
        let head = Head::read(&mut file)?;
        let (contents, loss) = match summary::read(&mut file, bytes) {
            Some(contents) => (contents, Loss::default()),
            None => salvage::read(&mut file, bytes)?,
        };
        let mut playback = Self {
            file,
            bytes,
            library: String::new(),
            run: RunInfo::default(),
            contents,
            loss,
            objects: Vec::new(),
            nameless: Vec::new(),
            points_channels: Vec::new(),
            mesh_channels: Vec::new(),
            meshes: Vec::new(),
            moments: Vec::new(),
            chunk: Chunk::default(),
            copy: Chunk::default(),
            loaded: None,
            loaded_copy: None,
        };
        playback.read_run(head)?;
        playback.read_objects()?;
        playback.moments = moment::list(&playback.run, &playback.contents, &playback.points_channels);
        playback.loss.frames = moment::missing(&playback.run, &playback.moments);
        Ok(playback)
    }

    /// Reads what the run is, from a copy where that is damaged.
    fn read_run(&mut self, head: Head) -> Result<(), OpenError> {
        let is_ours = matches!(&head, Head::Of { profile, .. } if profile == PROFILE);
        let read = RunInfo::from_metadata(&self.contents.metadata);
        let is_sound = matches!(read, Ok((_, true)));
        if !is_ours || !is_sound {
            self.contents.read_copies(&mut self.file, &mut self.copy)?;
        }
        if self.contents.channels.is_empty() {
            self.infer_channels()?;
        }
        if !is_ours && !self.contents.is_of_a_cache() {
            return Err(head.refusal());
        }
        let nothing = self.loss.cut_off && self.contents.chunks.is_empty();
        let (run, scene_is_sound) = match RunInfo::from_metadata(&self.contents.metadata) {
            Err(OpenError::NoRecord { .. }) if nothing => return Err(OpenError::TooShort),
            Err(error @ OpenError::NoRecord { .. }) => {
                let [_, record] = self.infer_run()?.ok_or(error)?.to_metadata();
                self.contents.set_metadata(record);
                self.loss.run = true;
                RunInfo::from_metadata(&self.contents.metadata)?
            }
            run => run?,
        };
        self.run = run;
        self.loss.start = !is_ours || scene_is_sound && !is_sound;
        self.loss.scene = !scene_is_sound;
        self.library = match head {
            Head::Of { library, .. } if is_ours => library,
            _ => self.contents.copies.library.clone().unwrap_or_default(),
        };
        Ok(())
    }

    /// What the run is.
    pub fn run(&self) -> &RunInfo {
        &self.run
    }

    /// The objects as they begin, in the order of the recording; [`object_at`](Self::object_at) has their meshes later.
    pub fn objects(&self) -> &[ObjectInfo] {
        &self.objects
    }

    /// All recorded moments in order of time; the first is the initial state.
    pub fn moments(&self) -> &[RecordedMoment] {
        &self.moments
    }

    /// The moment that shows the end of `frame`.
    pub fn end_of(&self, frame: i32) -> Option<usize> {
        self.moments.iter().position(|moment| moment.frame == frame && moment.ends_frame())
    }

    /// What is missing, as far as it is known; [`verify`](Self::verify) knows for certain.
    pub fn loss(&self) -> &Loss {
        &self.loss
    }

    /// Size of the file in bytes.
    pub fn bytes(&self) -> u64 {
        self.bytes
    }

    /// The program that wrote the file, with its version.
    pub fn library(&self) -> &str {
        &self.library
    }

    /// Every channel: topic, encoding, number of messages.
    pub fn channels(&self) -> impl Iterator<Item = (&str, &str, usize)> {
        self.contents.channels.values().map(|channel| {
            let messages = self.contents.messages.get(&channel.id).map_or(0, Vec::len);
            (channel.topic.as_str(), channel.message_encoding.as_str(), messages)
        })
    }

    /// Bytes of each channel before they were packed, by topic, and all bytes of frames once packed. Reads the
    /// whole file; damaged frames are left out.
    ///
    /// # Errors
    /// When the system fails to read.
    pub fn sizes(&mut self) -> Result<Sizes, ReadError> {
        let mut sizes = Sizes::default();
        for index in 0..self.contents.chunks.len() {
            let packed = self.contents.chunks[index].bytes.clone();
            match self.load(index) {
                Ok(()) => {}
                Err(ReadError::Damaged { .. }) => continue,
                Err(error) => return Err(error),
            }
            sizes.packed += packed.end - packed.start;
            for (header, data) in self.chunk.messages() {
                let topic = self.contents.channels.get(&header.channel_id).map(|channel| &channel.topic);
                let bytes = sizes.channels.entry(topic.cloned().unwrap_or_default()).or_default();
                *bytes += data.len() as u64;
            }
        }
        Ok(sizes)
    }

    /// Positions of an object at a moment, in scene units, as many as its mesh has points then. An object that does not move
    /// keeps its last ones.
    ///
    /// # Errors
    /// When there is no such object or moment, or its frame or that of its mesh is damaged.
    pub fn positions(&mut self, object: usize, moment: usize) -> Result<Vec<[f32; 3]>, ReadError> {
        let mut positions = Vec::new();
        self.positions_into(object, moment, &mut positions)?;
        Ok(positions)
    }

    /// The same into memory that is there already: whoever reads frame after frame is a third faster for it.
    ///
    /// # Errors
    /// As [`positions`](Self::positions); `out` is then as it was.
    pub fn positions_into(
        &mut self,
        object: usize,
        moment: usize,
        out: &mut Vec<[f32; 3]>,
    ) -> Result<(), ReadError> {
        self.points(object, moment).map(|points| points.positions(out))
    }

    /// Velocities of an object at a moment, in scene units per second, if they were recorded.
    ///
    /// # Errors
    /// As [`positions`](Self::positions).
    pub fn velocities(&mut self, object: usize, moment: usize) -> Result<Option<Vec<[f32; 3]>>, ReadError> {
        self.points(object, moment).map(|points| points.velocities())
    }

    /// How contact stands at each point of an object at a moment; nothing where that was not recorded.
    ///
    /// # Errors
    /// As [`positions`](Self::positions).
    pub fn contacts(&mut self, object: usize, moment: usize) -> Result<Option<Vec<ContactState>>, ReadError> {
        let frame = self.moments.get(moment).map_or(0, |moment| moment.frame);
        let Some(bytes) = self.attribute(object, moment, &attribute::CONTACTS)? else { return Ok(None) };
        attribute::read_contacts(bytes).map(Some).ok_or(ReadError::Damaged { frame })
    }

    /// The strain at each point of an object at a moment, the largest of its edges; nothing where it was not recorded.
    ///
    /// # Errors
    /// As [`positions`](Self::positions).
    pub fn strain(&mut self, object: usize, moment: usize) -> Result<Option<Vec<f32>>, ReadError> {
        let Some(planes) = self.attribute(object, moment, &attribute::STRAIN)? else { return Ok(None) };
        let mut strain = vec![0.0; planes.len() / 4];
        unshuffle(planes, &mut strain);
        Ok(Some(strain))
    }

    /// The bytes of an attribute of an object at a moment.
    fn attribute(
        &mut self,
        object: usize,
        moment: usize,
        attribute: &Attribute,
    ) -> Result<Option<&[u8]>, ReadError> {
        let (objects, moments) = (self.objects.len(), self.moments.len());
        let ObjectInfo { name, .. } =
            self.objects.get(object).ok_or(ReadError::NoObject { object, objects })?;
        let RecordedMoment { frame, log_time, .. } =
            *self.moments.get(moment).ok_or(ReadError::NoMoment { moment, moments })?;
        let channel = self.contents.channel(&format!("/{name}/{}", attribute.topic));
        let found = channel.and_then(|channel| Some((channel, self.contents.latest(channel, log_time)?)));
        let Some((channel, (time, index))) = found else { return Ok(None) };
        if time != log_time {
            return Ok(None); // It is of another moment.
        }
        let count = self.mesh_at(object, log_time)?.1.rest.len();
        self.load(index)?;
        let message = self.chunk.message(channel, log_time);
        let values = message.and_then(|data| attribute.read(data, count, (frame, log_time)));
        values.map(Some).ok_or(ReadError::Damaged { frame })
    }

    /// The report of each frame in order: JSON objects with a field `frame`. Reads the whole file; frames
    /// that are damaged or have no report are left out.
    ///
    /// # Errors
    /// When the system fails to read.
    pub fn reports(&mut self) -> Result<Vec<Value>, ReadError> {
        let Some(channel) = self.contents.channel("/report") else { return Ok(Vec::new()) };
        let mut reports = Vec::new();
        for (log_time, index) in self.contents.messages.get(&channel).cloned().unwrap_or_default() {
            match self.load(index) {
                Ok(()) => {}
                Err(ReadError::Damaged { .. }) => continue,
                Err(error) => return Err(error),
            }
            let line = self.chunk.message(channel, log_time);
            reports.extend(line.and_then(|line| serde_json::from_slice(line).ok()));
        }
        Ok(reports)
    }

    /// Reads every frame and checks it; gives what is lost then.
    ///
    /// # Errors
    /// When the system fails to read.
    pub fn verify(&mut self) -> Result<&Loss, ReadError> {
        let (mut numbers, mut missed) = (BTreeMap::new(), Vec::new());
        for index in 0..self.contents.chunks.len() {
            match self.load(index) {
                Ok(()) => self.note_missed_meshes(&mut numbers, &mut missed),
                Err(ReadError::Damaged { frame }) => self.note_damage(index, frame),
                Err(error) => return Err(error),
            }
        }
        self.note_lost_meshes(missed)?;
        self.loss.in_order();
        Ok(&self.loss)
    }

    /// Keeps in mind that a chunk is damaged.
    pub(crate) fn note_damage(&mut self, chunk: usize, frame: i32) {
        match self.contents.is_checkpoint(chunk) {
            true => self.loss.checkpoints.push(frame),
            false => self.loss.frames.push(frame),
        }
    }

    /// The message that holds for an object at a moment.
    fn points(&mut self, object: usize, moment: usize) -> Result<PointsMessage<'_>, ReadError> {
        let (objects, moments) = (self.objects.len(), self.moments.len());
        let channel = *self.points_channels.get(object).ok_or(ReadError::NoObject { object, objects })?;
        let RecordedMoment { frame, log_time, .. } =
            *self.moments.get(moment).ok_or(ReadError::NoMoment { moment, moments })?;
        let (mesh, has) = self.mesh_at(object, log_time)?;
        let (count, name) = (has.rest.len(), has.name.clone());
        let Some(held) = self.held(channel, log_time)? else {
            return Err(ReadError::Nothing { object: name, frame });
        };
        let frame = self.run.frame_at(held.time);
        let is_whole =
            |points: &PointsMessage| (points.stamp.frame, points.stamp.log_time()) == (frame, held.time);
        let message = self.held_message(channel, held).and_then(PointsMessage::read);
        let points = message.filter(is_whole).ok_or(ReadError::Damaged { frame })?;
        match points.mesh == mesh {
            true if points.count() == count => Ok(points),
            true => Err(ReadError::Damaged { frame }),
            false => Err(ReadError::MeshLost { object: name, frame }),
        }
    }

    /// Loads the last message of a channel at or before a time: from its chunk, or from its copy where that is damaged
    /// or lost. Nothing when there is none.
    ///
    /// # Errors
    /// When there is one and it cannot be read.
    pub(crate) fn held(&mut self, channel: u16, log_time: u64) -> Result<Option<Held>, ReadError> {
        let original = self.contents.latest(channel, log_time);
        let is_newer = |copied: (u64, usize)| original.is_none_or(|(time, _)| copied.0 > time);
        if let Some((time, index)) = original
            && !self.contents.copies.latest(channel, log_time).is_some_and(is_newer)
        {
            match self.load(index) {
                Ok(()) => return Ok(Some(Held { time, is_copy: false })),
                Err(error @ ReadError::Damaged { .. }) => {
                    self.read_copies()?;
                    let begin = self.contents.chunks[index].times.0;
                    if self.contents.copies.latest(channel, log_time).is_none_or(|(copied, _)| copied < begin)
                    {
                        return Err(error);
                    }
                }
                Err(error) => return Err(error),
            }
        }
        self.held_copy(channel, log_time)
    }

    /// Looks up what is in the copies, unless that is known.
    pub(crate) fn read_copies(&mut self) -> Result<(), ReadError> {
        Ok(self.contents.read_copies(&mut self.file, &mut self.copy)?)
    }

    /// Loads the last message of a channel that is copied, at or before a time.
    pub(crate) fn held_copy(&mut self, channel: u16, log_time: u64) -> Result<Option<Held>, ReadError> {
        let Some((time, copy)) = self.contents.copies.latest(channel, log_time) else { return Ok(None) };
        self.load_copy(copy, time)?;
        Ok(Some(Held { time, is_copy: true }))
    }

    /// The bytes of a message that [`held`](Self::held) has loaded.
    pub(crate) fn held_message(&self, channel: u16, held: Held) -> Option<&[u8]> {
        let chunk = if held.is_copy { &self.copy } else { &self.chunk };
        chunk.last_message(channel, held.time)
    }

    /// Makes `index` the copy in memory.
    fn load_copy(&mut self, index: usize, log_time: u64) -> Result<(), ReadError> {
        if self.loaded_copy == Some(index) {
            return Ok(());
        }
        self.loaded_copy = None;
        match self.copy.read_copy(&mut self.file, self.contents.copies.places[index].clone()) {
            Ok(()) => self.loaded_copy = Some(index),
            Err(ChunkFault::Damaged) => {
                return Err(ReadError::Damaged { frame: self.run.frame_at(log_time) });
            }
            Err(ChunkFault::Io(error)) => return Err(ReadError::Io(error)),
        }
        Ok(())
    }

    /// Makes `index` the chunk in memory.
    pub(crate) fn load(&mut self, index: usize) -> Result<(), ReadError> {
        if self.loaded == Some(index) {
            return Ok(());
        }
        self.loaded = None;
        let place = &self.contents.chunks[index];
        match self.chunk.read(&mut self.file, place.bytes.clone()) {
            Ok(times) if times == place.times => self.loaded = Some(index),
            Ok(_) | Err(ChunkFault::Damaged) => {
                return Err(ReadError::Damaged { frame: self.run.frame_at(place.times.1) });
            }
            Err(ChunkFault::Io(error)) => return Err(ReadError::Io(error)),
        }
        Ok(())
    }

    /// The mesh that an object begins with, from where it was recorded or from a copy.
    fn first_mesh(&mut self, channel: u16, name: &str) -> Option<ObjectInfo> {
        let held = self.held(channel, 0).ok().flatten()?;
        self.loss.start |= held.is_copy;
        let (object, number) = topology::read(name, self.held_message(channel, held)?)?;
        (number == 0).then_some(object)
    }

    /// Reads the meshes.
    fn read_objects(&mut self) -> Result<(), OpenError> {
        let topologies: BTreeMap<u16, String> = self
            .contents
            .channels
            .values()
            .filter(|channel| channel.message_encoding == topology::ENCODING)
            .filter_map(|channel| Some((channel.id, topology::object_name(&channel.topic)?.to_owned())))
            .collect();
        for (mesh_channel, name) in topologies {
            let damaged = || OpenError::Topology { object: format!("`{name}`") };
            let points = self.contents.channel(&format!("/{name}/points")).ok_or_else(damaged)?;
            let object = match self.first_mesh(mesh_channel, &name) {
                Some(object) => object,
                None => match self.cloud(points, &name)? {
                    Some(object) => {
                        self.loss.meshes.push(name);
                        object
                    }
                    None => {
                        self.loss.objects.push(name);
                        continue;
                    }
                },
            };
            self.objects.push(object);
            self.points_channels.push(points);
            self.mesh_channels.push(mesh_channel);
            self.meshes.push(None);
        }
        if self.contents.channels.is_empty() && self.loss.cut_off && self.contents.chunks.is_empty() {
            return Err(OpenError::TooShort);
        }
        if self.contents.channels.is_empty() || self.objects.is_empty() && !self.loss.objects.is_empty() {
            return Err(OpenError::Topology { object: "every object".to_owned() });
        }
        Ok(())
    }
}

/// A message that is in memory.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Held {
    /// When it was recorded.
    pub time: u64,
    pub is_copy: bool,
}

/// The first bytes of a file.
enum Head {
    /// Those of an MCAP file.
    Of { profile: String, library: String },
    /// Too few to tell.
    Short,
    /// Others.
    Other,
}

impl Head {
    fn read(file: &mut (impl Read + Seek)) -> Result<Self, OpenError> {
        let mut head = Vec::new();
        file.seek(SeekFrom::Start(0))?;
        file.take(4096).read_to_end(&mut head)?;
        let magic = &mcap::MAGIC[..mcap::MAGIC.len().min(head.len())];
        Ok(match target::read_header(&head) {
            _ if head.is_empty() => return Err(OpenError::Empty),
            Some((profile, library)) => Self::Of { profile, library },
            None if head.len() < 64 && head.starts_with(magic) => Self::Short,
            None => Self::Other,
        })
    }

    /// What is said of a file in which nothing of a cache is found.
    fn refusal(self) -> OpenError {
        match self {
            Self::Of { profile, library } => OpenError::OtherTool { profile, library },
            Self::Short => OpenError::TooShort,
            Self::Other => OpenError::NotMcap,
        }
    }
}
