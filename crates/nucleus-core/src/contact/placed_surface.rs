//! Triangulated surfaces at their present position: nearest point and ray intersection.
//!
//! Moving a surface refits its hierarchy. No answer depends on the hierarchy, so [`ObjectSurfaces`] are scratch memory: a
//! restored solver builds them anew and continues with the same bits.

use std::cell::Cell;

use nalgebra::Vector3;

use crate::contact::bvh::{Aabb, Bvh, RayBundle};
use crate::contact::narrow_phase::closest_on_triangle;
use crate::parallel::disjoint::DisjointSlice;
use crate::parallel::thread_pool::ThreadPool;

type Point = Vector3<f64>;

/// Triangles and a hierarchy of their boxes.
pub struct PlacedSurface {
    corners: Vec<[u32; 3]>,
    /// In metres.
    triangles: Vec<[Point; 3]>,
    bvh: Bvh,
    /// The origin of the boxes.
    origin: Point,
    /// Normals of the corners, not of unit length; empty until [`set_normals`](Self::set_normals).
    normals: Vec<Point>,
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

/// Rays of a bundle, at most.
pub const RAYS: usize = 8;

/// Triangles per task.
const TRIANGLES_PER_TASK: usize = 2048;

/// Relative margin for rounding in comparisons that exclude triangles before they are tested.
const ROUNDING: f64 = 1e-9;

impl PlacedSurface {
    /// A surface of these triangles; `place` gives the position of a corner in metres.
    pub fn new(corners: Vec<[u32; 3]>, place: impl Fn(u32) -> Point) -> Self {
        let triangles: Vec<[Point; 3]> = corners.iter().map(|triangle| triangle.map(&place)).collect();
        let centres: Vec<Point> = triangles.iter().map(|[a, b, c]| (a + b + c) / 3.0).collect();
        let origin = centres.first().copied().unwrap_or_default();
        let mut bvh = Bvh::new(&centres);
        bvh.refit(|at| bounds(&triangles[at], origin));
        Self { corners, triangles, bvh, origin, normals: Vec::new() }
    }

    /// Moves the corners; `place` gives their positions in metres.
    fn move_to(&mut self, place: impl Fn(u32) -> Point + Sync, pool: &ThreadPool) {
        let Self { corners, triangles, bvh, origin, .. } = self;
        let shared = DisjointSlice::new(triangles);
        pool.parallel_for(corners.len().div_ceil(TRIANGLES_PER_TASK), |task| {
            let first = task * TRIANGLES_PER_TASK;
            let end = corners.len().min(first + TRIANGLES_PER_TASK);
            // SAFETY: tasks share no triangle.
            #[allow(unsafe_code)]
            let own = unsafe { shared.run(first as u32..end as u32) };
            own.iter_mut().zip(&corners[first..end]).for_each(|(triangle, at)| *triangle = at.map(&place));
        });
        *origin = triangles.first().map_or_else(Point::zeros, |[a, ..]| *a);
        bvh.refit_in_tasks(|at| bounds(&triangles[at], *origin), pool);
    }

    /// Computes the normals of the corners at their present positions: those of their triangles, weighted by angles (Thürmer
    /// and Wüthrich 1998).
    pub fn set_normals(&mut self) {
        let Self { corners, triangles, normals, .. } = self;
        let count = corners.iter().flatten().max().map_or(0, |last| *last as usize + 1);
        normals.clear();
        normals.resize(count, Point::zeros());
        for (corners, places) in corners.iter().zip(triangles) {
            let [a, b, c] = *places;
            let Some(normal) = (b - a).cross(&(c - a)).try_normalize(0.0) else { continue };
            for k in 0..3 {
                let [here, next, last] = [places[k], places[(k + 1) % 3], places[(k + 2) % 3]];
                normals[corners[k] as usize] += normal * (next - here).angle(&(last - here));
            }
        }
    }

    /// The normal at a nearest point, of unit length: that of the corners, if they have been [set](Self::set_normals), else that
    /// of the triangle.
    pub fn normal_at(&self, nearest: &Nearest) -> Point {
        if self.normals.is_empty() {
            return nearest.normal;
        }
        let normal = |corner: u32| self.normals[corner as usize].try_normalize(0.0).unwrap_or(nearest.normal);
        nearest.mean(normal).try_normalize(0.0).unwrap_or(nearest.normal)
    }

