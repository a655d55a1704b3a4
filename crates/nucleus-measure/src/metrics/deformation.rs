//! Deviation of positions from a reference, strain of edges, and contact gaps.

use std::collections::BTreeSet;

use nalgebra::Vector3;
use nucleus_core::{StepReport, Surface};
use serde::{Deserialize, Serialize};

use super::{max_or_nan, root_mean_square};

/// Distances between two states of the same points, relative to the size of the cloth. Dimensionless.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Distance {
    /// Root mean square over the points.
    pub rms: f64,
    /// Maximum.
    pub max: f64,
}

/// Distances between corresponding points of a state and a reference; `size` is in the unit of the positions.
///
/// RMS and maximum are both needed: a fold that falls to the other side moves few points far
/// (solver dossier, F.7).
///
/// # Panics
/// When the two states have different numbers of points.
pub fn distance(points: &[Vector3<f64>], reference: &[Vector3<f64>], size: f64) -> Distance {
    assert_eq!(points.len(), reference.len(), "both states have the same points");
    let distances = || points.iter().zip(reference).map(|(a, b)| (a - b).norm() / size);
    Distance { rms: root_mean_square(distances()), max: distances().fold(0.0, max_or_nan) }
}

/// Diagonal of the bounding box of some points, in their unit: the scale of position errors.
pub fn size<'a>(points: impl IntoIterator<Item = &'a Vector3<f64>>) -> f64 {
    let empty = (Vector3::repeat(f64::INFINITY), Vector3::repeat(f64::NEG_INFINITY));
    let (low, high) = points.into_iter().fold(empty, |(low, high), point| (low.inf(point), high.sup(point)));
    let diagonal = (high - low).norm();
    if low.x <= high.x { diagonal } else { 0.0 }
}

/// Edges of a mesh, each once, with their rest lengths in metres.
#[derive(Debug, Clone, PartialEq)]
pub struct Edges {
    ends: Vec<[u32; 2]>,
    rest: Vec<f64>,
}

/// Strains of edges: length over rest length, minus 1. Dimensionless.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Strain {
    /// Root mean square over all edges, stretched and compressed alike.
    pub rms: f64,
    /// 99th percentile: the figure that correlates with visual quality (solver dossier, F.2).
    pub p99: f64,
    /// Maximum.
    pub max: f64,
}

impl Edges {
    /// Edges of the faces of a mesh at rest. Edges of zero length have no strain and are excluded.
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

    /// Ends and rest length in metres of every edge, by increasing ends.
    pub fn iter(&self) -> impl Iterator<Item = ([u32; 2], f64)> {
        self.ends.iter().copied().zip(self.rest.iter().copied())
    }

    /// Strains of a state.
    pub fn strain(&self, points: &[Vector3<f64>]) -> Strain {
        let length = |&[a, b]: &[u32; 2]| (points[b as usize] - points[a as usize]).norm();
        let strain = |(ends, rest): (&[u32; 2], &f64)| length(ends) / rest - 1.0;
        // The sign of NaN is arbitrary: a positive NaN sorts last and becomes the maximum.
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
            rms: root_mean_square(all.iter().copied()),
            p99: at(0.99).unwrap_or(0.0),
            max: at(1.0).unwrap_or(0.0),
        }
    }
}

/// Contact quality over the frames of a run.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Contact {
    /// Smallest ratio of gap to contact thickness: 1 is touching, below 1 is penetrating the thickness. `None` without
    /// any contact.
    pub least_gap: Option<f64>,
    /// Pairs of elements unresolved at the end of a time step, summed over all frames. Must be 0.
    pub pairs_unresolved: u64,
}

