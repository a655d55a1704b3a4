//! One contact of a cloth element and a collider element: its separating plane, and its certificate.
//!
//! The plane is a direction `n`, and for each cloth point the gap n·x - max n·q over the collider's points. Both
//! sides move along straight lines within a step, and the maximum of linear functions is convex, so the gap is a
//! concave function of time. A positive gap at both ends of the step, for one `n`, *proves* that nothing passed
//! in between. Where the contact's own plane proves nothing, others are tried. Where none does, the element
//! returns to its side of the plane that held at the start of the step.

use std::sync::atomic::Ordering;

use nalgebra::Vector3;

use crate::bytes::{Encode, Reader};
use crate::contact::collider::motion_bounds::MotionBounds;
use crate::contact::collider::separation::{best_plane, separated};
use crate::contact::collider_maps::ColliderMaps;
use crate::contact::material::ContactMaterial;
use crate::contact::narrow_phase;
use crate::contact::time_step::{ColliderStep, ContactCounters};
use crate::math::{Real, Row4, add, dot, scale, sub};

pub(super) type Point = Vector3<f64>;

/// Motion along the plane for which it stays valid, as a share of the rest gap: around an edge or a corner the
/// error is below 1e-5 of it, and on a face it is zero.
const PLANE_VALIDITY: f64 = 1.0 / 256.0;

/// A contact of a cloth element of `N` points and a collider element of `M` points. Point and face: 1 and 3; edge
/// and edge: 2 and 2; face and point: 3 and 1.
#[derive(Debug, Clone, Copy)]
pub struct ColliderContact<R, const N: usize, const M: usize> {
    /// The cloth's points, as rows of the solver.
    pub points: [u32; N],
    /// The collider's points.
    pub collider_points: [u32; M],
    pub(super) normal: [R; 3],
    /// n·q less n·anchor for each cloth point, at the start and at the end of the candidate interval.
    plane: [[R; N]; 2],
    /// How far the plane is above the contact on the collider, at the start and at the end of the candidate interval: it is
    /// through the highest of the collider's points, and its normal is rounded and does not turn with the collider.
    excess: [R; 2],
    /// Weights of the cloth points at the contact.
    pub(super) weights: [R; N],
    /// Motion of the collider at the contact over the whole frame, in metres, as if it reached to the cloth.
    pub(super) surface_motion: [R; 3],
    /// Displacement of the contact when the plane was set.
    plane_origin: [R; 3],
}

impl<R: Real, const N: usize, const M: usize> Encode for ColliderContact<R, N, M> {
    const SIZE: usize =
        <[u32; N]>::SIZE + <[u32; M]>::SIZE + 3 * <[R; 3]>::SIZE + 3 * <[R; N]>::SIZE + <[R; 2]>::SIZE;
    fn encode(&self, out: &mut Vec<u8>) {
        let Self { points, collider_points, normal, plane, excess, weights, surface_motion, plane_origin } =
            self;
        points.encode(out);
        collider_points.encode(out);
        [*normal, *surface_motion, *plane_origin].encode(out);
        [plane[0], plane[1], *weights].encode(out);
        excess.encode(out);
    }
    fn decode(from: &mut Reader<'_>) -> Option<Self> {
        let (points, collider_points) = (Encode::decode(from)?, Encode::decode(from)?);
        let [normal, surface_motion, plane_origin] = Encode::decode(from)?;
        let [start, end, weights] = Encode::decode(from)?;
        let excess = Encode::decode(from)?;
        Some(Self {
            points,
            collider_points,
            normal,
            plane: [start, end],
            excess,
            weights,
            surface_motion,
            plane_origin,
        })
    }
}

/// A separating plane: its normal, and n·q and this less n·anchor for each cloth point, at the start and at the end of the
/// candidate interval.
#[derive(Debug, Clone, Copy)]
pub(super) struct Plane<R, const N: usize> {
    pub(super) normal: [R; 3],
    pub(super) heights: [f64; 2],
    pub(super) offsets: [[R; N]; 2],
}

/// The outcome of resolving a contact.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Outcome {
    /// It keeps its thickness.
    Separated,
    /// It was pushed to its thickness.
    Pushed,
    /// It would have passed, and was reverted to its side.
    Reverted,
    /// The two touched at the start of the step: no plane separates them, and they are left as they are.
    Inseparable,
}

