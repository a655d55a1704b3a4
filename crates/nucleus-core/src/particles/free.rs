//! Free points: particles without links that touch no other cloth depend on nothing but colliders and the ground.
//!
//! All stages of a time step are applied to a run of them before the next run begins ([`free_run`](super::free_run)), so that
//! their columns are read and written once. What only contact needs stands in the buffers of a task, and what outlasts the
//! step is collected from the tasks in their order.

use crate::constraints::link::lists::Links;
use crate::contact::system::ContactSystem;
use crate::contact::time_step::ContactCounters;
use crate::input::frame::FrameInput;
use crate::input::links::Link;
use crate::math::{Real, Row4};
use crate::model::Model;
use crate::parallel::thread_pool::ThreadPool;
use crate::particles::free_pass::FreePass;
use crate::schedule::TimeStep;
use crate::state::State;

/// Blocks of a task.
const BLOCKS_PER_TASK: usize = 8;

/// Marks the objects of free points in this frame. Makes the columns that others need.
pub fn find_free_objects<R: Real>(
    model: &Model<R>,
    state: &mut State<R>,
    contact: &mut ContactSystem<R>,
    links: &Links<R>,
    frame: &FrameInput,
) {
    let is_linked = linked_cloths(links, frame, model.cloths.len());
    for cloth in 0..model.cloths.len() {
        contact.is_free[cloth] = !is_linked[cloth] && is_free(model, contact, frame, cloth);
    }
    contact.free_gap = f64::INFINITY;
    contact.begin_lists(model, state.anchor.len());
    if contact.is_free.contains(&false) {
        state.predicted.resize(state.anchor.len(), Row4::ZERO);
    }
}

/// Whether the points of an object depend on nothing but colliders and the ground.
fn is_free<R: Real>(model: &Model<R>, contact: &ContactSystem<R>, frame: &FrameInput, cloth: usize) -> bool {
    let (object, settings) = (&model.cloths[cloth], &frame.cloths[cloth]);
    let rows = object.stretch.len() + object.shear.len() + object.bend.len() + object.bend_six.len();
    let is_attracted = frame.input_meshes.iter().any(|mesh| mesh.cloth.index() == cloth);
    let touches_cloth = contact.cloth_contacts.as_ref().is_some_and(|contacts| contacts.touches(cloth));
    let is_tied = settings.liquid.is_some() || settings.tethers.is_some() || !frame.exclusions.is_empty();
    let has_shape = !object.boundary.triangles.is_empty() || object.has_faces || object.shape.shells() > 0;
    let is_plain = !has_shape && rows == 0;
    is_plain && !is_tied && !is_attracted && !touches_cloth
}

/// Whether each cloth has links in this frame.
fn linked_cloths<R: Real>(links: &Links<R>, frame: &FrameInput, cloths: usize) -> Vec<bool> {
    let mut is_linked = vec![false; cloths];
    let mut mark = |link: &Link| link.cloths().for_each(|cloth| is_linked[cloth] = true);
    for (at, settings) in frame.constraints.iter().enumerate() {
        let before = links.constraints.get(at).map_or(&[][..], |own| &own.links);
        settings.formed.as_deref().unwrap_or(before).iter().for_each(&mut mark);
    }
    is_linked
}

/// Applies a time step to all free points.
pub fn advance_free_points<R: Real>(
    (model, state, contact): (&Model<R>, &mut State<R>, &mut ContactSystem<R>),
    now: &TimeStep<'_, R>,
    counters: &mut ContactCounters,
    pool: &ThreadPool,
) {
    for cloth in 0..model.cloths.len() {
        if contact.is_free[cloth] {
            advance_object(cloth, (model, &mut *state, &mut *contact), now, counters, pool);
        }
    }
}

/// Applies a time step to the points of one object.
fn advance_object<R: Real>(
    cloth: usize,
    (model, state, contact): (&Model<R>, &mut State<R>, &mut ContactSystem<R>),
    now: &TimeStep<'_, R>,
    counters: &mut ContactCounters,
    pool: &ThreadPool,
) {
    let blocks = &model.cloths[cloth].blocks;
    let tasks = blocks.len().div_ceil(BLOCKS_PER_TASK);
    begin_colliders(cloth, model, contact, now, pool);
    contact.free_tasks.resize_with(contact.free_tasks.len().max(tasks), Default::default);
    let pass = FreePass::new(cloth, (model, &mut *state, &*contact), now);
    pool.parallel_for(tasks, |task| {
        // Uncontended: a task runs once.
        let Ok(mut near) = contact.free_tasks[task].lock() else { return };
        let last = blocks.len().min((task + 1) * BLOCKS_PER_TASK) - 1;
        pass.advance(blocks.range(task * BLOCKS_PER_TASK).start..blocks.range(last).end, &mut near);
    });
    collect_results(cloth, tasks, (state, contact), counters);
}

/// Fits the boxes of the colliders that an object is near, and forgets points inside those that let them stay there.
fn begin_colliders<R: Real>(
    cloth: usize,
    model: &Model<R>,
    contact: &mut ContactSystem<R>,
    now: &TimeStep<'_, R>,
    pool: &ThreadPool,
) {
    for at in contact.lists_of(cloth) {
        let collider = contact.collider_contacts[at].collider;
        let material = contact.collider_materials_of(cloth)[collider];
        let list = &mut contact.collider_contacts[at];
        let Some(material) = material else {
            list.depenetration.clear();
            continue;
        };
        if list.is_near {
            let times = now.span.times();
            contact.collider_states[collider].fit_boxes(&model.colliders[collider], times, pool);
        }
        if !material.depenetrates {
            list.depenetration.clear();
        }
    }
}

/// Collects what outlasts the time step from the tasks of an object: counters, the colliders that points have come near,
/// the points inside colliders, and those that contact has displaced without velocity.
fn collect_results<R: Real>(
    cloth: usize,
    tasks: usize,
    (state, contact): (&mut State<R>, &mut ContactSystem<R>),
    counters: &mut ContactCounters,
) {
    let lists = contact.lists_of(cloth);
    let ContactSystem { collider_contacts, collider_materials, free_tasks, free_gap, .. } = contact;
    let lists = &mut collider_contacts[lists];
    for list in lists.iter_mut() {
        // A collider that is not near has not been tested.
        let material = collider_materials[[cloth, list.collider]].as_ref().filter(|_| list.is_near);
        list.depenetration.begin_points(material);
    }
    for near in free_tasks[..tasks].iter_mut().filter_map(|task| task.get_mut().ok()) {
        counters.add(&near.counters);
        *free_gap = free_gap.min(near.min_gap);
        near.approached.iter().for_each(|&at| lists[at].is_near = true);
        for &(at, point, face) in &near.inside {
            lists[at].depenetration.points.push((point, face));
        }
        state.displaced.extend_from_slice(&near.displaced);
    }
}
