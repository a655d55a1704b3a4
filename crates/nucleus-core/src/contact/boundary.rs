//! Boundary elements of a mesh: the points, edges and triangles that can touch (§2.3), in small groups of
//! neighbours; and the pseudonormals of a closed mesh.
//!
//! Each point and each edge is owned by one triangle. A walk over pairs of triangles therefore visits every pair
//! of lower elements once: whenever two elements are near, so are the triangles that own them.

use std::ops::Range;

use nalgebra::Vector3;

use crate::model::order::by_halves;
use crate::model::topology::triangle_edges;

/// The boundary elements of one object, in the solver's rows.
#[derive(Debug, Clone, Default)]
pub struct BoundaryElements {
    /// Triangles, sorted spatially.
    pub triangles: Vec<[u32; 3]>,
    /// Edges, in the order of their owners.
    pub edges: Vec<[u32; 2]>,
    /// Points, in the order of their owners; points of no triangle come last.
    pub points: Vec<u32>,
    /// The end of each triangle's own edges, and of its own points.
    edge_ends: Vec<u32>,
    point_ends: Vec<u32>,
    /// Points in use: the first of `points`. Fewer than all where particles are to be born.
    live: usize,
}

/// The unit normal of a triangle; zero where it has no area.
pub fn unit_normal([a, b, c]: [Vector3<f64>; 3]) -> Vector3<f64> {
    (b - a).cross(&(c - a)).try_normalize(0.0).unwrap_or_default()
}

/// Sorts triangles so that any aligned run of a power of two of them is spatially compact.
pub fn sort_spatially(triangles: &[[u32; 3]], place: impl Fn(u32) -> Vector3<f64>) -> Vec<[u32; 3]> {
    let centre = |corners: &[u32; 3]| corners.iter().map(|&corner| place(corner)).sum::<Vector3<f64>>() / 3.0;
    let centres: Vec<_> = triangles.iter().map(centre).collect();
    by_halves(&centres, 2).into_iter().map(|at| triangles[at as usize]).collect()
}

/// A run of neighbouring elements.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ElementGroup {
    /// Runs in the columns of [`BoundaryElements`].
    pub triangles: Range<usize>,
    /// Edges owned by these triangles.
    pub edges: Range<usize>,
    /// Points owned by these triangles.
    pub points: Range<usize>,
}

impl BoundaryElements {
    /// The elements of a mesh of `points` points, in the order of its triangles.
    pub fn new(triangles: Vec<[u32; 3]>, points: Range<u32>) -> Self {
        let mut boundary = Self::default();
        let mut owned_points = vec![false; points.len()];
        let edges = triangle_edges(&triangles);
        let mut owned_edges = vec![false; edges.len()];
        for &[a, b, c] in &triangles {
            for point in [a, b, c] {
                if !std::mem::replace(&mut owned_points[(point - points.start) as usize], true) {
                    boundary.points.push(point);
                }
            }
            for [p, q] in [[a, b], [b, c], [c, a]] {
                let ends = [p.min(q), p.max(q)];
                // `edges` holds every side of every triangle.
                let Ok(edge) = edges.binary_search(&ends) else { continue };
                if !std::mem::replace(&mut owned_edges[edge], true) {
                    boundary.edges.push(ends);
                }
            }
            boundary.edge_ends.push(boundary.edges.len() as u32);
            boundary.point_ends.push(boundary.points.len() as u32);
        }
        boundary.points.extend(points.clone().filter(|point| !owned_points[(point - points.start) as usize]));
        boundary.triangles = triangles;
        boundary.live = boundary.points.len();
        boundary
    }

    /// Uses only the first `points` points of an object without faces.
    pub fn resize(&mut self, points: usize) {
        self.live = points.min(self.points.len());
    }

    /// The elements owned by one triangle.
    pub fn owned(&self, triangle: usize) -> ElementGroup {
        self.owned_by(triangle..triangle + 1)
    }

    /// All elements in groups of `size` triangles. Free points form groups of their own, of as many.
    pub fn groups(&self, size: usize) -> impl Iterator<Item = ElementGroup> + '_ {
        (0..self.group_count(size)).map(move |index| self.group(index, size))
    }

    /// The number of these groups.
    pub fn group_count(&self, size: usize) -> usize {
        let in_faces = self.point_ends.last().map_or(0, |&end| end as usize);
        let free = self.live - in_faces;
        self.triangles.len().div_ceil(size) + free.div_ceil(size)
    }

    /// One of these groups, by its index.
    pub fn group(&self, index: usize, size: usize) -> ElementGroup {
        let triangles = self.triangles.len();
        let of_triangles = triangles.div_ceil(size);
        if index < of_triangles {
            return self.owned_by(index * size..((index + 1) * size).min(triangles));
        }
        let in_faces = self.point_ends.last().map_or(0, |&end| end as usize);
        let from = in_faces + (index - of_triangles) * size;
        ElementGroup { triangles: 0..0, edges: 0..0, points: from..(from + size).min(self.live) }
    }

    fn owned_by(&self, triangles: Range<usize>) -> ElementGroup {
        let before = |ends: &[u32]| triangles.start.checked_sub(1).map_or(0, |k| ends[k] as usize);
        let last = triangles.end - 1;
        ElementGroup {
            edges: before(&self.edge_ends)..self.edge_ends[last] as usize,
            points: before(&self.point_ends)..self.point_ends[last] as usize,
            triangles,
        }
    }
}

/// The incident faces of each edge and each point of a closed mesh, for angle-free pseudonormals.
#[derive(Debug, Clone, PartialEq)]
pub struct Pseudonormals {
    /// The two faces of each edge.
    edges: Vec<[u32; 2]>,
    /// The faces of each point, one list after another, and the end of each list.
    faces: Vec<u32>,
    ends: Vec<u32>,
}

