//! Time index: the recorded time samples of a run, and the missing frames.

use std::collections::BTreeSet;

use crate::container::index::FileIndex;
use crate::run::RunInfo;

/// A recorded time sample.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TimeSample {
    /// The frame it belongs to.
    pub frame: i32,
    /// Index among the recorded samples of its frame, counted from 1; 0 is the initial state.
    pub substep: u32,
    /// Recorded samples of the frame: 1, unless substeps are recorded.
    pub substeps: u32,
    /// Seconds since the start frame.
    pub time: f64,
    pub(crate) log_time: u64,
}

impl TimeSample {
    /// Whether this is the last sample of its frame.
    pub fn ends_frame(&self) -> bool {
        self.substep == self.substeps || self.substep == 0
    }
}

/// All times at which any of `channels` has a message, in order.
pub(crate) fn list(run: &RunInfo, file_index: &FileIndex, channels: &[u16]) -> Vec<TimeSample> {
    let times = channels.iter().filter_map(|channel| file_index.messages.get(channel)).flatten();
    let times: BTreeSet<u64> = times.map(|&(time, _)| time).collect();
    let times: Vec<(i32, u64)> = times.into_iter().map(|time| (run.frame_at(time), time)).collect();
    let mut time_samples = Vec::with_capacity(times.len());
    for frame_times in times.chunk_by(|a, b| a.0 == b.0) {
        let substeps = frame_times.len() as u32;
        time_samples.extend((1..).zip(frame_times).map(|(place, &(frame, log_time))| TimeSample {
            frame,
            substep: if log_time == 0 { 0 } else { place },
            substeps,
            time: log_time as f64 * 1e-9,
            log_time,
        }));
    }
    time_samples
}

/// Frames up to the last recorded one that the run records and that have no sample.
pub(crate) fn missing(run: &RunInfo, time_samples: &[TimeSample]) -> Vec<i32> {
    let frames: BTreeSet<i32> = time_samples.iter().map(|sample| sample.frame).collect();
    let last = frames.last().copied().unwrap_or(run.start).min(run.end);
    (run.start..=last).filter(|&frame| run.expects(frame) && !frames.contains(&frame)).collect()
}
