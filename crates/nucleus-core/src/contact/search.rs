//! Broad phase: finds the pairs of elements that can touch within a span of time.
//!
//! It runs once per substep, on where each point is and where it is heading, with a margin. All passes of the
//! substep use its list. Should a point leave what was foreseen for it, its neighbourhood is searched again.

use std::sync::Mutex;

use nalgebra::Vector3;

use super::aabb::Aabb;
use super::collider::{Boxes, ColliderState};
use super::collider_contact::{Pair, Step};
use super::foresee::Foreseen;
use super::pairs::PairList;
use super::pseudonormals::Outside;
use super::skin::Group;
use crate::math::Real;
use crate::model::{ClothModel, ColliderModel};
use crate::parallel::thread_pool::ThreadPool;

/// What is searched: a cloth and a collider, whose boxes are fitted to the span.
pub struct Search<'a, R> {
    /// The cloth.
    pub cloth: &'a ClothModel<R>,
    /// The collider.
    pub collider: &'a ColliderModel,
    /// Its motion.
    pub state: &'a ColliderState,
    /// What is foreseen for the cloth's points.
    pub foreseen: Foreseen<'a, R>,
    /// Whether that is new, by point.
    pub strayed: &'a [bool],
    /// Where both are.
    pub step: &'a Step<'a, R>,
    /// From where the one sees it to whom something is foreseen to where the collider does, at both ends of the span.
    pub shifts: [Vector3<f64>; 2],
}

/// A group of the cloth's elements with its boxes.
struct Near<'a> {
    index: u32,
    group: &'a Group,
    boxes: &'a Boxes,
    around: &'a Aabb,
}

/// Triangles to a group of the cloth. Two are found max_speed: a drape takes 67 ms a frame with eight, 55 with two.
pub const GROUP: usize = 2;

/// Groups to a task.
const GROUPS_PER_TASK: usize = 64;

/// What one task finds, and room to find it in.
#[derive(Debug)]
pub struct Found<R> {
    point_face: Vec<Pair<R, 1, 3>>,
    edge_edge: Vec<Pair<R, 2, 2>>,
    face_point: Vec<Pair<R, 3, 1>>,
    /// Points behind a face.
    suspects: Vec<u32>,
    /// Boxes of the group being searched.
    boxes: Boxes,
}

impl<R> Default for Found<R> {
    fn default() -> Self {
        let boxes = Boxes::default();
        let (point_face, edge_edge, face_point) = (Vec::new(), Vec::new(), Vec::new());
        Self { point_face, edge_edge, face_point, suspects: Vec::new(), boxes }
    }
}

impl<R> Found<R> {
    fn clear(&mut self) {
        self.point_face.clear();
        self.edge_edge.clear();
        self.face_point.clear();
        self.suspects.clear();
    }
}