    /// The nearest point within a radius in metres; of two as near, that of the first triangle.
    pub fn nearest(&self, place: Point, radius: f64) -> Option<Nearest> {
        let away = place - self.origin;
        let mut best: Option<(f64, u32, Point, [f64; 3])> = None;
        let squared = |distance: f64| distance * distance * (1.0 + ROUNDING);
        let limit = Cell::new(squared(radius));
        self.bvh.descend_by(
            |bounds| bounds.squared_distance(away),
            &limit,
            |at| {
                let corners = self.triangles[at as usize];
                let weights = closest_on_triangle(place.into(), corners.map(Into::into));
                let point: Point = corners.iter().zip(weights).map(|(corner, weight)| corner * weight).sum();
                let found = ((place - point).norm(), at);
                if best.is_none_or(|(distance, other, ..)| found < (distance, other)) {
                    best = Some((found.0, found.1, point, weights));
                    limit.set(limit.get().min(squared(found.0)));
                }
            },
        );
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

    /// How far parallel rays get, as a share of their length, before they meet a triangle; 1 where they meet none. At most
    /// [`RAYS`] places are read. Triangles with the corner `own` do not count for the first ray, those with the next corner
    /// for the second, and so on.
    pub fn first_hits(&self, from: &[Point], ray: Point, own: Option<u32>) -> [f64; RAYS] {
        let mut reached = [1.0; RAYS];
        let from = &from[..from.len().min(RAYS)];
        let Some(last) = from.last() else { return reached };
        // One axis after the other, so that rays are tested side by side.
        let place = |k: usize| *from.get(k).unwrap_or(last);
        let [x, y, z]: [[f64; RAYS]; 3] = std::array::from_fn(|axis| std::array::from_fn(|k| place(k)[axis]));
        let (low, high) = from.iter().fold((*last, *last), |(low, high), p| (low.inf(p), high.sup(p)));
        let bundle = RayBundle::new([low, high].map(|corner| corner - self.origin), ray);
        let farthest = Cell::new(1.0);
        self.bvh.descend_by(
            |bounds| bundle.entry(bounds),
            &farthest,
            |at| {
                let triangle = self.triangles[at as usize];
                let [a, b, c] = triangle;
                let [ab, ac] = [b - a, c - a];
                let across = ray.cross(&ac);
                let volume = ab.dot(&across);
                if volume == 0.0 {
                    return;
                }
                // The test of `meets` without its divisions, for all rays at once.
                let (sign, size) = (volume.signum(), volume.abs() * (1.0 + ROUNDING));
                let mut may_meet = [false; RAYS];
                for k in 0..RAYS {
                    let away = Point::new(x[k] - a.x, y[k] - a.y, z[k] - a.z);
                    let u = away.dot(&across) * sign;
                    let around = away.cross(&ab);
                    let v = ray.dot(&around) * sign;
                    let share = ac.dot(&around) * sign;
                    let is_inside = (u >= 0.0) & (v >= 0.0) & (u + v <= size);
                    may_meet[k] = is_inside & (share > 0.0) & (share <= reached[k] * size);
                }
                if may_meet == [false; RAYS] {
                    return;
                }
                for k in (0..from.len()).filter(|&k| may_meet[k]) {
                    let is_own = own.is_some_and(|own| self.corners[at as usize].contains(&(own + k as u32)));
                    if let Some(share) = meets(from[k], ray, triangle).filter(|_| !is_own) {
                        reached[k] = share.min(reached[k]);
                    }
                }
                farthest.set(reached[..from.len()].iter().copied().fold(0.0, f64::max));
            },
        );
        reached
    }
}

fn bounds(triangle: &[Point; 3], origin: Point) -> Aabb {
    let [a, b, c] = triangle.map(|corner| corner - origin);
    Aabb::new(a.inf(&b).inf(&c), a.sup(&b).sup(&c))
}

/// The surfaces of objects that act on others at a distance, by kind and index. They are kept from substep to substep, so
/// that a substep only moves them.
#[derive(Default)]
pub struct ObjectSurfaces {
    colliders: Vec<Option<PlacedSurface>>,
    cloths: Vec<Option<PlacedSurface>>,
}

/// An object, by its index.
#[derive(Debug, Clone, Copy)]
pub enum ObjectAt {
    /// A collider.
    Collider(usize),
    /// A cloth.
    Cloth(usize),
}

impl ObjectSurfaces {
    /// Moves the surface of an object; the first time, `corners` makes its triangles.
    pub fn place(
        &mut self,
        at: ObjectAt,
        corners: impl FnOnce() -> Vec<[u32; 3]>,
        place: impl Fn(u32) -> Point + Sync,
        pool: &ThreadPool,
    ) {
        match self.entry(at) {
            Some(surface) => surface.move_to(place, pool),
            empty => *empty = Some(PlacedSurface::new(corners(), place)),
        }
    }

    /// Builds the surface of an object whose triangles change.
    pub fn replace(&mut self, at: ObjectAt, surface: PlacedSurface) {
        *self.entry(at) = Some(surface);
    }

    /// The surface of an object, once it is placed.
    pub fn get(&self, at: ObjectAt) -> Option<&PlacedSurface> {
        let (own, at) = match at {
            ObjectAt::Collider(at) => (&self.colliders, at),
            ObjectAt::Cloth(at) => (&self.cloths, at),
        };
        own.get(at).and_then(Option::as_ref)
    }

