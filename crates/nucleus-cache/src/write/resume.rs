//! Resumes a run from its cache. Frames before the checkpoint are copied into a new file beside the cache. Frames after
//! it are solved again and compared with the recorded ones. The new file replaces the partial cache only when it has
//! all recorded frames.

use std::fs::File;
use std::io::{BufReader, Seek, Write};
use std::path::Path;

use crate::container::part_file::{self, PartFile, PartPaths};
use crate::error::{OpenError, ReadError, RecordError};
use crate::messages::attribute::{CONTACTS, LOOKS, PARTICLES, ROTATION, STRAIN};
use crate::messages::{checkpoint, topology};
use crate::read::playback::{Playback, file_at};
use crate::run::{ObjectInfo, RunInfo, Source};
use crate::write::recorder::{Recorder, check};
use crate::write::replay_check::ReplayCheck;

/// Which frames of an older cache a resumed run copies and replays.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ResumeRange {
    /// Frames up to this one are copied. It has a checkpoint, or it is the start frame, or the frame before the start;
    /// in the last case nothing is copied and the start is recorded again.
    pub copied: i32,
    /// Frames up to this one are solved again and compared with the older cache; later ones are dropped.
    pub compared: i32,
}

impl Playback {
    /// Opens a cache to resume from it: as [`open`](Self::open), with an exclusive lock.
    ///
    /// # Errors
    /// As [`open`](Self::open), and when a run is writing the cache.
    pub fn open_to_resume(path: impl AsRef<Path>) -> Result<Self, OpenError> {
        let path = path.as_ref();
        let file = file_at(path)?;
        if part_file::is_locked(&file) {
            return Err(OpenError::InUse { path: path.to_owned() });
        }
        Self::read(BufReader::new(file))
    }
}

impl Recorder<File> {
    /// Resumes the run of `old` in a cache at `path`, which may be the path of `old`. With `replace`, another cache at
    /// `path` may be replaced. The next frame to record is the one after [`ResumeRange::copied`].
    ///
    /// The file grows as `.resuming` until it has all frames of `range`, and from then on as `.part`. Until then no
    /// existing file is touched.
    ///
    /// # Errors
    /// As [`create`](Self::create), and when `old` cannot be read.
    pub fn resume(
        path: impl AsRef<Path>,
        replace: bool,
        run: &RunInfo,
        objects: Vec<(Source, ObjectInfo)>,
        mut old: Playback,
        range: ResumeRange,
    ) -> Result<Self, RecordError> {
        check(run, &objects)?;
        let PartFile { file, paths } = part_file::create_for_resume(path.as_ref(), replace)?;
        let begun = Self::to_writer(file, run, objects)
            .and_then(|mut recorder| recorder.copy_frames(&mut old, range.copied).map(|()| recorder));
        let mut recorder = match begun {
            Ok(recorder) => recorder,
            Err(error) => {
                paths.remove();
                return Err(error);
            }
        };
        recorder.paths = Some(paths);
        recorder.replay_check = Some(Box::new(ReplayCheck::new(old, range.compared)));
        recorder.finish_replay()?;
        Ok(recorder)
    }
}

impl<W: Write + Seek> Recorder<W> {
    /// Once all frames are replayed, renames the file to the path of a partial cache.
    pub(crate) fn finish_replay(&mut self) -> Result<(), RecordError> {
        let Some(replay_check) = &mut self.replay_check else { return Ok(()) };
        match replay_check.is_complete(self.last_frame) {
            Ok(false) => return Ok(()),
            Ok(true) => {}
            Err(error) => {
                self.paths.iter().for_each(PartPaths::remove);
                return Err(error);
            }
        }
        let (frames, bytes) = self.writer.progress();
        let failed = |source| RecordError::Write { frames, bytes, source };
        self.paths.iter_mut().try_for_each(PartPaths::promote).map_err(failed)?;
        self.replay_check = None;
        Ok(())
    }

    /// Copies all frames up to `last`, with the checkpoints that an uninterrupted run would have.
    fn copy_frames(&mut self, old: &mut Playback, last: i32) -> Result<(), RecordError> {
        for index in 0..old.file_index.chunks.len() {
            if old.run().frame_at(old.file_index.chunks[index].times.1) > last {
                continue;
            }
            match old.load(index) {
                Ok(()) => self.copy_chunk(old)?,
                // A damaged checkpoint; frames up to `last` are readable.
                Err(ReadError::Damaged { .. }) => {}
                Err(error) => return Err(RecordError::Original { source: error }),
            }
        }
        self.last_frame = last.max(self.run.start);
        Ok(())
    }

    /// Copies the loaded chunk.
    fn copy_chunk(&mut self, old: &Playback) -> Result<(), RecordError> {
        let mut is_frame = false;
        let mut is_empty = true;
        for (header, data) in old.chunk.messages() {
            let Some(channel) = old.file_index.channels.get(&header.channel_id) else { continue };
            match channel.message_encoding.as_str() {
                topology::ENCODING => {
                    if !self.copy_mesh(&channel.topic, data) {
                        continue; // The first mesh is written already.
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
            self.writer.copy(own, header, data)?;
            is_empty = false;
        }
        if is_frame {
            self.time_samples += 1;
            return self.writer.close_frame();
        }
        if is_empty { Ok(()) } else { self.writer.close_chunk() }
    }

    /// The channel of a topic; `None` when this cache has none.
    fn channel_of(&self, topic: &str) -> Option<u16> {
        match topic {
            "/report" => Some(self.report_channel),
            checkpoint::TOPIC => self.checkpoint_channel,
            _ => {
                let (name, attribute) = topic.strip_prefix('/')?.rsplit_once('/')?;
                let track = self.tracks.iter().find(|track| track.name == name)?;
                match attribute {
                    "points" => Some(track.channel),
                    "topology" => Some(track.mesh_channel),
                    _ if attribute == CONTACTS.topic => track.contacts,
                    _ if attribute == LOOKS.topic => track.looks,
                    _ if attribute == ROTATION.topic => track.rotation,
                    _ if attribute == PARTICLES.topic => track.particles,
                    _ if attribute == STRAIN.topic => track.strain.as_ref().map(|(channel, _)| *channel),
                    _ => None,
                }
            }
        }
    }
}
