//! Closest points of four pairs of elements at a time, without branches (Ericson 2005, §5.1).

use crate::math::{Lanes as _, Real, dot, sub};

/// Four numbers, one for each pair.
pub type Four<R> = <R as Real>::Lanes;

/// Four positions, one for each pair.
pub type FourPositions<R> = [Four<R>; 3];

/// The pair of a lane; the first fills the lanes that are left.
#[inline(always)]
pub fn of_lane<T>(pairs: &[T], lane: usize) -> &T {
    &pairs[if lane < pairs.len() { lane } else { 0 }]
}

/// The closest points of two elements of each pair, as weights of their points: point and point, point and edge, point and
/// face (either way round), edge and edge.
#[inline(always)]
pub fn closest<R: Real, const N: usize, const M: usize>(
    x: [FourPositions<R>; N],
    q: [FourPositions<R>; M],
) -> ([Four<R>; N], [Four<R>; M]) {
    let one = R::Lanes::splat(R::ONE);
    let (mut b, mut c) = ([one; N], [one; M]);
    match (N, M) {
        (1, 2) => c.copy_from_slice(&closest_on_segment::<R>(x[0], [q[0], q[1]])),
        (2, 1) => b.copy_from_slice(&closest_on_segment::<R>(q[0], [x[0], x[1]])),
        (1, 3) => c.copy_from_slice(&closest_on_triangle::<R>(x[0], [q[0], q[1], q[2]])),
        (3, 1) => b.copy_from_slice(&closest_on_triangle::<R>(q[0], [x[0], x[1], x[2]])),
        (2, 2) => {
            let (first, second) = closest_on_segments::<R>([x[0], x[1]], [q[0], q[1]]);
            b.copy_from_slice(&first);
            c.copy_from_slice(&second);
        }
        _ => {}
    }
    (b, c)
}

/// The point of an element with these weights.
#[inline(always)]
pub fn interpolate<R: Real, const K: usize>(
    points: &[FourPositions<R>; K],
    weights: &[Four<R>; K],
) -> FourPositions<R> {
    let mut sum = scaled::<R>(points[0], weights[0]);
    for k in 1..K {
        let next = scaled::<R>(points[k], weights[k]);
        sum = [sum[0] + next[0], sum[1] + next[1], sum[2] + next[2]];
    }
    sum
}

/// A triple times a number.
#[inline(always)]
pub fn scaled<R: Real>([x, y, z]: FourPositions<R>, by: Four<R>) -> FourPositions<R> {
    [x * by, y * by, z * by]
}

/// The point of the segment closest to `p`, as weights of its ends.
#[inline(always)]
fn closest_on_segment<R: Real>(p: FourPositions<R>, [a, b]: [FourPositions<R>; 2]) -> [Four<R>; 2] {
    let along = sub(b, a);
    let t = clamp01::<R>(ratio::<R>(dot(sub(p, a), along), dot(along, along)));
    [R::Lanes::splat(R::ONE) - t, t]
}

/// The closest points of two segments, as weights of the ends of each.
#[inline(always)]
fn closest_on_segments<R: Real>(
    [a, b]: [FourPositions<R>; 2],
    [c, d]: [FourPositions<R>; 2],
) -> ([Four<R>; 2], [Four<R>; 2]) {
    let (u, v, r) = (sub(b, a), sub(d, c), sub(a, c));
    let (uu, vv, uv) = (dot(u, u), dot(v, v), dot(u, v));
    let (ur, vr) = (dot(u, r), dot(v, r));
    let (zero, one) = (R::Lanes::splat(R::ZERO), R::Lanes::splat(R::ONE));
    let denominator = uu * vv - uv * uv;
    // Parallel within rounding error: any point of the overlap is equally close.
    let skew = denominator - R::Lanes::splat(R::from_f64(16.0) * R::EPSILON) * uu * vv;
    let first = skew.choose_by_sign(clamp01::<R>((uv * vr - ur * vv) / denominator), zero);
    let second = clamp01::<R>(ratio::<R>(uv * first + vr, vv));
    let s = clamp01::<R>(ratio::<R>(uv * second - ur, uu));
    let t = clamp01::<R>(ratio::<R>(uv * s + vr, vv));
    ([one - s, s], [one - t, t])
}

