//! Swept boxes of the elements of a group, and a cache of them.

use crate::contact::box_row::BoxRow;
use crate::contact::cloth::search::ClothSearch;
use crate::math::Real;

/// Boxes of the elements of a group.
#[derive(Debug, Default)]
pub struct GroupBounds {
    /// The group; `None` in an empty slot.
    group: Option<u32>,
    /// Boxes of its points.
    pub points: BoxRow,
    /// Boxes of its edges.
    pub edges: BoxRow,
    /// Boxes of its triangles.
    pub triangles: BoxRow,
    /// Whether all of its points have new bounds.
    pub all_have_new_bounds: bool,
}

impl GroupBounds {
    /// Fills the boxes of a group.
    fn fill_group<R: Real>(&mut self, search: &ClothSearch<'_, R>, group: u32) {
        let (boundary, elements) = search.elements(group);
        let points = &boundary.points[elements.points.clone()];
        self.group = Some(group);
        self.triangles.fill(&boundary.triangles[elements.triangles.clone()], |corners| search.bound(corners));
        self.edges.fill(&boundary.edges[elements.edges.clone()], |ends| search.bound(ends));
        self.points.fill(points, |&point| search.bound(&[point]));
        self.all_have_new_bounds =
            search.elements.points_of(group as usize).iter().all(|&point| search.has_new_bound(&[point]));
    }
}

/// A direct-mapped cache of groups: neighbours query the same ones.
#[derive(Debug, Default)]
pub struct GroupBoundsCache {
    slots: Vec<GroupBounds>,
}

/// Slots of the cache.
const CACHE_SIZE: usize = 256;

impl GroupBoundsCache {
    /// Empties the cache.
    pub fn clear(&mut self) {
        self.slots.resize_with(CACHE_SIZE, GroupBounds::default);
        self.slots.iter_mut().for_each(|slot| slot.group = None);
    }

    /// The boxes of a group, filled on a cache miss.
    pub(super) fn of<R: Real>(&mut self, search: &ClothSearch<'_, R>, group: u32) -> &GroupBounds {
        let slot = &mut self.slots[group as usize % CACHE_SIZE];
        if slot.group != Some(group) {
            slot.fill_group(search, group);
        }
        slot
    }
}
