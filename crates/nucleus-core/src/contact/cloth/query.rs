//! Broad-phase query of one element group against others: tests rows of swept boxes, then creates contacts.

use crate::contact::box_row::BoxRow;
use crate::contact::ccd::CERTIFIED_GAP;
use crate::contact::cloth::contact::{Candidate, ContactKind, ContactParams};
use crate::contact::cloth::element_bounds::ContactDistance;
use crate::contact::cloth::elements::NewBounds;
use crate::contact::cloth::found_contacts::{FoundContacts, FoundPairs};
use crate::contact::cloth::new_elements::{NewElement, NewElements, NewRow};
use crate::contact::cloth::normals::set_normals;
use crate::contact::cloth::search::{ClothSearch, SearchInput, SearchedGroup};
use crate::contact::cloth::swept_points::ElementPoints;
use crate::contact::material::{ContactMaterial, MIN_THICKNESS};
use crate::contact::narrow_phase::shortest_line;
use crate::input::frame::Elements;
use crate::math::{Real, add};

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

    /// The narrow phase: contacts of the pairs whose boxes overlap.
    pub(super) fn find_contacts(&self, found: &mut FoundContacts<R>) {
        self.find_contacts_of(&mut found.point_face);
        self.find_contacts_of(&mut found.edge_edge);
        self.find_contacts_of(&mut found.point_edge);
        self.find_contacts_of(&mut found.point_point);
    }

    fn find_contacts_of<const N: usize, const M: usize>(&self, found: &mut FoundPairs<R, N, M>) {
        let FoundPairs { candidates, overlapping, .. } = found;
        let known = candidates.len();
        let [thickness, range] = self.thickness_and_range;
        let (points, share) = (self.search.bounds.swept_points(), self.search.input.interval_share as f32);
        let mut near = 0;
        for first in (0..overlapping.len()).step_by(4) {
            let count = (overlapping.len() - first).min(4);
            let separated =
                points.separated_centroids(&overlapping[first..first + count], share, thickness * range);
            for lane in (0..count).filter(|lane| separated & (1 << lane) == 0) {
                overlapping[near] = overlapping[first + lane];
                near += 1;
            }
        }
        for four in overlapping[..near].chunks(4) {
            let least = points.min_distances(four, share);
            candidates.extend((0..four.len()).filter_map(|lane| self.contact(four[lane], least[lane])));
        }
        overlapping.clear();
        // In a loop of its own: within the one above it makes a frame of falling cloth 4 % slower.
        let SearchInput { anchors, displacement: [start, _], .. } = self.search.input;
        candidates[known..].chunks_mut(4).for_each(|four| set_normals(four, anchors, start));
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

/// Two cloths, or one and itself, and their contact material.
pub(super) struct ClothPair<'a, R> {
    search: &'a ClothSearch<'a, R>,
    material: &'a ContactMaterial<R>,
    /// Contact thickness in metres, and interaction range in thicknesses.
    thickness_and_range: [f32; 2],
    /// Positions at rest, where elements can be neighbours.
    rest: Option<&'a [[f32; 3]]>,
}

impl<'a, R: Real> ClothPair<'a, R> {
    /// `None` where the two do not collide.
    pub(super) fn new(search: &'a ClothSearch<'a, R>, cloths: [usize; 2]) -> Option<Self> {
        let material = search.materials[cloths[0] * search.input.cloths.len() + cloths[1]].as_ref()?;
        // Free points have no shape at rest, so they have no neighbours.
        let is_shaped =
            cloths[0] == cloths[1] && !search.input.cloths[cloths[0]].boundary.triangles.is_empty();
        Some(Self {
            search,
            material,
            thickness_and_range: [material.thickness as f32, material.adhesion_range as f32],
            rest: is_shaped.then_some(&search.elements.rest_positions[..]),
        })
    }

    /// The contact distance in metres of two elements that coincide at rest and may have been torn from each other: their
    /// distance at the start of the step, so that they can part and not pass. Zero where they touch: what intersects is
    /// untangled.
    #[cold]
    fn torn_distance<const N: usize, const M: usize>(&self, (ours, theirs): ElementPoints<N, M>) -> f32 {
        let SearchInput { filter, anchors, displacement: [start, _], .. } = self.search.input;
        if !filter.tears() || filter.are_joined(&ours, &theirs) {
            return 0.0;
        }
        let place = |point: u32| add(anchors[point as usize], start[point as usize].xyz().map(R::to_f64));
        let (_, _, distance) = shortest_line((ours.map(place), theirs.map(place)));
        let is_apart = distance > MIN_THICKNESS * CERTIFIED_GAP;
        if is_apart { distance.max(MIN_THICKNESS) as f32 } else { 0.0 }
    }

    /// The contact of two elements that stay at least `least` metres apart, if they can touch.
    #[inline]
    fn contact<const N: usize, const M: usize>(
        &self,
        points: ElementPoints<N, M>,
        least: f32,
    ) -> Option<Candidate<R, N, M>> {
        let ClothSearch { input, untangling, elements, .. } = self.search;
        let torn = || self.torn_distance(points);
        let distance = ContactDistance::new(points, least, self.thickness_and_range, self.rest, torn)?;
        let [ours, theirs] = [points.0[0], points.1[0]].map(|point| elements.cloth[point as usize]);
        if untangling.is_disabled(&points.0, &points.1, [ours, theirs])
            || input.filter.excludes(&points.0, &points.1)
        {
            return None;
        }
        let is_free = |point: u32| elements.is_free_point[point as usize];
        let has_free_point = (N == 1 && is_free(points.0[0])) || (M == 1 && is_free(points.1[0]));
        let kind = ContactKind::of_material(ours * input.cloths.len() as u32 + theirs)
            .with(ContactKind::REST_LIMITED, distance.rest_limited)
            .with(ContactKind::CERTIFIED, distance.certified)
            .with(ContactKind::HAS_FREE_POINT, has_free_point);
        let params = ContactParams { thickness: R::from_f64(f64::from(distance.thickness)), kind };
        Some(Candidate { points, normal: [R::ZERO; 3], params })
    }
}
