//! Narrow phase: the closest points of two elements, point against face and edge against edge.
//!
//! In double precision; only pairs that are about to touch come here.

use nalgebra::Vector3;

type Point = Vector3<f64>;

/// The point of the triangle closest to `p`, as weights of its corners (Ericson 2005, §5.1.5).
pub fn closest_on_triangle(p: Point, [a, b, c]: [Point; 3]) -> [f64; 3] {
    let (ab, ac, ap) = (b - a, c - a, p - a);
    let (d1, d2) = (ab.dot(&ap), ac.dot(&ap));
    if d1 <= 0.0 && d2 <= 0.0 {
        return [1.0, 0.0, 0.0];
    }
    let bp = p - b;
    let (d3, d4) = (ab.dot(&bp), ac.dot(&bp));
    if d3 >= 0.0 && d4 <= d3 {
        return [0.0, 1.0, 0.0];
    }
    let vc = d1 * d4 - d3 * d2;
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        let v = ratio(d1, d1 - d3);
        return [1.0 - v, v, 0.0];
    }
    let cp = p - c;
    let (d5, d6) = (ab.dot(&cp), ac.dot(&cp));
    if d6 >= 0.0 && d5 <= d6 {
        return [0.0, 0.0, 1.0];
    }
    let vb = d5 * d2 - d1 * d6;
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        let w = ratio(d2, d2 - d6);
        return [1.0 - w, 0.0, w];
    }
    let va = d3 * d6 - d5 * d4;
    if va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0 {
        let w = ratio(d4 - d3, (d4 - d3) + (d5 - d6));
        return [0.0, 1.0 - w, w];
    }
    let sum = va + vb + vc;
    let (v, w) = (ratio(vb, sum), ratio(vc, sum));
    [1.0 - v - w, v, w]
}

/// The closest points of two segments, as weights of the ends of each (Ericson 2005, §5.1.9).
pub fn closest_on_segments([a, b]: [Point; 2], [c, d]: [Point; 2]) -> ([f64; 2], [f64; 2]) {
    let (u, v, r) = (b - a, d - c, a - c);
    let (uu, vv, uv) = (u.norm_squared(), v.norm_squared(), u.dot(&v));
    let (ur, vr) = (u.dot(&r), v.dot(&r));
    let denominator = uu * vv - uv * uv;
    // Parallel within rounding: any point of the overlap is as close as another.
    let parallel = denominator <= 1e-12 * uu * vv;
    let first = if parallel { 0.0 } else { clamp01((uv * vr - ur * vv) / denominator) };
    let second = ratio(uv * first + vr, vv);
    let s = if (0.0..=1.0).contains(&second) && !parallel {
        first
    } else {
        clamp01(ratio(uv * clamp01(second) - ur, uu))
    };
    let t = clamp01(ratio(uv * s + vr, vv));
    ([1.0 - s, s], [1.0 - t, t])
}

fn clamp01(x: f64) -> f64 {
    x.clamp(0.0, 1.0)
}

/// A quotient, nought where there is nothing to divide by (an element that has shrunk to a point).
fn ratio(numerator: f64, denominator: f64) -> f64 {
    if denominator == 0.0 { 0.0 } else { numerator / denominator }
}

#[cfg(test)]
mod tests {
    use super::*;
    use parry3d_f64::math::Vector;
    use parry3d_f64::query::{self, ClosestPoints, PointQuery};
    use parry3d_f64::shape::{Segment, Triangle};
    use proptest::prelude::*;

    fn point() -> impl Strategy<Value = Point> {
        proptest::array::uniform3(-2.0..2.0f64).prop_map(Point::from)
    }

    fn of(p: Point) -> Vector {
        Vector::new(p.x, p.y, p.z)
    }

    proptest! {
        #[test]
        fn the_closest_point_of_a_triangle_is_where_parry_finds_it(p in point(), t in proptest::array::uniform3(point())) {
            let weights = closest_on_triangle(p, t);
            let found: Point = (0..3).map(|k| t[k] * weights[k]).sum();
            let parry = Triangle::new(of(t[0]), of(t[1]), of(t[2])).project_local_point(of(p), false).point;
            prop_assert!(((p - found).norm() - (of(p) - parry).length()).abs() < 1e-9);
        }

        #[test]
        fn segments_are_as_far_apart_as_parry_says(e in proptest::array::uniform4(point())) {
            let (s, t) = closest_on_segments([e[0], e[1]], [e[2], e[3]]);
            let gap = (e[0] * s[0] + e[1] * s[1] - e[2] * t[0] - e[3] * t[1]).norm();
            let (first, second) = (Segment::new(of(e[0]), of(e[1])), Segment::new(of(e[2]), of(e[3])));
            let here = parry3d_f64::math::Pose::default();
            if let ClosestPoints::WithinMargin(a, b) =
                query::closest_points(&here, &first, &here, &second, 100.0).unwrap()
            {
                prop_assert!((gap - (a - b).length()).abs() < 1e-6, "{gap} against {}", (a - b).length());
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
