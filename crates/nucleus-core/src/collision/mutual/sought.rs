//! What pairs are sought for: a point that strayed, and the elements that it is the first strayed point of.

use super::candidate::{Candidate, Kind};
use super::local::{Boxes, Local};
use super::search::Search;
use crate::collision::tree::Aabb;
use crate::frame::Elements;
use crate::scalar::Real;

/// A point and elements of it that pairs are sought for.
#[derive(Debug)]
pub struct Sought {
    point: u32,
    cloth: usize,
    /// Round all of them.
    pub all: Boxes,
    round_point: Boxes,
    /// Their number in the skin, their ends, and what is round them.
    edges: Vec<(u32, [u32; 2], Boxes)>,
    triangles: Vec<([u32; 3], Boxes)>,
    /// Whether the point is of no face.
    is_free: bool,
}

impl Default for Sought {
    fn default() -> Self {
        let nothing = [Aabb::EMPTY; 2];
        let (edges, triangles) = (Vec::new(), Vec::new());
        Self { point: 0, cloth: 0, all: nothing, round_point: nothing, edges, triangles, is_free: false }
    }
}

impl Sought {
    /// Looks at a point.
    pub(super) fn look<R: Real>(&mut self, search: &Search<'_, R>, point: u32) {
        let stars = &search.bodies.stars;
        self.point = point;
        self.cloth = search.bodies.cloth[point as usize] as usize;
        self.is_free = stars.triangles(point).is_empty();
        self.round_point = search.bound([point].into_iter());
        self.all = self.round_point;
        self.edges.clear();
        self.triangles.clear();
        let skin = &search.cloths[self.cloth].skin;
        let is_first =
            |points: &[u32]| points.iter().all(|&other| other >= point || !search.strayed[other as usize]);
        for &edge in stars.edges(point) {
            let ends = skin.edges[edge as usize];
            if is_first(&ends) {
                self.edges.push((edge, ends, search.bound(ends.into_iter())));
            }
        }
        for &triangle in stars.triangles(point) {
            let corners = skin.triangles[triangle as usize];
            if is_first(&corners) {
                self.triangles.push((corners, search.bound(corners.into_iter())));
            }
        }
        let edges = self.edges.iter().map(|(_, _, boxes)| boxes);
        for boxes in edges.chain(self.triangles.iter().map(|(_, boxes)| boxes)) {
            self.all = [0, 1].map(|end| self.all[end].union(boxes[end]));
        }
    }

    /// All pairs with the elements of a group. What is new on both sides is found once: from the point where a point
    /// meets an edge or a face, and else from what comes first.
    pub(super) fn meet<R: Real>(
        &self,
        search: &Search<'_, R>,
        group: u32,
        local: &Local,
        list: &mut Vec<Candidate>,
    ) {
        let cloths = [self.cloth, search.bodies.groups[group as usize].cloth as usize];
        let Some(terms) = &search.terms[cloths[0] * search.cloths.len() + cloths[1]] else { return };
        let (skin, elements) = search.elements(group);
        // Free points have no shape at rest: what lies near at the start is no neighbour.
        let is_shaped = cloths[0] == cloths[1] && !skin.triangles.is_empty();
        let rest = is_shaped.then_some(&search.bodies.rest[..]);
        let near = [terms.thickness as f32, terms.reach as f32];
        let mut keep = |kind: Kind, points: [u32; 4]| {
            list.extend(search.seen.candidate(kind, points, near, rest));
        };
        // What has no face is points, whatever its cloth's are.
        let reach = |is_free: bool, elements: Elements| if is_free { Elements::Points } else { elements };
        let ours = reach(self.is_free, terms.elements[0]);
        let theirs = reach(elements.triangles.is_empty(), terms.elements[1]);
        let points = || skin.points[elements.points.clone()].iter().copied().zip(&local.points);
        let triangles = skin.triangles[elements.triangles.clone()].iter().zip(&local.triangles);
        let edges = skin.edges[elements.edges.clone()].iter().zip(&local.edges);
        match theirs {
            Elements::Points if ours == Elements::Points => {
                let counts = |q: u32| q != self.point && (self.point < q || !search.strayed[q as usize]);
                self.point_meets_points(points().filter(|&(q, _)| counts(q)), &mut keep);
            }
            Elements::Points => {}
            Elements::Edges => self.point_meets(edges.clone(), &mut keep),
            Elements::Faces => self.point_meets(triangles, &mut keep),
        }
        let known =
            points().filter(|&(q, there)| !search.strayed[q as usize] && Aabb::may_meet(&self.all, there));
        match ours {
            Elements::Points => {}
            Elements::Edges => {
                meet_points(|| self.edges.iter().map(|(_, ends, boxes)| (ends, boxes)), known, &mut keep)
            }
            Elements::Faces => meet_points(
                || self.triangles.iter().map(|(corners, boxes)| (corners, boxes)),
                known,
                &mut keep,
            ),
        }
        if terms.edges {
            let is_new = |ends: &[u32; 2]| ends.iter().any(|&point| search.strayed[point as usize]);
            let numbered = (elements.edges.start as u32..).zip(edges);
            let near = numbered.filter(|(_, (_, there))| Aabb::may_meet(&self.all, there));
            // Up to which of our edges the pair counts.
            let bounded = near.map(|(edge, (ends, there))| match is_new(ends) {
                true => ((cloths[1], edge), ends, there),
                false => ((usize::MAX, 0), ends, there),
            });
            self.edges_meet_edges(bounded, &mut keep);
        }
    }

