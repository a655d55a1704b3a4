//! Broad phase among cloths: finds the pairs of elements that can touch while every point keeps to what is
//! foreseen for it in the frame. Where points stray, only their neighbourhoods are searched again.

use std::sync::Mutex;

use super::Mutual;
use super::bodies::Bodies;
use super::candidate::{Candidate, Kind, Seen};
use super::terms::Terms;
use crate::collision::skin::Group;
use crate::collision::tree::Aabb;
use crate::frame::Elements;
use crate::model::ClothModel;
use crate::scalar::Real;
use crate::team::Team;

/// All candidates, and room to find them in.
#[derive(Debug, Default)]
pub struct Candidates {
    /// The candidates.
    pub list: Vec<Candidate>,
    again: Vec<bool>,
    tasks: Vec<Mutex<Found>>,
    seen: Seen,
    /// Each group's box at the start and at the end of what is foreseen.
    boxes: Vec<[Aabb; 2]>,
}

impl Clone for Candidates {
    /// A copy of what was found; the room is made anew.
    fn clone(&self) -> Self {
        Self { list: self.list.clone(), ..Self::default() }
    }
}

/// What one task finds, with the boxes it makes on the way.
#[derive(Debug, Default)]
struct Found {
    list: Vec<Candidate>,
    ours: Boxes,
    theirs: Boxes,
}

/// Two boxes per element of a group: at the start and at the end of what is foreseen.
#[derive(Debug, Default)]
struct Boxes {
    triangles: Vec<[Aabb; 2]>,
    edges: Vec<[Aabb; 2]>,
    points: Vec<[Aabb; 2]>,
}

/// Groups per task.
const GROUPS_PER_TASK: usize = 256;

/// All that a search looks at.
struct Search<'a, R> {
    bodies: &'a Bodies,
    cloths: &'a [ClothModel<R>],
    terms: &'a [Option<Terms<R>>],
    again: &'a [bool],
    seen: &'a Seen,
    boxes: &'a [[Aabb; 2]],
    /// Half of the largest distance that is kept.
    margin: f32,
}

/// Finds the candidates of all groups that have a strayed point, from time `now` of the frame on.
pub fn search<R: Real>(
    mutual: &mut Mutual<R>,
    cloths: &[ClothModel<R>],
    anchors: &[[f64; 3]],
    now: f64,
    team: &Team,
) {
    let Mutual { bodies, terms, far, strayed, candidates, .. } = mutual;
    let Candidates { list, again, tasks, seen, boxes } = candidates;
    seen.look(anchors, far, R::from_f64(now));
    let widest = terms.iter().flatten().map(|terms| terms.thickness).fold(0.0, f64::max) as f32;
    let margin = widest * 0.5 * (1.0 + 1e-5);
    again.clear();
    boxes.clear();
    for group in 0..bodies.groups.len() {
        let is_new = bodies.points_of(group).iter().any(|&point| strayed[point as usize]);
        again.push(is_new);
        let [start, end] = seen.bound(bodies.points_of(group).iter().copied(), margin);
        boxes.push([start, end]);
        if is_new {
            bodies.around[group] = start.union(end);
        }
    }
    if let Some(tree) = &mut bodies.tree {
        tree.refit(&bodies.around);
    }
    list.retain(|candidate| candidate.groups.iter().all(|&group| !again[group as usize]));
    let chunks = bodies.groups.len().div_ceil(GROUPS_PER_TASK);
    tasks.resize_with(chunks, Mutex::default);
    let view = Search { bodies, cloths, terms, again, seen, boxes, margin };
    team.phase(chunks, |task| {
        // Nobody else has it: a task is done once.
        let Ok(mut found) = tasks[task].lock() else { return };
        found.list.clear();
        let end = ((task + 1) * GROUPS_PER_TASK).min(view.bodies.groups.len());
        for group in (task * GROUPS_PER_TASK..end).filter(|&group| view.again[group]) {
            view.around(group as u32, &mut found);
        }
    });
    for found in tasks.iter_mut().filter_map(|task| task.get_mut().ok()) {
        list.append(&mut found.list);
    }
    strayed.fill(false);
}

