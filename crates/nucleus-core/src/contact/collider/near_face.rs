//! How the motion of a free point in a time step stands to a face: a plane keeps them apart, they may touch, or the point
//! passes the face.
//!
//! The point starts at one place and ends within a margin of another. A plane between the point and the face at the start,
//! and with a gap above the interaction range at the end, excludes contact: both move along straight lines.

use nalgebra::Vector3;

use crate::contact::collider::separation::{CLEAR_GAP, plane_along};
use crate::contact::narrow_phase::closest_on_triangle;

type Point = Vector3<f64>;

/// Distance from the plane of a face, in interaction ranges, beyond which a point begins with that plane.
const FAR: f64 = 2.0;

/// The motion of a point in a time step.
#[derive(Debug, Clone, Copy)]
pub struct PointPath {
    /// Its ends in metres.
    pub ends: [Point; 2],
    /// Interaction range in metres.
    pub range: f64,
    /// Distance in metres from the second end within which the point may end.
    pub margin: f64,
    /// The gap of a plane at the start of the step that excludes contact, in metres.
    pub start_gap: f64,
}

impl PointPath {
    /// A path on which no adhesion acts, so that the start of the step may be as near as it likes.
    pub fn new(ends: [Point; 2], range: f64, margin: f64) -> Self {
        Self { ends, range, margin, start_gap: CLEAR_GAP }
    }

    /// The same where a contact acts that is within range at the start.
    pub fn with_adhesion(self) -> Self {
        Self { start_gap: self.range, ..self }
    }
}

/// How a path stands to a face.
#[derive(Debug, Clone, Copy)]
pub enum Facing {
    /// A plane excludes contact.
    Apart,
    /// The two are close at the start: the normal along the shortest line, and the weights of its end on the face.
    Close(Point, [f64; 3]),
    /// A plane with this normal keeps them apart; at the end the two may touch.
    Near(Point),
    /// The point passes the face, which has this normal towards its start, at this share of the path.
    Passes(Point, f64),
}

/// How a path stands to a face with these corners at its start and at its end, and the height of the start above the face in
/// metres, below zero behind it.
pub fn facing(path: &PointPath, faces: [[Point; 3]; 2]) -> (Facing, f64) {
    let [[a, b, c], to] = faces;
    let across = (b - a).cross(&(c - a));
    let length = across.norm().max(f64::MIN_POSITIVE);
    let height = across.dot(&(path.ends[0] - a)) / length;
    let ahead = across * (height.signum() / length);
    let at_end = gap(ahead, path.ends[1], to);
    if at_end > path.range + path.margin && height.abs() > path.start_gap {
        return (Facing::Apart, height);
    }
    let aside = plane_along(path.ends, faces, 0.0);
    if aside.is_some_and(|aside| path.is_apart(aside, faces)) || is_apart_at_end(path, faces) {
        return (Facing::Apart, height);
    }
    let facing = match aside {
        _ if height.abs() <= FAR * path.range => facing_close(path, faces, across),
        _ if at_end >= 0.0 => Facing::Near(ahead),
        Some(aside) => Facing::Near(aside),
        None => Facing::Passes(ahead, height.abs() / (height.abs() - at_end)),
    };
    (facing, height)
}

/// The same for a start near the plane of the face, if no other plane excludes contact.
fn facing_close(path: &PointPath, [from, to]: [[Point; 3]; 2], across: Point) -> Facing {
    let (line, weights) = shortest_line(path.ends[0], from);
    let touching = || across.try_normalize(0.0).unwrap_or_else(Point::y);
    let normal = line.try_normalize(1e-12).unwrap_or_else(touching);
    if path.is_apart(normal, [from, to]) { Facing::Apart } else { Facing::Close(normal, weights) }
}

/// Whether the plane across the shortest line at the end of a path excludes contact.
fn is_apart_at_end(path: &PointPath, faces: [[Point; 3]; 2]) -> bool {
    let normal = shortest_line(path.ends[1], faces[1]).0.try_normalize(f64::MIN_POSITIVE);
    normal.is_some_and(|normal| path.is_apart(normal, faces))
}

impl PointPath {
    /// Whether a plane with this normal excludes contact.
    #[inline(always)]
    fn is_apart(&self, normal: Point, [from, to]: [[Point; 3]; 2]) -> bool {
        gap(normal, self.ends[1], to) > self.range + self.margin
            && gap(normal, self.ends[0], from) > self.start_gap
    }
}

/// The gap between a place and a face along a normal.
#[inline(always)]
fn gap(normal: Point, place: Point, [a, b, c]: [Point; 3]) -> f64 {
    normal.dot(&place) - normal.dot(&a).max(normal.dot(&b)).max(normal.dot(&c))
}

/// The shortest line from a face to a place, and the weights of its end on the face.
#[inline(always)]
fn shortest_line(place: Point, face: [Point; 3]) -> (Point, [f64; 3]) {
    let weights = closest_on_triangle(place.into(), face.map(Into::into));
    let nearest = face[0] * weights[0] + face[1] * weights[1] + face[2] * weights[2];
    (place - nearest, weights)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn place() -> impl Strategy<Value = Point> {
        proptest::array::uniform3(-1.0..1.0f64).prop_map(Point::from)
    }

    proptest! {
        #[test]
        fn a_point_comes_within_range_of_no_face_that_it_is_apart_from(
            ends in proptest::array::uniform2(place()), from in proptest::array::uniform3(place()),
            to in proptest::array::uniform3(place()), off in place(), turns in proptest::bool::ANY,
        ) {
            let travel = to[0] - from[0];
            let to = if turns { to } else { from.map(|corner| corner + travel) };
            let path = PointPath::new(ends, 0.05, 0.02);
            let end = ends[1] + off.normalize() * 0.02;
            if let Facing::Apart = facing(&path, [from, to]).0 {
                prop_assert!(shortest_line(end, to).0.norm() > 0.05);
                for k in 0..=50 {
                    let share = f64::from(k) / 50.0;
                    let face: [Point; 3] = std::array::from_fn(|c| from[c].lerp(&to[c], share));
                    prop_assert!(shortest_line(ends[0].lerp(&end, share), face).0.norm() > 0.0);
                }
            }
        }

        #[test]
        fn a_way_through_the_middle_of_a_face_passes_it_where_it_crosses_its_plane(
            start in place(), face in proptest::array::uniform3(place()), ahead in 0.5..3.0f64,
        ) {
            let middle = (face[0] + face[1] + face[2]) / 3.0;
            let normal = (face[1] - face[0]).cross(&(face[2] - face[0]));
            prop_assume!(normal.norm() > 1e-3 && (start - middle).dot(&normal).abs() > 0.05 * normal.norm());
            let path = PointPath::new([start, start + (middle - start) * (1.0 + ahead)], 0.01, 0.002);
            let (facing, height) = facing(&path, [face; 2]);
            prop_assert!((height - (start - middle).dot(&normal) / normal.norm()).abs() < 1e-9);
            match facing {
                Facing::Passes(_, share) => prop_assert!((share * (1.0 + ahead) - 1.0).abs() < 1e-9),
                other => prop_assert!(false, "{other:?}"),
            }
        }
    }
}
