//! Thickness: the default for a mesh, the value at a frame, and the widths derived from it for self-collision and
//! push-out.

use nalgebra::Vector3;
use nucleus_core::{Elements, MAX_COORDINATE, PushOut, SelfCollision, Surface};

use crate::attributes::{Choice, Key, n_base, n_cloth, n_particle, nucleus};
use crate::graph::NodeId;
use crate::mesh::bounding_box;

use super::compiler::Compiler;
use super::program::EvaluationInterval;
use super::sources::ClothSource;
use super::units::CLASSIC;

/// Default thickness of cloth at most, over the square root of its bounding box area.
pub(super) const CLOTH_SHARE: f64 = 0.005;
/// The same for colliders.
pub(super) const COLLIDER_SHARE: f64 = 0.003;
/// Default thickness at most, over the estimated edge length.
const EDGE_SHARE: f64 = 0.13;
/// Default thickness at least, in scene units.
const MIN_THICKNESS: f64 = 0.0001;
/// `pushOutRadius` over thickness in an object that Maya creates.
const CREATED_PUSH_OUT_RADIUS: f64 = 4.0;
/// `selfCollisionFlag`: vertex.
const VERTEX: i32 = 1;
/// `selfCollisionFlag`: vertex face.
const VERTEX_FACE: i32 = 3;
/// `selfCollisionFlag`: full surface.
const FULL_SURFACE: i32 = 4;

/// Attributes that are widths, and whether each is compared with the size of the scene. A few particles may be wider than
/// the space between them.
static WIDTHS: [(&Key<f64>, bool); 3] =
    [(&n_base::THICKNESS, true), (&n_base::PUSH_OUT_RADIUS, false), (&n_particle::RADIUS, false)];
/// Attributes that scale a width, and that width.
static SCALES: [(&Key<f64>, &Key<f64>); 3] = [
    (&n_cloth::SELF_COLLIDE_WIDTH_SCALE, &n_base::THICKNESS),
    (&n_particle::COLLIDE_WIDTH_SCALE, &n_particle::RADIUS),
    (&n_particle::SELF_COLLIDE_WIDTH_SCALE, &n_particle::RADIUS),
];

/// Whether the edge length of a surface limits its default thickness. Maya then creates the cloth with self-collision
/// of vertices alone, at three times the width.
pub(super) fn is_dense(surface: &Surface, share: f64) -> bool {
    let box_area = bounding_box_area(&surface.positions);
    let edge = (box_area / surface.faces.len().max(1) as f64).sqrt();
    edge * EDGE_SHARE <= box_area.sqrt() * share
}

/// The thickness that Maya gives a new object with this surface in world space; both in scene units.
pub(super) fn default_thickness(surface: &Surface, share: f64) -> f64 {
    let box_area = bounding_box_area(&surface.positions);
    let edge = (box_area / surface.faces.len().max(1) as f64).sqrt();
    (box_area.sqrt() * share).min(edge * EDGE_SHARE).max(MIN_THICKNESS)
}

/// Surface area of the bounding box.
fn bounding_box_area(positions: &[Vector3<f64>]) -> f64 {
    let [low, high] = bounding_box(positions);
    let size = high - low;
    2.0 * (size.x * size.y + size.y * size.z + size.z * size.x)
}

/// The elements of a `collisionFlag`: 1 points, 2 edges too, 3 and above faces too.
pub(super) fn elements(flag: Choice) -> Elements {
    match flag.0 {
        ..=1 => Elements::Points,
        2 => Elements::Edges,
        _ => Elements::Faces,
    }
}

