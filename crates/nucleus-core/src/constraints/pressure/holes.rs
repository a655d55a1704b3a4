//! Holes of a mesh, and the caps that close them.

use std::collections::BTreeMap;

use nalgebra::Vector3;

use crate::model::surface::Surface;

fn middle(corners: &[Vector3<f64>]) -> Vector3<f64> {
    corners.iter().sum::<Vector3<f64>>() / corners.len() as f64
}

/// Area vectors of the fan of triangles from the middle of a hole to each of its sides, doubled.
fn fan(corners: &[Vector3<f64>]) -> impl Iterator<Item = Vector3<f64>> + '_ {
    let centre = middle(corners);
    (0..corners.len()).map(move |k| (corners[k] - centre).cross(&(corners[(k + 1) % corners.len()] - centre)))
}

pub(super) fn cap_area(corners: &[Vector3<f64>]) -> Vector3<f64> {
    fan(corners).sum::<Vector3<f64>>() / 2.0
}

/// Share of a corner in the two triangles of the cap that it is a corner of.
pub(super) fn cap_corner(corners: &[Vector3<f64>], k: usize) -> Vector3<f64> {
    let count = corners.len();
    let centre = middle(corners);
    let side = |k: usize| (corners[k] - centre).cross(&(corners[(k + 1) % count] - centre));
    (side((k + count - 1) % count) + side(k)) / 6.0
}

pub(super) fn cap_volume(corners: &[Vector3<f64>]) -> f64 {
    let centre = middle(corners);
    let count = corners.len();
    let tetrahedron = |(k, normal): (usize, Vector3<f64>)| {
        (centre + corners[k] + corners[(k + 1) % count]).dot(&normal) / 18.0
    };
    fan(corners).enumerate().map(tetrahedron).sum()
}

/// The holes of a mesh as loops of points, against the direction of the faces beside them.
pub(super) fn boundary_loops(surface: &Surface) -> Vec<Vec<u32>> {
    let mut sides: Vec<[u32; 2]> = surface
        .faces
        .iter()
        .flat_map(|face| (0..face.len()).map(move |k| [face[k], face[(k + 1) % face.len()]]))
        .collect();
    sides.sort_unstable();
    let is_inner = |side: &[u32; 2]| sides.binary_search(&[side[1], side[0]]).is_ok();
    // From each point the way back along its side.
    let mut next: BTreeMap<u32, u32> =
        sides.iter().filter(|side| !is_inner(side)).map(|&[a, b]| (b, a)).collect();
    let mut loops = Vec::new();
    while let Some((first, mut point)) = next.pop_first() {
        let mut corners = vec![first];
        while point != first {
            corners.push(point);
            match next.remove(&point) {
                Some(following) => point = following,
                None => break, // a boundary that crosses itself ends where it was used before
            }
        }
        if corners.len() > 2 {
            loops.push(corners);
        }
    }
    loops
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::surface::Faces;

    /// A box of 1 × 1 × 1 m of quads that face outwards, without its top if it is open.
    fn unit_box(open: bool) -> Surface {
        let positions = (0..8u32)
            .map(|k| Vector3::new(f64::from(k & 1), f64::from(k >> 1 & 1), f64::from(k >> 2)))
            .collect();
        let faces: [[u32; 4]; 6] =
            [[4, 5, 7, 6], [0, 2, 3, 1], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        let faces = faces[usize::from(open)..].iter().map(|face| &face[..]).collect::<Faces>();
        Surface { positions, faces }
    }

    #[test]
    fn a_box_without_its_top_has_one_hole_whose_cap_faces_up() {
        let surface = unit_box(true);
        let loops = boundary_loops(&surface);
        assert_eq!(loops.len(), 1);
        let corners: Vec<_> = loops[0].iter().map(|&point| surface.positions[point as usize]).collect();
        assert_eq!(cap_area(&corners), Vector3::new(0.0, 0.0, 1.0));
        assert!((cap_volume(&corners) - 1.0 / 3.0).abs() < 1e-15, "a pyramid from the origin to the top");
        assert!(boundary_loops(&unit_box(false)).is_empty());
    }
}