impl Pseudonormals {
    /// `None` where the mesh is not closed and consistently oriented: each side of a triangle must be a side of
    /// exactly one other, in the other direction.
    pub fn of(boundary: &BoundaryElements) -> Option<Self> {
        let mut sides: Vec<([u32; 2], bool, u32)> = Vec::with_capacity(boundary.triangles.len() * 3);
        for (face, &[a, b, c]) in (0..).zip(&boundary.triangles) {
            sides.extend([[a, b], [b, c], [c, a]].map(|[p, q]| ([p.min(q), p.max(q)], p < q, face)));
        }
        sides.sort_unstable();
        let is_pair = |pair: &[([u32; 2], bool, u32)]| pair.len() == 2 && pair[0].1 != pair[1].1;
        if sides.is_empty() || !sides.chunk_by(|a, b| a.0 == b.0).all(is_pair) {
            return None;
        }
        let faces_of = |edge: &[u32; 2]| {
            let at = sides.partition_point(|side| side.0 < *edge);
            [sides[at].2, sides[at + 1].2]
        };
        let edges = boundary.edges.iter().map(faces_of).collect();
        let mut corners: Vec<(u32, u32)> = (0..)
            .zip(&boundary.triangles)
            .flat_map(|(face, triangle)| triangle.map(|point| (point, face)))
            .collect();
        corners.sort_unstable();
        let mut pseudonormals = Self { edges, faces: Vec::new(), ends: Vec::new() };
        for &point in &boundary.points {
            let from = corners.partition_point(|corner| corner.0 < point);
            let of_point = corners[from..].iter().take_while(|corner| corner.0 == point);
            pseudonormals.faces.extend(of_point.map(|corner| corner.1));
            pseudonormals.ends.push(pseudonormals.faces.len() as u32);
        }
        Some(pseudonormals)
    }

    /// The sum of the face normals at an edge: points outwards, of any length.
    pub fn at_edge(&self, edge: usize, normal: impl Fn(u32) -> Vector3<f64>) -> Vector3<f64> {
        self.edges[edge].into_iter().map(normal).sum()
    }

    /// The sum of the face normals at a point: points outwards, of any length.
    pub fn at_point(&self, point: usize, normal: impl Fn(u32) -> Vector3<f64>) -> Vector3<f64> {
        let from = point.checked_sub(1).map_or(0, |before| self.ends[before]);
        self.faces[from as usize..self.ends[point] as usize].iter().map(|&face| normal(face)).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    // EVIDENCE: N2.3-1  points, edges and faces: each lower element belongs to one face that has it
    #[test]
    fn every_point_and_edge_is_owned_by_one_triangle_that_has_it() {
        // Two triangles on a shared edge, and a point of no face.
        let boundary = BoundaryElements::new(vec![[0, 1, 2], [2, 1, 3]], 0..5);
        assert_eq!(boundary.edges.len(), 5);
        assert_eq!(boundary.points.len(), 5);
        for triangle in 0..2 {
            let (owned, corners) = (boundary.owned(triangle), boundary.triangles[triangle]);
            assert!(boundary.points[owned.points].iter().all(|point| corners.contains(point)));
            assert!(boundary.edges[owned.edges].iter().flatten().all(|point| corners.contains(point)));
        }
        let grouped: usize = boundary.groups(2).map(|group| group.points.len()).sum();
        assert_eq!(grouped, 5, "the free point has a group too");
    }

    const TETRAHEDRON: [[u32; 3]; 4] = [[0, 1, 2], [0, 3, 1], [1, 3, 2], [2, 3, 0]];

    #[test]
    fn only_closed_and_consistently_oriented_meshes_have_pseudonormals() {
        assert!(Pseudonormals::of(&BoundaryElements::new(TETRAHEDRON.to_vec(), 0..4)).is_some());
        assert!(
            Pseudonormals::of(&BoundaryElements::new(TETRAHEDRON[..3].to_vec(), 0..4)).is_none(),
            "it has a hole"
        );
        let turned = [[0, 1, 2], [0, 1, 3], [1, 3, 2], [2, 3, 0]];
        assert!(
            Pseudonormals::of(&BoundaryElements::new(turned.to_vec(), 0..4)).is_none(),
            "a face is turned"
        );
    }

    #[test]
    fn pseudonormals_of_a_tetrahedron_point_away_from_its_centre() {
        let boundary = BoundaryElements::new(TETRAHEDRON.to_vec(), 0..4);
        let pseudonormals = Pseudonormals::of(&boundary).expect("it is closed");
        let place = |point: u32| {
            let corners: [[f64; 3]; 4] =
                [[1.0, 1.0, 1.0], [1.0, -1.0, -1.0], [-1.0, 1.0, -1.0], [-1.0, -1.0, 1.0]];
            Vector3::from(corners[point as usize])
        };
        let normal = |face: u32| {
            let [a, b, c] = boundary.triangles[face as usize].map(place);
            (b - a).cross(&(c - a)).normalize()
        };
        let sign = normal(0).dot(&place(boundary.triangles[0][0])).signum();
        for (edge, &[a, b]) in boundary.edges.iter().enumerate() {
            assert!(sign * pseudonormals.at_edge(edge, normal).dot(&(place(a) + place(b))) > 0.0);
        }
        for (at, &point) in boundary.points.iter().enumerate() {
            assert!(sign * pseudonormals.at_point(at, normal).dot(&place(point)) > 0.0);
        }
    }
}
