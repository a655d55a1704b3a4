//! Broad phase: the pairs of elements that can touch within a span of time.
//!
//! It runs once per substep, on where each point is and where it is heading, with a margin. All passes of the
//! substep use its list. Should a point leave what was foreseen for it, the list is made anew for the rest.

use std::ops::Range;

use nalgebra::Vector3;

use super::contact::{Pair, Step};
use super::skin::{Group, Skin, bound};
use super::tree::{Aabb, Tree};
use crate::model::{Blocks, ClothModel, ColliderModel};
use crate::scalar::{Real, Row4};

/// Share of a point's expected motion that is added as margin all round.
const MARGIN: f64 = 0.25;

/// A collider within the current frame.
#[derive(Debug, Clone)]
pub struct ColliderState {
    /// Positions at the start of the frame in metres.
    pub start: Vec<Vector3<f64>>,
    /// Positions at the end of the frame in metres.
    pub end: Vec<Vector3<f64>>,
    /// Whether any point moves in this frame.
    pub moves: bool,
    /// The time of the frame that the solver has come to, as a share of it.
    pub now: f64,
    tree: Tree,
    /// The span that the tree's boxes hold for; empty if none.
    fitted: Option<[f64; 2]>,
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
            now: 0.0,
            tree: Tree::new(&centres),
            fitted: None,
        }
    }

    /// Takes up a frame's motion.
    pub fn begin_frame(&mut self, start: &[Vector3<f64>], end: &[Vector3<f64>]) {
        let last = if start.is_empty() { std::mem::take(&mut self.end) } else { start.to_vec() };
        let next = if end.is_empty() { last.clone() } else { end.to_vec() };
        self.now = 0.0;
        let rested = self.start == last && !self.moves;
        self.moves = last != next;
        // A collider that neither moved nor moves keeps its boxes.
        if self.moves || !rested {
            self.fitted = None;
        }
        (self.start, self.end) = (last, next);
    }

    /// The box round a point's path through a span of the frame.
    fn path(&self, point: u32, span: [f64; 2]) -> Aabb {
        let [start, end] = [self.start[point as usize], self.end[point as usize]];
        Aabb::of(span.map(|time| start + (end - start) * time))
    }

    /// Sets the tree's boxes for a span of the frame; those of a collider at rest hold on.
    pub fn fit(&mut self, skin: &Skin, span: [f64; 2]) {
        if self.fitted == Some(span) || (self.fitted.is_some() && !self.moves) {
            return;
        }
        let mut tree = std::mem::replace(&mut self.tree, Tree::new(&[]));
        tree.refit(|triangle| bound(&skin.triangles[triangle as usize], |point| self.path(point, span)));
        self.tree = tree;
        self.fitted = Some(span);
    }
}

/// Where each point of a cloth is foreseen to stay: low and high corner of its displacement.
pub type Cover<R> = [Row4<R>; 2];

/// The pairs of one cloth and one collider, and the span they hold for.
#[derive(Debug, Clone)]
pub struct PairList<R> {
    /// The cloth, by its index.
    pub cloth: usize,
    /// The collider, by its index.
    pub collider: usize,
    /// The span, as shares of the frame.
    pub span: [f64; 2],
    /// Points of the cloth near faces of the collider, sorted by point.
    pub point_face: Vec<Pair<R, 1, 3>>,
    /// The run of `point_face` that belongs to each block of the cloth.
    pub runs: Vec<Range<u32>>,
    /// Edges near edges.
    pub edge_edge: Vec<Pair<R, 2, 2>>,
    /// Faces of the cloth near points of the collider.
    pub face_point: Vec<Pair<R, 3, 1>>,
}

impl<R: Real> PairList<R> {
    /// No pairs yet.
    pub fn new(cloth: usize, collider: usize) -> Self {
        let span = [0.0, 0.0];
        Self {
            cloth,
            collider,
            span,
            point_face: Vec::new(),
            runs: Vec::new(),
            edge_edge: Vec::new(),
            face_point: Vec::new(),
        }
    }

    /// Pairs in all.
    pub fn len(&self) -> usize {
        self.point_face.len() + self.edge_edge.len() + self.face_point.len()
    }

    /// Forgets the pairs, keeps the room.
    pub fn clear(&mut self) {
        self.point_face.clear();
        self.edge_edge.clear();
        self.face_point.clear();
    }

    /// Finds the pairs anew. The collider's tree is fitted to the span.
    pub fn find(
        &mut self,
        cloth: &ClothModel<R>,
        (collider, state): (&ColliderModel, &ColliderState),
        cover: &[Cover<R>],
        step: &Step<'_, R>,
    ) {
        self.clear();
        self.span = step.span;
        let search = Search { cloth, collider, state, cover, step, thickness: step.thickness.to_f64() };
        cloth.skin.groups().for_each(|group| search.group(&group, self));
        self.point_face.sort_unstable_by_key(|pair| (pair.points, pair.collider_points));
        self.edge_edge.sort_unstable_by_key(|pair| (pair.points, pair.collider_points));
        self.face_point.sort_unstable_by_key(|pair| (pair.points, pair.collider_points));
        self.cut(&cloth.blocks);
    }

