//! Closest places of elements, and their distances.

use nalgebra::Vector3;

use super::bvh::{Bounds, Bvh};

type Point = Vector3<f64>;

/// A place on an element: up to three of its corners, by their index in it, with weights.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Foot {
    pub(super) corners: [usize; 3],
    pub(super) weights: [f64; 3],
    pub(super) place: Point,
}

impl Foot {
    fn corner(k: usize, place: Point) -> Self {
        Self { corners: [k; 3], weights: [1.0, 0.0, 0.0], place }
    }
}

/// Whether each of the places is within a distance of any polygon.
pub(in crate::compile) fn are_near(places: &[Point], polygons: &[Vec<Point>], reach: f64) -> Vec<bool> {
    let tree = Bvh::new(polygons.iter().map(|polygon| &polygon[..]));
    let is_near = |place: &Point| {
        let distance = |at: u32| (foot(&polygons[at as usize], *place).place - place).norm();
        tree.nearest(&Bounds::of(&[*place]), reach, distance).is_some()
    };
    places.iter().map(is_near).collect()
}

/// The place of an element (a point, an edge or a polygon) that is closest to a point.
pub(super) fn foot(element: &[Point], to: Point) -> Foot {
    match element {
        [only] => Foot::corner(0, *only),
        [a, b] => {
            let share = share_along(*a, *b, to);
            Foot { corners: [0, 1, 1], weights: [1.0 - share, share, 0.0], place: a + (b - a) * share }
        }
        _ => {
            let fan = (2..element.len()).map(|k| [0, k - 1, k]);
            let feet = fan.map(|corners| foot_on_triangle(corners, corners.map(|k| element[k]), to));
            let distance = |foot: &Foot| (foot.place - to).norm_squared();
            feet.reduce(|best, foot| if distance(&foot) < distance(&best) { foot } else { best })
                .unwrap_or_else(|| Foot::corner(0, element[0]))
        }
    }
}

/// The share of the way from `a` to `b` at which the segment is closest to a point.
fn share_along(a: Point, b: Point, to: Point) -> f64 {
    let along = b - a;
    let square = along.norm_squared();
    if square > 0.0 { ((to - a).dot(&along) / square).clamp(0.0, 1.0) } else { 0.0 }
}

fn foot_on_triangle(corners: [usize; 3], [a, b, c]: [Point; 3], to: Point) -> Foot {
    let weights = barycentric([a, b, c], to);
    if let Some(weights) = weights.filter(|weights| weights.iter().all(|weight| *weight >= 0.0)) {
        let place = a * weights[0] + b * weights[1] + c * weights[2];
        return Foot { corners, weights, place };
    }
    let side = |i: usize, j: usize| {
        let places = [a, b, c];
        let share = share_along(places[i], places[j], to);
        let mut weights = [0.0; 3];
        (weights[i], weights[j]) = (1.0 - share, share);
        Foot { corners, weights, place: places[i] + (places[j] - places[i]) * share }
    };
    let distance = |foot: &Foot| (foot.place - to).norm_squared();
    let nearer = |best: Foot, foot: Foot| if distance(&foot) < distance(&best) { foot } else { best };
    nearer(nearer(side(0, 1), side(1, 2)), side(2, 0))
}

/// Barycentric weights of the projection of a point to the plane of a triangle; `None` for one without area. Outside of
/// the triangle some are negative.
pub(super) fn barycentric([a, b, c]: [Point; 3], to: Point) -> Option<[f64; 3]> {
    let normal = (b - a).cross(&(c - a));
    let square = normal.norm_squared();
    if square <= 0.0 {
        return None;
    }
    let v = (to - a).cross(&(c - a)).dot(&normal) / square;
    let w = (b - a).cross(&(to - a)).dot(&normal) / square;
    Some([1.0 - v - w, v, w])
}

/// The distance of two elements: of corners to elements, and of edges to edges.
pub(super) fn distance(a: &[Point], b: &[Point]) -> f64 {
    let from = |from: &[Point], to: &[Point]| {
        from.iter().map(|&corner| (foot(to, corner).place - corner).norm()).fold(f64::INFINITY, f64::min)
    };
    let edges = |element: &[Point]| -> Vec<[Point; 2]> {
        match element.len() {
            0 | 1 => Vec::new(),
            2 => vec![[element[0], element[1]]],
            n => (0..n).map(|k| [element[k], element[(k + 1) % n]]).collect(),
        }
    };
    let crossing =
        edges(a).into_iter().flat_map(|a| edges(b).into_iter().map(move |b| between_segments(a, b)));
    crossing.fold(from(a, b).min(from(b, a)), f64::min)
}

/// The distance of two segments whose closest places are inside both; infinite for others, which [`foot`] covers.
fn between_segments([a, b]: [Point; 2], [c, d]: [Point; 2]) -> f64 {
    let (u, v, w) = (b - a, d - c, a - c);
    let (uu, uv, vv) = (u.dot(&u), u.dot(&v), v.dot(&v));
    let determinant = uu * vv - uv * uv;
    if determinant <= 1e-12 * uu * vv {
        return f64::INFINITY;
    }
    let s = (uv * v.dot(&w) - vv * u.dot(&w)) / determinant;
    let t = (uu * v.dot(&w) - uv * u.dot(&w)) / determinant;
    let inside = |x: f64| (0.0..=1.0).contains(&x);
    if inside(s) && inside(t) { (w + u * s - v * t).norm() } else { f64::INFINITY }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn triangles() -> impl Strategy<Value = Vec<[Point; 3]>> {
        let corner = || proptest::array::uniform3(-2.0..2.0f64).prop_map(Point::from);
        proptest::collection::vec([corner(), corner(), corner()], 1..30)
    }

    proptest! {
        #[test]
        fn a_foot_is_no_farther_than_any_place_of_the_element(
            all in triangles(), to in proptest::array::uniform3(-3.0..3.0f64), (u, v) in (0.0..1.0f64, 0.0..1.0f64),
        ) {
            let (to, [a, b, c]) = (Point::from(to), all[0]);
            let (u, v) = if u + v > 1.0 { (1.0 - u, 1.0 - v) } else { (u, v) };
            let other = a + (b - a) * u + (c - a) * v;
            let foot = foot(&all[0], to);
            prop_assert!((foot.place - to).norm() <= (other - to).norm() + 1e-9);
            prop_assert!((foot.weights.iter().sum::<f64>() - 1.0).abs() < 1e-9);
        }
    }
}
