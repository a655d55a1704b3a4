//! The projection of links: four side by side, or eight where the machine has lanes for them.
//!
//! C(x) = |x_b - x_a| - l, projected by inverse mass (Müller et al. 2007, §4.1) with the compliance of Macklin et al.
//! 2016, eq. 18. The multiplier starts at zero in every sweep, because a time step has one sweep only (Physical), or
//! there is no compliance (Classic).
//!
//! Eight links are two groups of one colour, so they share no point, and both widths give the same bits.

use crate::math::{Lanes, Real, Row4, Two};
use crate::parallel::disjoint::DisjointSlice;

use super::strength_map::{Sides, StrengthGroup, StrengthMap, Uniform};
use super::stretch::{LinkGroup, LinkStrength};

/// How four links side by side resist. By itself a strength map scales the compliance of the sweep.
pub trait LinkLaw<R: Real>: StrengthMap<R> {
    /// The multipliers of the corrections, over the lengths of the links, from those lengths and the sums of the
    /// inverse masses.
    #[inline(always)]
    fn multiplier(
        self,
        projection: &LinkProjection<R::Lanes>,
        group: &LinkGroup<R>,
        [length, mobility]: [R::Lanes; 2],
    ) -> R::Lanes {
        let [rest, slenderness] = [group.rest_length, group.slenderness].map(R::Lanes::from_array);
        let [c, share, compliance] = projection.violation(length, rest);
        let (share, compliance) = self.scale(c, share, compliance);
        projection.multiplier([c, share, compliance * slenderness], [length, mobility])
    }
}

impl<R: Real> LinkLaw<R> for Uniform {}
impl<R: Real> LinkLaw<R> for &StrengthGroup<R> {}

/// Sweeps the links of `groups` once, each group with its law.
///
/// # Safety
/// The rows of a group share no point, and no other task of the loop touches the points of `groups`.
#[allow(unsafe_code)]
#[inline]
pub unsafe fn relax<'a, R: Real, P: LinkLaw<R>>(
    points: DisjointSlice<'_, Row4<R>>,
    groups: impl Iterator<Item = (&'a LinkGroup<R>, P)>,
    strength: &LinkStrength<R>,
) {
    let projection = LinkProjection::new(strength);
    for (group, law) in groups {
        // SAFETY: the caller's promise.
        let ends = group.ends.map(|ends| ends.map(|end| unsafe { points.get(end) }.lanes()));
        let moved = projection.correction(group, law, ends).moved();
        for (ends, moved) in group.ends.iter().zip(moved) {
            for (&end, moved) in ends.iter().zip(moved) {
                // SAFETY: the caller's promise.
                unsafe { points.set(end, Row4(moved.to_array())) };
            }
        }
    }
}

/// Sweeps links that all have the strength of the sweep once, two groups at a time. Of each link the first `MOVED` ends
/// move.
///
/// # Safety
/// `groups` come in twos as [`Row::GROUPS`](crate::model::rows::Row::GROUPS) lays them out: the rows of two share no point
/// that moves. No other task of the loop touches the points that move, or writes the others.
#[allow(unsafe_code)]
pub unsafe fn relax_uniform<R: Real, const MOVED: usize>(
    points: DisjointSlice<'_, Row4<R>>,
    groups: &[LinkGroup<R>],
    backward: bool,
    strength: &LinkStrength<R>,
) {
    // SAFETY: the caller's promise, and the machine has the lanes.
    unsafe {
        #[cfg(target_arch = "x86_64")]
        if R::has_wide_lanes() {
            return relax_avx2::<R, MOVED>(points, groups, backward, strength);
        }
        relax_pairs::<R, Two<R::Lanes>, MOVED>(points, groups, backward, strength);
    }
}

