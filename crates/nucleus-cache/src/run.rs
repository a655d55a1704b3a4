//! Metadata of a run, its objects, and the conversion between frames and times.

use std::collections::BTreeMap;

use nucleus_core::{ClothId, ColliderId, Faces, SubstepIndex};

use crate::camera::Camera;
use crate::face_sets::FaceSets;
use crate::selections::SelectedPoints;
use crate::texture_coordinates::TextureCoordinates;

/// Which states of the run are recorded.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Detail {
    /// The end of each frame.
    #[default]
    Frames,
    /// The end of each substep.
    Substeps,
    /// The end of every n-th frame after the start frame, and of the last frame.
    Every(u32),
}

impl Detail {
    /// Whether the end of `frame` is recorded in a run from `start` to `end`.
    pub(crate) fn includes(self, frame: i32, start: i32, end: i32) -> bool {
        match self {
            Self::Every(n) => {
                frame == end || (i64::from(frame) - i64::from(start)) % i64::from(n.max(1)) == 0
            }
            Self::Frames | Self::Substeps => true,
        }
    }
}

/// Compression level of a cache. Both levels are lossless.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Packing {
    /// Fast: level 3 of zstd.
    #[default]
    Fast,
    /// Small: a tenth smaller than `Fast` at a hundred times the cost, since the low bits of a float do not compress.
    Small,
}

/// The ground plane, in scene units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Plane {
    /// A point on the plane.
    pub origin: [f64; 3],
    /// Normal of the plane.
    pub normal: [f64; 3],
}

/// Metadata of a run.
#[derive(Debug, Clone, PartialEq)]
pub struct RunInfo {
    /// Path of the scene file, as given.
    pub scene_path: String,
    /// Text of that file.
    pub scene_text: String,
    /// The frame of the initial state.
    pub start: i32,
    /// The last requested frame; a run that was interrupted ends sooner.
    pub end: i32,
    /// Frames per second; converts frames to message times.
    pub frames_per_second: f64,
    /// Scene units per metre (100 for centimetres); recorded positions are in scene units.
    pub units_per_metre: f64,
    /// Which states are recorded.
    pub detail: Detail,
    /// Frames from one solved frame to the next, counted from the start frame; the last frame is solved too.
    pub interval: u32,
    /// Whether velocities are recorded, in scene units per second. Doubles the size.
    pub velocities: bool,
    /// Whether the contact state of each cloth point is recorded.
    pub contacts: bool,
    /// Whether the strain at each cloth point is recorded. It can also be computed from positions and rest meshes.
    pub strain: bool,
    /// Whether particles have looks of their own, which are then recorded: radius, opacity and colours.
    pub looks: bool,
    /// Whether contact turns particles, whose orientations are then recorded.
    pub rotation: bool,
    /// Whether particles have numbers, ages, lifespans and masses of their own, which are then recorded.
    pub particles: bool,
    /// The ground plane, if the scene uses one.
    pub ground: Option<Plane>,
    /// The ground plane at each frame from the start frame on; empty if it does not move.
    pub ground_motion: Vec<Plane>,
    /// Particle radius of each particle object, by object name, in scene units.
    pub radii: BTreeMap<String, f64>,
    /// Distance of the particles of each liquid at rest, by object name, in scene units.
    pub rest_distances: BTreeMap<String, f64>,
    /// The shape of the surface of each particle object that states one, by object name.
    pub surfaces: BTreeMap<String, SurfaceShape>,
    /// Cameras of the scene; the first is the default for pictures.
    pub cameras: Vec<Camera>,
    /// Texture coordinates of each object that has any, by object name.
    pub texture_coordinates: BTreeMap<String, TextureCoordinates>,
    /// Groups and materials of the faces of each object that has any, by object name.
    pub face_sets: BTreeMap<String, FaceSets>,
    /// The points that constraints name.
    pub selections: Vec<SelectedPoints>,
    /// Frames between two checkpoints; 0 records none.
    pub checkpoint: u32,
    /// Compression level; a reader accepts both.
    pub packing: Packing,
    /// The version of Nucleus that wrote the cache; the recorder sets it.
    pub version: String,
    /// Further metadata. Keys that the format defines are ignored when writing.
    pub extra: BTreeMap<String, String>,
}