impl Outcome {
    /// Counts it. Returns whether the contact moved anything.
    pub fn count(self, counters: &ContactCounters) -> bool {
        match self {
            Self::Separated | Self::Inseparable => return false,
            Self::Pushed => counters.contacts.fetch_add(1, Ordering::Relaxed),
            Self::Reverted => counters.pairs_reverted.fetch_add(1, Ordering::Relaxed),
        };
        true
    }
}

/// Whether a pair provably did not pass through each other in a step.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Certificate {
    /// It is certified.
    Separated,
    /// It is not certified: the safeguard acts.
    Unproven,
    /// The two touched at the start of the step, and one is behind the other's plane now: their sides are
    /// undefined.
    Inseparable,
}

impl<R: Real, const N: usize, const M: usize> ColliderContact<R, N, M> {
    /// A contact of some points that has no plane yet.
    #[cfg(test)]
    pub(super) fn at(points: [u32; N]) -> Self {
        let (zero, none) = ([R::ZERO; 3], [R::ZERO; N]);
        Self {
            points,
            collider_points: [0; M],
            normal: zero,
            plane: [none; 2],
            excess: [R::ZERO; 2],
            weights: none,
            surface_motion: zero,
            plane_origin: zero,
        }
    }

    /// A contact with its plane across the shortest line, whose ends are given by weights.
    #[inline(always)]
    pub(super) fn across(
        points: [u32; N],
        collider_points: [u32; M],
        plane: Plane<R, N>,
        weights: ([f64; N], [f64; M]),
        step: &ColliderStep<'_, R>,
    ) -> Self {
        let Plane { normal, heights, offsets } = plane;
        let zero = [R::ZERO; 3];
        let mut contact = Self {
            points,
            collider_points,
            normal,
            plane: offsets,
            excess: [R::ZERO; 2],
            weights: [R::ZERO; N],
            surface_motion: zero,
            plane_origin: zero,
        };
        contact.set_plane_origin(heights, weights, step);
        contact
    }

    /// A contact with a plane of its own, for tests.
    #[cfg(test)]
    pub(super) fn of_plane(points: [u32; N], normal: [R; 3], plane: [[R; N]; 2]) -> Self {
        let zero = [R::ZERO; 3];
        Self {
            points,
            collider_points: [0; M],
            normal,
            plane,
            excess: [R::ZERO; 2],
            weights: [R::ZERO; N],
            surface_motion: zero,
            plane_origin: zero,
        }
    }

    /// Whether the contact is in the interior of the cloth's element.
    pub fn is_interior(&self) -> bool {
        self.weights.iter().all(|&weight| weight > R::from_f64(1e-4))
    }

    /// The place of the contact on the cloth at the start of the step, in metres.
    pub(super) fn start_place(&self, step: &ColliderStep<'_, R>) -> Point {
        interpolate(step.cloth_start_positions(self.points), self.weights.map(R::to_f64))
    }

    /// Whether the contact is on the far side of the surface. `outward` is the pseudonormal there.
    pub fn is_behind(&self, outward: Point) -> bool {
        Point::from(self.normal.map(R::to_f64)).dot(&outward) < 0.0
    }

    /// The smallest gap along the plane over the motion bounds of the cloth's points, within a window. The window
    /// is given by shares of the candidate interval and the motion of the moving frame. A contact with a gap
    /// above the thickness cannot touch.
    #[inline(always)]
    pub fn min_gap<const W: usize>(&self, window: [(R, [R; 3]); W], bounds: &MotionBounds<'_, R>) -> R {
        // A loop, because maps over arrays are not inlined.
        let mut motions = [(R::ZERO, R::ZERO); W];
        for w in 0..W {
            motions[w] = (window[w].0, dot(self.normal, window[w].1));
        }
        let mut least = R::from_f64(f64::from(f32::MAX));
        for k in 0..N {
            let [low, high] = bounds.of(self.points[k]);
            let corner = |axis: usize| if self.normal[axis] > R::ZERO { low.0[axis] } else { high.0[axis] };
            let lowest = dot(self.normal, [corner(0), corner(1), corner(2)]);
            for (share, frame_motion) in motions {
                let gap = lowest + frame_motion - self.plane_at(k, share);
                least = if gap < least { gap } else { least };
            }
        }
        least
    }

