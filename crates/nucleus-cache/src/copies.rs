//! Copies of all that holds beyond its own frame, so that no damaged chunk costs another frame: the run, the channels,
//! the meshes, and where colliders stand that do not move.
//!
//! A copy is an attachment that holds a small MCAP file without chunks, packed as a whole: each
//! megabyte as four planes, of which plane k holds bytes k, k + 4, k + 8 and so on, and all of it compressed by zstd.
//! With planes meshes become half as large as without. The copy of the start is written behind the first frame that follows it and once more behind the last frame. A mesh or a collider position
//! that changes later is copied behind the next frame, unless that has a newer one.

use std::borrow::Cow;
use std::collections::{BTreeMap, BTreeSet};
use std::io::{self, Read, Seek, Write};
use std::mem::take;

use mcap::records::{MessageHeader, Metadata};
use mcap::write::NoSeek;
use mcap::{Attachment, McapResult, WriteOptions, Writer};
use zstd::stream::write::Encoder;

use crate::provenance::{LIBRARY, PROFILE};
use crate::{points, topology};

/// The name of the attachments.
pub(crate) const NAME: &str = "nucleus.copy";
const MEDIA_TYPE: &str = "application/x-nucleus-planes+zstd";
/// Most of a copy are words of so many bytes.
const PLANES: usize = 4;
/// Bytes that are taken apart into planes at once.
const BLOCK: usize = 1 << 20;
/// Of their compression; any recorder must pick the same, whatever the level of its chunks.
const LEVEL: i32 = 3;

/// A topic and an encoding.
type Channel = (String, String);
/// A message that holds until the next on its channel.
type Held = (MessageHeader, Vec<u8>);

/// What has to be copied, and what will have to be.
pub(crate) struct Copies {
    channels: BTreeMap<u16, Channel>,
    /// Channels whose messages hold until the next.
    lasting: BTreeSet<u16>,
    /// The copy of the start until the first frame is closed, and its bytes from then on.
    start: Option<CopyWriter>,
    packed_start: Vec<u8>,
    start_is_due: bool,
    /// Lasting messages of the open chunk, the last of each channel.
    sent: BTreeMap<u16, Held>,
    /// Those of earlier chunks that have no copy yet.
    pending: BTreeMap<u16, Held>,
    /// Whether the open chunk shows a moment.
    shows: bool,
}

impl Copies {
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

    /// Messages of a mesh hold until the next; others only on channels that are announced by [`hold`](Self::hold).
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

    /// From now on messages of a channel hold until the next.
    pub fn hold(&mut self, channel: u16) {
        self.lasting.insert(channel);
    }

    /// Takes note of a message that is written.
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

    /// Writes what is due behind a frame whose chunk is closed.
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

    /// Writes the start once more, behind the last frame.
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

/// The small file of one copy.
struct CopyWriter(Writer<NoSeek<Planes>>);

impl CopyWriter {
    fn new() -> McapResult<Self> {
        let options = WriteOptions::new()
            .profile(PROFILE)
            .library(LIBRARY)
            .use_chunks(false)
            .emit_summary_records(false)
            .emit_summary_offsets(false)
            .calculate_data_section_crc(false);
        options.create(NoSeek::new(Planes::new()?)).map(Self)
    }

    fn channel(&mut self, id: u16, (topic, encoding): &Channel) -> McapResult<()> {
        self.0.add_channel_with_id(id, 0, topic, encoding, &BTreeMap::new()).map(drop)
    }

    fn finish(mut self) -> McapResult<Vec<u8>> {
        self.0.finish()?;
        Ok(self.0.into_inner().into_inner().finish()?)
    }
}

/// Packs what is written to it.
struct Planes {
    block: Vec<u8>,
    packed: Encoder<'static, Vec<u8>>,
}

impl Planes {
    fn new() -> io::Result<Self> {
        Ok(Self { block: Vec::new(), packed: Encoder::new(Vec::new(), LEVEL)? })
    }

    fn end_block(&mut self) -> io::Result<()> {
        let mut planes = Vec::with_capacity(self.block.len());
        for plane in 0..PLANES {
            planes.extend(self.block.iter().skip(plane).step_by(PLANES));
        }
        self.block.clear();
        self.packed.write_all(&planes)
    }

    fn finish(mut self) -> io::Result<Vec<u8>> {
        self.end_block()?;
        self.packed.finish()
    }
}

impl Write for Planes {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let room = (BLOCK - self.block.len()).min(bytes.len());
        self.block.extend_from_slice(&bytes[..room]);
        if self.block.len() == BLOCK {
            self.end_block()?;
        }
        Ok(room)
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

/// Replaces `out` by what was packed; it may be `most` bytes.
pub(crate) fn unpack(packed: &[u8], most: u64, out: &mut Vec<u8>) -> io::Result<()> {
    out.clear();
    zstd::Decoder::new(packed)?.take(most).read_to_end(out)?;
    let mut planes = Vec::new();
    for block in out.chunks_mut(BLOCK) {
        planes.clear();
        planes.extend_from_slice(block);
        let mut bytes = planes.iter();
        for plane in 0..PLANES {
            let places = block.iter_mut().skip(plane).step_by(PLANES);
            places.zip(bytes.by_ref()).for_each(|(place, &byte)| *place = byte);
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn packing_loses_no_byte() {
        for length in [0, 1, 2, 3, 4, 7, BLOCK - 1, BLOCK, BLOCK + 1, 2 * BLOCK + 3] {
            let bytes: Vec<u8> = (0..length).map(|k| ((k * k) >> 5) as u8).collect();
            let mut planes = Planes::new().unwrap();
            bytes.chunks(9973).for_each(|part| planes.write_all(part).unwrap());
            let mut back = vec![1; 5];
            unpack(&planes.finish().unwrap(), u64::MAX, &mut back).unwrap();
            assert!(back == bytes, "{length}");
        }
    }
}
