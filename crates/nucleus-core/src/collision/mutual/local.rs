//! A small group of elements as a search sees it: boxes round what is foreseen for each.

use super::search::Search;
use crate::collision::tree::Aabb;
use crate::scalar::Real;

/// Boxes round something at the start and at the end of what is foreseen.
pub type Boxes = [Aabb; 2];

/// A group of elements.
#[derive(Debug, Default)]
pub struct Local {
    /// Which; none where this is room for one.
    group: Option<u32>,
    /// Round its points.
    pub points: Vec<Boxes>,
    /// Round its edges.
    pub edges: Vec<Boxes>,
    /// Round its triangles.
    pub triangles: Vec<Boxes>,
}

impl Local {
    /// Looks at a group.
    fn look<R: Real>(&mut self, search: &Search<'_, R>, group: u32) {
        let (skin, elements) = search.elements(group);
        let bound = |element: &[u32]| search.bound(element.iter().copied());
        let Self { group: which, points, edges, triangles } = self;
        *which = Some(group);
        [&mut *points, &mut *edges, &mut *triangles].into_iter().for_each(Vec::clear);
        triangles.extend(skin.triangles[elements.triangles.clone()].iter().map(|corners| bound(corners)));
        edges.extend(skin.edges[elements.edges.clone()].iter().map(|ends| bound(ends)));
        points.extend(skin.points[elements.points.clone()].iter().map(|&point| bound(&[point])));
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
