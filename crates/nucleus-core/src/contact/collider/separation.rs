//! Certificates that a cloth element and a collider element do not pass through each other in a time step.
//!
//! A direction along which the two have a gap at the start and at the end proves it, because both move along straight
//! lines. Where there is none the motion is subdivided. For a point and a face that does not turn, its path often decides at
//! once: it meets the face, or, for free points, a plane along the path proves that it misses the face.

use nalgebra::Vector3;

use crate::contact::ccd::separated_throughout;

type Point = Vector3<f64>;

/// Whether the two are separated throughout the step, by subdivision; where `by_path` is set, for a point and a face by a
/// plane along its path first.
pub fn separated<const N: usize, const M: usize>(
    [x0, x1]: [[Point; N]; 2],
    [q0, q1]: [[Point; M]; 2],
    by_path: bool,
) -> bool {
    if let ([start], [end], [a0, b0, c0], [a1, b1, c1]) = (&x0[..], &x1[..], &q0[..], &q1[..]) {
        let (path, faces) = ([*start, *end], [[*a0, *b0, *c0], [*a1, *b1, *c1]]);
        if passes_through(path, faces) {
            return false;
        }
        if by_path && plane_along(path, faces, CLEAR_GAP).is_some() {
            return true;
        }
    }
    let at = |x: [Point; N], q: [Point; M]| (x.map(Into::into), q.map(Into::into));
    separated_throughout([&at(x0, q0), &at(x1, q1)], [0.0; 2]).is_some()
}

/// Share of a path below which a distance from a face is not clear, and share of a face that is its rim.
const CLEAR: f64 = 1e-6;
const RIM: f64 = 1e-3;
/// Gap in metres of a plane at the start of a step, far above rounding, so that of two faces with a common edge one at least
/// is met.
pub(super) const CLEAR_GAP: f64 = 1e-9;

/// Whether a point clearly passes through the interior of a face that does not turn: no subdivision of its path has a
/// certificate.
fn passes_through(path: [Point; 2], [from, to]: [[Point; 3]; 2]) -> bool {
    let travel = to[0] - from[0];
    let rounding = CLEAR * (path[1] - path[0]).norm();
    if (1..3).any(|k| (to[k] - from[k] - travel).norm() > CLEAR * rounding) {
        return false;
    }
    let (u, v) = (from[1] - from[0], from[2] - from[0]);
    let (start, end) = (path[0] - from[0], path[1] - travel - from[0]);
    let normal = u.cross(&v);
    let heights = [normal.dot(&start), normal.dot(&end)];
    let is_clear = heights.iter().all(|height| height.abs() > rounding * normal.norm());
    if !is_clear || (heights[0] > 0.0) == (heights[1] > 0.0) {
        return false;
    }
    let place = start + (end - start) * (heights[0] / (heights[0] - heights[1]));
    let area = normal.norm_squared();
    let [b, c] = [place.cross(&v), u.cross(&place)].map(|part| part.dot(&normal) / area);
    b > RIM && c > RIM && b + c < 1.0 - RIM
}

/// Among some directions and their opposites, the one that separates the two at the start of the step with the
/// largest gap at its end.
pub fn best_plane<const N: usize, const M: usize>(
    directions: [Point; 4],
    [x0, x1]: [[Point; N]; 2],
    [q0, q1]: [[Point; M]; 2],
) -> Option<(f64, Point)> {
    let mut best: Option<(f64, Point)> = None;
    for direction in directions {
        let length = direction.norm();
        if length <= 1e-12 {
            continue;
        }
        let n = direction / length;
        let at_start = gaps_along(n, &x0, &q0);
        if at_start[0] <= 0.0 && at_start[1] <= 0.0 {
            continue;
        }
        let at_end = gaps_along(n, &x1, &q1);
        for (side, normal) in [n, -n].into_iter().enumerate() {
            let is_larger = best.is_none_or(|(gap, _)| at_end[side].total_cmp(&gap).is_ge());
            if at_start[side] > 0.0 && is_larger {
                best = Some((at_end[side], normal));
            }
        }
    }
    best
}

