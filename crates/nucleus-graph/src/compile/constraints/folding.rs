//! Folds: joined edges that resist folding about each other.
//!
//! A fold is between two faces, one at each of the joined edges. A face of more than three corners has two folds of half the
//! stiffness, with the corners behind either end of its edge, so that neither end is preferred.

use std::collections::BTreeMap;

use nalgebra::Vector3;
use nucleus_core::{Link, LinkSide, PointId, fold_link};

use super::bvh::{Bounds, Bvh};
use super::forming::Forming;
use super::member::{Member, MemberObject};
use super::near::distance;

type Point = Vector3<f64>;

/// An edge of a member, by the indices of both.
pub(super) type MemberEdge = (usize, u32);

impl Forming<'_> {
    /// The folds of two edges that the links `holds` join.
    pub(super) fn folds(&self, edges: [(&Member, u32); 2], holds: [u32; 2]) -> Vec<Link> {
        let corners = edges.map(|(member, edge)| {
            let ends = member.elements.face(edge as usize);
            let [c, d] = member.behind.get(edge as usize).copied().flatten()?;
            Some([*ends.first()?, *ends.last()?, c, d])
        });
        let [Some(ours), Some(mut theirs)] = corners else { return Vec::new() };
        let [from, to] = edges.map(|(member, _)| member.object);
        let gap = |a: u32, b: u32| (self.places.point(from, a) - self.places.point(to, b)).norm();
        if gap(ours[0], theirs[0]) + gap(ours[1], theirs[1])
            > gap(ours[0], theirs[1]) + gap(ours[1], theirs[0])
        {
            theirs = [theirs[1], theirs[0], theirs[3], theirs[2]];
        }
        let strength = edges.map(|(member, edge)| member.factors(edge)[0]);
        let folds = self.folds_between([(from, ours), (to, theirs)], holds);
        folds.map(|fold| Link { strength: strength[0] * strength[1], ..fold }).collect()
    }

    /// The folds of two faces, each given by the ends of its edge and the next corner behind each end.
    fn folds_between(
        &self,
        faces: [(MemberObject, [u32; 4]); 2],
        holds: [u32; 2],
    ) -> impl Iterator<Item = Link> {
        let is_triangle = faces.iter().all(|(_, [_, _, c, d])| c == d);
        let count = if is_triangle { 1 } else { 2 };
        let of = |(object, corners): (MemberObject, [u32; 4]), k: usize| {
            let points = [corners[0], corners[1], corners[2 + k]];
            (side(object, points), points.map(|point| self.places.point(object, point)))
        };
        let fold = move |k: usize| {
            let [a, b] = faces.map(|face| of(face, k));
            fold_link([a.0, b.0], [a.1, b.1], 1.0 / count as f64, holds)
        };
        (0..count).filter_map(fold).collect::<Vec<_>>().into_iter()
    }

    /// The folds of a tearable surface, which break with the welds at their ends.
    pub(super) fn folds_of_seams(&self) -> Vec<Link> {
        let source = self.source;
        let key = |cloth, points: [u32; 2]| (cloth, points[0].min(points[1]), points[0].max(points[1]));
        let seams = source.seams.iter().zip(0u32..);
        let welds: BTreeMap<_, u32> =
            seams.map(|((cloth, points, _), at)| (key(*cloth, *points), at)).collect();
        let mut folds = Vec::new();
        for (cloth, [ours, theirs]) in &source.creases {
            let weld = |end: usize| welds.get(&key(*cloth, [ours[end], theirs[end]])).copied();
            let holds = [0, 1].map(|end| weld(end).unwrap_or(u32::MAX));
            let object = MemberObject::Cloth(*cloth);
            folds.extend(self.folds_between([(object, *ours), (object, *theirs)], holds));
        }
        folds
    }

    /// The distance of two edges in metres.
    pub(super) fn gap(&self, edges: [MemberEdge; 2]) -> f64 {
        let [a, b] = edges.map(|(member, edge)| self.corners(&self.source.members[member], edge));
        distance(&a, &b)
    }

    /// The edges of borders that face each other within a distance: the nearest of another border to each, by their middles.
    pub(super) fn border_pairs(&self, within: bool, reach: f64) -> Vec<[MemberEdge; 2]> {
        let members = &self.source.members;
        let ends = |(member, edge): MemberEdge| -> [Point; 2] {
            let points = members[member].elements.face(edge as usize);
            [points[0], points[points.len() - 1]]
                .map(|point| self.places.point(members[member].object, point))
        };
        let middle = |edge: MemberEdge| ends(edge).iter().sum::<Point>() / 2.0;
        let shares_point = |a: MemberEdge, b: MemberEdge| {
            let points = members[b.0].elements.face(b.1 as usize);
            a.0 == b.0 && members[a.0].elements.face(a.1 as usize).iter().any(|point| points.contains(point))
        };
        let all: Vec<MemberEdge> = (0..members.len())
            .flat_map(|member| (0..members[member].elements.len() as u32).map(move |edge| (member, edge)))
            .collect();
        // Both ends of one are near the other: edges that only meet at a corner do not face each other.
        let is_along = |edge: MemberEdge, other: MemberEdge| {
            ends(edge).iter().all(|&end| distance(&[end, end], &ends(other)) <= reach)
        };
        let middles: Vec<Point> = all.iter().map(|&edge| middle(edge)).collect();
        let tree = Bvh::new(middles.iter().map(std::slice::from_ref));
        // The middle of an edge along another is within reach of it, and no farther from its middle than half its length.
        let half = |&edge: &MemberEdge| (ends(edge)[1] - ends(edge)[0]).norm() / 2.0;
        let farthest = (reach + all.iter().map(half).fold(0.0, f64::max)) * (1.0 + 1e-9);
        let mut pairs = Vec::new();
        for (&edge, &at) in all.iter().zip(&middles) {
            let is_other = |other: MemberEdge| {
                other.0 > edge.0
                    || within && other.0 == edge.0 && other.1 > edge.1 && !shares_point(edge, other)
            };
            let gap = |k: u32| match is_other(all[k as usize]) {
                true => (at - middles[k as usize]).norm(),
                false => f64::INFINITY,
            };
            let nearest = tree.nearest(&Bounds::of(&[at]), farthest, gap).map(|(_, k)| all[k as usize]);
            if let Some(other) = nearest.filter(|&other| is_along(edge, other) || is_along(other, edge)) {
                pairs.push([edge, other]);
            }
        }
        pairs
    }
}

fn side(object: MemberObject, points: [u32; 3]) -> LinkSide {
    let points = points.map(PointId);
    let weights = [0.0; 3];
    match object {
        MemberObject::Cloth(cloth) => LinkSide::Cloth { cloth, points, weights },
        MemberObject::Collider(collider) => LinkSide::Collider { collider, points, weights },
    }
}
