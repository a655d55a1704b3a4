//! Bending with a sign: hinges that are bent at rest, and everything that depends on which way they bend.
//!
//! The bending vector c of a [`hinge`](super::hinge) lies along the bisector n of its faces' normals, so s = ±|c|, with the
//! sign of c·n, is twice the sine of half the signed angle. A hinge with a rest angle then has one rest shape instead of
//! two mirrored ones (`bendSolver`: High Quality). The correction is (s - s_rest) m, where m is c/|c| with that sign, and n
//! where the hinge is flat, so no shape is singular.
//!
//! - `bendAngleScale` multiplies s_rest.
//! - `bendAngleDropoff` d: the resistance is a share (1 - d) + d |s - s_rest| / s_max of the whole, so near-flat cloth is soft.
//! - Flip tracking: a hinge whose sign changes while it is folded by more than 90° has been folded past 180°. It is pushed
//!   back the way it came: its chord counts as 2 s_max - |c| with the old sign.

use nalgebra::Vector3;

use crate::input::frame::Bending;
use crate::math::kernel::{self, Kernel};
use crate::math::{Lanes, Real, Row4, by_axis, cross, dot};
use crate::model::rows::Row;
use crate::model::surface::Surface;
use crate::parallel::disjoint::DisjointSlice;

use super::bend::BendStrength;
use super::hinge::{HingeGroup, HingeRow, MIN_COSINE, weights};
use super::side_by_side::{group_starts, load_each, store};
use super::strength_map::{StrengthGroup, StrengthMap};

/// Vectors that give four hinges their sign, in addition to the hinges.
#[derive(Debug, Clone, Copy)]
pub struct AngleGroup<R> {
    /// From the first end of the edge of the anchors to the other, and to the middles of the far sides.
    pub anchored: [[[R; 4]; 3]; 3],
    /// Chord at rest with its sign, unscaled. Changes where bends can stay.
    pub rest: [R; 4],
    /// The sign that a hinge folded past 180° had before; 0 for all others.
    pub flipped: [R; 4],
    /// The sign of each hinge while it is not flipped; 0 before it was ever looked at.
    pub side: [R; 4],
}

/// The angle of one hinge, before it is laid out like the hinge.
#[derive(Debug, Clone, Copy)]
pub struct AngleRow<R, const N: usize> {
    points: [u32; N],
    rest: R,
}

impl<R: Real, const N: usize> AngleRow<R, N> {
    /// The angle of a hinge with a chord `rest` at rest.
    pub fn new(points: [u32; N], rest: f64) -> Self {
        Self { points, rest: R::from_f64(rest) }
    }
}

impl<R: Real, const N: usize> Row for AngleRow<R, N> {
    type Group = AngleGroup<R>;
    const POINTS: usize = N;
    const GROUPS: usize = HingeRow::<R, N>::GROUPS;

    fn point(&self, k: usize) -> u32 {
        self.points[k]
    }

    fn idle(stand_in: u32) -> Self {
        Self { points: [stand_in; N], rest: R::ZERO }
    }

    fn group(rows: [Self; 4]) -> AngleGroup<R> {
        AngleGroup {
            anchored: [[[R::ZERO; 4]; 3]; 3],
            rest: rows.map(|row| row.rest),
            flipped: [R::ZERO; 4],
            side: [R::ZERO; 4],
        }
    }
}

impl<R: Real, const N: usize> HingeRow<R, N> {
    /// The signed angle of the hinge in the mesh that it was made from; `point` gives the mesh's point of a row.
    pub fn angle(&self, surface: &Surface, point: impl Fn(u32) -> usize) -> AngleRow<R, N> {
        let x = self.points.map(|row| surface.positions[point(row)]);
        let c: Vector3<f64> = x.iter().zip(&self.weights).map(|(x, w)| x * w.to_f64()).sum();
        let n = bisector(spans(x.map(Into::into)));
        let sign = if c.dot(&Vector3::from(n)) < 0.0 { -1.0 } else { 1.0 };
        AngleRow::new(self.points, self.rest.to_f64() * sign)
    }
}

/// How a sweep reads angles.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AngleStrength<R> {
    /// `bendAngleScale`.
    pub scale: R,
    /// `bendAngleDropoff`, 0 to 1.
    pub dropoff: R,
}

impl<R: Real> AngleStrength<R> {
    /// The strength that the attributes of a cloth give.
    pub fn of(bending: &Bending) -> Self {
        Self {
            scale: R::from_f64(bending.angle_scale),
            dropoff: R::from_f64(bending.angle_dropoff.clamp(0.0, 1.0)),
        }
    }
}

