//! Updates of the pair filter: the exclusions of a frame, and the points that are welded.

use nalgebra::Vector3;

use crate::constraints::link::lists::Links;
use crate::contact::cloth::contacts::ClothContacts;
use crate::contact::system::ContactSystem;
use crate::input::frame::FrameInput;
use crate::math::Real;
use crate::model::Model;
use crate::state::State;

/// Takes up the exclusions of a frame and the points that are welded. Candidates of points that this concerns are
/// searched again.
pub fn update_pair_filter<R: Real>(
    contact: &mut ContactSystem<R>,
    (model, state): (&Model<R>, &State<R>),
    links: &Links<R>,
    frame: &FrameInput,
    links_changed: bool,
) {
    let rows = model.cloths.last().map_or(0, |last| last.blocks.end()) as usize;
    if contact.pair_filter.has_released() && !links_changed {
        keep_released(contact, state, rows);
    }
    if frame.exclusions.is_empty() && !contact.pair_filter.has_exclusions() && !links_changed {
        return;
    }
    let before = contact.pair_filter.clone();
    contact.pair_filter.set_exclusions(&frame.exclusions, &model.cloths, &model.colliders, rows);
    if links_changed {
        contact.pair_filter.set_welds(links.clusters(&model.cloths), links.can_tear());
        keep_released(contact, state, rows);
    }
    let all = contact.pair_filter.differs_in_colliders(&before);
    for row in 0..rows {
        if all || contact.pair_filter.differs_at(&before, row) {
            contact.invalidate_bounds(row);
        }
    }
    // What was excluded until now may be inside a collider.
    for (cloth, model) in model.cloths.iter().enumerate() {
        let excludes_otherwise = |row: u32| contact.pair_filter.excludes_otherwise_at(&before, row as usize);
        if all || model.points().any(excludes_otherwise) {
            let of_cloth = contact.lists_of(cloth);
            contact.collider_contacts[of_cloth].iter_mut().for_each(|list| list.depenetration.begin_again());
        }
    }
    // What was welded and excluded until now may intersect.
    if let Some(cloth_contacts) = contact.cloth_contacts.as_mut().filter(|_| links_changed) {
        for (is_due, model) in cloth_contacts.untangling.is_search_due.iter_mut().zip(&model.cloths) {
            *is_due |= model.points().any(|row| contact.pair_filter.differs_at(&before, row as usize));
        }
    }
}

/// Forgets the pairs that have come apart since their welds were released: they keep their contact thickness from now on.
fn keep_released<R: Real>(contact: &mut ContactSystem<R>, state: &State<R>, rows: usize) {
    let ContactSystem { cloth_contacts, pair_filter, .. } = contact;
    let is_near = |[a, b]: [u32; 2]| {
        let Some(ClothContacts { elements, materials, .. }) = &*cloth_contacts else { return false };
        let [ours, theirs] = [a, b].map(|row| elements.cloth[row as usize] as usize);
        let thickness = materials[[ours, theirs]].as_ref().map(|material| material.thickness);
        let apart = Vector3::from(state.position(a)) - Vector3::from(state.position(b));
        // Rows of particles have other particles later.
        ![a, b].iter().any(|row| elements.is_free_point[*row as usize])
            && thickness.is_none_or(|thickness| apart.norm() < thickness)
    };
    pair_filter.keep_released(rows, is_near);
}
