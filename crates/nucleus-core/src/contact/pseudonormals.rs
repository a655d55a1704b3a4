//! The outside of a closed mesh, edge by edge and point by point.

use nalgebra::Vector3;

use crate::contact::skin::Skin;

/// Which faces are round each edge and each point of a closed skin.
#[derive(Debug, Clone, PartialEq)]
pub struct Outside {
    /// The two faces of each of the skin's edges.
    edges: Vec<[u32; 2]>,
    /// The faces of each of the skin's points, one after another, and where each point's end.
    faces: Vec<u32>,
    ends: Vec<u32>,
}

impl Outside {
    /// Of a skin; nothing where it is not closed: each side of a triangle has to be a side of one other, run through
    /// the other way.
    pub fn of(skin: &Skin) -> Option<Self> {
        let mut sides: Vec<([u32; 2], bool, u32)> = Vec::with_capacity(skin.triangles.len() * 3);
        for (face, &[a, b, c]) in (0..).zip(&skin.triangles) {
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
        let edges = skin.edges.iter().map(faces_of).collect();
        let mut corners: Vec<(u32, u32)> = (0..)
            .zip(&skin.triangles)
            .flat_map(|(face, triangle)| triangle.map(|point| (point, face)))
            .collect();
        corners.sort_unstable();
        let mut outside = Self { edges, faces: Vec::new(), ends: Vec::new() };
        for &point in &skin.points {
            let from = corners.partition_point(|corner| corner.0 < point);
            let of_point = corners[from..].iter().take_while(|corner| corner.0 == point);
            outside.faces.extend(of_point.map(|corner| corner.1));
            outside.ends.push(outside.faces.len() as u32);
        }
        Some(outside)
    }

    /// A direction out of the mesh at an edge of its skin, given each face's normal; of any length.
    pub fn at_edge(&self, edge: usize, normal: impl Fn(u32) -> Vector3<f64>) -> Vector3<f64> {
        self.edges[edge].into_iter().map(normal).sum()
    }

    /// The same at a point of its skin.
    pub fn at_point(&self, point: usize, normal: impl Fn(u32) -> Vector3<f64>) -> Vector3<f64> {
        let from = point.checked_sub(1).map_or(0, |before| self.ends[before]);
        self.faces[from as usize..self.ends[point] as usize].iter().map(|&face| normal(face)).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TETRAHEDRON: [[u32; 3]; 4] = [[0, 1, 2], [0, 3, 1], [1, 3, 2], [2, 3, 0]];

    #[test]
    fn what_has_no_rim_has_an_outside() {
        assert!(Outside::of(&Skin::new(TETRAHEDRON.to_vec(), 0..4)).is_some());
        assert!(Outside::of(&Skin::new(TETRAHEDRON[..3].to_vec(), 0..4)).is_none(), "it has a hole");
        let turned = [[0, 1, 2], [0, 1, 3], [1, 3, 2], [2, 3, 0]];
        assert!(Outside::of(&Skin::new(turned.to_vec(), 0..4)).is_none(), "a face is turned");
    }

    #[test]
    fn out_of_a_tetrahedron_is_away_from_its_middle() {
        let skin = Skin::new(TETRAHEDRON.to_vec(), 0..4);
        let outside = Outside::of(&skin).expect("it is closed");
        let place = |point: u32| {
            let corners: [[f64; 3]; 4] =
                [[1.0, 1.0, 1.0], [1.0, -1.0, -1.0], [-1.0, 1.0, -1.0], [-1.0, -1.0, 1.0]];
            Vector3::from(corners[point as usize])
        };
        let normal = |face: u32| {
            let [a, b, c] = skin.triangles[face as usize].map(place);
            (b - a).cross(&(c - a)).normalize()
        };
        let sign = normal(0).dot(&place(skin.triangles[0][0])).signum();
        for (edge, &[a, b]) in skin.edges.iter().enumerate() {
            assert!(sign * outside.at_edge(edge, normal).dot(&(place(a) + place(b))) > 0.0);
        }
        for (at, &point) in skin.points.iter().enumerate() {
            assert!(sign * outside.at_point(at, normal).dot(&place(point)) > 0.0);
        }
    }
}
