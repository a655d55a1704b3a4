//! Push-out: points of other objects that are near a surface, and not yet clear of it, go to the side that it says.
//!
//! It asks only where points are, not where they came from: for scenes that start with one object in another. What it
//! moves passes through surfaces; contact begins anew from where that ends (Maya's `pushOut` and `pushOutRadius`).

use nalgebra::Vector3;

use crate::contact::aabb::Aabb;
use crate::contact::narrow::closest_on_triangle;
use crate::contact::tree::Tree;
use crate::input::frame::{FrameInput, PushOut};
use crate::math::Real;
use crate::solver::Solver;

type Point = Vector3<f64>;

/// A surface that pushes out, as it is now.
struct Pusher {
    /// Its triangles in metres, wound so that they face the side that points are pushed to.
    triangles: Vec<[Point; 3]>,
    tree: Tree,
    /// What the boxes of the tree are relative to.
    origin: Point,
    /// Its own thickness in metres.
    thickness: f64,
    /// Share of the way.
    share: f64,
    radius: f64,
}

impl<R: Real> Solver<R> {
    /// Pushes points out of everything that does so, at the start of a substep that begins at a share of the frame.
    pub(crate) fn push_out(&mut self, frame: &FrameInput, time: f64) {
        let pushes = |push_out: &PushOut| push_out.share != 0.0 && push_out.radius > 0.0;
        for at in (0..self.model.colliders.len()).filter(|&at| pushes(&frame.colliders[at].push_out)) {
            let state = &self.contact.collider_states[at];
            let faces = self.model.colliders[at].skin.triangles.iter();
            let triangles = faces.map(|face| face.map(|point| state.point(point, time))).collect();
            let pusher = Pusher::new(triangles, frame.colliders[at].push_out, frame.colliders[at].thickness);
            (0..self.model.cloths.len()).for_each(|cloth| self.push_out_of(&pusher, frame, cloth));
        }
        for at in (0..self.model.cloths.len()).filter(|&at| pushes(&frame.cloths[at].push_out)) {
            let place = |row: u32| Point::from(self.state.position(row));
            let triangles = self.model.cloths[at].skin.triangles.iter().map(|face| face.map(place)).collect();
            let pusher = Pusher::new(triangles, frame.cloths[at].push_out, frame.cloths[at].thickness);
            let others = (0..self.model.cloths.len()).filter(|&cloth| cloth != at);
            others.for_each(|cloth| self.push_out_of(&pusher, frame, cloth));
        }
    }

    /// Moves the free points of a cloth; what is foreseen and found for them begins anew.
    fn push_out_of(&mut self, pusher: &Pusher, frame: &FrameInput, cloth: usize) {
        let thickness = pusher.thickness + frame.cloths[cloth].thickness;
        let mut is_moved = false;
        for row in self.model.cloths[cloth].points() {
            let mut moved = self.state.displacement[row as usize];
            let way = pusher.way(Point::from(self.state.position(row)), thickness);
            let Some(way) = way.filter(|_| moved.0[3] > R::ZERO) else { continue };
            (0..3).for_each(|axis| moved.0[axis] += R::from_f64(way[axis]));
            self.state.displacement[row as usize] = moved;
            is_moved = true;
            self.invalidate_bounds(row as usize);
        }
        if is_moved {
            self.contact.windows.fill([0.0; 2]);
            if let Some(mutual) = &mut self.contact.mutual {
                mutual.span = [0.0; 2];
                mutual.tangle.is_suspected = true;
            }
        }
    }
}

impl Pusher {
    fn new(mut triangles: Vec<[Point; 3]>, push_out: PushOut, thickness: f64) -> Self {
        if push_out.share < 0.0 {
            triangles.iter_mut().for_each(|corners| corners.swap(1, 2));
        }
        let centres: Vec<Point> = triangles.iter().map(|[a, b, c]| (a + b + c) / 3.0).collect();
        let origin = centres.first().copied().unwrap_or_default();
        let mut tree = Tree::new(&centres);
        tree.refit(|at| Aabb::of(triangles[at].into_iter().map(|corner| corner - origin)));
        let share = push_out.share.abs().min(1.0);
        Self { triangles, tree, origin, thickness, share, radius: push_out.radius }
    }

    /// The way that a point goes in this substep, if it is near and not clear of the surface by `thickness`.
    fn way(&self, place: Point, thickness: f64) -> Option<Point> {
        let away = place - self.origin;
        let reach = Point::repeat(self.radius);
        let mut nearest: Option<(f64, u32, Point)> = None;
        self.tree.query(&Aabb::new(away - reach, away + reach), |at| {
            let corners = self.triangles[at as usize];
            let weights = closest_on_triangle(place.into(), corners.map(Into::into));
            let there: Point = corners.iter().zip(weights).map(|(corner, weight)| corner * weight).sum();
            let found = ((place - there).norm(), at);
            if nearest.is_none_or(|(distance, other, _)| found < (distance, other)) {
                nearest = Some((found.0, found.1, there));
            }
        });
        let (distance, at, there) = nearest.filter(|&(distance, _, _)| distance <= self.radius)?;
        let [a, b, c] = self.triangles[at as usize];
        let normal = (b - a).cross(&(c - a)).try_normalize(0.0)?;
        let is_clear = normal.dot(&(place - there)) >= 0.0 && distance >= thickness;
        (!is_clear).then(|| (there + normal * thickness - place) * self.share)
    }
}