/// # Safety
/// See [`relax_uniform`]; the machine has AVX2.
#[cfg(target_arch = "x86_64")]
#[allow(unsafe_code)]
#[target_feature(enable = "avx2")]
unsafe fn relax_avx2<R: Real, const MOVED: usize>(
    points: DisjointSlice<'_, Row4<R>>,
    groups: &[LinkGroup<R>],
    backward: bool,
    strength: &LinkStrength<R>,
) {
    // SAFETY: the caller's promise.
    unsafe { relax_pairs::<R, R::Wide, MOVED>(points, groups, backward, strength) };
}

/// # Safety
/// See [`relax_uniform`].
#[allow(unsafe_code)]
#[inline(always)]
unsafe fn relax_pairs<R: Real, W: Lanes<R, Array = [[R; 4]; 2]>, const MOVED: usize>(
    points: DisjointSlice<'_, Row4<R>>,
    groups: &[LinkGroup<R>],
    backward: bool,
    strength: &LinkStrength<R>,
) {
    let projection = LinkProjection::<W>::new(strength);
    let (pairs, rest) = groups.as_chunks::<2>();
    debug_assert!(rest.is_empty(), "an odd group of links");
    for k in 0..pairs.len() {
        let pair = &pairs[if backward { pairs.len() - 1 - k } else { k }];
        // SAFETY: the caller's promise.
        unsafe { relax_pair::<R, W, MOVED>(points, pair, &projection) };
    }
}

/// # Safety
/// See [`relax_uniform`].
#[allow(unsafe_code)]
#[inline(always)]
unsafe fn relax_pair<R: Real, W: Lanes<R, Array = [[R; 4]; 2]>, const MOVED: usize>(
    points: DisjointSlice<'_, Row4<R>>,
    [low, high]: &[LinkGroup<R>; 2],
    projection: &LinkProjection<W>,
) {
    // SAFETY: the caller's promise.
    let ends =
        unsafe { [load(points, [low.ends[0], high.ends[0]]), load(points, [low.ends[1], high.ends[1]])] };
    let span = [0, 1, 2].map(|axis: usize| W::from_array([low.span[axis], high.span[axis]]));
    let rest = W::from_array([low.rest_length, high.rest_length]);
    let slenderness = W::from_array([low.slenderness, high.slenderness]);
    let correction = Correction::new(span, ends, |length, mobility| {
        let [c, share, compliance] = projection.violation(length, rest);
        projection.multiplier([c, share, compliance * slenderness], [length, mobility])
    });
    let moved = correction.moved();
    for (end, moved) in moved.into_iter().enumerate().take(MOVED) {
        for (lane, moved) in moved.into_iter().enumerate() {
            let halves = moved.to_array();
            // SAFETY: the caller's promise.
            unsafe {
                points.set(low.ends[end][lane], Row4(halves[0]));
                points.set(high.ends[end][lane], Row4(halves[1]));
            }
        }
    }
}

/// The rows of two times four points.
///
/// # Safety
/// The points are inside the column, and no other task of the loop writes them.
#[allow(unsafe_code)]
#[inline(always)]
unsafe fn load<R: Real, W: Lanes<R, Array = [[R; 4]; 2]>>(
    points: DisjointSlice<'_, Row4<R>>,
    [low, high]: [[u32; 4]; 2],
) -> [W; 4] {
    // SAFETY: the caller's promise.
    unsafe {
        [
            W::from_array([points.get(low[0]).0, points.get(high[0]).0]),
            W::from_array([points.get(low[1]).0, points.get(high[1]).0]),
            W::from_array([points.get(low[2]).0, points.get(high[2]).0]),
            W::from_array([points.get(low[3]).0, points.get(high[3]).0]),
        ]
    }
}

/// The correction of links in one sweep, with its constants in lanes.
pub struct LinkProjection<L> {
    share: [L; 2],
    compliance: [L; 2],
    rest_scale: L,
    tiny: L,
}

