//! Finding the frames of a file without a sound index by walking through it and checking each.

use std::io::{self, Read, Seek, SeekFrom};

use mcap::MAGIC;
use mcap::records::{Record, op};

use crate::chunk::{Chunk, ChunkFault, ChunkPlace, RECORD_HEAD};
use crate::contents::Contents;
use crate::loss::Loss;

/// All whole records, and what lies between and behind them.
///
/// Reads every frame once, so it takes as long as reading the file. Where a record is damaged its length cannot
/// be trusted either: the next chunk is then looked for by what its head holds.
pub(crate) fn read(file: &mut (impl Read + Seek), length: u64) -> io::Result<(Contents, Loss)> {
    let mut contents = Contents::default();
    let mut chunk = Chunk::default();
    let mut position = MAGIC.len() as u64;
    loop {
        let record = record_at(file, position, length)?;
        let Some((opcode, end)) = record.filter(|(opcode, _)| (op::HEADER..=op::DATA_END).contains(opcode))
        else {
            match next_chunk(file, position + 1, length)? {
                Some(chunk) => position = chunk,
                None => break,
            }
            continue;
        };
        match opcode {
            op::DATA_END => return Ok((contents, Loss { index: true, ..Loss::default() })),
            op::CHUNK => match chunk.read(file, position..end) {
                Ok(times) => contents.add_chunk(ChunkPlace { bytes: position..end, times }, &chunk),
                // Its frame is missing in the end, and named as such.
                Err(ChunkFault::Damaged) => {
                    position = next_chunk(file, position + 1, length)?.unwrap_or(end);
                    continue;
                }
                Err(ChunkFault::Io(error)) => return Err(error),
            },
            op::METADATA => contents.metadata.extend(read_metadata(file, position, end)?),
            _ => {}
        }
        position = end;
    }
    Ok((contents, Loss { cut_off: true, bytes: length - position, ..Loss::default() }))
}

/// Where the next record begins that looks like a chunk, from `position` on.
fn next_chunk(file: &mut (impl Read + Seek), position: u64, length: u64) -> io::Result<Option<u64>> {
    /// The compression, as a chunk's head states it, and what stands before it.
    const MARK: &[u8] = b"\x04\0\0\0zstd";
    const BEFORE: u64 = RECORD_HEAD + 28;
    let mut begin = position;
    let mut bytes = Vec::new();
    while begin < length {
        bytes.clear();
        file.seek(SeekFrom::Start(begin))?;
        file.take(1 << 20).read_to_end(&mut bytes)?;
        for found in bytes.windows(MARK.len()).enumerate().filter(|(_, window)| *window == MARK) {
            let Some(start) = (begin + found.0 as u64).checked_sub(BEFORE).filter(|&start| start >= position)
            else {
                continue;
            };
            if record_at(file, start, length)?.is_some_and(|(opcode, _)| opcode == op::CHUNK) {
                return Ok(Some(start));
            }
        }
        if bytes.len() < 1 << 20 {
            break;
        }
        // A mark may lie across two pieces.
        begin += bytes.len() as u64 - MARK.len() as u64;
    }
    Ok(None)
}

/// Kind and end of the record at `position`; nothing when it reaches past the end of the file.
fn record_at(file: &mut (impl Read + Seek), position: u64, length: u64) -> io::Result<Option<(u8, u64)>> {
    if position + RECORD_HEAD > length {
        return Ok(None);
    }
    let mut head = [0; RECORD_HEAD as usize];
    file.seek(SeekFrom::Start(position))?;
    file.read_exact(&mut head)?;
    let body = u64::from_le_bytes(head[1..].try_into().expect("eight bytes"));
    let end = (position + RECORD_HEAD).checked_add(body).filter(|&end| end <= length);
    Ok(end.map(|end| (head[0], end)))
}

fn read_metadata(
    file: &mut (impl Read + Seek),
    position: u64,
    end: u64,
) -> io::Result<Option<mcap::records::Metadata>> {
    file.seek(SeekFrom::Start(position + RECORD_HEAD))?;
    let mut body = Vec::new();
    file.take(end - position - RECORD_HEAD).read_to_end(&mut body)?;
    match mcap::parse_record(op::METADATA, &body) {
        Ok(Record::Metadata(record)) => Ok(Some(record)),
        _ => Ok(None),
    }
}
