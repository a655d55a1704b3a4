//! The narrow phase among cloths: which pairs of elements whose boxes overlap can touch, eight at a time.
//!
//! Most pairs stay apart along the line between their centroids; of the others the least distance over the candidate interval
//! is computed, and that at rest, which limits the thickness of neighbours.

use crate::contact::bvh::SweptBox;
use crate::contact::ccd::CERTIFIED_GAP;
use crate::contact::closest_lanes::{Positions, closest, interpolate, of_lane};
use crate::contact::cloth::contact::{Candidate, ContactKind, ContactParams};
use crate::contact::cloth::element_bounds::ContactDistance;
use crate::contact::cloth::found_contacts::{FoundContacts, FoundPairs};
use crate::contact::cloth::local_origins::{OriginShift, ROUNDING};
use crate::contact::cloth::new_elements::NewElements;
use crate::contact::cloth::normals::SetNormals;
use crate::contact::cloth::search::{ClothSearch, SearchInput};
use crate::contact::cloth::swept_points::{ElementPoints, PairPoints, ShiftedCloth};
use crate::contact::material::{ContactMaterial, MIN_THICKNESS};
use crate::contact::narrow_phase::shortest_line;
use crate::contact::response::TOUCHING_GAP;
use crate::math::kernel::{self, Kernel};
use crate::math::{Lanes, Real, add, dot, sub};

/// Two cloths, or one and itself, and their contact material.
pub(super) struct ClothPair<'a, R> {
    pub(super) search: &'a ClothSearch<'a, R>,
    /// By index; the first is that of the group that is searched.
    pub(super) cloths: [usize; 2],
    pub(super) material: &'a ContactMaterial<R>,
    /// Contact thickness in metres, and interaction range in thicknesses.
    thickness_and_range: [f32; 2],
    /// Positions at rest, where elements can be neighbours.
    rest: Option<&'a [[f32; 3]]>,
    /// From our origin to theirs, between two cloths.
    shift: Option<OriginShift>,
    /// How far the two reach to each other beyond the margins of their boxes, in metres.
    margin: f32,
}

impl<'a, R: Real> ClothPair<'a, R> {
    /// `None` where the two do not collide.
    pub(super) fn new(search: &'a ClothSearch<'a, R>, cloths: [usize; 2]) -> Option<Self> {
        let material = search.materials[cloths].as_ref()?;
        // Free points have no shape at rest, so they have no neighbours.
        let is_shaped =
            cloths[0] == cloths[1] && !search.input.cloths[cloths[0]].boundary.triangles.is_empty();
        let reach = (material.thickness * material.adhesion_range) as f32 * (1.0 + 1e-5);
        Some(Self {
            search,
            cloths,
            material,
            thickness_and_range: [material.thickness as f32, material.adhesion_range as f32],
            rest: is_shaped.then_some(&search.elements.rest_positions[..]),
            shift: (cloths[0] != cloths[1]).then(|| search.bounds.origins.shift(cloths)),
            margin: (reach - search.margins[cloths[0]] - search.margins[cloths[1]]).max(0.0),
        })
    }

    /// A swept box of ours among theirs: relative to their origin, and as far as the two reach.
    pub(super) fn in_their_space(&self, swept_box: &SweptBox) -> SweptBox {
        self.shift.map_or(*swept_box, |shift| shift.apply(swept_box, self.margin))
    }

    /// The same for elements of ours with new bounds; `shifted` is a buffer.
    pub(super) fn elements_in_their_space<'b>(
        &self,
        new: &'b NewElements,
        shifted: &'b mut NewElements,
    ) -> &'b NewElements {
        let Some(shift) = &self.shift else { return new };
        shifted.fill_shifted(new, shift, self.margin);
        shifted
    }

    /// The swept positions of both, relative to their origin.
    fn swept_points(&self) -> PairPoints<'_> {
        let ClothSearch { bounds, elements, .. } = self.search;
        let shifted = |shift| ShiftedCloth { of_point: &elements.cloth, cloth: self.cloths[0] as u32, shift };
        PairPoints { points: bounds.swept_points(), shifted: self.shift.map(shifted) }
    }

    /// Contacts of the pairs whose boxes overlap.
    pub(super) fn find_contacts(&self, found: &mut FoundContacts<R>) {
        self.find_contacts_of(&mut found.point_face);
        self.find_contacts_of(&mut found.edge_edge);
        self.find_contacts_of(&mut found.point_edge);
        self.find_contacts_of(&mut found.point_point);
    }

    fn find_contacts_of<const N: usize, const M: usize>(&self, found: &mut FoundPairs<R, N, M>) {
        if found.overlapping.is_empty() {
            return;
        }
        let known = found.candidates.len();
        let may_overlap = self.search.overlapping[self.cloths];
        let SearchInput { anchors, displacement: [start, _], .. } = self.search.input;
        // SAFETY: these kernels ask for nothing but the lanes.
        #[allow(unsafe_code)]
        unsafe {
            kernel::run(NearPairs { pair: self, found });
            // By itself, because it has the solver's scalar.
            kernel::run(SetNormals {
                candidates: &mut found.candidates[known..],
                anchors,
                start,
                may_overlap,
            });
        }
        found.overlapping.clear();
    }

    /// The contact distance in metres of two elements that coincide at rest or were welded, and have been released: their
    /// distance at the start of the step, so that they can part and not pass. Zero where they touch: what intersects is
    /// untangled, and what slides along each other in one plane has no normal.
    #[cold]
    fn released_distance<const N: usize, const M: usize>(&self, (ours, theirs): ElementPoints<N, M>) -> f32 {
        let SearchInput { filter, anchors, displacement: [start, _], .. } = self.search.input;
        if !(filter.tears() || filter.are_released(&ours, &theirs)) || filter.are_joined(&ours, &theirs) {
            return 0.0;
        }
        let place = |point: u32| add(anchors[point as usize], start[point as usize].xyz().map(R::to_f64));
        let (_, _, distance) = shortest_line((ours.map(place), theirs.map(place)));
        let touching = f64::from(self.thickness_and_range[0]) * TOUCHING_GAP;
        let is_apart = distance > touching.max(MIN_THICKNESS * CERTIFIED_GAP);
        if is_apart { distance.max(MIN_THICKNESS) as f32 } else { 0.0 }
    }

    /// The contact of two elements that stay at least `least` metres apart and are `at_rest` metres apart at rest, if they can
    /// touch.
    #[inline(always)]
    fn contact<const N: usize, const M: usize>(
        &self,
        points: ElementPoints<N, M>,
        [least, at_rest]: [f32; 2],
    ) -> Option<Candidate<R, N, M>> {
        let ClothSearch { input, untangling, elements, .. } = self.search;
        let released = || self.released_distance(points);
        let at_rest = if input.filter.are_released(&points.0, &points.1) { 0.0 } else { at_rest };
        let distance = ContactDistance::new([least, at_rest], self.thickness_and_range, released)?;
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

/// Appends the contacts of pairs whose boxes overlap, without their normals.
struct NearPairs<'a, R, const N: usize, const M: usize> {
    pair: &'a ClothPair<'a, R>,
    found: &'a mut FoundPairs<R, N, M>,
}

