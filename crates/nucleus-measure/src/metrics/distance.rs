//! How far points are from where they should be.

use nalgebra::Vector3;

use super::{root_mean_square, worse};

/// Distances between two states of the same points, over the size of what they are points of. No unit.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Distance {
    /// Root mean square over the points.
    pub rms: f64,
    /// The largest.
    pub max: f64,
}

/// Compares positions with those that they should be, point by point. `size` is in the positions' unit.
///
/// Both the mean and the largest are wanted, since a fold that falls to the other side moves few points far
/// (solver dossier, F.7).
///
/// # Panics
/// When there are not as many points in both.
pub fn distance(points: &[Vector3<f64>], wanted: &[Vector3<f64>], size: f64) -> Distance {
    assert_eq!(points.len(), wanted.len(), "states of the same points");
    let apart = || points.iter().zip(wanted).map(|(a, b)| (a - b).norm() / size);
    Distance { rms: root_mean_square(apart()), max: apart().fold(0.0, worse) }
}

/// The diagonal of the box round some points, in their unit: what an error of position is measured against.
pub fn size<'a>(points: impl IntoIterator<Item = &'a Vector3<f64>>) -> f64 {
    let empty = (Vector3::repeat(f64::INFINITY), Vector3::repeat(f64::NEG_INFINITY));
    let (low, high) = points.into_iter().fold(empty, |(low, high), point| (low.inf(point), high.sup(point)));
    let diagonal = (high - low).norm();
    if low.x <= high.x { diagonal } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn unit_square() -> Vec<Vector3<f64>> {
        [[0.0, 0.0], [3.0, 0.0], [3.0, 4.0], [0.0, 4.0]].map(|[x, y]| Vector3::new(x, y, 0.0)).to_vec()
    }

    #[test]
    fn a_state_is_at_no_distance_from_itself() {
        let points = unit_square();
        assert_eq!(distance(&points, &points, 1.0), Distance::default());
    }

    #[test]
    fn a_shift_is_its_length_over_the_size_in_mean_and_largest() {
        let points = unit_square();
        let moved: Vec<_> = points.iter().map(|point| point + Vector3::new(0.0, 0.0, 0.5)).collect();
        assert_eq!(size(&points), 5.0);
        let found = distance(&moved, &points, size(&points));
        assert!((found.rms - 0.1).abs() < 1e-15 && (found.max - 0.1).abs() < 1e-15, "{found:?}");
    }

    #[test]
    fn one_point_of_four_counts_half_in_the_mean_and_whole_in_the_largest() {
        let points = unit_square();
        let mut moved = points.clone();
        moved[2].x += 5.0;
        assert_eq!(distance(&moved, &points, 5.0), Distance { rms: 0.5, max: 1.0 });
    }

    #[test]
    fn a_lost_point_is_never_near() {
        let points = unit_square();
        let mut moved = points.clone();
        moved[1].y = f64::NAN;
        let found = distance(&moved, &points, 1.0);
        assert!(found.rms.is_nan() && found.max.is_nan());
    }

    #[test]
    fn nothing_has_no_size() {
        assert_eq!(size(&[]), 0.0);
    }
}
