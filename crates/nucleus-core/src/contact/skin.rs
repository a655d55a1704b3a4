//! What of a mesh can touch: its points, edges and triangles (§2.3), in small groups of neighbours.
//!
//! Each point and each edge is owned by one triangle, so that walking over pairs of triangles meets every
//! pair of lower elements once: whenever two elements are near, so are the triangles that own them.

use std::ops::Range;

use nalgebra::Vector3;

use crate::model::{by_halves, triangle_edges};

/// The elements of one object, in the solver's places.
#[derive(Debug, Clone, Default)]
pub struct Skin {
    /// Triangles, those that lie together one after the other.
    pub triangles: Vec<[u32; 3]>,
    /// Edges, in the order of their owners.
    pub edges: Vec<[u32; 2]>,
    /// Points, in the order of their owners; points of no triangle come last.
    pub points: Vec<u32>,
    /// Where each triangle's own edges end, and its own points.
    edge_ends: Vec<u32>,
    point_ends: Vec<u32>,
}

/// Triangles in an order in which any run of a power of two of them lies together.
pub fn by_place(triangles: &[[u32; 3]], place: impl Fn(u32) -> Vector3<f64>) -> Vec<[u32; 3]> {
    let centre = |corners: &[u32; 3]| corners.iter().map(|&corner| place(corner)).sum::<Vector3<f64>>() / 3.0;
    let centres: Vec<_> = triangles.iter().map(centre).collect();
    by_halves(&centres, 2).into_iter().map(|at| triangles[at as usize]).collect()
}

/// A run of neighbouring elements.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Group {
    /// Runs in the columns of the skin.
    pub triangles: Range<usize>,
    /// Edges owned by these triangles.
    pub edges: Range<usize>,
    /// Points owned by these triangles.
    pub points: Range<usize>,
}

impl Skin {
    /// The elements of a mesh of `points` points, in the order of its triangles.
    pub fn new(triangles: Vec<[u32; 3]>, points: Range<u32>) -> Self {
        let mut skin = Self::default();
        let mut owned_points = vec![false; points.len()];
        let edges = triangle_edges(&triangles);
        let mut owned_edges = vec![false; edges.len()];
        for &[a, b, c] in &triangles {
            for point in [a, b, c] {
                if !std::mem::replace(&mut owned_points[(point - points.start) as usize], true) {
                    skin.points.push(point);
                }
            }
            for [p, q] in [[a, b], [b, c], [c, a]] {
                let ends = [p.min(q), p.max(q)];
                // The list holds every side of every triangle.
                let Ok(edge) = edges.binary_search(&ends) else { continue };
                if !std::mem::replace(&mut owned_edges[edge], true) {
                    skin.edges.push(ends);
                }
            }
            skin.edge_ends.push(skin.edges.len() as u32);
            skin.point_ends.push(skin.points.len() as u32);
        }
        skin.points.extend(points.clone().filter(|point| !owned_points[(point - points.start) as usize]));
        skin.triangles = triangles;
        skin
    }

    /// The elements owned by one triangle.
    pub fn owned(&self, triangle: usize) -> Group {
        self.owned_by(triangle..triangle + 1)
    }

    /// All elements in groups of neighbours, of so many triangles each; free points in groups of their own, of as many.
    pub fn groups(&self, size: usize) -> impl Iterator<Item = Group> + '_ {
        let in_faces = self.point_ends.last().map_or(0, |&end| end as usize);
        let free = self.points.len() - in_faces;
        let groups = self.triangles.len().div_ceil(size) + free.div_ceil(size);
        (0..groups).map(move |index| self.group(index, size))
    }

    /// One of them, by its place among them.
    pub fn group(&self, index: usize, size: usize) -> Group {
        let triangles = self.triangles.len();
        let of_triangles = triangles.div_ceil(size);
        if index < of_triangles {
            return self.owned_by(index * size..((index + 1) * size).min(triangles));
        }
        let in_faces = self.point_ends.last().map_or(0, |&end| end as usize);
        let from = in_faces + (index - of_triangles) * size;
        Group { triangles: 0..0, edges: 0..0, points: from..(from + size).min(self.points.len()) }
    }

    fn owned_by(&self, triangles: Range<usize>) -> Group {
        let before = |ends: &[u32]| triangles.start.checked_sub(1).map_or(0, |k| ends[k] as usize);
        let last = triangles.end - 1;
        Group {
            edges: before(&self.edge_ends)..self.edge_ends[last] as usize,
            points: before(&self.point_ends)..self.point_ends[last] as usize,
            triangles,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    // EVIDENCE: N2.3-1  points, edges and faces: each lower element belongs to one face that has it
    #[test]
    fn every_point_and_edge_is_owned_by_one_triangle_that_has_it() {
        // Two triangles on a shared edge, and a point of no face.
        let skin = Skin::new(vec![[0, 1, 2], [2, 1, 3]], 0..5);
        assert_eq!(skin.edges.len(), 5);
        assert_eq!(skin.points.len(), 5);
        for triangle in 0..2 {
            let (owned, corners) = (skin.owned(triangle), skin.triangles[triangle]);
            assert!(skin.points[owned.points].iter().all(|point| corners.contains(point)));
            assert!(skin.edges[owned.edges].iter().flatten().all(|point| corners.contains(point)));
        }
        let grouped: usize = skin.groups(2).map(|group| group.points.len()).sum();
        assert_eq!(grouped, 5, "the free point has a group too");
    }
}
