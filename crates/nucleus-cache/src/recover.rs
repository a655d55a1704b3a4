//! A sound file from what survives of a damaged one.

use std::io::{Read, Seek, Write};

use crate::attribute::Attribute;
use crate::open_error::ReadError;
use crate::playback::Playback;
use crate::record_error::RecordError;
use crate::run::Packing;
use crate::stream::Stream;

/// What was saved.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Recovered {
    /// Chunks, which are frames, that were copied.
    pub frames: usize,
    /// Chunks that were left out, as they are damaged.
    pub damaged: usize,
    /// Size of the new file in bytes.
    pub bytes: u64,
}

/// Why nothing could be saved.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum RecoverError {
    /// The damaged file cannot be read.
    #[error("reading failed")]
    Read(#[from] ReadError),
    /// The new one cannot be written.
    #[error("writing failed")]
    Write(#[from] RecordError),
}

impl<R: Read + Seek> Playback<R> {
    /// Writes everything that is sound into an empty `target`, as a cache that is whole: every message of every
    /// frame that can be read, bit for bit, the channels, and what is known of the run. Fills in what is lost.
    ///
    /// # Errors
    /// When the system fails to read or write.
    pub fn recover<W: Write + Seek>(&mut self, target: W) -> Result<Recovered, RecoverError> {
        let mut stream = Stream::create(target, Packing::Fast)?;
        for record in &self.contents.metadata {
            stream.metadata(record)?;
        }
        let uses = |one: &Attribute| {
            self.contents.channels.values().any(|channel| channel.message_encoding == one.encoding)
        };
        let schemas = stream.own_schemas(uses, self.contents.checkpoints().next().is_some())?;
        let mut ids = std::collections::BTreeMap::new();
        for channel in self.contents.channels.values() {
            let schema = schemas.of(&channel.message_encoding);
            ids.insert(channel.id, stream.channel(&channel.topic, schema, &channel.message_encoding)?);
        }
        let mut recovered = Recovered { frames: 0, damaged: 0, bytes: 0 };
        for index in 0..self.contents.chunks.len() {
            match self.load(index) {
                Ok(()) => {}
                Err(ReadError::Damaged { frame }) => {
                    recovered.damaged += 1;
                    self.note_damage(index, frame);
                    continue;
                }
                Err(error) => return Err(error.into()),
            }
            for (header, data) in self.chunk.messages() {
                if let Some(&channel) = ids.get(&header.channel_id) {
                    stream.copy(channel, header, data)?;
                }
            }
            if self.contents.is_checkpoint(index) {
                stream.close_chunk()?;
                continue;
            }
            stream.close_frame()?;
            recovered.frames += 1;
        }
        self.loss.in_order();
        (_, recovered.bytes) = stream.finish()?;
        Ok(recovered)
    }
}
