//! Closest points of several pairs of elements at a time, one in each lane, without branches (Ericson 2005, §5.1).

use crate::math::{Lanes, Real, dot, sub};

/// Positions, one for each pair.
pub type Positions<L> = [L; 3];

/// Squared sine of the angle at the first corner of a triangle, in rounding errors, below which its area is lost to rounding.
const NEEDLE: f64 = 64.0;

/// The pair of a lane; the first fills the lanes that are left.
#[inline(always)]
pub fn of_lane<T>(pairs: &[T], lane: usize) -> &T {
    &pairs[if lane < pairs.len() { lane } else { 0 }]
}

/// The closest points of two elements of each pair, as weights of their points: point and point, point and edge, point and
/// face (either way round), edge and edge.
#[inline(always)]
pub fn closest<R: Real, L: Lanes<R>, const N: usize, const M: usize>(
    x: [Positions<L>; N],
    q: [Positions<L>; M],
) -> ([L; N], [L; M]) {
    let one = L::splat(R::ONE);
    let (mut b, mut c) = ([one; N], [one; M]);
    match (N, M) {
        (1, 2) => c.copy_from_slice(&closest_on_segment::<R, L>(x[0], [q[0], q[1]])),
        (2, 1) => b.copy_from_slice(&closest_on_segment::<R, L>(q[0], [x[0], x[1]])),
        (1, 3) => c.copy_from_slice(&closest_on_triangle::<R, L>(x[0], [q[0], q[1], q[2]])),
        (3, 1) => b.copy_from_slice(&closest_on_triangle::<R, L>(q[0], [x[0], x[1], x[2]])),
        (2, 2) => {
            let (first, second) = closest_on_segments::<R, L>([x[0], x[1]], [q[0], q[1]]);
            b.copy_from_slice(&first);
            c.copy_from_slice(&second);
        }
        _ => {}
    }
    (b, c)
}

/// The point of an element with these weights.
#[inline(always)]
pub fn interpolate<R: Real, L: Lanes<R>, const K: usize>(
    points: &[Positions<L>; K],
    weights: &[L; K],
) -> Positions<L> {
    let mut sum = scaled::<R, L>(points[0], weights[0]);
    for k in 1..K {
        let next = scaled::<R, L>(points[k], weights[k]);
        sum = [sum[0] + next[0], sum[1] + next[1], sum[2] + next[2]];
    }
    sum
}

/// A triple times a number.
#[inline(always)]
pub fn scaled<R: Real, L: Lanes<R>>([x, y, z]: Positions<L>, by: L) -> Positions<L> {
    [x * by, y * by, z * by]
}

/// The point of the segment closest to `p`, as weights of its ends.
#[inline(always)]
fn closest_on_segment<R: Real, L: Lanes<R>>(p: Positions<L>, [a, b]: [Positions<L>; 2]) -> [L; 2] {
    let along = sub(b, a);
    let t = clamp01::<R, L>(ratio::<R, L>(dot(sub(p, a), along), dot(along, along)));
    [L::splat(R::ONE) - t, t]
}

/// The closest points of two segments, as weights of the ends of each.
#[inline(always)]
fn closest_on_segments<R: Real, L: Lanes<R>>(
    [a, b]: [Positions<L>; 2],
    [c, d]: [Positions<L>; 2],
) -> ([L; 2], [L; 2]) {
    let (u, v, r) = (sub(b, a), sub(d, c), sub(a, c));
    let (uu, vv, uv) = (dot(u, u), dot(v, v), dot(u, v));
    let (ur, vr) = (dot(u, r), dot(v, r));
    let (zero, one) = (L::splat(R::ZERO), L::splat(R::ONE));
    let denominator = uu * vv - uv * uv;
    // Parallel within rounding error: any point of the overlap is equally close.
    let skew = denominator - L::splat(R::from_f64(16.0) * R::EPSILON) * uu * vv;
    let first = skew.choose_by_sign(clamp01::<R, L>((uv * vr - ur * vv) / denominator), zero);
    let second = clamp01::<R, L>(ratio::<R, L>(uv * first + vr, vv));
    let s = clamp01::<R, L>(ratio::<R, L>(uv * second - ur, uu));
    let t = clamp01::<R, L>(ratio::<R, L>(uv * s + vr, vv));
    ([one - s, s], [one - t, t])
}

