//! A small group of elements as a search sees it: boxes round what is foreseen for each, and which are new.

use super::search::Search;
use crate::collision::tree::Aabb;
use crate::scalar::Real;

/// A group of elements.
#[derive(Debug)]
pub struct Local {
    /// Which; none where this is room for one.
    pub group: Option<u32>,
    /// Round all elements, at the start and at the end of what is foreseen.
    pub all: [Aabb; 2],
    /// Round those that are new.
    pub new: [Aabb; 2],
    /// Its points.
    pub points: Kind,
    /// Its edges.
    pub edges: Kind,
    /// Its triangles.
    pub triangles: Kind,
}

/// Elements of one kind in a group.
#[derive(Debug, Default)]
pub struct Kind {
    /// Round each, at the start and at the end of what is foreseen.
    pub boxes: Vec<[Aabb; 2]>,
    /// Whether something new is foreseen for a point of it.
    pub is_new: Vec<bool>,
}

impl Default for Local {
    fn default() -> Self {
        let nothing = [Aabb::EMPTY; 2];
        let [points, edges, triangles] = [(); 3].map(|()| Kind::default());
        Self { group: None, all: nothing, new: nothing, points, edges, triangles }
    }
}

impl Local {
    /// Looks at a group.
    pub(super) fn look<R: Real>(&mut self, search: &Search<'_, R>, group: u32) {
        let (skin, elements) = search.elements(group);
        *self =
            Self { group: Some(group), all: [Aabb::EMPTY; 2], new: [Aabb::EMPTY; 2], ..std::mem::take(self) };
        let Self { all, new, points, edges, triangles, .. } = self;
        let mut around = |kind: &mut Kind, element: &[u32]| {
            let bound = search.seen.bound(element.iter().copied(), search.margin);
            let is_new = element.iter().any(|&point| search.strayed[point as usize]);
            kind.boxes.push(bound);
            kind.is_new.push(is_new);
            for end in 0..2 {
                all[end] = all[end].union(bound[end]);
                new[end] = if is_new { new[end].union(bound[end]) } else { new[end] };
            }
        };
        [&mut *points, &mut *edges, &mut *triangles].into_iter().for_each(Kind::clear);
        skin.triangles[elements.triangles.clone()].iter().for_each(|corners| around(triangles, corners));
        skin.edges[elements.edges.clone()].iter().for_each(|ends| around(edges, ends));
        skin.points[elements.points.clone()].iter().for_each(|&point| around(points, &[point]));
    }
}

impl Kind {
    fn clear(&mut self) {
        self.boxes.clear();
        self.is_new.clear();
    }
}

/// Groups that were looked at a short while ago: neighbours meet the same ones.
#[derive(Debug, Default)]
pub struct Locals {
    places: Vec<Local>,
}

/// How many groups are remembered.
const PLACES: usize = 128;

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
