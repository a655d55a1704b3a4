//! Updates of the pair filter: the exclusions of a frame, and the points that are welded.

use crate::constraints::link::lists::Links;
use crate::contact::system::ContactSystem;
use crate::input::frame::FrameInput;
use crate::math::Real;
use crate::model::Model;

/// Takes up the exclusions of a frame and the points that are welded. Candidates of points that this concerns are
/// searched again.
pub fn update_pair_filter<R: Real>(
    contact: &mut ContactSystem<R>,
    model: &Model<R>,
    links: &Links<R>,
    frame: &FrameInput,
    links_changed: bool,
) {
    if frame.exclusions.is_empty() && !contact.pair_filter.has_exclusions() && !links_changed {
        return;
    }
    let before = contact.pair_filter.clone();
    let rows = model.cloths.last().map_or(0, |last| last.blocks.end()) as usize;
    contact.pair_filter.set_exclusions(&frame.exclusions, &model.cloths, &model.colliders, rows);
    if links_changed {
        contact.pair_filter.set_welds(links.clusters(&model.cloths), links.can_tear());
    }
    let all = contact.pair_filter.differs_in_colliders(&before);
    for row in 0..rows {
        if all || contact.pair_filter.differs_at(&before, row) {
            contact.invalidate_bounds(row);
        }
    }
    // What was welded and excluded until now may intersect.
    if let Some(cloth_contacts) = contact.cloth_contacts.as_mut().filter(|_| links_changed) {
        for (is_due, model) in cloth_contacts.untangling.is_search_due.iter_mut().zip(&model.cloths) {
            *is_due |= model.points().any(|row| contact.pair_filter.differs_at(&before, row as usize));
        }
    }
}
