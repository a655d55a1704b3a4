//! The thickness that an object gets when nobody sets one: Maya's rule at creation.

use nalgebra::Vector3;
use nucleus_core::Surface;

/// Share of the size of an object, at most: for cloth.
pub(super) const CLOTH_SHARE: f64 = 0.005;
/// The same for colliders.
pub(super) const COLLIDER_SHARE: f64 = 0.003;
/// Share of the estimated length of an edge, at most.
const EDGE_SHARE: f64 = 0.13;
/// Nothing is thinner than this, in scene units.
const LEAST: f64 = 0.0001;

/// Whether a surface is so dense that its edges limit its default thickness. Maya then makes it meet itself in
/// its points alone, three times as wide.
pub(super) fn is_dense(surface: &Surface, share: f64) -> bool {
    let box_area = bounding_box_area(&surface.positions);
    let edge = (box_area / surface.faces.len().max(1) as f64).sqrt();
    edge * EDGE_SHARE <= box_area.sqrt() * share
}

/// The default thickness of a surface in world space; both in scene units.
pub(super) fn default_thickness(surface: &Surface, share: f64) -> f64 {
    let box_area = bounding_box_area(&surface.positions);
    let edge = (box_area / surface.faces.len().max(1) as f64).sqrt();
    (box_area.sqrt() * share).min(edge * EDGE_SHARE).max(LEAST)
}

fn bounding_box_area(positions: &[Vector3<f64>]) -> f64 {
    let Some(&first) = positions.first() else { return 0.0 };
    let low = positions.iter().fold(first, |low, p| low.inf(p));
    let size = positions.iter().fold(first, |high, p| high.sup(p)) - low;
    2.0 * (size.x * size.y + size.y * size.z + size.z * size.x)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::{poly_cylinder, poly_plane};

    /// The value that Maya wrote into a scene with this pole.
    #[test]
    fn the_rule_gives_what_maya_gives() {
        let pole = poly_cylinder(0.05, 3.5, (6, 1, 1)).expect("valid");
        assert!((default_thickness(&pole, COLLIDER_SHARE) - 0.003_451_354_1).abs() < 1e-9);
    }

    #[test]
    fn a_dense_mesh_is_as_thin_as_its_edges_want() {
        // The box has two sides of 1 by 1; its edges are estimated as sqrt(2 / 10000) long.
        let plane = poly_plane(1.0, 1.0, (100, 100)).expect("valid");
        assert!((default_thickness(&plane, CLOTH_SHARE) - 0.13 * 2f64.sqrt() / 100.0).abs() < 1e-15);
    }

    #[test]
    fn nothing_is_thinner_than_the_least() {
        let tiny = poly_plane(1e-4, 1e-4, (1, 1)).expect("valid");
        assert_eq!(default_thickness(&tiny, CLOTH_SHARE), 0.0001);
    }
}
