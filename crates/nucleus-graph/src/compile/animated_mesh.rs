//! Meshes that deform: a file per frame, and blends of two meshes.

use std::sync::Arc;

use nalgebra::Vector3;

use crate::attributes::surface_shape;
use crate::graph::{EvalContext, NodeId};

/// Points in mesh space, in scene units.
pub(super) type Points = Arc<[Vector3<f64>]>;

/// The points of a mesh at any frame.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct AnimatedMesh {
    /// Points of each frame from `first` on; one entry if they are constant.
    frames: Vec<Points>,
    first: i64,
    /// The blend target, and the node whose `blend` is its weight.
    blend: Option<(NodeId, Box<AnimatedMesh>)>,
}

/// A file name with a run of `#`, which stands for the digits of the frame.
pub(super) struct NumberedFile<'a> {
    before: &'a str,
    digits: usize,
    after: &'a str,
}

impl AnimatedMesh {
    /// A mesh of constant points.
    pub(super) fn fixed(points: Points) -> Self {
        Self { frames: vec![points], first: 0, blend: None }
    }

    /// A mesh with points for each frame from `first` on.
    pub(super) fn sequence(frames: Vec<Points>, first: i64) -> Self {
        Self { frames, first, blend: None }
    }

    /// Blends this mesh into `target`, weighted by the `blend` of a mesh node.
    pub(super) fn blended(self, node: NodeId, target: AnimatedMesh) -> Self {
        Self { blend: Some((node, Box::new(target))), ..self }
    }

    /// Whether its points ever change. `is_animated` says whether the blend of a mesh node changes.
    pub(super) fn changes(&self, is_animated: &dyn Fn(NodeId) -> bool) -> bool {
        let blends = self
            .blend
            .as_ref()
            .is_some_and(|(node, target)| is_animated(*node) || target.changes(is_animated));
        blends || self.frames.windows(2).any(|pair| pair[0] != pair[1])
    }

    /// The points at a time. Between two frames they are interpolated linearly.
    pub(super) fn at(&self, moment: &EvalContext) -> Points {
        let own = self.interpolated(moment.frame());
        let Some((node, target)) = &self.blend else { return own };
        let weight = moment.get(*node, &surface_shape::BLEND);
        if weight == 0.0 {
            return own;
        }
        let target = target.at(moment);
        own.iter().zip(target.iter()).map(|(a, b)| a + (b - a) * weight).collect()
    }

    fn interpolated(&self, frame: f64) -> Points {
        let last = self.frames.len() - 1;
        let place = (frame - self.first as f64).clamp(0.0, last as f64);
        let before = place.floor() as usize;
        let share = place - before as f64;
        if share == 0.0 {
            return self.frames[before].clone();
        }
        let (a, b) = (&self.frames[before], &self.frames[before + 1]);
        a.iter().zip(b.iter()).map(|(a, b)| a + (b - a) * share).collect()
    }
}

impl<'a> NumberedFile<'a> {
    /// `None` if there is no `#` in the name.
    pub(super) fn new(file: &'a str) -> Option<Self> {
        let first = file.find('#')?;
        let digits = file[first..].bytes().take_while(|byte| *byte == b'#').count();
        Some(Self { before: &file[..first], digits, after: &file[first + digits..] })
    }

    /// The name of the file of a frame.
    pub(super) fn at(&self, frame: i64) -> String {
        format!("{}{frame:0digits$}{}", self.before, self.after, digits = self.digits)
    }
}
