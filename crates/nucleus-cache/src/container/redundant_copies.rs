//! Redundant copies of all data that outlives its own frame, so that a damaged chunk costs no other frame: run
//! metadata, channels, meshes, and positions of resting colliders.
//!
//! A copy is an attachment that holds a small MCAP file without chunks. The whole file is byte-shuffled in blocks of 1
//! MiB (see [`byte_shuffle`](crate::messages::byte_shuffle)), then compressed by zstd. Shuffling halves the size of
//! meshes. The copy of the start is written behind the first frame that follows it, and again behind the last frame. A
//! mesh or collider position that changes later is copied behind the next frame, unless that frame has a newer one.

use std::borrow::Cow;
use std::collections::{BTreeMap, BTreeSet};
use std::io::{Seek, Write};
use std::mem::take;

use mcap::records::{MessageHeader, Metadata};
use mcap::write::NoSeek;
use mcap::{Attachment, McapResult, WriteOptions, Writer};

use crate::messages::byte_shuffle::PlaneEncoder;
use crate::messages::metadata::{LIBRARY, PROFILE};
use crate::messages::{points, topology};

/// Name of the attachments.
pub(crate) const NAME: &str = "nucleus.copy";
const MEDIA_TYPE: &str = "application/x-nucleus-planes+zstd";

/// Topic and encoding.
type Channel = (String, String);
/// A message that holds until the next one on its channel.
type HeldMessage = (MessageHeader, Vec<u8>);

/// Collects the messages that need copies, and writes the copies.
pub(crate) struct RedundantCopies {
    channels: BTreeMap<u16, Channel>,
    /// Channels whose messages hold until the next message.
    lasting: BTreeSet<u16>,
    /// The copy of the start while it is open, and its compressed bytes from the first frame on.
    start: Option<CopyWriter>,
    packed_start: Vec<u8>,
    start_is_due: bool,
    /// Held messages of the open chunk, the last of each channel.
    sent: BTreeMap<u16, HeldMessage>,
    /// Held messages of earlier chunks that have no copy yet.
    pending: BTreeMap<u16, HeldMessage>,
    /// Whether the open chunk has positions.
    shows: bool,
}

impl RedundantCopies {
    pub fn new() -> McapResult<Self> {
        Ok(Self {
            channels: BTreeMap::new(),
            lasting: BTreeSet::new(),
            start: Some(CopyWriter::new()?),
            packed_start: Vec::new(),
            start_is_due: false,
            sent: BTreeMap::new(),
            pending: BTreeMap::new(),
            shows: false,
        })
    }

    pub fn metadata(&mut self, record: &Metadata) -> McapResult<()> {
        self.start.as_mut().map_or(Ok(()), |start| start.0.write_metadata(record))
    }

    /// Registers a channel. Messages of meshes hold until the next; of other channels only after [`hold`](Self::hold).
    pub fn channel(&mut self, id: u16, topic: &str, encoding: &str) -> McapResult<()> {
        let channel = (topic.to_owned(), encoding.to_owned());
        if let Some(start) = &mut self.start {
            start.channel(id, &channel)?;
        }
        if encoding == topology::ENCODING {
            self.hold(id);
        }
        self.channels.insert(id, channel);
        Ok(())
    }

    /// Declares that messages of a channel hold until the next.
    pub fn hold(&mut self, channel: u16) {
        self.lasting.insert(channel);
    }

    /// Collects a message that is written.
    pub fn message(&mut self, header: &MessageHeader, data: &[u8]) -> McapResult<()> {
        let channel = header.channel_id;
        self.shows |= self.channels.get(&channel).is_some_and(|(_, encoding)| encoding == points::ENCODING);
        if !self.lasting.contains(&channel) {
            return Ok(());
        }
        if let Some(start) = &mut self.start {
            return start.0.write_to_known_channel(header, data);
        }
        let (_, copy) = self.sent.entry(channel).or_insert_with(|| (*header, Vec::new()));
        copy.clear();
        copy.extend_from_slice(data);
        if let Some((sent, _)) = self.sent.get_mut(&channel) {
            *sent = *header;
        }
        Ok(())
    }

    /// Writes the copies that are due behind a frame whose chunk is closed.
    pub fn end_frame<W: Write + Seek>(&mut self, file: &mut Writer<W>) -> McapResult<()> {
        let shows = take(&mut self.shows);
        if let Some(start) = self.start.take() {
            self.packed_start = start.finish()?;
            self.start_is_due = true;
            return Ok(());
        }
        self.pending.retain(|channel, _| !self.sent.contains_key(channel));
        if shows && take(&mut self.start_is_due) {
            attach(file, 0, &self.packed_start)?;
        }
        if shows && !self.pending.is_empty() {
            let time = self.pending.values().map(|(header, _)| header.log_time).max().unwrap_or(0);
            attach(file, time, &self.pack_pending()?)?;
        }
        self.pending.append(&mut self.sent);
        Ok(())
    }

    /// Writes the copy of the start again, behind the last frame.
    pub fn finish<W: Write + Seek>(&mut self, file: &mut Writer<W>) -> McapResult<()> {
        if let Some(start) = self.start.take() {
            self.packed_start = start.finish()?;
        }
        attach(file, 0, &self.packed_start)
    }

    fn pack_pending(&mut self) -> McapResult<Vec<u8>> {
        let mut copy = CopyWriter::new()?;
        for (id, (header, data)) in take(&mut self.pending) {
            if let Some(channel) = self.channels.get(&id) {
                copy.channel(id, channel)?;
                copy.0.write_to_known_channel(&header, &data)?;
            }
        }
        copy.finish()
    }
}

fn attach<W: Write + Seek>(file: &mut Writer<W>, log_time: u64, data: &[u8]) -> McapResult<()> {
    file.attach(&Attachment {
        log_time,
        create_time: 0,
        name: NAME.to_owned(),
        media_type: MEDIA_TYPE.to_owned(),
        data: Cow::Borrowed(data),
    })
}

/// The small MCAP file of one copy.
struct CopyWriter(Writer<NoSeek<PlaneEncoder>>);

impl CopyWriter {
    fn new() -> McapResult<Self> {
        let options = WriteOptions::new()
            .profile(PROFILE)
            .library(LIBRARY)
            .use_chunks(false)
            .emit_summary_records(false)
            .emit_summary_offsets(false)
            .calculate_data_section_crc(false);
        options.create(NoSeek::new(PlaneEncoder::new()?)).map(Self)
    }

    fn channel(&mut self, id: u16, (topic, encoding): &Channel) -> McapResult<()> {
        self.0.add_channel_with_id(id, 0, topic, encoding, &BTreeMap::new()).map(drop)
    }

    fn finish(mut self) -> McapResult<Vec<u8>> {
        self.0.finish()?;
        Ok(self.0.into_inner().into_inner().finish()?)
    }
}