/// The points of the two far sides of a hinge: one each between triangles, two each between quads.
const fn far_sides<const N: usize>() -> [&'static [usize]; 2] {
    if N == 6 { [&[2, 3], &[4, 5]] } else { [&[2], &[3]] }
}

/// The sum of the unit normals of a hinge's two faces, from the vectors of its edge and to its far sides.
pub fn bisector([edge, left, right]: [[f64; 3]; 3]) -> [f64; 3] {
    let [edge, left, right] = [edge, left, right].map(Vector3::from);
    let unit = |v: Vector3<f64>| v.try_normalize(0.0).unwrap_or_default();
    (unit(edge.cross(&left)) + unit(right.cross(&edge))).into()
}

impl<R: Real> AngleGroup<R> {
    /// Takes up where the anchors now are, in double precision.
    pub fn anchor<const N: usize>(&mut self, hinge: &HingeGroup<R, N>, anchors: &[[f64; 3]]) {
        for lane in 0..4 {
            let x = hinge.points.map(|point| anchors[point[lane] as usize]);
            let vectors = spans(x);
            for (vector, span) in self.anchored.iter_mut().zip(vectors) {
                for axis in 0..3 {
                    vector[axis][lane] = R::from_f64(span[axis]);
                }
            }
        }
    }
}

/// The vectors of the edge and to the far sides of each hinge, in lanes.
#[inline(always)]
fn spans_of<R: Real, L: Lanes<R>, const N: usize>(angles: &[AngleGroup<R>], x: &[[L; 4]; N]) -> [[L; 3]; 3] {
    let [near, other] = far_sides::<N>();
    // A loop, because a closure that computes in lanes is not inlined.
    let mut spans = [[L::splat(R::ZERO); 3]; 3];
    for axis in 0..3 {
        let ends = [x[1][axis], far_end(x, near, axis), far_end(x, other, axis)];
        for vector in 0..3 {
            let anchored = L::of_groups(|k| angles[k].anchored[vector][axis]);
            spans[vector][axis] = anchored + (ends[vector] - x[0][axis]);
        }
    }
    spans
}

/// A coordinate of the middle of a far side.
#[inline(always)]
fn far_end<R: Real, L: Lanes<R>, const N: usize>(x: &[[L; 4]; N], side: &[usize], axis: usize) -> L {
    match side {
        [one] => x[*one][axis],
        [one, other] => (x[*one][axis] + x[*other][axis]) * L::splat(R::from_f64(0.5)),
        _ => x[0][axis],
    }
}

/// The vectors of a hinge's edge and to its far sides, from the positions of its points.
pub fn spans<const N: usize>(x: [[f64; 3]; N]) -> [[f64; 3]; 3] {
    let from_first = |side: &[usize]| {
        [0, 1, 2].map(|axis| side.iter().map(|&k| x[k][axis]).sum::<f64>() / side.len() as f64 - x[0][axis])
    };
    let [near, far] = far_sides::<N>();
    [from_first(&[1]), from_first(near), from_first(far)]
}

/// The chord of hinges with its sign, the direction of their correction, and their longest chord.
struct Measured<L> {
    chord: L,
    direction: [L; 3],
    longest: L,
}

/// Share of the longest chord below which the direction of a hinge turns from c to the bisector.
const NEAR_FLAT: f64 = 0.02;

/// Measures the hinges of groups side by side; `x` are the columns of their points.
#[inline(always)]
fn measure<R: Real, L: Lanes<R>, const N: usize>(
    hinges: &[HingeGroup<R, N>],
    angles: &[AngleGroup<R>],
    x: &[[L; 4]; N],
) -> Measured<L> {
    let splat = |value: f64| L::splat(R::from_f64(value));
    let (zero, one, tiny) = (splat(0.0), splat(1.0), L::splat(R::MIN_DENOMINATOR));
    let mut c = by_axis(|axis| L::of_groups(|k| hinges[k].anchored[axis]));
    let weights: [L; N] = weights(hinges);
    for k in 0..N {
        for axis in 0..3 {
            c[axis] = c[axis] + weights[k] * x[k][axis];
        }
    }
    let [edge, left, right] = spans_of(angles, x);
    let [one_normal, other_normal] = [cross(edge, left), cross(right, edge)];
    let one_length = dot(one_normal, one_normal).sqrt() + tiny;
    let other_length = dot(other_normal, other_normal).sqrt() + tiny;
    let n = by_axis(|axis| one_normal[axis] / one_length + other_normal[axis] / other_length);
    let length = dot(c, c).sqrt();
    let sign = dot(c, n).choose_by_sign(one, zero - one);
    let fold = L::of_groups(|k| hinges[k].inverse_square_max);
    // The twist of a quad has no fold: its chord is measured by its own rest.
    let longest = (fold - tiny).choose_by_sign(one / (fold.most(tiny)).sqrt(), length + tiny);
    let flat = longest * splat(NEAR_FLAT);
    let m = by_axis(|axis| c[axis] * sign + n[axis] * flat);
    let size = dot(m, m).sqrt() + tiny;
    let direction = by_axis(|axis| m[axis] / size);
    let flipped = L::of_groups(|k| angles[k].flipped);
    let past = flipped * flipped;
    let chord = (one - past) * (sign * length) + flipped * (longest + longest - length);
    Measured { chord, direction, longest }
}