impl<R: Real> Search<'_, R> {
    /// Replaces the pairs of those groups of the cloth for which something new is foreseen.
    pub fn run(&self, list: &mut PairList<R>, pool: &ThreadPool) {
        let is_new = |group: &Group| {
            let skin = &self.cloth.skin;
            let corners = skin.triangles[group.triangles.clone()].iter().flatten();
            corners.chain(&skin.points[group.points.clone()]).any(|&point| self.strayed[point as usize])
        };
        let PairList { searched, again, tasks, point_face, edge_edge, face_point, by_point, trapped, .. } =
            list;
        searched.clear();
        searched.extend(self.cloth.skin.groups(GROUP).map(|group| is_new(&group)));
        again.clear();
        again.extend((0..).zip(&*searched).filter(|(_, is_new)| **is_new).map(|(group, _)| group));
        point_face.retain(|pair| !searched[pair.group as usize]);
        edge_edge.retain(|pair| !searched[pair.group as usize]);
        face_point.retain(|pair| !searched[pair.group as usize]);
        let chunks = again.len().div_ceil(GROUPS_PER_TASK);
        tasks.resize_with(tasks.len().max(chunks), Mutex::default);
        pool.parallel_for(chunks, |task| {
            // Nobody else has it: a task is done once.
            let Ok(mut found) = tasks[task].lock() else { return };
            found.clear();
            let end = ((task + 1) * GROUPS_PER_TASK).min(again.len());
            again[task * GROUPS_PER_TASK..end].iter().for_each(|&group| self.around(group, &mut found));
        });
        // In the order of the groups, whoever searched them.
        for found in tasks[..chunks].iter_mut().filter_map(|task| task.get_mut().ok()) {
            point_face.append(&mut found.point_face);
            edge_edge.append(&mut found.edge_edge);
            face_point.append(&mut found.face_point);
            trapped.suspects.append(&mut found.suspects);
        }
        by_point.clear();
        let key = |(index, pair): (u64, &Pair<R, 1, 3>)| u64::from(pair.points[0]) << 32 | index;
        by_point.extend((0..).zip(point_face.iter()).map(key));
        by_point.sort_unstable();
    }

    /// Everything that a group can touch.
    fn around(&self, index: u32, found: &mut Found<R>) {
        let group = self.cloth.skin.group(index as usize, GROUP);
        let mut boxes = std::mem::take(&mut found.boxes);
        let around = self.bound_group(&group, &mut boxes);
        let near = Near { index, group: &group, boxes: &boxes, around: &around };
        self.state.tree.query(&around, |triangle| self.meet(&near, triangle, found));
        found.boxes = boxes;
    }

    /// Writes the boxes of a group's elements, with the thickness; the box round them all.
    fn bound_group(&self, group: &Group, boxes: &mut Boxes) -> Aabb {
        let skin = &self.cloth.skin;
        let thickness = self.step.reach().to_f64() as f32 * (1.0 + 1e-6);
        let bound = |points: &[u32]| {
            points.iter().map(|&point| self.reach(point)).fold(Aabb::EMPTY, Aabb::union).inflate(thickness)
        };
        boxes.triangles.clear();
        boxes
            .triangles
            .extend(skin.triangles[group.triangles.clone()].iter().map(|triangle| bound(triangle)));
        boxes.edges.clear();
        boxes.edges.extend(skin.edges[group.edges.clone()].iter().map(|edge| bound(edge)));
        boxes.points.clear();
        boxes.points.extend(skin.points[group.points.clone()].iter().map(|&point| bound(&[point])));
        boxes.triangles.iter().chain(&boxes.points).copied().fold(Aabb::EMPTY, Aabb::union)
    }

    /// Every pair of an element of the group and an element owned by one triangle of the collider.
    fn meet(&self, near: &Near<'_>, triangle: u32, found: &mut Found<R>) {
        let (skin, theirs, boxes) = (&self.cloth.skin, &self.collider.skin, &self.state.boxes);
        let Near { index, group, boxes: ours, around } = near;
        let face = &boxes.triangles[triangle as usize];
        if !face.meets(around) {
            return;
        }
        let corners = theirs.triangles[triangle as usize];
        let points = skin.points[group.points.clone()].iter().zip(&ours.points);
        for (&point, _) in points.filter(|(_, reach)| reach.meets(face)) {
            let Some(pair) = self.pair([point], corners, *index) else { continue };
            found.point_face.push(pair);
            if self.collider.outside.is_some() && self.is_behind(point, corners) {
                found.suspects.push(point);
            }
        }
        let owned = theirs.owned(triangle as usize);
        for edge in owned.edges.filter(|&edge| boxes.edges[edge].meets(around)) {
            let edges = skin.edges[group.edges.clone()].iter().zip(&ours.edges);
            for (&ends, _) in edges.filter(|(_, reach)| reach.meets(&boxes.edges[edge])) {
                let pair = self.pair(ends, theirs.edges[edge], *index);
                found.edge_edge.extend(pair.filter(|pair| !self.is_within(pair, |o, n| o.at_edge(edge, n))));
            }
        }
        for point in owned.points.filter(|&point| boxes.points[point].meets(around)) {
            let faces = skin.triangles[group.triangles.clone()].iter().zip(&ours.triangles);
            for (&face, _) in faces.filter(|(_, reach)| reach.meets(&boxes.points[point])) {
                let pair = self.pair(face, [theirs.points[point]], *index);
                found
                    .face_point
                    .extend(pair.filter(|pair| !self.is_within(pair, |o, n| o.at_point(point, n))));
            }
        }
    }

    /// Whether the cloth's element of a pair is inside the collider: kept on its side it would never come out.
    fn is_within<const N: usize, const M: usize>(
        &self,
        pair: &Pair<R, N, M>,
        outward: impl Fn(&Outside, &dyn Fn(u32) -> Vector3<f64>) -> Vector3<f64>,
    ) -> bool {
        let normal = |face: u32| {
            let [from, _] = self.step.surface(self.collider.skin.triangles[face as usize]);
            (from[1] - from[0]).cross(&(from[2] - from[0])).try_normalize(0.0).unwrap_or_default()
        };
        self.collider.outside.as_ref().is_some_and(|outside| pair.is_within(outward(outside, &normal)))
    }

    /// Whether a point is behind the plane of a face.
    fn is_behind(&self, point: u32, corners: [u32; 3]) -> bool {
        let [from, _] = self.step.surface(corners);
        let outward = (from[1] - from[0]).cross(&(from[2] - from[0]));
        outward.dot(&(self.step.place_at_start(point) - from[0])) < 0.0
    }

    /// A pair, if it can touch.
    fn pair<const N: usize, const M: usize>(
        &self,
        ours: [u32; N],
        theirs: [u32; M],
        group: u32,
    ) -> Option<Pair<R, N, M>> {
        Pair::find(ours, theirs, group, self.step, &self.foreseen)
    }

    /// The box round all that is foreseen for a point of the cloth, as the collider sees it.
    fn reach(&self, point: u32) -> Aabb {
        let anchor = Vector3::from(self.step.anchors[point as usize]);
        let [low, high] =
            self.foreseen.of(point).map(|corner| anchor + Vector3::from(corner.xyz().map(R::to_f64)));
        let [from, to] = self.shifts.map(|shift| Aabb::new(low + shift, high + shift));
        from.union(to)
    }
}
