//! Detection of intersections: finds the edges that pierce faces, groups them into contours by union-find, and
//! chooses a correction for each.

use crate::contact::bvh::Aabb;
use crate::contact::cloth::contacts::GROUPS_PER_TASK;
use crate::contact::cloth::element_bounds::ElementBounds;
use crate::contact::cloth::elements::ElementGroups;
use crate::contact::cloth::group_bounds::GroupBounds;
use crate::contact::cloth::local_origins::OriginShift;
use crate::contact::cloth::search::SearchInput;
use crate::contact::cloth::untangling::{Correction, Intersection, Untangling, Wing, pierces};
use crate::contact::pair_filter::PairFilter;
use crate::contact::pair_table::ContactMaterials;
use crate::math::{Real, Row4, add, cross, dot, scale, sub};
use crate::model::ClothModel;
use crate::parallel::thread_pool::ThreadPool;
use crate::union_find::UnionFind;

/// Finds all intersections at the start of the time step: the end is not certified yet, and what would pass on the way there
/// is not to be untangled but stopped. Valid while the boxes of the last search are. Returns how many pairs that a broken weld has
/// released intersect for the first time: they had no contact until it broke.
pub fn find_intersections<R: Real>(
    elements: &ElementGroups,
    bounds: (&ElementBounds, &[GroupBounds]),
    materials: &ContactMaterials<R>,
    input: &SearchInput<'_, R>,
    untangling: &mut Untangling,
    pool: &ThreadPool,
) -> u64 {
    untangling.is_search_due.fill(false);
    let SearchInput { cloths, anchors, displacement: [displacement, _], strength, filter, .. } = *input;
    let search =
        IntersectionSearch { elements, bounds, materials, cloths, anchors, displacement, strength, filter };
    let groups = elements.groups.len();
    let mut found = vec![Vec::new(); groups.div_ceil(GROUPS_PER_TASK)];
    pool.for_each_mut(&mut found, |task, found| {
        for group in task * GROUPS_PER_TASK..groups.min((task + 1) * GROUPS_PER_TASK) {
            (0..cloths.len()).for_each(|cloth| search.find_with(group as u32, cloth, found));
        }
    });
    note_known(untangling, filter);
    untangling.intersections.clear();
    found.iter().for_each(|found| untangling.intersections.extend_from_slice(found));
    if untangling.any() {
        untangling.mark_neighbourhood(cloths);
        untangling.choose_corrections(cloths);
        search.choose_sides(untangling);
    } else {
        untangling.is_on_wrong_side.fill(false);
        untangling.sides.clear();
    }
    count_released(untangling, filter)
}

/// Notes the intersections of the last search, where a weld has released any pairs.
fn note_known(untangling: &mut Untangling, filter: &PairFilter) {
    let Untangling { intersections, known, .. } = untangling;
    known.clear();
    if filter.has_released() {
        known.extend(intersections.iter().map(|known| (known.edge, known.face)));
        known.sort_unstable();
    }
}

/// The number of released pairs that intersect and did not at the last search.
fn count_released(untangling: &Untangling, filter: &PairFilter) -> u64 {
    if !filter.has_released() {
        return 0;
    }
    let Untangling { intersections, known, .. } = untangling;
    let released = intersections.iter().filter(|found| filter.are_released(&found.edge, &found.face));
    released.filter(|found| known.binary_search(&(found.edge, found.face)).is_err()).count() as u64
}

struct IntersectionSearch<'a, R> {
    elements: &'a ElementGroups,
    bounds: (&'a ElementBounds, &'a [GroupBounds]),
    materials: &'a ContactMaterials<R>,
    cloths: &'a [ClothModel<R>],
    anchors: &'a [[f64; 3]],
    displacement: &'a [Row4<R>],
    strength: &'a [R],
    filter: &'a PairFilter,
}

