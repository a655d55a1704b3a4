//! Likeness of two shapes whose points cannot be compared one by one.
//!
//! After the motion of cloth has become chaotic, a fold lies a little further along in one run than in another. The
//! distance of corresponding points then measures chaos; the distance of the surfaces and their outlines still
//! measure the shape.

use nalgebra::Vector3;
use nucleus_core::Faces;
use serde::{Deserialize, Serialize};

use super::root_mean_square;

/// Difference of a shape from another.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Outline {
    /// Distance of the surfaces, RMS, over the cloth's size.
    pub distance: f64,
    /// Area that only one of the two covers over the area that either covers, along the three axes together.
    pub silhouette: f64,
}

/// Points of a shape that are measured; the rest are skipped evenly.
const MAX_QUERIES: usize = 2048;

/// Cells along each side of an outline.
const CELLS: usize = 256;

/// Distance of two surfaces with the same triangles, RMS over points, in the unit of the positions: from each point of
/// one to the nearest place of the other, and the other way round. Sliding along itself does not count.
///
/// The nearest place is taken from the triangles around the nearest vertex.
pub fn surface_distance(a: &[Vector3<f64>], b: &[Vector3<f64>], triangles: &[[u32; 3]]) -> f64 {
    let around = triangles_around(a.len(), triangles);
    let of = |from: &[Vector3<f64>], to: &[Vector3<f64>]| {
        let step = from.len().div_ceil(MAX_QUERIES).max(1);
        root_mean_square(from.iter().step_by(step).map(|point| distance_to(*point, to, triangles, &around)))
    };
    let (there, back) = (of(a, b), of(b, a));
    root_mean_square([there, back])
}

/// The triangles at each vertex.
fn triangles_around(points: usize, triangles: &[[u32; 3]]) -> Vec<Vec<u32>> {
    let mut around = vec![Vec::new(); points];
    for (index, corners) in triangles.iter().enumerate() {
        corners.iter().for_each(|corner| around[*corner as usize].push(index as u32));
    }
    around
}

/// Distance of a point from the triangles around the nearest vertex; NaN if any position is.
fn distance_to(point: Vector3<f64>, to: &[Vector3<f64>], triangles: &[[u32; 3]], around: &[Vec<u32>]) -> f64 {
    let (mut nearest, mut least) = (0, f64::INFINITY);
    for (index, vertex) in to.iter().enumerate() {
        let square = (vertex - point).norm_squared();
        if square.is_nan() {
            return f64::NAN;
        }
        if square < least {
            (nearest, least) = (index, square);
        }
    }
    let corners = |triangle: &u32| triangles[*triangle as usize].map(|corner| to[corner as usize]);
    let all = around[nearest].iter().map(|triangle| distance_to_triangle(point, corners(triangle)));
    all.fold(least.sqrt(), f64::min)
}

/// Distance of a point from a triangle (Ericson, Real-Time Collision Detection, §5.1.5).
fn distance_to_triangle(point: Vector3<f64>, [a, b, c]: [Vector3<f64>; 3]) -> f64 {
    let (ab, ac) = (b - a, c - a);
    let normal = ab.cross(&ac);
    let inside =
        |from: Vector3<f64>, to: Vector3<f64>| (to - from).cross(&(point - from)).dot(&normal) >= 0.0;
    if inside(a, b) && inside(b, c) && inside(c, a) && normal.norm() > 0.0 {
        return (point - a).dot(&normal).abs() / normal.norm();
    }
    [(a, b), (b, c), (c, a)]
        .map(|(from, to)| distance_to_segment(point, from, to))
        .into_iter()
        .fold(f64::INFINITY, f64::min)
}

fn distance_to_segment(point: Vector3<f64>, a: Vector3<f64>, b: Vector3<f64>) -> f64 {
    let along = b - a;
    let length = along.norm_squared();
    let share = if length > 0.0 { ((point - a).dot(&along) / length).clamp(0.0, 1.0) } else { 0.0 };
    (point - a - along * share).norm()
}

/// Difference of the outlines of two shapes as a share: the area that only one of them covers over the area that either
/// covers, seen along the three axes together. 0 is the same outline, 1 no overlap.
///
/// A sheet that an axis shows edge on has hardly any area there, so its outline along that axis counts as little.
pub fn silhouette_difference(a: &[Vector3<f64>], b: &[Vector3<f64>], triangles: &[[u32; 3]]) -> f64 {
    let all = || a.iter().chain(b);
    if all().any(|point| !point.iter().all(|x| x.is_finite())) {
        return f64::NAN;
    }
    let low = all().fold(Vector3::repeat(f64::INFINITY), |low, point| low.inf(point));
    let high = all().fold(Vector3::repeat(f64::NEG_INFINITY), |high, point| high.sup(point));
    let cell = (high - low).max() / CELLS as f64;
    if triangles.is_empty() || cell <= 0.0 {
        return 0.0;
    }
    let seen = |axis: usize| {
        let [a, b] = [a, b].map(|points| outline(points, triangles, axis, &low, cell));
        let (only, either) = a.iter().zip(&b).fold((0u32, 0u32), |(only, either), (a, b)| {
            (only + u32::from(a != b), either + u32::from(a | b))
        });
        [only, either]
    };
    let [only, either] = (0..3).map(seen).fold([0, 0], |sum, of| [sum[0] + of[0], sum[1] + of[1]]);
    f64::from(only) / f64::from(either.max(1))
}

