//! A sound file from what survives of a damaged one.

use std::collections::BTreeMap;
use std::io::{Read, Seek, Write};

use mcap::records::MessageHeader;

use crate::attribute::Attribute;
use crate::mesh::FIRST;
use crate::object::ObjectKind;
use crate::open_error::ReadError;
use crate::playback::{Held, Playback};
use crate::record_error::RecordError;
use crate::run::Packing;
use crate::stream::Stream;
use crate::{points, topology};

/// What was saved.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Recovered {
    /// Chunks, which are frames, that were copied.
    pub frames: usize,
    /// Chunks that were left out, as they are damaged.
    pub damaged: usize,
    /// Size of the new file in bytes.
    pub bytes: u64,
}

/// Why nothing could be saved.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum RecoverError {
    /// The damaged file cannot be read.
    #[error("reading failed")]
    Read(#[from] ReadError),
    /// The new one cannot be written.
    #[error("writing failed")]
    Write(#[from] RecordError),
}

impl<R: Read + Seek> Playback<R> {
    /// Writes everything that is sound into an empty `target`, as a cache that is whole: every message of every
    /// frame that can be read, bit for bit, the channels, and what is known of the run. Fills in what is lost.
    ///
    /// Of a damaged frame the meshes, and the colliders that stood still from then on, are taken from their copies and
    /// join the next frame.
    ///
    /// # Errors
    /// When the system fails to read or write.
    pub fn recover<W: Write + Seek>(&mut self, target: W) -> Result<Recovered, RecoverError> {
        let mut saved = Saved {
            stream: Stream::create(target, Packing::Fast)?,
            ids: BTreeMap::new(),
            sent: BTreeMap::new(),
        };
        self.begin_recovered(&mut saved)?;
        let mut recovered = Recovered { frames: 0, damaged: 0, bytes: 0 };
        for index in 0..self.contents.chunks.len() {
            match self.load(index) {
                Ok(()) => {}
                Err(ReadError::Damaged { frame }) => {
                    recovered.damaged += 1;
                    self.note_damage(index, frame);
                    self.read_copies()?;
                    continue;
                }
                Err(error) => return Err(error.into()),
            }
            if let Some(first) = self.first_points() {
                self.fill_in(&first, &mut saved)?;
            }
            for (header, data) in self.chunk.messages() {
                saved.copy(header, data)?;
            }
            if self.contents.is_checkpoint(index) {
                saved.stream.close_chunk()?;
                continue;
            }
            saved.stream.close_frame()?;
            recovered.frames += 1;
        }
        self.loss.in_order();
        (_, recovered.bytes) = saved.stream.finish()?;
        Ok(recovered)
    }

    /// Writes what stands before the first frame.
    fn begin_recovered<W: Write + Seek>(&self, saved: &mut Saved<W>) -> Result<(), RecoverError> {
        for record in &self.contents.metadata {
            saved.stream.metadata(record)?;
        }
        let uses = |one: &Attribute| {
            self.contents.channels.values().any(|channel| channel.message_encoding == one.encoding)
        };
        let schemas = saved.stream.own_schemas(uses, self.contents.checkpoints().next().is_some())?;
        let is_lost =
            |topic: &str| self.loss.objects.iter().any(|name| topic.starts_with(&format!("/{name}/")));
        for channel in self.contents.channels.values().filter(|channel| !is_lost(&channel.topic)) {
            let schema = schemas.of(&channel.message_encoding);
            let id = saved.stream.channel(&channel.topic, schema, &channel.message_encoding)?;
            saved.ids.insert(channel.id, id);
        }
        for (object, channel) in self.objects().iter().zip(&self.points_channels) {
            if object.kind == ObjectKind::Collider {
                saved.ids.get(channel).iter().for_each(|&&id| saved.stream.hold(id));
            }
        }
        Ok(())
    }

    /// The first message of points in the chunk in memory.
    fn first_points(&self) -> Option<(MessageHeader, Vec<u8>)> {
        let mut points =
            self.chunk.messages().filter(|(head, _)| self.points_channels.contains(&head.channel_id));
        let (header, data) = points.next()?;
        Some((*header, data.get(..points::HEAD)?.to_vec()))
    }

    /// Writes what holds at the first moment of the chunk in memory, and was in none that has been written.
    fn fill_in<W: Write + Seek>(
        &mut self,
        (now, stamp): &(MessageHeader, Vec<u8>),
        saved: &mut Saved<W>,
    ) -> Result<(), RecoverError> {
        for object in 0..self.objects().len() {
            let (mesh, points) = (self.mesh_channels[object], self.points_channels[object]);
            let at =
                |time: u64| MessageHeader { channel_id: mesh, log_time: time, publish_time: time, ..*now };
            if !saved.sent.contains_key(&mesh) && self.chunk.message(mesh, FIRST).is_none() {
                let mut message = Vec::new();
                topology::write(self.objects()[object].clone(), 0, &mut message);
                saved.copy(&at(FIRST), &message)?;
            }
            if let Some(held) = self.copied_since(mesh, now.log_time, saved)? {
                saved.copy(&at(held.time), self.held_message(mesh, held).unwrap_or_default())?;
            }
            if let Some(held) = self.copied_since(points, now.log_time, saved)? {
                let mut message = self.held_message(points, held).unwrap_or_default().to_vec();
                if points::restamp(&mut message, stamp) {
                    saved.copy(&MessageHeader { channel_id: points, ..at(now.log_time) }, &message)?;
                }
            }
        }
        Ok(())
    }

    /// The copy that holds on a channel at a time, if it is newer than all that was written and the chunk in memory
    /// has nothing for that time.
    fn copied_since<W: Write + Seek>(
        &mut self,
        channel: u16,
        log_time: u64,
        saved: &Saved<W>,
    ) -> Result<Option<Held>, ReadError> {
        let Some((time, _)) = self.contents.copies.latest(channel, log_time) else { return Ok(None) };
        let is_there = self.chunk.message(channel, log_time).is_some()
            || saved.sent.get(&channel).is_some_and(|&sent| sent >= time);
        if is_there { Ok(None) } else { self.held_copy(channel, log_time) }
    }
}

/// The file that is written.
struct Saved<W: Write + Seek> {
    stream: Stream<W>,
    /// Its channels, by those of the damaged file.
    ids: BTreeMap<u16, u16>,
    /// The time of the last message on each of those.
    sent: BTreeMap<u16, u64>,
}

impl<W: Write + Seek> Saved<W> {
    fn copy(&mut self, header: &MessageHeader, data: &[u8]) -> Result<(), RecordError> {
        self.sent.insert(header.channel_id, header.log_time);
        match self.ids.get(&header.channel_id) {
            Some(&id) => self.stream.copy(id, header, data),
            None => Ok(()),
        }
    }
}
