//! One contact of two elements that can both move.
//!
//! Its normal separated the two at the start of the time step. While it separates them at the end too, they have
//! not passed through each other; otherwise the certificate tries other directions.

use std::sync::atomic::{AtomicBool, Ordering};

use crate::bytes::{Encode, Reader, encode_struct};
use crate::contact::cloth::local_anchors::LocalAnchors;
use crate::contact::cloth::swept_points::ElementPoints;
use crate::contact::material::{ContactMaterial, ContactPoints, MaterialMaps};
use crate::contact::narrow_phase::{ElementPositions, gap_along, shortest_line};
use crate::contact::pair_table::ContactMaterials;
use crate::contact::time_step::PositionWriter;
use crate::math::{Real, Row4, add, sub};
use crate::state::State;

/// A time step of all cloths.
#[derive(Clone, Copy)]
pub struct ClothStep<'a, R> {
    /// The positions of all points.
    pub writer: PositionWriter<'a, R>,
    /// Displacements at the start of the step.
    pub start: &'a [Row4<R>],
    /// The anchors that displacements are relative to, in metres.
    pub origins: &'a [[f64; 3]],
    /// For fast gaps; `None` where all are to be computed.
    pub local_anchors: Option<&'a LocalAnchors<R>>,
    /// Friction anchors; `None` outside of contact passes.
    pub anchors: Option<FrictionAnchors<'a, R>>,
    /// The cloths whose contacts are resolved; all where it is empty.
    pub mask: &'a [bool],
    /// Contact materials, by cloth and cloth.
    pub materials: &'a ContactMaterials<R>,
    /// Vertex maps of contact attributes.
    pub material_maps: &'a MaterialMaps<R>,
    /// Length of the step in seconds.
    pub h: R,
    /// Factor on every thickness: below one where there is too little clearance.
    pub thickness_scale: R,
    /// By cloth: the mean motion of its island in the step, in metres, to which motion is truncated instead of to rest.
    pub drift: &'a [Option<[R; 3]>],
}

/// The reference of friction anchors.
#[derive(Clone, Copy)]
pub struct FrictionAnchors<'a, R> {
    /// Displacements at the start of the candidate interval.
    pub interval_start: &'a [Row4<R>],
    /// Pairs of intersecting cloths, the lower index first. They are to separate, so they have no anchors.
    pub intersecting: &'a [[u32; 2]],
}

impl<R> FrictionAnchors<'_, R> {
    /// Whether two cloths intersect, given their pair in the order of their contacts.
    #[inline(always)]
    pub(super) fn are_intersecting(&self, cloths: impl FnOnce() -> [usize; 2]) -> bool {
        if self.intersecting.is_empty() {
            return false;
        }
        let [a, b] = cloths().map(|cloth| cloth as u32);
        self.intersecting.contains(&[a.min(b), a.max(b)])
    }
}

impl<'a, R: Real> ClothStep<'a, R> {
    /// A step of `h` seconds that resolves the contacts of all cloths, without friction anchors.
    pub fn new(
        state: &'a mut State<R>,
        materials: &'a ContactMaterials<R>,
        material_maps: &'a MaterialMaps<R>,
        h: f64,
    ) -> Self {
        let (writer, start, origins) = PositionWriter::of(state);
        let (h, thickness_scale) = (R::from_f64(h), R::ONE);
        Self {
            writer,
            start,
            origins,
            local_anchors: None,
            anchors: None,
            mask: &[],
            materials,
            material_maps,
            h,
            thickness_scale,
            drift: &[],
        }
    }
}

impl<R: Real> ClothStep<'_, R> {
    #[inline(always)]
    pub(super) fn row(&self, point: u32) -> Row4<R> {
        self.writer.row(point) // tasks of a phase share no block, and a contact's points are in its task's blocks
    }

    #[inline(always)]
    pub(super) fn start(&self, point: u32) -> [R; 3] {
        self.start[point as usize].xyz()
    }
}

/// The parameters of a contact.
#[derive(Debug, Clone, Copy)]
pub struct ContactParams<R> {
    /// Contact thickness in metres: the largest value under the vertex maps.
    pub thickness: R,
    /// The material, and what is known of the contact.
    pub kind: ContactKind,
}