impl<L: Copy> LinkProjection<L> {
    /// For a sweep of this strength.
    #[inline(always)]
    pub fn new<R: Real>(strength: &LinkStrength<R>) -> Self
    where
        L: Lanes<R>,
    {
        let both = |sides: Sides<R>| [L::splat(sides.above), L::splat(sides.below)];
        Self {
            share: both(strength.share),
            compliance: both(strength.compliance),
            rest_scale: L::splat(strength.rest_scale),
            tiny: L::splat(R::MIN_DENOMINATOR),
        }
    }

    /// C(x) of links of this length in metres, and the share and compliance of the sweep on that side of rest.
    #[inline(always)]
    pub fn violation<R: Real>(&self, length: L, rest: L) -> [L; 3]
    where
        L: Lanes<R>,
    {
        let c = length - rest * self.rest_scale;
        let pick = |[above, below]: [L; 2]| c.choose_by_sign(above, below);
        [c, pick(self.share), pick(self.compliance)]
    }

    /// The multipliers of links, over their lengths; `softness` is the compliance of each.
    #[inline(always)]
    pub fn multiplier<R: Real>(&self, [c, share, softness]: [L; 3], [length, mobility]: [L; 2]) -> L
    where
        L: Lanes<R>,
    {
        // For two pinned ends, and for zero length, the numerator or the difference is zero too.
        share * c / ((mobility + softness) * length + self.tiny)
    }

    /// Factor on all rest lengths.
    #[inline(always)]
    pub fn rest_scale(&self) -> L {
        self.rest_scale
    }

    /// The correction of four links. `ends` are the rows of their first and second ends.
    #[inline(always)]
    pub fn correction<R: Real<Lanes = L>, P: LinkLaw<R>>(
        &self,
        group: &LinkGroup<R>,
        law: P,
        ends: [[L; 4]; 2],
    ) -> Correction<L>
    where
        L: Lanes<R, Array = [R; 4]>,
    {
        let span = group.span.map(L::from_array);
        Correction::new(span, ends, |length, mobility| law.multiplier(self, group, [length, mobility]))
    }
}

/// The correction of links side by side.
pub struct Correction<L> {
    /// The vectors by which the first ends move, over their inverse masses, in metres times kilograms: x, y, z. The second
    /// ends move the other way.
    pub push: [L; 3],
    /// x, y, z and the inverse mass of the first and of the second ends.
    ends: [[L; 4]; 2],
}

impl<L: Copy> Correction<L> {
    /// `span` is from anchor to anchor, `rows` are those of the ends; `multiplier` takes lengths and sums of inverse masses.
    #[inline(always)]
    fn new<R: Real>(span: [L; 3], rows: [[L; 4]; 2], multiplier: impl FnOnce(L, L) -> L) -> Self
    where
        L: Lanes<R>,
    {
        let ends = [L::transpose(rows[0]), L::transpose(rows[1])];
        let [[ax, ay, az, w_a], [bx, by, bz, w_b]] = ends;
        let [sx, sy, sz] = span;
        let (dx, dy, dz) = (sx + (bx - ax), sy + (by - ay), sz + (bz - az));
        let length = (dx * dx + dy * dy + dz * dz).sqrt();
        let lambda = multiplier(length, w_a + w_b);
        Self { push: [lambda * dx, lambda * dy, lambda * dz], ends }
    }

    /// The rows of the first and of the second ends after the correction.
    #[inline(always)]
    pub fn moved<R: Real>(self) -> [[L; 4]; 2]
    where
        L: Lanes<R>,
    {
        let [[ax, ay, az, w_a], [bx, by, bz, w_b]] = self.ends;
        let [x, y, z] = self.push;
        [
            L::transpose([ax + w_a * x, ay + w_a * y, az + w_a * z, w_a]),
            L::transpose([bx - w_b * x, by - w_b * y, bz - w_b * z, w_b]),
        ]
    }

