//! Tearable surfaces: a mesh that is split where it can tear, and the welds that keep it whole until then.
//!
//! As in Maya the split exists from the start: every face that meets a tearable point gets a point of its own there, and
//! faces that share an edge are joined at both of its ends. Topology never changes, and a tear runs along edges. A weld
//! stands for half of its edge, so the load that tears it is per length of edge.

use std::collections::BTreeMap;

use nucleus_core::{Faces, Surface, VertexMaps};

use crate::graph::NodeId;

/// A cloth mesh that is split where it can tear.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Tearing {
    /// The number of points of the mesh as it was given; further points are twins.
    pub(super) points: usize,
    /// The point that each further point was split off.
    pub(crate) twins: Vec<u32>,
    /// The faces of the split mesh.
    split: Faces,
    pub(super) seams: Vec<Seam>,
    pub(super) creases: Vec<Crease>,
}

/// Two points that a weld joins: one end of an edge that can tear.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Seam {
    pub(super) constraint: NodeId,
    pub(super) points: [u32; 2],
    /// The ends of the edge, in the mesh as it was given.
    pub(super) edge: [u32; 2],
}

/// The two faces of an edge that can tear.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Crease {
    pub(super) constraint: NodeId,
    /// Of each face the ends of the edge, and the next corner behind each end.
    pub(super) sides: [[u32; 4]; 2],
}

impl Tearing {
    /// Splits a mesh. `tears` gives the constraint that can tear an edge at one of its ends.
    pub(super) fn new(faces: &Faces, points: usize, tears: impl Fn([u32; 2], u32) -> Option<NodeId>) -> Self {
        // Corners of faces round a point stay together where an edge between them cannot tear.
        let mut parents: Vec<usize> = (0..faces.corners().len()).collect();
        let TornEdges { torn, creased } = join_corners(faces, &mut parents, tears);
        let groups: Vec<usize> = (0..parents.len()).map(|corner| root(&mut parents, corner)).collect();
        let (own, twins) = points_of_corners(faces.corners(), points, &groups);
        let seam = |(constraint, edge, sides): (NodeId, [u32; 2], [usize; 2])| Seam {
            constraint,
            points: sides.map(|corner| own[corner]),
            edge,
        };
        let crease = |(constraint, sides): (NodeId, [[usize; 4]; 2])| Crease {
            constraint,
            sides: sides.map(|side| side.map(|corner| own[corner])),
        };
        Self {
            points,
            twins,
            split: with_corners(faces, &own),
            seams: torn.into_iter().map(seam).filter(|seam| seam.points[0] != seam.points[1]).collect(),
            creases: creased.into_iter().map(crease).collect(),
        }
    }

    /// A column of points, with twins where their originals are.
    pub(crate) fn extend<T: Clone>(&self, column: &mut Vec<T>) {
        if !column.is_empty() {
            let twins: Vec<T> = self.twins.iter().map(|&twin| column[twin as usize].clone()).collect();
            column.extend(twins);
        }
    }

    /// The split mesh.
    pub(crate) fn split(&self, mut surface: Surface) -> Surface {
        self.extend(&mut surface.positions);
        Surface { faces: self.split.clone(), ..surface }
    }

    /// Vertex maps of the split mesh. `shares_mass`: masses are given by point, and twins share that of their original.
    pub(crate) fn maps(&self, mut maps: VertexMaps, shares_mass: bool) -> VertexMaps {
        if shares_mass {
            if maps.mass.is_empty() {
                maps.mass = vec![1.0; self.points];
            }
            let mut copies = vec![1.0; self.points];
            self.twins.iter().for_each(|&twin| copies[twin as usize] += 1.0);
            maps.mass.iter_mut().zip(&copies).for_each(|(mass, copies)| *mass /= copies);
        }
        maps.columns_mut().for_each(|column| self.extend(column));
        maps
    }

    /// The twins of points of the mesh as it was given, those of the first point first.
    pub(super) fn twins_of(&self, points: &[u32]) -> Vec<u32> {
        let mut twins: Vec<(u32, u32)> = self.twins.iter().copied().zip(self.points as u32..).collect();
        twins.sort_unstable();
        let of = |&point: &u32| {
            let first = twins.partition_point(|(original, _)| *original < point);
            twins[first..].iter().take_while(move |(original, _)| *original == point).map(|(_, twin)| *twin)
        };
        points.iter().flat_map(of).collect()
    }
}

/// What can tear, in corners of faces.
struct TornEdges {
    /// Ends of edges, with their corners on both sides.
    torn: Vec<(NodeId, [u32; 2], [usize; 2])>,
    /// Edges, with the corners of both faces.
    creased: Vec<(NodeId, [[usize; 4]; 2])>,
}