/// The index of a contact's material, and what is known of the contact, in one word: contacts are most of the memory of a
/// heap.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ContactKind {
    word: u32,
}

impl ContactKind {
    /// The thickness is reduced, because the two are neighbours at rest.
    pub const REST_LIMITED: u32 = 1 << 31;
    /// Motion bounds certify that the two keep a gap.
    pub const CERTIFIED: u32 = 1 << 30;
    /// One side is a free point, which can move many times its size in a step.
    pub const HAS_FREE_POINT: u32 = 1 << 29;
    /// It has a friction anchor.
    pub const HAS_ANCHOR: u32 = 1 << 28;
    /// The two were nearer than their thickness when they were found, and have not been apart since.
    pub const OVERLAPS: u32 = 1 << 27;

    /// The number of cloths of which every pair still has an index below the facts.
    pub const MAX_CLOTHS: usize = (Self::OVERLAPS as usize).isqrt();

    /// A contact of a material, of which nothing is known.
    #[inline(always)]
    pub fn of_material(material: u32) -> Self {
        debug_assert!(material < Self::OVERLAPS, "the builder refuses more than MAX_CLOTHS");
        Self { word: material }
    }

    /// The index of the contact material.
    #[inline(always)]
    pub fn material(self) -> u32 {
        self.word & (Self::OVERLAPS - 1)
    }

    /// Whether a fact is known.
    #[inline(always)]
    pub fn is(self, fact: u32) -> bool {
        self.word & fact != 0
    }

    /// The same without a fact.
    #[inline(always)]
    pub fn without(self, fact: u32) -> Self {
        Self { word: self.word & !fact }
    }

    /// The same with another fact, if it holds.
    #[inline(always)]
    pub fn with(self, fact: u32, holds: bool) -> Self {
        Self { word: if holds { self.word | fact } else { self.word } }
    }
}

/// Share of the thickness below which two elements overlap: layers at rest keep more under their load.
pub(super) const OVERLAP: f64 = 0.95;

/// Two elements that a search has found: they can touch within the candidate interval.
#[derive(Debug, Clone, Copy)]
pub struct Candidate<R, const N: usize, const M: usize> {
    /// Points of the one element and of the other, as rows of the solver.
    pub points: ElementPoints<N, M>,
    /// Along the shortest line at the start of the time step, from theirs to ours.
    pub normal: [R; 3],
    /// The parameters of their contact.
    pub params: ContactParams<R>,
}

impl<R: Real, const N: usize, const M: usize> Candidate<R, N, M> {
    /// Notes whether the two overlap at a distance in metres. Neighbours at rest are pressed together where cloth folds.
    pub(super) fn mark_overlap(&mut self, distance: R) {
        let ContactParams { thickness, kind } = self.params;
        let overlaps = !kind.is(ContactKind::REST_LIMITED) && distance < thickness * R::from_f64(OVERLAP);
        self.params.kind = kind.with(ContactKind::OVERLAPS, overlaps);
    }
}

/// A contact: `N` points of one element, `M` of the other.
#[derive(Debug, Clone, Copy)]
pub struct ClothContact<R, const N: usize, const M: usize> {
    /// Points of the one element, as rows of the solver.
    pub ours: [u32; N],
    /// Points of the other.
    pub theirs: [u32; M],
    /// From theirs to ours; it separated the two at the start of the step. Zero if no direction held throughout
    /// the last one.
    pub(super) normal: [R; 3],
    /// Friction anchor: the slip of ours along theirs at the start of the candidate interval, in metres, that
    /// friction is still to reverse. Valid only with
    /// [`ContactKind::HAS_ANCHOR`].
    pub(super) friction_anchor: [R; 3],
    pub(super) params: ContactParams<R>,
}

encode_struct!([] ContactKind { word: u32 });
encode_struct!([R: Real] ContactParams<R> { thickness: R, kind: ContactKind });