/// The point of the triangle closest to `p`, as weights of its corners: inside, or on the closest of its edges. A triangle
/// almost without area is its edges.
#[inline(always)]
fn closest_on_triangle<R: Real, L: Lanes<R>>(p: Positions<L>, [a, b, c]: [Positions<L>; 3]) -> [L; 3] {
    let (zero, one) = (L::splat(R::ZERO), L::splat(R::ONE));
    let (ab, ac, bc) = (sub(b, a), sub(c, a), sub(c, b));
    let (ap, bp, cp) = (sub(p, a), sub(p, b), sub(p, c));
    let (d1, d2, d3) = (dot(ab, ap), dot(ac, ap), dot(ab, bp));
    let (d4, d5, d6) = (dot(ac, bp), dot(ab, cp), dot(ac, cp));
    let along_ab = clamp01::<R, L>(ratio::<R, L>(d1, d1 - d3));
    let along_ac = clamp01::<R, L>(ratio::<R, L>(d2, d2 - d6));
    let along_bc = clamp01::<R, L>(ratio::<R, L>(d4 - d3, (d4 - d3) + (d5 - d6)));
    let to_ab = distance_squared::<R, L>(ap, ab, along_ab);
    let to_ac = distance_squared::<R, L>(ap, ac, along_ac);
    let to_bc = distance_squared::<R, L>(bp, bc, along_bc);
    let ac_is_closer = to_ab - to_ac;
    let mut on_edges = [one - along_ab, along_ab, zero];
    let of_ac = [one - along_ac, zero, along_ac];
    let of_bc = [zero, one - along_bc, along_bc];
    let bc_is_closest = to_ab.least(to_ac) - to_bc;
    for k in 0..3 {
        on_edges[k] =
            bc_is_closest.choose_by_sign(of_bc[k], ac_is_closer.choose_by_sign(of_ac[k], on_edges[k]));
    }
    let (va, vb, vc) = (d3 * d6 - d5 * d4, d5 * d2 - d1 * d6, d1 * d4 - d3 * d2);
    let sum = va + vb + vc;
    let wide = sum - L::splat(R::from_f64(NEEDLE) * R::EPSILON) * dot(ab, ab) * dot(ac, ac);
    let inside = va.least(vb).least(vc).least(wide);
    let (v, w) = (ratio::<R, L>(vb, sum), ratio::<R, L>(vc, sum));
    let mut weights = [one - v - w, v, w];
    for k in 0..3 {
        weights[k] = inside.choose_by_sign(weights[k], on_edges[k]);
    }
    weights
}

/// From a point to one on an edge; both relative to an end of the edge.
#[inline(always)]
fn distance_squared<R: Real, L: Lanes<R>>(point: Positions<L>, edge: Positions<L>, along: L) -> L {
    let line = sub(point, scaled::<R, L>(edge, along));
    dot(line, line)
}

#[inline(always)]
fn clamp01<R: Real, L: Lanes<R>>(x: L) -> L {
    x.most(L::splat(R::ZERO)).least(L::splat(R::ONE))
}

