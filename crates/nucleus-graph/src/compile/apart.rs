//! What is to be kept apart in a frame, for the audit: everything that is not told to pass through.

use nucleus_audit::{Rules, World};
use nucleus_core::Pin;

use crate::attributes::{n_base, nucleus};
use crate::graph::Node;

use super::program::{ObjectKind, Program};

impl Program {
    /// The rules of the frame that ends at `frame`, over all objects in their order. Colliders and pinned points go
    /// where they are told, so nobody can keep them apart from each other.
    pub(crate) fn kept_apart(&self, frame: i64, pins: &[Pin], world: &World) -> Rules {
        let mut rules = Rules::default();
        let objects = self.objects();
        for a in 0..objects.len() {
            for b in a..objects.len() {
                if !self.meet(a, b, frame as f64) {
                    rules.ignore(a, b);
                }
            }
            if let ObjectKind::Collider(_) = objects[a].kind {
                world.points_of(a).for_each(|point| rules.hold(point));
            }
        }
        for pin in pins {
            let is_it = |object: &super::Object| object.kind == ObjectKind::Cloth(pin.cloth);
            let cloth = objects.iter().position(is_it).map(|cloth| world.points_of(cloth));
            cloth.into_iter().for_each(|points| rules.hold(points.start + pin.point.index()));
        }
        rules
    }

    /// Whether two objects meet, or one itself.
    fn meet(&self, a: usize, b: usize, frame: f64) -> bool {
        let [one, other] = [a, b].map(|object| self.node_of(self.objects()[object].kind));
        if a == b {
            return one.at(&n_base::SELF_COLLIDE, frame);
        }
        let collide = one.at(&n_base::COLLIDE, frame) && other.at(&n_base::COLLIDE, frame);
        let are_cloths = [a, b].iter().all(|&k| matches!(self.objects()[k].kind, ObjectKind::Cloth(_)));
        let range = self.graph.node(self.nucleus).at(&nucleus::COLLISION_LAYER_RANGE, frame);
        let layers = one.at(&n_base::COLLISION_LAYER, frame) - other.at(&n_base::COLLISION_LAYER, frame);
        collide && !(are_cloths && layers.abs() >= range)
    }

    fn node_of(&self, kind: ObjectKind) -> &Node {
        self.graph.node(match kind {
            ObjectKind::Cloth(cloth) => self.cloths[cloth.index()].node,
            ObjectKind::Collider(collider) => self.colliders[collider.index()].node,
        })
    }
}