impl<R: Real, const N: usize, const M: usize> Encode for ClothContact<R, N, M> {
    const SIZE: usize = <ElementPoints<N, M>>::SIZE + <[[R; 3]; 2]>::SIZE + ContactParams::<R>::SIZE;
    fn encode(&self, out: &mut Vec<u8>) {
        let Self { ours, theirs, normal, friction_anchor, params } = self;
        (*ours, *theirs).encode(out);
        [*normal, *friction_anchor].encode(out);
        params.encode(out);
    }
    fn decode(from: &mut Reader<'_>) -> Option<Self> {
        let (ours, theirs) = Encode::decode(from)?;
        let [normal, friction_anchor] = Encode::decode(from)?;
        Some(Self { ours, theirs, normal, friction_anchor, params: Encode::decode(from)? })
    }
}

impl<R: Real, const N: usize, const M: usize> ClothContact<R, N, M> {
    /// The contact of a candidate, without a friction anchor.
    pub fn new(candidate: &Candidate<R, N, M>) -> Self {
        let Candidate { points: (ours, theirs), normal, params } = *candidate;
        Self { ours, theirs, normal, friction_anchor: [R::ZERO; 3], params }
    }

    /// The positions of its points, in metres relative to the anchor of the first.
    #[inline(always)]
    pub(super) fn positions(
        &self,
        origins: &[[f64; 3]],
        displacement: impl Fn(u32) -> [R; 3],
    ) -> ElementPositions<R, N, M> {
        positions((&self.ours, &self.theirs), origins, displacement)
    }

    #[inline(always)]
    pub(super) fn end_positions(&self, step: &ClothStep<'_, R>) -> ElementPositions<R, N, M> {
        self.positions(step.origins, |point| step.row(point).xyz())
    }

    #[inline(always)]
    pub(super) fn start_positions(&self, step: &ClothStep<'_, R>) -> ElementPositions<R, N, M> {
        self.positions(step.origins, |point| step.start(point))
    }

