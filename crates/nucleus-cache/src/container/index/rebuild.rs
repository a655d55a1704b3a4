//! Index rebuild: scans a file without a valid index for whole chunks and verifies each.

use std::io::{self, Read, Seek, SeekFrom};

use mcap::MAGIC;
use mcap::records::{Record, op};

use crate::container::chunk::{Chunk, ChunkError, ChunkPlace, RECORD_HEAD};
use crate::container::index::FileIndex;
use crate::corruption::CorruptionReport;
use crate::messages::metadata::checksum_holds;

/// Signatures that locate a record behind damage: the bytes, their offset in the record, and the record's opcode.
const SIGNATURES: [(&[u8], u64, u8); 3] = [
    // Name of the compression, behind two times, a size and a checksum.
    (b"\x04\0\0\0zstd", RECORD_HEAD + 28, op::CHUNK),
    // Name prefix of a metadata record, behind its length.
    (b"nucleus.", RECORD_HEAD + 4, op::METADATA),
    // Name of a redundant copy, behind two times and its length.
    (b"nucleus.copy", RECORD_HEAD + 20, op::ATTACHMENT),
];
/// Bytes that are searched at once, at first and at most: signatures may follow each other closely, or not at all.
const SEARCH_BLOCK: [u64; 2] = [1 << 12, 1 << 20];
/// How often the bytes of a file may be read for records that prove invalid: a file may state many that overlap.
const MAX_READS: u64 = 4;
/// Longest body of a small record; a longer one is damaged.
const MAX_SMALL_BODY: u64 = 1 << 28;

/// A record as its header states it.
#[derive(Clone, Copy)]
struct RecordPlace {
    opcode: u8,
    begin: u64,
    end: u64,
}

/// Indexes all whole records.
///
/// Reads every frame once, so it takes as long as reading the file, and a few times that at most. The stated end of a record
/// counts only if the record is valid; behind an invalid one the search continues at the next signature.
pub(crate) fn read(file: &mut (impl Read + Seek), length: u64) -> io::Result<(FileIndex, CorruptionReport)> {
    let mut file_index = FileIndex::default();
    let mut chunk = Chunk::default();
    let mut position = MAGIC.len() as u64;
    let mut corruption = CorruptionReport { truncated: true, ..CorruptionReport::default() };
    // End of the last valid record: the bytes behind it belong to none.
    let mut sound = position.min(length);
    let mut may_waste = length.saturating_mul(MAX_READS);
    loop {
        let record = record_at(file, position, length)?;
        if let Some(place) = record.filter(|place| place.opcode == op::DATA_END)
            && is_followed_by_index(file, place, length)?
        {
            corruption = CorruptionReport { index: true, ..CorruptionReport::default() };
            break;
        }
        let is_taken = match record.filter(|place| place.end - place.begin <= may_waste) {
            Some(place) => {
                let is_valid = add_record(file, place, &mut file_index, &mut chunk)?;
                may_waste -= if is_valid { 0 } else { place.end - place.begin };
                is_valid
            }
            None => false,
        };
        match record.filter(|_| is_taken) {
            Some(place) => (position, sound) = (place.end, place.end),
            None => match next_signature(file, position + 1, length)? {
                Some(found) => position = found,
                None => break,
            },
        }
    }
    file_index.mark_copies_read();
    if corruption.truncated {
        corruption.bytes = length - sound;
    }
    Ok((file_index, corruption))
}

/// Adds the contents of a record; `false` when it is invalid.
fn add_record(
    file: &mut (impl Read + Seek),
    place: RecordPlace,
    file_index: &mut FileIndex,
    chunk: &mut Chunk,
) -> io::Result<bool> {
    let RecordPlace { opcode, begin, end } = place;
    let sound = match opcode {
        op::CHUNK => chunk.read(file, begin..end).map(|times| {
            file_index.add_chunk(ChunkPlace { bytes: begin..end, times }, chunk);
        }),
        op::ATTACHMENT => chunk.read_copy(file, begin..end).map(|()| file_index.add_copy(begin..end, chunk)),
        op::HEADER | op::METADATA | op::MESSAGE_INDEX if end - begin <= MAX_SMALL_BODY => {
            return add_small_record(file, place, file_index);
        }
        _ => return Ok(false),
    };
    match sound {
        Ok(()) => Ok(true),
        // The corruption report lists its frame as missing.
        Err(ChunkError::Damaged) => Ok(false),
        Err(ChunkError::Io(error)) => Err(error),
    }
}

