//! Loads chunks and redundant copies, and verifies a whole cache.

use std::collections::BTreeMap;
use std::io::{Read, Seek};

use crate::container::chunk::ChunkError;
use crate::corruption::CorruptionReport;
use crate::error::ReadError;
use crate::read::playback::{Playback, Sizes};

/// A message that is in memory.
#[derive(Debug, Clone, Copy)]
pub(crate) struct LatestMessage {
    /// Its time in nanoseconds.
    pub time: u64,
    pub is_copy: bool,
}

impl<R: Read + Seek> Playback<R> {
    /// Loads the last message of a channel at or before a time: from its chunk, or from its redundant copy where the
    /// chunk is damaged or lost. `None` when there is no such message.
    ///
    /// # Errors
    /// When the message exists and cannot be read.
    pub(crate) fn load_latest(
        &mut self,
        channel: u16,
        log_time: u64,
    ) -> Result<Option<LatestMessage>, ReadError> {
        let original = self.file_index.latest(channel, log_time);
        let is_newer = |copied: (u64, usize)| original.is_none_or(|(time, _)| copied.0 > time);
        if let Some((time, index)) = original
            && !self.file_index.copies.latest(channel, log_time).is_some_and(is_newer)
        {
            match self.load(index) {
                Ok(()) => return Ok(Some(LatestMessage { time, is_copy: false })),
                Err(error @ ReadError::Damaged { .. }) => {
                    self.read_copies()?;
                    let begin = self.file_index.chunks[index].times.0;
                    if self
                        .file_index
                        .copies
                        .latest(channel, log_time)
                        .is_none_or(|(copied, _)| copied < begin)
                    {
                        return Err(error);
                    }
                }
                Err(error) => return Err(error),
            }
        }
        self.load_latest_copy(channel, log_time)
    }

    /// Lists the contents of the redundant copies, once.
    pub(crate) fn read_copies(&mut self) -> Result<(), ReadError> {
        Ok(self.file_index.read_copies(&mut self.file, &mut self.copy)?)
    }

    /// Loads the last copied message of a channel at or before a time.
    pub(crate) fn load_latest_copy(
        &mut self,
        channel: u16,
        log_time: u64,
    ) -> Result<Option<LatestMessage>, ReadError> {
        let Some((time, copy)) = self.file_index.copies.latest(channel, log_time) else { return Ok(None) };
        self.load_copy(copy, time)?;
        Ok(Some(LatestMessage { time, is_copy: true }))
    }

    /// The bytes of a message that [`load_latest`](Self::load_latest) has loaded.
    pub(crate) fn latest_message(&self, channel: u16, latest: LatestMessage) -> Option<&[u8]> {
        let chunk = if latest.is_copy { &self.copy } else { &self.chunk };
        chunk.last_message(channel, latest.time)
    }

    /// Loads copy `index`, unless it is in memory.
    fn load_copy(&mut self, index: usize, log_time: u64) -> Result<(), ReadError> {
        if self.loaded_copy == Some(index) {
            return Ok(());
        }
        self.loaded_copy = None;
        match self.copy.read_copy(&mut self.file, self.file_index.copies.places[index].clone()) {
            Ok(()) => self.loaded_copy = Some(index),
            Err(ChunkError::Damaged) => {
                return Err(ReadError::Damaged { frame: self.run.frame_at(log_time) });
            }
            Err(ChunkError::Io(error)) => return Err(ReadError::Io(error)),
        }
        Ok(())
    }

    /// Loads chunk `index`, unless it is in memory.
    pub(crate) fn load(&mut self, index: usize) -> Result<(), ReadError> {
        if self.loaded == Some(index) {
            return Ok(());
        }
        self.loaded = None;
        let place = &self.file_index.chunks[index];
        match self.chunk.read(&mut self.file, place.bytes.clone()) {
            Ok(times) if times == place.times => self.loaded = Some(index),
            Ok(_) | Err(ChunkError::Damaged) => {
                return Err(ReadError::Damaged { frame: self.run.frame_at(place.times.1) });
            }
            Err(ChunkError::Io(error)) => return Err(ReadError::Io(error)),
        }
        Ok(())
    }

    /// Reads and verifies every frame; returns the complete corruption report.
    ///
    /// # Errors
    /// When the system fails to read.
    pub fn verify(&mut self) -> Result<&CorruptionReport, ReadError> {
        let (mut numbers, mut missed) = (BTreeMap::new(), Vec::new());
        for index in 0..self.file_index.chunks.len() {
            match self.load(index) {
                Ok(()) => self.find_missing_meshes(&mut numbers, &mut missed),
                Err(ReadError::Damaged { frame }) => self.report_damage(index, frame),
                Err(error) => return Err(error),
            }
        }
        self.report_lost_meshes(missed)?;
        self.verify_copies()?;
        self.corruption.sort_and_dedup();
        Ok(&self.corruption)
    }

    fn verify_copies(&mut self) -> Result<(), ReadError> {
        self.corruption.copies = 0;
        self.loaded_copy = None;
        for place in &self.file_index.copies.places {
            match self.copy.read_copy(&mut self.file, place.clone()) {
                Ok(()) => {}
                Err(ChunkError::Damaged) => self.corruption.copies += 1,
                Err(ChunkError::Io(error)) => return Err(ReadError::Io(error)),
            }
        }
        Ok(())
    }

    /// Adds a damaged chunk to the corruption report.
    pub(crate) fn report_damage(&mut self, chunk: usize, frame: i32) {
        match self.file_index.is_checkpoint(chunk) {
            true => self.corruption.checkpoints.push(frame),
            false => self.corruption.frames.push(frame),
        }
    }

    /// Uncompressed bytes of each channel, by topic, and compressed bytes of all frames. Reads the whole file; damaged
    /// frames are left out.
    ///
    /// # Errors
    /// When the system fails to read.
    pub fn sizes(&mut self) -> Result<Sizes, ReadError> {
        let mut sizes = Sizes::default();
        for index in 0..self.file_index.chunks.len() {
            let packed = self.file_index.chunks[index].bytes.clone();
            match self.load(index) {
                Ok(()) => {}
                Err(ReadError::Damaged { .. }) => continue,
                Err(error) => return Err(error),
            }
            sizes.packed += packed.end - packed.start;
            for (header, data) in self.chunk.messages() {
                let topic = self.file_index.channels.get(&header.channel_id).map(|channel| &channel.topic);
                let bytes = sizes.channels.entry(topic.cloned().unwrap_or_default()).or_default();
                *bytes += data.len() as u64;
            }
        }
        Ok(sizes)
    }
}
