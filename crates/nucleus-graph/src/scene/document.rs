//! A scene as a whole.

use std::collections::BTreeMap;
use std::ops::Range;
use std::path::{Path, PathBuf};

use crate::checks::Check;
use crate::graph::Graph;
use crate::memory::{Budget, Memory};

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

/// The file of a scene.
#[derive(Debug, Clone, Default)]
pub struct Source {
    file: PathBuf,
    places: BTreeMap<String, Range<usize>>,
    budget: Budget,
}

impl Source {
    /// A file in which nothing has a known place.
    pub fn new(file: impl Into<PathBuf>) -> Self {
        Self { file: file.into(), ..Self::default() }
    }

    /// The same, with a limit on the memory that the scene may take.
    pub(super) fn within(file: &Path, memory: Memory) -> Self {
        Self { budget: Budget::new(memory), ..Self::new(file) }
    }

    /// The memory that the scene may take, and what reading it has taken of it.
    pub(crate) fn budget(&self) -> Budget {
        self.budget
    }

    pub(crate) fn budget_mut(&mut self) -> &mut Budget {
        &mut self.budget
    }

    /// Its path, as it was given.
    pub fn file(&self) -> &Path {
        &self.file
    }

    /// A path that the scene names, seen from where the scene's file is.
    pub fn path(&self, relative: &str) -> PathBuf {
        self.file.parent().unwrap_or(Path::new("")).join(relative)
    }

    /// Where something stands: `cloth1`, `cloth1.friction`, `pin.components[2]`. What has no place of its
    /// own is where its node is, and that is `0..0` if it comes from no file.
    pub fn place(&self, name: &str) -> Range<usize> {
        let node = name.split('.').next().unwrap_or_default();
        self.places.get(name).or_else(|| self.places.get(node)).cloned().unwrap_or_default()
    }

    /// Everything that has a place of its own.
    pub(super) fn places(&self) -> impl Iterator<Item = (&str, &Range<usize>)> {
        self.places.iter().map(|(name, span)| (name.as_str(), span))
    }

    pub(super) fn note(&mut self, name: String, span: &Range<usize>) {
        self.places.entry(name).or_insert_with(|| span.clone());
    }
}
