//! A collider within a frame: its points move along straight lines from where the frame found them to where
//! it leaves them (§2.4), so that even one substep sees its velocity and its change of shape.

use nalgebra::Vector3;

use super::aabb::Aabb;
use super::tree::Tree;
use crate::bytes::checkpoint_struct;
use crate::model::ColliderModel;

/// A collider in the current frame, and the boxes over its elements for a span of it.
#[derive(Debug, Clone)]
pub struct ColliderState {
    /// Positions at the start of the frame in metres.
    pub start: Vec<Vector3<f64>>,
    /// Positions at the end of the frame in metres.
    pub end: Vec<Vector3<f64>>,
    /// Whether any point moves in this frame.
    pub moves: bool,
    /// The farthest that any point goes in this frame, in metres.
    pub way: f64,
    /// How far its points go in this frame on the mean, in metres.
    pub drift: Vector3<f64>,
    /// Low and high corner of the box round it at the start and at the end of the frame.
    corners: [[Vector3<f64>; 2]; 2],
    /// The time of the frame that the solver has come to, as a share of it.
    pub now: f64,
    /// A box per triangle, per edge and per point of the skin.
    pub boxes: Boxes,
    /// Boxes over triangles.
    pub tree: Tree,
    /// The span that the boxes hold for; none if they are out of date.
    fitted: Option<[f64; 2]>,
}

checkpoint_struct!([] ColliderState {
    columns: [start, end],
    values: [now],
    parts: [],
    rebuilt: [moves, way, drift, corners, boxes, tree, fitted],
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
        let centres: Vec<_> = model.skin.triangles.iter().map(third).collect();
        Self {
            start: model.positions.clone(),
            end: model.positions.clone(),
            moves: false,
            way: 0.0,
            drift: Vector3::zeros(),
            corners: [corners(&model.positions); 2],
            now: 0.0,
            boxes: Boxes::default(),
            tree: Tree::new(&centres),
            fitted: None,
        }
    }

    /// Takes up a frame's motion. No positions at the start: as the frame before ended; none at the end: at rest.
    pub fn begin_frame(&mut self, start: &[Vector3<f64>], end: &[Vector3<f64>]) {
        self.now = 0.0;
        if self.moves || !start.is_empty() || !end.is_empty() {
            std::mem::swap(&mut self.start, &mut self.end);
            if !start.is_empty() {
                self.start.clone_from_slice(start);
            }
            let next = if end.is_empty() { &self.start } else { end };
            self.end.clone_from_slice(next);
            self.fitted = None;
            self.moves = self.start != self.end;
            let ways = self.start.iter().zip(&self.end).map(|(start, end)| (end - start).norm());
            self.way = ways.fold(0.0, f64::max);
            let sum: Vector3<f64> = self.start.iter().zip(&self.end).map(|(start, end)| end - start).sum();
            self.drift = sum / self.start.len().max(1) as f64;
            self.corners = [corners(&self.start), corners(&self.end)];
        }
    }

    /// A box round it at a time of the frame: its low and its high corner, in metres.
    pub fn bounds(&self, time: f64) -> [Vector3<f64>; 2] {
        let [start, end] = self.corners;
        [0, 1].map(|corner| start[corner] + (end[corner] - start[corner]) * time)
    }

    /// What the boxes are relative to at a time of the frame, in metres.
    pub fn origin(&self, time: f64) -> Vector3<f64> {
        self.start.first().copied().unwrap_or_default() + self.drift * time
    }

    /// Where a point is at a time of the frame, in metres.
    pub fn point(&self, point: u32, time: f64) -> Vector3<f64> {
        let [start, end] = [self.start[point as usize], self.end[point as usize]];
        start + (end - start) * time
    }

    /// Sets the boxes for a span of the frame, as seen by one who goes with it; those of a collider at rest hold on.
    pub fn fit(&mut self, model: &ColliderModel, span: [f64; 2]) {
        if self.fitted == Some(span) || (self.fitted.is_some() && !self.moves) {
            return;
        }
        let mut boxes = std::mem::take(&mut self.boxes);
        let bound = |points: &[u32]| {
            let path =
                points.iter().flat_map(|&point| span.map(|time| self.point(point, time) - self.origin(time)));
            Aabb::of(path)
        };
        let skin = &model.skin;
        refill(&mut boxes.triangles, skin.triangles.iter().map(|triangle| bound(triangle)));
        refill(&mut boxes.edges, skin.edges.iter().map(|edge| bound(edge)));
        refill(&mut boxes.points, skin.points.iter().map(|&point| bound(&[point])));
        self.tree.refit(|triangle| boxes.triangles[triangle]);
        self.boxes = boxes;
        self.fitted = Some(span);
    }
}

/// The low and the high corner of the box round some points.
fn corners(points: &[Vector3<f64>]) -> [Vector3<f64>; 2] {
    let first = points.first().copied().unwrap_or_default();
    points.iter().fold([first, first], |[low, high], point| [low.inf(point), high.sup(point)])
}

fn refill(column: &mut Vec<Aabb>, boxes: impl Iterator<Item = Aabb>) {
    column.clear();
    column.extend(boxes);
}
