//! The topology of a mesh as simple lists (§2.2, §2.4): edges, cross links of quads and seams between faces, with the
//! areas and lengths that determine their stiffness and mass.

use nalgebra::Vector3;

use crate::model::surface::Surface;
use crate::union_find::UnionFind;

/// Two points at a rest length, and the cloth between them that the link stands for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Link {
    /// The two points.
    pub ends: [u32; 2],
    /// Rest length in metres.
    pub rest_length: f64,
    /// Length over width of the strip of cloth that the link stands for. The stiffness of the cloth in N/m, divided by
    /// it, is the stiffness of the link.
    pub slenderness: f64,
    /// Squared cosine of the angle to the warp of woven cloth; 1 in other cloth.
    pub warp: f64,
}

/// Two faces that share an edge.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Seam {
    /// The ends of the edge.
    pub ends: [u32; 2],
    /// The faces on its two sides.
    pub faces: [u32; 2],
}

/// A line between two corners of a face, the lower index first, and the area of its strip of cloth in m².
#[derive(Clone, Copy)]
struct Line {
    ends: [u32; 2],
    strip: f64,
}

/// The edges of the mesh as links, each once, sorted by ends; then, `with_cross_links`, the cross links
/// (`addCrossLinks`): both diagonals of each quad, and in larger polygons every line between two corners that are not
/// neighbours. A triangle has none.
///
/// A stiffness K of the cloth in N/m gives a link the stiffness K strip / l², where the strip is the area of cloth that
/// the link stands for. The strips are chosen so that the links together have the stiffness K along the edges of a
/// grid, and in every direction in equilateral triangles and in squares with cross links. The latter then also have a
/// Poisson's ratio of 1/3 and a shear stiffness of 3/8 K.
pub fn stretch_links(surface: &Surface, with_cross_links: bool) -> Vec<Link> {
    let mut links = merged(surface, sides(surface, with_cross_links));
    if with_cross_links {
        links.extend(merged(surface, diagonals(surface, |face| strips_of_diagonals(surface, face))));
    }
    links
}

/// The cross links of quads alone, each of a strip as wide as the link is long: the links of `shearResistance`.
pub fn shear_links(surface: &Surface) -> Vec<Link> {
    let mut links = merged(surface, diagonals(surface, |_| |_| 0.0));
    links.iter_mut().for_each(|link| link.slenderness = 1.0);
    links
}

/// The lines as links; lines between the same two points become one link.
fn merged(surface: &Surface, mut lines: Vec<Line>) -> Vec<Link> {
    lines.sort_by_key(|line| line.ends);
    let strips = lines.chunk_by(|a, b| a.ends == b.ends);
    let link = |shared: &[Line]| {
        let ends = shared[0].ends;
        let rest_length = distance(surface, ends);
        let strip: f64 = shared.iter().map(|line| line.strip).sum();
        Link { ends, rest_length, slenderness: slenderness(rest_length, strip), warp: 1.0 }
    };
    strips.map(link).collect()
}

/// The sides of all faces.
fn sides(surface: &Surface, with_cross_links: bool) -> Vec<Line> {
    let mut sides = Vec::with_capacity(surface.faces.corners().len());
    for face in surface.faces.iter() {
        let area = polygon_area(surface, face);
        // Without cross links the sides cover every direction once and share twice the area; the sides of a triangle
        // brace each other, and share it three times.
        let without_cross_links = if face.len() == 3 { area } else { 2.0 * area / face.len() as f64 };
        let cell = (with_cross_links && face.len() == 4).then(|| Cell::of(surface, face));
        let polygon = (with_cross_links && face.len() > 4).then(|| Polygon::of(surface, face));
        for (k, ends) in around(face).enumerate() {
            let strip = match (&cell, &polygon) {
                (Some(cell), _) => cell.side(k % 2) * area / 2.0,
                (None, Some(polygon)) => polygon.strip(surface, ends),
                _ => without_cross_links,
            };
            sides.push(Line { ends, strip });
        }
    }
    sides
}

