//! Reads one chunk, which holds one frame, or one redundant copy: decompresses it and verifies its checksum.

use std::io::{self, Read, Seek, SeekFrom};
use std::ops::Range;

use mcap::MAGIC;
use mcap::records::{Header, MessageHeader, Metadata, Record, op};
use zstd::bulk::Decompressor;

use crate::container::redundant_copies;
use crate::messages::byte_shuffle;

/// Bytes before the body of a record: opcode and length.
pub(crate) const RECORD_HEAD: u64 = 9;

/// Bytes of a chunk's body without the name of the compression and the records: two times, a size, a checksum, and two
/// lengths.
const CHUNK_HEAD: usize = 8 + 8 + 8 + 4 + 4 + 8;

/// Bytes of a chunk that are read at once.
const AT_ONCE: u64 = 1 << 26;
/// Upper bound of zstd's compression ratio: a block of 128 kB takes at least four bytes.
const LARGEST_RATIO: u64 = 1 << 15;

/// Where a chunk lies in the file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct ChunkPlace {
    /// The whole record, including its header.
    pub bytes: Range<u64>,
    /// First and last time of its messages, in nanoseconds.
    pub times: (u64, u64),
}

/// A chunk in memory. It is reused, so that its buffers are allocated once.
#[derive(Default)]
pub(crate) struct Chunk {
    compressed: Vec<u8>,
    records: Vec<u8>,
    /// Created on first use: its tables are larger than many frames.
    decompressor: Option<Decompressor<'static>>,
    channels: Vec<mcap::records::Channel>,
    messages: Vec<(MessageHeader, Range<usize>)>,
    /// Only redundant copies have these.
    metadata: Vec<Metadata>,
    header: Option<Header>,
}

/// Why a chunk cannot be used.
#[derive(Debug)]
pub(crate) enum ChunkError {
    /// The bytes differ from those that were written.
    Damaged,
    /// Reading failed.
    Io(io::Error),
}

impl Chunk {
    /// Reads the chunk whose record fills `bytes` of the file; returns the first and last time of its messages.
    pub fn read(
        &mut self,
        file: &mut (impl Read + Seek),
        bytes: Range<u64>,
    ) -> Result<(u64, u64), ChunkError> {
        self.load_bytes(file, bytes)?;
        self.unpack().ok_or(ChunkError::Damaged)
    }

    /// Reads the redundant copy whose record fills `bytes` of the file.
    pub fn read_copy(&mut self, file: &mut (impl Read + Seek), bytes: Range<u64>) -> Result<(), ChunkError> {
        self.load_bytes(file, bytes)?;
        self.unpack_copy().ok_or(ChunkError::Damaged)
    }

    /// Replaces the contents of memory by these bytes of the file.
    fn load_bytes(&mut self, file: &mut (impl Read + Seek), bytes: Range<u64>) -> Result<(), ChunkError> {
        self.messages.clear();
        self.channels.clear();
        self.metadata.clear();
        self.header = None;
        file.seek(SeekFrom::Start(bytes.start)).map_err(ChunkError::Io)?;
        self.fetch(file, bytes.end.saturating_sub(bytes.start)).map_err(ChunkError::Io)
    }

    /// Reads `length` bytes, or as many as the file has.
    fn fetch(&mut self, file: &mut impl Read, length: u64) -> io::Result<()> {
        // A damaged index may state any length; up to `AT_ONCE` an allocation costs little.
        let at_once = length.min(AT_ONCE) as usize;
        // `resize` without `clear`: the read overwrites all bytes.
        self.compressed.resize(at_once, 0);
        let mut read = 0;
        while read < at_once {
            match file.read(&mut self.compressed[read..]) {
                Ok(0) => break,
                Ok(count) => read += count,
                Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
                Err(error) => return Err(error),
            }
        }
        self.compressed.truncate(read);
        if read == at_once {
            file.take(length - at_once as u64).read_to_end(&mut self.compressed)?;
        }
        Ok(())
    }

    /// The channels that this chunk introduces.
    pub fn channels(&self) -> &[mcap::records::Channel] {
        &self.channels
    }

    /// The metadata records in a redundant copy.
    pub fn metadata(&self) -> &[Metadata] {
        &self.metadata
    }

    /// The header record of the file, from a redundant copy.
    pub fn header(&self) -> Option<&Header> {
        self.header.as_ref()
    }

    /// The messages in order.
    pub fn messages(&self) -> impl Iterator<Item = (&MessageHeader, &[u8])> {
        self.messages.iter().map(|(header, range)| (header, &self.records[range.clone()]))
    }

    /// The message of a channel at a time.
    pub fn message(&self, channel: u16, log_time: u64) -> Option<&[u8]> {
        let mut messages = self.messages();
        messages
            .find(|(head, _)| head.channel_id == channel && head.log_time == log_time)
            .map(|(_, data)| data)
    }

    /// The last of several messages of a channel at one time.
    pub fn last_message(&self, channel: u16, log_time: u64) -> Option<&[u8]> {
        let at = self.messages().filter(|(head, _)| head.channel_id == channel && head.log_time == log_time);
        at.last().map(|(_, data)| data)
    }

