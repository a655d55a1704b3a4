//! What a cache holds and where, however that was found out.

use std::collections::BTreeMap;

use mcap::records::{Channel, Metadata};

use crate::checkpoint;
use crate::chunk::{Chunk, ChunkPlace};

/// The table of contents.
#[derive(Debug, Default, PartialEq)]
pub(crate) struct Contents {
    pub chunks: Vec<ChunkPlace>,
    pub channels: BTreeMap<u16, Channel>,
    pub metadata: Vec<Metadata>,
    /// For each channel the times of its messages in order, and the chunk each lies in.
    pub messages: BTreeMap<u16, Vec<(u64, usize)>>,
}

impl Contents {
    /// Adds a chunk by what it holds.
    pub fn add_chunk(&mut self, place: ChunkPlace, chunk: &Chunk) {
        let messages = chunk.messages().map(|(header, _)| (header.channel_id, header.log_time));
        self.add_messages(place, messages);
        self.channels.extend(chunk.channels().iter().map(|channel| (channel.id, channel.clone())));
    }

    /// Adds a chunk by the channels and times of its messages.
    pub fn add_messages(&mut self, place: ChunkPlace, messages: impl IntoIterator<Item = (u16, u64)>) {
        let index = self.chunks.len();
        self.chunks.push(place);
        for (channel, log_time) in messages {
            self.messages.entry(channel).or_default().push((log_time, index));
        }
    }

    /// Whether a chunk holds a checkpoint, and no frame.
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

    /// The chunk and time of a channel's last message at or before `log_time`.
    pub fn latest(&self, channel: u16, log_time: u64) -> Option<(u64, usize)> {
        let messages = self.messages.get(&channel)?;
        let after = messages.partition_point(|&(time, _)| time <= log_time);
        messages[..after].last().copied()
    }
}
