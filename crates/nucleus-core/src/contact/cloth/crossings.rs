//! Finds the edges that go through faces, and says what is done about each.

use super::Mutual;
use super::bodies::Bodies;
use super::pieces::Pieces;
use super::search::Look;
use super::tangle::{Crossing, Remedy, Tangle, Wing, goes_through};
use crate::contact::terms::Terms;
use crate::math::{Real, Row4, add, cross, dot, scale, sub};
use crate::model::ClothModel;

/// Looks for all that passes through each other where the points are now. Good while the boxes of the last search hold.
pub fn find_crossings<R: Real>(mutual: &mut Mutual<R>, look: &Look<'_, R>) {
    let Mutual { bodies, terms, tangle, .. } = mutual;
    tangle.is_suspected = false;
    tangle.crossings.clear();
    let Some(tree) = &bodies.tree else { return };
    let Look { cloths, anchors, moved: [_, moved], strength, .. } = *look;
    let view = View { bodies, terms, cloths, anchors, moved, strength };
    for group in 0..bodies.groups.len() as u32 {
        tree.query(&bodies.swept(group), |other| view.cross(group, other, &mut tangle.crossings));
    }
    if tangle.is_there() {
        tangle.spread(cloths);
        tangle.find_remedies(cloths);
        view.take_sides(tangle);
    } else {
        tangle.is_wrong.fill(false);
        tangle.sides.clear();
    }
}

struct View<'a, R> {
    bodies: &'a Bodies,
    terms: &'a [Option<Terms<R>>],
    cloths: &'a [ClothModel<R>],
    anchors: &'a [[f64; 3]],
    moved: &'a [Row4<R>],
    strength: &'a [R],
}

impl<R: Real> View<'_, R> {
    /// Every edge of one group that goes through a face of another.
    fn cross(&self, group: u32, other: u32, found: &mut Vec<Crossing>) {
        let [ours, theirs] = [group, other].map(|group| &self.bodies.groups[group as usize]);
        let terms = &self.terms[ours.cloth as usize * self.cloths.len() + theirs.cloth as usize];
        let meets = terms.as_ref().is_some_and(|terms| terms.strength == [R::ONE; 2]);
        if !meets || !self.bodies.swept(other).meets(&self.bodies.swept(group)) {
            return;
        }
        let place = |point: u32| self.place(point);
        let holds = |points: &[u32]| {
            self.strength.is_empty() || points.iter().all(|&p| self.strength[p as usize] >= R::ONE)
        };
        let edges = &self.cloths[ours.cloth as usize].skin.edges[ours.group.edges.clone()];
        let faces = &self.cloths[theirs.cloth as usize].skin.triangles[theirs.group.triangles.clone()];
        for &edge in edges.iter().filter(|edge| holds(*edge)) {
            for &face in faces.iter().filter(|face| holds(*face)) {
                let is_joined = face.iter().any(|point| edge.contains(point));
                if !is_joined && goes_through(edge.map(place), face.map(place)) {
                    found.push(Crossing { edge, wings: [edge[0]; 2], face, remedy: Remedy::Wait });
                }
            }
        }
    }

    /// Where two cloths pass through each other, the first is to be on that side of the second where most of it is.
    fn take_sides(&self, tangle: &mut Tangle) {
        let Tangle { crossings, sides, pairs, wings, .. } = tangle;
        pairs.clear();
        let cloth = |point: u32| self.bodies.cloth[point as usize];
        for at in 0..crossings.len() {
            let Crossing { edge, face, .. } = crossings[at];
            let (ours, theirs) = (cloth(edge[0]), cloth(face[0]));
            let pair = [ours.min(theirs), ours.max(theirs)];
            if !pairs.contains(&pair) {
                pairs.push(pair);
            }
            if ours == theirs {
                continue;
            }
            let known = sides.iter().find(|side| side.0 == pair).map(|side| side.1);
            let is_first_outside = known.unwrap_or_else(|| self.is_above(pair, crossings));
            if known.is_none() {
                sides.push((pair, is_first_outside));
            }
            let [p, q, r] = face.map(|point| self.place(point));
            let normal = cross(sub(q, p), sub(r, p));
            // The second is on the side of the first where that has its own other side turned to.
            let along = || dot(normal, self.normal_at(wings, edge)) > 0.0;
            let is_above = if ours < theirs { is_first_outside } else { is_first_outside != along() };
            let is_first_above = dot(normal, sub(self.place(edge[0]), p)) > 0.0;
            crossings[at].remedy = Remedy::Back(usize::from(is_first_above == is_above));
        }
    }

    /// Whether most of a cloth is on the outer side of another, by the plane that fits the faces it goes through.
    fn is_above(&self, [ours, theirs]: [u32; 2], crossings: &[Crossing]) -> bool {
        let cloth = |point: u32| self.bodies.cloth[point as usize];
        let between =
            |crossing: &&Crossing| [cloth(crossing.edge[0]), cloth(crossing.face[0])] == [ours, theirs];
        let faces =
            || crossings.iter().filter(between).map(|crossing| crossing.face.map(|point| self.place(point)));
        let normal = faces().map(|[p, q, r]| cross(sub(q, p), sub(r, p))).fold([0.0; 3], add);
        let middle =
            scale(faces().map(|[p, _, _]| p).fold([0.0; 3], add), 1.0 / faces().count().max(1) as f64);
        let points = self.cloths[ours as usize].points();
        let above = points.clone().filter(|&point| dot(normal, sub(self.place(point), middle)) > 0.0).count();
        2 * above > points.len()
    }

    /// The normal of the faces beside an edge, of any length.
    fn normal_at(&self, wings: &[Wing], edge: [u32; 2]) -> [f64; 3] {
        let of_face = |&([p, q], wing, is_forward): &Wing| {
            let [p, q, wing] = [p, q, wing].map(|point| self.place(point));
            scale(cross(sub(q, p), sub(wing, p)), if is_forward { 1.0 } else { -1.0 })
        };
        beside(wings, edge).map(of_face).fold([0.0; 3], add)
    }

    fn place(&self, point: u32) -> [f64; 3] {
        add(self.anchors[point as usize], self.moved[point as usize].xyz().map(R::to_f64))
    }
}

