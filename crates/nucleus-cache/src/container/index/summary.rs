//! Reads the index from the summary section of a finished file, without reading its frames.

use std::collections::BTreeSet;
use std::io::{self, Read, Seek, SeekFrom};
use std::ops::Range;

use mcap::MAGIC;
use mcap::records::{ChunkIndex, MetadataIndex, Record, op};
use mcap::sans_io::{LinearReadEvent, LinearReader, LinearReaderOptions};

use crate::container::chunk::{Chunk, ChunkPlace, RECORD_HEAD, next_record};
use crate::container::index::FileIndex;
use crate::container::redundant_copies;

/// The footer, which states where the summary section begins, and the magic bytes after it.
const FOOTER: u64 = RECORD_HEAD + 20 + MAGIC.len() as u64;
/// The record between the last chunk and the summary section.
const DATA_END: u64 = RECORD_HEAD + 4;

/// Channel and length of a message index; time and offset of each message in it.
const MESSAGE_INDEX_HEAD: usize = 6;
const MESSAGE_INDEX_ENTRY: usize = 16;

/// The index; `None` when the file has no summary section, its checksum fails, or it contradicts the file.
pub(crate) fn read(file: &mut (impl Read + Seek), length: u64) -> Option<FileIndex> {
    let begin = index_begin(file, length).ok()??;
    let mut file_index = FileIndex::default();
    let mut chunks = Vec::new();
    let mut metadata = Vec::new();
    each_record(file, begin, length, |record| match record {
        Record::Channel(channel) => {
            file_index.channels.insert(channel.id, channel);
        }
        Record::ChunkIndex(index) => chunks.push(index),
        Record::MetadataIndex(index) => metadata.push(index),
        Record::AttachmentIndex(index) if index.name == redundant_copies::NAME => {
            file_index.copies.places.push(index.offset..index.offset.saturating_add(index.length));
        }
        _ => {}
    })?;
    for index in chunks {
        add_chunk(file, &index, begin, &mut file_index)?;
    }
    for MetadataIndex { offset, length, .. } in metadata {
        // A damaged record is detected later and read from a redundant copy.
        let (opcode, body) = first_record(&read_range(file, offset, length, begin)?).unwrap_or_default();
        if opcode == op::METADATA
            && let Ok(Record::Metadata(record)) = mcap::parse_record(opcode, &body)
        {
            file_index.add_metadata(record);
        }
    }
    Some(file_index)
}

/// End of the data section, from the footer; `None` when the file does not end in a footer.
fn index_begin(file: &mut (impl Read + Seek), length: u64) -> io::Result<Option<u64>> {
    let Some(begin) = length.checked_sub(FOOTER) else { return Ok(None) };
    let mut footer = [0; FOOTER as usize];
    file.seek(SeekFrom::Start(begin))?;
    file.read_exact(&mut footer)?;
    if footer[0] != op::FOOTER || !footer.ends_with(MAGIC) {
        return Ok(None);
    }
    let index = u64::from_le_bytes(footer[9..17].try_into().expect("eight bytes"));
    // The checksum of the summary section begins behind the data end record.
    Ok(index.checked_sub(DATA_END).filter(|&data_end| data_end < begin))
}

/// Visits all records of the summary section and verifies its checksum.
fn each_record(
    file: &mut (impl Read + Seek),
    begin: u64,
    length: u64,
    mut visit: impl FnMut(Record<'static>),
) -> Option<()> {
    let options = LinearReaderOptions::default()
        .with_skip_start_magic(true)
        .with_validate_summary_section_crc(true)
        .with_record_length_limit(usize::try_from(length - begin).ok()?);
    let mut reader = LinearReader::new_with_options(options);
    file.seek(SeekFrom::Start(begin)).ok()?;
    while let Some(event) = reader.next_event() {
        match event.ok()? {
            LinearReadEvent::ReadRequest(wanted) => {
                let read = file.read(reader.insert(wanted)).ok()?;
                reader.notify_read(read);
            }
            LinearReadEvent::Record { opcode, data } => {
                visit(mcap::parse_record(opcode, data).ok()?.into_owned());
            }
        }
    }
    Some(())
}

/// Adds a chunk by its message index; if that is invalid, by reading the chunk; if that fails, by its entry in the
/// summary section, so that no older message is taken for a lost one.
fn add_chunk(
    file: &mut (impl Read + Seek),
    index: &ChunkIndex,
    end: u64,
    file_index: &mut FileIndex,
) -> Option<()> {
    let bytes = index.chunk_start_offset..index.chunk_start_offset.checked_add(index.chunk_length)?;
    let times = (index.message_start_time, index.message_end_time);
    let place = ChunkPlace { bytes: bytes.clone(), times };
    let indexes = read_range(file, bytes.end, index.message_index_length, end)?;
    if let Some(messages) = messages(&indexes, index) {
        file_index.add_messages(place, messages);
        return Some(());
    }
    let mut chunk = Chunk::default();
    match chunk.read(file, bytes) {
        Ok(_) => file_index.add_chunk(place, &chunk),
        Err(_) => {
            let ends = index.message_index_offsets.keys().map(|&channel| (channel, index.message_end_time));
            file_index.add_messages(place, ends.collect::<Vec<_>>());
        }
    }
    Some(())
}

/// Channels and times of a chunk's messages. `None` when they contradict the chunk index or are not evenly spaced:
/// message indexes have no checksum of their own.
fn messages(indexes: &[u8], chunk: &ChunkIndex) -> Option<Vec<(u16, u64)>> {
    let mut rest = 0..indexes.len();
    let mut channels = BTreeSet::new();
    let mut messages = Vec::new();
    while let Some((opcode, body)) = next_record(indexes, &mut rest) {
        let length = body.len();
        let Ok(Record::MessageIndex(index)) = mcap::parse_record(opcode, &indexes[body]) else { return None };
        if length != MESSAGE_INDEX_HEAD + MESSAGE_INDEX_ENTRY * index.records.len() {
            return None;
        }
        channels.insert(index.channel_id);
        messages.extend(index.records.iter().map(|entry| (index.channel_id, entry.log_time)));
    }
    let times: BTreeSet<u64> = messages.iter().map(|&(_, time)| time).collect();
    let sound = rest.is_empty()
        && are_evenly_spaced(&times, chunk.message_start_time, chunk.message_end_time)
        && channels.iter().eq(chunk.message_index_offsets.keys());
    sound.then_some(messages)
}

/// Whether the times begin and end as stated and are evenly spaced up to rounding.
fn are_evenly_spaced(times: &BTreeSet<u64>, start: u64, end: u64) -> bool {
    let distances = || times.iter().zip(times.iter().skip(1)).map(|(time, next)| next - time);
    let (shortest, longest) = (distances().min().unwrap_or(0), distances().max().unwrap_or(0));
    times.first() == Some(&start) && times.last() == Some(&end) && longest - shortest <= 2
}

/// Bytes of the file, where they lie before `end`.
fn read_range(file: &mut (impl Read + Seek), begin: u64, length: u64, end: u64) -> Option<Vec<u8>> {
    begin.checked_add(length).filter(|&last| last <= end)?;
    let mut bytes = vec![0; usize::try_from(length).ok()?];
    file.seek(SeekFrom::Start(begin)).ok()?;
    file.read_exact(&mut bytes).ok()?;
    Some(bytes)
}

fn first_record(bytes: &[u8]) -> Option<(u8, Vec<u8>)> {
    let (opcode, body): (u8, Range<usize>) = next_record(bytes, &mut (0..bytes.len()))?;
    Some((opcode, bytes[body].to_vec()))
}
