//! Broad-phase query of one element group against others: tests rows of swept boxes, then builds contacts.

use crate::contact::box_row::BoxRow;
use crate::contact::bvh::{Aabb, SweptBox};
use crate::contact::cloth::contact::{ClothContact, ContactParams};
use crate::contact::cloth::element_bounds::ElementPoints;
use crate::contact::cloth::group_bounds::{GroupBounds, GroupBoundsCache};
use crate::contact::cloth::search::ClothSearch;
use crate::contact::material::ContactMaterial;
use crate::input::frame::Elements;
use crate::math::Real;

/// The contacts that a search task finds.
#[derive(Debug)]
pub struct FoundContacts<R> {
    /// Points and faces.
    pub point_face: Vec<ClothContact<R, 1, 3>>,
    /// Edges and edges.
    pub edge_edge: Vec<ClothContact<R, 2, 2>>,
    /// Points and edges.
    pub point_edge: Vec<ClothContact<R, 1, 2>>,
    /// Points and points.
    pub point_point: Vec<ClothContact<R, 1, 1>>,
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

/// The contacts that a task finds, and its buffers.
#[derive(Debug)]
pub struct SearchTask<R> {
    pub(super) found: FoundContacts<R>,
    pub(super) query: QueryGroup,
    pub(super) group_bounds: GroupBoundsCache,
}

impl<R> Default for SearchTask<R> {
    fn default() -> Self {
        Self {
            found: FoundContacts::default(),
            query: QueryGroup::default(),
            group_bounds: GroupBoundsCache::default(),
        }
    }
}

/// The elements of a group that have a new bound.
#[derive(Debug, Default)]
pub struct QueryGroup {
    cloth: usize,
    points: QueryElements<u32>,
    /// With their index in the boundary.
    edges: QueryElements<(u32, [u32; 2])>,
    triangles: QueryElements<[u32; 3]>,
    /// Whether it is a group of free points.
    is_free: bool,
}

/// Elements and their swept boxes.
#[derive(Debug)]
struct QueryElements<T> {
    list: Vec<T>,
    boxes: Vec<SweptBox>,
    row: BoxRow,
}

impl<T> Default for QueryElements<T> {
    fn default() -> Self {
        Self { list: Vec::new(), boxes: Vec::new(), row: BoxRow::default() }
    }
}

impl<T> QueryElements<T> {
    fn fill(&mut self, all: impl Iterator<Item = T>, bound: impl Fn(&T) -> SweptBox) {
        let Self { list, boxes, row } = self;
        list.clear();
        list.extend(all);
        boxes.clear();
        boxes.extend(list.iter().map(bound));
        row.fill(boxes, |one| *one);
    }

    /// Calls `found` with each element that may overlap a swept box.
    #[inline(always)]
    fn for_each_overlap(&self, swept_box: &SweptBox, mut found: impl FnMut(&T, &SweptBox)) {
        self.row.for_each_overlap(swept_box, |at| found(&self.list[at], &self.boxes[at]));
    }
}

impl QueryGroup {
    /// Takes up a group. Returns the union of its swept boxes.
    pub(super) fn fill<R: Real>(&mut self, search: &ClothSearch<'_, R>, group: u32) -> SweptBox {
        let (boundary, elements) = search.elements(group);
        self.cloth = search.elements.groups[group as usize].cloth as usize;
        self.is_free = elements.triangles.is_empty();
        let points = boundary.points[elements.points.clone()].iter().copied();
        self.points
            .fill(points.filter(|&point| search.has_new_bound(&[point])), |&point| search.bound(&[point]));
        let edges =
            (elements.edges.start as u32..).zip(boundary.edges[elements.edges.clone()].iter().copied());
        self.edges.fill(edges.filter(|(_, ends)| search.has_new_bound(ends)), |(_, ends)| search.bound(ends));
        let triangles = boundary.triangles[elements.triangles.clone()].iter().copied();
        self.triangles.fill(triangles.filter(|face| search.has_new_bound(face)), |face| search.bound(face));
        let all = self.points.boxes.iter().chain(&self.edges.boxes).chain(&self.triangles.boxes);
        all.fold([Aabb::EMPTY; 2], |[start, end], boxes| [start.union(boxes[0]), end.union(boxes[1])])
    }