/// The sides of a face, each with its lower end first.
pub(super) fn around(face: &[u32]) -> impl Iterator<Item = [u32; 2]> + '_ {
    let next = face.iter().cycle().skip(1);
    face.iter().zip(next).map(|(&p, &q)| [p.min(q), p.max(q)])
}

/// The strip of each line across a face.
fn strips_of_diagonals<'a>(surface: &'a Surface, face: &'a [u32]) -> impl Fn([u32; 2]) -> f64 + 'a {
    let of_quad = (face.len() == 4).then(|| Cell::of(surface, face).diagonal() * polygon_area(surface, face));
    let polygon = Polygon::of(surface, face);
    move |ends| of_quad.unwrap_or_else(|| polygon.strip(surface, ends))
}

/// A polygon of five or more corners: all of its links have the same stiffness, and their strips have three times its area.
pub(super) struct Polygon {
    /// Strip of a link over its squared length.
    strip_per_square: f64,
}

impl Polygon {
    pub(super) fn of(surface: &Surface, face: &[u32]) -> Self {
        let corners = face.iter().map(|&corner| surface.positions[corner as usize]);
        let count = face.len() as f64;
        let centre = corners.clone().sum::<Vector3<f64>>() / count;
        // The sum over all pairs of corners.
        let squares = count * corners.map(|corner| (corner - centre).norm_squared()).sum::<f64>();
        Self {
            strip_per_square: if squares > 0.0 { 3.0 * polygon_area(surface, face) / squares } else { 0.0 },
        }
    }

    /// The strip of a line between two of its corners.
    pub(super) fn strip(&self, surface: &Surface, ends: [u32; 2]) -> f64 {
        self.strip_per_square * distance(surface, ends).powi(2)
    }
}

/// A quad, approximated by a rectangle: the squares of the cosines between its diagonal and its sides.
///
/// With strips of D = 3 c_x² c_y² of its area for each diagonal, the shear stiffness is 6 c_x⁴ c_y⁴, that is 3/8 in a
/// square. The strips of the sides supply the remainder to a stiffness of exactly 1 along both of them.
struct Cell {
    cosine: [f64; 2],
}

impl Cell {
    fn of(surface: &Surface, face: &[u32]) -> Self {
        let length = |k: usize| distance(surface, [face[k], face[(k + 1) % 4]]);
        let squares = [length(0) + length(2), length(1) + length(3)].map(|sum| sum * sum);
        let all = squares[0] + squares[1];
        Self { cosine: if all > 0.0 { squares.map(|square| square / all) } else { [0.5; 2] } }
    }

    /// Share of the area for one diagonal.
    fn diagonal(&self) -> f64 {
        3.0 * self.cosine[0] * self.cosine[1]
    }

    /// Share of the area for both sides along an axis.
    fn side(&self, axis: usize) -> f64 {
        let cross = 2.0 * self.diagonal() * self.cosine[0] * self.cosine[1];
        // E = C - cross² / C is to be 1.
        let along = (1.0 + (1.0 + 4.0 * cross * cross).sqrt()) / 2.0;
        along - 2.0 * self.diagonal() * self.cosine[axis] * self.cosine[axis]
    }
}

/// The lines across all faces, with the strip of each, given those of a face.
fn diagonals<'a, Strip: Fn([u32; 2]) -> f64>(
    surface: &'a Surface,
    strips: impl Fn(&'a [u32]) -> Strip,
) -> Vec<Line> {
    let mut lines = Vec::new();
    for face in surface.faces.iter().filter(|face| face.len() > 3) {
        let strip = strips(face);
        lines.extend(across(face).map(|ends| Line { ends, strip: strip(ends) }));
    }
    lines
}

