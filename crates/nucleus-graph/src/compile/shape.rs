//! Meshes that change their shape: a file per frame, and blends of two meshes.

use std::sync::Arc;

use nalgebra::Vector3;

use crate::attributes::surface_shape;
use crate::graph::{EvalContext, NodeId};

/// Points in the space of a mesh, in scene units.
pub(super) type Points = Arc<[Vector3<f64>]>;

/// The points of a mesh at any frame.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Shape {
    /// Points from the first frame of the run on, a file each; just one if they never change.
    frames: Vec<Points>,
    first: i64,
    /// What it is blended into, and the node that says how far.
    blend: Option<(NodeId, Box<Shape>)>,
}

impl Shape {
    /// A shape that stays as it is.
    pub(super) fn fixed(points: Points) -> Self {
        Self { frames: vec![points], first: 0, blend: None }
    }

    /// A shape for each frame from `first` on.
    pub(super) fn sequence(frames: Vec<Points>, first: i64) -> Self {
        Self { frames, first, blend: None }
    }

    /// A shape that is blended into another, as far as a mesh node says.
    pub(super) fn blended(self, node: NodeId, target: Shape) -> Self {
        Self { blend: Some((node, Box::new(target))), ..self }
    }

    /// Whether it ever changes. `changes` says it of the blend of a mesh node.
    pub(super) fn changes(&self, changes: &dyn Fn(NodeId) -> bool) -> bool {
        let blended =
            self.blend.as_ref().is_some_and(|(node, target)| changes(*node) || target.changes(changes));
        blended || self.frames.windows(2).any(|pair| pair[0] != pair[1])
    }

    /// The points at a moment. Between files, points move in straight lines.
    pub(super) fn at(&self, moment: &EvalContext) -> Points {
        let own = self.between(moment.frame());
        let Some((node, target)) = &self.blend else { return own };
        let share = moment.get(*node, &surface_shape::BLEND);
        if share == 0.0 {
            return own;
        }
        let target = target.at(moment);
        own.iter().zip(target.iter()).map(|(a, b)| a + (b - a) * share).collect()
    }

    fn between(&self, frame: f64) -> Points {
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
