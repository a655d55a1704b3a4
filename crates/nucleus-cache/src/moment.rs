//! The moments of a run that were recorded, and the frames that were not.

use std::collections::BTreeSet;

use crate::contents::Contents;
use crate::run::RunInfo;

/// A moment that was recorded.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RecordedMoment {
    /// The frame it belongs to.
    pub frame: i32,
    /// Its place among the recorded moments of its frame, counted from 1; 0 is the initial state.
    pub substep: u32,
    /// How many moments of the frame were recorded: 1, unless substeps were.
    pub substeps: u32,
    /// Seconds since the start frame.
    pub time: f64,
    pub(crate) log_time: u64,
}

impl RecordedMoment {
    /// Whether this is how the frame looks in the end.
    pub fn ends_frame(&self) -> bool {
        self.substep == self.substeps || self.substep == 0
    }
}

/// All moments at which any of `channels` has a message, in order of time.
pub(crate) fn list(run: &RunInfo, contents: &Contents, channels: &[u16]) -> Vec<RecordedMoment> {
    let times = channels.iter().filter_map(|channel| contents.messages.get(channel)).flatten();
    let times: BTreeSet<u64> = times.map(|&(time, _)| time).collect();
    let times: Vec<(i32, u64)> = times.into_iter().map(|time| (run.frame_at(time), time)).collect();
    let mut moments = Vec::with_capacity(times.len());
    for frame_times in times.chunk_by(|a, b| a.0 == b.0) {
        let substeps = frame_times.len() as u32;
        moments.extend((1..).zip(frame_times).map(|(place, &(frame, log_time))| RecordedMoment {
            frame,
            substep: if log_time == 0 { 0 } else { place },
            substeps,
            time: log_time as f64 * 1e-9,
            log_time,
        }));
    }
    moments
}

/// Frames up to the last recorded one that have no moment.
pub(crate) fn missing(run: &RunInfo, moments: &[RecordedMoment]) -> Vec<i32> {
    let frames: BTreeSet<i32> = moments.iter().map(|moment| moment.frame).collect();
    let last = frames.last().copied().unwrap_or(run.start).min(run.end);
    let expected = (run.start..=last).filter(|&frame| run.detail.takes(frame, run.start, run.end));
    expected.filter(|frame| !frames.contains(frame)).collect()
}
