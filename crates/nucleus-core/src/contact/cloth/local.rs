//! A group of elements as a search sees it: boxes round what is foreseen for each, side by side.

use super::search::Search;
use crate::contact::aabb::{Aabb, Four, SweptBox};
use crate::math::Real;

/// A group of elements.
#[derive(Debug, Default)]
pub struct Local {
    /// Which; none where this is room for one.
    group: Option<u32>,
    /// Pass its points.
    pub points: Fours,
    /// Pass its edges.
    pub edges: Fours,
    /// Pass its triangles.
    pub triangles: Fours,
    /// Whether something new is foreseen for all points of its elements.
    pub is_all_new: bool,
}

/// Swept boxes, by four.
#[derive(Debug, Default)]
pub struct Fours {
    fours: Vec<Four>,
}

impl Fours {
    /// Puts the boxes of other things in place of all.
    pub fn fill<T>(&mut self, things: &[T], boxes: impl Fn(&T) -> SweptBox) {
        let four = |things: &[T]| {
            let mut four = [[Aabb::EMPTY; 2]; 4];
            four.iter_mut().zip(things).for_each(|(place, thing)| *place = boxes(thing));
            Four::of(&four)
        };
        self.fours.clear();
        self.fours.extend(things.chunks(4).map(four));
    }

    /// Calls `found` with the place of each that something in these boxes may meet.
    #[inline(always)]
    pub fn met_by(&self, boxes: &SweptBox, mut found: impl FnMut(usize)) {
        for (four, all) in self.fours.iter().enumerate() {
            let mut met = all.met_by(boxes);
            while met != 0 {
                found(4 * four + met.trailing_zeros() as usize);
                met &= met - 1;
            }
        }
    }
}

impl Local {
    /// Looks at a group.
    fn look<R: Real>(&mut self, search: &Search<'_, R>, group: u32) {
        let (skin, elements) = search.elements(group);
        let points = &skin.points[elements.points.clone()];
        self.group = Some(group);
        self.triangles.fill(&skin.triangles[elements.triangles.clone()], |corners| search.bound(corners));
        self.edges.fill(&skin.edges[elements.edges.clone()], |ends| search.bound(ends));
        self.points.fill(points, |&point| search.bound(&[point]));
        self.is_all_new =
            search.bodies.points_of(group as usize).iter().all(|&point| search.is_new(&[point]));
    }
}

/// Groups that were looked at a short while ago: neighbours meet the same ones.
#[derive(Debug, Default)]
pub struct Locals {
    places: Vec<Local>,
}

/// How many groups are remembered.
const PLACES: usize = 256;

impl Locals {
    /// Forgets all.
    pub fn forget(&mut self) {
        self.places.resize_with(PLACES, Local::default);
        self.places.iter_mut().for_each(|place| place.group = None);
    }

    /// A group, looked at if it is not remembered.
    pub(super) fn of<R: Real>(&mut self, search: &Search<'_, R>, group: u32) -> &Local {
        let place = &mut self.places[group as usize % PLACES];
        if place.group != Some(group) {
            place.look(search, group);
        }
        place
    }
}