/// A quotient; zero where the denominator is not above zero (an element that has shrunk to a point).
#[inline(always)]
fn ratio<R: Real, L: Lanes<R>>(numerator: L, denominator: L) -> L {
    denominator.choose_by_sign(numerator / denominator, L::splat(R::ZERO))
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::contact::narrow_phase;
    use crate::math::kernel::{self, Kernel};
    use crate::math::{Quad, Two};

    type Points<const K: usize> = [[f64; 3]; K];

    fn position() -> impl Strategy<Value = [f64; 3]> {
        // Multiples of a quarter, so that parallel and shrunk elements are common.
        proptest::array::uniform3((-8..8i32).prop_map(|n| f64::from(n) / 4.0))
    }

    /// The distances of one pair: by lanes, in which it stands beside another pair, and by itself.
    fn distances<const N: usize, const M: usize>(x: Points<N>, q: Points<M>, beside: f64) -> [f64; 2] {
        let splat = |p: [f64; 3]| p.map(|p| Quad([beside - p, p, beside, p + beside]));
        let (ours, theirs) = (x.map(splat), q.map(splat));
        let (b, c) = closest::<f64, Quad<f64>, N, M>(ours, theirs);
        let line = sub(interpolate(&ours, &b), interpolate(&theirs, &c));
        let by_lanes = dot(line, line).to_array()[1].sqrt();
        let (_, _, alone) = narrow_phase::shortest_line((x, q));
        [by_lanes, alone]
    }

    /// Closest points in the lanes of the machine, as bits.
    struct Closest<'a> {
        points: [[[f32; 4]; 2]; 12],
        bits: &'a mut Vec<u32>,
    }

    impl Kernel<f32> for Closest<'_> {
        /// # Safety
        /// The machine has the lanes.
        #[inline(always)]
        #[allow(unsafe_code)]
        unsafe fn run<L: Lanes<f32>>(self) {
            let axis = |k: usize| L::of_groups(|group| self.points[k][group]);
            let [p, a, b, c] = [0, 3, 6, 9].map(|k| [axis(k), axis(k + 1), axis(k + 2)]);
            let (_, on_face) = closest::<f32, L, 1, 3>([p], [a, b, c]);
            let (first, second) = closest::<f32, L, 2, 2>([p, a], [b, c]);
            for weight in on_face.into_iter().chain(first).chain(second) {
                weight.for_groups(|_, four| self.bits.extend(four.map(f32::to_bits)));
            }
        }
    }

    proptest! {
        #[test]
        fn four_points_and_faces_are_as_far_apart_as_each_pair_alone(p in position(), t in proptest::array::uniform3(position()), beside in -1.0..1.0f64) {
            let [by_lanes, alone] = distances([p], t, beside);
            prop_assert!((by_lanes - alone).abs() < 1e-9, "{by_lanes} {alone}");
            let [by_lanes, alone] = distances(t, [p], beside);
            prop_assert!((by_lanes - alone).abs() < 1e-9, "{by_lanes} {alone}");
        }

        #[test]
        fn four_points_and_edges_are_as_far_apart_as_each_pair_alone(p in position(), e in proptest::array::uniform2(position()), beside in -1.0..1.0f64) {
            for [by_lanes, alone] in [distances([p], e, beside), distances(e, [p], beside), distances([p], [e[0]], beside)] {
                prop_assert!((by_lanes - alone).abs() < 1e-9, "{by_lanes} {alone}");
            }
        }

        #[test]
        fn the_lanes_of_the_machine_have_the_bits_of_plain_ones(
            points in proptest::array::uniform12(proptest::array::uniform2(proptest::array::uniform4(-2.0..2.0f32))),
        ) {
            let (mut own, mut plain) = (Vec::new(), Vec::new());
            // SAFETY: the kernel asks for nothing but the lanes.
            #[allow(unsafe_code)]
            unsafe {
                kernel::run(Closest { points, bits: &mut own });
                Closest { points, bits: &mut plain }.run::<Two<Quad<f32>>>();
            }
            prop_assert_eq!(own, plain);
        }

        #[test]
        fn the_closest_point_of_a_sliver_is_on_it_within_its_width(
            p in proptest::array::uniform3(-1.0..1.0f32),
            length in 0.5..2.0f32,
            width in 0.0..1e-3f32,
            along in 0.0..1.0f32,
        ) {
            let t = [[0.0, 0.0, 0.0], [length, 0.0, 0.0], [along * length, width, 0.0]];
            let splat = |p: [f32; 3]| p.map(|x| Quad([x; 4]));
            let (_, weights) = closest::<f32, Quad<f32>, 1, 3>([splat(p)], t.map(splat));
            let line = sub(splat(p), interpolate(&t.map(splat), &weights));
            let found = dot(line, line).sqrt().to_array()[0];
            let wide = |p: [f32; 3]| p.map(f64::from);
            let (_, _, distance) = narrow_phase::shortest_line(([wide(p)], t.map(wide)));
            prop_assert!((f64::from(found) - distance).abs() <= f64::from(width) + 1e-6, "{found} {distance}");
        }

        #[test]
        fn four_pairs_of_edges_are_as_far_apart_as_each_pair_alone(e in proptest::array::uniform4(position()), beside in -1.0..1.0f64) {
            let [by_lanes, alone] = distances([e[0], e[1]], [e[2], e[3]], beside);
            prop_assert!((by_lanes - alone).abs() < 1e-9, "{by_lanes} {alone}");
        }
    }
}
