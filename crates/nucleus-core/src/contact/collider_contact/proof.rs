//! The proof that cloth and collider did not pass each other in a step.

use super::step::Step;
use super::{Pair, Point, Proof, across, closest, weigh};
use crate::contact::apart::apart;
use crate::math::Real;

impl<R: Real, const N: usize, const M: usize> Pair<R, N, M> {
    /// Whether it is certain that the two did not pass each other in this step; takes up another plane if that
    /// proves it.
    #[inline]
    pub fn prove(&mut self, step: &Step<'_, R>) -> Proof {
        let moved = self.points.map(|point| step.moved(point).xyz());
        let size = moved[0].into_iter().map(|x| if x > R::ZERO { x } else { -x }).sum::<R>();
        // What lies within rounding of the plane is looked at in double precision.
        let grain = (size + step.thickness) * (R::EPSILON * R::from_f64(16.0));
        let (_, at_end) = self.gaps(moved, step.share(step.time[1]));
        // The plane may be of the end of a pass in this step, and good for nothing at its start.
        let (_, at_start) = self.gaps(self.points.map(|point| step.start(point)), step.share(step.time[0]));
        if (at_end > grain && at_start > grain) || self.may_pass(step) {
            return Proof::Certain;
        }
        self.prove_otherwise(step, at_end)
    }

    /// Whether the scene lets the two pass through each other: a collision that is carried out in part is none that holds.
    #[cold]
    pub(super) fn may_pass(&self, step: &Step<'_, R>) -> bool {
        let of_points = |map: &[R]| map.is_empty() || self.points.iter().any(|&p| map[p as usize] < R::ONE);
        let all = step.terms.strength.iter().any(|&side| side < R::ONE);
        step.terms.is_weak(step.maps) && (all || of_points(&step.maps.strength))
    }

    #[cold]
    fn prove_otherwise(&mut self, step: &Step<'_, R>, at_end: R) -> Proof {
        let (cloth, surface) = (step.cloth(self.points), step.surface(self.collider_points));
        let ([x0, x1], [q0, q1]) = (cloth, surface);
        let at_start = closest(x0, q0);
        let line = |x, q, (b, c)| weigh(x, b) - weigh(q, c);
        let directions =
            [line(x0, q0, at_start), across(x1, q1), across(x0, q0), line(x1, q1, closest(x1, q1))];
        match best_plane(directions, cloth, surface) {
            Some((gap, normal)) if gap > 0.0 => self.turn_to(normal, at_start, step),
            Some(_) if !stays(cloth, surface) => return Proof::Open,
            None if at_end < R::ZERO => return Proof::Inseparable,
            _ => {}
        }
        Proof::Certain
    }
}

/// Whether it is certain that the two stay apart all through the step, though no one direction tells.
pub(super) fn stays<const N: usize, const M: usize>(
    [x0, x1]: [[Point; N]; 2],
    [q0, q1]: [[Point; M]; 2],
) -> bool {
    let at = |x: [Point; N], q: [Point; M]| (x.map(Into::into), q.map(Into::into));
    apart([&at(x0, q0), &at(x1, q1)], [0.0; 2]).is_some()
}

/// Among some directions, each taken both ways, the one that separates the two at the start of the step
/// and leaves the largest gap at its end.
pub(super) fn best_plane<const N: usize, const M: usize>(
    directions: [Point; 4],
    [x0, x1]: [[Point; N]; 2],
    [q0, q1]: [[Point; M]; 2],
) -> Option<(f64, Point)> {
    let gap = |n: Point, x: &[Point], q: &[Point]| {
        let least = x.iter().map(|x| n.dot(x)).fold(f64::INFINITY, f64::min);
        least - q.iter().map(|q| n.dot(q)).fold(f64::NEG_INFINITY, f64::max)
    };
    let units = directions.into_iter().filter_map(|direction| direction.try_normalize(1e-12));
    let planes = units.flat_map(|n| [n, -n]).filter(|&n| gap(n, &x0, &q0) > 0.0);
    planes.map(|n| (gap(n, &x1, &q1), n)).max_by(|a, b| a.0.total_cmp(&b.0))
}
