//! The index of a cache: which chunk holds which message, read from the summary section or rebuilt from the chunks.

pub(crate) mod rebuild;
pub(crate) mod summary;

use std::collections::{BTreeMap, BTreeSet};
use std::io::{self, Read, Seek};
use std::ops::Range;

use mcap::records::{Channel, Metadata};

use crate::container::chunk::{Chunk, ChunkError, ChunkPlace};
use crate::messages::checkpoint;
use crate::messages::metadata::checksum_holds;

/// Index of chunks, channels, metadata and redundant copies.
#[derive(Debug, Default, PartialEq)]
pub(crate) struct FileIndex {
    pub chunks: Vec<ChunkPlace>,
    pub channels: BTreeMap<u16, Channel>,
    pub metadata: Vec<Metadata>,
    /// For each channel the times of its messages in order, and the chunk of each.
    pub messages: BTreeMap<u16, Vec<(u64, usize)>>,
    pub copies: CopyIndex,
}

/// Index of the redundant copies; their contents are listed when they are first needed.
#[derive(Debug, Default, PartialEq)]
pub(crate) struct CopyIndex {
    /// Byte ranges of the whole records.
    pub places: Vec<Range<u64>>,
    /// For each channel the times of its copied messages in order, and the copy of each.
    messages: BTreeMap<u16, Vec<(u64, usize)>>,
    /// The program that wrote the file.
    pub library: Option<String>,
    is_read: bool,
}

impl CopyIndex {
    /// Time and copy of a channel's last copied message at or before `log_time`.
    pub fn latest(&self, channel: u16, log_time: u64) -> Option<(u64, usize)> {
        latest(self.messages.get(&channel)?, log_time)
    }
}

impl FileIndex {
    /// Adds a chunk and its messages.
    pub fn add_chunk(&mut self, place: ChunkPlace, chunk: &Chunk) {
        let messages = chunk.messages().map(|(header, _)| (header.channel_id, header.log_time));
        self.add_messages(place, messages);
        self.channels.extend(chunk.channels().iter().map(|channel| (channel.id, channel.clone())));
    }

    /// Adds a redundant copy; its metadata and channels fill in missing ones.
    pub fn add_copy(&mut self, place: Range<u64>, copy: &Chunk) {
        let index = self.copies.places.len();
        self.copies.places.push(place);
        self.list_copy(index, copy);
    }

    fn list_copy(&mut self, index: usize, copy: &Chunk) {
        for record in copy.metadata() {
            self.add_metadata(record.clone());
        }
        for channel in copy.channels() {
            self.channels.entry(channel.id).or_insert_with(|| channel.clone());
        }
        for (header, _) in copy.messages() {
            let messages = self.copies.messages.entry(header.channel_id).or_default();
            let place = messages.partition_point(|&(time, _)| time < header.log_time);
            messages.insert(place, (header.log_time, index));
        }
        let library = copy.header().map(|header| header.library.clone());
        self.copies.library = self.copies.library.take().or(library);
    }

    /// Lists the contents of all redundant copies, once. Damaged copies are left out.
    pub fn read_copies(&mut self, file: &mut (impl Read + Seek), chunk: &mut Chunk) -> io::Result<()> {
        if std::mem::replace(&mut self.copies.is_read, true) {
            return Ok(());
        }
        for index in 0..self.copies.places.len() {
            match chunk.read_copy(file, self.copies.places[index].clone()) {
                Ok(()) => self.list_copy(index, chunk),
                Err(ChunkError::Damaged) => {}
                Err(ChunkError::Io(error)) => return Err(error),
            }
        }
        Ok(())
    }

    /// Declares that the contents of all redundant copies are listed.
    pub fn mark_copies_read(&mut self) {
        self.copies.is_read = true;
    }

    /// Adds a metadata record. Of two records of one name, the one with a valid checksum is kept.
    pub fn add_metadata(&mut self, record: Metadata) {
        match self.metadata.iter_mut().find(|known| known.name == record.name) {
            None => self.metadata.push(record),
            Some(known) if !checksum_holds(known) && checksum_holds(&record) => *known = record,
            Some(_) => {}
        }
    }

    /// Replaces a metadata record.
    pub fn set_metadata(&mut self, record: Metadata) {
        self.metadata.retain(|known| known.name != record.name);
        self.metadata.push(record);
    }

    /// Whether the file has records that only caches have.
    pub fn has_cache_records(&self) -> bool {
        let is_ours = |text: &str| text.starts_with("nucleus.");
        !self.copies.places.is_empty()
            || self.channels.values().any(|channel| is_ours(&channel.message_encoding))
            || self.metadata.iter().any(|record| is_ours(&record.name) && checksum_holds(record))
    }

    /// Adds a chunk by the channels and times of its messages.
    pub fn add_messages(&mut self, place: ChunkPlace, messages: impl IntoIterator<Item = (u16, u64)>) {
        let index = self.chunks.len();
        self.chunks.push(place);
        for (channel, log_time) in messages {
            self.messages.entry(channel).or_default().push((log_time, index));
        }
    }

    /// Whether a chunk holds a checkpoint instead of a frame.
    pub fn is_checkpoint(&self, chunk: usize) -> bool {
        self.checkpoints().any(|(_, index)| index == chunk)
    }

    /// Times and chunks of all checkpoints.
    pub fn checkpoints(&self) -> impl Iterator<Item = (u64, usize)> + '_ {
        let channel = self.channels.values().find(|channel| channel.message_encoding == checkpoint::ENCODING);
        channel.and_then(|channel| self.messages.get(&channel.id)).into_iter().flatten().copied()
    }

    /// The channel of a topic.
    pub fn channel(&self, topic: &str) -> Option<u16> {
        self.channels.values().find(|channel| channel.topic == topic).map(|channel| channel.id)
    }

    /// Times of a channel's messages and copied messages, each once and in order.
    pub fn message_times(&self, channel: u16) -> BTreeSet<u64> {
        let messages = [self.messages.get(&channel), self.copies.messages.get(&channel)];
        messages.into_iter().flatten().flatten().map(|&(time, _)| time).collect()
    }

    /// Time and chunk of a channel's last message at or before `log_time`.
    pub fn latest(&self, channel: u16, log_time: u64) -> Option<(u64, usize)> {
        latest(self.messages.get(&channel)?, log_time)
    }
}

fn latest(messages: &[(u64, usize)], log_time: u64) -> Option<(u64, usize)> {
    let after = messages.partition_point(|&(time, _)| time <= log_time);
    messages[..after].last().copied()
}