impl Contact {
    /// Adds a frame.
    pub fn add(&mut self, report: &StepReport) {
        if report.min_gap < f64::INFINITY {
            self.least_gap = Some(self.least_gap.map_or(report.min_gap, |least| least.min(report.min_gap)));
        }
        self.pairs_unresolved += report.pairs_unresolved;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nucleus_core::Faces;

    fn unit_square() -> Vec<Vector3<f64>> {
        [[0.0, 0.0], [3.0, 0.0], [3.0, 4.0], [0.0, 4.0]].map(|[x, y]| Vector3::new(x, y, 0.0)).to_vec()
    }

    #[test]
    fn the_distance_of_a_state_from_itself_is_zero() {
        let points = unit_square();
        assert_eq!(distance(&points, &points, 1.0), Distance::default());
    }

    #[test]
    fn a_translation_has_its_length_over_the_size_as_rms_and_maximum() {
        let points = unit_square();
        let moved: Vec<_> = points.iter().map(|point| point + Vector3::new(0.0, 0.0, 0.5)).collect();
        assert_eq!(size(&points), 5.0);
        let found = distance(&moved, &points, size(&points));
        assert!((found.rms - 0.1).abs() < 1e-15 && (found.max - 0.1).abs() < 1e-15, "{found:?}");
    }

    #[test]
    fn one_moved_point_of_four_contributes_half_to_the_rms_and_fully_to_the_maximum() {
        let points = unit_square();
        let mut moved = points.clone();
        moved[2].x += 5.0;
        assert_eq!(distance(&moved, &points, 5.0), Distance { rms: 0.5, max: 1.0 });
    }

    #[test]
    fn a_nan_position_makes_the_distance_nan() {
        let points = unit_square();
        let mut moved = points.clone();
        moved[1].y = f64::NAN;
        let found = distance(&moved, &points, 1.0);
        assert!(found.rms.is_nan() && found.max.is_nan());
    }

    #[test]
    fn the_size_of_no_points_is_zero() {
        assert_eq!(size(&[]), 0.0);
    }

    fn square() -> Surface {
        let corners = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
        let faces = [[0, 1, 2], [0, 2, 3]].iter().map(|face| &face[..]).collect::<Faces>();
        Surface { positions: corners.map(|[x, y]| Vector3::new(x, y, 0.0)).to_vec(), faces }
    }

    #[test]
    fn an_edge_shared_by_two_faces_is_counted_once() {
        assert_eq!(Edges::of(&square()).ends.len(), 5);
    }

    #[test]
    fn uniformly_scaled_cloth_has_uniform_strain() {
        let square = square();
        let drawn: Vec<_> = square.positions.iter().map(|point| point * 1.25).collect();
        let found = Edges::of(&square).strain(&drawn);
        assert_eq!((found.rms, found.p99, found.max), (0.25, 0.25, 0.25));
    }

    #[test]
    fn compression_contributes_to_the_rms_strain_only() {
        let square = square();
        let drawn: Vec<_> = square.positions.iter().map(|point| point * 0.5).collect();
        let found = Edges::of(&square).strain(&drawn);
        assert_eq!((found.rms, found.max), (0.5, -0.5));
    }

    #[test]
    fn the_99th_percentile_ignores_the_longest_of_a_hundred_edges() {
        let edges = Edges { ends: (0..100).map(|k| [2 * k, 2 * k + 1]).collect(), rest: vec![1.0; 100] };
        let mut points = [Vector3::zeros(), Vector3::x() * 1.5].repeat(100);
        points[1].x = 3.0;
        let found = edges.strain(&points);
        assert_eq!((found.p99, found.max), (0.5, 2.0));
    }

    #[test]
    fn a_nan_position_makes_the_maximum_strain_nan() {
        let square = square();
        let mut lost = square.positions.clone();
        lost[0].x = f64::NAN;
        assert!(Edges::of(&square).strain(&lost).max.is_nan());
    }

    #[test]
    fn the_minimum_gap_is_kept_and_unresolved_pairs_are_summed() {
        let mut contact = Contact::default();
        for (min_gap, pairs_unresolved) in [(f64::INFINITY, 0), (1.2, 1), (0.7, 0), (0.9, 2)] {
            contact.add(&StepReport { min_gap, pairs_unresolved, ..StepReport::default() });
        }
        assert_eq!(contact, Contact { least_gap: Some(0.7), pairs_unresolved: 3 });
    }

    #[test]
    fn a_run_without_contact_has_no_gap() {
        let mut contact = Contact::default();
        contact.add(&StepReport::default());
        assert_eq!(contact.least_gap, None);
    }
}