    /// Finds all contacts with the elements of a group. Where both elements have new bounds, the contact is found
    /// once: from the point in point-edge and point-face pairs, from the lower index in others.
    pub(super) fn find_contacts<R: Real>(
        &self,
        search: &ClothSearch<'_, R>,
        group: u32,
        bounds: &GroupBounds,
        found: &mut FoundContacts<R>,
    ) {
        let cloths = [self.cloth, search.elements.groups[group as usize].cloth as usize];
        let Some(pair) = ClothPair::new(search, cloths) else { return };
        let (boundary, elements) = search.elements(group);
        let target = TargetGroup {
            points: &boundary.points[elements.points.clone()],
            edges: &boundary.edges[elements.edges.clone()],
            triangles: &boundary.triangles[elements.triangles.clone()],
            first_edge: (cloths[1], elements.edges.start),
            swept_box: &search.elements.swept_boxes[group as usize],
            bounds,
        };
        // A group without faces is points, whatever the cloth's element type.
        let element_type =
            |is_free: bool, elements: Elements| if is_free { Elements::Points } else { elements };
        let ours = element_type(self.is_free, pair.material.elements[0]);
        let theirs = element_type(target.triangles.is_empty(), pair.material.elements[1]);
        let FoundContacts { point_face, edge_edge, point_edge, point_point } = found;
        match theirs {
            Elements::Points if ours == Elements::Points => {
                self.points_against_points(&target, &pair, point_point)
            }
            Elements::Points => {}
            Elements::Edges => {
                self.points_against_elements(&target, (target.edges, &bounds.edges), &pair, point_edge)
            }
            Elements::Faces => self.points_against_elements(
                &target,
                (target.triangles, &bounds.triangles),
                &pair,
                point_face,
            ),
        }
        match ours {
            Elements::Points => {}
            Elements::Edges => {
                target.elements_against_points(&self.edges, |(_, ends)| *ends, &pair, point_edge)
            }
            Elements::Faces => {
                target.elements_against_points(&self.triangles, |face| *face, &pair, point_face)
            }
        }
        if pair.material.edges {
            self.edges_against_edges(&target, &pair, edge_edge);
        }
    }

    fn points_against_points<R: Real>(
        &self,
        target: &TargetGroup<'_>,
        pair: &ClothPair<'_, R>,
        found: &mut Vec<ClothContact<R, 1, 1>>,
    ) {
        self.points.for_each_overlap(target.swept_box, |&p, here| {
            target.bounds.points.for_each_overlap(here, |at| {
                let q = target.points[at];
                let (low, high) = (p.min(q), p.max(q));
                if q != p && (p == low || !pair.search.has_new_bound(&[q])) {
                    found.extend(pair.contact(([low], [high])));
                }
            });
        });
    }

    /// Query points against target edges or faces.
    fn points_against_elements<R: Real, const N: usize>(
        &self,
        target: &TargetGroup<'_>,
        (elements, boxes): (&[[u32; N]], &BoxRow),
        pair: &ClothPair<'_, R>,
        found: &mut Vec<ClothContact<R, 1, N>>,
    ) {
        self.points.for_each_overlap(target.swept_box, |p, here| {
            boxes.for_each_overlap(here, |at| {
                if !elements[at].contains(p) {
                    found.extend(pair.contact(([*p], elements[at])));
                }
            });
        });
    }

    fn edges_against_edges<R: Real>(
        &self,
        target: &TargetGroup<'_>,
        pair: &ClothPair<'_, R>,
        found: &mut Vec<ClothContact<R, 2, 2>>,
    ) {
        let (cloth, first) = target.first_edge;
        let is_new = |ends: &[u32]| target.bounds.all_have_new_bounds || pair.search.has_new_bound(ends);
        let last = self.edges.list.last().map_or((0, 0), |&(edge, _)| (self.cloth, edge as usize));
        if target.bounds.all_have_new_bounds && last >= (cloth, first + target.edges.len()) {
            return; // every pair is found from theirs
        }
        self.edges.for_each_overlap(target.swept_box, |&(edge, [a, b]), here| {
            target.bounds.edges.for_each_overlap(here, |at| {
                let [c, d] = target.edges[at];
                let is_joined = a == c || a == d || b == c || b == d;
                if !is_joined && ((self.cloth, edge as usize) < (cloth, first + at) || !is_new(&[c, d])) {
                    found.extend(pair.contact(([a, b], [c, d])));
                }
            });
        });
    }
}

/// The group that is queried.
struct TargetGroup<'a> {
    points: &'a [u32],
    edges: &'a [[u32; 2]],
    triangles: &'a [[u32; 3]],
    /// Its cloth, and the index of its first edge in the boundary.
    first_edge: (usize, usize),
    /// Swept box of the whole group.
    swept_box: &'a SweptBox,
    bounds: &'a GroupBounds,
}

impl TargetGroup<'_> {
    /// Query edges or faces against target points whose bounds are not new.
    fn elements_against_points<R: Real, T, const N: usize>(
        &self,
        ours: &QueryElements<T>,
        element: impl Fn(&T) -> [u32; N],
        pair: &ClothPair<'_, R>,
        found: &mut Vec<ClothContact<R, 1, N>>,
    ) {
        if self.bounds.all_have_new_bounds {
            return;
        }
        ours.for_each_overlap(self.swept_box, |ours, here| {
            self.bounds.points.for_each_overlap(here, |at| {
                let (q, element) = (self.points[at], element(ours));
                if !pair.search.has_new_bound(&[q]) && !element.contains(&q) {
                    found.extend(pair.contact(([q], element)));
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
    ) -> Option<ClothContact<R, N, M>> {
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
        Some(ClothContact::new(points, params, input.anchors, input.displacement[0]))
    }
}