/// Hinges, their angles, and the vertex map of their angles, which is empty where there is none.
pub type MappedAngles<'a, R, const N: usize> =
    (&'a [HingeGroup<R, N>], &'a [AngleGroup<R>], &'a [StrengthGroup<R>]);

/// Sweeps hinges once, in order or backward, with their angles and their strength map.
///
/// # Safety
/// The groups come in twos whose rows share no point, and no other task of the loop touches their points.
#[allow(unsafe_code)]
#[inline]
pub unsafe fn relax<R: Real, P: StrengthMap<R>, const N: usize>(
    points: DisjointSlice<'_, Row4<R>>,
    lists: MappedAngles<'_, R, N>,
    map: P,
    backward: bool,
    strength: (&BendStrength<R>, &AngleStrength<R>),
) {
    // SAFETY: the caller's promise.
    unsafe { kernel::run(AngleSweep { points, lists, map, backward, strength }) };
}

/// A sweep over hinges with angles; see [`relax`].
pub(super) struct AngleSweep<'a, R, P, const N: usize> {
    pub(super) points: DisjointSlice<'a, Row4<R>>,
    pub(super) lists: MappedAngles<'a, R, N>,
    pub(super) map: P,
    pub(super) backward: bool,
    pub(super) strength: (&'a BendStrength<R>, &'a AngleStrength<R>),
}

#[allow(unsafe_code)]
impl<R: Real, P: StrengthMap<R>, const N: usize> Kernel<R> for AngleSweep<'_, R, P, N> {
    /// # Safety
    /// See [`relax`].
    #[inline(always)]
    unsafe fn run<L: Lanes<R>>(self) {
        let Self { points, lists: (hinges, angles, angle_maps), map, backward, strength } = self;
        let (strength, reading) = strength;
        let (share, compliance) = (L::splat(strength.share), L::splat(strength.compliance));
        let (zero, one, tiny) = (L::splat(R::ZERO), L::splat(R::ONE), L::splat(R::MIN_DENOMINATOR));
        let least = L::splat(R::from_f64(MIN_COSINE * MIN_COSINE));
        let (scale, dropoff) = (L::splat(reading.scale), L::splat(reading.dropoff));
        for at in group_starts::<R, L>(hinges.len(), backward) {
            let (hinges, angles) = (&hinges[at..at + L::GROUPS], &angles[at..at + L::GROUPS]);
            let weights: [L; N] = weights(hinges);
            // SAFETY: the caller's promise.
            let x: [[L; 4]; N] = unsafe { load_each(points, |k, group| hinges[group].points[k]) };
            let Measured { chord, direction, longest } = measure(hinges, angles, &x);
            let mut mobility = zero;
            for (k, x) in x.iter().enumerate() {
                let weight = weights[k];
                mobility = mobility + x[3] * weight * weight;
            }
            let error = chord - L::of_groups(|k| angles[k].rest) * scale;
            let size = error.most(zero - error);
            let bent = (size / (longest + tiny)).least(one);
            let dropoff = match angle_maps {
                [] => dropoff,
                maps => (dropoff * L::of_groups(|k| maps[at + k].above)).least(one),
            };
            let grown = (one - dropoff) + dropoff * bent;
            // cos²(θ/2), within bounds: the moment grows with the angle.
            let cosine = one - chord * chord * L::of_groups(|k| hinges[k].inverse_square_max);
            let cosine = (cosine - least).choose_by_sign(cosine, least);
            let (share, compliance) = map.scale(at, error, share * grown, compliance / (grown + tiny));
            let lambda = share * error / (mobility + compliance * cosine.sqrt() + tiny);
            let push = by_axis(|axis| direction[axis] * lambda);
            for (k, [px, py, pz, w]) in x.into_iter().enumerate() {
                let [mx, my, mz] = by_axis(|axis| weights[k] * push[axis]);
                // SAFETY: the caller's promise.
                unsafe {
                    let moved = [px - w * mx, py - w * my, pz - w * mz, w];
                    store(points, |group| hinges[group].points[k], moved);
                }
            }
        }
    }
}

