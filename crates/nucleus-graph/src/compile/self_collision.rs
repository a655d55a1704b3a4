//! How a cloth meets itself, and which of its elements meet others.

use nucleus_core::{Elements, SelfCollision};

use super::frame::Stretch;
use super::objects::{CLASSIC, ClothSource};
use crate::attributes::{Choice, n_base, n_cloth, nucleus};

/// `selfCollisionFlag` full surface.
const FULL_SURFACE: i32 = 4;

impl Stretch<'_> {
    /// How a cloth meets itself at a frame.
    pub(super) fn self_collision(&self, cloth: &ClothSource) -> SelfCollision {
        let (node, to) = (cloth.node, &self.to);
        let classic = to.get(self.universe.nucleus, &nucleus::RESISTANCE_MODEL) == CLASSIC;
        // Left out, a flag is what Maya sets when it makes the cloth, or in Physical what lets nothing pass.
        let (vertex, vertex_face) = (1, 3);
        let created = if cloth.is_dense { (vertex, 3.0) } else { (vertex_face, 1.0) };
        let (made, width) = if classic { created } else { (FULL_SURFACE, 1.0) };
        let is_given = self.graph.is_given(node, &n_base::SELF_COLLISION_FLAG);
        let flag = if is_given { to.get(node, &n_base::SELF_COLLISION_FLAG).0 } else { made };
        let is_given = self.graph.is_given(node, &n_cloth::SELF_COLLIDE_WIDTH_SCALE);
        let scale = if is_given { to.get(node, &n_cloth::SELF_COLLIDE_WIDTH_SCALE) } else { width };
        SelfCollision {
            on: to.get(node, &n_base::SELF_COLLIDE),
            thickness: self.thickness(node, cloth.default_thickness) * cloth.scales.thickness * scale,
            elements: elements(Choice(flag)),
            edges: flag == FULL_SURFACE,
        }
    }

    /// Passes in 1/24 s: as many as the cloth that wants most.
    pub(super) fn self_collision_iterations(&self) -> f64 {
        let of = |cloth: &ClothSource| self.to.get(cloth.node, &n_base::MAX_SELF_COLLISION_ITERATIONS) as f64;
        self.universe.cloths.iter().map(of).fold(0.0, f64::max)
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