/// The faces beside an edge.
fn beside(wings: &[Wing], [p, q]: [u32; 2]) -> impl Iterator<Item = &Wing> {
    let edge = [p.min(q), p.max(q)];
    let from = wings.partition_point(|wing| wing.0 < edge);
    wings[from..].iter().take_while(move |wing| wing.0 == edge)
}

impl Tangle {
    /// Says of every crossing what is done about it. What was on the wrong side stays so until it is back: a piece
    /// that shrinks must not become the right one half-way.
    fn find_remedies<R: Real>(&mut self, cloths: &[ClothModel<R>]) {
        let Self { crossings, points, is_wrong, .. } = self;
        let mut cut: Vec<[u32; 2]> = crossings.iter().map(|crossing| crossing.edge).collect();
        cut.sort_unstable();
        let mut pieces = Pieces::new(points.len());
        for &[a, b] in cloths.iter().flat_map(|cloth| &cloth.skin.edges) {
            if cut.binary_search(&[a, b]).is_err() {
                pieces.join(a, b);
            }
        }
        pieces.agree(is_wrong);
        let mut curves = Pieces::new(points.len());
        for Crossing { edge, face, .. } in crossings.iter() {
            edge.iter().chain(face).for_each(|&point| curves.join(edge[0], point));
        }
        // Of each curve that nobody has judged, the smallest piece that it cuts off; by size, then by its first point.
        let mut smallest = vec![Some((u32::MAX, u32::MAX)); points.len()];
        for [a, b] in crossings.iter().map(|crossing| crossing.edge) {
            let curve = &mut smallest[curves.of(a) as usize];
            let [here, there] = [a, b].map(|point| pieces.of(point));
            if is_wrong[a as usize] != is_wrong[b as usize] {
                *curve = None;
            } else if here != there {
                let least = (pieces.size(here), here).min((pieces.size(there), there));
                *curve = curve.map(|before| before.min(least));
            }
        }
        for (_, piece) in smallest.into_iter().flatten().filter(|&(size, _)| size < u32::MAX) {
            (0..points.len() as u32).filter(|&point| pieces.of(point) == piece).for_each(|point| {
                is_wrong[point as usize] = true;
            });
        }
        for crossing in crossings {
            let [a, b] = crossing.edge.map(|point| pieces.of(point));
            crossing.remedy = match crossing.edge.map(|point| is_wrong[point as usize]) {
                [true, false] => Remedy::Back(0),
                [false, true] => Remedy::Back(1),
                _ if a == b => Remedy::Shorten,
                _ => Remedy::Wait,
            };
        }
    }

    /// Gives every crossing the faces beside its edge, and marks the points round it.
    fn spread<R: Real>(&mut self, cloths: &[ClothModel<R>]) {
        let Self { crossings, points, wings, .. } = self;
        let faces = || cloths.iter().flat_map(|cloth| &cloth.skin.triangles);
        if wings.is_empty() {
            let sides = |&[a, b, c]: &[u32; 3]| [(a, b, c), (b, c, a), (c, a, b)];
            wings.extend(faces().flat_map(sides).map(|(p, q, wing)| ([p.min(q), p.max(q)], wing, p < q)));
            wings.sort_unstable();
        }
        points.fill(false);
        for crossing in crossings {
            let places = crossing.wings.iter_mut();
            places.zip(beside(wings, crossing.edge)).for_each(|(place, &(_, wing, _))| *place = wing);
            let Crossing { edge, wings, face, .. } = *crossing;
            edge.iter().chain(&wings).chain(&face).for_each(|&point| points[point as usize] = true);
        }
        let near: Vec<bool> = points.clone();
        for face in faces().filter(|face| face.iter().any(|&point| near[point as usize])) {
            face.iter().for_each(|&point| points[point as usize] = true);
        }
    }
}