    /// Rebases the plane on anchors that move to the points' positions; the collider is at rest.
    pub fn shift_anchors(&mut self, moved: &[Row4<R>]) {
        for k in 0..N {
            let by = moved[self.points[k] as usize].xyz();
            let along = dot(self.normal, by);
            self.plane[0][k] -= along;
            self.plane[1][k] -= along;
            for axis in 0..3 {
                self.plane_origin[axis] -= self.weights[k] * by[axis];
            }
        }
    }

    /// The plane's offset for a point at the start and at the end of the candidate interval.
    #[inline(always)]
    pub(super) fn plane_ends(&self, k: usize) -> [R; 2] {
        [self.plane[0][k], self.plane[1][k]]
    }

    /// The plane's offset for a point, at a share of the candidate interval.
    #[inline(always)]
    fn plane_at(&self, k: usize, share: R) -> R {
        self.plane[0][k] + (self.plane[1][k] - self.plane[0][k]) * share
    }

    /// The distance between the two elements at the end of the step, over their contact thickness.
    pub fn gap_ratio(&self, step: &ColliderStep<'_, R>) -> f64 {
        let (x, q) = (step.cloth_positions(self.points)[1], step.collider_positions(self.collider_points)[1]);
        let (b, c) = closest(x, q);
        (interpolate(x, b) - interpolate(q, c)).norm() / self.rest_gap(step, b.map(R::from_f64)).to_f64()
    }

    /// The gap at the contact above the plane, and the smallest gap of any point, at a share of the candidate interval.
    #[inline(always)]
    pub(super) fn gaps(&self, displacement: [[R; 3]; N], share: R) -> (R, R) {
        let mut at_contact = R::ZERO;
        let mut least = R::ZERO;
        for k in 0..N {
            let gap = dot(self.normal, displacement[k]) - self.plane_at(k, share);
            at_contact += self.weights[k] * gap;
            least = if k == 0 || gap < least { gap } else { least };
        }
        (at_contact, least)
    }

    /// How far the plane is above the contact on the collider, at a share of the candidate interval.
    #[inline(always)]
    pub(super) fn excess_at(&self, share: R) -> R {
        self.excess[0] + (self.excess[1] - self.excess[0]) * share
    }

    /// The gap at the contact, at a share of the candidate interval: from the contact on the collider, not from the plane.
    #[inline(always)]
    pub(super) fn gap_at(&self, displacement: [[R; 3]; N], share: R) -> R {
        self.gaps(displacement, share).0 + self.excess_at(share)
    }

    /// The gap at the contact at the start of the step.
    #[inline(always)]
    pub(super) fn gap_at_start(&self, step: &ColliderStep<'_, R>) -> R {
        self.gap_at(step.start_displacements(self.points), step.shares[0])
    }

    /// The gap at the contact at the end of the step.
    #[inline(always)]
    pub fn gap(&self, step: &ColliderStep<'_, R>) -> R {
        self.gap_at(step.displacements(self.points), step.shares[1])
    }

    /// The gaps above the plane at the start and at the end of the step. Those of a point are no larger than its distance.
    #[inline(always)]
    pub(super) fn gaps_above_plane(&self, step: &ColliderStep<'_, R>) -> [R; 2] {
        let [start, end] = [step.start_displacements(self.points), step.displacements(self.points)];
        [self.gaps(start, step.shares[0]).0, self.gaps(end, step.shares[1]).0]
    }

    /// Depenetration by colliders at the contact in this step, in metres.
    #[inline(always)]
    pub(super) fn depenetration(&self, step: &ColliderStep<'_, R>) -> [R; 3] {
        self.contact_displacement(self.points.map(|point| step.writer.depenetration(point)))
    }

    /// Whether the contact is still where its plane was set.
    #[inline(always)]
    pub(super) fn plane_is_valid(&self, displacement: [[R; 3]; N], step: &ColliderStep<'_, R>) -> bool {
        let time = R::from_f64(step.time.end);
        let displacement = self.contact_displacement(displacement);
        let away = sub(sub(displacement, scale(self.surface_motion, time)), self.plane_origin);
        let most = self.rest_gap(step, self.weights) * R::from_f64(PLANE_VALIDITY);
        dot(away, away) <= most * most
    }

    /// Displacement of the contact on the cloth.
    #[inline(always)]
    pub(super) fn contact_displacement(&self, displacement: [[R; 3]; N]) -> [R; 3] {
        let mut sum = scale(displacement[0], self.weights[0]);
        for k in 1..N {
            sum = add(sum, scale(displacement[k], self.weights[k]));
        }
        sum
    }

