//! Broad phase among cloths: finds the pairs of elements that can touch while every point keeps to what is foreseen for it
//! in a span. Where points stray, only the pairs of their elements are looked for again.

use std::sync::RwLock;

use super::Mutual;
use super::active::Found;
use super::bodies::Bodies;
use super::crossings::find_crossings;
use super::local::Locals;
use super::seen::Seen;
use super::sought::Sought;
use super::tangle::Tangle;
use crate::contact::aabb::{Aabb, SweptBox};
use crate::contact::skin::{Group, Skin};
use crate::contact::terms::Terms;
use crate::math::{Real, Row4};
use crate::model::ClothModel;
use crate::parallel::thread_pool::ThreadPool;

/// Room to search in.
#[derive(Debug)]
pub struct Room<R> {
    seen: Seen,
    /// The groups that something new is foreseen for.
    groups: Vec<u32>,
    tasks: Vec<RwLock<Task<R>>>,
}

/// What one task finds, and what it looks at on the way.
#[derive(Debug)]
pub(super) struct Task<R> {
    pub(super) found: Found<R>,
    sought: Sought,
    locals: Locals,
}

impl<R> Default for Task<R> {
    fn default() -> Self {
        Self { found: Found::default(), sought: Sought::default(), locals: Locals::default() }
    }
}

impl<R> Default for Room<R> {
    fn default() -> Self {
        Self { seen: Seen::default(), groups: Vec::new(), tasks: Vec::new() }
    }
}

/// When and where is searched.
#[derive(Clone, Copy)]
pub struct Look<'a, R> {
    /// The cloths.
    pub cloths: &'a [ClothModel<R>],
    /// Anchors in metres.
    pub anchors: &'a [[f64; 3]],
    /// Displacements at the start and at the end of the time step.
    pub moved: [&'a [Row4<R>]; 2],
    /// The start of the time step, as a share of the span.
    pub begun: f64,
    /// A factor on the collide strength of each point; none where no cloth has a map of it.
    pub strength: &'a [R],
}

/// Groups per task.
const PER_TASK: usize = 64;

/// All that a search looks at.
pub(super) struct Search<'a, R> {
    pub(super) bodies: &'a Bodies,
    pub(super) terms: &'a [Option<Terms<R>>],
    pub(super) seen: &'a Seen,
    pub(super) tangle: &'a Tangle,
    pub(super) look: Look<'a, R>,
    strayed: &'a [bool],
    /// Half of the largest distance that is kept.
    margin: f32,
}

/// Finds the contacts of all elements that have a point that strayed from what was foreseen for it; of all, as a span begins.
pub fn search<R: Real>(mutual: &mut Mutual<R>, look: Look<'_, R>, is_late: bool, pool: &ThreadPool) {
    let widest = mutual.terms.iter().flatten().map(|terms| terms.thickness * terms.reach).fold(0.0, f64::max);
    let margin = widest as f32 * 0.5 * (1.0 + 1e-5);
    mutual.look_ahead(look.anchors, margin, is_late);
    if !is_late && mutual.tangle.may_be_there() {
        find_crossings(mutual, &look);
    }
    let Mutual { bodies, terms, strayed, room, active, tangle, .. } = mutual;
    let Room { seen, groups, tasks } = room;
    let chunks = groups.len().div_ceil(PER_TASK);
    tasks.resize_with(tasks.len().max(chunks), RwLock::default);
    let view = Search { bodies, terms, seen, tangle, look, strayed, margin };
    pool.parallel_for(chunks, |task| {
        // Nobody else has it: a task is done once.
        let Ok(mut own) = tasks[task].write() else { return };
        own.found.clear();
        own.locals.forget();
        let end = ((task + 1) * PER_TASK).min(groups.len());
        groups[task * PER_TASK..end].iter().for_each(|&group| view.around(group, &mut own));
    });
    active.renew(&tasks[..chunks], strayed, is_late, (&bodies.block, bodies.blocks), pool);
    strayed.fill(false);
}

impl<R: Real> Mutual<R> {
    /// Sees where points go, and what is round the groups that have them: those that strayed, or all as a span begins.
    fn look_ahead(&mut self, anchors: &[[f64; 3]], margin: f32, is_late: bool) {
        let Self { bodies, strayed, room, paths, .. } = self;
        let Room { seen, groups, .. } = room;
        let strays = (0..).zip(&*strayed).filter(|(_, strayed)| **strayed).map(|(point, _)| point);
        bodies.groups_of(strays.clone(), groups);
        if is_late {
            seen.look(anchors, paths, strays);
            groups.iter().for_each(|&group| bodies.look(group, seen, margin));
        } else {
            seen.look(anchors, paths, 0..anchors.len() as u32);
            (0..bodies.groups.len() as u32).for_each(|group| bodies.look(group, seen, margin));
        }
        bodies.refit();
    }
}

impl<R: Real> Search<'_, R> {
    /// Everything that meets what is new about a group.
    fn around(&self, group: u32, task: &mut Task<R>) {
        let Some(tree) = &self.bodies.tree else { return };
        let Task { found, sought, locals } = task;
        let all = sought.look(self, group);
        tree.query(&all[0].union(all[1]), |other| {
            if Aabb::may_meet(&all, &self.bodies.around[other as usize]) {
                sought.meet(self, other, locals.of(self, other), found);
            }
        });
    }

    /// A group's elements, and the skin that they are of.
    pub(super) fn elements(&self, group: u32) -> (&Skin, &Group) {
        let body = &self.bodies.groups[group as usize];
        (&self.look.cloths[body.cloth as usize].skin, &body.group)
    }

    /// The boxes round all that is foreseen for some points, with half of the largest distance that is kept.
    #[inline(always)]
    pub(super) fn bound(&self, points: &[u32]) -> SweptBox {
        self.seen.bound(points, self.margin)
    }

    /// Whether something new is foreseen for any of these points.
    #[inline(always)]
    pub(super) fn is_new(&self, points: &[u32]) -> bool {
        points.iter().any(|&point| self.strayed[point as usize])
    }
}