    /// The same, to change it.
    pub fn get_mut(&mut self, at: ObjectAt) -> Option<&mut PlacedSurface> {
        self.entry(at).as_mut()
    }

    fn entry(&mut self, at: ObjectAt) -> &mut Option<PlacedSurface> {
        let (own, at) = match at {
            ObjectAt::Collider(at) => (&mut self.colliders, at),
            ObjectAt::Cloth(at) => (&mut self.cloths, at),
        };
        if own.len() <= at {
            own.resize_with(at + 1, || None);
        }
        &mut own[at]
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
        let hit = |[x, y]: [f64; 2], ray: f64, own| {
            let from = [Point::new(x, y, -1.0), Point::new(0.8, 0.8, -1.0), Point::new(x, y, -1.0)];
            let [first, beside, same, ..] = surface.first_hits(&from, Point::new(0.0, 0.0, ray), own);
            assert_eq!(beside, 1.0);
            if own.is_none() {
                assert_eq!(first, same);
            }
            first
        };
        assert_eq!(hit([0.2; 2], 4.0, None), 0.25);
        assert_eq!(hit([0.2; 2], 4.0, Some(1)), 0.5);
        assert_eq!(hit([0.2; 2], 0.5, None), 1.0);
        assert_eq!(hit([0.2; 2], -4.0, None), 1.0);
    }

    /// A wavy sheet of 2 (n - 1)² triangles.
    fn waves(n: u32, height: f64) -> (Vec<[u32; 3]>, impl Fn(u32) -> Point + Sync) {
        let place = move |k: u32| {
            let [x, z] = [k % n, k / n].map(|k| f64::from(k) / f64::from(n - 1));
            Point::new(x, height * (9.0 * x).sin() * (7.0 * z).cos(), z)
        };
        let cell = move |k: u32| {
            let a = k / (n - 1) * n + k % (n - 1);
            [[a, a + 1, a + n + 1], [a, a + n + 1, a + n]]
        };
        ((0..(n - 1) * (n - 1)).flat_map(cell).collect(), place)
    }

    #[test]
    fn bundles_of_rays_and_nearest_points_are_those_of_all_triangles() {
        let (corners, place) = waves(23, 0.2);
        let surface = PlacedSurface::new(corners.clone(), &place);
        let triangles: Vec<_> = corners.iter().map(|triangle| triangle.map(&place)).collect();
        let points: Vec<Point> = (0..23 * 23).map(&place).collect();
        for ray in [Point::new(0.5, 0.2, 0.1), Point::new(0.0, 1.0, 0.0), Point::new(-0.4, 0.0, 0.3)] {
            for (first, bundle) in (0..).step_by(RAYS).zip(points.chunks(RAYS)) {
                let reached = surface.first_hits(bundle, ray, Some(first));
                for (k, from) in (first..).zip(bundle) {
                    let others = triangles.iter().zip(&corners).filter(|(_, corners)| !corners.contains(&k));
                    let hits = others.filter_map(|(triangle, _)| meets(*from, ray, *triangle));
                    assert_eq!(reached[(k - first) as usize], hits.fold(1.0, f64::min));
                }
            }
        }
        for place in points.iter().map(|point| point + Point::new(0.03, 0.1, 0.02)) {
            let distance = |triangle: &[Point; 3]| {
                let weights = closest_on_triangle(place.into(), triangle.map(Into::into));
                let point: Point = triangle.iter().zip(weights).map(|(corner, weight)| corner * weight).sum();
                (place - point).norm()
            };
            let least = triangles.iter().map(distance).fold(f64::INFINITY, f64::min);
            let found = surface.nearest(place, 0.08).map(|nearest| nearest.distance);
            assert_eq!(found, (least <= 0.08).then_some(least));
        }
    }

    #[test]
    fn a_surface_that_was_moved_answers_as_one_that_is_new() {
        let (corners, place) = waves(23, 0.2);
        let (_, elsewhere) = waves(23, -0.3);
        let (at, pool) = (ObjectAt::Cloth(1), ThreadPool::new(2));
        let mut moved = ObjectSurfaces::default();
        moved.place(at, || corners.clone(), &place, &pool);
        moved.place(at, || corners.clone(), |k| elsewhere(k) + Point::new(3.0, 0.0, 0.0), &pool);
        let moved = moved.get(at).expect("a surface");
        let new = PlacedSurface::new(corners, |k| elsewhere(k) + Point::new(3.0, 0.0, 0.0));
        for k in 0..23 * 23 {
            let place = elsewhere(k) + Point::new(3.01, 0.05, 0.02);
            let [one, other] = [moved, &new].map(|surface| surface.nearest(place, 0.5));
            let facts = |nearest: Nearest| (nearest.distance, nearest.corners, nearest.weights);
            assert_eq!(one.map(facts), other.map(facts));
            let ray = Point::new(0.3, 0.4, -0.2);
            assert_eq!(moved.first_hits(&[place], ray, None), new.first_hits(&[place], ray, None));
        }
    }
}
