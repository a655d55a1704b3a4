//! Replay check: compares frames that are solved again with those of an older cache of the same run.

use crate::error::RecordError;
use crate::messages::points::Stamp;
use crate::read::playback::Playback;

/// The older cache, and the last frame to compare.
pub(crate) struct ReplayCheck {
    old: Playback,
    until: i32,
    differs: Option<RecordError>,
}

impl ReplayCheck {
    pub fn new(old: Playback, until: i32) -> Self {
        Self { old, until, differs: None }
    }

    /// Compares a message with the recorded one. A message that the older cache lacks or cannot read is no difference.
    pub fn compare(&mut self, stamp: &Stamp, object: &str, topic: &str, message: &[u8]) {
        if stamp.frame > self.until || self.differs.is_some() {
            return;
        }
        let file_index = &self.old.file_index;
        let Some(channel) = file_index.channel(&format!("/{object}/{topic}")) else { return };
        let time = stamp.log_time();
        let Some((_, chunk)) = file_index.latest(channel, time).filter(|&(found, _)| found == time) else {
            return;
        };
        if self.old.load(chunk).is_err() {
            return;
        }
        if self.old.chunk.message(channel, time).is_some_and(|recorded| recorded != message) {
            self.differs =
                Some(RecordError::ReplayMismatch { frame: stamp.frame, object: object.to_owned() });
        }
    }

    /// Whether all frames up to the last one are compared after `frame`.
    ///
    /// # Errors
    /// When a message differed from the recorded one.
    pub fn is_complete(&mut self, frame: i32) -> Result<bool, RecordError> {
        self.differs.take().map_or(Ok(frame >= self.until), Err)
    }

    /// The last frame to compare.
    pub fn until(&self) -> i32 {
        self.until
    }
}
