//! Broad-phase query of one element group against others: tests rows of swept boxes.

use crate::contact::box_row::BoxRow;
use crate::contact::cloth::elements::NewBounds;
use crate::contact::cloth::found_contacts::FoundContacts;
use crate::contact::cloth::near_pairs::ClothPair;
use crate::contact::cloth::new_elements::{NewElement, NewElements, NewRow};
use crate::contact::cloth::search::SearchedGroup;
use crate::contact::cloth::swept_points::ElementPoints;
use crate::input::frame::Elements;
use crate::math::Real;

impl<R: Real> ClothPair<'_, R> {
    /// Finds all overlapping boxes of a group's elements that have new bounds with the elements of another group. Where both
    /// elements have new bounds, the pair is found once: from the point in point-edge and point-face pairs, from the lower
    /// index in others.
    pub(super) fn test_boxes(
        &self,
        (ours, new): (&SearchedGroup<'_>, &NewElements),
        theirs: &SearchedGroup<'_>,
        found: &mut FoundContacts<R>,
    ) {
        let groups = GroupPair { ours, new, theirs, pair: self };
        // A group without faces is points, whatever the cloth's element type.
        let element_type =
            |is_free: bool, elements: Elements| if is_free { Elements::Points } else { elements };
        let our_type = element_type(ours.is_free(), self.material.elements[0]);
        let their_type = element_type(theirs.is_free(), self.material.elements[1]);
        let FoundContacts { point_face, edge_edge, point_edge, point_point, .. } = found;
        let (point_face, point_edge) = (&mut point_face.overlapping, &mut point_edge.overlapping);
        let (edges, triangles) = (&theirs.bounds.edges, &theirs.bounds.triangles);
        match their_type {
            Elements::Points if our_type == Elements::Points => {
                groups.points_against_points(&mut point_point.overlapping);
            }
            Elements::Points => {}
            Elements::Edges => groups.points_against_elements((theirs.edges, edges), point_edge),
            Elements::Faces => groups.points_against_elements((theirs.triangles, triangles), point_face),
        }
        match our_type {
            Elements::Points => {}
            Elements::Edges => groups.elements_against_points(&new.edges, point_edge),
            Elements::Faces => groups.elements_against_points(&new.triangles, point_face),
        }
        if self.material.edges {
            groups.edges_against_edges(&mut edge_edge.overlapping);
        }
    }
}

/// A group whose elements with new bounds are tested against all of another.
struct GroupPair<'a, R> {
    ours: &'a SearchedGroup<'a>,
    new: &'a NewElements,
    theirs: &'a SearchedGroup<'a>,
    pair: &'a ClothPair<'a, R>,
}

impl<R: Real> GroupPair<'_, R> {
    /// Whether an element of theirs keeps its bounds.
    #[inline(always)]
    fn is_kept(&self, points: &[u32]) -> bool {
        match self.theirs.new_bounds {
            NewBounds::None => true,
            NewBounds::All => false,
            NewBounds::Some => !self.pair.search.has_new_bound(points),
        }
    }

    fn points_against_points(&self, found: &mut Vec<ElementPoints<1, 1>>) {
        self.new.points.for_each_overlap(
            self.theirs.swept_box,
            |&NewElement { points: [p], swept_box, .. }| {
                self.theirs.bounds.points.for_each_overlap(&swept_box, |at| {
                    let q = self.theirs.points[at];
                    let (low, high) = (p.min(q), p.max(q));
                    if q != p && (p == low || self.is_kept(&[q])) {
                        found.push(([low], [high]));
                    }
                });
            },
        );
    }

    /// Our points against their edges or faces.
    fn points_against_elements<const N: usize>(
        &self,
        (elements, boxes): (&[[u32; N]], &BoxRow),
        found: &mut Vec<ElementPoints<1, N>>,
    ) {
        self.new.points.for_each_overlap(
            self.theirs.swept_box,
            |&NewElement { points: [p], swept_box, .. }| {
                boxes.for_each_overlap(&swept_box, |at| {
                    if !elements[at].contains(&p) {
                        found.push(([p], elements[at]));
                    }
                });
            },
        );
    }

    /// Our edges or faces against their points that keep their bounds.
    fn elements_against_points<const N: usize>(
        &self,
        ours: &NewRow<N>,
        found: &mut Vec<ElementPoints<1, N>>,
    ) {
        if self.theirs.new_bounds == NewBounds::All {
            return;
        }
        ours.for_each_overlap(self.theirs.swept_box, |&NewElement { points: element, swept_box, .. }| {
            self.theirs.bounds.points.for_each_overlap(&swept_box, |at| {
                let q = self.theirs.points[at];
                if self.is_kept(&[q]) && !element.contains(&q) {
                    found.push(([q], element));
                }
            });
        });
    }

    fn edges_against_edges(&self, found: &mut Vec<ElementPoints<2, 2>>) {
        let [our_first, their_first] = [self.ours.first_edge, self.theirs.first_edge];
        if self.theirs.new_bounds == NewBounds::All && our_first > their_first {
            return; // every pair is found from theirs
        }
        self.new.edges.for_each_overlap(
            self.theirs.swept_box,
            |&NewElement { points: [a, b], place, swept_box }| {
                let edge = (our_first.0, our_first.1 + place);
                self.theirs.bounds.edges.for_each_overlap(&swept_box, |at| {
                    let [c, d] = self.theirs.edges[at];
                    let is_joined = a == c || a == d || b == c || b == d;
                    if !is_joined && (edge < (their_first.0, their_first.1 + at) || self.is_kept(&[c, d])) {
                        found.push(([a, b], [c, d]));
                    }
                });
            },
        );
    }
}
