//! Broad phase among cloths: finds the pairs of elements that can touch while every point keeps to what is
//! foreseen for it in the frame. Where points stray, only the pairs of their elements are looked for again.

use std::sync::Mutex;

use super::Mutual;
use super::bodies::Bodies;
use super::candidate::{Candidate, Kind, Seen};
use super::local::{self, Local, Locals};
use super::terms::Terms;
use crate::checkpoint::kept;
use crate::collision::skin::{Group, Skin};
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
    again: Vec<u32>,
    tasks: Vec<Mutex<Found>>,
    seen: Seen,
}

kept!([] Candidates { columns: [], values: [list], parts: [seen], anew: [again, tasks] });

impl Clone for Candidates {
    /// A copy of what was found; the room is made anew.
    fn clone(&self) -> Self {
        Self { list: self.list.clone(), ..Self::default() }
    }
}

/// What one task finds, and the groups that it looks at on the way.
#[derive(Debug, Default)]
struct Found {
    list: Vec<Candidate>,
    ours: Local,
    theirs: Locals,
}

/// Groups per task.
const GROUPS_PER_TASK: usize = 64;

/// All that a search looks at.
pub(super) struct Search<'a, R> {
    bodies: &'a Bodies,
    cloths: &'a [ClothModel<R>],
    terms: &'a [Option<Terms<R>>],
    pub(super) strayed: &'a [bool],
    pub(super) seen: &'a Seen,
    /// Half of the largest distance that is kept.
    pub(super) margin: f32,
}

/// Finds the candidates of all elements that have a strayed point, from time `now` of the frame on.
pub fn search<R: Real>(
    mutual: &mut Mutual<R>,
    cloths: &[ClothModel<R>],
    anchors: &[[f64; 3]],
    now: f64,
    team: &Team,
) {
    let Mutual { bodies, terms, far, strayed, candidates, .. } = mutual;
    let Candidates { list, again, tasks, seen } = candidates;
    seen.look(anchors, far, R::from_f64(now));
    let widest = terms.iter().flatten().map(|terms| terms.thickness).fold(0.0, f64::max) as f32;
    let margin = widest * 0.5 * (1.0 + 1e-5);
    again.clear();
    for group in 0..bodies.groups.len() {
        if bodies.points_of(group).iter().any(|&point| strayed[point as usize]) {
            let [start, end] = seen.bound(bodies.points_of(group).iter().copied(), margin);
            bodies.around[group] = start.union(end);
            again.push(group as u32);
        }
    }
    if let Some(tree) = &mut bodies.tree {
        tree.refit(&bodies.around);
    }
    list.retain(|candidate| candidate.points.iter().all(|&point| !strayed[point as usize]));
    let chunks = again.len().div_ceil(GROUPS_PER_TASK);
    tasks.resize_with(tasks.len().max(chunks), Mutex::default);
    let view = Search { bodies, cloths, terms, strayed, seen, margin };
    team.phase(chunks, |task| {
        // Nobody else has it: a task is done once.
        let Ok(mut found) = tasks[task].lock() else { return };
        found.list.clear();
        found.theirs.forget();
        let end = ((task + 1) * GROUPS_PER_TASK).min(again.len());
        again[task * GROUPS_PER_TASK..end].iter().for_each(|&group| view.around(group, &mut found));
    });
    for found in tasks[..chunks].iter_mut().filter_map(|task| task.get_mut().ok()) {
        list.append(&mut found.list);
    }
    strayed.fill(false);
}

impl<R: Real> Search<'_, R> {
    /// Everything that meets the new elements of a group.
    fn around(&self, group: u32, found: &mut Found) {
        let Some(tree) = &self.bodies.tree else { return };
        let Found { list, ours, theirs } = found;
        ours.look(self, group);
        let new = ours.new;
        let sought = new[0].union(new[1]);
        tree.query(&sought, |other| {
            // A leaf of the tree has several.
            if !self.bodies.around[other as usize].meets(&sought) {
                return;
            }
            let theirs = theirs.of(self, other);
            if Aabb::may_meet(&new, &theirs.all) {
                self.meet((group, ours), (other, theirs), list);
            }
        });
    }

    /// All pairs of an element that is new in our group with one of theirs. What is new on both sides is found from
    /// the group that comes first.
    fn meet(&self, ours: (u32, &Local), theirs: (u32, &Local), list: &mut Vec<Candidate>) {
        let cloths = [ours, theirs].map(|(group, _)| self.bodies.groups[group as usize].cloth as usize);
        let Some(terms) = &self.terms[cloths[0] * self.cloths.len() + cloths[1]] else { return };
        let rest = (cloths[0] == cloths[1]).then_some(&self.bodies.rest[..]);
        let mut pairs = Pairs { seen: self.seen, thickness: terms.thickness as f32, rest, list };
        let side = |(group, local), reach| {
            let (skin, elements) = self.elements(group);
            Side { local, reach, skin, elements }
        };
        let (here, there) = (side(ours, terms.elements[0]), side(theirs, terms.elements[1]));
        if ours.0 == theirs.0 {
            pairs.points_against(&here, &here, |ours, theirs| ours || theirs);
            if terms.edges {
                pairs.edges_within(&here);
            }
            return;
        }
        let is_first = ours.0 < theirs.0;
        let counts = |ours: bool, theirs: bool| ours && (is_first || !theirs);
        pairs.points_against(&here, &there, counts);
        pairs.points_against(&there, &here, |theirs, ours| counts(ours, theirs));
        if terms.edges {
            pairs.edges_against(&here, &there, counts);
        }
    }

    /// A group's elements, and the skin that they are of.
    pub(super) fn elements(&self, group: u32) -> (&Skin, &Group) {
        let body = &self.bodies.groups[group as usize];
        (&self.cloths[body.cloth as usize].skin, &body.group)
    }
}

