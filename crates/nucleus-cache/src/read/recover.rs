//! Recovery: writes a sound cache from the readable parts of a damaged one.

use std::collections::BTreeMap;
use std::io::{Read, Seek, Write};

use mcap::records::MessageHeader;

use crate::container::writer::CacheWriter;
use crate::error::{ReadError, RecordError};
use crate::messages::attribute::Attribute;
use crate::messages::{points, topology};
use crate::read::load::LatestMessage;
use crate::read::playback::{FIRST, Playback};
use crate::run::{ObjectKind, Packing};

/// The result of a recovery.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Recovered {
    /// Copied frames.
    pub frames: usize,
    /// Damaged chunks that were left out.
    pub damaged: usize,
    /// Size of the new file in bytes.
    pub bytes: u64,
}

/// Why a recovery failed.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum RecoverError {
    /// The damaged file cannot be read.
    #[error("reading failed")]
    Read(#[from] ReadError),
    /// The new file cannot be written.
    #[error("writing failed")]
    Write(#[from] RecordError),
}

impl<R: Read + Seek> Playback<R> {
    /// Writes all readable parts into an empty `target` as a finished cache: every message of every readable frame bit
    /// for bit, the channels and the metadata. Completes the corruption report.
    ///
    /// Meshes and collider positions of a damaged frame that hold for later frames are taken from their redundant
    /// copies and join the next frame.
    ///
    /// # Errors
    /// When the system fails to read or write.
    pub fn recover<W: Write + Seek>(&mut self, target: W) -> Result<Recovered, RecoverError> {
        let mut saved = Saved {
            writer: CacheWriter::create(target, Packing::Fast)?,
            ids: BTreeMap::new(),
            sent: BTreeMap::new(),
        };
        self.begin_recovered(&mut saved)?;
        let mut recovered = Recovered { frames: 0, damaged: 0, bytes: 0 };
        for index in 0..self.file_index.chunks.len() {
            match self.load(index) {
                Ok(()) => {}
                Err(ReadError::Damaged { frame }) => {
                    recovered.damaged += 1;
                    self.report_damage(index, frame);
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
            if self.file_index.is_checkpoint(index) {
                saved.writer.close_chunk()?;
                continue;
            }
            saved.writer.close_frame()?;
            recovered.frames += 1;
        }
        self.corruption.sort_and_dedup();
        (_, recovered.bytes) = saved.writer.finish()?;
        Ok(recovered)
    }

    /// Writes the records before the first frame.
    fn begin_recovered<W: Write + Seek>(&self, saved: &mut Saved<W>) -> Result<(), RecoverError> {
        if self.corruption.records.is_empty() {
            self.file_index.metadata.iter().try_for_each(|record| saved.writer.metadata(record))?;
        } else {
            // The record of the run lists the others: without what is lost, but for the scene, which every run has.
            let records = self.run.to_metadata().into_iter().chain(self.run.extras_to_metadata());
            let mut kept = records.filter(|record| !self.corruption.records.contains(&record.name.as_str()));
            kept.try_for_each(|record| saved.writer.metadata(&record))?;
        }
        let uses = |one: &Attribute| {
            self.file_index.channels.values().any(|channel| channel.message_encoding == one.encoding)
        };
        let schemas = saved.writer.own_schemas(uses, self.file_index.checkpoints().next().is_some())?;
        let is_lost =
            |topic: &str| self.corruption.objects.iter().any(|name| topic.starts_with(&format!("/{name}/")));
        for channel in self.file_index.channels.values().filter(|channel| !is_lost(&channel.topic)) {
            let schema = schemas.of(&channel.message_encoding);
            let id = saved.writer.channel(&channel.topic, schema, &channel.message_encoding)?;
            saved.ids.insert(channel.id, id);
        }
        for (object, channel) in self.objects().iter().zip(&self.points_channels) {
            if object.kind == ObjectKind::Collider {
                saved.ids.get(channel).iter().for_each(|&&id| saved.writer.hold(id));
            }
        }
        Ok(())
    }

    /// The first points message of the loaded chunk.
    fn first_points(&self) -> Option<(MessageHeader, Vec<u8>)> {
        let mut points =
            self.chunk.messages().filter(|(head, _)| self.points_channels.contains(&head.channel_id));
        let (header, data) = points.next()?;
        Some((*header, data.get(..points::HEAD)?.to_vec()))
    }

    /// Writes messages that hold at the first sample of the loaded chunk and were in no chunk before.
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
            if let Some(latest) = self.copied_since(mesh, now.log_time, saved)? {
                saved.copy(&at(latest.time), self.latest_message(mesh, latest).unwrap_or_default())?;
            }
            if let Some(latest) = self.copied_since(points, now.log_time, saved)? {
                let mut message = self.latest_message(points, latest).unwrap_or_default().to_vec();
                if points::set_stamp(&mut message, stamp) {
                    saved.copy(&MessageHeader { channel_id: points, ..at(now.log_time) }, &message)?;
                }
            }
        }
        Ok(())
    }

    /// The copied message that holds on a channel at a time, if it is newer than all written messages and the loaded
    /// chunk has none at that time.
    fn copied_since<W: Write + Seek>(
        &mut self,
        channel: u16,
        log_time: u64,
        saved: &Saved<W>,
    ) -> Result<Option<LatestMessage>, ReadError> {
        let Some((time, _)) = self.file_index.copies.latest(channel, log_time) else { return Ok(None) };
        let is_there = self.chunk.message(channel, log_time).is_some()
            || saved.sent.get(&channel).is_some_and(|&sent| sent >= time);
        if is_there { Ok(None) } else { self.load_latest_copy(channel, log_time) }
    }
}

/// The cache being written.
struct Saved<W: Write + Seek> {
    writer: CacheWriter<W>,
    /// Its channel ids, by those of the damaged file.
    ids: BTreeMap<u16, u16>,
    /// Time of the last written message, by channel of the damaged file.
    sent: BTreeMap<u16, u64>,
}

impl<W: Write + Seek> Saved<W> {
    fn copy(&mut self, header: &MessageHeader, data: &[u8]) -> Result<(), RecordError> {
        self.sent.insert(header.channel_id, header.log_time);
        match self.ids.get(&header.channel_id) {
            Some(&id) => self.writer.copy(id, header, data),
            None => Ok(()),
        }
    }
}
