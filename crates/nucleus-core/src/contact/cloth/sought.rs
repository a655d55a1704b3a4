//! What pairs are sought for: the elements of a group that something new is foreseen for.

use super::active::Found;
use super::local::{Fours, Local};
use super::near::{Meeting, Near};
use super::search::Search;
use super::ways::Points;
use crate::contact::aabb::{Aabb, SweptBox};
use crate::contact::terms::Terms;
use crate::input::frame::Elements;
use crate::math::Real;

/// The elements of a group that pairs are sought for.
#[derive(Debug, Default)]
pub struct Sought {
    cloth: usize,
    points: Those<u32>,
    /// With their number in the skin.
    edges: Those<(u32, [u32; 2])>,
    triangles: Those<[u32; 3]>,
    /// Whether the points are of no face.
    is_free: bool,
}

/// Elements, and boxes round them.
#[derive(Debug)]
struct Those<T> {
    list: Vec<T>,
    boxes: Vec<SweptBox>,
    row: Fours,
}

impl<T> Default for Those<T> {
    fn default() -> Self {
        Self { list: Vec::new(), boxes: Vec::new(), row: Fours::default() }
    }
}

impl<T> Those<T> {
    fn look(&mut self, all: impl Iterator<Item = T>, bound: impl Fn(&T) -> SweptBox) {
        let Self { list, boxes, row } = self;
        list.clear();
        list.extend(all);
        boxes.clear();
        boxes.extend(list.iter().map(bound));
        row.fill(boxes, |one| *one);
    }

    /// Calls `found` with each that something in these boxes may meet.
    #[inline(always)]
    fn met_by(&self, around: &SweptBox, mut found: impl FnMut(&T, &SweptBox)) {
        self.row.met_by(around, |at| found(&self.list[at], &self.boxes[at]));
    }
}

impl Sought {
    /// Looks at a group; the boxes round all that is sought for.
    pub(super) fn look<R: Real>(&mut self, search: &Search<'_, R>, group: u32) -> SweptBox {
        let (skin, elements) = search.elements(group);
        self.cloth = search.bodies.groups[group as usize].cloth as usize;
        self.is_free = elements.triangles.is_empty();
        let points = skin.points[elements.points.clone()].iter().copied();
        self.points.look(points.filter(|&point| search.is_new(&[point])), |&point| search.bound(&[point]));
        let edges = (elements.edges.start as u32..).zip(skin.edges[elements.edges.clone()].iter().copied());
        self.edges.look(edges.filter(|(_, ends)| search.is_new(ends)), |(_, ends)| search.bound(ends));
        let triangles = skin.triangles[elements.triangles.clone()].iter().copied();
        self.triangles.look(triangles.filter(|face| search.is_new(face)), |face| search.bound(face));
        let all = self.points.boxes.iter().chain(&self.edges.boxes).chain(&self.triangles.boxes);
        all.fold([Aabb::EMPTY; 2], |[start, end], boxes| [start.union(boxes[0]), end.union(boxes[1])])
    }

    /// All contacts with the elements of a group. What is new on both sides is found once: from the point where a point
    /// meets an edge or a face, and else from what comes first.
    pub(super) fn meet<R: Real>(
        &self,
        search: &Search<'_, R>,
        group: u32,
        local: &Local,
        found: &mut Found<R>,
    ) {
        let cloths = [self.cloth, search.bodies.groups[group as usize].cloth as usize];
        let Some(pair) = Pair::new(search, cloths) else { return };
        let (skin, elements) = search.elements(group);
        let there = There {
            points: &skin.points[elements.points.clone()],
            edges: &skin.edges[elements.edges.clone()],
            triangles: &skin.triangles[elements.triangles.clone()],
            first_edge: (cloths[1], elements.edges.start),
            around: &search.bodies.around[group as usize],
            local,
        };
        // What has no face is points, whatever its cloth's are.
        let reach = |is_free: bool, elements: Elements| if is_free { Elements::Points } else { elements };
        let ours = reach(self.is_free, pair.terms.elements[0]);
        let theirs = reach(there.triangles.is_empty(), pair.terms.elements[1]);
        let Found { point_face, edge_edge, point_edge, point_point } = found;
        match theirs {
            Elements::Points if ours == Elements::Points => {
                self.points_meet_points(&there, &pair, point_point)
            }
            Elements::Points => {}
            Elements::Edges => self.points_meet(&there, (there.edges, &local.edges), &pair, point_edge),
            Elements::Faces => {
                self.points_meet(&there, (there.triangles, &local.triangles), &pair, point_face)
            }
        }
        match ours {
            Elements::Points => {}
            Elements::Edges => there.points_are_met(&self.edges, |(_, ends)| *ends, &pair, point_edge),
            Elements::Faces => there.points_are_met(&self.triangles, |face| *face, &pair, point_face),
        }
        if pair.terms.edges {
            self.edges_meet_edges(&there, &pair, edge_edge);
        }
    }