/// How the surface of particles follows from them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SurfaceShape {
    /// The density at the surface (`threshold`): sparser particles have none. A particle on its own has a density of 1.
    pub threshold: f32,
    /// Factor on the radius that a particle has on its own (`blobbyRadiusScale`).
    pub radius_scale: f32,
}

impl SurfaceShape {
    /// Maya's defaults.
    pub const DEFAULT: Self = Self { threshold: 0.1, radius_scale: 1.0 };
}

impl Default for RunInfo {
    /// An unnamed scene at 24 frames per second, in metres, with the start frame only.
    fn default() -> Self {
        Self {
            scene_path: String::new(),
            scene_text: String::new(),
            start: 1,
            end: 1,
            frames_per_second: 24.0,
            units_per_metre: 1.0,
            detail: Detail::Frames,
            interval: 1,
            velocities: false,
            contacts: false,
            strain: false,
            looks: false,
            rotation: false,
            particles: false,
            ground: None,
            ground_motion: Vec::new(),
            radii: BTreeMap::new(),
            rest_distances: BTreeMap::new(),
            surfaces: BTreeMap::new(),
            cameras: Vec::new(),
            texture_coordinates: BTreeMap::new(),
            face_sets: BTreeMap::new(),
            selections: Vec::new(),
            checkpoint: 0,
            packing: Packing::Fast,
            version: env!("CARGO_PKG_VERSION").to_owned(),
            extra: BTreeMap::new(),
        }
    }
}

impl RunInfo {
    /// The reason why this description cannot be recorded, if there is one.
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
        if self.interval == 0 {
            return Some("every 0th frame cannot be solved".to_owned());
        }
        positive("frames per second", self.frames_per_second)
            .or_else(|| positive("units per metre", self.units_per_metre))
            .or_else(backwards)
    }

    /// The ground plane at a time in frames, linear between two frames; the last plane holds for all later frames.
    pub fn ground_at(&self, frame: f64) -> Option<Plane> {
        let place = (frame - f64::from(self.start)).max(0.0);
        let plane = |index: usize| self.ground_motion.get(index).or(self.ground_motion.last()).copied();
        let Some(before) = plane(place as usize) else { return self.ground };
        let (after, share) = (plane(place as usize + 1).unwrap_or(before), place.fract());
        let between = |a: [f64; 3], b: [f64; 3]| std::array::from_fn(|k| a[k] + (b[k] - a[k]) * share);
        let Plane { origin, normal } = after;
        Some(Plane { origin: between(before.origin, origin), normal: between(before.normal, normal) })
    }

    /// Whether the run solves `frame` and records its end.
    pub(crate) fn expects(&self, frame: i32) -> bool {
        [self.detail, Detail::Every(self.interval)]
            .iter()
            .all(|detail| detail.includes(frame, self.start, self.end))
    }

    /// Seconds from the start frame to the end of a substep of the interval between two solved frames.
    pub(crate) fn time(&self, [from, to]: [i32; 2], SubstepIndex { substep, substeps }: SubstepIndex) -> f64 {
        let [before, length] = [[self.start, from], [from, to]].map(|[a, b]| f64::from(b) - f64::from(a));
        let share = f64::from(substep) / f64::from(substeps.max(1));
        (before + length * share) / self.frames_per_second
    }

    /// Frames from the solved frame before `frame` to it.
    pub fn interval_before(&self, frame: i32) -> u32 {
        let interval = self.interval.max(1);
        match (i64::from(frame) - i64::from(self.start)).rem_euclid(i64::from(interval)) as u32 {
            0 => interval,
            rest => rest, // the last frame
        }
    }

    /// Seconds from the start frame to the end of `frame`.
    pub(crate) fn end_time(&self, frame: i32) -> f64 {
        (f64::from(frame) - f64::from(self.start)) / self.frames_per_second
    }

    /// The frame that a message of this time belongs to: of a substep, the next one that is solved.
    pub(crate) fn frame_at(&self, log_time: u64) -> i32 {
        // Times are rounded to nanoseconds; a substep is far longer than this tolerance.
        let frames = (log_time as f64 * 1e-9 * self.frames_per_second - 1e-6).ceil() as i32;
        if self.detail != Detail::Substeps || self.interval <= 1 {
            return self.start.saturating_add(frames);
        }
        let interval = i64::from(self.interval);
        let solved =
            i64::from(self.start) + (i64::from(frames) + interval - 1).div_euclid(interval) * interval;
        // The last frame is solved whether its turn has come or not.
        let last = self.start.saturating_add(frames).max(self.end);
        i32::try_from(solved).unwrap_or(last).min(last)
    }
}