/// The update of rest angles after a time step: plastic bends, and hinges folded past 180°.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AngleMemory<R> {
    /// `bendAngleScale`.
    pub scale: R,
    /// Sine of half the angle beyond which bends stay; above 1 none do.
    pub yield_sine: R,
    /// Half that angle in radians, for a vertex map to scale.
    pub yield_half_angle: f64,
    /// Whether hinges that are folded past 180° are followed.
    pub tracks_flips: bool,
}

/// The new rest of a hinge that is bent farther from rest than its limit: the bend less the limit. All are sines of half
/// the angle, and the bend is above 1 past 180°. `None` within the limit.
fn permanent(bend: f64, rest: f64, limit: f64) -> Option<f64> {
    let cosine = (1.0 - limit * limit).max(0.0).sqrt();
    let across = (1.0 - bend * bend).max(0.0).sqrt();
    // sin(a ∓ b); past 180°, where there is no such angle, the chords are subtracted.
    let [less, more] = match bend.abs() <= 1.0 {
        true => [bend * cosine - across * limit, bend * cosine + across * limit],
        false => [bend - limit, bend + limit],
    };
    // Within the half turn in which the sine grows.
    let beyond = (bend > -cosine && less > rest).then_some(less);
    beyond.or((bend < cosine && more < rest).then_some(more))
}

impl<R: Real> AngleMemory<R> {
    /// Whether there is anything to remember.
    pub fn is_on(&self) -> bool {
        self.tracks_flips || self.yield_sine <= R::ONE || self.yield_half_angle.is_finite()
    }

    /// Brings the memory of four hinges up to where their points are.
    pub fn update<const N: usize>(
        &self,
        hinge: &HingeGroup<R, N>,
        angle: &mut AngleGroup<R>,
        map: Option<&StrengthGroup<R>>,
        displacement: &[Row4<R>],
    ) {
        let x = hinge
            .points
            .map(|ends| R::Lanes::transpose(ends.map(|point| displacement[point as usize].lanes())));
        let unflipped = AngleGroup { flipped: [R::ZERO; 4], ..*angle };
        let now = measure(std::slice::from_ref(hinge), &[unflipped], &x);
        let (chord, longest) = (now.chord.to_array(), now.longest.to_array());
        for lane in 0..4 {
            if hinge.inverse_square_max[lane] == R::ZERO {
                continue; // the twist of a quad has no angle
            }
            if self.tracks_flips {
                self.follow(angle, lane, chord[lane], longest[lane]);
            }
            let yield_sine = map.map_or(self.yield_sine, |map| self.mapped_sine(map.below[lane]));
            let chord = measured(angle.flipped[lane], chord[lane], longest[lane]);
            let rest = angle.rest[lane] * self.scale;
            if yield_sine <= R::ONE && self.scale != R::ZERO && longest[lane] > R::ZERO {
                let [chord, rest] = [chord, rest].map(|x| (x / longest[lane]).to_f64());
                if let Some(set) = permanent(chord, rest, yield_sine.to_f64()) {
                    angle.rest[lane] = longest[lane] * R::from_f64(set) / self.scale;
                }
            }
        }
    }

    /// The sine of half the angle beyond which a hinge with this factor keeps its bend; above 1 from 180° on.
    fn mapped_sine(&self, factor: R) -> R {
        let half = self.yield_half_angle * factor.to_f64();
        R::from_f64(if half < std::f64::consts::FRAC_PI_2 { sine(half) } else { f64::INFINITY })
    }

    /// A sign that changes while the hinge is folded by more than 90° has gone past 180°.
    fn follow(&self, angle: &mut AngleGroup<R>, lane: usize, chord: R, longest: R) {
        let size = if chord < R::ZERO { -chord } else { chord };
        let is_folded = size * R::from_f64(std::f64::consts::SQRT_2) > longest;
        let sign = if chord < R::ZERO { -R::ONE } else { R::ONE };
        let side = angle.side[lane];
        let is_flipped = angle.flipped[lane] != R::ZERO;
        if is_folded && side * sign < R::ZERO {
            angle.flipped[lane] = side;
        } else if !is_flipped || is_folded {
            (angle.flipped[lane], angle.side[lane]) = (R::ZERO, sign);
        }
    }
}

/// The sine of 0 to 90° in radians, to 6e-8, by its series: the same bits on every machine.
fn sine(x: f64) -> f64 {
    let square = x * x;
    let terms = [110.0, 72.0, 42.0, 20.0, 6.0];
    x * terms.iter().fold(1.0, |sum, term| 1.0 - square / term * sum)
}

fn measured<R: Real>(flipped: R, chord: R, longest: R) -> R {
    let size = if chord < R::ZERO { -chord } else { chord };
    if flipped == R::ZERO { chord } else { flipped * (longest + longest - size) }
}