    /// The pushes, a row for each link.
    #[inline(always)]
    pub fn rows<R: Real>(&self) -> [L; 4]
    where
        L: Lanes<R>,
    {
        let [x, y, z] = self.push;
        L::transpose([x, y, z, L::splat(R::ZERO)])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::constraints::stretch::LinkRow;
    use crate::model::blocks::Blocks;
    use crate::model::rows::RowList;
    use proptest::prelude::*;

    const POINTS: u32 = 60;
    const STRENGTH: LinkStrength<f32> = LinkStrength {
        share: Sides { above: 0.9, below: 0.4 },
        compliance: Sides { above: 0.02, below: 0.3 },
        rest_scale: 1.1,
    };

    fn links() -> impl Strategy<Value = RowList<LinkGroup<f32>>> {
        let end = 0..POINTS;
        let link = (end.clone(), end, 0.0f32..2.0).prop_filter_map("one point", |(a, b, rest_length)| {
            let row = LinkRow { ends: [a, b], rest_length, slenderness: 0.7, warp: 1.0 };
            (a != b).then_some(row)
        });
        proptest::collection::vec(link, 1..200)
            .prop_map(|rows| RowList::new(&rows, &Blocks::new(0, POINTS as usize)))
    }

    /// Points in a cube of 2 m, of which every fifth is pinned.
    fn points() -> impl Strategy<Value = Vec<Row4<f32>>> {
        let point = proptest::array::uniform4(-1.0f32..1.0);
        proptest::collection::vec(point, POINTS as usize).prop_map(|all| {
            let free = all
                .into_iter()
                .enumerate()
                .map(|(k, [x, y, z, w])| Row4([x, y, z, if k % 5 == 0 { 0.0 } else { 1.5 + w }]));
            let blocks = Blocks::new(0, POINTS as usize);
            free.chain((POINTS..blocks.columns()).map(|_| Row4::ZERO)).collect()
        })
    }

    fn bits(points: &[Row4<f32>]) -> Vec<[u32; 4]> {
        points.iter().map(|point| point.0.map(f32::to_bits)).collect()
    }

    fn sweep<const MOVED: usize>(
        wide: bool,
        start: &[Row4<f32>],
        groups: &[LinkGroup<f32>],
        backward: bool,
    ) -> Vec<[u32; 4]> {
        let mut points = start.to_vec();
        let column = DisjointSlice::new(&mut points);
        // SAFETY: there is one task, and the caller sees to the lanes.
        #[allow(unsafe_code)]
        unsafe {
            #[cfg(target_arch = "x86_64")]
            if wide {
                relax_avx2::<f32, MOVED>(column, groups, backward, &STRENGTH);
                return bits(&points);
            }
            relax_pairs::<f32, Two<<f32 as Real>::Lanes>, MOVED>(column, groups, backward, &STRENGTH);
        }
        bits(&points)
    }

    proptest! {
        #[test]
        fn eight_lanes_give_the_same_bits_as_four(list in links(), start in points(), backward: bool) {
            let groups = list.groups();
            let four = sweep::<2>(false, &start, groups, backward);
            prop_assert_ne!(&four, &bits(&start));
            let mut one_by_one = start.clone();
            let column = DisjointSlice::new(&mut one_by_one);
            let uniform = |group| (group, Uniform);
            // SAFETY: there is one task.
            #[allow(unsafe_code)]
            unsafe {
                match backward {
                    false => relax(column, groups.iter().map(uniform), &STRENGTH),
                    true => relax(column, groups.iter().rev().map(uniform), &STRENGTH),
                }
            }
            prop_assert_eq!(&four, &bits(&one_by_one));
            if f32::has_wide_lanes() {
                prop_assert_eq!(four, sweep::<2>(true, &start, groups, backward));
                let first_ends = [false, true].map(|wide| sweep::<1>(wide, &start, groups, backward));
                prop_assert_eq!(&first_ends[0], &first_ends[1]);
            }
        }
    }
}
