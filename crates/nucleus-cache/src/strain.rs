//! How far the edges at each point are from their length at rest.

use crate::object::ObjectInfo;

/// The edges of a mesh, each once, with their length at rest.
pub(crate) struct RestEdges(Vec<([u32; 2], f32)>);

impl RestEdges {
    /// The edges of the faces of an object; those of no length are left out.
    pub fn new(object: &ObjectInfo) -> Self {
        let around = |face: &[u32]| {
            let next = face.iter().copied().cycle().skip(1);
            face.iter().copied().zip(next).map(|(a, b)| [a.min(b), a.max(b)]).collect::<Vec<_>>()
        };
        let mut edges: Vec<[u32; 2]> = object.faces.iter().flat_map(around).collect();
        edges.sort_unstable();
        edges.dedup();
        let with_length = edges.into_iter().map(|edge| (edge, length(&object.rest, edge)));
        Self(with_length.filter(|&(_, length)| length > 0.0).collect())
    }

    /// Replaces `out` by the strain of largest size among the edges at each point, with its sign; 0 where there is none.
    pub fn strain(&self, positions: &[[f32; 3]], out: &mut Vec<f32>) {
        out.clear();
        out.resize(positions.len(), 0.0);
        for &(edge, rest) in &self.0 {
            let strain = length(positions, edge) / rest - 1.0;
            for point in edge {
                let largest = &mut out[point as usize];
                if strain.abs() > largest.abs() {
                    *largest = strain;
                }
            }
        }
    }
}

fn length(positions: &[[f32; 3]], [a, b]: [u32; 2]) -> f32 {
    let [a, b] = [a, b].map(|point| positions[point as usize]);
    let square = |axis: usize| (a[axis] - b[axis]) * (a[axis] - b[axis]);
    (square(0) + square(1) + square(2)).sqrt()
}

#[cfg(test)]
mod tests {
    use nucleus_core::Faces;

    use super::*;
    use crate::object::ObjectKind;

    #[test]
    fn a_point_has_the_strain_of_its_worst_edge() {
        let faces = Faces::from_iter([&[0_u32, 1, 2][..]]);
        let rest = vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
        let object = ObjectInfo { name: "a".into(), kind: ObjectKind::Cloth, faces, rest };
        let mut strain = Vec::new();
        RestEdges::new(&object).strain(&[[0.0; 3], [0.25, 0.0, 0.0], [0.0, 1.5, 0.0]], &mut strain);
        assert_eq!(strain[..2], [-0.75, -0.75]);
        assert_eq!(strain[2], 0.5);
    }
}