/// The cells whose centres a shape covers, seen along an axis.
fn outline(
    points: &[Vector3<f64>],
    triangles: &[[u32; 3]],
    axis: usize,
    low: &Vector3<f64>,
    cell: f64,
) -> Vec<bool> {
    let mut covered = vec![false; CELLS * CELLS];
    let [u, v] = [(axis + 1) % 3, (axis + 2) % 3];
    let place = |point: Vector3<f64>| [(point[u] - low[u]) / cell, (point[v] - low[v]) / cell];
    for corners in triangles {
        let corners = corners.map(|corner| place(points[corner as usize]));
        fill(&mut covered, corners);
    }
    covered
}

/// Covers the cells whose centres lie in a triangle, given in cells.
fn fill(covered: &mut [bool], corners: [[f64; 2]; 3]) {
    let cross =
        |a: [f64; 2], b: [f64; 2], p: [f64; 2]| (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]);
    let [a, b, c] = corners;
    let sign = if cross(a, b, c) < 0.0 { -1.0 } else { 1.0 };
    let range = |k: usize| {
        let values = corners.map(|corner| corner[k]);
        let low = values.into_iter().fold(f64::INFINITY, f64::min) - 0.5;
        let high = values.into_iter().fold(f64::NEG_INFINITY, f64::max) - 0.5;
        (low.ceil().max(0.0) as usize)..((high.floor() + 1.0).clamp(0.0, CELLS as f64) as usize)
    };
    for y in range(1) {
        for x in range(0) {
            let centre = [x as f64 + 0.5, y as f64 + 0.5];
            let inside = |a, b| sign * cross(a, b, centre) >= 0.0;
            covered[y * CELLS + x] |= inside(a, b) && inside(b, c) && inside(c, a);
        }
    }
}

/// The faces of a mesh as triangles around their first corners, with `first` added to every index.
pub fn triangles(faces: &Faces, first: u32) -> impl Iterator<Item = [u32; 3]> {
    faces.iter().flat_map(move |face| {
        let fan = face.windows(2).skip(1);
        fan.map(move |pair| [face[0] + first, pair[0] + first, pair[1] + first]).collect::<Vec<_>>()
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A unit square of `n` by `n` quads in the plane y = 0, as triangles.
    fn sheet(n: u32) -> (Vec<Vector3<f64>>, Vec<[u32; 3]>) {
        let row = n + 1;
        let at = |k: u32| Vector3::new(f64::from(k % row), 0.0, f64::from(k / row)) / f64::from(n);
        let quad = |k: u32| {
            let a = k / n * row + k % n;
            [[a, a + 1, a + row + 1], [a, a + row + 1, a + row]]
        };
        ((0..row * row).map(at).collect(), (0..n * n).flat_map(quad).collect())
    }

    fn moved(points: &[Vector3<f64>], by: Vector3<f64>) -> Vec<Vector3<f64>> {
        points.iter().map(|point| point + by).collect()
    }

    #[test]
    fn a_sheet_lifted_along_its_normal_is_at_the_distance_of_the_lift() {
        let (points, triangles) = sheet(8);
        let lifted = moved(&points, Vector3::y() * 0.03);
        assert!((surface_distance(&points, &lifted, &triangles) - 0.03).abs() < 1e-12);
    }

    #[test]
    fn points_that_slide_within_their_sheet_leave_the_shape_as_it_is() {
        let (points, triangles) = sheet(8);
        let slid: Vec<_> = points
            .iter()
            .map(|p| {
                let is_border = [p.x, p.z].iter().any(|x| *x == 0.0 || *x == 1.0);
                if is_border { *p } else { p + Vector3::new(0.05, 0.0, 0.04) }
            })
            .collect();
        assert!(surface_distance(&points, &slid, &triangles) < 1e-12);
        assert_eq!(silhouette_difference(&points, &slid, &triangles), 0.0);
    }

    #[test]
    fn the_silhouette_of_a_square_shifted_by_a_tenth_differs_by_two_elevenths() {
        let (points, triangles) = sheet(4);
        let shifted = moved(&points, Vector3::x() * 0.1);
        let found = silhouette_difference(&points, &shifted, &triangles);
        assert!((found - 0.2 / 1.1).abs() < 0.01, "{found}");
    }

    #[test]
    fn an_outline_seen_edge_on_counts_by_its_area() {
        let (flat, triangles) = sheet(4);
        // A wave of 1 cm doubles and more what the sides see of the sheet, and leaves what is seen from above.
        let wave = |p: &Vector3<f64>| Vector3::new(p.x, 0.01 * (9.0 * p.x).sin() * (7.0 * p.z).cos(), p.z);
        let waved: Vec<_> = flat.iter().map(wave).collect();
        let found = silhouette_difference(&flat, &waved, &triangles);
        assert!(found > 0.001 && found < 0.05, "{found}");
    }

    #[test]
    fn shapes_without_overlap_differ_entirely_and_a_nan_makes_the_difference_nan() {
        let (points, triangles) = sheet(2);
        let away = moved(&points, Vector3::x() * 3.0);
        assert_eq!(silhouette_difference(&points, &away, &triangles), 1.0);
        let lost = moved(&points, Vector3::repeat(f64::NAN));
        assert!(silhouette_difference(&points, &lost, &triangles).is_nan());
        assert!(surface_distance(&points, &lost, &triangles).is_nan());
    }

    #[test]
    fn the_distance_to_a_triangle_is_that_to_its_nearest_face_edge_or_corner() {
        let triangle = [Vector3::zeros(), Vector3::x(), Vector3::z()];
        let of = |x, y, z| distance_to_triangle(Vector3::new(x, y, z), triangle);
        assert!((of(0.25, 2.0, 0.25) - 2.0).abs() < 1e-12, "face");
        assert!((of(0.5, 0.0, -1.0) - 1.0).abs() < 1e-12, "edge");
        assert!((of(-3.0, 0.0, -4.0) - 5.0).abs() < 1e-12, "corner");
    }
}