/// Cosine of 50 degrees: faces of a collider whose normals differ by more meet in a hard edge. The player has the same number.
pub const COS_HARD_EDGE: f32 = 0.643;

/// The role of an object in the solver.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ObjectKind {
    /// A simulated surface.
    Cloth,
    /// A surface that cloth collides with.
    Collider,
    /// Simulated points without faces.
    Particles,
}

/// One object of a run.
#[derive(Debug, Clone, PartialEq)]
pub struct ObjectInfo {
    /// Name in the scene: any characters, unique in the run.
    pub name: String,
    /// Its role in the solver.
    pub kind: ObjectKind,
    /// Faces; corners index the points.
    pub faces: Faces,
    /// Rest positions in scene units, one per point.
    pub rest: Vec<[f32; 3]>,
}

impl ObjectInfo {
    /// Whether every face refers to existing points.
    pub(crate) fn is_valid(&self) -> bool {
        self.faces.corners().iter().all(|&point| (point as usize) < self.rest.len())
    }
}

/// Where the recorder reads an object's positions from the solver's state.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Source {
    /// A cloth.
    Cloth(ClothId),
    /// A collider; it is recorded only in frames in which it moves.
    Collider(ColliderId),
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn a_moving_ground_plane_is_linear_between_frames_and_holds_at_the_end() {
        let at = |height: f64| Plane { origin: [0.0, height, 0.0], normal: [0.0, 1.0, 0.0] };
        let ground_motion = vec![at(0.0), at(2.0), at(8.0)];
        let run = RunInfo { start: 5, ground: Some(at(0.0)), ground_motion, ..RunInfo::default() };
        for (frame, height) in [(4.0, 0.0), (5.0, 0.0), (5.5, 1.0), (6.0, 2.0), (7.0, 8.0), (9.5, 8.0)] {
            assert_eq!(run.ground_at(frame), Some(at(height)));
        }
        assert_eq!(RunInfo { ground: Some(at(3.0)), ..RunInfo::default() }.ground_at(9.0), Some(at(3.0)));
    }

    proptest! {
        #[test]
        fn a_time_names_its_frame(
            start in -1000_i32..1000, after in 1_i32..100_000, substeps in 1_u32..500, share in 0.0..1.0_f64,
            fps in 1.0..120.0_f64,
        ) {
            let run = RunInfo { start, end: start, frames_per_second: fps, ..RunInfo::default() };
            let substep = 1 + (share * f64::from(substeps - 1)) as u32;
            let interval = [start + after - 1, start + after];
            let time = run.time(interval, SubstepIndex { substep, substeps });
            prop_assert_eq!(run.frame_at((time * 1e9).round() as u64), start + after);
        }

        #[test]
        fn a_time_within_an_interval_names_the_frame_that_ends_it(
            start in -1000_i32..1000, length in 1_i32..1000, interval in 1_u32..9, substeps in 1_u32..50,
        ) {
            let end = start + length;
            let run = RunInfo { start, end, interval, detail: Detail::Substeps, ..RunInfo::default() };
            let mut from = start;
            for to in (start + 1..=end).filter(|&frame| run.expects(frame)) {
                for substep in 1..=substeps {
                    let time = run.time([from, to], SubstepIndex { substep, substeps });
                    prop_assert_eq!(run.frame_at((time * 1e9).round() as u64), to);
                }
                from = to;
            }
        }
    }
}