/// The edges of a mesh, each with its faces in order: the corners at its ends, the lower first, and the next one behind each.
fn sides_of_edges(faces: &Faces) -> BTreeMap<[u32; 2], Vec<[usize; 4]>> {
    let mut found: BTreeMap<[u32; 2], Vec<[usize; 4]>> = BTreeMap::new();
    let mut first = 0;
    for face in faces.iter() {
        for k in 0..face.len() {
            let at = |step: usize| first + (k + step) % face.len();
            let (a, b) = (face[k], face[(k + 1) % face.len()]);
            let behind = [at(face.len() - 1), at(2)];
            let ends = match a < b {
                true => [at(0), at(1), behind[0], behind[1]],
                false => [at(1), at(0), behind[1], behind[0]],
            };
            found.entry([a.min(b), a.max(b)]).or_default().push(ends);
        }
        first += face.len();
    }
    found
}

/// Joins the corners on both sides of an edge at the ends where it cannot tear.
fn join_corners(
    faces: &Faces,
    parents: &mut [usize],
    tears: impl Fn([u32; 2], u32) -> Option<NodeId>,
) -> TornEdges {
    let mut edges = TornEdges { torn: Vec::new(), creased: Vec::new() };
    for (edge, sides) in sides_of_edges(faces) {
        for pair in sides.windows(2) {
            if let Some(constraint) = edge.iter().find_map(|&end| tears(edge, end)) {
                edges.creased.push((constraint, [pair[0], pair[1]]));
            }
            for end in 0..2 {
                let ours = [pair[0][end], pair[1][end]];
                match tears(edge, edge[end]) {
                    Some(constraint) => edges.torn.push((constraint, edge, ours)),
                    None => {
                        let [x, y] = ours.map(|corner| root(parents, corner));
                        parents[x.max(y)] = x.min(y);
                    }
                }
            }
        }
    }
    edges
}

/// The point of each corner, and the originals of twins: the first group of corners of a point keeps it, every other gets a twin.
fn points_of_corners(corners: &[u32], points: usize, groups: &[usize]) -> (Vec<u32>, Vec<u32>) {
    let (mut twins, mut of_group) = (Vec::new(), vec![u32::MAX; corners.len()]);
    let mut taken = vec![false; points];
    for (&point, &group) in corners.iter().zip(groups) {
        if of_group[group] == u32::MAX {
            let is_taken = std::mem::replace(&mut taken[point as usize], true);
            of_group[group] = if is_taken { (points + twins.len()) as u32 } else { point };
            if is_taken {
                twins.push(point);
            }
        }
    }
    (groups.iter().map(|&group| of_group[group]).collect(), twins)
}

/// The same faces with other points at their corners.
fn with_corners(faces: &Faces, own: &[u32]) -> Faces {
    let mut split = Faces::default();
    let mut first = 0;
    for face in faces.iter() {
        split.push(&own[first..first + face.len()]);
        first += face.len();
    }
    split
}

fn root(parents: &mut [usize], mut at: usize) -> usize {
    while parents[at] != at {
        parents[at] = parents[parents[at]];
        at = parents[at];
    }
    at
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::attributes::dynamic_constraint as con;

    /// Two quads by two, nine points.
    fn quads() -> Faces {
        let mut faces = Faces::default();
        for corner in [0, 1, 3, 4] {
            faces.push(&[corner, corner + 1, corner + 4, corner + 3]);
        }
        faces
    }

    fn constraint() -> NodeId {
        let mut graph = crate::graph::Graph::new();
        graph.add("tear", &con::DYNAMIC_CONSTRAINT).expect("a free name")
    }

    #[test]
    fn every_face_gets_points_of_its_own_where_all_points_tear() {
        let id = constraint();
        let tearing = Tearing::new(&quads(), 9, |_, _| Some(id));
        assert_eq!(tearing.twins.len(), 16 - 9);
        let mut corners = tearing.split.corners().to_vec();
        corners.sort_unstable();
        assert_eq!(corners, (0..16).collect::<Vec<u32>>());
        assert_eq!(tearing.twins_of(&[4, 0, 1]), [10, 12, 13, 9]);
        // Four inner edges, each welded at both ends.
        assert_eq!(tearing.seams.len(), 8);
    }

    #[test]
    fn a_path_of_edges_splits_the_points_along_it_but_not_where_it_ends_inside() {
        let id = constraint();
        let along = |edge: [u32; 2], _: u32| (edge == [1, 4]).then_some(id);
        let tearing = Tearing::new(&quads(), 9, along);
        assert_eq!(tearing.twins, [1], "point 4 is where the tear ends");
        let across = |edge: [u32; 2], _: u32| [[1, 4], [4, 7]].contains(&edge).then_some(id);
        let tearing = Tearing::new(&quads(), 9, across);
        assert_eq!(tearing.twins.len(), 3);
        assert_eq!(tearing.seams.len(), 4);
    }

    #[test]
    fn twins_share_the_mass_of_their_point() {
        let id = constraint();
        let tearing = Tearing::new(&quads(), 9, |_, _| Some(id));
        let maps = tearing.maps(VertexMaps::default(), true);
        assert!((maps.mass.iter().sum::<f64>() - 9.0).abs() < 1e-12);
        assert_eq!(maps.mass.len(), 16);
    }
}
