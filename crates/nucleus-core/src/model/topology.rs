//! A mesh taken apart into the simple lists the solver works on (§2.2, §2.4): edges, cross links of quads,
//! hinges between triangles, and the areas and lengths that weigh them.

use nalgebra::Vector3;

use crate::surface::Surface;

/// Two points to be kept at a distance, and how much cloth the link stands for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Link {
    /// The two points.
    pub ends: [u32; 2],
    /// Distance at rest in metres.
    pub rest_length: f64,
    /// Length over width of the strip of cloth it stands for: a stiffness in N/m of the cloth, divided by
    /// this, is the stiffness of the link.
    pub slenderness: f64,
}

/// Two triangles that share an edge.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hinge {
    /// The ends of the shared edge, then the opposite corners.
    pub points: [u32; 4],
}

/// One side of one face: its ends in ascending order, the face, and the face's corner opposite (triangles only).
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Side {
    ends: [u32; 2],
    face: u32,
    opposite: u32,
}

/// The edges of the mesh as links, each once, sorted by ends.
///
/// The strips of a square grid are as wide as its cells, so that the links together are exactly as stiff as
/// the cloth along both directions.
pub fn edge_links(surface: &Surface) -> Vec<Link> {
    let areas: Vec<f64> = surface.faces.iter().map(|face| polygon_area(surface, face)).collect();
    let mut sides = polygon_sides(surface);
    sides.sort_unstable();
    let strips = sides.chunk_by(|a, b| a.ends == b.ends);
    let link = |shared: &[Side]| {
        let ends = shared[0].ends;
        let rest_length = distance(surface, ends);
        // An edge's share of a face: its sides share twice the area, since every direction is covered once.
        let share = |side: &Side| {
            let corners = surface.faces.face(side.face as usize).len();
            2.0 * areas[side.face as usize] / corners as f64
        };
        let strip: f64 = shared.iter().map(share).sum();
        Link { ends, rest_length, slenderness: slenderness(rest_length, strip) }
    };
    strips.map(link).collect()
}

/// The cross links: both diagonals of each quad (`addCrossLinks`); a triangle has none.
/// Of larger polygons every point is linked to every other that is not its neighbour.
pub fn cross_links(surface: &Surface) -> Vec<Link> {
    let mut links = Vec::new();
    for face in surface.faces.iter().filter(|face| face.len() > 3) {
        for first in 0..face.len() {
            for second in first + 2..face.len() {
                if first > 0 || second + 1 < face.len() {
                    let ends = [face[first].min(face[second]), face[first].max(face[second])];
                    links.push(Link { ends, rest_length: distance(surface, ends), slenderness: 1.0 });
                }
            }
        }
    }
    links.sort_unstable_by_key(|link| link.ends);
    links.dedup_by_key(|link| link.ends);
    links
}

/// The hinges of the triangulated mesh. Where more than two triangles share an edge (not a manifold), each
/// is hinged to the next.
pub fn hinges(surface: &Surface) -> Vec<Hinge> {
    let mut sides = triangle_sides(surface);
    sides.sort_unstable();
    let mut hinges = Vec::with_capacity(sides.len() / 2);
    for shared in sides.chunk_by(|a, b| a.ends == b.ends) {
        for pair in shared.windows(2).filter(|pair| pair[0].opposite != pair[1].opposite) {
            let [a, b] = pair[0].ends;
            hinges.push(Hinge { points: [a, b, pair[0].opposite, pair[1].opposite] });
        }
    }
    hinges
}

/// The edges of the triangulated mesh, each once, sorted: the edges that collide.
pub fn triangle_edges(triangles: &[[u32; 3]]) -> Vec<[u32; 2]> {
    let sides = |&[a, b, c]: &[u32; 3]| [[a, b], [b, c], [c, a]].map(|[p, q]| [p.min(q), p.max(q)]);
    let mut edges: Vec<_> = triangles.iter().flat_map(sides).collect();
    edges.sort_unstable();
    edges.dedup();
    edges
}

/// The area round each point in m²: a third of each triangle that meets there.
pub fn point_areas(surface: &Surface) -> Vec<f64> {
    let mut areas = vec![0.0; surface.positions.len()];
    for triangle in surface.faces.triangles() {
        let share = triangle_area(surface, triangle) / 3.0;
        triangle.iter().for_each(|&point| areas[point as usize] += share);
    }
    areas
}

/// The area of a triangle in m².
pub fn triangle_area(surface: &Surface, triangle: [u32; 3]) -> f64 {
    let [a, b, c] = triangle.map(|point| surface.positions[point as usize]);
    (b - a).cross(&(c - a)).norm() / 2.0
}

/// A link of no length has no direction, and one without faces no width: both get the width of their length.
fn slenderness(length: f64, strip_area: f64) -> f64 {
    if length > 0.0 && strip_area > 0.0 { length * length / strip_area } else { 1.0 }
}

fn distance(surface: &Surface, ends: [u32; 2]) -> f64 {
    let [a, b]: [Vector3<f64>; 2] = ends.map(|point| surface.positions[point as usize]);
    (b - a).norm()
}

fn polygon_area(surface: &Surface, face: &[u32]) -> f64 {
    (2..face.len()).map(|k| triangle_area(surface, [face[0], face[k - 1], face[k]])).sum()
}

fn polygon_sides(surface: &Surface) -> Vec<Side> {
    let mut sides = Vec::with_capacity(surface.faces.corners().len());
    for (index, face) in surface.faces.iter().enumerate() {
        for k in 0..face.len() {
            let (p, q) = (face[k], face[(k + 1) % face.len()]);
            sides.push(Side { ends: [p.min(q), p.max(q)], face: index as u32, opposite: u32::MAX });
        }
    }
    sides
}

fn triangle_sides(surface: &Surface) -> Vec<Side> {
    let mut sides = Vec::with_capacity(surface.faces.corners().len() * 2);
    for (index, [a, b, c]) in surface.faces.triangles().enumerate() {
        for (p, q, opposite) in [(a, b, c), (b, c, a), (c, a, b)] {
            sides.push(Side { ends: [p.min(q), p.max(q)], face: index as u32, opposite });
        }
    }
    sides
}
