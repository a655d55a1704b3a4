//! Edge-face intersections in a state, with exact predicates: signs of volumes and areas (Shewchuk 1997).

use nalgebra::{Vector2, Vector3};
use robust::{Coord, Coord3D, orient2d, orient3d};

use crate::bvh::{Aabb, Bvh};
use crate::collision_filter::CollisionFilter;
use crate::collision_mesh::{CollisionMesh, EdgeId, FaceId};
use crate::parallel::parallel_chunks;

/// An edge that intersects a face in a state.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Intersection {
    /// The edge.
    pub edge: EdgeId,
    /// The face.
    pub face: FaceId,
    /// How they intersect; never [`IntersectionKind::Separated`].
    pub kind: IntersectionKind,
}

/// The edge-face pairs with a common point, in order. Positions are those of all bodies, one body after the other.
///
/// # Panics
/// When the number of positions differs from the number of points.
pub fn intersections(
    mesh: &CollisionMesh,
    filter: &CollisionFilter,
    positions: &[Vector3<f64>],
) -> Vec<Intersection> {
    assert!(positions.len() == mesh.points(), "a position for every point");
    let at = |point: u32| &positions[point as usize];
    let boxes: Vec<Aabb> = mesh.triangles().iter().map(|corners| Aabb::of(corners.map(at))).collect();
    let tree = Bvh::new(filter.active_elements(mesh, mesh.triangles()), &boxes);
    let mut found = parallel_chunks(&filter.active_elements(mesh, mesh.edges()), |edges| {
        let (mut stack, mut found) = (Vec::new(), Vec::new());
        for &edge in edges {
            let ends = &mesh.edges()[edge as usize];
            tree.query(&Aabb::of(ends.map(at)), &boxes, &mut stack, |face| {
                let corners = &mesh.triangles()[face as usize];
                if filter.apply(mesh, ends, corners) {
                    let kind = intersect_edge_face(&ends.map(|p| *at(p)), &corners.map(|p| *at(p)));
                    if kind != IntersectionKind::Separated {
                        found.push(Intersection { edge: EdgeId(edge), face: FaceId(face), kind });
                    }
                }
            });
        }
        found
    });
    found.sort_by_key(|found| (found.edge, found.face));
    found
}

/// Relation of an edge and a face.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum IntersectionKind {
    /// No common point.
    Separated,
    /// The edge passes through the face; its ends lie strictly on different sides.
    Through,
    /// A common point without ends on both sides: an end lies in the face, or both lie in its plane.
    Touching,
    /// A coordinate is not finite.
    Undecided,
}

/// Relation of an edge and a face. A degenerate face intersects nothing; its edges are tested as edges.
pub fn intersect_edge_face(edge: &[Vector3<f64>; 2], face: &[Vector3<f64>; 3]) -> IntersectionKind {
    if !edge.iter().chain(face).all(|point| point.iter().all(|x| x.is_finite())) {
        return IntersectionKind::Undecided;
    }
    let ([a, b], [u, v, w]) = (edge, face);
    let (start, end) = (side(u, v, w, a), side(u, v, w, b));
    if start == 0 && end == 0 {
        return if touches_in_plane(edge, face) {
            IntersectionKind::Touching
        } else {
            IntersectionKind::Separated
        };
    }
    if start == end {
        return IntersectionKind::Separated;
    }
    let turns = [side(a, b, u, v), side(a, b, v, w), side(a, b, w, u)];
    let misses = turns.contains(&1) && turns.contains(&-1);
    match (misses, start != 0 && end != 0) {
        (true, _) => IntersectionKind::Separated,
        (false, true) => IntersectionKind::Through,
        (false, false) => IntersectionKind::Touching,
    }
}

/// Side of the plane through three points on which the fourth lies: -1, 0 or 1.
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

