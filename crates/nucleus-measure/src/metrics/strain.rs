//! How far cloth is stretched.

use std::collections::BTreeSet;

use nalgebra::Vector3;
use nucleus_core::Surface;

/// Edges of a mesh, each once, with their lengths at rest in metres.
#[derive(Debug, Clone, PartialEq)]
pub struct Edges {
    ends: Vec<[u32; 2]>,
    rest: Vec<f64>,
}

/// Strains of edges: length over length at rest, less one. No unit.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Strain {
    /// Root mean square over all edges, longer and shorter ones alike.
    pub rms: f64,
    /// What 99 % of the edges stay below: the figure that a look follows (solver dossier, F.2).
    pub most: f64,
    /// The largest.
    pub max: f64,
}

impl Edges {
    /// The edges round the faces of a mesh at rest; those without length have no strain and are left out.
    pub fn of(rest: &Surface) -> Self {
        let mut found = BTreeSet::new();
        for face in rest.faces.iter() {
            let next = face.iter().cycle().skip(1);
            found.extend(face.iter().zip(next).map(|(&a, &b)| [a.min(b), a.max(b)]));
        }
        let length = |[a, b]: [u32; 2]| (rest.positions[b as usize] - rest.positions[a as usize]).norm();
        let (ends, rest) =
            found.into_iter().map(|ends| (ends, length(ends))).filter(|(_, length)| *length > 0.0).unzip();
        Self { ends, rest }
    }

    /// The strains of a state.
    pub fn strain(&self, points: &[Vector3<f64>]) -> Strain {
        let length = |&[a, b]: &[u32; 2]| (points[b as usize] - points[a as usize]).norm();
        let strain = |(ends, rest): (&[u32; 2], &f64)| length(ends) / rest - 1.0;
        // What is not a number has a sign that says nothing: with a plus it comes last, and is the largest.
        let mut all: Vec<f64> = self
            .ends
            .iter()
            .zip(&self.rest)
            .map(strain)
            .map(|x| if x.is_nan() { f64::NAN } else { x })
            .collect();
        all.sort_by(f64::total_cmp);
        let at =
            |share: f64| all.get(((all.len() as f64 * share).ceil() as usize).saturating_sub(1)).copied();
        Strain {
            rms: super::root_mean_square(all.iter().copied()),
            most: at(0.99).unwrap_or(0.0),
            max: at(1.0).unwrap_or(0.0),
        }
    }
}

#[cfg(test)]
mod tests {
    use nucleus_core::Faces;

    use super::*;

    fn square() -> Surface {
        let corners = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
        let faces = [[0, 1, 2], [0, 2, 3]].iter().map(|face| &face[..]).collect::<Faces>();
        Surface { positions: corners.map(|[x, y]| Vector3::new(x, y, 0.0)).to_vec(), faces }
    }

    #[test]
    fn an_edge_of_two_faces_counts_once() {
        assert_eq!(Edges::of(&square()).ends.len(), 5);
    }

    #[test]
    fn cloth_drawn_out_evenly_has_the_same_strain_everywhere() {
        let square = square();
        let drawn: Vec<_> = square.positions.iter().map(|point| point * 1.25).collect();
        let found = Edges::of(&square).strain(&drawn);
        assert_eq!((found.rms, found.most, found.max), (0.25, 0.25, 0.25));
    }

    #[test]
    fn shorter_edges_count_in_the_mean_alone() {
        let square = square();
        let drawn: Vec<_> = square.positions.iter().map(|point| point * 0.5).collect();
        let found = Edges::of(&square).strain(&drawn);
        assert_eq!((found.rms, found.max), (0.5, -0.5));
    }

    #[test]
    fn one_edge_in_a_hundred_may_be_longer_than_the_most() {
        let edges = Edges { ends: (0..100).map(|k| [2 * k, 2 * k + 1]).collect(), rest: vec![1.0; 100] };
        let mut points = [Vector3::zeros(), Vector3::x() * 1.5].repeat(100);
        points[1].x = 3.0;
        let found = edges.strain(&points);
        assert_eq!((found.most, found.max), (0.5, 2.0));
    }

    #[test]
    fn a_lost_point_has_the_largest_strain() {
        let square = square();
        let mut lost = square.positions.clone();
        lost[0].x = f64::NAN;
        assert!(Edges::of(&square).strain(&lost).max.is_nan());
    }
}
