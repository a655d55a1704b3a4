//! Degenerate faces: too few corners, repeated points, or no area.

use nalgebra::Vector3;
use nucleus_core::{Faces, Surface};

/// Removes degenerate faces and returns their number. Points stay unchanged.
///
/// A corner that repeats the one before it is removed first, which may turn a quad into a triangle. Then a face is
/// degenerate if it has fewer than three corners, has a point twice, or has an area of exactly zero.
///
/// Corners must index the surface's positions.
pub fn drop_degenerate_faces(surface: &mut Surface) -> usize {
    let before = surface.faces.len();
    let mut kept = Faces::with_capacity(before, surface.faces.corners().len());
    let (mut corners, mut sorted) = (Vec::new(), Vec::new());
    for face in surface.faces.iter() {
        corners.clear();
        corners.extend_from_slice(face);
        corners.dedup();
        while corners.len() > 1 && corners.first() == corners.last() {
            corners.pop();
        }
        if corners.len() >= 3 && !has_a_point_twice(&corners, &mut sorted) && has_area(surface, &corners) {
            kept.push(&corners);
        }
    }
    surface.faces = kept;
    before - surface.faces.len()
}

/// Sorts instead of comparing all pairs, because a face may have thousands of corners. `sorted` is a reused buffer.
fn has_a_point_twice(corners: &[u32], sorted: &mut Vec<u32>) -> bool {
    sorted.clear();
    sorted.extend_from_slice(corners);
    sorted.sort_unstable();
    sorted.windows(2).any(|pair| pair[0] == pair[1])
}

/// Whether any triangle of the fan from the first corner has an area.
fn has_area(surface: &Surface, corners: &[u32]) -> bool {
    let point = |k: usize| surface.positions[corners[k] as usize];
    (2..corners.len()).any(|k| (point(k - 1) - point(0)).cross(&(point(k) - point(0))) != Vector3::zeros())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn surface(faces: &[&[u32]]) -> Surface {
        let points = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0], [0.5, 0.0]];
        let positions = points.map(|[x, y]| Vector3::new(x, y, 0.0)).to_vec();
        Surface { positions, faces: faces.iter().copied().collect() }
    }

    #[test]
    fn degenerate_faces_are_removed_and_points_stay() {
        let mut mesh = surface(&[&[0, 1, 2], &[0, 0, 1], &[0, 4, 1], &[0, 1, 0, 2], &[1, 1], &[0, 1, 2, 3]]);
        assert_eq!(drop_degenerate_faces(&mut mesh), 4);
        assert_eq!(mesh, surface(&[&[0, 1, 2], &[0, 1, 2, 3]]));
    }

    #[test]
    fn a_quad_that_repeats_a_corner_becomes_a_triangle() {
        let mut mesh = surface(&[&[0, 1, 1, 2], &[0, 1, 2, 0], &[3, 3, 0, 1]]);
        assert_eq!(drop_degenerate_faces(&mut mesh), 0);
        assert_eq!(mesh, surface(&[&[0, 1, 2], &[0, 1, 2], &[3, 0, 1]]));
    }
}