    /// Verifies and decompresses `compressed`; `None` when anything differs from what was written.
    fn unpack(&mut self) -> Option<(u64, u64)> {
        let (&opcode, body) = self.compressed.split_first()?;
        let (length, body) = body.split_first_chunk::<8>()?;
        if opcode != op::CHUNK || u64::from_le_bytes(*length) != body.len() as u64 {
            return None;
        }
        let Ok(Record::Chunk { header, data }) = mcap::parse_record(opcode, body) else { return None };
        // A length that is too large would hide the records that follow.
        if body.len() != CHUNK_HEAD + header.compression.len() + data.len() {
            return None;
        }
        self.records.clear();
        match header.compression.as_str() {
            "zstd" => decompress(&mut self.decompressor, &data, header.uncompressed_size, &mut self.records)?,
            "" => self.records.extend_from_slice(&data),
            _ => return None,
        }
        let whole = self.records.len() as u64 == header.uncompressed_size;
        if !whole || crc32fast::hash(&self.records) != header.uncompressed_crc {
            return None;
        }
        self.list_records(0..self.records.len())?;
        let times = self.messages.iter().map(|(head, _)| head.log_time);
        let times = (times.clone().min().unwrap_or(0), times.max().unwrap_or(0));
        (times == (header.message_start_time, header.message_end_time)).then_some(times)
    }

    /// Verifies and decompresses the attachment in `compressed`; `None` when it is no redundant copy or is damaged.
    fn unpack_copy(&mut self) -> Option<()> {
        let (&opcode, body) = self.compressed.split_first()?;
        let (length, body) = body.split_first_chunk::<8>()?;
        let (body, sum) = body.split_last_chunk::<4>()?;
        let is_whole = u64::from_le_bytes(*length) == body.len() as u64 + 4;
        if opcode != op::ATTACHMENT || !is_whole || crc32fast::hash(body) != u32::from_le_bytes(*sum) {
            return None;
        }
        // Two times, name and media type, and the data with its length.
        let (name, rest) = word(body.get(16..)?)?;
        let (_, rest) = word(rest)?;
        let data = rest.get(8..)?;
        if name != redundant_copies::NAME.as_bytes() {
            return None;
        }
        let most = (data.len() as u64).saturating_mul(LARGEST_RATIO);
        byte_shuffle::unpack(data, most, &mut self.records).ok()?;
        let records = self.records.strip_prefix(MAGIC)?.strip_suffix(MAGIC)?.len();
        self.list_records(MAGIC.len()..MAGIC.len() + records)
    }

    /// Lists the messages, channels and metadata records.
    fn list_records(&mut self, mut rest: Range<usize>) -> Option<()> {
        while let Some((opcode, body)) = next_record(&self.records, &mut rest) {
            if !matches!(opcode, op::HEADER | op::CHANNEL | op::MESSAGE | op::METADATA) {
                continue;
            }
            let data = &self.records[body.clone()];
            match mcap::parse_record(opcode, data).ok()? {
                Record::Message { header, data } => {
                    self.messages.push((header, body.end - data.len()..body.end));
                }
                Record::Channel(channel) => self.channels.push(channel),
                Record::Metadata(record) => self.metadata.push(record),
                Record::Header(header) => self.header = Some(header),
                _ => {}
            }
        }
        rest.is_empty().then_some(())
    }
}

/// Decompresses `data` into `out`. `stated` is the decompressed length; longer data is an error.
fn decompress(
    decompressor: &mut Option<Decompressor<'static>>,
    data: &[u8],
    stated: u64,
    out: &mut Vec<u8>,
) -> Option<()> {
    if stated / LARGEST_RATIO > data.len() as u64 {
        return None;
    }
    out.try_reserve_exact(usize::try_from(stated).ok()?).ok()?;
    if decompressor.is_none() {
        *decompressor = Decompressor::new().ok();
    }
    decompressor.as_mut()?.decompress_to_buffer(data, out).ok()?;
    Some(())
}

/// The text at the start of `bytes`, which its length precedes, and the bytes that follow.
fn word(bytes: &[u8]) -> Option<(&[u8], &[u8])> {
    let (length, rest) = bytes.split_first_chunk::<4>()?;
    rest.split_at_checked(u32::from_le_bytes(*length) as usize)
}

/// Opcode and body of the record at the start of `rest`, which then begins behind it. `None` where no whole record is
/// left.
pub(crate) fn next_record(bytes: &[u8], rest: &mut Range<usize>) -> Option<(u8, Range<usize>)> {
    let (&opcode, after) = bytes[rest.clone()].split_first()?;
    let (length, after) = after.split_first_chunk::<8>()?;
    let length = usize::try_from(u64::from_le_bytes(*length)).ok().filter(|&length| length <= after.len())?;
    let begin = rest.start + RECORD_HEAD as usize;
    rest.start = begin + length;
    Some((opcode, begin..rest.start))
}
