//! Broad phase among cloths: finds the pairs of elements that can touch while every point keeps to what is
//! foreseen for it in the frame. Where points stray, only the pairs of their elements are looked for again.

use std::sync::Mutex;

use super::Mutual;
use super::bodies::Bodies;
use super::candidate::{Candidate, Seen};
use super::local::{Boxes, Locals};
use super::sought::Sought;
use crate::checkpoint::kept;
use crate::collision::skin::{Group, Skin};
use crate::collision::terms::Terms;
use crate::collision::tree::Aabb;
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

impl Candidates {
    /// Anchors move: what was foreseen from where they were is to be looked at anew.
    pub fn forget_places(&mut self) {
        self.seen.forget();
    }
}

/// What one task finds, and what it looks at on the way.
#[derive(Debug, Default)]
struct Found {
    list: Vec<Candidate>,
    sought: Sought,
    locals: Locals,
}

/// Points per task.
const POINTS_PER_TASK: usize = 64;

/// All that a search looks at.
pub(super) struct Search<'a, R> {
    pub(super) bodies: &'a Bodies,
    pub(super) cloths: &'a [ClothModel<R>],
    pub(super) terms: &'a [Option<Terms<R>>],
    pub(super) strayed: &'a [bool],
    pub(super) seen: &'a Seen,
    /// Half of the largest distance that is kept.
    margin: f32,
}

/// Finds the candidates of all elements that have a strayed point. `now` is when the window began, as a share of the
/// frame: all of its searches look from there, so that what is known of points that did not stray is of the same time.
pub fn search<R: Real>(
    mutual: &mut Mutual<R>,
    cloths: &[ClothModel<R>],
    anchors: &[[f64; 3]],
    now: f64,
    team: &Team,
) {
    let Mutual { bodies, terms, far, strayed, candidates, .. } = mutual;
    let Candidates { list, again, tasks, seen } = candidates;
    let widest = terms.iter().flatten().map(|terms| terms.thickness * terms.reach).fold(0.0, f64::max) as f32;
    let margin = widest * 0.5 * (1.0 + 1e-5);
    let is_changed = |points: &[u32]| points.iter().any(|&point| strayed[point as usize]);
    let is_all_new = seen.look(anchors, far, strayed, now);
    for group in 0..bodies.groups.len() {
        let points = bodies.points_of(group);
        if is_all_new || is_changed(points) {
            bodies.around[group] = seen.bound(points.iter().copied(), margin);
        }
    }
    bodies.refit();
    list.retain(|candidate| !is_changed(&candidate.points));
    again.clear();
    let strays = (0..).zip(&*strayed).filter(|(_, strayed)| **strayed).map(|(row, _)| row);
    again.extend(strays.filter(|&row| bodies.stars.has(row)));
    let chunks = again.len().div_ceil(POINTS_PER_TASK);
    tasks.resize_with(tasks.len().max(chunks), Mutex::default);
    let view = Search { bodies, cloths, terms, strayed, seen, margin };
    team.phase(chunks, |task| {
        // Nobody else has it: a task is done once.
        let Ok(mut found) = tasks[task].lock() else { return };
        found.list.clear();
        found.locals.forget();
        let end = ((task + 1) * POINTS_PER_TASK).min(again.len());
        again[task * POINTS_PER_TASK..end].iter().for_each(|&point| view.around(point, &mut found));
    });
    for found in tasks[..chunks].iter_mut().filter_map(|task| task.get_mut().ok()) {
        list.append(&mut found.list);
    }
    strayed.fill(false);
}

impl<R: Real> Search<'_, R> {
    /// Everything that meets what is new about a point.
    fn around(&self, point: u32, found: &mut Found) {
        let Some(tree) = &self.bodies.tree else { return };
        let Found { list, sought, locals } = found;
        sought.look(self, point);
        tree.query(&sought.all[0].union(sought.all[1]), |group| {
            if Aabb::may_meet(&sought.all, &self.bodies.around[group as usize]) {
                sought.meet(self, group, locals.of(self, group), list);
            }
        });
    }

    /// A group's elements, and the skin that they are of.
    pub(super) fn elements(&self, group: u32) -> (&Skin, &Group) {
        let body = &self.bodies.groups[group as usize];
        (&self.cloths[body.cloth as usize].skin, &body.group)
    }

    /// The boxes round all that is foreseen for some points, with half of the largest distance that is kept.
    #[inline(always)]
    pub(super) fn bound(&self, points: impl Iterator<Item = u32>) -> Boxes {
        self.seen.bound(points, self.margin)
    }
}
