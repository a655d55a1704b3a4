//! The elements of a group that have new motion bounds, with their swept boxes: the ones that a search tests against
//! other groups. Where few points of a group violate their bounds, they are a small part of it.

use crate::contact::box_row::BoxRow;
use crate::contact::bvh::{Aabb, SweptBox};
use crate::contact::cloth::local_origins::OriginShift;
use crate::contact::cloth::search::{ClothSearch, SearchedGroup};
use crate::math::Real;

/// The points, edges and triangles of a group that have new bounds.
#[derive(Debug)]
pub(super) struct NewElements {
    pub(super) points: NewRow<1>,
    pub(super) edges: NewRow<2>,
    pub(super) triangles: NewRow<3>,
    /// Swept box of all of them.
    pub(super) swept_box: SweptBox,
}

/// Elements of one kind, in the order of their group.
#[derive(Debug, Default)]
pub(super) struct NewRow<const N: usize> {
    elements: Vec<NewElement<N>>,
    boxes: BoxRow,
}

/// One element with a new bound.
#[derive(Debug, Clone, Copy)]
pub(super) struct NewElement<const N: usize> {
    pub(super) points: [u32; N],
    /// Its place among the elements of its kind in the group.
    pub(super) place: usize,
    pub(super) swept_box: SweptBox,
}

impl Default for NewElements {
    fn default() -> Self {
        let (points, edges, triangles) = Default::default();
        Self { points, edges, triangles, swept_box: [Aabb::EMPTY; 2] }
    }
}

impl NewElements {
    /// Takes up the elements of a group that have a point with a new bound.
    pub(super) fn fill<R: Real>(&mut self, search: &ClothSearch<'_, R>, group: &SearchedGroup<'_>) {
        let Self { points, edges, triangles, swept_box } = self;
        let margin = search.margins[group.first_edge.0];
        points.fill(search, margin, group.points.as_chunks().0);
        edges.fill(search, margin, group.edges);
        triangles.fill(search, margin, group.triangles);
        *swept_box = [Aabb::EMPTY; 2];
        points.unite(swept_box);
        edges.unite(swept_box);
        triangles.unite(swept_box);
    }

    /// Takes up the elements of another, relative to another origin and inflated by a margin.
    pub(super) fn fill_shifted(&mut self, from: &Self, shift: &OriginShift, margin: f32) {
        let Self { points, edges, triangles, swept_box } = self;
        points.fill_shifted(&from.points, shift, margin);
        edges.fill_shifted(&from.edges, shift, margin);
        triangles.fill_shifted(&from.triangles, shift, margin);
        *swept_box = shift.apply(&from.swept_box, margin);
    }
}

impl<const N: usize> NewRow<N> {
    fn fill<R: Real>(&mut self, search: &ClothSearch<'_, R>, margin: f32, elements: &[[u32; N]]) {
        self.elements.clear();
        for (place, &points) in elements.iter().enumerate() {
            if search.has_new_bound(&points) {
                let swept_box = search.bounds.bound(&points, margin);
                self.elements.push(NewElement { points, place, swept_box });
            }
        }
        self.boxes.fill(&self.elements, |element| element.swept_box);
    }

    fn fill_shifted(&mut self, from: &Self, shift: &OriginShift, margin: f32) {
        self.elements.clear();
        let shifted = |element: &NewElement<N>| NewElement {
            swept_box: shift.apply(&element.swept_box, margin),
            ..*element
        };
        self.elements.extend(from.elements.iter().map(shifted));
        self.boxes.fill(&self.elements, |element| element.swept_box);
    }

    fn unite(&self, [start, end]: &mut SweptBox) {
        for NewElement { swept_box, .. } in &self.elements {
            (*start, *end) = (start.union(swept_box[0]), end.union(swept_box[1]));
        }
    }

    /// Calls `found` with each element that may overlap a box.
    #[inline(always)]
    pub(super) fn for_each_overlap(&self, theirs: &SweptBox, mut found: impl FnMut(&NewElement<N>)) {
        self.boxes.for_each_overlap(theirs, |at| found(&self.elements[at]));
    }
}
