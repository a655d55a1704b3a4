//! The projection of links, eight side by side.
//!
//! C(x) = |x_b - x_a| - l, projected by inverse mass (Müller et al. 2007, §4.1) with the compliance of Macklin et al.
//! 2016, eq. 18. The multiplier starts at zero in every sweep, because a time step has one sweep only (Physical), or
//! there is no compliance (Classic).
//!
//! Eight links are two groups of one colour, so they share no point, and both widths give the same bits.

use crate::math::kernel::{self, Kernel};
use crate::math::{Lanes, Real, Row4, by_axis};
use crate::parallel::disjoint::DisjointSlice;

use super::side_by_side::{group_starts, load, store};
use super::strength_map::{Sides, StrengthGroup, StrengthMap, Uniform};
use super::stretch::{LinkGroup, LinkStrength};

/// How links side by side resist. By itself a strength map scales the compliance of the sweep.
pub trait LinkLaw<R: Real>: StrengthMap<R> {
    /// The multipliers of the corrections of the groups from `at` on, over the lengths of the links, from those lengths
    /// and the sums of the inverse masses.
    #[inline(always)]
    fn multiplier<L: Lanes<R>>(
        self,
        at: usize,
        projection: &LinkProjection<L>,
        [rest, slenderness]: [L; 2],
        [length, mobility]: [L; 2],
    ) -> L {
        let [c, share, compliance] = projection.violation(length, rest);
        let (share, compliance) = self.scale(at, c, share, compliance);
        projection.multiplier([c, share, compliance * slenderness], [length, mobility])
    }
}

impl<R: Real> LinkLaw<R> for Uniform {}
impl<R: Real> LinkLaw<R> for &[StrengthGroup<R>] {}

/// Sweeps links once, in order or backward. Of each link the first `MOVED` ends move.
///
/// # Safety
/// `groups` come in twos as [`Row::GROUPS`](crate::model::rows::Row::GROUPS) lays them out: the rows of two share no point
/// that moves. No other task of the loop touches the points that move, or writes the others.
#[allow(unsafe_code)]
#[inline]
pub unsafe fn relax<R: Real, P: LinkLaw<R>, const MOVED: usize>(
    points: DisjointSlice<'_, Row4<R>>,
    groups: &[LinkGroup<R>],
    law: P,
    backward: bool,
    strength: &LinkStrength<R>,
) {
    // SAFETY: the caller's promise.
    unsafe { kernel::run(LinkSweep::<R, P, MOVED> { points, groups, law, backward, strength }) };
}

struct LinkSweep<'a, R, P, const MOVED: usize> {
    points: DisjointSlice<'a, Row4<R>>,
    groups: &'a [LinkGroup<R>],
    law: P,
    backward: bool,
    strength: &'a LinkStrength<R>,
}

