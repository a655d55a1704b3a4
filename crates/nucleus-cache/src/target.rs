//! The file a run is recorded to: made anew, or put in the place of an older cache, and of nothing else.

use std::fs::File;
use std::io::{self, ErrorKind, Read};
use std::path::Path;

use mcap::MAGIC;
use mcap::records::{Record, op};

use crate::provenance::PROFILE;
use crate::record_error::RecordError;

/// Makes the file, after a look at what is there.
pub(crate) fn create(path: &Path) -> Result<File, RecordError> {
    let failed = |source| RecordError::Create { path: path.to_owned(), source };
    match path.metadata() {
        Err(error) if error.kind() == ErrorKind::NotFound => {}
        Err(error) => return Err(failed(error)),
        Ok(found) if !found.is_file() => return Err(RecordError::NotAFile { path: path.to_owned() }),
        Ok(found) if found.len() == 0 => {}
        Ok(_) if is_cache(path).map_err(failed)? => {}
        Ok(_) => return Err(RecordError::NotOurs { path: path.to_owned() }),
    }
    File::create(path).map_err(failed)
}

/// Whether the file begins as a cache does.
fn is_cache(path: &Path) -> io::Result<bool> {
    let mut head = Vec::new();
    File::open(path)?.take(4096).read_to_end(&mut head)?;
    Ok(read_header(&head).is_some_and(|(profile, _)| profile == PROFILE))
}

/// Profile and library from the first bytes of an MCAP file.
pub(crate) fn read_header(head: &[u8]) -> Option<(String, String)> {
    let record = head.strip_prefix(MAGIC)?;
    let (&opcode, record) = record.split_first()?;
    let (length, body) = record.split_first_chunk::<8>()?;
    let body = body.get(..usize::try_from(u64::from_le_bytes(*length)).ok()?)?;
    match (opcode == op::HEADER).then(|| mcap::parse_record(opcode, body))? {
        Ok(Record::Header(header)) => Some((header.profile, header.library)),
        _ => None,
    }
}
