//! A collider within a frame, and contact of cloth with it.
//!
//! A collider's points move along straight lines from their positions at the start of the frame to those at its end (§2.4).
//! So even a single substep includes its velocity and its change of shape.
//!
//! | You want to know... | Read |
//! |---|---|
//! | the start of a frame: materials, and which colliders each cloth can touch | [`frame_start`] |
//! | motion bounds of points | [`motion_bounds`] |
//! | broad phase: when bounds are predicted and contacts searched | [`broad_phase`] |
//! | which elements can touch, group by group; four pairs at a time | [`query`], [`candidates`] |
//! | the contacts of one cloth with one collider, and their certificates; how a search replaces them | [`contacts`], [`contact_list`] |
//! | the contacts that can touch within the next few time steps, in the order of sweeps | [`active_set`], [`selected`] |
//! | a sweep over them | [`sweep`] |
//! | the planes of the active contacts, four at a time | [`plane_columns`] |
//! | one contact: its separating plane, and its certificate | [`contact`] |
//! | certificates for the motion of a time step | [`separation`] |
//! | its push, friction, adhesion and restitution | [`response`] |
//! | free points: which faces a run of them may touch | [`near_collider`], [`near_search`] |
//! | how the motion of one stands to a face | [`near_face`] |
//! | their contacts in one time step | [`near_points`] |
//! | sweeps over these, certificates and fallbacks | [`near_response`] |
//! | fallbacks for points of a liquid or of links | [`free_points`] |
//! | starts inside the contact thickness | [`start_gaps`] |
//! | points that leave one while another is in their way | [`pinched`] |
//! | surfaces that face each other with cloth between them | [`facing`] |
//! | the motion of what it carries along | [`affine_motion`] |
//! | how what grips it turns with it | [`turning`] |
//! | the passes of a time step, over each cloth's lists of contacts | [`pass`], [`lists`] |

pub mod active_set;
pub mod affine_motion;
pub mod broad_phase;
pub mod candidates;
pub mod contact;
pub mod contact_list;
pub mod contacts;
pub mod facing;
pub mod frame_start;
pub mod free_points;
pub mod lists;
pub mod motion_bounds;
pub mod near_collider;
mod near_face;
pub mod near_points;
mod near_response;
pub mod near_search;
pub mod pass;
pub mod pinched;
mod plane_columns;
pub mod query;
mod response;
mod selected;
pub mod separation;
pub mod start_gaps;
pub mod sweep;
pub mod turning;

use nalgebra::Vector3;

use crate::bytes::checkpoint_struct;
use crate::contact::bvh::{Aabb, Bvh};
use crate::contact::collider::turning::Turning;
use crate::model::ColliderModel;
use crate::parallel::disjoint::DisjointSlice;
use crate::parallel::thread_pool::ThreadPool;
use crate::schedule::TimeInterval;

/// A collider in the current frame, and the boxes of its elements over an interval of it.
#[derive(Debug, Clone)]
pub struct ColliderState {
    /// Positions at the start of the frame in metres.
    pub start: Vec<Vector3<f64>>,
    /// Positions at the end of the frame in metres.
    pub end: Vec<Vector3<f64>>,
    /// Whether any point moves in this frame.
    pub moves: bool,
    /// The largest motion of any point in this frame, in metres.
    pub max_travel: f64,
    /// The mean motion of its points in this frame, in metres.
    pub mean_travel: Vector3<f64>,
    /// How its surface turns in this frame; `None` where it does not.
    pub turning: Option<Turning>,
    /// Low and high corner of the bounding box at the start and at the end of the frame.
    corners: [[Vector3<f64>; 2]; 2],
    /// The time that the solver has reached, as a share of the frame.
    pub now: f64,
    /// A box for each boundary triangle, edge and point.
    pub boxes: Boxes,
    /// Boxes over triangles.
    pub bvh: Bvh,
    /// The interval that the boxes cover; `None` if they are out of date.
    fitted_interval: Option<TimeInterval>,
}

checkpoint_struct!([] ColliderState {
    columns: [start, end],
    values: [now],
    parts: [],
    rebuilt: [moves, max_travel, mean_travel, turning, corners, boxes, bvh, fitted_interval],
});

/// The boxes of an object's elements.
#[derive(Debug, Clone, Default)]
pub struct Boxes {
    /// One per triangle.
    pub triangles: Vec<Aabb>,
    /// One per edge.
    pub edges: Vec<Aabb>,
    /// One per point.
    pub points: Vec<Aabb>,
}

impl ColliderState {
    /// A collider at rest.
    pub fn new(model: &ColliderModel) -> Self {
        let third = |t: &[u32; 3]| t.iter().map(|&p| model.positions[p as usize]).sum::<Vector3<f64>>() / 3.0;
        let centres: Vec<_> = model.boundary.triangles.iter().map(third).collect();
        Self { bvh: Bvh::new(&centres), ..Self::at_rest(&model.positions) }
    }

