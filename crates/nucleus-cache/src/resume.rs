//! Going on with a cache: what is kept is copied into a file beside it, frames that it already has are solved again and
//! held to it, and only when all of them are there does the new file take the place of the growing one.

use std::fs::File;
use std::io::{BufReader, Seek, Write};
use std::path::Path;

use crate::attribute::{CONTACTS, STRAIN};
use crate::object::{ObjectInfo, Source};
use crate::open_error::{OpenError, ReadError};
use crate::playback::{Playback, file_at};
use crate::record_error::RecordError;
use crate::recorder::{Recorder, check};
use crate::run::RunInfo;
use crate::target::{self, Places, Target};
use crate::witness::Witness;
use crate::{checkpoint, topology};

/// Which frames of an older cache a run goes on from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Kept {
    /// Frames up to this one are copied. The older cache has a checkpoint of it, or it is the start frame, or the one
    /// before that: then nothing is copied, and the start is recorded anew.
    pub copied: i32,
    /// Frames up to this one are solved again and held to what the older cache has; later ones are dropped.
    pub compared: i32,
}

impl Playback {
    /// Opens a cache to go on with it: as [`open`](Self::open), but no two can.
    ///
    /// # Errors
    /// As [`open`](Self::open), and when a run is writing it.
    pub fn open_to_resume(path: impl AsRef<Path>) -> Result<Self, OpenError> {
        let path = path.as_ref();
        let file = file_at(path)?;
        if target::is_locked(&file) {
            return Err(OpenError::InUse { path: path.to_owned() });
        }
        Self::read(BufReader::new(file))
    }
}

impl Recorder<File> {
    /// Goes on with `old` in a cache at `path`, which may be where `old` is: with `replace` another cache there may be
    /// replaced too. `kept` frames are taken over; the next to be recorded is the one after [`Kept::copied`].
    ///
    /// The file grows as `.resuming` until it has all that is to be kept, and from then on as any that is recorded. Till
    /// then nothing that was there is touched.
    ///
    /// # Errors
    /// As [`create`](Self::create), and when `old` cannot be read.
    pub fn resume(
        path: impl AsRef<Path>,
        replace: bool,
        run: &RunInfo,
        objects: Vec<(Source, ObjectInfo)>,
        mut old: Playback,
        kept: Kept,
    ) -> Result<Self, RecordError> {
        check(run, &objects)?;
        let Target { file, places } = target::beside(path.as_ref(), replace)?;
        let begun = Self::to_writer(file, run, objects)
            .and_then(|mut recorder| recorder.take_over(&mut old, kept.copied).map(|()| recorder));
        let mut recorder = match begun {
            Ok(recorder) => recorder,
            Err(error) => {
                places.give_up();
                return Err(error);
            }
        };
        recorder.places = Some(places);
        recorder.witness = Some(Box::new(Witness::new(old, kept.compared)));
        recorder.catch_up()?;
        Ok(recorder)
    }
}

impl<W: Write + Seek> Recorder<W> {
    /// Once all that is to be kept is there, puts the file in its place as one that grows.
    pub(crate) fn catch_up(&mut self) -> Result<(), RecordError> {
        let Some(witness) = &mut self.witness else { return Ok(()) };
        match witness.has_seen_all(self.last_frame) {
            Ok(false) => return Ok(()),
            Ok(true) => {}
            Err(error) => {
                self.places.iter().for_each(Places::give_up);
                return Err(error);
            }
        }
        let (frames, bytes) = self.stream.progress();
        let failed = |source| RecordError::Write { frames, bytes, source };
        self.places.iter_mut().try_for_each(Places::take_over).map_err(failed)?;
        self.witness = None;
        Ok(())
    }

    /// Copies all frames up to `last`, with the checkpoints that a run without a stop would have made.
    fn take_over(&mut self, old: &mut Playback, last: i32) -> Result<(), RecordError> {
        for index in 0..old.contents.chunks.len() {
            if old.run().frame_at(old.contents.chunks[index].times.1) > last {
                continue;
            }
            match old.load(index) {
                Ok(()) => self.copy_chunk(old)?,
                // A checkpoint; frames up to `last` are sound.
                Err(ReadError::Damaged { .. }) => {}
                Err(error) => return Err(RecordError::Original { source: error }),
            }
        }
        self.last_frame = last.max(self.run.start);
        Ok(())
    }

    /// Copies the chunk in memory.
    fn copy_chunk(&mut self, old: &Playback) -> Result<(), RecordError> {
        let mut is_frame = false;
        let mut is_empty = true;
        for (header, data) in old.chunk.messages() {
            let Some(channel) = old.contents.channels.get(&header.channel_id) else { continue };
            match channel.message_encoding.as_str() {
                topology::ENCODING => {
                    if !self.follow_mesh(&channel.topic, data) {
                        continue; // The first, which was sent already.
                    }
                }
                checkpoint::ENCODING => {
                    let Some(found) = checkpoint::read(data) else { continue };
                    for (track, &has_moved) in self.tracks.iter_mut().zip(&found.has_moved) {
                        track.has_moved = has_moved;
                    }
                    if found.is_last {
                        continue;
                    }
                    self.checkpointed = Some(found.frame);
                }
                _ => is_frame = true,
            }
            let Some(own) = self.channel_of(&channel.topic) else { continue };
            self.stream.copy(own, header, data)?;
            is_empty = false;
        }
        if is_frame {
            self.moments += 1;
            return self.stream.close_frame();
        }
        if is_empty { Ok(()) } else { self.stream.close_chunk() }
    }

    /// The channel of a topic; nothing where there is none here.
    fn channel_of(&self, topic: &str) -> Option<u16> {
        match topic {
            "/report" => Some(self.report_channel),
            checkpoint::TOPIC => self.checkpoint_channel,
            _ => {
                let (name, what) = topic.strip_prefix('/')?.rsplit_once('/')?;
                let track = self.tracks.iter().find(|track| track.name == name)?;
                match what {
                    "points" => Some(track.channel),
                    "topology" => Some(track.mesh_channel),
                    _ if what == CONTACTS.topic => track.contacts,
                    _ if what == STRAIN.topic => track.strain.as_ref().map(|(channel, _)| *channel),
                    _ => None,
                }
            }
        }
    }
}
