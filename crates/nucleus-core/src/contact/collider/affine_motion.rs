//! The motion of a collider in a time step as an affine map of space: what it carries along keeps apart, wherever it is.

use nalgebra::{Matrix3, Vector3};

use crate::schedule::TimeInterval;

/// The motion of every place in a time step, in metres: linear in its position.
#[derive(Debug, Clone, Copy)]
pub struct AffineMotion {
    linear: Matrix3<f64>,
    origin: Vector3<f64>,
    /// Motion of the origin.
    travel: Vector3<f64>,
}

/// Largest deviation of a collider's point from the map, as a share of the root mean square distance from its centre.
const TOLERANCE: f64 = 1e-6;
/// Smallest variance along an axis, as a share of the largest, where a collider has an extent.
const FLAT: f64 = 1e-9;

impl AffineMotion {
    /// The motion at a position.
    pub fn at(&self, place: Vector3<f64>) -> Vector3<f64> {
        self.linear * (place - self.origin) + self.travel
    }

    /// The change of directions: what they are multiplied by.
    pub fn linear(&self) -> &Matrix3<f64> {
        &self.linear
    }

    /// That of a collider between two times of the frame, given its points at the start and at the end of the frame; `None` where it
    /// deforms otherwise, or is a line.
    pub fn of([start, end]: [&[Vector3<f64>]; 2], times: TimeInterval) -> Option<Self> {
        let [from, to] = times.ends();
        let mean = |points: &[Vector3<f64>]| points.iter().sum::<Vector3<f64>>() / points.len().max(1) as f64;
        let [centre, end_centre] = [mean(start), mean(end)];
        let (mut spread, mut mixed) = (Matrix3::zeros(), Matrix3::zeros());
        for (p, q) in start.iter().zip(end) {
            spread += (p - centre) * (p - centre).transpose();
            mixed += (q - end_centre) * (p - centre).transpose();
        }
        let map = linear_map(spread, mixed)?;
        let size = (spread.trace() / start.len().max(1) as f64).sqrt();
        let deviation =
            |(p, q): (&Vector3<f64>, &Vector3<f64>)| (map * (p - centre) - (q - end_centre)).norm();
        if start.iter().zip(end).map(deviation).fold(0.0, f64::max) > TOLERANCE * size {
            return None;
        }
        // Points move along straight lines in the frame, so its map at a time is a mean of the identity and `map`.
        let change = map - Matrix3::identity();
        let to_frame_start = (Matrix3::identity() + change * from).try_inverse()?;
        let travel = end_centre - centre;
        Some(Self {
            linear: change * to_frame_start * (to - from),
            origin: centre + travel * from,
            travel: travel * (to - from),
        })
    }
}

/// The linear map of least squares, from the covariances of where points are and where they go. A flat collider's normal
/// stays normal to it.
fn linear_map(spread: Matrix3<f64>, mixed: Matrix3<f64>) -> Option<Matrix3<f64>> {
    let eigen = spread.symmetric_eigen();
    let mut order = [0, 1, 2];
    order.sort_by(|&a, &b| eigen.eigenvalues[b].total_cmp(&eigen.eigenvalues[a]));
    let axes = order.map(|k| eigen.eigenvectors.column(k).into_owned());
    let variances = order.map(|k| eigen.eigenvalues[k]);
    if variances[1].is_nan() || variances[1] <= FLAT * variances[0] {
        return None;
    }
    let image = |k: usize| mixed * axes[k] / variances[k];
    let [first, second] = [image(0), image(1)];
    let third = if variances[2] > FLAT * variances[0] {
        image(2)
    } else {
        let side = axes[0].cross(&axes[1]).dot(&axes[2]);
        first.cross(&second).try_normalize(0.0)? * side
    };
    let images = [first, second, third];
    Some((0..3).map(|k| images[k] * axes[k].transpose()).sum())
}

#[cfg(test)]
mod tests {
    use nalgebra::Rotation3;
    use proptest::prelude::*;

    use super::*;
    use crate::contact::collider::ColliderState;

    type Point = Vector3<f64>;

    fn point() -> impl Strategy<Value = Point> {
        proptest::array::uniform3(-1.0..1.0f64).prop_map(Point::from)
    }

    /// A collider of these points that turns and moves within the frame.
    fn moved(points: &[Point], turn: Point, travel: Point) -> ColliderState {
        let rotation = Rotation3::new(turn);
        let end: Vec<Point> = points.iter().map(|p| rotation * p + travel).collect();
        let mut state = ColliderState::at_rest(points);
        state.begin_frame(points, &end);
        state
    }

    proptest! {
        #[test]
        fn a_place_moves_as_a_point_of_the_collider_would(
            points in proptest::collection::vec(point(), 5..9),
            turn in point(),
            travel in point(),
            [from, to] in proptest::array::uniform2(0.0..1.0f64),
        ) {
            let state = moved(&points, turn, travel);
            let motion = AffineMotion::of(state.ends(), TimeInterval { start: from, end: to });
            prop_assume!(motion.is_some());
            for k in 0..points.len() as u32 {
                let expected = state.point(k, to) - state.point(k, from);
                let error = motion.map_or(1.0, |motion| (motion.at(state.point(k, from)) - expected).norm());
                prop_assert!(error < 1e-6, "{error}");
            }
        }

        #[test]
        fn a_place_off_a_flat_collider_turns_with_it(turn in point(), above in 0.1..1.0f64) {
            let points = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]].map(|[x, z]| Point::new(x, 0.0, z));
            let state = moved(&points, turn, Point::zeros());
            let place = Point::new(0.3, above, 0.6);
            let expected = Rotation3::new(turn) * place;
            let found = AffineMotion::of(state.ends(), TimeInterval { start: 0.0, end: 1.0 }).map(|motion| place + motion.at(place));
            prop_assert!(found.is_some_and(|found| (found - expected).norm() < 1e-9), "{found:?}");
        }
    }

    #[test]
    fn a_collider_that_bends_has_no_affine_motion() {
        let points = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]].map(|[x, z]| Point::new(x, 0.0, z));
        let mut state = ColliderState::at_rest(&points);
        let mut end = points;
        end[3].y = 0.5;
        state.begin_frame(&points, &end);
        assert!(AffineMotion::of(state.ends(), TimeInterval { start: 0.0, end: 1.0 }).is_none());
    }
}
