//! A scene, and the file that it comes from.

use std::collections::BTreeMap;
use std::ops::Range;
use std::path::{Path, PathBuf};

use crate::attributes::{Value, n_particle};
use crate::checks::Check;
use crate::graph::{Graph, GraphError, NodeId, Setting};
use crate::memory::{Budget, Memory};

/// A scene: frames, recording, nodes and checks.
///
/// Scenes are equal when all of these are, whatever the layout of their files.
#[derive(Debug, Clone)]
pub struct Scene {
    /// The frames of the run.
    pub time: TimeSpan,
    /// Evaluation interval in frames: a whole number, or the reciprocal of one.
    pub every: f64,
    /// Which states are recorded.
    pub record: Record,
    /// The nodes and their connections.
    pub graph: Graph,
    /// The checks that the run has to pass.
    pub checks: Vec<Check>,
    /// The file it comes from.
    pub source: Source,
}

/// The frames of a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TimeSpan {
    /// The first frame.
    pub start: i64,
    /// The last frame, not before the first.
    pub end: i64,
    /// Frames per second, above zero.
    pub fps: f64,
}

/// The states of a run that are recorded.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Record {
    /// The end of every frame.
    #[default]
    Frames,
    /// The end of every substep.
    Substeps,
    /// The end of every n-th frame, and of the last frame. `n` is at least 1.
    Every(u32),
    /// No state.
    None,
}

/// Limit on frame numbers.
pub(super) const MAX_FRAME: i64 = 1_000_000_000;

/// Limit on frames per evaluation, and on evaluations per frame.
const MAX_EVERY: f64 = 1000.0;

/// The evaluation interval nearest to a number: a whole number of frames, or the reciprocal of one; `None` for others.
pub(super) fn evaluation_interval(every: f64) -> Option<f64> {
    let whole = |x: f64| (1.0..=MAX_EVERY).contains(&x) && x.fract() == 0.0;
    // 1/3 has no exact decimal, so the nearest reciprocal is taken.
    let parts = (1.0 / every).round();
    match whole(every) {
        true => Some(every),
        false => (whole(parts) && (every * parts - 1.0).abs() < 1e-6).then_some(1.0 / parts),
    }
}

/// Whether a number can be frames per second.
pub(super) fn is_frame_rate(fps: f64) -> bool {
    (1e-3..=1e6).contains(&fps)
}

impl Scene {
    /// What is wrong with the frames of the run and their evaluation interval. A scene that was read has no such faults.
    pub(crate) fn time_faults(&self) -> Vec<String> {
        let TimeSpan { start, end, fps } = self.time;
        let faults = [
            (start.checked_abs().is_none_or(|x| x > MAX_FRAME))
                .then(|| format!("the run starts at frame {start}, beyond the limit of {MAX_FRAME}")),
            (end.checked_abs().is_none_or(|x| x > MAX_FRAME))
                .then(|| format!("the run ends at frame {end}, beyond the limit of {MAX_FRAME}")),
            (start > end).then(|| format!("the run starts at frame {start} and ends before it, at {end}")),
            (!is_frame_rate(fps)).then(|| format!("`fps` must be from 0.001 to 1000000, found {fps}")),
            evaluation_interval(self.every).is_none().then(|| {
                let found = self.every;
                format!("`every` must be a whole number of frames, or 1 divided by one, found {found}")
            }),
            (self.record == Record::Every(0))
                .then(|| "`record` takes every n-th frame: n is at least 1".to_owned()),
        ];
        faults.into_iter().flatten().collect()
    }

    /// Sets the positions of the particles of a node at the start, in place of all that the scene gives or fills a volume with.
    ///
    /// # Errors
    /// When the node has no particles.
    pub fn set_particle_positions(
        &mut self,
        node: NodeId,
        positions: Vec<[f64; 3]>,
    ) -> Result<(), GraphError> {
        use n_particle::{FILL_MESH, MAXIMUM_CORNER, MINIMUM_CORNER, POSITION0};
        self.graph.set(node, &POSITION0.row, Setting::Fixed(Value::Vectors(positions)))?;
        for filling in [&MINIMUM_CORNER.row, &MAXIMUM_CORNER.row, &FILL_MESH.row] {
            self.graph.unset(node, filling);
        }
        Ok(())
    }
}

impl PartialEq for Scene {
    fn eq(&self, other: &Self) -> bool {
        (self.time, self.every, self.record) == (other.time, other.every, other.record)
            && self.graph == other.graph
            && self.checks == other.checks
    }
}

/// The file of a scene: its path, the places of nodes and settings, and the memory that reading has taken.
#[derive(Debug, Clone, Default)]
pub struct Source {
    file: PathBuf,
    places: BTreeMap<String, Range<usize>>,
    budget: Budget,
}

impl Source {
    /// A file without known places.
    pub fn new(file: impl Into<PathBuf>) -> Self {
        Self { file: file.into(), ..Self::default() }
    }

    /// A file without known places, with a limit on the memory of its scene.
    pub(super) fn within(file: &Path, memory: Memory) -> Self {
        Self { budget: Budget::new(memory), ..Self::new(file) }
    }

    /// The memory limit of the scene, and the memory that reading has claimed.
    pub(crate) fn budget(&self) -> Budget {
        self.budget
    }

    pub(crate) fn budget_mut(&mut self) -> &mut Budget {
        &mut self.budget
    }

    /// The path as given.
    pub fn file(&self) -> &Path {
        &self.file
    }

    /// A path in the scene, resolved against the folder of the scene's file.
    pub fn path(&self, relative: &str) -> PathBuf {
        self.file.parent().unwrap_or(Path::new("")).join(relative)
    }

    /// The place of a node or setting: `cloth1`, `cloth1.friction`, `pin.components[2]`. An unknown setting has the
    /// place of its node, and an unknown node `0..0`.
    pub fn place(&self, name: &str) -> Range<usize> {
        let node = name.split('.').next().unwrap_or_default();
        self.places.get(name).or_else(|| self.places.get(node)).cloned().unwrap_or_default()
    }

    pub(super) fn note(&mut self, name: String, span: &Range<usize>) {
        self.places.entry(name).or_insert_with(|| span.clone());
    }
}
