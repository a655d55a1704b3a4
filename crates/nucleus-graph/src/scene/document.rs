//! A scene as a whole.

use crate::checks::Check;
use crate::graph::Graph;

use super::source::Source;

/// Everything a run needs: time, nodes, and what must hold.
///
/// Two scenes are equal when they say the same, wherever it stands in their files.
#[derive(Debug, Clone)]
pub struct Scene {
    /// The frames of the run.
    pub time: TimeSpan,
    /// Frames from one evaluation to the next: whole, or a part of one.
    pub every: f64,
    /// What is recorded.
    pub record: Record,
    /// The nodes and their connections.
    pub graph: Graph,
    /// What must hold during the run.
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

/// What of a run is recorded.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Record {
    /// The end of every frame.
    #[default]
    Frames,
    /// The end of every substep.
    Substeps,
    /// The end of every so manieth frame, and of the last; above zero.
    Every(u32),
    /// Nothing.
    None,
}

impl PartialEq for Scene {
    fn eq(&self, other: &Self) -> bool {
        (self.time, self.every, self.record) == (other.time, other.every, other.record)
            && self.graph == other.graph
            && self.checks == other.checks
    }
}
