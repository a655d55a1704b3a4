//! Closest points of four pairs of elements at a time, in double precision and without branches (Ericson 2005, §5.1).

use crate::math::{Lanes as _, Real, dot, sub};

/// Four numbers, one for each pair.
pub type Four = <f64 as Real>::Lanes;

/// Four positions, one for each pair.
pub type FourPositions = [Four; 3];

/// The closest points of two elements of each pair, as weights of their points: point and face (either way round), edge and
/// edge.
#[inline(always)]
pub fn closest<const N: usize, const M: usize>(
    x: [FourPositions; N],
    q: [FourPositions; M],
) -> ([Four; N], [Four; M]) {
    let (mut b, mut c) = ([Four::splat(1.0); N], [Four::splat(1.0); M]);
    match (N, M) {
        (1, 3) => c.copy_from_slice(&closest_on_triangle(x[0], [q[0], q[1], q[2]])),
        (3, 1) => b.copy_from_slice(&closest_on_triangle(q[0], [x[0], x[1], x[2]])),
        (2, 2) => {
            let (first, second) = closest_on_segments([x[0], x[1]], [q[0], q[1]]);
            b.copy_from_slice(&first);
            c.copy_from_slice(&second);
        }
        _ => {}
    }
    (b, c)
}

/// The point of an element with these weights.
#[inline(always)]
pub fn interpolate<const K: usize>(points: &[FourPositions; K], weights: &[Four; K]) -> FourPositions {
    let mut sum = scaled(points[0], weights[0]);
    for k in 1..K {
        let next = scaled(points[k], weights[k]);
        sum = [sum[0] + next[0], sum[1] + next[1], sum[2] + next[2]];
    }
    sum
}

/// A triple times a number.
#[inline(always)]
pub fn scaled([x, y, z]: FourPositions, by: Four) -> FourPositions {
    [x * by, y * by, z * by]
}

/// The closest points of two segments, as weights of the ends of each.
#[inline(always)]
fn closest_on_segments([a, b]: [FourPositions; 2], [c, d]: [FourPositions; 2]) -> ([Four; 2], [Four; 2]) {
    let (u, v, r) = (sub(b, a), sub(d, c), sub(a, c));
    let (uu, vv, uv) = (dot(u, u), dot(v, v), dot(u, v));
    let (ur, vr) = (dot(u, r), dot(v, r));
    let (zero, one) = (Four::splat(0.0), Four::splat(1.0));
    let denominator = uu * vv - uv * uv;
    // Parallel within rounding error: any point of the overlap is equally close.
    let skew = denominator - Four::splat(16.0 * f64::EPSILON) * uu * vv;
    let first = skew.choose_by_sign(clamp01((uv * vr - ur * vv) / denominator), zero);
    let second = clamp01(ratio(uv * first + vr, vv));
    let s = clamp01(ratio(uv * second - ur, uu));
    let t = clamp01(ratio(uv * s + vr, vv));
    ([one - s, s], [one - t, t])
}

/// The point of the triangle closest to `p`, as weights of its corners: inside, or the closest of its edges.
#[inline(always)]
fn closest_on_triangle(p: FourPositions, [a, b, c]: [FourPositions; 3]) -> [Four; 3] {
    let (zero, one) = (Four::splat(0.0), Four::splat(1.0));
    let (ab, ac, bc) = (sub(b, a), sub(c, a), sub(c, b));
    let (ap, bp, cp) = (sub(p, a), sub(p, b), sub(p, c));
    let (d1, d2, d3) = (dot(ab, ap), dot(ac, ap), dot(ab, bp));
    let (d4, d5, d6) = (dot(ac, bp), dot(ab, cp), dot(ac, cp));
    let along_ab = clamp01(ratio(d1, d1 - d3));
    let along_ac = clamp01(ratio(d2, d2 - d6));
    let along_bc = clamp01(ratio(d4 - d3, (d4 - d3) + (d5 - d6)));
    let squared = |from: FourPositions, edge: FourPositions, along: Four| {
        let line = sub(from, scaled(edge, along));
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
    let (v, w) = (ratio(vb, sum), ratio(vc, sum));
    let mut weights = [one - v - w, v, w];
    for k in 0..3 {
        weights[k] = inside.choose_by_sign(weights[k], on_edges[k]);
    }
    weights
}

#[inline(always)]
fn clamp01(x: Four) -> Four {
    x.most(Four::splat(0.0)).least(Four::splat(1.0))
}

/// A quotient; zero where the denominator is not above zero (an element that has shrunk to a point).
#[inline(always)]
fn ratio(numerator: Four, denominator: Four) -> Four {
    denominator.choose_by_sign(numerator / denominator, Four::splat(0.0))
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
        let splat = |p: [f64; 3]| p.map(|p| Four::from_array([beside - p, p, beside, p + beside]));
        let (ours, theirs) = (x.map(splat), q.map(splat));
        let (b, c) = closest(ours, theirs);
        let line = sub(interpolate(&ours, &b), interpolate(&theirs, &c));
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
        x: [FourPositions; N],
        q: [FourPositions; M],
    ) -> ([Four; N], [Four; M]) {
        closest(x, q)
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
        #[cfg(target_arch = "x86_64")]
        fn lanes_have_the_same_bits_with_avx2(t in proptest::array::uniform4(proptest::array::uniform3(-2.0..2.0f64)), beside in -1.0..1.0f64) {
            if std::arch::is_x86_feature_detected!("avx2") {
                let four = |p: [f64; 3]| p.map(|p| Four::from_array([p, p * beside, beside - p, p + beside]));
                let [p, a, b, c] = t.map(four);
                // SAFETY: the processor has AVX2.
                #[allow(unsafe_code)]
                let with = unsafe { (closest_avx2([p], [a, b, c]), closest_avx2([p, a], [b, c])) };
                prop_assert_eq!(with, (closest([p], [a, b, c]), closest([p, a], [b, c])));
            }
        }

        #[test]
        fn four_pairs_of_edges_are_as_far_apart_as_each_pair_alone(e in proptest::array::uniform4(position()), beside in -1.0..1.0f64) {
            let [by_lanes, alone] = distances([e[0], e[1]], [e[2], e[3]], beside);
            prop_assert!((by_lanes - alone).abs() < 1e-9, "{by_lanes} {alone}");
        }
    }
}