/// Adds a header, metadata or message index record; its body must have exactly the length that its contents need.
fn add_small_record(
    file: &mut (impl Read + Seek),
    place: RecordPlace,
    file_index: &mut FileIndex,
) -> io::Result<bool> {
    let mut body = Vec::new();
    file.seek(SeekFrom::Start(place.begin + RECORD_HEAD))?;
    file.take(place.end - place.begin - RECORD_HEAD).read_to_end(&mut body)?;
    Ok(match mcap::parse_record(place.opcode, &body) {
        Ok(Record::Header(header)) => body.len() == 8 + header.profile.len() + header.library.len(),
        // Channel and length, then time and offset of each message.
        Ok(Record::MessageIndex(index)) => body.len() == 6 + 16 * index.records.len(),
        Ok(Record::Metadata(record)) => {
            let texts = record.metadata.iter().map(|(key, value)| 8 + key.len() + value.len());
            let has_length = body.len() == 8 + record.name.len() + texts.sum::<usize>();
            let is_sound = has_length && checksum_holds(&record);
            // A damaged record may still state a later format version.
            if record.name.starts_with("nucleus.") {
                file_index.add_metadata(record);
            }
            is_sound
        }
        _ => false,
    })
}

/// Whether a record ends the data section: it has the right length, and the index or the end of the file follows.
fn is_followed_by_index(file: &mut (impl Read + Seek), place: RecordPlace, length: u64) -> io::Result<bool> {
    let next = record_at(file, place.end, length)?;
    let is_index = |next: RecordPlace| matches!(next.opcode, op::FOOTER..=op::CHANNEL | op::CHUNK_INDEX..=op::SUMMARY_OFFSET);
    Ok(place.end - place.begin == RECORD_HEAD + 4 && next.is_none_or(is_index))
}

/// Start of the next record with a known signature, from `position` on.
fn next_signature(file: &mut (impl Read + Seek), position: u64, length: u64) -> io::Result<Option<u64>> {
    let longest = SIGNATURES.iter().map(|(mark, ..)| mark.len()).max().unwrap_or(0) as u64;
    let [mut block, most] = SEARCH_BLOCK;
    let mut begin = position;
    let mut bytes = Vec::new();
    while begin < length {
        bytes.clear();
        file.seek(SeekFrom::Start(begin))?;
        file.take(block).read_to_end(&mut bytes)?;
        for at in 0..bytes.len() {
            let marks = SIGNATURES.iter().filter(|(mark, ..)| bytes[at..].starts_with(mark));
            for &(_, before, opcode) in marks {
                let start = (begin + at as u64).checked_sub(before).filter(|&start| start >= position);
                let Some(start) = start else { continue };
                if record_at(file, start, length)?.is_some_and(|found| found.opcode == opcode) {
                    return Ok(Some(start));
                }
            }
        }
        if (bytes.len() as u64) < block {
            break;
        }
        // A signature may lie across two blocks.
        begin += block - longest;
        block = (2 * block).min(most);
    }
    Ok(None)
}

/// The record at `position`; `None` when it reaches past the end of the file.
fn record_at(file: &mut (impl Read + Seek), position: u64, length: u64) -> io::Result<Option<RecordPlace>> {
    if position + RECORD_HEAD > length {
        return Ok(None);
    }
    let mut head = [0; RECORD_HEAD as usize];
    file.seek(SeekFrom::Start(position))?;
    file.read_exact(&mut head)?;
    let body = u64::from_le_bytes(head[1..].try_into().expect("eight bytes"));
    let end = (position + RECORD_HEAD).checked_add(body).filter(|&end| end <= length);
    Ok(end.map(|end| RecordPlace { opcode: head[0], begin: position, end }))
}

#[cfg(test)]
mod tests {
    use std::io::Cursor;

    use super::*;

    /// A file that counts the bytes that are read of it.
    struct Counted {
        file: Cursor<Vec<u8>>,
        bytes: u64,
    }

    impl Read for Counted {
        fn read(&mut self, out: &mut [u8]) -> io::Result<usize> {
            let read = self.file.read(out)?;
            self.bytes += read as u64;
            Ok(read)
        }
    }

    impl Seek for Counted {
        fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
            self.file.seek(to)
        }
    }

    #[test]
    fn heads_of_records_that_are_none_cost_a_few_kilobytes_each() {
        let heads = 4000;
        let mut file = MAGIC.to_vec();
        let length = MAGIC.len() + heads * 25;
        for _ in 0..heads {
            // Metadata whose name and contents reach to the end of the file.
            let body = (length - file.len() - RECORD_HEAD as usize) as u64;
            file.push(op::METADATA);
            file.extend(body.to_le_bytes());
            file.extend(8u32.to_le_bytes());
            file.extend(b"nucleus.");
            file.extend((body as u32).saturating_sub(16).to_le_bytes());
        }
        let mut counted = Counted { file: Cursor::new(file), bytes: 0 };
        let (_, corruption) = read(&mut counted, length as u64).unwrap();
        assert!(corruption.truncated);
        assert!(counted.bytes < 8192 * heads as u64, "{} bytes", counted.bytes);
    }
}