    fn points_meet_points<R: Real>(
        &self,
        there: &There<'_>,
        pair: &Pair<'_, R>,
        found: &mut Vec<Near<R, 1, 1>>,
    ) {
        self.points.met_by(there.around, |&p, here| {
            there.local.points.met_by(here, |at| {
                let q = there.points[at];
                let (low, high) = (p.min(q), p.max(q));
                if q != p && (p == low || !pair.search.is_new(&[q])) {
                    found.extend(pair.contact(([low], [high])));
                }
            });
        });
    }

    /// Our points against their edges or faces.
    fn points_meet<R: Real, const N: usize>(
        &self,
        there: &There<'_>,
        (elements, boxes): (&[[u32; N]], &Fours),
        pair: &Pair<'_, R>,
        found: &mut Vec<Near<R, 1, N>>,
    ) {
        self.points.met_by(there.around, |p, here| {
            boxes.met_by(here, |at| {
                if !elements[at].contains(p) {
                    found.extend(pair.contact(([*p], elements[at])));
                }
            });
        });
    }

    fn edges_meet_edges<R: Real>(
        &self,
        there: &There<'_>,
        pair: &Pair<'_, R>,
        found: &mut Vec<Near<R, 2, 2>>,
    ) {
        let (cloth, first) = there.first_edge;
        let is_new = |ends: &[u32]| there.local.is_all_new || pair.search.is_new(ends);
        let last = self.edges.list.last().map_or((0, 0), |&(edge, _)| (self.cloth, edge as usize));
        if there.local.is_all_new && last >= (cloth, first + there.edges.len()) {
            return; // every pair is found from theirs
        }
        self.edges.met_by(there.around, |&(edge, [a, b]), here| {
            there.local.edges.met_by(here, |at| {
                let [c, d] = there.edges[at];
                let is_joined = a == c || a == d || b == c || b == d;
                if !is_joined && ((self.cloth, edge as usize) < (cloth, first + at) || !is_new(&[c, d])) {
                    found.extend(pair.contact(([a, b], [c, d])));
                }
            });
        });
    }
}

/// A group that is met.
struct There<'a> {
    points: &'a [u32],
    edges: &'a [[u32; 2]],
    triangles: &'a [[u32; 3]],
    /// Its cloth, and the number of its first edge in the skin.
    first_edge: (usize, usize),
    /// Pass all of it.
    around: &'a SweptBox,
    local: &'a Local,
}

impl There<'_> {
    /// Edges or faces of ours against those of its points that nothing new is foreseen for.
    fn points_are_met<R: Real, T, const N: usize>(
        &self,
        ours: &Those<T>,
        element: impl Fn(&T) -> [u32; N],
        pair: &Pair<'_, R>,
        found: &mut Vec<Near<R, 1, N>>,
    ) {
        if self.local.is_all_new {
            return;
        }
        ours.met_by(self.around, |ours, here| {
            self.local.points.met_by(here, |at| {
                let (q, element) = (self.points[at], element(ours));
                if !pair.search.is_new(&[q]) && !element.contains(&q) {
                    found.extend(pair.contact(([q], element)));
                }
            });
        });
    }
}

/// Two cloths, or one and itself, and how they meet.
struct Pair<'a, R> {
    search: &'a Search<'a, R>,
    terms: &'a Terms<R>,
    /// The thickness in metres, and its share up to which anything acts.
    near: [f32; 2],
    /// The shape at rest, where elements can be neighbours in it.
    rest: Option<&'a [[f32; 3]]>,
}

impl<'a, R: Real> Pair<'a, R> {
    /// Nothing where the two do not meet.
    fn new(search: &'a Search<'a, R>, cloths: [usize; 2]) -> Option<Self> {
        let terms = search.terms[cloths[0] * search.look.cloths.len() + cloths[1]].as_ref()?;
        // Free points have no shape at rest: what lies near at the start is no neighbour.
        let is_shaped = cloths[0] == cloths[1] && !search.look.cloths[cloths[0]].skin.triangles.is_empty();
        Some(Self {
            search,
            terms,
            near: [terms.thickness as f32, terms.reach as f32],
            rest: is_shaped.then_some(&search.bodies.rest[..]),
        })
    }

    /// A contact, if the two can touch.
    #[inline]
    fn contact<const N: usize, const M: usize>(&self, points: Points<N, M>) -> Option<Near<R, N, M>> {
        let Search { seen, look, tangle, bodies, .. } = self.search;
        let kept = seen.kept(points, look.begun as f32, self.near, self.rest)?;
        let [ours, theirs] = [points.0[0], points.1[0]].map(|point| bodies.cloth[point as usize]);
        if tangle.lets_pass(&points.0, &points.1, [ours, theirs]) {
            return None;
        }
        let is_free = |point: u32| bodies.is_free[point as usize];
        let meeting = Meeting {
            thickness: R::from_f64(f64::from(kept.thickness)),
            terms: ours * look.cloths.len() as u32 + theirs,
            rest_limited: kept.rest_limited,
            certified: kept.certified,
            is_swept: (N == 1 && is_free(points.0[0])) || (M == 1 && is_free(points.1[0])),
            rubs: false,
        };
        Some(Near::new(points, meeting, look.anchors, look.moved[0]))
    }
}
