//! A triangulated surface at its present position: nearest point and ray intersection.

use std::cell::Cell;

use nalgebra::Vector3;

use crate::contact::bvh::{Aabb, Bvh};
use crate::contact::narrow_phase::closest_on_triangle;

type Point = Vector3<f64>;

/// Triangles and a hierarchy of their boxes.
pub struct PlacedSurface {
    corners: Vec<[u32; 3]>,
    /// In metres.
    triangles: Vec<[Point; 3]>,
    bvh: Bvh,
    /// The origin of the boxes.
    origin: Point,
}

/// The nearest point of a surface.
#[derive(Debug, Clone, Copy)]
pub struct Nearest {
    /// In metres.
    pub distance: f64,
    /// The point, in metres.
    pub point: Point,
    /// Normal of its triangle, of unit length.
    pub normal: Point,
    corners: [u32; 3],
    weights: [f64; 3],
}

impl Nearest {
    /// The value of a column at the point, from its values at the corners.
    pub fn mean<T>(&self, value: impl Fn(u32) -> T) -> T
    where
        T: std::ops::Mul<f64, Output = T> + std::ops::Add<Output = T>,
    {
        let [a, b, c] = self.corners;
        let [wa, wb, wc] = self.weights;
        value(a) * wa + value(b) * wb + value(c) * wc
    }
}

impl PlacedSurface {
    /// A surface of these triangles; `place` gives the position of a corner in metres.
    pub fn new(corners: Vec<[u32; 3]>, place: impl Fn(u32) -> Point) -> Self {
        let triangles: Vec<[Point; 3]> = corners.iter().map(|triangle| triangle.map(&place)).collect();
        let centres: Vec<Point> = triangles.iter().map(|[a, b, c]| (a + b + c) / 3.0).collect();
        let origin = centres.first().copied().unwrap_or_default();
        let mut bvh = Bvh::new(&centres);
        bvh.refit(|at| Aabb::of(triangles[at].into_iter().map(|corner| corner - origin)));
        Self { corners, triangles, bvh, origin }
    }

    /// The nearest point within a radius in metres; of two as near, that of the first triangle.
    pub fn nearest(&self, place: Point, radius: f64) -> Option<Nearest> {
        let away = place - self.origin;
        let half = Point::repeat(radius);
        let mut best: Option<(f64, u32, Point, [f64; 3])> = None;
        self.bvh.query(&Aabb::new(away - half, away + half), |at| {
            let corners = self.triangles[at as usize];
            let weights = closest_on_triangle(place.into(), corners.map(Into::into));
            let point: Point = corners.iter().zip(weights).map(|(corner, weight)| corner * weight).sum();
            let found = ((place - point).norm(), at);
            if best.is_none_or(|(distance, other, ..)| found < (distance, other)) {
                best = Some((found.0, found.1, point, weights));
            }
        });
        let (distance, at, point, weights) = best.filter(|&(distance, ..)| distance <= radius)?;
        let [a, b, c] = self.triangles[at as usize];
        let normal = (b - a).cross(&(c - a)).try_normalize(0.0)?;
        Some(Nearest { distance, point, normal, corners: self.corners[at as usize], weights })
    }

    /// Calls `found` with each triangle that may overlap a box: its place, and its corners in metres.
    pub fn for_faces(&self, [low, high]: [Point; 2], mut found: impl FnMut(usize, [Point; 3])) {
        let around = Aabb::new(low - self.origin, high - self.origin);
        self.bvh.query(&around, |at| found(at as usize, self.triangles[at as usize]));
    }

    /// How far a ray gets, as a share of its length, before it meets a triangle; triangles with the corner `own` do not
    /// count.
    pub fn first_hit(&self, from: Point, ray: Point, own: Option<u32>) -> Option<f64> {
        let start = from - self.origin;
        let first = Cell::new(None);
        let reaches = |bounds: &Aabb| bounds.meets_ray(start, ray, first.get().unwrap_or(1.0));
        self.bvh.descend(reaches, |at| {
            let at = at as usize;
            if own.is_some_and(|own| self.corners[at].contains(&own)) {
                return;
            }
            let share = meets(from, ray, self.triangles[at]);
            if let Some(share) = share.filter(|share| first.get().is_none_or(|first| *share < first)) {
                first.set(Some(share));
            }
        });
        first.get()
    }
}

/// Where a ray meets a triangle, as a share of its length (Möller and Trumbore 1997).
pub fn meets(from: Point, ray: Point, [a, b, c]: [Point; 3]) -> Option<f64> {
    let [ab, ac] = [b - a, c - a];
    let across = ray.cross(&ac);
    let volume = ab.dot(&across);
    if volume == 0.0 {
        return None;
    }
    let away = from - a;
    let u = away.dot(&across) / volume;
    let around = away.cross(&ab);
    let v = ray.dot(&around) / volume;
    let share = ac.dot(&around) / volume;
    let is_inside = u >= 0.0 && v >= 0.0 && u + v <= 1.0;
    (is_inside && share > 0.0 && share <= 1.0).then_some(share)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ray_stops_at_the_first_triangle_that_is_not_its_own() {
        let corners = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]];
        let place = |corner: u32| {
            let [x, y] = corners[corner as usize % 3];
            Point::new(x, y, f64::from(corner / 3))
        };
        let surface = PlacedSurface::new(vec![[0, 1, 2], [3, 4, 5]], place);
        let from = Point::new(0.2, 0.2, -1.0);
        let hit = |ray: f64, own| surface.first_hit(from, Point::new(0.0, 0.0, ray), own);
        assert_eq!(hit(4.0, None), Some(0.25));
        assert_eq!(hit(4.0, Some(1)), Some(0.5));
        assert_eq!(hit(0.5, None), None);
        assert_eq!(hit(-4.0, None), None);
        assert_eq!(surface.first_hit(Point::new(0.8, 0.8, -1.0), Point::new(0.0, 0.0, 4.0), None), None);
    }
}
