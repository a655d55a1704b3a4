//! Finding the frames of a file without a sound index by walking through it and checking each.

use std::io::{self, Read, Seek, SeekFrom};

use mcap::MAGIC;
use mcap::records::{Record, op};

use crate::chunk::{Chunk, ChunkFault, ChunkPlace, RECORD_HEAD};
use crate::contents::Contents;
use crate::loss::Loss;
use crate::provenance::is_sound;

/// Marks by which a record is found again behind damage: bytes, how many stand before them in the record, and its kind.
const MARKS: [(&[u8], u64, u8); 3] = [
    // The compression, behind two times, a size and a checksum.
    (b"\x04\0\0\0zstd", RECORD_HEAD + 28, op::CHUNK),
    // The name of what is known of the run, behind its length.
    (b"nucleus.", RECORD_HEAD + 4, op::METADATA),
    // The name of a copy, behind two times and its length.
    (b"nucleus.copy", RECORD_HEAD + 20, op::ATTACHMENT),
];
/// Bytes that are searched at once.
const PIECE: u64 = 1 << 20;
/// The longest body of a record that is read only to see whether it is sound.
const LONGEST: u64 = 1 << 28;

/// A record as its head states it.
#[derive(Clone, Copy)]
struct Place {
    opcode: u8,
    begin: u64,
    end: u64,
}

/// All whole records, and what lies between and behind them.
///
/// Reads every frame once, so it takes as long as reading the file. The stated end of a record is believed only if the
/// record proves to be sound. Behind any other the next one is searched for by its mark.
pub(crate) fn read(file: &mut (impl Read + Seek), length: u64) -> io::Result<(Contents, Loss)> {
    let mut contents = Contents::default();
    let mut chunk = Chunk::default();
    let mut position = MAGIC.len() as u64;
    let mut loss = Loss { cut_off: true, ..Loss::default() };
    // Where the last sound record ends: what lies behind it belongs to none.
    let mut sound = position.min(length);
    loop {
        let record = record_at(file, position, length)?;
        if let Some(place) = record.filter(|place| place.opcode == op::DATA_END)
            && is_followed_by_index(file, place, length)?
        {
            loss = Loss { index: true, ..Loss::default() };
            break;
        }
        let is_taken = match record {
            Some(place) => take(file, place, &mut contents, &mut chunk)?,
            None => false,
        };
        match record.filter(|_| is_taken) {
            Some(place) => (position, sound) = (place.end, place.end),
            None => match next_mark(file, position + 1, length)? {
                Some(found) => position = found,
                None => break,
            },
        }
    }
    contents.has_read_copies();
    if loss.cut_off {
        loss.bytes = length - sound;
    }
    Ok((contents, loss))
}

/// Adds what a record holds; false when it is not sound.
fn take(
    file: &mut (impl Read + Seek),
    place: Place,
    contents: &mut Contents,
    chunk: &mut Chunk,
) -> io::Result<bool> {
    let Place { opcode, begin, end } = place;
    let sound = match opcode {
        op::CHUNK => chunk.read(file, begin..end).map(|times| {
            contents.add_chunk(ChunkPlace { bytes: begin..end, times }, chunk);
        }),
        op::ATTACHMENT => chunk.read_copy(file, begin..end).map(|()| contents.add_copy(begin..end, chunk)),
        op::HEADER | op::METADATA | op::MESSAGE_INDEX if end - begin <= LONGEST => {
            return take_small(file, place, contents);
        }
        _ => return Ok(false),
    };
    match sound {
        Ok(()) => Ok(true),
        // Its frame is missing in the end, and named as such.
        Err(ChunkFault::Damaged) => Ok(false),
        Err(ChunkFault::Io(error)) => Err(error),
    }
}

/// The same for a record that is no larger than it has to be.
fn take_small(file: &mut (impl Read + Seek), place: Place, contents: &mut Contents) -> io::Result<bool> {
    let mut body = Vec::new();
    file.seek(SeekFrom::Start(place.begin + RECORD_HEAD))?;
    file.take(place.end - place.begin - RECORD_HEAD).read_to_end(&mut body)?;
    Ok(match mcap::parse_record(place.opcode, &body) {
        Ok(Record::Header(header)) => body.len() == 8 + header.profile.len() + header.library.len(),
        // Channel and length, then a time and a place each.
        Ok(Record::MessageIndex(index)) => body.len() == 6 + 16 * index.records.len(),
        Ok(Record::Metadata(record)) => {
            let texts = record.metadata.iter().map(|(key, value)| 8 + key.len() + value.len());
            let has_length = body.len() == 8 + record.name.len() + texts.sum::<usize>();
            let is_sound = has_length && is_sound(&record);
            // One that is not may still say that it is of a later version.
            if record.name.starts_with("nucleus.") {
                contents.add_metadata(record);
            }
            is_sound
        }
        _ => false,
    })
}

/// Whether a record is the end of the frames: it has the length for it, and the index or the end of the file follows.
fn is_followed_by_index(file: &mut (impl Read + Seek), place: Place, length: u64) -> io::Result<bool> {
    let next = record_at(file, place.end, length)?;
    let is_index =
        |next: Place| matches!(next.opcode, op::FOOTER..=op::CHANNEL | op::CHUNK_INDEX..=op::SUMMARY_OFFSET);
    Ok(place.end - place.begin == RECORD_HEAD + 4 && next.is_none_or(is_index))
}

/// Where the next record begins that looks like one of the kinds that have a mark, from `position` on.
fn next_mark(file: &mut (impl Read + Seek), position: u64, length: u64) -> io::Result<Option<u64>> {
    let longest = MARKS.iter().map(|(mark, ..)| mark.len()).max().unwrap_or(0) as u64;
    let mut begin = position;
    let mut bytes = Vec::new();
    while begin < length {
        bytes.clear();
        file.seek(SeekFrom::Start(begin))?;
        file.take(PIECE).read_to_end(&mut bytes)?;
        for at in 0..bytes.len() {
            let marks = MARKS.iter().filter(|(mark, ..)| bytes[at..].starts_with(mark));
            for &(_, before, opcode) in marks {
                let start = (begin + at as u64).checked_sub(before).filter(|&start| start >= position);
                let Some(start) = start else { continue };
                if record_at(file, start, length)?.is_some_and(|found| found.opcode == opcode) {
                    return Ok(Some(start));
                }
            }
        }
        if (bytes.len() as u64) < PIECE {
            break;
        }
        // A mark may lie across two pieces.
        begin += PIECE - longest;
    }
    Ok(None)
}

/// The record at `position`; nothing when it reaches past the end of the file.
fn record_at(file: &mut (impl Read + Seek), position: u64, length: u64) -> io::Result<Option<Place>> {
    if position + RECORD_HEAD > length {
        return Ok(None);
    }
    let mut head = [0; RECORD_HEAD as usize];
    file.seek(SeekFrom::Start(position))?;
    file.read_exact(&mut head)?;
    let body = u64::from_le_bytes(head[1..].try_into().expect("eight bytes"));
    let end = (position + RECORD_HEAD).checked_add(body).filter(|&end| end <= length);
    Ok(end.map(|end| Place { opcode: head[0], begin: position, end }))
}
