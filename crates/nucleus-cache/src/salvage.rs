//! Finding the frames of a file without a sound index by walking through it and checking each.

use std::io::{self, Read, Seek, SeekFrom};

use mcap::MAGIC;
use mcap::records::{Record, op};

use crate::chunk::{Chunk, ChunkFault, ChunkPlace, RECORD_HEAD};
use crate::contents::Contents;
use crate::loss::Loss;

/// The contents up to the last whole record, and what lies behind it.
///
/// Reads every frame once, so it takes as long as reading the file.
pub(crate) fn read(file: &mut (impl Read + Seek), length: u64) -> io::Result<(Contents, Loss)> {
    let mut contents = Contents::default();
    let mut chunk = Chunk::default();
    let mut position = MAGIC.len() as u64;
    while let Some((opcode, end)) = record_at(file, position, length)? {
        match opcode {
            op::DATA_END => return Ok((contents, Loss { index: true, ..Loss::default() })),
            op::CHUNK => match chunk.read(file, position..end) {
                Ok(times) => contents.add_chunk(ChunkPlace { bytes: position..end, times }, &chunk),
                Err(ChunkFault::Damaged) => {} // Its frame is missing in the end, and named as such.
                Err(ChunkFault::Io(error)) => return Err(error),
            },
            op::METADATA => contents.metadata.extend(read_metadata(file, position, end)?),
            _ => {}
        }
        position = end;
    }
    Ok((contents, Loss { cut_off: true, bytes: length - position, ..Loss::default() }))
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
