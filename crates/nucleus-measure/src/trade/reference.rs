//! References: the same model in double precision with many more and smaller steps; and the error against them.
//!
//! There are two, of steps h and h/2. The motion of cloth is chaotic: once the two diverge, because a fold falls to one
//! side in one of them and to the other side in the other, the distance of positions measures nothing. The
//! [`Horizon`] is the time until then.

use serde::{Deserialize, Serialize};

use super::benchmark::Benchmark;
use super::run::{Run, RunStates, Trajectory, key};
use super::setting::Setting;
use crate::metrics::deformation::distance;
use crate::result_cache::{ResultCache, ResultCacheError};

/// List of all references of a scene.
const LIST: &str = "references.jsonl";

/// A reference run.
#[derive(Debug, Clone)]
pub struct ReferenceRun {
    /// Its figures per frame.
    pub run: Run,
    /// All frames, in metres.
    pub trajectory: Trajectory,
    /// All objects in the last frame, in scene units.
    pub end: Vec<Vec<[f32; 3]>>,
}

/// The two references of a scene: step h and step h/2.
#[derive(Debug, Clone)]
pub struct References {
    /// Step h.
    pub coarse: ReferenceRun,
    /// Step h/2: errors of runs are measured against it.
    pub fine: ReferenceRun,
    /// Predictability horizon of the two.
    pub horizon: Horizon,
}

/// File format of the positions of all objects.
#[derive(Serialize, Deserialize)]
struct End(Vec<Vec<[f32; 3]>>);

impl References {
    /// Combines both; `size` is the size of the cloth in metres.
    pub fn new(coarse: ReferenceRun, fine: ReferenceRun, size: f64) -> Self {
        let frames = coarse.trajectory.frames().min(fine.trajectory.frames());
        let (mut a, mut b) = (Vec::new(), Vec::new());
        let mut divergence = Vec::with_capacity(frames);
        for frame in 0..frames {
            coarse.trajectory.frame(frame, &mut a);
            fine.trajectory.frame(frame, &mut b);
            divergence.push(distance(&a, &b, size).rms);
        }
        Self { coarse, fine, horizon: Horizon::of(divergence) }
    }
}

impl ReferenceRun {
    /// From a finished run.
    pub fn of(run: Run, states: RunStates) -> Self {
        Self { run, trajectory: states.trajectory.unwrap_or_default(), end: states.end }
    }

    /// Saves it for later commands.
    ///
    /// # Errors
    /// When it cannot be written.
    pub fn save(&self, cache: &ResultCache) -> Result<(), ResultCacheError> {
        let key = self.run.key();
        cache.write(&format!("{key}.path"), &self.trajectory.to_bytes())?;
        save_end(cache, &key, &self.end)?;
        cache.append(LIST, &self.run)
    }
}

/// Loads a saved reference; `None` if it is missing or incomplete.
///
/// # Errors
/// When a file exists and cannot be read.
pub fn load(
    cache: &ResultCache,
    benchmark: &Benchmark,
    setting: &Setting,
) -> Result<Option<ReferenceRun>, ResultCacheError> {
    let key = key(setting, 64, benchmark.window());
    let run = cache.list::<Run>(LIST)?.into_iter().find(|run| run.key() == key);
    let trajectory = cache.read(&format!("{key}.path"))?.and_then(|bytes| Trajectory::from_bytes(&bytes));
    let end = load_end(cache, &key)?;
    Ok(run.zip(trajectory).zip(end).map(|((run, trajectory), end)| ReferenceRun { run, trajectory, end }))
}

/// Saves the last frame of a run.
///
/// # Errors
/// When the file cannot be written.
pub(crate) fn save_end(
    cache: &ResultCache,
    key: &str,
    end: &[Vec<[f32; 3]>],
) -> Result<(), ResultCacheError> {
    let bytes = serde_json::to_vec(&End(end.to_vec())).unwrap_or_default();
    cache.write(&format!("{key}.end.json"), &bytes)
}

/// Loads the last frame of a run, if it is saved.
///
/// # Errors
/// When the file exists and cannot be read.
pub(crate) fn load_end(
    cache: &ResultCache,
    key: &str,
) -> Result<Option<Vec<Vec<[f32; 3]>>>, ResultCacheError> {
    let bytes = cache.read(&format!("{key}.end.json"))?;
    Ok(bytes.and_then(|bytes| serde_json::from_slice::<End>(&bytes).ok()).map(|End(end)| end))
}

/// Largest tolerated divergence of the references, RMS over frames and points, over the size of the cloth: a quarter of
/// 1 %, the error requested most often, so that the noise of the references leaves room for the error of a setting.
pub const MAX_DIVERGENCE: f64 = 0.0025;

/// Positions are comparable if the horizon covers this share of the frames.
const MIN_SHARE: f64 = 0.25;

/// Predictability horizon: the time over which two references agree.
#[derive(Debug, Clone, PartialEq)]
pub struct Horizon {
    /// Distance of the two references in each frame, RMS over the points and over the cloth's size.
    pub divergence: Vec<f64>,
    /// Number of comparable frames.
    pub frames: usize,
    /// RMS of the distance over these frames: the reference uncertainty. Smaller errors are indistinguishable from 0.
    pub floor: f64,
}

impl Horizon {
    /// From the distance in each frame: the longest time over which its RMS stays below [`MAX_DIVERGENCE`].
    ///
    /// A hard impact can separate the references for some frames; if they converge again, it is not chaos.
    pub fn of(divergence: Vec<f64>) -> Self {
        let mut squares = 0.0;
        let (mut frames, mut floor) = (0, 0.0);
        for (frame, divergence) in divergence.iter().enumerate() {
            squares += divergence * divergence;
            let so_far = (squares / (frame + 1) as f64).sqrt();
            if so_far <= MAX_DIVERGENCE {
                (frames, floor) = (frame + 1, so_far);
            }
        }
        Self { divergence, frames, floor }
    }

    /// Whether enough frames are comparable for an error of positions.
    pub fn is_usable(&self) -> bool {
        self.frames > 0 && self.frames as f64 >= MIN_SHARE * self.divergence.len() as f64
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn references_that_agree_are_comparable_to_the_last_frame() {
        let horizon = Horizon::of(vec![1e-4; 48]);
        assert_eq!((horizon.frames, horizon.is_usable()), (48, true));
        assert!((horizon.floor - 1e-4).abs() < 1e-12);
    }

    #[test]
    fn exponential_divergence_ends_the_horizon_below_the_limit() {
        let horizon = Horizon::of((0..48).map(|frame| 1e-7 * f64::from(frame).exp2()).collect());
        assert!((10..20).contains(&horizon.frames), "{horizon:?}");
        assert!(horizon.floor <= MAX_DIVERGENCE && horizon.is_usable());
    }

    #[test]
    fn a_transient_separation_does_not_end_the_horizon() {
        let horizon = Horizon::of((0..48).map(|frame| if frame == 8 { 0.01 } else { 1e-3 }).collect());
        assert_eq!(horizon.frames, 48);
        assert!(horizon.floor < MAX_DIVERGENCE, "{horizon:?}");
    }

    #[test]
    fn references_that_differ_from_the_start_are_not_comparable() {
        let horizon = Horizon::of(vec![0.1; 48]);
        assert_eq!((horizon.frames, horizon.is_usable()), (0, false));
        assert!(!Horizon::of(vec![f64::NAN; 4]).is_usable());
        assert!(!Horizon::of(Vec::new()).is_usable());
    }
}
