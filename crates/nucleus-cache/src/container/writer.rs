//! Writes the MCAP file of a cache: gathers messages into a chunk until the frame is closed.

use std::collections::BTreeMap;
use std::io::{self, BufWriter, Seek, SeekFrom, Write};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use mcap::records::{MessageHeader, Metadata};
use mcap::{Compression, McapResult, WriteOptions, Writer};

use crate::container::redundant_copies::RedundantCopies;
use crate::error::{RecordError, cause};
use crate::messages::attribute::{self, Attribute};
use crate::messages::metadata::{LIBRARY, PROFILE};
use crate::messages::points::{self, Stamp};
use crate::messages::{checkpoint, topology};
use crate::run::Packing;

/// Level 3 makes files 1 % smaller than level 1 at the same speed.
const FAST: u32 = 3;
/// The highest level that does not increase the reader's memory.
const SMALL: u32 = 19;

/// Writes an MCAP file. Every error states the frames and bytes written so far.
pub(crate) struct CacheWriter<W: Write + Seek> {
    writer: Writer<BufWriter<CountingWriter<W>>>,
    progress: Progress,
    sequence: u32,
    copies: RedundantCopies,
}

/// Schema ids of a cache, by encoding.
pub(crate) struct Schemas(Vec<(&'static str, u16)>);

impl Schemas {
    /// The schema of an encoding; 0, which means none, for encodings without a schema.
    pub fn of(&self, encoding: &str) -> u16 {
        self.0.iter().find(|(name, _)| *name == encoding).map_or(0, |&(_, schema)| schema)
    }
}

/// Frames and bytes written so far.
struct Progress {
    frames: u32,
    length: Arc<AtomicU64>,
}

impl<W: Write + Seek> CacheWriter<W> {
    /// Begins a file in an empty `target`.
    pub fn create(target: W, packing: Packing) -> Result<Self, RecordError> {
        let (counting_writer, length) = CountingWriter::new(target);
        let progress = Progress { frames: 0, length };
        let writer = progress.check(options(packing).create(BufWriter::new(counting_writer)))?;
        let copies = progress.check(RedundantCopies::new())?;
        Ok(Self { writer, progress, sequence: 0, copies })
    }

    pub fn metadata(&mut self, record: &Metadata) -> Result<(), RecordError> {
        self.progress.check(self.writer.write_metadata(record))?;
        self.progress.check(self.copies.metadata(record))
    }

    /// Adds a schema as plain text.
    pub fn schema(&mut self, name: &str, text: &str) -> Result<u16, RecordError> {
        self.progress.check(self.writer.add_schema(name, "text", text.as_bytes()))
    }

    /// Adds the schemas of a cache: those of the attributes it uses, and that of checkpoints if it has any.
    pub fn own_schemas(
        &mut self,
        uses: impl Fn(&Attribute) -> bool,
        checkpoints: bool,
    ) -> Result<Schemas, RecordError> {
        let own = [(topology::ENCODING, topology::SCHEMA), (points::ENCODING, points::SCHEMA)];
        let attributes =
            attribute::ALL.into_iter().filter(|one| uses(one)).map(|one| (one.encoding, one.schema));
        let checkpoint = checkpoints.then_some((checkpoint::ENCODING, checkpoint::SCHEMA));
        let schema = |(name, text)| Ok((name, self.schema(name, text)?));
        let all = own.into_iter().chain(attributes).chain(checkpoint);
        Ok(Schemas(all.map(schema).collect::<Result<_, RecordError>>()?))
    }

    pub fn channel(&mut self, topic: &str, schema: u16, encoding: &str) -> Result<u16, RecordError> {
        let id = self.progress.check(self.writer.add_channel(schema, topic, encoding, &BTreeMap::new()))?;
        self.progress.check(self.copies.channel(id, topic, encoding))?;
        Ok(id)
    }

    /// Declares that messages of a channel hold until the next, so that they need redundant copies.
    pub fn hold(&mut self, channel: u16) {
        self.copies.hold(channel);
    }

    pub fn send(&mut self, stamp: &Stamp, channel: u16, message: &[u8]) -> Result<(), RecordError> {
        self.sequence = self.sequence.wrapping_add(1);
        let header = stamp.header(channel, self.sequence);
        self.write(&header, message)
    }

    /// Copies a message from another file.
    pub fn copy(&mut self, channel: u16, header: &MessageHeader, message: &[u8]) -> Result<(), RecordError> {
        self.sequence = self.sequence.wrapping_add(1);
        let header = MessageHeader { channel_id: channel, sequence: self.sequence, ..*header };
        self.write(&header, message)
    }

    fn write(&mut self, header: &MessageHeader, message: &[u8]) -> Result<(), RecordError> {
        self.progress.check(self.writer.write_to_known_channel(header, message))?;
        self.progress.check(self.copies.message(header, message))
    }

    /// Closes the chunk of a frame and hands it to the system, so that a kill loses only the next frame.
    pub fn close_frame(&mut self) -> Result<(), RecordError> {
        self.close_chunk()?;
        self.progress.frames += 1;
        self.progress.check(self.copies.end_frame(&mut self.writer))?;
        self.close_chunk()
    }

    /// Closes a chunk that holds no frame.
    pub fn close_chunk(&mut self) -> Result<(), RecordError> {
        self.progress.check(self.writer.flush())
    }

    /// Frames and bytes so far.
    pub fn progress(&self) -> (u32, u64) {
        (self.progress.frames, self.progress.bytes())
    }

    /// Writes the index; returns frames and bytes.
    pub fn finish(mut self) -> Result<(u32, u64), RecordError> {
        self.progress.check(self.copies.finish(&mut self.writer))?;
        self.progress.check(self.writer.finish())?;
        self.progress.check(self.writer.into_inner().flush().map_err(Into::into))?;
        Ok((self.progress.frames, self.progress.bytes()))
    }
}

impl Progress {
    fn bytes(&self) -> u64 {
        self.length.load(Ordering::Relaxed)
    }

    fn check<T>(&self, result: McapResult<T>) -> Result<T, RecordError> {
        result.map_err(|error| RecordError::Write {
            frames: self.frames,
            bytes: self.bytes(),
            source: cause(error),
        })
    }
}

/// One chunk per flush, compressed on the calling thread: the same run gives the same bytes.
fn options(packing: Packing) -> WriteOptions {
    let level = match packing {
        Packing::Fast => FAST,
        Packing::Small => SMALL,
    };
    WriteOptions::new()
        .profile(PROFILE)
        .library(LIBRARY)
        .compression(Some(Compression::Zstd))
        .compression_level(level)
        .compression_threads(0)
        .chunk_size(None)
}

/// Counting writer: its length can be read from outside while it is in use.
pub(crate) struct CountingWriter<W> {
    inner: W,
    position: u64,
    length: Arc<AtomicU64>,
}

impl<W> CountingWriter<W> {
    /// Wraps `inner`, which must be empty. The returned counter outlives the writer.
    pub fn new(inner: W) -> (Self, Arc<AtomicU64>) {
        let length = Arc::new(AtomicU64::new(0));
        (Self { inner, position: 0, length: length.clone() }, length)
    }
}

impl<W: Write> Write for CountingWriter<W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let written = self.inner.write(bytes)?;
        self.position += written as u64;
        self.length.fetch_max(self.position, Ordering::Relaxed);
        Ok(written)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.inner.flush()
    }
}

impl<W: Seek> Seek for CountingWriter<W> {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        self.position = self.inner.seek(to)?;
        Ok(self.position)
    }
}
