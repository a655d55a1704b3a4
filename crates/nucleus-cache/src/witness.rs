//! An older cache of the same run, to which frames that are solved again are held.

use crate::playback::Playback;
use crate::points::Stamp;
use crate::record_error::RecordError;

/// What was recorded before, up to a frame.
pub(crate) struct Witness {
    old: Playback,
    until: i32,
    differs: Option<RecordError>,
}

impl Witness {
    pub fn new(old: Playback, until: i32) -> Self {
        Self { old, until, differs: None }
    }

    /// Looks at a message that is about to be recorded. What the older cache has not, or cannot read, is no difference.
    pub fn see(&mut self, stamp: &Stamp, object: &str, what: &str, message: &[u8]) {
        if stamp.frame > self.until || self.differs.is_some() {
            return;
        }
        let contents = &self.old.contents;
        let Some(channel) = contents.channel(&format!("/{object}/{what}")) else { return };
        let time = stamp.log_time();
        let Some((_, chunk)) = contents.latest(channel, time).filter(|&(found, _)| found == time) else {
            return;
        };
        if self.old.load(chunk).is_err() {
            return;
        }
        if self.old.chunk.message(channel, time).is_some_and(|recorded| recorded != message) {
            self.differs = Some(RecordError::Differs { frame: stamp.frame, object: object.to_owned() });
        }
    }

    /// Whether nothing is left to be seen after a frame.
    ///
    /// # Errors
    /// When something was not as it was before.
    pub fn has_seen_all(&mut self, frame: i32) -> Result<bool, RecordError> {
        self.differs.take().map_or(Ok(frame >= self.until), Err)
    }

    /// The frame up to which it looks.
    pub fn until(&self) -> i32 {
        self.until
    }
}