    fn cut(&mut self, blocks: &Blocks) {
        let pairs = &self.point_face;
        let place = |end: u32| pairs.partition_point(|pair| pair.points[0] < end) as u32;
        self.runs.clear();
        self.runs.extend(
            (0..blocks.len()).map(|block| blocks.range(block)).map(|run| place(run.start)..place(run.end)),
        );
    }
}

struct Search<'a, R> {
    cloth: &'a ClothModel<R>,
    collider: &'a ColliderModel,
    state: &'a ColliderState,
    cover: &'a [Cover<R>],
    step: &'a Step<'a, R>,
    thickness: f64,
}

impl<R: Real> Search<'_, R> {
    fn group(&self, group: &Group, found: &mut PairList<R>) {
        let skin = &self.cloth.skin;
        let corners = skin.triangles[group.triangles.clone()].iter().flatten();
        let all = corners.chain(&skin.points[group.points.clone()]);
        let around =
            all.fold(Aabb::EMPTY, |all, &point| all.union(self.reach(point))).inflate(self.thickness);
        self.state.tree.query(&around, |triangle| self.triangle(group, &around, triangle, found));
    }

    /// Every pair of an element of the group and an element owned by one triangle of the collider.
    fn triangle(&self, group: &Group, around: &Aabb, triangle: u32, found: &mut PairList<R>) {
        let (skin, theirs) = (&self.cloth.skin, &self.collider.skin);
        let corners = theirs.triangles[triangle as usize];
        let face = self.theirs(&corners);
        if !face.meets(around) {
            return;
        }
        for &point in &skin.points[group.points.clone()] {
            self.pair([point], corners, &face, &mut found.point_face);
        }
        let owned = theirs.owned(triangle as usize);
        for &edge in &theirs.edges[owned.edges] {
            let near = self.theirs(&edge);
            if near.meets(around) {
                let edges = skin.edges[group.edges.clone()].iter();
                edges.for_each(|&ours| self.pair(ours, edge, &near, &mut found.edge_edge));
            }
        }
        for &point in &theirs.points[owned.points] {
            let near = self.theirs(&[point]);
            if near.meets(around) {
                let faces = skin.triangles[group.triangles.clone()].iter();
                faces.for_each(|&ours| self.pair(ours, [point], &near, &mut found.face_point));
            }
        }
    }

    fn pair<const N: usize, const M: usize>(
        &self,
        ours: [u32; N],
        theirs: [u32; M],
        near: &Aabb,
        found: &mut Vec<Pair<R, N, M>>,
    ) {
        let reach = bound(&ours, |point| self.reach(point)).inflate(self.thickness);
        if reach.meets(near) {
            let pair = Pair::new(ours, theirs, self.step);
            if pair.least_gap(|point| self.cover[point as usize]) < self.step.thickness {
                found.push(pair);
            }
        }
    }

    /// The box round all that is foreseen for a point of the cloth.
    fn reach(&self, point: u32) -> Aabb {
        let anchor = Vector3::from(self.step.anchors[point as usize]);
        let corner = |row: Row4<R>| anchor + Vector3::from(row.xyz().map(R::to_f64));
        let [low, high] = self.cover[point as usize];
        Aabb { low: corner(low), high: corner(high) }
    }

    fn theirs(&self, points: &[u32]) -> Aabb {
        bound(points, |point| self.state.path(point, self.step.span))
    }
}

/// What is foreseen for a point: from where it started the step, over where it is now, on to where it will
/// be at the end of the span if it goes on like this, with a margin.
pub fn foresee<R: Real>(start: [R; 3], now: [R; 3], steps_left: R, margin: R) -> Cover<R> {
    let mut travel = R::ZERO;
    let end: [R; 3] = std::array::from_fn(|axis| now[axis] + (now[axis] - start[axis]) * steps_left);
    for axis in 0..3 {
        let far = end[axis] - start[axis];
        travel = max(travel, max(far, -far));
    }
    let margin = margin + travel * R::from_f64(MARGIN);
    let corner = |side: R, pick: fn(R, R) -> R| {
        let at = |axis: usize| pick(pick(start[axis], now[axis]), end[axis]) + margin * side;
        Row4([at(0), at(1), at(2), R::ZERO])
    };
    [corner(-R::ONE, min), corner(R::ONE, max)]
}

/// Whether a point is where it was foreseen to be.
pub fn is_foreseen<R: Real>([low, high]: &Cover<R>, now: [R; 3]) -> bool {
    (0..3).all(|axis| low.0[axis] <= now[axis] && now[axis] <= high.0[axis])
}

fn min<R: Real>(a: R, b: R) -> R {
    if b < a { b } else { a }
}

fn max<R: Real>(a: R, b: R) -> R {
    if b > a { b } else { a }
}