/// The gaps between some points and others along a direction, and along its opposite.
#[inline(always)]
fn gaps_along<const N: usize, const M: usize>(n: Point, x: &[Point; N], q: &[Point; M]) -> [f64; 2] {
    let (mut ours, mut theirs) = ([n.dot(&x[0]); 2], [n.dot(&q[0]); 2]);
    for k in 1..N {
        let along = n.dot(&x[k]);
        ours = [ours[0].min(along), ours[1].max(along)];
    }
    for k in 1..M {
        let along = n.dot(&q[k]);
        theirs = [theirs[0].min(along), theirs[1].max(along)];
    }
    [ours[0] - theirs[1], theirs[0] - ours[1]]
}

/// A plane along the path of a point that has a face on its other side from the start to the end: the one with the largest
/// gap of those through the path and parallel to an edge. For a face that does not turn there is one if the path misses the
/// face between its corners. Its gap is above `least` metres.
pub fn plane_along([start, end]: [Point; 2], [from, to]: [[Point; 3]; 2], least: f64) -> Option<Point> {
    let middle = |corners: [Point; 3]| (corners[0] + corners[1] + corners[2]) / 3.0;
    let path = (end - start) - (middle(to) - middle(from));
    let mut best = (least, None);
    for k in 0..3 {
        let edge = from[(k + 1) % 3] - from[k];
        let across = path.cross(&edge);
        // The third corner is on the other side of the plane through the edge.
        let across = if across.dot(&(from[(k + 2) % 3] - from[k])) > 0.0 { -across } else { across };
        let at_start = across.dot(&(start - from[k]));
        if at_start <= 0.0 {
            continue;
        }
        let length = across.norm();
        let normal = across / length;
        let at_end = to.iter().map(|corner| normal.dot(&(end - corner))).fold(f64::INFINITY, f64::min);
        let gap = at_end.min(at_start / length);
        if gap > best.0 {
            best = (gap, Some(normal));
        }
    }
    best.1
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
        fn no_subdivision_certifies_a_path_that_clearly_meets_a_face(
            path in proptest::array::uniform2(place()), face in proptest::array::uniform3(place()), travel in place(),
        ) {
            let faces = [face, face.map(|corner| corner + travel)];
            if passes_through(path, faces) {
                let at = |end: usize| ([path[end].into()], faces[end].map(Into::into));
                prop_assert!(separated_throughout([&at(0), &at(1)], [0.0; 2]).is_none());
                prop_assert!(plane_along(path, faces, CLEAR_GAP).is_none());
            }
        }

        #[test]
        fn a_way_through_the_middle_of_a_face_meets_it(
            start in place(), face in proptest::array::uniform3(place()), ahead in 0.5..3.0f64, travel in place(),
        ) {
            let middle = (face[0] + face[1] + face[2]) / 3.0;
            let normal = (face[1] - face[0]).cross(&(face[2] - face[0]));
            prop_assume!((start - middle).dot(&normal).abs() > 1e-3);
            let end = start + (middle - start) * (1.0 + ahead) + travel;
            prop_assert!(passes_through([start, end], [face, face.map(|corner| corner + travel)]));
        }

        #[test]
        fn a_plane_along_the_path_keeps_a_point_out_of_the_face_at_all_times(
            path in proptest::array::uniform2(place()), from in proptest::array::uniform3(place()), to in proptest::array::uniform3(place()),
        ) {
            if let Some(normal) = plane_along(path, [from, to], CLEAR_GAP) {
                for k in 0..=100 {
                    let share = f64::from(k) / 100.0;
                    let point = path[0] + (path[1] - path[0]) * share;
                    for (a, b) in from.iter().zip(&to) {
                        prop_assert!(normal.dot(&(point - (a + (b - a) * share))) > 0.0);
                    }
                }
            }
        }
    }
}
