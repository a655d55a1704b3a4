//! Narrow phase: the closest points of two elements of up to three points each.

use crate::math::{Real, add, cross, dot, scale, sub, unit};

/// The positions of the points of two elements, in metres.
pub type ElementPositions<R, const N: usize, const M: usize> = ([[R; 3]; N], [[R; 3]; M]);

/// Lengths in metres below which two elements coincide.
pub const COINCIDENT: f64 = 1e-12;

/// The closest points of two elements, as weights of their points: point and point, point and edge, point and
/// face (either way round), edge and edge.
#[inline]
pub fn closest<R: Real, const N: usize, const M: usize>(x: [[R; 3]; N], q: [[R; 3]; M]) -> ([R; N], [R; M]) {
    let (mut b, mut c) = ([R::ONE; N], [R::ONE; M]);
    match (N, M) {
        (1, 2) => c.copy_from_slice(&closest_on_segment(x[0], [q[0], q[1]])),
        (1, 3) => c.copy_from_slice(&closest_on_triangle(x[0], [q[0], q[1], q[2]])),
        (2, 1) => b.copy_from_slice(&closest_on_segment(q[0], [x[0], x[1]])),
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

/// A direction across two elements: the normal of a face, or the cross product of two edges. Of any length; zero
/// for other pairs.
#[inline]
pub fn cross_direction<R: Real, const N: usize, const M: usize>(x: [[R; 3]; N], q: [[R; 3]; M]) -> [R; 3] {
    match (N, M) {
        (1, 3) => cross(sub(q[1], q[0]), sub(q[2], q[0])),
        (3, 1) => cross(sub(x[1], x[0]), sub(x[2], x[0])),
        (2, 2) => cross(sub(x[1], x[0]), sub(q[1], q[0])),
        _ => [R::ZERO; 3],
    }
}

/// The point of an element with these weights.
#[inline(always)]
pub fn interpolate<R: Real, const K: usize>(points: [[R; 3]; K], weights: [R; K]) -> [R; 3] {
    // Loops, because sums over mapped ranges are not inlined.
    let mut sum = scale(points[0], weights[0]);
    for k in 1..K {
        sum = add(sum, scale(points[k], weights[k]));
    }
    sum
}

/// The line from the centroid of their element to the centroid of ours.
#[inline(always)]
pub fn between_centroids<R: Real, const N: usize, const M: usize>(
    (ours, theirs): &ElementPositions<R, N, M>,
) -> [R; 3] {
    sub(centroid(ours), centroid(theirs))
}

#[inline(always)]
fn centroid<R: Real, const K: usize>(points: &[[R; 3]; K]) -> [R; 3] {
    let mut sum = points[0];
    for k in 1..K {
        sum = add(sum, points[k]);
    }
    scale(sum, R::from_f64(1.0 / K as f64))
}

/// The smallest gap along a direction: the least of our points minus the greatest of theirs.
#[inline(always)]
pub fn gap_along<R: Real, const N: usize, const M: usize>(
    normal: [R; 3],
    at: &ElementPositions<R, N, M>,
) -> R {
    let mut ours = dot(normal, at.0[0]);
    for k in 1..N {
        let height = dot(normal, at.0[k]);
        ours = if height < ours { height } else { ours };
    }
    let mut theirs = dot(normal, at.1[0]);
    for k in 1..M {
        let height = dot(normal, at.1[k]);
        theirs = if height > theirs { height } else { theirs };
    }
    ours - theirs
}

/// The shortest line from their element to ours: its direction, its ends as weights, and its length.
#[inline(always)]
#[allow(clippy::type_complexity)]
pub fn shortest_line<R: Real, const N: usize, const M: usize>(
    at: ElementPositions<R, N, M>,
) -> ([R; 3], ([R; N], [R; M]), R) {
    let (b, c) = closest(at.0, at.1);
    let line = sub(interpolate(at.0, b), interpolate(at.1, c));
    let length = dot(line, line).sqrt();
    if length > R::from_f64(COINCIDENT) {
        return (scale(line, R::ONE / length), (b, c), length);
    }
    let up = [R::ZERO, R::ONE, R::ZERO];
    (unit(cross_direction(at.0, at.1), R::MIN_DENOMINATOR).unwrap_or(up), (b, c), R::ZERO)
}

/// The point of the segment closest to `p`, as weights of its ends.
pub fn closest_on_segment<R: Real>(p: [R; 3], [a, b]: [[R; 3]; 2]) -> [R; 2] {
    let along = sub(b, a);
    let t = clamp01(ratio(dot(sub(p, a), along), dot(along, along)));
    [R::ONE - t, t]
}

/// The point of the triangle closest to `p`, as weights of its corners (Ericson 2005, §5.1.5).
#[inline]
pub fn closest_on_triangle<R: Real>(p: [R; 3], [a, b, c]: [[R; 3]; 3]) -> [R; 3] {
    let (zero, one) = (R::ZERO, R::ONE);
    let (ab, ac, ap) = (sub(b, a), sub(c, a), sub(p, a));
    let (d1, d2) = (dot(ab, ap), dot(ac, ap));
    if d1 <= zero && d2 <= zero {
        return [one, zero, zero];
    }
    let bp = sub(p, b);
    let (d3, d4) = (dot(ab, bp), dot(ac, bp));
    if d3 >= zero && d4 <= d3 {
        return [zero, one, zero];
    }
    let vc = d1 * d4 - d3 * d2;
    if vc <= zero && d1 >= zero && d3 <= zero && d1 > d3 {
        let v = ratio(d1, d1 - d3);
        return [one - v, v, zero];
    }
    let cp = sub(p, c);
    let (d5, d6) = (dot(ab, cp), dot(ac, cp));
    if d6 >= zero && d5 <= d6 {
        return [zero, zero, one];
    }
    let vb = d5 * d2 - d1 * d6;
    if vb <= zero && d2 >= zero && d6 <= zero {
        let w = ratio(d2, d2 - d6);
        return [one - w, zero, w];
    }
    let va = d3 * d6 - d5 * d4;
    if va <= zero && d4 - d3 >= zero && d5 - d6 >= zero {
        let w = ratio(d4 - d3, (d4 - d3) + (d5 - d6));
        return [zero, one - w, w];
    }
    let sum = va + vb + vc;
    if sum <= R::from_f64(THIN_CORNER) * dot(ab, ab) * dot(ac, ac) {
        return closest_on_needle(p, [a, b, c]);
    }
    let (v, w) = (ratio(vb, sum), ratio(vc, sum));
    [one - v - w, v, w]
}

/// Squared sine of the angle at the first corner of a triangle, below which products of scalar products lose its area to
/// rounding in `f32`.
const THIN_CORNER: f64 = 1e-2;

/// [`closest_on_triangle`] where the point may be above the inside of a triangle almost without area: its closest edge, or
/// above the inside, by cross products.
#[cold]
fn closest_on_needle<R: Real>(p: [R; 3], corners: [[R; 3]; 3]) -> [R; 3] {
    let [a, b, c] = corners;
    let (ab, ac, ap) = (sub(b, a), sub(c, a), sub(p, a));
    let normal = cross(ab, ac);
    let sum = dot(normal, normal);
    let (v, w) = (ratio(dot(normal, cross(ap, ac)), sum), ratio(dot(normal, cross(ab, ap)), sum));
    let inside = [R::ONE - v - w, v, w];
    let mut best = None;
    if inside.iter().all(|&weight| weight >= R::ZERO) {
        best = Some((inside, distance_squared(p, interpolate(corners, inside))));
    }
    for k in 0..3 {
        let ends = [k, (k + 1) % 3];
        let on_edge = closest_on_segment(p, ends.map(|end| corners[end]));
        let mut weights = [R::ZERO; 3];
        (weights[ends[0]], weights[ends[1]]) = (on_edge[0], on_edge[1]);
        let distance = distance_squared(p, interpolate(corners, weights));
        if best.is_none_or(|(_, least)| distance < least) {
            best = Some((weights, distance));
        }
    }
    best.map_or(inside, |(weights, _)| weights)
}

fn distance_squared<R: Real>(p: [R; 3], q: [R; 3]) -> R {
    let line = sub(p, q);
    dot(line, line)
}

/// The closest points of two segments, as weights of the ends of each (Ericson 2005, §5.1.9).
#[inline]
pub fn closest_on_segments<R: Real>([a, b]: [[R; 3]; 2], [c, d]: [[R; 3]; 2]) -> ([R; 2], [R; 2]) {
    let (u, v, r) = (sub(b, a), sub(d, c), sub(a, c));
    let (uu, vv, uv) = (dot(u, u), dot(v, v), dot(u, v));
    let (ur, vr) = (dot(u, r), dot(v, r));
    let denominator = uu * vv - uv * uv;
    // Parallel within rounding error: any point of the overlap is equally close.
    let parallel = denominator <= R::EPSILON * R::from_f64(16.0) * uu * vv;
    let first = if parallel { R::ZERO } else { clamp01((uv * vr - ur * vv) / denominator) };
    let second = ratio(uv * first + vr, vv);
    let s = if second >= R::ZERO && second <= R::ONE && !parallel {
        first
    } else {
        clamp01(ratio(uv * clamp01(second) - ur, uu))
    };
    let t = clamp01(ratio(uv * s + vr, vv));
    ([R::ONE - s, s], [R::ONE - t, t])
}

#[inline(always)]
fn clamp01<R: Real>(x: R) -> R {
    if x > R::ZERO { if x < R::ONE { x } else { R::ONE } } else { R::ZERO }
}

/// A quotient; zero where the denominator is zero (an element that has shrunk to a point).
#[inline(always)]
fn ratio<R: Real>(numerator: R, denominator: R) -> R {
    if denominator == R::ZERO { R::ZERO } else { numerator / denominator }
}

#[cfg(test)]
mod tests {
    use parry3d_f64::math::Vector;
    use parry3d_f64::query::{self, ClosestPoints, PointQuery};
    use parry3d_f64::shape::{Segment, Triangle};
    use proptest::prelude::*;

    use super::*;

    type Point = [f64; 3];

    fn point() -> impl Strategy<Value = Point> {
        proptest::array::uniform3(-2.0..2.0f64)
    }

    fn of(p: Point) -> Vector {
        Vector::new(p[0], p[1], p[2])
    }

    proptest! {
        #[test]
        fn the_closest_point_of_a_triangle_is_where_parry_finds_it(p in point(), t in proptest::array::uniform3(point())) {
            let weights = closest_on_triangle(p, t);
            let found = interpolate(t, weights);
            let parry = Triangle::new(of(t[0]), of(t[1]), of(t[2])).project_local_point(of(p), false).point;
            prop_assert!(((of(p) - of(found)).length() - (of(p) - parry).length()).abs() < 1e-9);
        }

        #[test]
        fn segments_are_as_far_apart_as_parry_says(e in proptest::array::uniform4(point())) {
            let (s, t) = closest_on_segments([e[0], e[1]], [e[2], e[3]]);
            let gap = (of(interpolate([e[0], e[1]], s)) - of(interpolate([e[2], e[3]], t))).length();
            let (first, second) = (Segment::new(of(e[0]), of(e[1])), Segment::new(of(e[2]), of(e[3])));
            let here = parry3d_f64::math::Pose::default();
            if let ClosestPoints::WithinMargin(a, b) =
                query::closest_points(&here, &first, &here, &second, 100.0).unwrap()
            {
                prop_assert!((gap - (a - b).length()).abs() < 1e-6, "{gap} against {}", (a - b).length());
            }
        }

        #[test]
        fn no_edge_of_a_needle_is_closer_than_its_closest_point(
            p in point(),
            ends in proptest::array::uniform2(point()),
            along in prop_oneof![Just(0.0), Just(1.0), -0.5..1.5f64],
            aside in point(),
            height in prop_oneof![Just(0.0), (-9.0..-1.0f64).prop_map(|power| 10f64.powf(power))],
            order in Just([0, 1, 2]).prop_shuffle(),
        ) {
            let [a, b] = ends;
            let c = add(add(a, scale(sub(b, a), along)), scale(aside, height));
            let corners = order.map(|k| [a, b, c][k].map(|x| x as f32));
            let p = p.map(|x| x as f32);
            let distance_to = |q: [f32; 3]| {
                let line = sub(p.map(f64::from), q.map(f64::from));
                dot(line, line).sqrt()
            };
            let found = distance_to(interpolate(corners, closest_on_triangle(p, corners)));
            for edge in [0, 1, 2].map(|k| [corners[k], corners[(k + 1) % 3]]) {
                let on_edge = distance_to(interpolate(edge, closest_on_segment(p, edge)));
                prop_assert!(found <= on_edge + 1e-5, "{found} where an edge is {on_edge} away");
            }
        }

        #[test]
        fn an_element_that_has_shrunk_to_a_point_still_has_a_closest_point(p in point(), q in point()) {
            prop_assert_eq!(closest_on_triangle(p, [q; 3]).iter().sum::<f64>(), 1.0);
            let (s, t) = closest_on_segments([p, p], [q, q]);
            prop_assert_eq!(s[0] + s[1] + t[0] + t[1], 2.0);
        }
    }
}