    /// Points at rest, without boxes.
    fn at_rest(positions: &[Vector3<f64>]) -> Self {
        Self {
            start: positions.to_vec(),
            end: positions.to_vec(),
            moves: false,
            max_travel: 0.0,
            mean_travel: Vector3::zeros(),
            turning: None,
            corners: [corners(positions); 2],
            now: 0.0,
            boxes: Boxes::default(),
            bvh: Bvh::new(&[]),
            fitted_interval: None,
        }
    }

    /// Takes up a frame's motion. Without positions at the start, it starts as the frame before ended; without
    /// any at the end, it is at rest. Returns whether it starts elsewhere than the frame before ended.
    pub fn begin_frame(&mut self, start: &[Vector3<f64>], end: &[Vector3<f64>]) -> bool {
        self.now = 0.0;
        let mut has_jumped = false;
        if self.moves || !start.is_empty() || !end.is_empty() {
            std::mem::swap(&mut self.start, &mut self.end);
            if !start.is_empty() {
                has_jumped = self.start != start;
                self.start.clone_from_slice(start);
            }
            let next = if end.is_empty() { &self.start } else { end };
            self.end.clone_from_slice(next);
            self.fitted_interval = None;
            self.moves = self.start != self.end;
            let travels = self.start.iter().zip(&self.end).map(|(start, end)| (end - start).norm());
            self.max_travel = travels.fold(0.0, f64::max);
            let sum: Vector3<f64> = self.start.iter().zip(&self.end).map(|(start, end)| end - start).sum();
            self.mean_travel = sum / self.start.len().max(1) as f64;
            self.corners = [corners(&self.start), corners(&self.end)];
            self.turning = if self.moves { Turning::of(self.ends()) } else { None };
        }
        has_jumped
    }

    /// Its points at the start and at the end of the frame, in metres.
    pub fn ends(&self) -> [&[Vector3<f64>]; 2] {
        [&self.start, &self.end]
    }

    /// Low and high corner of its bounding box at a time of the frame, in metres.
    pub fn bounds(&self, time: f64) -> [Vector3<f64>; 2] {
        let [start, end] = self.corners;
        [0, 1].map(|corner| start[corner] + (end[corner] - start[corner]) * time)
    }

    /// Low and high corner of the box that it sweeps over the whole frame, in metres.
    pub fn swept_bounds(&self) -> [Vector3<f64>; 2] {
        let [start, end] = self.corners;
        [start[0].inf(&end[0]), start[1].sup(&end[1])]
    }

    /// Origin of the boxes at a time of the frame, in metres.
    pub fn origin(&self, time: f64) -> Vector3<f64> {
        self.start.first().copied().unwrap_or_default() + self.mean_travel * time
    }

    /// Position of a point at a time of the frame, in metres.
    pub fn point(&self, point: u32, time: f64) -> Vector3<f64> {
        let [start, end] = [self.start[point as usize], self.end[point as usize]];
        start + (end - start) * time
    }

    /// Fits the boxes to an interval of the frame, relative to [`origin`](Self::origin). Those of a collider at
    /// rest stay valid.
    pub fn fit_boxes(&mut self, model: &ColliderModel, interval: TimeInterval, pool: &ThreadPool) {
        if self.fitted_interval == Some(interval) || (self.fitted_interval.is_some() && !self.moves) {
            return;
        }
        let mut boxes = std::mem::take(&mut self.boxes);
        let bound = |points: &[u32]| {
            let path = points
                .iter()
                .flat_map(|&point| interval.ends().map(|time| self.point(point, time) - self.origin(time)));
            Aabb::of(path)
        };
        let boundary = &model.boundary;
        refill(&mut boxes.triangles, &boundary.triangles, |triangle| bound(triangle), pool);
        refill(&mut boxes.edges, &boundary.edges, |edge| bound(edge), pool);
        refill(&mut boxes.points, &boundary.points, |&point| bound(&[point]), pool);
        self.bvh.refit_in_tasks(|triangle| boxes.triangles[triangle], pool);
        self.boxes = boxes;
        self.fitted_interval = Some(interval);
    }
}

/// The low and the high corner of the bounding box of some points.
fn corners(points: &[Vector3<f64>]) -> [Vector3<f64>; 2] {
    let first = points.first().copied().unwrap_or_default();
    points.iter().fold([first, first], |[low, high], point| [low.inf(point), high.sup(point)])
}

/// Boxes per task.
const BOXES_PER_TASK: usize = 512;

/// Sets the boxes of some elements.
fn refill<T: Sync>(
    column: &mut Vec<Aabb>,
    elements: &[T],
    bound: impl Fn(&T) -> Aabb + Sync,
    pool: &ThreadPool,
) {
    column.resize(elements.len(), Aabb::EMPTY);
    let boxes = DisjointSlice::new(column);
    pool.parallel_for(elements.len().div_ceil(BOXES_PER_TASK), |task| {
        let own = elements.chunks(BOXES_PER_TASK).nth(task).unwrap_or_default();
        for (at, element) in (task * BOXES_PER_TASK..).zip(own) {
            // SAFETY: every element is in one task.
            #[allow(unsafe_code)]
            unsafe {
                boxes.set(at as u32, bound(element));
            }
        }
    });
}