impl<R: Real> IntersectionSearch<'_, R> {
    /// All edges of a group that pierce a face of a cloth.
    fn find_with(&self, group: u32, cloth: usize, found: &mut Vec<Intersection>) {
        let own = self.elements.groups[group as usize].cloth as usize;
        let material = &self.materials[[own, cloth]];
        if !material.as_ref().is_some_and(|material| material.strength == [R::ONE; 2]) {
            return;
        }
        let shift = self.bounds.0.origins.shift([own, cloth]);
        let swept_box = shift.apply(&self.elements.swept_boxes[group as usize], 0.0);
        let [start, end] = swept_box;
        self.elements.query_cloth(cloth, &start.union(end), |other| {
            if Aabb::may_overlap(&swept_box, &self.elements.swept_boxes[other as usize]) {
                self.find_between(group, other, &shift, found);
            }
        });
    }

    /// All edges of one group that pierce a face of another. `shift` leads to the origin of the other's cloth.
    fn find_between(&self, group: u32, other: u32, shift: &OriginShift, found: &mut Vec<Intersection>) {
        let [ours, theirs] = [group, other].map(|group| &self.elements.groups[group as usize]);
        let position = |point: u32| self.position(point);
        let has_full_strength = |points: &[u32]| {
            self.strength.is_empty() || points.iter().all(|&p| self.strength[p as usize] >= R::ONE)
        };
        let edges = &self.cloths[ours.cloth as usize].boundary.edges[ours.group.edges.clone()];
        let faces = &self.cloths[theirs.cloth as usize].boundary.triangles[theirs.group.triangles.clone()];
        let (bounds, of_groups) = self.bounds;
        let back = bounds.origins.shift([theirs.cloth as usize, ours.cloth as usize]);
        let [ours, theirs] = [group, other].map(|group| &of_groups[group as usize]);
        ours.edges.for_each_overlap(&back.apply(&self.elements.swept_boxes[other as usize], 0.0), |edge| {
            let edge = edges[edge];
            if !has_full_strength(&edge) {
                return;
            }
            theirs.triangles.for_each_overlap(&shift.apply(&bounds.bound(&edge, 0.0), 0.0), |face| {
                let face = faces[face];
                let is_joined =
                    face.iter().any(|point| edge.contains(point)) || self.filter.excludes(&edge, &face);
                if !is_joined && has_full_strength(&face) && pierces(edge.map(position), face.map(position)) {
                    let wings = [edge[0]; 2];
                    found.push(Intersection { edge, wings, face, correction: Correction::None });
                }
            });
        });
    }

    /// Chooses corrections between two cloths: the first belongs on the side of the second where most of it is.
    fn choose_sides(&self, untangling: &mut Untangling) {
        let Untangling { intersections, sides, cloth_pairs, wings, .. } = untangling;
        cloth_pairs.clear();
        let cloth = |point: u32| self.elements.cloth[point as usize];
        for at in 0..intersections.len() {
            let Intersection { edge, face, .. } = intersections[at];
            let (ours, theirs) = (cloth(edge[0]), cloth(face[0]));
            let pair = [ours.min(theirs), ours.max(theirs)];
            if !cloth_pairs.contains(&pair) {
                cloth_pairs.push(pair);
            }
            if ours == theirs {
                continue;
            }
            let previous = sides.iter().find(|side| side.0 == pair).map(|side| side.1);
            let is_first_outside = previous.unwrap_or_else(|| self.is_above(pair, intersections));
            if previous.is_none() {
                sides.push((pair, is_first_outside));
            }
            let [p, q, r] = face.map(|point| self.position(point));
            let normal = cross(sub(q, p), sub(r, p));
            // The second is above the first where the first's outer side faces it.
            let along = || dot(normal, self.normal_at(wings, edge)) > 0.0;
            let is_above = if ours < theirs { is_first_outside } else { is_first_outside != along() };
            let is_first_above = dot(normal, sub(self.position(edge[0]), p)) > 0.0;
            intersections[at].correction = Correction::ReturnEnd(usize::from(is_first_above == is_above));
        }
    }

    /// Whether most of a cloth is on the outer side of another, by the mean plane of the faces it pierces.
    fn is_above(&self, [ours, theirs]: [u32; 2], intersections: &[Intersection]) -> bool {
        let cloth = |point: u32| self.elements.cloth[point as usize];
        let between = |intersection: &&Intersection| {
            [cloth(intersection.edge[0]), cloth(intersection.face[0])] == [ours, theirs]
        };
        let faces = || {
            intersections
                .iter()
                .filter(between)
                .map(|intersection| intersection.face.map(|point| self.position(point)))
        };
        let normal = faces().map(|[p, q, r]| cross(sub(q, p), sub(r, p))).fold([0.0; 3], add);
        let middle =
            scale(faces().map(|[p, _, _]| p).fold([0.0; 3], add), 1.0 / faces().count().max(1) as f64);
        let points = self.cloths[ours as usize].points();
        let above =
            points.clone().filter(|&point| dot(normal, sub(self.position(point), middle)) > 0.0).count();
        2 * above > points.len()
    }

    /// The sum of the normals of the faces at an edge.
    fn normal_at(&self, wings: &[Wing], edge: [u32; 2]) -> [f64; 3] {
        let of_face = |&([p, q], wing, is_forward): &Wing| {
            let [p, q, wing] = [p, q, wing].map(|point| self.position(point));
            scale(cross(sub(q, p), sub(wing, p)), if is_forward { 1.0 } else { -1.0 })
        };
        beside(wings, edge).map(of_face).fold([0.0; 3], add)
    }

    fn position(&self, point: u32) -> [f64; 3] {
        add(self.anchors[point as usize], self.displacement[point as usize].xyz().map(R::to_f64))
    }
}

