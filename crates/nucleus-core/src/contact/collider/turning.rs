//! How the surface of a collider turns in a frame: what grips it at a distance turns with it.
//!
//! Contact keeps cloth at a distance from the surface. If friction compared its motion with that of the surface below it, a band
//! on a turning wheel would lag by its distance times the angle.

use nalgebra::{Matrix3, Vector3};

use crate::contact::boundary::unit_normal;
use crate::contact::collider::affine_motion::AffineMotion;
use crate::schedule::TimeInterval;

type Point = Vector3<f64>;

/// The turn of a collider's surface in a frame.
#[derive(Debug, Clone, Copy)]
pub enum Turning {
    /// All of it turns alike: the change of a direction is linear in it.
    Whole(Matrix3<f64>),
    /// It deforms, and each face turns by itself.
    ByFace,
}

/// Change of a direction below which a collider does not turn: rounding of the positions of its points.
const NO_TURN: f64 = 1e-9;

impl Turning {
    /// That of a collider that moves, given its points at the start and at the end of the frame; `None` without a turn.
    pub fn of(ends: [&[Point]; 2]) -> Option<Self> {
        match AffineMotion::of(ends, TimeInterval { start: 0.0, end: 1.0 }) {
            Some(motion) if motion.linear().norm() <= NO_TURN => None,
            Some(motion) => Some(Self::Whole(*motion.linear())),
            None => Some(Self::ByFace),
        }
    }

    /// The change of the unit normal of a contact in the frame, without its part along the normal, given the element of the
    /// collider at the start and at the end of the frame. Of a collider that deforms that of edges and corners is not known:
    /// zero.
    pub fn of_normal<const M: usize>(&self, normal: Point, [start, end]: &[[Point; M]; 2]) -> Point {
        let change = match (self, &start[..], &end[..]) {
            (Self::Whole(linear), ..) => linear * normal,
            (Self::ByFace, &[a, b, c], &[d, e, f]) => {
                let [before, after] = [[a, b, c], [d, e, f]].map(unit_normal);
                (after - before) * normal.dot(&before).signum()
            }
            _ => return Point::zeros(),
        };
        change - normal * normal.dot(&change)
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::Rotation3;

    use super::*;

    fn corners() -> [Point; 3] {
        [Point::zeros(), Point::x(), -Point::z()]
    }

    #[test]
    fn a_face_that_turns_by_itself_turns_its_normal_on_both_sides() {
        let turn = Rotation3::from_axis_angle(&Point::z_axis(), 0.01);
        let ends = [corners(), corners().map(|corner| turn * corner + Point::y())];
        for side in [1.0, -1.0] {
            let change = Turning::ByFace.of_normal(Point::y() * side, &ends);
            assert!((change - Point::new(-0.01f64.sin() * side, 0.0, 0.0)).norm() < 1e-12, "{change}");
        }
    }

    #[test]
    fn what_moves_or_grows_without_turning_does_not_turn_a_normal() {
        let ends = [corners(), corners().map(|corner| corner * 2.0 + Point::x())];
        assert_eq!(Turning::ByFace.of_normal(Point::y(), &ends), Point::zeros());
        let grown = Turning::Whole(Matrix3::identity());
        assert_eq!(grown.of_normal(Point::y(), &ends), Point::zeros());
    }
}