/// All five points are coplanar; projects along an axis in which the face keeps its area.
fn touches_in_plane(edge: &[Vector3<f64>; 2], face: &[Vector3<f64>; 3]) -> bool {
    [[0, 1], [1, 2], [2, 0]].iter().any(|&[x, y]| {
        let flat = |point: &Vector3<f64>| Vector2::new(point[x], point[y]);
        let ([a, b], [u, v, w]) = (edge.each_ref().map(flat), face.each_ref().map(flat));
        let [v, w] = match turn(&u, &v, &w) {
            0 => return false,
            1 => [v, w],
            _ => [w, v],
        };
        // Convex sets in a plane are disjoint if and only if the line through a side of one separates them.
        let outside =
            [[u, v], [v, w], [w, u]].iter().any(|[p, q]| [&a, &b].iter().all(|end| turn(p, q, end) < 0));
        let corners = [&u, &v, &w].map(|corner| turn(&a, &b, corner));
        let on_one_side = corners.iter().all(|&turn| turn > 0) || corners.iter().all(|&turn| turn < 0);
        !outside && !on_one_side
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn face() -> [Vector3<f64>; 3] {
        [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0]].map(Vector3::from)
    }

    fn with(a: [f64; 3], b: [f64; 3]) -> IntersectionKind {
        intersect_edge_face(&[a, b].map(Vector3::from), &face())
    }

    #[test]
    fn an_edge_passes_through_a_face_or_misses_it() {
        assert_eq!(with([1.0, 1.0, -1.0], [1.0, 1.0, 1.0]), IntersectionKind::Through);
        assert_eq!(with([1.0, 1.0, 0.5], [1.0, 1.0, 1.0]), IntersectionKind::Separated);
        assert_eq!(with([3.0, 3.0, -1.0], [3.0, 3.0, 1.0]), IntersectionKind::Separated);
    }

    #[test]
    fn an_edge_through_a_side_or_a_corner_goes_through() {
        assert_eq!(with([2.0, 0.0, -1.0], [2.0, 0.0, 1.0]), IntersectionKind::Through);
        assert_eq!(with([0.0, 0.0, -1.0], [0.0, 0.0, 1.0]), IntersectionKind::Through);
        assert_eq!(with([-f64::EPSILON, 0.0, -1.0], [-f64::EPSILON, 0.0, 1.0]), IntersectionKind::Separated);
    }

    #[test]
    fn an_end_in_the_face_touches() {
        assert_eq!(with([1.0, 1.0, 0.0], [1.0, 1.0, 1.0]), IntersectionKind::Touching);
        assert_eq!(with([5.0, 5.0, 0.0], [1.0, 1.0, 1.0]), IntersectionKind::Separated);
        assert_eq!(with([1.0, 1.0, 5e-324], [1.0, 1.0, 1.0]), IntersectionKind::Separated);
    }

    #[test]
    fn coplanar_edges_touch_a_face_only_where_they_overlap_it() {
        for (b, expected) in
            [([9.0, 1.0, 0.0], IntersectionKind::Touching), ([-9.0, 1.0, 0.0], IntersectionKind::Separated)]
        {
            assert_eq!(with([-1.0, 1.0, 0.0], b), expected, "{b:?}");
        }
        assert_eq!(with([1.0, 1.0, 0.0], [1.5, 1.0, 0.0]), IntersectionKind::Touching, "it lies inside");
        assert_eq!(with([2.0, 2.0, 0.0], [3.0, 3.0, 0.0]), IntersectionKind::Touching, "it begins on a side");
        assert_eq!(with([2.0, 2.1, 0.0], [3.0, 3.0, 0.0]), IntersectionKind::Separated);
        assert_eq!(
            with([4.0, 0.0, 0.0], [6.0, 0.0, 0.0]),
            IntersectionKind::Touching,
            "on the line of a side"
        );
        assert_eq!(
            with([4.5, 0.0, 0.0], [6.0, 0.0, 0.0]),
            IntersectionKind::Separated,
            "on the line of a side"
        );
    }

    #[test]
    fn a_face_without_area_intersects_nothing() {
        let flat = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0]].map(Vector3::from);
        let edge = [[1.0, 0.0, -1.0], [1.0, 0.0, 1.0]].map(Vector3::from);
        assert_eq!(intersect_edge_face(&edge, &flat), IntersectionKind::Separated);
    }

    #[test]
    fn coordinates_that_are_not_finite_are_undecided() {
        assert_eq!(with([f64::NAN, 0.0, 0.0], [1.0, 1.0, 1.0]), IntersectionKind::Undecided);
    }
}