    /// Sets the plane through a contact, given by its normal and its weights.
    pub(super) fn set_plane(
        &mut self,
        normal: Point,
        weights: ([f64; N], [f64; M]),
        step: &ColliderStep<'_, R>,
    ) {
        let heights = self.set_plane_offsets(normal, step);
        self.set_plane_origin(heights, weights, step);
    }

    /// Sets the normal of the plane, and its offset for each point. Returns n·q at the start and at the end of the candidate
    /// interval.
    #[inline]
    fn set_plane_offsets(&mut self, normal: Point, step: &ColliderStep<'_, R>) -> [f64; 2] {
        self.normal = [normal.x, normal.y, normal.z].map(R::from_f64);
        // Rounds first, so that offset and direction belong together to the last bit.
        let normal = Point::from(self.normal.map(R::to_f64));
        let [start, end] = step.support(normal, &self.collider_points);
        // Loops, because maps over these arrays are not inlined.
        for k in 0..N {
            let anchor = normal.dot(&Point::from(step.anchors[self.points[k] as usize]));
            (self.plane[0][k], self.plane[1][k]) = (R::from_f64(start - anchor), R::from_f64(end - anchor));
        }
        [start, end]
    }

    /// How far what keeps its thickness from the surface moves along it in the frame because the surface turns, in metres.
    #[inline]
    fn turn(&self, step: &ColliderStep<'_, R>, ends: &[[Point; M]; 2]) -> Point {
        let Some(turning) = step.turning else { return Point::zeros() };
        let normal = Point::from(self.normal.map(R::to_f64));
        turning.of_normal(normal, ends) * self.rest_gap(step, self.weights).to_f64()
    }

    /// Sets the weights of the contact, and the place where its plane was set; `heights` are those of the plane.
    #[inline]
    fn set_plane_origin(
        &mut self,
        heights: [f64; 2],
        (b, c): ([f64; N], [f64; M]),
        step: &ColliderStep<'_, R>,
    ) {
        let mut ends = [[Point::zeros(); M]; 2];
        for k in 0..M {
            let point = self.collider_points[k] as usize;
            (ends[0][k], ends[1][k]) = (step.collider[0][point], step.collider[1][point]);
        }
        let start = interpolate(ends[0], c);
        let motion = interpolate(ends[1], c) - start;
        let normal = Point::from(self.normal.map(R::to_f64));
        let times = step.interval.ends();
        for end in 0..2 {
            self.excess[end] = R::from_f64(heights[end] - normal.dot(&(start + motion * times[end])));
        }
        self.weights = b.map(R::from_f64);
        self.surface_motion = (motion + self.turn(step, &ends)).map(R::from_f64).into();
        let contact = self.contact_displacement(step.displacements(self.points));
        let time = R::from_f64(step.time.end);
        self.plane_origin = sub(contact, scale(self.surface_motion, time));
    }
}

/// Displacement of a contact whose plane is valid nowhere: it serves certificates, and a push needs another.
const NOWHERE: f64 = 1e18;

impl<R: Real> ColliderContact<R, 1, 3> {
    /// The contact of a free point and a face, with a plane of this normal; `weights` are those of the closest point of the
    /// face at the start of the step, if the plane is across the shortest line.
    pub fn of_free_point(
        point: u32,
        corners: [u32; 3],
        normal: Point,
        weights: Option<[f64; 3]>,
        step: &ColliderStep<'_, R>,
    ) -> Self {
        let zero = [R::ZERO; 3];
        let mut contact = Self {
            points: [point],
            collider_points: corners,
            normal: zero,
            plane: [[R::ZERO; 1]; 2],
            excess: [R::ZERO; 2],
            weights: [R::ZERO; 1],
            surface_motion: zero,
            plane_origin: zero,
        };
        contact.set_plane(normal, ([1.0], weights.unwrap_or([1.0 / 3.0; 3])), step);
        if weights.is_none() {
            contact.excess = [R::ZERO; 2]; // No contact is known that it could be above.
            contact.plane_origin = [R::from_f64(NOWHERE); 3];
        }
        contact
    }
}