/// The faces at an edge.
fn beside(wings: &[Wing], [p, q]: [u32; 2]) -> impl Iterator<Item = &Wing> {
    let edge = [p.min(q), p.max(q)];
    let from = wings.partition_point(|wing| wing.0 < edge);
    wings[from..].iter().take_while(move |wing| wing.0 == edge)
}

impl Untangling {
    /// Chooses corrections within one cloth. Points on the wrong side stay marked until they are back: a piece
    /// that shrinks must not become the right side half-way.
    fn choose_corrections<R: Real>(&mut self, cloths: &[ClothModel<R>]) {
        let Self { intersections, near_contour: points, is_on_wrong_side, .. } = self;
        let mut cut: Vec<[u32; 2]> = intersections.iter().map(|intersection| intersection.edge).collect();
        cut.sort_unstable();
        let mut pieces = UnionFind::new(points.len());
        for &[a, b] in cloths.iter().flat_map(|cloth| &cloth.boundary.edges) {
            if cut.binary_search(&[a, b]).is_err() {
                pieces.union(a, b);
            }
        }
        pieces.take_majority(is_on_wrong_side);
        let mut contours = UnionFind::new(points.len());
        for Intersection { edge, face, .. } in intersections.iter() {
            edge.iter().chain(face).for_each(|&point| contours.union(edge[0], point));
        }
        // For each contour without marked points, the smallest piece that it cuts off; by size, then by first
        // point.
        let mut smallest = vec![Some((u32::MAX, u32::MAX)); points.len()];
        for [a, b] in intersections.iter().map(|intersection| intersection.edge) {
            let contour = &mut smallest[contours.find(a) as usize];
            let [here, there] = [a, b].map(|point| pieces.find(point));
            if is_on_wrong_side[a as usize] != is_on_wrong_side[b as usize] {
                *contour = None;
            } else if here != there {
                let least = (pieces.size(here), here).min((pieces.size(there), there));
                *contour = contour.map(|before| before.min(least));
            }
        }
        let mut is_wrong_piece = vec![false; points.len()];
        let found = smallest.into_iter().flatten().filter(|&(size, _)| size < u32::MAX);
        found.for_each(|(_, piece)| is_wrong_piece[piece as usize] = true);
        for (point, is_wrong) in (0..).zip(is_on_wrong_side.iter_mut()) {
            *is_wrong |= is_wrong_piece[pieces.find(point) as usize];
        }
        for intersection in intersections {
            let [a, b] = intersection.edge.map(|point| pieces.find(point));
            intersection.correction = match intersection.edge.map(|point| is_on_wrong_side[point as usize]) {
                [true, false] => Correction::ReturnEnd(0),
                [false, true] => Correction::ReturnEnd(1),
                _ if a == b => Correction::ShortenContour,
                _ => Correction::None,
            };
        }
    }

    /// Sets the wings of every intersection, and marks the points near a contour.
    fn mark_neighbourhood<R: Real>(&mut self, cloths: &[ClothModel<R>]) {
        let Self { intersections, near_contour: points, wings, .. } = self;
        let faces = || cloths.iter().flat_map(|cloth| &cloth.boundary.triangles);
        if wings.is_empty() {
            let sides = |&[a, b, c]: &[u32; 3]| [(a, b, c), (b, c, a), (c, a, b)];
            wings.extend(faces().flat_map(sides).map(|(p, q, wing)| ([p.min(q), p.max(q)], wing, p < q)));
            wings.sort_unstable();
        }
        points.fill(false);
        for intersection in intersections {
            let wing_slots = intersection.wings.iter_mut();
            wing_slots.zip(beside(wings, intersection.edge)).for_each(|(slot, &(_, wing, _))| *slot = wing);
            let Intersection { edge, wings, face, .. } = *intersection;
            edge.iter().chain(&wings).chain(&face).for_each(|&point| points[point as usize] = true);
        }
        let near: Vec<bool> = points.clone();
        for face in faces().filter(|face| face.iter().any(|&point| near[point as usize])) {
            face.iter().for_each(|&point| points[point as usize] = true);
        }
    }
}