    fn point_meets_points<'a>(
        &self,
        theirs: impl Iterator<Item = (u32, &'a Boxes)>,
        keep: &mut impl FnMut(Kind, [u32; 4]),
    ) {
        for (q, _) in theirs.filter(|(_, there)| Aabb::may_meet(&self.round_point, there)) {
            let (p, q) = (self.point.min(q), self.point.max(q));
            keep(Kind::PointPoint, [p, q, p, p]);
        }
    }

    /// The point against edges or faces.
    fn point_meets<'a, const N: usize>(
        &self,
        theirs: impl Iterator<Item = (&'a [u32; N], &'a Boxes)>,
        keep: &mut impl FnMut(Kind, [u32; 4]),
    ) {
        for (element, there) in theirs {
            if !element.contains(&self.point) && Aabb::may_meet(&self.round_point, there) {
                let (kind, points) = pair(self.point, element);
                keep(kind, points);
            }
        }
    }

    /// Theirs come with the number, by cloth and edge, below which ours count.
    fn edges_meet_edges<'a>(
        &self,
        theirs: impl Iterator<Item = ((usize, u32), &'a [u32; 2], &'a Boxes)>,
        keep: &mut impl FnMut(Kind, [u32; 4]),
    ) {
        for (below, &[c, d], there) in theirs {
            for &(edge, [a, b], ref here) in &self.edges {
                let joined = a == c || a == d || b == c || b == d;
                if !joined && (self.cloth, edge) < below && Aabb::may_meet(here, there) {
                    keep(Kind::EdgeEdge, [a, b, c, d]);
                }
            }
        }
    }
}

/// Edges or faces of ours against points of theirs.
fn meet_points<'a, 'b, const N: usize, I: Iterator<Item = (&'b [u32; N], &'b Boxes)>>(
    ours: impl Fn() -> I,
    theirs: impl Iterator<Item = (u32, &'a Boxes)>,
    keep: &mut impl FnMut(Kind, [u32; 4]),
) {
    for (q, there) in theirs {
        for (element, here) in ours() {
            if !element.contains(&q) && Aabb::may_meet(here, there) {
                let (kind, points) = pair(q, element);
                keep(kind, points);
            }
        }
    }
}

/// A point against an edge, or a face.
fn pair<const N: usize>(point: u32, element: &[u32; N]) -> (Kind, [u32; 4]) {
    let mut points = [point; 4];
    points[1..=N].copy_from_slice(element);
    (if N == 2 { Kind::PointEdge } else { Kind::PointFace }, points)
}
