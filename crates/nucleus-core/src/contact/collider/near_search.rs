//! The faces of a collider that the points of a run may touch, found for all of them together.
//!
//! One descent of the hierarchy serves the run: 128 points that lie close together reach the same few leaves. Each point
//! has the faces of a query of its own, in the same order.

use std::ops::Range;

use crate::contact::bvh::Aabb;
use crate::contact::collider::motion_bounds::MotionBox;
use crate::contact::collider::near_collider::{MARGIN, NearCollider, place_box};
use crate::contact::time_step::ColliderStep;
use crate::math::{Real, Row4};

/// The points of a run that may touch a collider, and the faces near each.
#[derive(Debug)]
pub struct Search<R> {
    /// The points, with the bounds of their motion.
    points: Vec<(u32, MotionBox<R>)>,
    /// The box of each point, in the frame of the collider's boxes.
    targets: Vec<Aabb>,
    /// Scratch memory of the descent.
    lists: Vec<u32>,
    /// Pairs of a point, by its place, and a face.
    found: Vec<(u32, u32)>,
    /// Faces by point; those of the point at a place lie between its entry of `first` and the next.
    faces: Vec<u32>,
    first: Vec<u32>,
}

impl<R> Default for Search<R> {
    fn default() -> Self {
        let (points, targets, lists) = (Vec::new(), Vec::new(), Vec::new());
        Self { points, targets, lists, found: Vec::new(), faces: Vec::new(), first: Vec::new() }
    }
}

impl<R: Real> Search<R> {
    /// Lists the points of a run whose motion in this step comes near a collider, and the faces that each may touch. Without
    /// fitted boxes it lists the points alone.
    pub fn begin(&mut self, collider: &NearCollider<'_, R>, step: &ColliderStep<'_, R>, rows: Range<u32>) {
        self.points.clear();
        self.targets.clear();
        let [low, high] = collider.reach();
        for point in rows {
            let (anchor, from, to) = (step.anchors[point as usize], step.start(point), step.row(point).xyz());
            let is_outside = (0..3).any(|axis| {
                let [from, to] = [from, to].map(|x| anchor[axis] + x[axis].to_f64());
                ((from > high[axis]) & (to > high[axis])) | ((from < low[axis]) & (to < low[axis]))
            });
            if !is_outside {
                self.points.push((point, search_bound(point, step)));
            }
        }
        if collider.is_fitted() && !self.points.is_empty() {
            self.find_faces(collider, step);
        }
    }

    fn find_faces(&mut self, collider: &NearCollider<'_, R>, step: &ColliderStep<'_, R>) {
        let Self { points, targets, lists, found, faces, first } = self;
        let range = step.interaction_range().to_f64() as f32;
        targets.extend(points.iter().map(|(point, bound)| {
            let anchor = step.anchors[*point as usize];
            let is_reached = collider.reaches(place_box(anchor, bound));
            if is_reached { collider.box_around(anchor, bound, range) } else { Aabb::EMPTY }
        }));
        found.clear();
        collider.for_faces_of_all(targets, lists, |place, face| found.push((place, face)));
        // A counting sort, which keeps the order of the faces of each point.
        first.clear();
        first.resize(points.len() + 2, 0);
        found.iter().for_each(|&(place, _)| first[place as usize + 2] += 1);
        (2..first.len()).for_each(|place| first[place] += first[place - 1]);
        faces.resize(found.len(), 0);
        for &(place, face) in &*found {
            let next = &mut first[place as usize + 1];
            faces[*next as usize] = face;
            *next += 1;
        }
    }

    /// The number of points that may touch the collider.
    pub fn len(&self) -> usize {
        self.points.len()
    }

    /// The point at a place.
    pub fn point(&self, place: usize) -> u32 {
        self.points[place].0
    }

    /// The faces that the point at a place may touch, if boxes are fitted.
    pub fn faces(&self, place: usize) -> &[u32] {
        &self.faces[self.first[place] as usize..self.first[place + 1] as usize]
    }
}

/// The box around the motion of a point in this step, with the margin of a search, in metres from its anchor.
pub fn search_bound<R: Real>(point: u32, step: &ColliderStep<'_, R>) -> MotionBox<R> {
    let margin = step.interaction_range() * R::from_f64(MARGIN);
    let (from, to) = (step.start(point), step.row(point).xyz());
    let (mut low, mut high) = (Row4::ZERO, Row4::ZERO);
    for axis in 0..3 {
        let [least, most] = if from[axis] < to[axis] { [from, to] } else { [to, from] };
        (low.0[axis], high.0[axis]) = (least[axis] - margin, most[axis] + margin);
    }
    [low, high]
}