/// The closest points of two elements, as weights.
pub(super) fn closest<const N: usize, const M: usize>(x: [Point; N], q: [Point; M]) -> ([f64; N], [f64; M]) {
    narrow_phase::closest(x.map(Into::into), q.map(Into::into))
}

/// A direction across two elements, of any length.
pub(super) fn cross_direction<const N: usize, const M: usize>(x: [Point; N], q: [Point; M]) -> Point {
    narrow_phase::cross_direction(x.map(Into::into), q.map(Into::into)).into()
}

pub(super) fn interpolate<const K: usize>(points: [Point; K], weights: [f64; K]) -> Point {
    let mut sum = Point::zeros();
    for k in 0..K {
        sum += points[k] * weights[k];
    }
    sum
}

impl<R: Real, const N: usize, const M: usize> ColliderContact<R, N, M> {
    /// Certifies the contact in this step; may set another plane that proves it.
    #[inline]
    pub fn certify(&mut self, step: &ColliderStep<'_, R>) -> Certificate {
        let moved = step.displacements(self.points);
        let [x, y, z] = moved[0].map(|x| if x > R::ZERO { x } else { -x });
        let size = x + y + z;
        // Gaps within rounding error are computed in double precision.
        let rounding = (size + step.thickness) * (R::EPSILON * R::from_f64(16.0));
        let (_, at_end) = self.gaps(moved, step.shares[1]);
        // The plane may have been set at the end of this step, and prove nothing at its start.
        let (_, at_start) = self.gaps(step.start_displacements(self.points), step.shares[0]);
        if (at_end > rounding && at_start > rounding) || self.may_interpenetrate(step) {
            return Certificate::Separated;
        }
        self.certify_with_other_plane(step, at_end)
    }

    /// Whether the scene lets the two pass through each other, because collisions are carried out in part.
    #[cold]
    pub(super) fn may_interpenetrate(&self, step: &ColliderStep<'_, R>) -> bool {
        let of_points = |map: &[R]| !map.is_empty() && self.points.iter().any(|&p| map[p as usize] < R::ONE);
        let all = step.material.strength.iter().any(|&side| side < R::ONE);
        let there = || step.collider_maps.is_some_and(|maps| maps.are_partial(&self.collider_points));
        step.is_partial() && (all || of_points(&step.material_maps.strength) || there())
    }

    /// The material at the contact. `mapped` holds it where the collider has vertex maps.
    #[inline(always)]
    pub(super) fn material<'m>(
        &self,
        step: &'m ColliderStep<'_, R>,
        mapped: &'m mut Option<ContactMaterial<R>>,
    ) -> &'m ContactMaterial<R> {
        match step.collider_maps {
            None => &step.material,
            Some(maps) => mapped.insert(self.mapped_material(step, maps)),
        }
    }

    #[cold]
    fn mapped_material(&self, step: &ColliderStep<'_, R>, maps: &ColliderMaps) -> ContactMaterial<R> {
        let (x, q) = (step.cloth_positions(self.points)[1], step.collider_positions(self.collider_points)[1]);
        step.material.scaled(maps.at(self.collider_points, closest(x, q).1))
    }

    /// The distance to keep at the contact, in metres, with these weights of the cloth's points.
    #[inline(always)]
    pub(super) fn rest_gap(&self, step: &ColliderStep<'_, R>, weights: [R; N]) -> R {
        step.rest_gap(self.material(step, &mut None), self.points, weights)
    }

    #[cold]
    fn certify_with_other_plane(&mut self, step: &ColliderStep<'_, R>, at_end: R) -> Certificate {
        let (cloth, surface) =
            (step.cloth_positions(self.points), step.collider_positions(self.collider_points));
        let ([x0, x1], [q0, q1]) = (cloth, surface);
        let at_start = closest(x0, q0);
        let line = |x, q, (b, c)| interpolate(x, b) - interpolate(q, c);
        let directions = [
            line(x0, q0, at_start),
            cross_direction(x1, q1),
            cross_direction(x0, q0),
            line(x1, q1, closest(x1, q1)),
        ];
        match best_plane(directions, cloth, surface) {
            Some((gap, normal)) if gap > 0.0 => self.set_plane(normal, at_start, step),
            Some(_) if !separated(cloth, surface, step.of_free_points) => return Certificate::Unproven,
            None if at_end < R::ZERO => return Certificate::Inseparable,
            _ => {}
        }
        Certificate::Separated
    }
}
