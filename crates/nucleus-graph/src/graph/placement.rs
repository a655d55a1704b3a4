//! Where nodes stand: transforms under transforms.

use nalgebra::Vector3;

use crate::animation::{Affine, Transform};
use crate::attributes::transform;

use super::node::NodeId;
use super::nodes::Graph;

impl Graph {
    /// What carries points of a node into the world at a frame. Lengths in scene units.
    pub fn placement(&self, node: NodeId, frame: f64) -> Affine {
        let own = |node| self.transform(node, frame).affine();
        self.and_ancestors(node).map(own).reduce(|child, parent| child.under(&parent)).unwrap_or_default()
    }

    /// Whether a node, or anything it hangs from, is moved.
    pub fn moves(&self, node: NodeId) -> bool {
        self.and_ancestors(node).map(|node| self.node(node)).any(|node| {
            node.changes(&transform::TRANSLATE)
                || node.changes(&transform::ROTATE)
                || node.changes(&transform::SCALE)
        })
    }

    fn transform(&self, node: NodeId, frame: f64) -> Transform {
        let node = self.node(node);
        Transform {
            translate: Vector3::from(node.at(&transform::TRANSLATE, frame)),
            rotate: Vector3::from(node.at(&transform::ROTATE, frame)),
            scale: Vector3::from(node.at(&transform::SCALE, frame)),
        }
    }
}