#[allow(unsafe_code)]
impl<R: Real, P: LinkLaw<R>, const MOVED: usize> Kernel<R> for LinkSweep<'_, R, P, MOVED> {
    /// # Safety
    /// See [`relax`].
    #[inline(always)]
    unsafe fn run<L: Lanes<R>>(self) {
        let Self { points, groups, law, backward, strength } = self;
        let projection = LinkProjection::<L>::new(strength);
        for at in group_starts::<R, L>(groups.len(), backward) {
            let groups = &groups[at..at + L::GROUPS];
            // SAFETY: the caller's promise.
            let ends = unsafe { [load(points, |k| groups[k].ends[0]), load(points, |k| groups[k].ends[1])] };
            let moved = projection.correction(|k| &groups[k], (law, at), ends).moved();
            for (end, moved) in moved.into_iter().enumerate().take(MOVED) {
                // SAFETY: the caller's promise.
                unsafe { store(points, |k| groups[k].ends[end], moved) };
            }
        }
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

    /// The correction of the links of groups side by side; `ends` are the columns x, y, z and inverse mass of their first
    /// and second ends.
    #[inline(always)]
    pub fn correction<'g, R: Real, P: LinkLaw<R>>(
        &self,
        group: impl Fn(usize) -> &'g LinkGroup<R>,
        (law, at): (P, usize),
        ends: [[L; 4]; 2],
    ) -> Correction<L>
    where
        L: Lanes<R>,
    {
        let [sx, sy, sz] = by_axis(|axis| L::of_groups(|k| group(k).span[axis]));
        let [[ax, ay, az, w_a], [bx, by, bz, w_b]] = ends;
        let (dx, dy, dz) = (sx + (bx - ax), sy + (by - ay), sz + (bz - az));
        let length = (dx * dx + dy * dy + dz * dz).sqrt();
        let own = [L::of_groups(|k| group(k).rest_length), L::of_groups(|k| group(k).slenderness)];
        let lambda = law.multiplier(at, self, own, [length, w_a + w_b]);
        Correction { push: [lambda * dx, lambda * dy, lambda * dz], ends }
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
    /// The columns of the first and of the second ends after the correction.
    #[inline(always)]
    pub fn moved<R: Real>(self) -> [[L; 4]; 2]
    where
        L: Lanes<R>,
    {
        let [[ax, ay, az, w_a], [bx, by, bz, w_b]] = self.ends;
        let [x, y, z] = self.push;
        [[ax + w_a * x, ay + w_a * y, az + w_a * z, w_a], [bx - w_b * x, by - w_b * y, bz - w_b * z, w_b]]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::constraints::side_by_side::tests::agrees_in_every_width;
    use crate::constraints::stretch::LinkRow;
    use crate::constraints::weave::{WeaveGroup, WeaveStrength, Woven};
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
        proptest::collection::vec(link, 20..200)
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
            free.chain((POINTS..blocks.row_count()).map(|_| Row4::ZERO)).collect()
        })
    }

    /// Directions of links, and vertex maps, of which every third factor is zero.
    fn columns(groups: usize) -> (Vec<WeaveGroup<f32>>, Vec<StrengthGroup<f32>>) {
        let number = |group: usize, lane: usize| (group * 4 + lane) as f32;
        let weave = |group| WeaveGroup { warp: [0, 1, 2, 3].map(|lane| number(group, lane) * 0.37 % 1.0) };
        let factor = |group, lane| if lane == group % 3 { 0.0 } else { number(group, lane) * 0.71 % 1.0 };
        let map = |group| StrengthGroup {
            above: [0, 1, 2, 3].map(|lane| factor(group, lane)),
            below: [0, 1, 2, 3].map(|lane| factor(group + 1, lane)),
        };
        ((0..groups).map(weave).collect(), (0..groups).map(map).collect())
    }

    fn agrees<const MOVED: usize>(
        start: &[Row4<f32>],
        groups: &[LinkGroup<f32>],
        law: impl LinkLaw<f32>,
        backward: bool,
    ) -> bool {
        let strength = &STRENGTH;
        agrees_in_every_width!(start, points => LinkSweep::<_, _, MOVED> { points, groups, law, backward, strength })
    }

    proptest! {
        #[test]
        fn every_width_of_lanes_gives_the_same_bits(list in links(), start in points(), backward: bool) {
            let groups = list.groups();
            let (weave, maps) = columns(groups.len());
            let sides = |above, below| Sides { above, below };
            let strength = WeaveStrength { warp: sides(0.01, 0.2), weft: sides(0.05, 0.2), shear: 0.4, buckling: 0.3 };
            let woven = Woven { groups: &weave, strength: &strength, map: Uniform };
            prop_assert!(agrees::<2>(&start, groups, Uniform, backward));
            prop_assert!(agrees::<2>(&start, groups, &maps[..], backward));
            prop_assert!(agrees::<2>(&start, groups, woven, backward));
            let mapped = Woven { groups: &weave, strength: &strength, map: &maps[..] };
            prop_assert!(agrees::<2>(&start, groups, mapped, backward));
        }

        #[test]
        fn every_width_of_lanes_moves_the_first_ends_alike(list in links(), start in points(), backward: bool) {
            prop_assert!(agrees::<1>(&start, list.groups(), Uniform, backward));
        }
    }
}
