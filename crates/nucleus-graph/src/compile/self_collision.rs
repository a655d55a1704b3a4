//! How a cloth meets itself, and which of its elements meet others.

use nucleus_core::{Elements, SelfCollision};

use super::objects::{CLASSIC, ClothSource};
use super::program::Program;
use crate::attributes::{Choice, n_base, n_cloth, nucleus};

/// `selfCollisionFlag` full surface.
const FULL_SURFACE: i32 = 4;

impl Program {
    /// How a cloth meets itself at a frame.
    pub(super) fn self_collision(&self, cloth: &ClothSource, frame: f64) -> SelfCollision {
        let node = self.graph.node(cloth.node);
        let classic = self.graph.node(self.nucleus).get(&nucleus::RESISTANCE_MODEL) == CLASSIC;
        // Left out, a flag is what Maya sets when it makes the cloth, or in Physical what lets nothing pass.
        let (vertex, vertex_face) = (1, 3);
        let created = if cloth.is_dense { (vertex, 3.0) } else { (vertex_face, 1.0) };
        let (made, width) = if classic { created } else { (FULL_SURFACE, 1.0) };
        let is_set = node.setting(&n_base::SELF_COLLISION_FLAG).is_some();
        let flag = if is_set { node.at(&n_base::SELF_COLLISION_FLAG, frame).0 } else { made };
        let is_set = node.setting(&n_cloth::SELF_COLLIDE_WIDTH_SCALE).is_some();
        let scale = if is_set { node.at(&n_cloth::SELF_COLLIDE_WIDTH_SCALE, frame) } else { width };
        SelfCollision {
            on: node.at(&n_base::SELF_COLLIDE, frame),
            thickness: self.thickness(cloth.node, cloth.default_thickness, frame) * scale,
            elements: elements(Choice(flag)),
            edges: flag == FULL_SURFACE,
        }
    }

    /// Passes in 1/24 s: as many as the cloth that wants most.
    pub(super) fn self_collision_iterations(&self, frame: f64) -> f64 {
        let of = |cloth: &ClothSource| {
            self.graph.node(cloth.node).at(&n_base::MAX_SELF_COLLISION_ITERATIONS, frame) as f64
        };
        self.cloths.iter().map(of).fold(0.0, f64::max)
    }
}

/// The elements that a flag stands for: 1 points, 2 edges too, 3 and above faces too.
pub(super) fn elements(flag: Choice) -> Elements {
    match flag.0 {
        ..=1 => Elements::Points,
        2 => Elements::Edges,
        _ => Elements::Faces,
    }
}
