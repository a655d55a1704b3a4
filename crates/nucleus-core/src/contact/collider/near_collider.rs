//! A collider that free points can touch: which of its faces their motion in a time step reaches.

use nalgebra::Vector3;

use crate::contact::bvh::Aabb;
use crate::contact::collider::ColliderState;
use crate::contact::collider::motion_bounds::MotionBox;
use crate::contact::depenetration::{Depenetration, exit_face, push_outward};
use crate::contact::time_step::{ColliderStep, ColliderStepArgs};
use crate::math::{Real, add};
use crate::model::ColliderModel;

/// Margin of a search around the motion of a point, as a share of the interaction range: contacts push by about as much.
pub const MARGIN: f64 = 0.125;

/// A collider that the points of a pass can touch.
pub struct NearCollider<'a, R> {
    /// The parameters of its steps.
    pub args: ColliderStepArgs<'a, R>,
    model: &'a ColliderModel,
    state: &'a ColliderState,
    /// The points that were inside it at the end of the last time step.
    inside: &'a Depenetration,
    /// Whether its boxes are fitted to the time step; without them every face is tested.
    is_fitted: bool,
}

impl<'a, R: Real> NearCollider<'a, R> {
    /// A collider with its motion in this frame, and the points that were inside it; `is_fitted` if its boxes are fitted to
    /// the time step.
    pub fn new(
        args: ColliderStepArgs<'a, R>,
        model: &'a ColliderModel,
        state: &'a ColliderState,
        inside: &'a Depenetration,
        is_fitted: bool,
    ) -> Self {
        Self { args, model, state, inside, is_fitted }
    }

    /// The collider's positions in this frame.
    pub fn state(&self) -> &'a ColliderState {
        self.state
    }

    /// Whether its boxes are fitted to the time step.
    pub fn is_fitted(&self) -> bool {
        self.is_fitted
    }

    /// Whether points inside it are pushed out.
    pub fn depenetrates(&self) -> bool {
        self.args.material.depenetrates && self.model.pseudonormals.is_some() && self.is_fitted
    }

    /// Whether a point was inside at the end of the last time step, or may have been from the start on.
    pub fn was_inside(&self, point: u32) -> bool {
        !self.inside.has_begun() || self.inside.contains(point)
    }

    /// The face through which a point leaves it that is inside at this place; `None` outside.
    pub fn exit_face(&self, point: u32, place: Vector3<f64>, time: f64) -> Option<u32> {
        exit_face(place, self.inside.exit_of(point), self.model, self.state, time)
    }

    /// Moves a point inside at least a step farther out of its exit face.
    pub fn push_outward(&self, point: u32, face: u32, step: &ColliderStep<'_, R>) {
        push_outward(point, face, self.model, step, |_| f64::INFINITY);
    }

    /// The corners of a face.
    pub fn corners(&self, face: u32) -> [u32; 3] {
        self.model.boundary.triangles[face as usize]
    }

    /// The box in world space outside of which nothing touches it in the time step.
    pub fn reach(&self) -> [Vector3<f64>; 2] {
        let [from, to] = self.args.time.ends().map(|time| self.state.bounds(time));
        let range = self.args.material.thickness * self.args.material.adhesion_range;
        let margin = range * (1.0 + 2.0 * MARGIN);
        [from[0].inf(&to[0]).add_scalar(-margin), from[1].sup(&to[1]).add_scalar(margin)]
    }

    /// Whether anything in a box in world space can touch it in the time step.
    pub fn reaches(&self, [low, high]: [[f64; 3]; 2]) -> bool {
        let reach = self.reach();
        (0..3).all(|axis| low[axis] <= reach[1][axis] && reach[0][axis] <= high[axis])
    }

    /// Calls `found` with the faces that a box may touch, given in world space relative to an anchor.
    pub fn for_faces(&self, anchor: [f64; 3], bound: &MotionBox<R>, range: f32, mut found: impl FnMut(u32)) {
        if !self.is_fitted {
            return (0..self.model.boundary.triangles.len() as u32).for_each(found);
        }
        let around = self.box_around(anchor, bound, range);
        let boxes = &self.state.boxes.triangles;
        self.state.bvh.query(&around, |face| {
            if boxes[face as usize].overlaps(&around) {
                found(face);
            }
        });
    }

    /// Calls `found` with the place of each box and the faces that it may touch; the boxes are those of
    /// [`box_around`](Self::box_around). Needs fitted boxes. The faces of a box come in the order of
    /// [`for_faces`](Self::for_faces).
    pub fn for_faces_of_all(&self, targets: &[Aabb], lists: &mut Vec<u32>, mut found: impl FnMut(u32, u32)) {
        let boxes = &self.state.boxes.triangles;
        self.state.bvh.query_all(targets, lists, |target, face| {
            if boxes[face as usize].overlaps(&targets[target as usize]) {
                found(target, face);
            }
        });
    }

    /// Whether a path comes within `reach` of the box of a face, in the frame of the fitted boxes (separating axes across the
    /// path: Ericson 2005, §5.3.3). Without fitted boxes every face is one.
    #[inline]
    pub fn comes_near(&self, path: &[Vector3<f64>; 2], face: u32, reach: f64) -> bool {
        if !self.is_fitted {
            return true;
        }
        let [low, high] = self.state.boxes.triangles[face as usize].corners();
        let (mut apart, mut half, mut along) = ([0.0; 3], [0.0; 3], [0.0; 3]);
        for axis in 0..3 {
            let [low, high] = [low, high].map(|corner| f64::from(corner[axis]));
            apart[axis] = path[0][axis] + path[1][axis] - low - high;
            half[axis] = high - low + 2.0 * reach;
            along[axis] = path[1][axis] - path[0][axis];
        }
        [(0, 1), (1, 2), (2, 0)].into_iter().all(|(a, b)| {
            let across = apart[a] * along[b] - apart[b] * along[a];
            across.abs() <= half[a] * along[b].abs() + half[b] * along[a].abs()
        })
    }

    /// A path in this step in the frame of the fitted boxes.
    pub fn path_among_boxes(&self, ends: [Vector3<f64>; 2]) -> [Vector3<f64>; 2] {
        let [from, to] = self.args.time.ends().map(|time| self.state.origin(time));
        [ends[0] - from, ends[1] - to]
    }

    /// A box in world space relative to an anchor, inflated by a range, in the frame of the fitted boxes in the time step.
    pub fn box_around(&self, anchor: [f64; 3], bound: &MotionBox<R>, range: f32) -> Aabb {
        let [low, high] = place_box(anchor, bound).map(Vector3::from);
        let at = |time: f64| {
            let origin = self.state.origin(time);
            Aabb::new(low - origin, high - origin)
        };
        let [from, to] = self.args.time.ends();
        let around = if self.state.moves { at(from).union(at(to)) } else { at(from) };
        around.inflate(range * (1.0 + 1e-6))
    }
}

/// A box relative to an anchor, in world space.
pub fn place_box<R: Real>(anchor: [f64; 3], bound: &MotionBox<R>) -> [[f64; 3]; 2] {
    bound.map(|corner| add(anchor, corner.xyz().map(R::to_f64)))
}
