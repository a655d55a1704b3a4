//! Continuous collision detection for linear motion within a time step.
//!
//! The gap along one fixed direction is a concave function of time, so two elements that are separated along it
//! at both ends of the motion are separated throughout. Two long edges that turn past each other by more than
//! their gap have no such direction. They are certified by subdivision: each half of the motion has its own
//! direction.
//!
//! Free points need two more tests, because a free point can move many times its size in a step. Along the
//! shortest line at the start of the step it would collide with everything it flies past.

use crate::contact::narrow_phase::{
    ElementPositions, between_centroids, cross_direction, gap_along, shortest_line,
};
use crate::math::{Real, add, dot, scale, sub, unit};

/// Share of the thickness above which a gap over motion bounds is a certificate: far above rounding error.
pub const CERTIFIED_GAP: f64 = 0.02;
/// Bisections of the motion, at most.
const MAX_SUBDIVISIONS: u32 = 6;

/// How two elements are certified to be separated.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Separation<R> {
    /// Along one direction, throughout the motion.
    Along([R; 3]),
    /// Along a separate direction in each part of the motion.
    Subdivided,
}

/// Certifies that two elements are separated throughout linear motion, by more than `min_gaps[0]` metres at the
/// start and `min_gaps[1]` later on. `None` if they cannot be certified.
#[cold]
pub fn separated_throughout<R: Real, const N: usize, const M: usize>(
    ends: [&ElementPositions<R, N, M>; 2],
    min_gaps: [R; 2],
) -> Option<Separation<R>> {
    let along = separating_direction(ends, min_gaps).map(Separation::Along);
    along.or_else(|| halves_separated(ends, min_gaps, MAX_SUBDIVISIONS).then_some(Separation::Subdivided))
}

/// A direction along which the two are separated at both ends of the motion, among the shortest lines and the
/// cross directions at both ends.
#[inline]
fn separating_direction<R: Real, const N: usize, const M: usize>(
    [before, now]: [&ElementPositions<R, N, M>; 2],
    min_gaps: [R; 2],
) -> Option<[R; 3]> {
    let first = shortest_line(*before).0;
    let lines =
        [shortest_line(*now).0, cross_direction(now.0, now.1), cross_direction(before.0, before.1), first];
    let units = lines.into_iter().filter_map(|line| unit(line, R::MIN_DENOMINATOR));
    let mut both = units.flat_map(|n| [n, n.map(|x| -x)]);
    both.find(|&n| gap_along(n, before) > min_gaps[0] && gap_along(n, now) > min_gaps[1])
}

/// Whether the two are separated in both halves of the motion.
fn halves_separated<R: Real, const N: usize, const M: usize>(
    [before, now]: [&ElementPositions<R, N, M>; 2],
    min_gaps: [R; 2],
    subdivisions: u32,
) -> bool {
    let middle = halfway(before, now);
    let is_separated = |ends: [&ElementPositions<R, N, M>; 2], min_gaps: [R; 2]| {
        separating_direction(ends, min_gaps).is_some() || halves_separated(ends, min_gaps, subdivisions - 1)
    };
    subdivisions > 0
        && shortest_line(middle).2 > min_gaps[1]
        && is_separated([before, &middle], min_gaps)
        && is_separated([&middle, now], [min_gaps[1]; 2])
}

fn halfway<R: Real, const N: usize, const M: usize>(
    (ours, theirs): &ElementPositions<R, N, M>,
    (ours_then, theirs_then): &ElementPositions<R, N, M>,
) -> ElementPositions<R, N, M> {
    let half = R::from_f64(0.5);
    let between = |from: [R; 3], to: [R; 3]| {
        let way = scale(sub(to, from), half);
        std::array::from_fn(|axis| from[axis] + way[axis])
    };
    let ours = std::array::from_fn(|k| between(ours[k], ours_then[k]));
    (ours, std::array::from_fn(|k| between(theirs[k], theirs_then[k])))
}

/// A direction along which two elements keep `rest_gap` throughout a step: the shortest line at their closest
/// approach. `None` if they come closer.
pub fn passing_direction<R: Real, const N: usize, const M: usize>(
    before: &ElementPositions<R, N, M>,
    now: &ElementPositions<R, N, M>,
    rest_gap: R,
) -> Option<[R; 3]> {
    let share = closest_share(between_centroids(before), between_centroids(now));
    let (normal, _, _) = shortest_line(interpolated(before, now, share));
    let is_separated = gap_along(normal, before) >= rest_gap && gap_along(normal, now) >= rest_gap;
    is_separated.then_some(normal)
}

/// The line from their point to ours at the first time the two are `rest_gap` apart. `None` if they start closer,
/// never come that close, or are not two points.
pub fn first_contact_normal<R: Real, const N: usize, const M: usize>(
    before: &ElementPositions<R, N, M>,
    now: &ElementPositions<R, N, M>,
    rest_gap: R,
) -> Option<[R; 3]> {
    if N + M > 2 {
        return None;
    }
    let line = sub(before.0[0], before.1[0]);
    let motion = sub(sub(now.0[0], now.1[0]), line);
    // |line + t motion| = rest_gap, the smaller root.
    let (a, half_b, c) = (dot(motion, motion), dot(line, motion), dot(line, line) - rest_gap * rest_gap);
    let discriminant = half_b * half_b - a * c;
    if c <= R::ZERO || half_b >= R::ZERO || discriminant < R::ZERO {
        return None;
    }
    // c / (-b + sqrt) instead of (-b - sqrt) / a avoids cancellation.
    let share = c / (discriminant.sqrt() - half_b);
    unit(add(line, scale(motion, share)), R::MIN_DENOMINATOR)
}