impl<R: Real, const N: usize, const M: usize> Kernel<f32> for NearPairs<'_, R, N, M> {
    /// # Safety
    /// The machine has the lanes.
    #[inline(always)]
    #[allow(unsafe_code)]
    unsafe fn run<L: Lanes<f32>>(self) {
        let Self { pair, found: FoundPairs { candidates, overlapping, .. } } = self;
        let lanes = 4 * L::GROUPS;
        let [thickness, range] = pair.thickness_and_range;
        let (points, share) = (pair.swept_points(), pair.search.input.interval_share as f32);
        let mut near = 0;
        for first in (0..overlapping.len()).step_by(lanes) {
            let count = (overlapping.len() - first).min(lanes);
            let some = &overlapping[first..first + count];
            let separated = points.separated_centroids::<L, N, M>(some, share, thickness * range);
            for lane in (0..count).filter(|lane| separated & (1 << lane) == 0) {
                overlapping[near] = overlapping[first + lane];
                near += 1;
            }
        }
        for some in overlapping[..near].chunks(lanes) {
            let least: L = points.min_distances(some, share);
            let close = (L::splat(thickness * range) - least).above_zero();
            if close == 0 {
                continue;
            }
            let at_rest: L = match pair.rest {
                Some(rest) => distances_at_rest(some, rest),
                None => L::splat(f32::INFINITY),
            };
            let (least, at_rest) = (to_eight(least), to_eight(at_rest));
            let of_lane = |(lane, &points): (usize, &ElementPoints<N, M>)| {
                let is_close = close & (1 << lane) != 0;
                is_close.then(|| pair.contact(points, [least[lane], at_rest[lane]])).flatten()
            };
            candidates.extend(some.iter().enumerate().filter_map(of_lane));
        }
    }
}

/// The distances of up to eight pairs at rest; zero within rounding error, as for the diagonals of a doubled face: elements that
/// coincide at rest have no separating direction.
#[inline(always)]
fn distances_at_rest<L: Lanes<f32>, const N: usize, const M: usize>(
    pairs: &[ElementPoints<N, M>],
    rest: &[[f32; 3]],
) -> L {
    let (mut ours, mut theirs) = ([[L::splat(0.0); 3]; N], [[L::splat(0.0); 3]; M]);
    for k in 0..N {
        ours[k] = rest_positions(rest, |lane| of_lane(pairs, lane).0[k]);
    }
    for k in 0..M {
        theirs[k] = rest_positions(rest, |lane| of_lane(pairs, lane).1[k]);
    }
    let weights = closest::<f32, L, N, M>(ours, theirs);
    let line = sub(interpolate(&ours, &weights.0), interpolate(&theirs, &weights.1));
    let distance = dot(line, line).sqrt();
    let rounding = (size(ours[0]) + size(theirs[0])) * L::splat(ROUNDING);
    (distance - rounding).choose_by_sign(distance, L::splat(0.0))
}

#[inline(always)]
fn size<L: Lanes<f32>>([x, y, z]: Positions<L>) -> L {
    let zero = L::splat(0.0);
    x.most(zero - x) + y.most(zero - y) + z.most(zero - z)
}

/// The position at rest of the point of each lane.
#[inline(always)]
fn rest_positions<L: Lanes<f32>>(rest: &[[f32; 3]], point: impl Fn(usize) -> u32) -> Positions<L> {
    let mut rows = [L::splat(0.0); 4];
    for (k, row) in rows.iter_mut().enumerate() {
        *row = L::of_groups(|group| {
            let [x, y, z] = rest[point(4 * group + k) as usize];
            [x, y, z, 0.0]
        });
    }
    let [x, y, z, _] = L::transpose(rows);
    [x, y, z]
}

#[inline(always)]
fn to_eight<L: Lanes<f32>>(lanes: L) -> [f32; 8] {
    let mut eight = [0.0; 8];
    lanes.for_groups(|group, four| eight[4 * group..4 * group + 4].copy_from_slice(&four));
    eight
}
