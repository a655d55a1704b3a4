//! The proof that two elements stay apart while their points go along straight lines.
//!
//! What is apart along one direction at both ends of a way is so all along it. Two long edges that turn beside each other
//! by more than the gap between them have no such direction, and stay apart all the same: there is one for each part of
//! the way, if the parts are small.

use super::narrow::{Places, across, gap_along, shortest};
use crate::math::{Real, scale, sub, unit};

/// How often a way is halved.
const HALVINGS: u32 = 6;

/// How two elements are known to stay apart.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Apart<R> {
    /// Along this direction, all the way.
    Along([R; 3]),
    /// Along a direction of its own in each part of the way.
    ByParts,
}

/// How it is certain that the two stay apart, by more than `least` at the start and later on, in metres; nothing if it is
/// not.
#[cold]
pub fn apart<R: Real, const N: usize, const M: usize>(
    ends: [&Places<R, N, M>; 2],
    least: [R; 2],
) -> Option<Apart<R>> {
    let along = separating(ends, least).map(Apart::Along);
    along.or_else(|| halves_apart(ends, least, HALVINGS).then_some(Apart::ByParts))
}

/// A direction along which the two are apart at both ends of a way, if the shortest lines and the planes of the two there
/// are any.
#[inline]
fn separating<R: Real, const N: usize, const M: usize>(
    [before, now]: [&Places<R, N, M>; 2],
    least: [R; 2],
) -> Option<[R; 3]> {
    let first = shortest(*before).0;
    let lines = [shortest(*now).0, across(now.0, now.1), across(before.0, before.1), first];
    let units = lines.into_iter().filter_map(|line| unit(line, R::MIN_DENOMINATOR));
    let mut both = units.flat_map(|n| [n, n.map(|x| -x)]);
    both.find(|&n| gap_along(n, before) > least[0] && gap_along(n, now) > least[1])
}

/// Whether the two are apart in both halves of a way that no one direction tells it of.
fn halves_apart<R: Real, const N: usize, const M: usize>(
    [before, now]: [&Places<R, N, M>; 2],
    least: [R; 2],
    halvings: u32,
) -> bool {
    let middle = halfway(before, now);
    let is_apart = |ends: [&Places<R, N, M>; 2], least: [R; 2]| {
        separating(ends, least).is_some() || halves_apart(ends, least, halvings - 1)
    };
    halvings > 0
        && shortest(middle).2 > least[1]
        && is_apart([before, &middle], least)
        && is_apart([&middle, now], [least[1]; 2])
}

fn halfway<R: Real, const N: usize, const M: usize>(
    (ours, theirs): &Places<R, N, M>,
    (ours_then, theirs_then): &Places<R, N, M>,
) -> Places<R, N, M> {
    let half = R::from_f64(0.5);
    let between = |from: [R; 3], to: [R; 3]| {
        let way = scale(sub(to, from), half);
        std::array::from_fn(|axis| from[axis] + way[axis])
    };
    let ours = std::array::from_fn(|k| between(ours[k], ours_then[k]));
    (ours, std::array::from_fn(|k| between(theirs[k], theirs_then[k])))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    type Edges = Places<f64, 2, 2>;

    fn ends([before, now]: &[Edges; 2]) -> [&Edges; 2] {
        [before, now]
    }

    #[test]
    fn edges_that_turn_beside_each_other_are_seen_to_stay_apart_part_by_part() {
        // The one is turned from z towards y as it goes over; its ends change sides, and it does not touch.
        let still = [[-1.0, 0.0, 0.0], [1.0, 0.0, 0.0]];
        let way = [[[0.0, 0.1, -1.0], [0.0, 0.1, 1.0]], [[0.0, 1.2, -0.1], [0.0, -1.0, 0.3]]];
        let turning = way.map(|edge| (edge, still));
        assert_eq!(apart(ends(&turning), [1e-6; 2]), Some(Apart::ByParts));
    }

    proptest! {
        #[test]
        fn what_stays_apart_never_meets_on_the_way(
            places in proptest::collection::vec(proptest::array::uniform3(-1.0..1.0f64), 8),
        ) {
            let edges = |k: usize| ([places[k], places[k + 1]], [places[k + 2], places[k + 3]]);
            let way: [Edges; 2] = [edges(0), edges(4)];
            if apart(ends(&way), [1e-9; 2]).is_some() {
                let at = |t: f64, from: [f64; 3], to: [f64; 3]| std::array::from_fn(|k| from[k] + t * (to[k] - from[k]));
                let volume = |t: f64| {
                    let p: Vec<[f64; 3]> = (0..4).map(|k| at(t, places[k], places[k + 4])).collect();
                    let (u, v, w) = (sub(p[1], p[0]), sub(p[2], p[0]), sub(p[3], p[0]));
                    u[0] * (v[1] * w[2] - v[2] * w[1]) + u[1] * (v[2] * w[0] - v[0] * w[2])
                        + u[2] * (v[0] * w[1] - v[1] * w[0])
                };
                // They can only meet when all four points are in a plane: at roots of a cubic, bracketed here.
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
                        prop_assert!(shortest::<f64, 2, 2>(([p[0], p[1]], [p[2], p[3]])).2 > 1e-9);
                    }
                }
            }
        }
    }
}
