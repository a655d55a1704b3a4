//! Whether an edge and a face have a point in common, exactly: signs of volumes and areas as of Shewchuk 1997.

use nalgebra::{Vector2, Vector3};
use robust::{Coord, Coord3D, orient2d, orient3d};

/// How an edge and a face lie.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Overlap {
    /// They have no point in common.
    Apart,
    /// The edge goes through the face, its ends on different sides.
    Through,
    /// They have a point in common, and no end of the edge is on the other side of the face: an end in the face, or
    /// both in its plane.
    Touching,
    /// A coordinate is not finite.
    Undecided,
}

/// How an edge and a face lie. A face without area is no face; its edges meet others as edges do.
pub fn overlap(edge: &[Vector3<f64>; 2], face: &[Vector3<f64>; 3]) -> Overlap {
    if !edge.iter().chain(face).all(|point| point.iter().all(|x| x.is_finite())) {
        return Overlap::Undecided;
    }
    let ([a, b], [u, v, w]) = (edge, face);
    let (start, end) = (side(u, v, w, a), side(u, v, w, b));
    if start == 0 && end == 0 {
        return if touches_in_plane(edge, face) { Overlap::Touching } else { Overlap::Apart };
    }
    if start == end {
        return Overlap::Apart;
    }
    let turns = [side(a, b, u, v), side(a, b, v, w), side(a, b, w, u)];
    let goes_by = turns.contains(&1) && turns.contains(&-1);
    match (goes_by, start != 0 && end != 0) {
        (true, _) => Overlap::Apart,
        (false, true) => Overlap::Through,
        (false, false) => Overlap::Touching,
    }
}

/// The side of the plane through three points that a fourth is on: -1, 0 or 1.
fn side(a: &Vector3<f64>, b: &Vector3<f64>, c: &Vector3<f64>, d: &Vector3<f64>) -> i8 {
    let [a, b, c, d] = [a, b, c, d].map(|p| Coord3D { x: p.x, y: p.y, z: p.z });
    sign(orient3d(a, b, c, d))
}

fn turn(a: &Vector2<f64>, b: &Vector2<f64>, c: &Vector2<f64>) -> i8 {
    let [a, b, c] = [a, b, c].map(|p| Coord { x: p.x, y: p.y });
    sign(orient2d(a, b, c))
}

fn sign(x: f64) -> i8 {
    i8::from(x > 0.0) - i8::from(x < 0.0)
}

/// All five points in one plane, seen along an axis that leaves the face its area.
fn touches_in_plane(edge: &[Vector3<f64>; 2], face: &[Vector3<f64>; 3]) -> bool {
    [[0, 1], [1, 2], [2, 0]].iter().any(|&[x, y]| {
        let flat = |point: &Vector3<f64>| Vector2::new(point[x], point[y]);
        let ([a, b], [u, v, w]) = (edge.each_ref().map(flat), face.each_ref().map(flat));
        let [v, w] = match turn(&u, &v, &w) {
            0 => return false,
            1 => [v, w],
            _ => [w, v],
        };
        // They are apart if and only if the line through a side of either separates them.
        let outside =
            [[u, v], [v, w], [w, u]].iter().any(|[p, q]| [&a, &b].iter().all(|end| turn(p, q, end) < 0));
        let corners = [&u, &v, &w].map(|corner| turn(&a, &b, corner));
        let beside = corners.iter().all(|&turn| turn > 0) || corners.iter().all(|&turn| turn < 0);
        !outside && !beside
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn face() -> [Vector3<f64>; 3] {
        [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0]].map(Vector3::from)
    }

    fn with(a: [f64; 3], b: [f64; 3]) -> Overlap {
        overlap(&[a, b].map(Vector3::from), &face())
    }

    #[test]
    fn an_edge_goes_through_or_by() {
        assert_eq!(with([1.0, 1.0, -1.0], [1.0, 1.0, 1.0]), Overlap::Through);
        assert_eq!(with([1.0, 1.0, 0.5], [1.0, 1.0, 1.0]), Overlap::Apart);
        assert_eq!(with([3.0, 3.0, -1.0], [3.0, 3.0, 1.0]), Overlap::Apart);
    }

    #[test]
    fn an_edge_through_a_side_or_a_corner_goes_through() {
        assert_eq!(with([2.0, 0.0, -1.0], [2.0, 0.0, 1.0]), Overlap::Through);
        assert_eq!(with([0.0, 0.0, -1.0], [0.0, 0.0, 1.0]), Overlap::Through);
        assert_eq!(with([-f64::EPSILON, 0.0, -1.0], [-f64::EPSILON, 0.0, 1.0]), Overlap::Apart);
    }

    #[test]
    fn an_end_in_the_face_touches() {
        assert_eq!(with([1.0, 1.0, 0.0], [1.0, 1.0, 1.0]), Overlap::Touching);
        assert_eq!(with([5.0, 5.0, 0.0], [1.0, 1.0, 1.0]), Overlap::Apart);
        assert_eq!(with([1.0, 1.0, 5e-324], [1.0, 1.0, 1.0]), Overlap::Apart);
    }

    #[test]
    fn edges_in_the_plane_of_a_face_touch_it_or_not() {
        for (b, expected) in [([9.0, 1.0, 0.0], Overlap::Touching), ([-9.0, 1.0, 0.0], Overlap::Apart)] {
            assert_eq!(with([-1.0, 1.0, 0.0], b), expected, "{b:?}");
        }
        assert_eq!(with([1.0, 1.0, 0.0], [1.5, 1.0, 0.0]), Overlap::Touching, "it lies inside");
        assert_eq!(with([2.0, 2.0, 0.0], [3.0, 3.0, 0.0]), Overlap::Touching, "it begins on a side");
        assert_eq!(with([2.0, 2.1, 0.0], [3.0, 3.0, 0.0]), Overlap::Apart);
        assert_eq!(with([4.0, 0.0, 0.0], [6.0, 0.0, 0.0]), Overlap::Touching, "on the line of a side");
        assert_eq!(with([4.5, 0.0, 0.0], [6.0, 0.0, 0.0]), Overlap::Apart, "on the line of a side");
    }

    #[test]
    fn a_face_without_area_is_no_face() {
        let flat = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0]].map(Vector3::from);
        let edge = [[1.0, 0.0, -1.0], [1.0, 0.0, 1.0]].map(Vector3::from);
        assert_eq!(overlap(&edge, &flat), Overlap::Apart);
    }

    #[test]
    fn what_is_not_finite_is_undecided() {
        assert_eq!(with([f64::NAN, 0.0, 0.0], [1.0, 1.0, 1.0]), Overlap::Undecided);
    }
}
