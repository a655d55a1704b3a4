//! What is to be kept apart in a frame, for the audit: everything that is not told to pass through.

use nucleus_audit::{CollisionFilter, CollisionMesh};
use nucleus_core::Pin;

use crate::attributes::{n_base, nucleus};
use crate::graph::{Moment, NodeId};

use super::program::{ObjectKind, Program, Universe};

impl Program {
    /// The rules of the frame that ends at `frame`, over all objects in their order. Colliders and pinned points go
    /// where they are told, so nobody can keep them apart from each other.
    pub(crate) fn kept_apart(&self, frame: i64, pins: &[Pin], world: &CollisionMesh) -> CollisionFilter {
        let mut rules = CollisionFilter::default();
        let objects = self.objects();
        let moment = self.graph().at(frame as f64);
        for a in 0..objects.len() {
            for b in a..objects.len() {
                if !self.meet(a, b, &moment) {
                    rules.ignore(a, b);
                }
            }
            if let ObjectKind::Collider(_) = objects[a].kind {
                world.points_of(a).for_each(|point| rules.set_kinematic(point));
            }
        }
        for pin in pins {
            let is_it = |object: &super::Object| object.kind == ObjectKind::Cloth(pin.cloth);
            let cloth = objects.iter().position(is_it).map(|cloth| world.points_of(cloth));
            cloth.into_iter().for_each(|points| rules.set_kinematic(points.start + pin.point.index()));
        }
        rules
    }

    /// Whether two objects meet, or one itself. What hangs on different nuclei never does.
    fn meet(&self, a: usize, b: usize, moment: &Moment) -> bool {
        let [(one, here), (other, there)] = [a, b].map(|object| self.node_of(self.objects()[object].kind));
        if a == b {
            return moment.get(one, &n_base::SELF_COLLIDE);
        }
        let collide = moment.get(one, &n_base::COLLIDE) && moment.get(other, &n_base::COLLIDE);
        let are_cloths = [a, b].iter().all(|&k| matches!(self.objects()[k].kind, ObjectKind::Cloth(_)));
        let range = moment.get(here.nucleus, &nucleus::COLLISION_LAYER_RANGE);
        let layers = moment.get(one, &n_base::COLLISION_LAYER) - moment.get(other, &n_base::COLLISION_LAYER);
        here.nucleus == there.nucleus && collide && !(are_cloths && layers.abs() >= range)
    }

    /// The node of an object, and the nucleus that it belongs to.
    fn node_of(&self, kind: ObjectKind) -> (NodeId, &Universe) {
        let holds = |universe: &&Universe| match kind {
            ObjectKind::Cloth(cloth) => universe.cloths().contains(&cloth.0),
            ObjectKind::Collider(collider) => universe.colliders().contains(&collider.0),
        };
        let universe = self.universes().iter().find(holds).unwrap_or(&self.universes()[0]);
        let node = match kind {
            ObjectKind::Cloth(cloth) => universe.cloths[(cloth.0 - universe.first_cloth) as usize].node,
            ObjectKind::Collider(collider) => {
                universe.colliders[(collider.0 - universe.first_collider) as usize].node
            }
        };
        (node, universe)
    }
}
