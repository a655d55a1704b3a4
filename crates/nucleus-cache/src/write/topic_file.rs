//! An MCAP file of topics in public schemas, for third-party viewers.

use std::collections::BTreeMap;
use std::io::{BufWriter, Seek, Write};

use mcap::records::MessageHeader;
use mcap::{Compression, WriteOptions, Writer};

use crate::error::{RecordError, cause};

/// Writes messages of any schema. Its MCAP profile is empty, which marks it as no cache.
pub struct TopicFile<W: Write + Seek> {
    writer: Writer<BufWriter<W>>,
    sequence: u32,
}

impl<W: Write + Seek> TopicFile<W> {
    /// Begins a file in an empty `target`.
    ///
    /// # Errors
    /// When writing fails; this holds for all methods.
    pub fn to_writer(target: W) -> Result<Self, RecordError> {
        let options = WriteOptions::new()
            .library(concat!("nucleus ", env!("CARGO_PKG_VERSION")))
            .compression(Some(Compression::Zstd))
            .compression_threads(0)
            .chunk_size(None);
        let writer = options.create(BufWriter::new(target)).map_err(failed)?;
        Ok(Self { writer, sequence: 0 })
    }

    /// Adds a schema: its name, its encoding (such as `protobuf`), and its bytes.
    pub fn schema(&mut self, name: &str, encoding: &str, bytes: &[u8]) -> Result<u16, RecordError> {
        self.writer.add_schema(name, encoding, bytes).map_err(failed)
    }

    /// Adds a topic whose messages use `schema`.
    pub fn channel(&mut self, topic: &str, schema: u16, encoding: &str) -> Result<u16, RecordError> {
        self.writer.add_channel(schema, topic, encoding, &BTreeMap::new()).map_err(failed)
    }

    /// Adds a message at a time in nanoseconds.
    pub fn send(&mut self, channel: u16, time: u64, message: &[u8]) -> Result<(), RecordError> {
        self.sequence = self.sequence.wrapping_add(1);
        let header = MessageHeader {
            channel_id: channel,
            sequence: self.sequence,
            log_time: time,
            publish_time: time,
        };
        self.writer.write_to_known_channel(&header, message).map_err(failed)
    }

    /// Closes the chunk, so that viewers can seek to the next one.
    pub fn close_chunk(&mut self) -> Result<(), RecordError> {
        self.writer.flush().map_err(failed)
    }

    /// Writes the index.
    pub fn finish(mut self) -> Result<(), RecordError> {
        self.writer.finish().map_err(failed)?;
        self.writer.into_inner().flush().map_err(|source| RecordError::Export { source })
    }
}

fn failed(error: mcap::McapError) -> RecordError {
    RecordError::Export { source: cause(error) }
}
