//! Measures of meshes: area, volume, bounding box, open edges.

use nalgebra::Vector3;
use nucleus_core::Faces;

/// A vector along the normal of a triangle, of twice its area.
pub(crate) fn doubled_area(points: &[Vector3<f64>], corners: [u32; 3]) -> Vector3<f64> {
    let [a, b, c] = corners.map(|corner| points[corner as usize]);
    (b - a).cross(&(c - a))
}

/// The area of some faces in the square of the unit of length.
pub(crate) fn area(faces: &Faces, points: &[Vector3<f64>]) -> f64 {
    faces.triangles().map(|corners| doubled_area(points, corners).norm() / 2.0).sum()
}

/// The volume inside some faces in the cube of the unit of length; negative where they face inwards.
pub(crate) fn volume(faces: &Faces, points: &[Vector3<f64>]) -> f64 {
    // Relative to a point of the mesh, so that one far from the origin loses nothing.
    let origin = points.first().copied().unwrap_or_default();
    let sixfold =
        |corners: [u32; 3]| (points[corners[0] as usize] - origin).dot(&doubled_area(points, corners));
    faces.triangles().map(sixfold).sum::<f64>() / 6.0
}

/// The lower and the upper corner of the bounding box; the origin without points.
pub(crate) fn bounding_box(points: &[Vector3<f64>]) -> [Vector3<f64>; 2] {
    let first = points.first().copied().unwrap_or_default();
    points.iter().fold([first; 2], |[low, high], point| [low.inf(point), high.sup(point)])
}

/// The sides of all faces, in the direction of each face.
pub(crate) fn sides(faces: &Faces) -> impl Iterator<Item = [u32; 2]> + '_ {
    faces.iter().flat_map(|face| (0..face.len()).map(|k| [face[k], face[(k + 1) % face.len()]]))
}

/// Whether an edge belongs to one face only.
pub(crate) fn is_open(faces: &Faces) -> bool {
    faces_per_edge(faces).contains(&1)
}

/// Whether every edge has two faces.
pub(crate) fn is_closed(faces: &Faces) -> bool {
    faces_per_edge(faces).iter().all(|count| *count == 2)
}

/// The number of faces of each edge.
fn faces_per_edge(faces: &Faces) -> Vec<usize> {
    let mut edges: Vec<[u32; 2]> = sides(faces).map(|[a, b]| [a.min(b), a.max(b)]).collect();
    edges.sort_unstable();
    edges.chunk_by(|a, b| a == b).map(<[_]>::len).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sheet_is_open_and_a_tetrahedron_closed() {
        let of = |all: &[&[u32]]| {
            let mut faces = Faces::default();
            all.iter().for_each(|face| faces.push(face));
            [is_open(&faces), is_closed(&faces)]
        };
        assert_eq!(of(&[&[0, 1, 2, 3]]), [true, false]);
        assert_eq!(of(&[&[0, 2, 1], &[0, 1, 3], &[1, 2, 3], &[2, 0, 3]]), [false, true]);
        // An edge of three faces is neither.
        let fin = [&[0, 2, 1][..], &[0, 1, 3], &[1, 2, 3], &[2, 0, 3], &[0, 1, 4]];
        assert_eq!(of(&fin), [true, false]);
    }

    #[test]
    fn a_rectangle_has_its_area_and_its_bounds() {
        let points = [[0.0, 1.0, 0.0], [2.0, 1.0, 0.0], [2.0, 1.0, 3.0], [0.0, 1.0, 3.0]].map(Vector3::from);
        let mut faces = Faces::default();
        faces.push(&[0, 1, 2, 3]);
        assert_eq!(area(&faces, &points), 6.0);
        assert_eq!(bounding_box(&points), [points[0], points[2]]);
    }

    #[test]
    fn a_tetrahedron_has_its_volume_anywhere_and_a_negative_one_inside_out() {
        let at = |place: f64| {
            let corners = [[0.0; 3], [2.0, 0.0, 0.0], [0.0, 3.0, 0.0], [0.0, 0.0, 4.0]];
            corners.map(|corner| Vector3::from(corner) + Vector3::repeat(place))
        };
        let mut faces = Faces::default();
        [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]].iter().for_each(|face| faces.push(face));
        assert_eq!([volume(&faces, &at(0.0)), volume(&faces, &at(-64.0))], [4.0; 2]);
        let mut inside_out = Faces::default();
        [[0, 1, 2], [0, 3, 1], [1, 3, 2], [2, 3, 0]].iter().for_each(|face| inside_out.push(face));
        assert_eq!(volume(&inside_out, &at(8.0)), -4.0);
    }
}