    /// The contact material of the two cloths.
    #[inline(always)]
    pub(super) fn material<'a>(&self, step: &ClothStep<'a, R>) -> Option<&'a ContactMaterial<R>> {
        step.materials.values().get(self.params.kind.material() as usize)?.as_ref()
    }

    /// Whether this pass resolves it.
    #[inline(always)]
    pub(super) fn is_resolved(&self, step: &ClothStep<'_, R>) -> bool {
        step.mask.is_empty() || step.mask[self.cloths(step.materials)[0]]
    }

    /// The motion of its island in the step to which its own is truncated, in metres.
    pub(super) fn drift(&self, step: &ClothStep<'_, R>) -> [R; 3] {
        step.drift.get(self.cloths(step.materials)[0]).copied().flatten().unwrap_or([R::ZERO; 3])
    }

    /// The cloths of its two sides.
    #[inline(always)]
    pub fn cloths(&self, materials: &ContactMaterials<R>) -> [usize; 2] {
        materials.pair(self.params.kind.material() as usize)
    }

    /// Marks the cloths of its two sides.
    pub(super) fn mark_cloths(&self, materials: &ContactMaterials<R>, marks: &[AtomicBool]) {
        self.cloths(materials).into_iter().for_each(|cloth| marks[cloth].store(true, Ordering::Relaxed));
    }

    /// The points of the two and their weights.
    #[inline(always)]
    pub(super) fn contact_points<'a>(&self, weights: &'a ([R; N], [R; M])) -> ContactPoints<'a, R, N, M> {
        (self.ours, self.theirs, weights)
    }

    /// The distance to keep at the contact, in metres.
    #[inline(always)]
    pub(super) fn rest_gap(&self, step: &ClothStep<'_, R>, weights: &([R; N], [R; M])) -> R {
        self.thickness_at(step.materials, step.material_maps, weights) * step.thickness_scale
    }

    /// The distance to keep at the closest points, in metres.
    pub(super) fn rest_gap_at(&self, step: &ClothStep<'_, R>, at: &ElementPositions<R, N, M>) -> R {
        self.rest_gap(step, &shortest_line(*at).1)
    }

    /// The contact thickness at the contact, in metres.
    #[inline(always)]
    pub fn thickness_at(
        &self,
        materials: &ContactMaterials<R>,
        material_maps: &MaterialMaps<R>,
        weights: &([R; N], [R; M]),
    ) -> R {
        let most = self.params.thickness;
        let there = |materials: &ContactMaterial<R>| {
            materials.thickness_at(material_maps, self.contact_points(weights), most)
        };
        if material_maps.thickness.is_empty() {
            return most;
        }
        materials.values()[self.params.kind.material() as usize].as_ref().map_or(most, there)
    }

    /// Whether the gap along the normal exceeds `least` metres and any rounding error, as far as a fast test can tell.
    #[inline(always)]
    pub(super) fn certainly_exceeds(&self, step: &ClothStep<'_, R>, least: R) -> bool {
        let min_gap = |anchors: &LocalAnchors<R>| {
            anchors.min_gap::<N, M>(self.normal, self.points(), |point| step.row(point))
        };
        step.local_anchors.and_then(min_gap).is_some_and(|gap| gap > least)
    }

    /// The gap along the normal.
    #[inline(always)]
    pub(super) fn gap(&self, at: &ElementPositions<R, N, M>) -> R {
        gap_along(self.normal, at)
    }

    /// Its points, first ours, then theirs; the rest repeats the first.
    pub fn points(&self) -> [u32; 4] {
        let mut points = [self.ours[0]; 4];
        points.iter_mut().zip(self.ours.iter().chain(&self.theirs)).for_each(|(at, point)| *at = *point);
        points
    }

    /// Whether the thickness is reduced, because the two are neighbours at rest.
    pub fn is_rest_limited(&self) -> bool {
        self.params.kind.is(ContactKind::REST_LIMITED)
    }

    /// Whether one side is a free point.
    pub(super) fn has_free_point(&self) -> bool {
        self.params.kind.is(ContactKind::HAS_FREE_POINT)
    }

    /// Whether the two were nearer than their thickness when they were found, and have not been apart since.
    pub(super) fn overlaps(&self) -> bool {
        self.params.kind.is(ContactKind::OVERLAPS)
    }

    /// Whether it has a friction anchor.
    pub(super) fn has_anchor(&self) -> bool {
        self.params.kind.is(ContactKind::HAS_ANCHOR)
    }

    /// Whether motion bounds certify it.
    pub fn is_certified(&self) -> bool {
        self.params.kind.is(ContactKind::CERTIFIED)
    }

    /// The contact with other rows of its points; `None` where one has no number.
    pub fn renumbered(&self, number: impl Fn(u32) -> Option<u32>) -> Option<Self> {
        let (ours, theirs) = (self.ours.map(&number), self.theirs.map(&number));
        let is_whole = ours.iter().chain(&theirs).all(Option::is_some);
        let (ours, theirs) = (ours.map(Option::unwrap_or_default), theirs.map(Option::unwrap_or_default));
        is_whole.then_some(Self { ours, theirs, ..*self })
    }

    /// Whether it refers to existing points and to an existing material.
    pub fn is_valid(&self, are_points: impl Fn(&[u32]) -> bool, materials: usize) -> bool {
        are_points(&self.ours)
            && are_points(&self.theirs)
            && (self.params.kind.material() as usize) < materials
    }

    /// The distance between the two, over their contact thickness.
    pub fn gap_ratio(&self, step: &ClothStep<'_, R>) -> R {
        let (_, weights, distance) = shortest_line(self.end_positions(step));
        distance / self.rest_gap(step, &weights)
    }
}

/// The positions of the points of two elements, in metres relative to the anchor of the first.
#[inline(always)]
pub(super) fn positions<R: Real, const N: usize, const M: usize>(
    (ours, theirs): (&[u32; N], &[u32; M]),
    origins: &[[f64; 3]],
    displacement: impl Fn(u32) -> [R; 3],
) -> ElementPositions<R, N, M> {
    let first = origins[ours[0] as usize];
    let position = |point: u32| {
        let [x, y, z] = sub(origins[point as usize], first);
        add([R::from_f64(x), R::from_f64(y), R::from_f64(z)], displacement(point))
    };
    // Loops, because maps over these arrays are not inlined.
    let mut at = ([[R::ZERO; 3]; N], [[R::ZERO; 3]; M]);
    at.0[0] = displacement(ours[0]);
    for k in 1..N {
        at.0[k] = position(ours[k]);
    }
    for k in 0..M {
        at.1[k] = position(theirs[k]);
    }
    at
}
