//! Free points on their ways: where they come nearest within a time step, and along which line they first touch.
//!
//! Cloth goes a part of an edge in a step, so that what its elements pass on is a plane along the shortest line between
//! them. A free point can go many times its size: along that line it would be held up by all that it flies past.

use crate::contact::narrow::{Places, between_middles, gap_along, shortest};
use crate::math::{Real, add, dot, scale, sub, unit};

/// A line along which two elements stay `kept` apart all through a step: from where they come nearest. Nothing if that
/// is none.
pub fn passes_beside<R: Real, const N: usize, const M: usize>(
    before: &Places<R, N, M>,
    now: &Places<R, N, M>,
    kept: R,
) -> Option<[R; 3]> {
    let share = nearest(between_middles(before), between_middles(now));
    let (normal, _, _) = shortest(between(before, now, share));
    let stays = gap_along(normal, before) >= kept && gap_along(normal, now) >= kept;
    stays.then_some(normal)
}

/// The line from their point to ours when the two first are `kept` apart; nothing if they are that near already, never come
/// that near, or are more than one point.
pub fn first_touch<R: Real, const N: usize, const M: usize>(
    before: &Places<R, N, M>,
    now: &Places<R, N, M>,
    kept: R,
) -> Option<[R; 3]> {
    if N + M > 2 {
        return None;
    }
    let line = sub(before.0[0], before.1[0]);
    let way = sub(sub(now.0[0], now.1[0]), line);
    // |line + t way| = kept, the lesser t of the two.
    let (a, half_b, c) = (dot(way, way), dot(line, way), dot(line, line) - kept * kept);
    let discriminant = half_b * half_b - a * c;
    if c <= R::ZERO || half_b >= R::ZERO || discriminant < R::ZERO {
        return None;
    }
    // c / (-b + sqrt) instead of (-b - sqrt) / a: it does not cancel.
    let share = c / (discriminant.sqrt() - half_b);
    unit(add(line, scale(way, share)), R::MIN_DENOMINATOR)
}

/// The share of a step at which a line that goes from one to another is shortest.
fn nearest<R: Real>(from: [R; 3], to: [R; 3]) -> R {
    let way = sub(to, from);
    let square = dot(way, way);
    if square <= R::MIN_DENOMINATOR {
        return R::ZERO;
    }
    let share = -dot(from, way) / square;
    if share > R::ONE {
        R::ONE
    } else if share > R::ZERO {
        share
    } else {
        R::ZERO
    }
}

/// Where two elements are when a share of the step is over.
fn between<R: Real, const N: usize, const M: usize>(
    before: &Places<R, N, M>,
    now: &Places<R, N, M>,
    share: R,
) -> Places<R, N, M> {
    let on = |from: [R; 3], to: [R; 3]| add(from, scale(sub(to, from), share));
    let ours = std::array::from_fn(|k| on(before.0[k], now.0[k]));
    (ours, std::array::from_fn(|k| on(before.1[k], now.1[k])))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A point that flies past another at a distance, from x = 3 to x = -3.
    fn flight(beside: f64) -> [Places<f64, 1, 1>; 2] {
        [3.0, -3.0].map(|x| ([[x, beside, 0.0]], [[0.0; 3]]))
    }

    #[test]
    fn what_flies_past_farther_off_than_it_keeps_is_beside_and_what_flies_past_nearer_touches() {
        let [before, now] = flight(1.5);
        assert_eq!(passes_beside(&before, &now, 1.0), Some([0.0, 1.0, 0.0]));
        assert_eq!(first_touch(&before, &now, 1.0), None);
        let [before, now] = flight(0.6);
        assert_eq!(passes_beside(&before, &now, 1.0), None);
        // It touches where the two are 0.8 and 0.6 apart.
        let normal = first_touch(&before, &now, 1.0).expect("it touches");
        assert!((normal[0] - 0.8).abs() < 1e-12 && (normal[1] - 0.6).abs() < 1e-12, "{normal:?}");
    }

    #[test]
    fn what_goes_away_or_has_come_too_near_already_has_no_first_touch() {
        let [before, now] = flight(0.6);
        assert_eq!(first_touch(&now, &([[-9.0, 0.6, 0.0]], [[0.0; 3]]), 1.0), None);
        assert_eq!(first_touch(&before, &now, 4.0), None);
    }

    #[test]
    fn a_point_that_flies_past_a_face_is_beside_it_however_far_it_goes() {
        let face = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]];
        let at = |x: f64, y: f64| ([[x, y, 0.2]], face);
        assert!(passes_beside::<f64, 1, 3>(&at(1.2, 50.0), &at(1.2, -50.0), 0.1).is_some());
        assert!(passes_beside::<f64, 1, 3>(&at(0.3, 50.0), &at(0.3, -50.0), 0.1).is_none());
    }
}