/// One group of two that meet.
struct Side<'a> {
    local: &'a Local,
    /// Which of its elements meet the points of the other.
    reach: Elements,
    skin: &'a Skin,
    elements: &'a Group,
}

impl<'a> Side<'a> {
    /// Which of its elements the points of another meet. What has no face is points, whatever its cloth's are.
    fn reach(&self) -> Elements {
        if self.elements.triangles.is_empty() { Elements::Points } else { self.reach }
    }

    fn points(&self) -> impl Iterator<Item = (u32, Boxed<'a>)> {
        self.skin.points[self.elements.points.clone()].iter().copied().zip(boxed(&self.local.points))
    }

    fn edges(&self) -> impl Iterator<Item = ([u32; 2], Boxed<'a>)> {
        self.skin.edges[self.elements.edges.clone()].iter().copied().zip(boxed(&self.local.edges))
    }

    fn triangles(&self) -> impl Iterator<Item = ([u32; 3], Boxed<'a>)> {
        self.skin.triangles[self.elements.triangles.clone()].iter().copied().zip(boxed(&self.local.triangles))
    }
}

/// The boxes round an element, and whether it is new.
type Boxed<'a> = (&'a [Aabb; 2], bool);

fn boxed(kind: &local::Kind) -> impl Iterator<Item = Boxed<'_>> {
    kind.boxes.iter().zip(kind.is_new.iter().copied())
}

/// Where pairs of two cloths are put.
struct Pairs<'a> {
    seen: &'a Seen,
    thickness: f32,
    /// The shape at rest, where both are one cloth: neighbours keep less than the thickness.
    rest: Option<&'a [[f32; 3]]>,
    list: &'a mut Vec<Candidate>,
}

impl Pairs<'_> {
    fn keep(&mut self, kind: Kind, points: [u32; 4]) {
        self.list.extend(self.seen.candidate(kind, points, self.thickness, self.rest));
    }

    /// Every point of one side against the elements of the other, as far as they count, given which are new.
    fn points_against(&mut self, ours: &Side<'_>, theirs: &Side<'_>, counts: impl Fn(bool, bool) -> bool) {
        for (p, (here, p_is_new)) in ours.points() {
            let meets = |(there, is_new): Boxed<'_>| counts(p_is_new, is_new) && Aabb::may_meet(here, there);
            match theirs.reach() {
                // Each pair counts once, and where one side has edges or faces the other's points meet those.
                Elements::Points if ours.reach() == Elements::Points => {
                    for (q, _) in theirs.points().filter(|&(q, there)| p < q && meets(there)) {
                        self.keep(Kind::PointPoint, [p, q, p, p]);
                    }
                }
                Elements::Points => {}
                Elements::Edges => {
                    for ([a, b], _) in
                        theirs.edges().filter(|(edge, there)| !edge.contains(&p) && meets(*there))
                    {
                        self.keep(Kind::PointEdge, [p, a, b, p]);
                    }
                }
                Elements::Faces => {
                    for ([a, b, c], _) in
                        theirs.triangles().filter(|(face, there)| !face.contains(&p) && meets(*there))
                    {
                        self.keep(Kind::PointFace, [p, a, b, c]);
                    }
                }
            }
        }
    }

    /// Every edge of one side against every edge of the other.
    fn edges_against(&mut self, ours: &Side<'_>, theirs: &Side<'_>, counts: impl Fn(bool, bool) -> bool) {
        for ([a, b], (here, is_new)) in ours.edges() {
            for ([c, d], (there, other_is_new)) in theirs.edges() {
                let joined = a == c || a == d || b == c || b == d;
                if counts(is_new, other_is_new) && !joined && Aabb::may_meet(here, there) {
                    self.keep(Kind::EdgeEdge, [a, b, c, d]);
                }
            }
        }
    }

    /// Every edge of a group against those that come after it.
    fn edges_within(&mut self, group: &Side<'_>) {
        for (at, ([a, b], (here, is_new))) in group.edges().enumerate() {
            for ([c, d], (there, other_is_new)) in group.edges().skip(at + 1) {
                let joined = a == c || a == d || b == c || b == d;
                if (is_new || other_is_new) && !joined && Aabb::may_meet(here, there) {
                    self.keep(Kind::EdgeEdge, [a, b, c, d]);
                }
            }
        }
    }
}
