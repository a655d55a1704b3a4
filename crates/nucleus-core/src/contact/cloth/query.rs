//! Broad-phase query of one element group against others: tests rows of swept boxes, then creates contacts.

use crate::contact::box_row::BoxRow;
use crate::contact::bvh::SweptBox;
use crate::contact::cloth::contact::{Candidate, ContactParams};
use crate::contact::cloth::element_bounds::ElementPoints;
use crate::contact::cloth::search::{ClothSearch, SearchedGroup};
use crate::contact::material::ContactMaterial;
use crate::input::frame::Elements;
use crate::math::Real;

/// The candidates that a search task finds.
#[derive(Debug)]
pub struct FoundContacts<R> {
    /// Points and faces.
    pub point_face: Vec<Candidate<R, 1, 3>>,
    /// Edges and edges.
    pub edge_edge: Vec<Candidate<R, 2, 2>>,
    /// Points and edges.
    pub point_edge: Vec<Candidate<R, 1, 2>>,
    /// Points and points.
    pub point_point: Vec<Candidate<R, 1, 1>>,
}

impl<R> Default for FoundContacts<R> {
    fn default() -> Self {
        Self {
            point_face: Vec::new(),
            edge_edge: Vec::new(),
            point_edge: Vec::new(),
            point_point: Vec::new(),
        }
    }
}

impl<R> FoundContacts<R> {
    /// Removes all, keeps the capacity.
    pub fn clear(&mut self) {
        self.point_face.clear();
        self.edge_edge.clear();
        self.point_edge.clear();
        self.point_point.clear();
    }
}

impl<R: Real> ClothSearch<'_, R> {
    /// Finds all contacts of a group's elements that have new bounds with the elements of another group. Where both elements
    /// have new bounds, the contact is found once: from the point in point-edge and point-face pairs, from the lower index
    /// in others.
    pub(super) fn find_contacts(&self, ours: &SearchedGroup<'_>, other: u32, found: &mut FoundContacts<R>) {
        let theirs = self.group(other);
        let Some(pair) = ClothPair::new(self, [ours.first_edge.0, theirs.first_edge.0]) else { return };
        let groups =
            GroupPair { ours, theirs: &theirs, all_new: self.all_have_new_bounds(other), pair: &pair };
        // A group without faces is points, whatever the cloth's element type.
        let element_type =
            |is_free: bool, elements: Elements| if is_free { Elements::Points } else { elements };
        let our_type = element_type(ours.is_free(), pair.material.elements[0]);
        let their_type = element_type(theirs.is_free(), pair.material.elements[1]);
        let FoundContacts { point_face, edge_edge, point_edge, point_point } = found;
        let (edges, triangles) = (&theirs.bounds.edges, &theirs.bounds.triangles);
        match their_type {
            Elements::Points if our_type == Elements::Points => groups.points_against_points(point_point),
            Elements::Points => {}
            Elements::Edges => groups.points_against_elements((theirs.edges, edges), point_edge),
            Elements::Faces => groups.points_against_elements((theirs.triangles, triangles), point_face),
        }
        match our_type {
            Elements::Points => {}
            Elements::Edges => groups.elements_against_points((ours.edges, &ours.bounds.edges), point_edge),
            Elements::Faces => {
                groups.elements_against_points((ours.triangles, &ours.bounds.triangles), point_face);
            }
        }
        if pair.material.edges {
            groups.edges_against_edges(edge_edge);
        }
    }
}

/// A group whose elements with new bounds are tested against those of another.
struct GroupPair<'a, R> {
    ours: &'a SearchedGroup<'a>,
    theirs: &'a SearchedGroup<'a>,
    /// Whether all points of theirs have new bounds.
    all_new: bool,
    pair: &'a ClothPair<'a, R>,
}

