//! What a run is: which scene, which frames, which units, and how frames become times.

use std::collections::BTreeMap;

use crate::camera::Camera;

/// How finely time is recorded.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Detail {
    /// The end of each frame.
    #[default]
    Frames,
    /// The end of each substep.
    Substeps,
    /// The end of every so manieth frame after the start, and of the last.
    Every(u32),
}

impl Detail {
    /// Whether the end of `frame` is recorded in a run from `start` to `end`.
    pub(crate) fn takes(self, frame: i32, start: i32, end: i32) -> bool {
        match self {
            Self::Every(n) => {
                frame == end || (i64::from(frame) - i64::from(start)) % i64::from(n.max(1)) == 0
            }
            Self::Frames | Self::Substeps => true,
        }
    }
}

/// How much time is spent on making a cache small. Nothing is ever lost.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Packing {
    /// As fast as a disk.
    #[default]
    Fast,
    /// A tenth smaller, at a hundred times the time: what is noise in a float cannot be packed.
    Small,
}

/// A plane that everything rests on, in scene units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Plane {
    /// A point of it.
    pub origin: [f64; 3],
    /// Its normal.
    pub normal: [f64; 3],
}

/// What a cache says about the run it holds.
#[derive(Debug, Clone, PartialEq)]
pub struct RunInfo {
    /// The file the scene was read from, as it was given.
    pub scene_path: String,
    /// The text of that file.
    pub scene_text: String,
    /// The frame of the initial state.
    pub start: i32,
    /// The last frame that was asked for; the run may have ended sooner.
    pub end: i32,
    /// Frames per second; fixes the times of the messages.
    pub frames_per_second: f64,
    /// Units of the recorded positions that make a metre (100 for centimetres).
    pub units_per_metre: f64,
    /// How finely time is recorded.
    pub detail: Detail,
    /// Whether velocities follow the positions (units per second). Doubles the size.
    pub velocities: bool,
    /// Whether it is told how contact stands at each point of cloth.
    pub contacts: bool,
    /// Whether the strain at each point of cloth follows. Whoever has positions can find it again.
    pub strain: bool,
    /// The ground plane, if the scene uses one.
    pub ground: Option<Plane>,
    /// Radius of the particles of each object that has some, by its name, in scene units.
    pub radii: BTreeMap<String, f64>,
    /// The cameras of the scene; a picture is taken by the first, if nobody says otherwise.
    pub cameras: Vec<Camera>,
    /// Frames from one checkpoint to the next; at 0 there is none.
    pub checkpoint: u32,
    /// How much time is spent on making the file small. Any reader reads both.
    pub packing: Packing,
    /// The version of Nucleus that wrote the cache. A recorder sets it.
    pub version: String,
    /// Anything else worth keeping. Keys of the format itself are ignored when writing.
    pub extra: BTreeMap<String, String>,
}

impl Default for RunInfo {
    /// An unnamed scene of 24 frames a second in metres, only its start frame.
    fn default() -> Self {
        Self {
            scene_path: String::new(),
            scene_text: String::new(),
            start: 1,
            end: 1,
            frames_per_second: 24.0,
            units_per_metre: 1.0,
            detail: Detail::Frames,
            velocities: false,
            contacts: false,
            strain: false,
            ground: None,
            radii: BTreeMap::new(),
            cameras: Vec::new(),
            checkpoint: 0,
            packing: Packing::Fast,
            version: env!("CARGO_PKG_VERSION").to_owned(),
            extra: BTreeMap::new(),
        }
    }
}

impl RunInfo {
    /// Why nothing can be recorded under this description, if so.
    pub(crate) fn fault(&self) -> Option<String> {
        let positive = |name: &str, x: f64| {
            (!(x.is_finite() && x > 0.0)).then(|| format!("{name} must be above zero and finite, not {x}"))
        };
        let backwards = || {
            (self.end < self.start).then(|| format!("frame {} ends before frame {}", self.end, self.start))
        };
        if self.detail == Detail::Every(0) {
            return Some("every 0th frame cannot be recorded".to_owned());
        }
        positive("frames per second", self.frames_per_second)
            .or_else(|| positive("units per metre", self.units_per_metre))
            .or_else(backwards)
    }

    /// Seconds from the start frame to the end of `substep` of `substeps` in `frame`.
    pub(crate) fn time(&self, frame: i32, substep: u32, substeps: u32) -> f64 {
        let frames = f64::from(frame) - f64::from(self.start) - 1.0;
        (frames + f64::from(substep) / f64::from(substeps.max(1))) / self.frames_per_second
    }

    /// The frame in which a message of this time was recorded.
    pub(crate) fn frame_at(&self, log_time: u64) -> i32 {
        // Times are rounded to nanoseconds; substeps are far longer than the slack given here.
        let frames = (log_time as f64 * 1e-9 * self.frames_per_second - 1e-6).ceil();
        self.start.saturating_add(frames as i32)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn a_time_names_its_frame(
            start in -1000_i32..1000, after in 1_i32..100_000, substeps in 1_u32..500, share in 0.0..1.0_f64,
            fps in 1.0..120.0_f64,
        ) {
            let run = RunInfo { start, end: start, frames_per_second: fps, ..RunInfo::default() };
            let substep = 1 + (share * f64::from(substeps - 1)) as u32;
            let time = run.time(start + after, substep, substeps);
            prop_assert_eq!(run.frame_at((time * 1e9).round() as u64), start + after);
        }
    }
}
