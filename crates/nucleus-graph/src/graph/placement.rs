//! Where nodes stand: transforms under transforms.

use nalgebra::Vector3;

use crate::animation::{Affine, Transform};
use crate::attributes::transform;

use super::moment::Moment;
use super::node::NodeId;
use super::nodes::Graph;

/// Axes by Maya's index of `rotateOrder`: xyz, yzx, zxy, xzy, yxz, zyx.
const ORDERS: [[usize; 3]; 6] = [[0, 1, 2], [1, 2, 0], [2, 0, 1], [0, 2, 1], [1, 0, 2], [2, 1, 0]];

impl Graph {
    /// What carries points of a node into the world at a frame. Lengths in scene units. To ask for many nodes,
    /// take [`at`](Self::at) once.
    pub fn placement(&self, node: NodeId, frame: f64) -> Affine {
        self.at(frame).placement(node)
    }

    /// Whether a node, or anything it hangs from, is moved.
    pub fn moves(&self, node: NodeId) -> bool {
        self.and_ancestors(node).any(|node| {
            self.changes(node, &transform::TRANSLATE)
                || self.changes(node, &transform::ROTATE)
                || self.changes(node, &transform::SCALE)
        })
    }
}

impl Moment<'_> {
    pub(super) fn transform(&self, node: NodeId) -> Transform {
        Transform {
            translate: Vector3::from(self.get(node, &transform::TRANSLATE)),
            rotate: Vector3::from(self.get(node, &transform::ROTATE)),
            order: ORDERS[self.get(node, &transform::ROTATE_ORDER).0.clamp(0, 5) as usize],
            scale: Vector3::from(self.get(node, &transform::SCALE)),
        }
    }
}
