//! Faces that are no faces.

use nalgebra::Vector3;
use nucleus_core::{Faces, Surface};

/// Removes the faces that no solver can work with, and returns how many that were; points stay as they are.
///
/// A corner that repeats the one before it is left out, which may make a quad a triangle. Then every face
/// goes that has fewer than three corners, names a point twice, or has exactly no area.
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
        if corners.len() >= 3 && !names_a_point_twice(&corners, &mut sorted) && has_area(surface, &corners) {
            kept.push(&corners);
        }
    }
    surface.faces = kept;
    before - surface.faces.len()
}

/// A face may have as many corners as its mesh has points, so they are not compared pair by pair. `sorted` is memory.
fn names_a_point_twice(corners: &[u32], sorted: &mut Vec<u32>) -> bool {
    sorted.clear();
    sorted.extend_from_slice(corners);
    sorted.sort_unstable();
    sorted.windows(2).any(|pair| pair[0] == pair[1])
}

/// Whether any triangle of the fan has.
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
    fn faces_without_area_go_and_points_stay() {
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