impl<R: Real> Search<'_, R> {
    /// Everything that meets the elements of a group.
    fn around(&self, group: u32, found: &mut Found) {
        let Some(tree) = &self.bodies.tree else { return };
        self.bound_elements(group, &mut found.ours);
        let ours = &self.boxes[group as usize];
        tree.query(&self.bodies.around[group as usize], |other| {
            // Two groups that are both searched meet once.
            let met_before = other < group && self.again[other as usize];
            if !met_before && Aabb::may_meet(ours, &self.boxes[other as usize]) {
                self.meet(group, other, found);
            }
        });
    }

    fn meet(&self, group: u32, other: u32, found: &mut Found) {
        let cloths = [group, other].map(|group| self.bodies.groups[group as usize].cloth as usize);
        let Some(terms) = &self.terms[cloths[0] * self.cloths.len() + cloths[1]] else { return };
        self.bound_elements(other, &mut found.theirs);
        let Found { list, ours, theirs } = found;
        let here = Side { search: self, index: group, boxes: ours, reach: terms.elements[0] };
        let there = Side { search: self, index: other, boxes: theirs, reach: terms.elements[1] };
        here.points_against(&there, terms, list);
        if group != other {
            there.points_against(&here, terms, list);
        }
        if terms.edges {
            here.edges_against(&there, terms, list);
        }
    }

    fn bound_elements(&self, group: u32, boxes: &mut Boxes) {
        let (skin, group) = self.elements(group);
        boxes.triangles.clear();
        boxes.edges.clear();
        boxes.points.clear();
        let bound = |points: &[u32]| self.seen.bound(points.iter().copied(), self.margin);
        boxes.triangles.extend(skin.triangles[group.triangles.clone()].iter().map(|t| bound(t)));
        boxes.edges.extend(skin.edges[group.edges.clone()].iter().map(|edge| bound(edge)));
        boxes.points.extend(skin.points[group.points.clone()].iter().map(|&point| bound(&[point])));
    }

    fn elements(&self, group: u32) -> (&crate::collision::skin::Skin, &Group) {
        let body = &self.bodies.groups[group as usize];
        (&self.cloths[body.cloth as usize].skin, &body.group)
    }
}

/// One group of two that meet.
struct Side<'a, R> {
    search: &'a Search<'a, R>,
    index: u32,
    boxes: &'a Boxes,
    /// Which of its elements meet the points of the other.
    reach: Elements,
}

impl<R: Real> Side<'_, R> {
    /// Every point of this side against the elements of the other.
    fn points_against(&self, other: &Self, terms: &Terms<R>, found: &mut Vec<Candidate>) {
        let ((skin, group), (theirs, their_group)) =
            (self.search.elements(self.index), self.search.elements(other.index));
        let rest = self.search.rest(self.index, other.index);
        let mut keep = |kind: Kind, points: [u32; 4]| {
            let groups = [self.index, other.index];
            found.extend(self.search.seen.candidate(kind, points, groups, terms.thickness as f32, rest));
        };
        for (&p, reach) in skin.points[group.points.clone()].iter().zip(&self.boxes.points) {
            let meets = |boxes: &[Aabb; 2]| Aabb::may_meet(reach, boxes);
            // What has no face is a point, whatever its cloth's elements are.
            if other.reach == Elements::Points || their_group.triangles.is_empty() {
                let points = theirs.points[their_group.points.clone()].iter().zip(&other.boxes.points);
                for (&q, _) in points.filter(|&(&q, boxes)| self.is_first(other, p, q) && meets(boxes)) {
                    keep(Kind::PointPoint, [p, q, p, p]);
                }
            } else if other.reach == Elements::Edges {
                let edges = theirs.edges[their_group.edges.clone()].iter().zip(&other.boxes.edges);
                for (&[a, b], _) in edges.filter(|(edge, boxes)| !edge.contains(&p) && meets(boxes)) {
                    keep(Kind::PointEdge, [p, a, b, p]);
                }
            } else {
                let faces =
                    theirs.triangles[their_group.triangles.clone()].iter().zip(&other.boxes.triangles);
                for (&[a, b, c], _) in faces.filter(|(face, boxes)| !face.contains(&p) && meets(boxes)) {
                    keep(Kind::PointFace, [p, a, b, c]);
                }
            }
        }
    }

    /// Whether two points meet as points, and in this direction: each pair counts once, and where one side has
    /// faces or edges the other's points meet those.
    fn is_first(&self, other: &Self, p: u32, q: u32) -> bool {
        let only_points = (self.reach == Elements::Points
            || self.search.elements(self.index).1.triangles.is_empty())
            && (other.reach == Elements::Points || self.search.elements(other.index).1.triangles.is_empty());
        only_points && p < q
    }

    /// Every edge of this side against every edge of the other.
    fn edges_against(&self, other: &Self, terms: &Terms<R>, found: &mut Vec<Candidate>) {
        let ((skin, group), (theirs, their_group)) =
            (self.search.elements(self.index), self.search.elements(other.index));
        let rest = self.search.rest(self.index, other.index);
        for (&[a, b], reach) in skin.edges[group.edges.clone()].iter().zip(&self.boxes.edges) {
            for (&[c, d], boxes) in theirs.edges[their_group.edges.clone()].iter().zip(&other.boxes.edges) {
                let counted = self.index == other.index && [a, b] >= [c, d];
                let joined = a == c || a == d || b == c || b == d;
                if !counted && !joined && Aabb::may_meet(reach, boxes) {
                    let groups = [self.index, other.index];
                    let points = [a, b, c, d];
                    let thickness = terms.thickness as f32;
                    found.extend(self.search.seen.candidate(Kind::EdgeEdge, points, groups, thickness, rest));
                }
            }
        }
    }
}

impl<R: Real> Search<'_, R> {
    /// The shape at rest, where two groups are of one cloth: neighbours keep less than the thickness.
    fn rest(&self, group: u32, other: u32) -> Option<&[[f32; 3]]> {
        let [a, b] = [group, other].map(|group| self.bodies.groups[group as usize].cloth);
        (a == b).then_some(&self.bodies.rest)
    }
}