/// The lines between corners of a face that are not neighbours, each with its lower end first.
pub(super) fn across(face: &[u32]) -> impl Iterator<Item = [u32; 2]> + '_ {
    let pairs = (2..face.len()).flat_map(|second| (0..second - 1).map(move |first| (first, second)));
    let pairs = pairs.filter(|&(first, second)| first > 0 || second + 1 < face.len());
    pairs.map(|(first, second)| [face[first].min(face[second]), face[first].max(face[second])])
}

/// The edges that two faces share. Where more than two do (a non-manifold edge), each face is joined to the next.
pub fn seams(surface: &Surface) -> Vec<Seam> {
    let sides = (0..).zip(surface.faces.iter());
    let mut sides: Vec<([u32; 2], u32)> =
        sides.flat_map(|(index, face)| around(face).map(move |ends| (ends, index))).collect();
    sides.sort_unstable();
    let mut seams = Vec::with_capacity(sides.len() / 2);
    for shared in sides.chunk_by(|a, b| a.0 == b.0) {
        let pairs = shared.windows(2).filter(|pair| pair[0].1 != pair[1].1);
        seams.extend(pairs.map(|pair| Seam { ends: pair[0].0, faces: [pair[0].1, pair[1].1] }));
    }
    seams
}

/// The unconnected parts of a mesh, each its points in rising order, the part of the lowest point first. A point of no face
/// is in none.
pub fn components(surface: &Surface) -> Vec<Vec<u32>> {
    let points = surface.positions.len();
    let mut sets = UnionFind::new(points);
    let mut in_face = vec![false; points];
    for face in surface.faces.iter() {
        face.iter().for_each(|&point| in_face[point as usize] = true);
        face[1..].iter().for_each(|&point| sets.union(face[0], point));
    }
    let mut parts: std::collections::BTreeMap<u32, Vec<u32>> = std::collections::BTreeMap::new();
    for point in (0..points as u32).filter(|&point| in_face[point as usize]) {
        parts.entry(sets.find(point)).or_default().push(point);
    }
    parts.into_values().collect()
}

/// The rows of the unconnected parts of a mesh; empty where the mesh is one part.
pub fn rows_of_parts(surface: &Surface, place: impl Fn(u32) -> u32) -> Vec<Vec<u32>> {
    let parts = components(surface);
    match &parts[..] {
        [whole] if whole.len() == surface.positions.len() => Vec::new(),
        _ => parts.into_iter().map(|part| part.into_iter().map(&place).collect()).collect(),
    }
}

/// A face cut into triangles, a fan round its first corner.
pub fn fan_triangles(face: &[u32]) -> impl Iterator<Item = [u32; 3]> + '_ {
    (2..face.len()).map(|k| [face[0], face[k - 1], face[k]])
}

/// The edges of the triangulated mesh, each once, sorted: the edges of contact.
pub fn triangle_edges(triangles: &[[u32; 3]]) -> Vec<[u32; 2]> {
    let sides = |&[a, b, c]: &[u32; 3]| [[a, b], [b, c], [c, a]].map(|[p, q]| [p.min(q), p.max(q)]);
    let mut edges: Vec<_> = triangles.iter().flat_map(sides).collect();
    edges.sort_unstable();
    edges.dedup();
    edges
}

/// The area of each point in m²: a third of each of its triangles.
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

/// A link of zero length, or without faces, counts as long as it is wide.
pub(super) fn slenderness(length: f64, strip_area: f64) -> f64 {
    if length > 0.0 && strip_area > 0.0 { length * length / strip_area } else { 1.0 }
}

pub(super) fn distance(surface: &Surface, ends: [u32; 2]) -> f64 {
    let [a, b]: [Vector3<f64>; 2] = ends.map(|point| surface.positions[point as usize]);
    (b - a).norm()
}

pub(super) fn polygon_area(surface: &Surface, face: &[u32]) -> f64 {
    fan_triangles(face).map(|triangle| triangle_area(surface, triangle)).sum()
}