/// The point of the triangle closest to `p`, as weights of its corners: inside, or the closest of its edges.
#[inline(always)]
fn closest_on_triangle<R: Real>(p: FourPositions<R>, [a, b, c]: [FourPositions<R>; 3]) -> [Four<R>; 3] {
    let (zero, one) = (R::Lanes::splat(R::ZERO), R::Lanes::splat(R::ONE));
    let (ab, ac, bc) = (sub(b, a), sub(c, a), sub(c, b));
    let (ap, bp, cp) = (sub(p, a), sub(p, b), sub(p, c));
    let (d1, d2, d3) = (dot(ab, ap), dot(ac, ap), dot(ab, bp));
    let (d4, d5, d6) = (dot(ac, bp), dot(ab, cp), dot(ac, cp));
    let along_ab = clamp01::<R>(ratio::<R>(d1, d1 - d3));
    let along_ac = clamp01::<R>(ratio::<R>(d2, d2 - d6));
    let along_bc = clamp01::<R>(ratio::<R>(d4 - d3, (d4 - d3) + (d5 - d6)));
    let squared = |from: FourPositions<R>, edge: FourPositions<R>, along: Four<R>| {
        let line = sub(from, scaled::<R>(edge, along));
        dot(line, line)
    };
    let (to_ab, to_ac, to_bc) =
        (squared(ap, ab, along_ab), squared(ap, ac, along_ac), squared(bp, bc, along_bc));
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
    let (inside, sum) = (va.least(vb).least(vc), va + vb + vc);
    let (v, w) = (ratio::<R>(vb, sum), ratio::<R>(vc, sum));
    let mut weights = [one - v - w, v, w];
    for k in 0..3 {
        weights[k] = inside.choose_by_sign(weights[k], on_edges[k]);
    }
    weights
}

#[inline(always)]
fn clamp01<R: Real>(x: Four<R>) -> Four<R> {
    x.most(R::Lanes::splat(R::ZERO)).least(R::Lanes::splat(R::ONE))
}

/// A quotient; zero where the denominator is not above zero (an element that has shrunk to a point).
#[inline(always)]
fn ratio<R: Real>(numerator: Four<R>, denominator: Four<R>) -> Four<R> {
    denominator.choose_by_sign(numerator / denominator, R::Lanes::splat(R::ZERO))
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::contact::narrow_phase;

    type Points<const K: usize> = [[f64; 3]; K];

    fn position() -> impl Strategy<Value = [f64; 3]> {
        // Multiples of a quarter, so that parallel and shrunk elements are common.
        proptest::array::uniform3((-8..8i32).prop_map(|n| f64::from(n) / 4.0))
    }

    /// The distances of one pair: by lanes, in which it stands beside another pair, and by itself.
    fn distances<const N: usize, const M: usize>(x: Points<N>, q: Points<M>, beside: f64) -> [f64; 2] {
        let splat =
            |p: [f64; 3]| p.map(|p| <f64 as Real>::Lanes::from_array([beside - p, p, beside, p + beside]));
        let (ours, theirs) = (x.map(splat), q.map(splat));
        let (b, c) = closest::<f64, N, M>(ours, theirs);
        let line = sub(interpolate::<f64, N>(&ours, &b), interpolate::<f64, M>(&theirs, &c));
        let by_lanes = dot(line, line).to_array()[1].sqrt();
        let (_, _, alone) = narrow_phase::shortest_line((x, q));
        [by_lanes, alone]
    }

    /// # Safety
    ///
    /// Needs a processor with AVX2.
    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "avx2")]
    #[allow(unsafe_code)]
    unsafe fn closest_avx2<const N: usize, const M: usize>(
        x: [FourPositions<f64>; N],
        q: [FourPositions<f64>; M],
    ) -> ([Four<f64>; N], [Four<f64>; M]) {
        closest::<f64, N, M>(x, q)
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
        #[cfg(target_arch = "x86_64")]
        fn lanes_have_the_same_bits_with_avx2(t in proptest::array::uniform4(proptest::array::uniform3(-2.0..2.0f64)), beside in -1.0..1.0f64) {
            if std::arch::is_x86_feature_detected!("avx2") {
                let four = |p: [f64; 3]| p.map(|p| <f64 as Real>::Lanes::from_array([p, p * beside, beside - p, p + beside]));
                let [p, a, b, c] = t.map(four);
                // SAFETY: the processor has AVX2.
                #[allow(unsafe_code)]
                let with = unsafe { (closest_avx2([p], [a, b, c]), closest_avx2([p, a], [b, c])) };
                prop_assert_eq!(with, (closest::<f64, 1, 3>([p], [a, b, c]), closest::<f64, 2, 2>([p, a], [b, c])));
            }
        }

        #[test]
        fn four_pairs_of_edges_are_as_far_apart_as_each_pair_alone(e in proptest::array::uniform4(position()), beside in -1.0..1.0f64) {
            let [by_lanes, alone] = distances([e[0], e[1]], [e[2], e[3]], beside);
            prop_assert!((by_lanes - alone).abs() < 1e-9, "{by_lanes} {alone}");
        }
    }
}