impl EvaluationInterval<'_> {
    /// Thickness of a mesh object in metres; `default` in scene units where it is not given.
    pub(super) fn thickness(&self, node: NodeId, default: f64) -> f64 {
        self.nucleus.units.length(self.given(node, &n_base::THICKNESS).unwrap_or(default))
    }

    /// Push-out of an object. A radius that is not given is that of an object that Maya creates.
    pub(super) fn push_out(&self, node: NodeId, default_thickness: f64) -> PushOut {
        let share = self.to.get(node, &n_base::PUSH_OUT);
        if share == 0.0 {
            return PushOut::OFF;
        }
        let radius = match self.given(node, &n_base::PUSH_OUT_RADIUS) {
            Some(radius) => self.nucleus.units.length(radius),
            None => CREATED_PUSH_OUT_RADIUS * self.thickness(node, default_thickness),
        };
        PushOut { share, radius }
    }

    /// Self-collision of a cloth. In the Classic resistance model, a flag or width scale that is not given is that of a
    /// cloth that Maya creates; in Physical it is the full surface, which certifies every pair.
    pub(super) fn self_collision(&self, cloth: &ClothSource) -> SelfCollision {
        let (node, to) = (cloth.node, &self.to);
        let classic = to.get(self.nucleus.node, &nucleus::RESISTANCE_MODEL) == CLASSIC;
        let created = if cloth.is_dense { (VERTEX, 3.0) } else { (VERTEX_FACE, 1.0) };
        let (default_flag, default_scale) = if classic { created } else { (FULL_SURFACE, 1.0) };
        let flag = self.given(node, &n_base::SELF_COLLISION_FLAG).unwrap_or(Choice(default_flag));
        let scale = self.given(node, &n_cloth::SELF_COLLIDE_WIDTH_SCALE).unwrap_or(default_scale);
        SelfCollision {
            on: to.get(node, &n_base::SELF_COLLIDE),
            thickness: self.thickness(node, cloth.default_thickness) * cloth.scales.thickness * scale,
            elements: elements(flag),
            edges: flag.0 == FULL_SURFACE,
        }
    }

    /// Self-collision passes in 1/24 s: the maximum over all cloths.
    pub(super) fn self_collision_iterations(&self) -> f64 {
        let of = |cloth: &ClothSource| self.to.get(cloth.node, &n_base::MAX_SELF_COLLISION_ITERATIONS) as f64;
        self.nucleus.cloths.iter().map(of).fold(0.0, f64::max)
    }
}

impl Compiler<'_> {
    /// Reports widths that no scene can mean: an error beyond the range of coordinates, a warning where a thickness
    /// exceeds the bounding box diagonal of all objects of the nucleus at the start frame.
    pub(super) fn check_widths(&mut self, objects: &[NodeId]) {
        let extent = self.bounds.map_or(0.0, |[low, high]: [Vector3<f64>; 2]| (high - low).norm());
        for &object in objects {
            for (key, is_bounded) in WIDTHS {
                self.check_width(object, key, 1.0, extent, is_bounded);
            }
            for (scale, key) in SCALES {
                let is_bounded = WIDTHS.iter().any(|(width, is_bounded)| width.row == key.row && *is_bounded);
                if self.has(object, key) && self.has(object, scale) {
                    let width = self.start.get(object, key);
                    self.check_width(object, scale, width, extent, is_bounded);
                }
            }
        }
    }

    fn has(&self, object: NodeId, key: &Key<f64>) -> bool {
        self.scene.graph.node(object).node_type().attribute(key.row.name).is_some()
    }

    fn check_width(&mut self, object: NodeId, key: &Key<f64>, factor: f64, extent: f64, is_bounded: bool) {
        let graph = &self.scene.graph;
        if !self.has(object, key) || !graph.is_given(object, key) {
            return;
        }
        let value = self.start.get(object, key);
        let width = value * factor;
        let name = graph.node(object).name();
        let place = self.place(object, &key.row);
        let label = format!("`{}` of `{name}`", key.row.name);
        let help = "widths are in scene units, thickness mostly a hundredth of the object";
        if self.program.units.length(width) > MAX_COORDINATE {
            let message = format!("{label} is {value:e}, which makes it wider than {MAX_COORDINATE:e} m");
            self.findings.error(&place, message).help(help);
        } else if is_bounded && extent > 0.0 && width > extent {
            let message = format!(
                "{label} is {value}, which makes it wider than all objects together, which take {extent:.3} from corner \
                 to corner"
            );
            self.findings.warning(&place, message).help(help);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::{poly_cylinder, poly_plane};

    /// The expected value is from a scene that Maya saved with this pole.
    #[test]
    fn the_default_thickness_is_mayas() {
        let pole = poly_cylinder(0.05, 3.5, (6, 1, 1)).expect("valid");
        assert!((default_thickness(&pole, COLLIDER_SHARE) - 0.003_451_354_1).abs() < 1e-9);
    }

    #[test]
    fn the_edge_length_limits_the_thickness_of_a_dense_mesh() {
        // The box has two sides of 1 by 1; the estimated edge length is sqrt(2 / 10000).
        let plane = poly_plane(1.0, 1.0, (100, 100)).expect("valid");
        assert!((default_thickness(&plane, CLOTH_SHARE) - 0.13 * 2f64.sqrt() / 100.0).abs() < 1e-15);
    }

    #[test]
    fn the_default_thickness_has_a_minimum() {
        let tiny = poly_plane(1e-4, 1e-4, (1, 1)).expect("valid");
        assert_eq!(default_thickness(&tiny, CLOTH_SHARE), 0.0001);
    }
}