impl<R: Real> GroupPair<'_, R> {
    /// Calls `found` with each of our elements that has a new bound and may overlap the other group: its index, its points
    /// and its box.
    #[inline(always)]
    fn for_each_new<const N: usize>(
        &self,
        (elements, boxes): (&[[u32; N]], &BoxRow),
        mut found: impl FnMut(usize, [u32; N], &SweptBox),
    ) {
        boxes.for_each_overlap(self.theirs.swept_box, |at| {
            if self.pair.search.has_new_bound(&elements[at]) {
                found(at, elements[at], &boxes.swept_box(at));
            }
        });
    }

    fn our_points(&self) -> (&[[u32; 1]], &BoxRow) {
        (self.ours.points.as_chunks().0, &self.ours.bounds.points)
    }

    fn points_against_points(&self, found: &mut Vec<Candidate<R, 1, 1>>) {
        self.for_each_new(self.our_points(), |_, [p], here| {
            self.theirs.bounds.points.for_each_overlap(here, |at| {
                let q = self.theirs.points[at];
                let (low, high) = (p.min(q), p.max(q));
                if q != p && (p == low || !self.pair.search.has_new_bound(&[q])) {
                    found.extend(self.pair.contact(([low], [high])));
                }
            });
        });
    }

    /// Our points against their edges or faces.
    fn points_against_elements<const N: usize>(
        &self,
        (elements, boxes): (&[[u32; N]], &BoxRow),
        found: &mut Vec<Candidate<R, 1, N>>,
    ) {
        self.for_each_new(self.our_points(), |_, [p], here| {
            boxes.for_each_overlap(here, |at| {
                if !elements[at].contains(&p) {
                    found.extend(self.pair.contact(([p], elements[at])));
                }
            });
        });
    }

    /// Our edges or faces against their points whose bounds are not new.
    fn elements_against_points<const N: usize>(
        &self,
        ours: (&[[u32; N]], &BoxRow),
        found: &mut Vec<Candidate<R, 1, N>>,
    ) {
        if self.all_new {
            return;
        }
        self.for_each_new(ours, |_, element, here| {
            self.theirs.bounds.points.for_each_overlap(here, |at| {
                let q = self.theirs.points[at];
                if !self.pair.search.has_new_bound(&[q]) && !element.contains(&q) {
                    found.extend(self.pair.contact(([q], element)));
                }
            });
        });
    }

    fn edges_against_edges(&self, found: &mut Vec<Candidate<R, 2, 2>>) {
        let [our_first, their_first] = [self.ours.first_edge, self.theirs.first_edge];
        if self.all_new && our_first > their_first {
            return; // every pair is found from theirs
        }
        let is_new = |ends: &[u32]| self.all_new || self.pair.search.has_new_bound(ends);
        self.for_each_new((self.ours.edges, &self.ours.bounds.edges), |edge, [a, b], here| {
            let edge = (our_first.0, our_first.1 + edge);
            self.theirs.bounds.edges.for_each_overlap(here, |at| {
                let [c, d] = self.theirs.edges[at];
                let is_joined = a == c || a == d || b == c || b == d;
                if !is_joined && (edge < (their_first.0, their_first.1 + at) || !is_new(&[c, d])) {
                    found.extend(self.pair.contact(([a, b], [c, d])));
                }
            });
        });
    }
}

/// Two cloths, or one and itself, and their contact material.
struct ClothPair<'a, R> {
    search: &'a ClothSearch<'a, R>,
    material: &'a ContactMaterial<R>,
    /// Contact thickness in metres, and interaction range in thicknesses.
    thickness_and_range: [f32; 2],
    /// Positions at rest, where elements can be neighbours.
    rest: Option<&'a [[f32; 3]]>,
}

impl<'a, R: Real> ClothPair<'a, R> {
    /// `None` where the two do not collide.
    fn new(search: &'a ClothSearch<'a, R>, cloths: [usize; 2]) -> Option<Self> {
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

    /// The contact of two elements, if they can touch.
    #[inline]
    fn contact<const N: usize, const M: usize>(
        &self,
        points: ElementPoints<N, M>,
    ) -> Option<Candidate<R, N, M>> {
        let ClothSearch { bounds, input, untangling, elements, .. } = self.search;
        let distance = bounds.contact_distance(
            points,
            input.interval_share as f32,
            self.thickness_and_range,
            self.rest,
        )?;
        let [ours, theirs] = [points.0[0], points.1[0]].map(|point| elements.cloth[point as usize]);
        if untangling.is_disabled(&points.0, &points.1, [ours, theirs])
            || input.filter.excludes(&points.0, &points.1)
        {
            return None;
        }
        let is_free = |point: u32| elements.is_free_point[point as usize];
        let params = ContactParams {
            thickness: R::from_f64(f64::from(distance.thickness)),
            material: ours * input.cloths.len() as u32 + theirs,
            rest_limited: distance.rest_limited,
            certified: distance.certified,
            has_free_point: (N == 1 && is_free(points.0[0])) || (M == 1 && is_free(points.1[0])),
            has_anchor: false,
        };
        Some(Candidate { points, params })
    }
}
