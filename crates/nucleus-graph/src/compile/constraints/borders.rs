//! Links along borders: the welds of a tearable surface, and those of borders that are sewn together.

use std::collections::{BTreeMap, BTreeSet};

use nucleus_core::{ClothId, Link, LinkSide, PointId};

use crate::attributes::dynamic_constraint as con;

use super::bvh::{Bounds, Bvh};
use super::forming::{Forming, Place, Point};
use super::member::{Member, MemberObject};
use super::near::{Foot, foot};

impl Forming<'_> {
    /// The welds of a tearable surface, each for half of its edge.
    pub(super) fn seams(&self) -> Vec<Link> {
        let glue = self.source.members.first().map_or(1.0, |member| member.factors(0)[2]);
        let weld = |(cloth, points, edge): &(ClothId, [u32; 2], [u32; 2])| {
            let place = |point: u32| self.places.point(MemberObject::Cloth(*cloth), point);
            let sides = points.map(|point| LinkSide::point(*cloth, PointId(point)));
            Link { glue, length: (place(edge[0]) - place(edge[1])).norm() / 2.0, ..Link::new(sides, 0.0) }
        };
        let mut links: Vec<Link> = self.source.seams.iter().map(weld).collect();
        if self.bends {
            links.extend(self.folds_of_seams());
        }
        links
    }

    /// Links from the points of borders to the closest places of other borders, within `maxDistance`, thinned out by
    /// `connectionDensity`.
    pub(super) fn borders(&self) -> Vec<Link> {
        let reach = self.values.number(&con::MAX_DISTANCE) * self.metres;
        let within = self.values.toggle(&con::CONNECT_WITHIN_COMPONENT) || self.source.members.len() == 1;
        let mut links = Vec::new();
        let mut joined = BTreeSet::new();
        let mut welds = BTreeMap::new();
        let density = self.density();
        for (a, from) in self.source.members.iter().enumerate() {
            let lengths = from.lengths(self.places);
            for (b, to) in self.source.members.iter().enumerate().filter(|(b, _)| within || a != *b) {
                let edges = self.all_corners(to);
                let tree = Bvh::new(edges.iter().map(Vec::as_slice));
                let along = (a == b).then(|| Chains::new(to, &edges));
                for (point, element) in from.points() {
                    let at = self.places.point(from.object, point);
                    let near =
                        along.as_ref().map(|chains| chains.near(point, 2.0 * reach)).unwrap_or_default();
                    let of = |edge: u32| match near.contains(&edge) {
                        true => f64::INFINITY,
                        false => (foot(&edges[edge as usize], at).place - at).norm(),
                    };
                    let Some((distance, edge)) = tree.nearest(&Bounds::of(&[at]), reach, of) else {
                        continue;
                    };
                    let on = snapped(foot(&edges[edge as usize], at), &edges[edge as usize]);
                    let to_point = to.elements.face(edge as usize)[on.corners[0]];
                    if on.weights[0] == 1.0 {
                        // Two points that find each other are one weld.
                        let [p, q] = [(from.object.key(), point), (to.object.key(), to_point)];
                        if !joined.insert([p.min(q), p.max(q)]) {
                            continue;
                        }
                    }
                    if !density.keeps([point, edge], distance) {
                        continue;
                    }
                    let from_place = Place { side: from.side([point; 3], [1.0, 0.0, 0.0]), at, element };
                    let to_place = self.place(to, edge, &on);
                    let link = self.link([(from, from_place), (to, to_place)], None);
                    welds.insert((a, point), links.len() as u32);
                    links.push(Link { length: lengths.get(&point).copied().unwrap_or(link.length), ..link });
                }
            }
        }
        if self.bends {
            let folds: Vec<Link> = self
                .border_pairs(within, reach)
                .into_iter()
                .filter(|&[a, b]| density.keeps([a.1, b.1], self.gap([a, b])))
                .flat_map(|[a, b]| {
                    let members = [a, b].map(|(member, edge)| (&self.source.members[member], edge));
                    let ends = members[0].0.elements.face(a.1 as usize);
                    let weld = |end: u32| welds.get(&(a.0, end)).copied().unwrap_or(u32::MAX);
                    self.folds(members, [weld(ends[0]), weld(ends[ends.len() - 1])])
                })
                .collect();
            links.extend(folds);
        }
        links
    }
}

/// A foot that is a corner where it is within a thousandth of the edge of one.
fn snapped(on: Foot, edge: &[Point]) -> Foot {
    let near = (0..edge.len()).find(|&k| {
        on.corners[..2][..].contains(&k)
            && (edge[k] - on.place).norm() <= 1e-3 * (edge[edge.len() - 1] - edge[0]).norm()
    });
    near.map_or(on, |k| Foot { corners: [k; 3], weights: [1.0, 0.0, 0.0], place: edge[k] })
}

/// Border edges by their points, to find those that are near along the border.
struct Chains<'a> {
    member: &'a Member,
    lengths: Vec<f64>,
    of_point: BTreeMap<u32, Vec<u32>>,
}

impl<'a> Chains<'a> {
    fn new(member: &'a Member, edges: &[Vec<Point>]) -> Self {
        let mut of_point: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
        for edge in 0..member.elements.len() as u32 {
            for &point in member.elements.face(edge as usize) {
                of_point.entry(point).or_default().push(edge);
            }
        }
        let length = |edge: &Vec<Point>| (edge[edge.len() - 1] - edge[0]).norm();
        Self { member, lengths: edges.iter().map(length).collect(), of_point }
    }

    /// The edges that a walk along the border from a point reaches within a length.
    fn near(&self, point: u32, length: f64) -> BTreeSet<u32> {
        let mut found = BTreeSet::new();
        let mut open = vec![(point, 0.0)];
        while let Some((point, walked)) = open.pop() {
            for &edge in self.of_point.get(&point).into_iter().flatten() {
                if !found.insert(edge) {
                    continue;
                }
                let reached = walked + self.lengths[edge as usize];
                if reached <= length {
                    let ends = self.member.elements.face(edge as usize).iter();
                    open.extend(ends.filter(|&&end| end != point).map(|&end| (end, reached)));
                }
            }
        }
        found
    }
}
