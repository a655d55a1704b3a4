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
    each_kept(surface, |_, _, points| kept.push(points));
    surface.faces = kept;
    before - surface.faces.len()
}

/// What [`drop_degenerate_faces`] keeps of the faces of a mesh.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct KeptFaces {
    /// The indices of the faces, ascending.
    pub faces: Vec<u32>,
    /// The indices of their corners among those of all faces, ascending.
    pub corners: Vec<u32>,
}

impl KeptFaces {
    /// Those of a mesh with all its faces, whose corners index its positions.
    pub fn of(surface: &Surface) -> Self {
        let mut kept = Self::default();
        each_kept(surface, |face, corners, _| {
            kept.faces.push(face);
            kept.corners.extend_from_slice(corners);
        });
        kept
    }
}

/// Passes the index of each kept face, the indices of its corners among those of all faces, and their points.
fn each_kept(surface: &Surface, mut keep: impl FnMut(u32, &[u32], &[u32])) {
    let (mut corners, mut points, mut sorted) = (Vec::new(), Vec::new(), Vec::new());
    let (mut first, all) = (0, surface.faces.corners());
    for (index, face) in (0..).zip(surface.faces.iter()) {
        let point = |corner: &u32| all[*corner as usize];
        corners.clear();
        corners.extend(first..first + face.len() as u32);
        first += face.len() as u32;
        corners.dedup_by_key(|corner| point(corner));
        while corners.len() > 1 && corners.first().map(point) == corners.last().map(point) {
            corners.pop();
        }
        points.clear();
        points.extend(corners.iter().map(point));
        if points.len() >= 3 && !has_a_point_twice(&points, &mut sorted) && has_area(surface, &points) {
            keep(index, &corners, &points);
        }
    }
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
        let kept = KeptFaces::of(&mesh);
        assert_eq!((kept.faces, kept.corners), (vec![0, 5], vec![0, 1, 2, 15, 16, 17, 18]));
        assert_eq!(drop_degenerate_faces(&mut mesh), 4);
        assert_eq!(mesh, surface(&[&[0, 1, 2], &[0, 1, 2, 3]]));
    }

    #[test]
    fn a_quad_that_repeats_a_corner_becomes_a_triangle() {
        let mut mesh = surface(&[&[0, 1, 1, 2], &[0, 1, 2, 0], &[3, 3, 0, 1]]);
        assert_eq!(KeptFaces::of(&mesh).corners, [0, 1, 3, 4, 5, 6, 8, 10, 11]);
        assert_eq!(drop_degenerate_faces(&mut mesh), 0);
        assert_eq!(mesh, surface(&[&[0, 1, 2], &[0, 1, 2], &[3, 0, 1]]));
    }
}