/// The share of a step at which a linearly moving line is shortest.
fn closest_share<R: Real>(from: [R; 3], to: [R; 3]) -> R {
    let motion = sub(to, from);
    let square = dot(motion, motion);
    if square <= R::MIN_DENOMINATOR {
        return R::ZERO;
    }
    let share = -dot(from, motion) / square;
    if share > R::ONE {
        R::ONE
    } else if share > R::ZERO {
        share
    } else {
        R::ZERO
    }
}

/// The positions of two elements at a share of the step.
fn interpolated<R: Real, const N: usize, const M: usize>(
    before: &ElementPositions<R, N, M>,
    now: &ElementPositions<R, N, M>,
    share: R,
) -> ElementPositions<R, N, M> {
    let on = |from: [R; 3], to: [R; 3]| add(from, scale(sub(to, from), share));
    let ours = std::array::from_fn(|k| on(before.0[k], now.0[k]));
    (ours, std::array::from_fn(|k| on(before.1[k], now.1[k])))
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    type Edges = ElementPositions<f64, 2, 2>;

    fn ends([before, now]: &[Edges; 2]) -> [&Edges; 2] {
        [before, now]
    }

    #[test]
    fn edges_that_turn_past_each_other_are_certified_by_subdivision() {
        // The first edge turns from z towards y as it moves past the second; its ends change sides without
        // contact.
        let still = [[-1.0, 0.0, 0.0], [1.0, 0.0, 0.0]];
        let way = [[[0.0, 0.1, -1.0], [0.0, 0.1, 1.0]], [[0.0, 1.2, -0.1], [0.0, -1.0, 0.3]]];
        let turning = way.map(|edge| (edge, still));
        assert_eq!(separated_throughout(ends(&turning), [1e-6; 2]), Some(Separation::Subdivided));
    }

    proptest! {
        #[test]
        fn certified_edges_never_touch_during_the_motion(
            places in proptest::collection::vec(proptest::array::uniform3(-1.0..1.0f64), 8),
        ) {
            let edges = |k: usize| ([places[k], places[k + 1]], [places[k + 2], places[k + 3]]);
            let way: [Edges; 2] = [edges(0), edges(4)];
            if separated_throughout(ends(&way), [1e-9; 2]).is_some() {
                let at = |t: f64, from: [f64; 3], to: [f64; 3]| std::array::from_fn(|k| from[k] + t * (to[k] - from[k]));
                let volume = |t: f64| {
                    let p: Vec<[f64; 3]> = (0..4).map(|k| at(t, places[k], places[k + 4])).collect();
                    let (u, v, w) = (sub(p[1], p[0]), sub(p[2], p[0]), sub(p[3], p[0]));
                    u[0] * (v[1] * w[2] - v[2] * w[1]) + u[1] * (v[2] * w[0] - v[0] * w[2])
                        + u[2] * (v[0] * w[1] - v[1] * w[0])
                };
                // They can only touch when all four points are coplanar: at the roots of a cubic, bracketed here.
                let steps = 2000;
                for k in 0..steps {
                    let (from, to) = (f64::from(k) / f64::from(steps), f64::from(k + 1) / f64::from(steps));
                    if volume(from) * volume(to) <= 0.0 {
                        let (mut low, mut high) = (from, to);
                        for _ in 0..60 {
                            let mid = 0.5 * (low + high);
                            if volume(low) * volume(mid) <= 0.0 { high = mid } else { low = mid }
                        }
                        let p: Vec<[f64; 3]> = (0..4).map(|k| at(low, places[k], places[k + 4])).collect();
                        prop_assert!(shortest_line::<f64, 2, 2>(([p[0], p[1]], [p[2], p[3]])).2 > 1e-9);
                    }
                }
            }
        }
    }

    /// A point that flies past another at a distance, from x = 3 to x = -3.
    fn flight(beside: f64) -> [ElementPositions<f64, 1, 1>; 2] {
        [3.0, -3.0].map(|x| ([[x, beside, 0.0]], [[0.0; 3]]))
    }

    #[test]
    fn a_point_passes_beyond_the_rest_gap_and_touches_within_it() {
        let [before, now] = flight(1.5);
        assert_eq!(passing_direction(&before, &now, 1.0), Some([0.0, 1.0, 0.0]));
        assert_eq!(first_contact_normal(&before, &now, 1.0), None);
        let [before, now] = flight(0.6);
        assert_eq!(passing_direction(&before, &now, 1.0), None);
        // It touches where the two are 0.8 and 0.6 apart.
        let normal = first_contact_normal(&before, &now, 1.0).expect("it touches");
        assert!((normal[0] - 0.8).abs() < 1e-12 && (normal[1] - 0.6).abs() < 1e-12, "{normal:?}");
    }

    #[test]
    fn points_that_separate_or_start_too_close_have_no_first_contact() {
        let [before, now] = flight(0.6);
        assert_eq!(first_contact_normal(&now, &([[-9.0, 0.6, 0.0]], [[0.0; 3]]), 1.0), None);
        assert_eq!(first_contact_normal(&before, &now, 4.0), None);
    }

    #[test]
    fn a_point_that_passes_a_face_is_certified_at_any_speed() {
        let face = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]];
        let at = |x: f64, y: f64| ([[x, y, 0.2]], face);
        assert!(passing_direction::<f64, 1, 3>(&at(1.2, 50.0), &at(1.2, -50.0), 0.1).is_some());
        assert!(passing_direction::<f64, 1, 3>(&at(0.3, 50.0), &at(0.3, -50.0), 0.1).is_none());
    }
}
