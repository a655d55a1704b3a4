//! Stretch, compression and shear: links keep their length.
//!
//! C(x) = |x_b - x_a| - l, projected by inverse mass (Müller et al. 2007, §4.1) with the compliance of Macklin et al.
//! 2016, eq. 18. The multiplier starts at zero in every sweep, because a time step has one sweep only (Physical), or
//! there is no compliance (Classic).
//!
//! Shear rows are links too: the cross links of quads, swept with the strength of `shearResistance`.

use nalgebra::Vector3;

use crate::math::{Lanes, Real, Row4};
use crate::model::rows::Row;
use crate::model::surface::Surface;
use crate::model::topology::{Link, shear_links};
use crate::model::vertex_maps::mean;
use crate::model::weave::woven_links;
use crate::parallel::disjoint::DisjointSlice;

use super::strength_map::{Sides, StrengthGroup, StrengthMap, Uniform};

/// Four links side by side. 28 bytes a link in `f32`.
#[derive(Debug, Clone, Copy)]
pub struct LinkGroup<R> {
    /// The points a and b.
    pub ends: [[u32; 4]; 2],
    /// From anchor a to anchor b in metres: x, y, z. Written at the start of each frame.
    pub span: [[R; 4]; 3],
    /// Length at rest in metres.
    pub rest_length: [R; 4],
    /// Length over width of the strip of cloth that the link stands for.
    pub slenderness: [R; 4],
}

/// A link between rows of the solver's columns, before it is laid out.
#[derive(Debug, Clone, Copy)]
pub struct LinkRow<R> {
    /// The points a and b.
    pub ends: [u32; 2],
    /// Length at rest in metres.
    pub rest_length: R,
    /// Length over width of the strip of cloth that the link stands for.
    pub slenderness: R,
    /// Squared cosine of the angle to the warp of woven cloth; 1 in other cloth.
    pub warp: R,
}

impl<R: Real> LinkRow<R> {
    /// The row of a link; `place` maps a point of the mesh to its row in the columns, `rest` is a factor on the rest
    /// length.
    pub fn new(link: &Link, rest: f64, place: impl Fn(u32) -> u32) -> Self {
        Self {
            ends: link.ends.map(place),
            rest_length: R::from_f64(link.rest_length * rest),
            slenderness: R::from_f64(link.slenderness),
            warp: R::from_f64(link.warp),
        }
    }
}

/// The shear rows of a mesh: its cross links. `rest` is the vertex map of rest length factors, `warp` the directions of
/// the warp of woven cloth.
///
/// Two diagonals of stiffness k in every cell of a square grid resist shear with the modulus k, so a resistance means
/// the same stiffness here as along the edges.
pub fn shear_rows<R: Real>(
    surface: &Surface,
    warp: &[Vector3<f64>],
    rest: &[f64],
    place: impl Fn(u32) -> u32,
) -> Vec<LinkRow<R>> {
    let row =
        |link: &Link| LinkRow::new(link, mean(rest, link.ends.map(|end| end as usize).into_iter()), &place);
    let links = if warp.is_empty() { shear_links(surface) } else { woven_links(surface, warp).cross };
    let mut rows: Vec<LinkRow<R>> = links.iter().map(row).collect();
    rows.sort_unstable_by_key(|row| row.ends);
    rows
}

impl<R: Real> Row for LinkRow<R> {
    type Group = LinkGroup<R>;
    const POINTS: usize = 2;

    fn point(&self, k: usize) -> u32 {
        self.ends[k]
    }

    fn idle(padding_point: u32) -> Self {
        Self { ends: [padding_point; 2], rest_length: R::ZERO, slenderness: R::ONE, warp: R::ONE }
    }

    fn group(rows: [Self; 4]) -> LinkGroup<R> {
        LinkGroup {
            ends: [0, 1].map(|k| rows.map(|row| row.ends[k])),
            span: [[R::ZERO; 4]; 3],
            rest_length: rows.map(|row| row.rest_length),
            slenderness: rows.map(|row| row.slenderness),
        }
    }
}

/// The strength of a sweep over links.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LinkStrength<R> {
    /// The share of the error that a sweep removes, 0 to 1.
    pub share: Sides<R>,
    /// 1 / (stiffness h²) in 1/kg, for a link as long as it is wide; 0 is rigid.
    pub compliance: Sides<R>,
    /// Factor on all rest lengths.
    pub rest_scale: R,
}

impl<R: Real> LinkGroup<R> {
    /// Updates the spans from the anchors. Differences are in double precision, so a cloth far from the origin is as
    /// exact as one near it.
    pub fn anchor(&mut self, anchors: &[[f64; 3]]) {
        for lane in 0..4 {
            let [a, b] = self.ends.map(|end| anchors[end[lane] as usize]);
            for axis in 0..3 {
                self.span[axis][lane] = R::from_f64(b[axis] - a[axis]);
            }
        }
    }

    /// The strain of each link, length over rest length minus one; 0 for a link whose rest length is zero.
    pub fn strain(&self, points: &[Row4<R>], rest_scale: R) -> [R; 4] {
        std::array::from_fn(|lane| {
            let [a, b] = self.ends.map(|end| points[end[lane] as usize].0);
            let d: [R; 3] = std::array::from_fn(|axis| self.span[axis][lane] + (b[axis] - a[axis]));
            let rest = self.rest_length[lane] * rest_scale;
            if rest > R::ZERO { crate::math::dot(d, d).sqrt() / rest - R::ONE } else { R::ZERO }
        })
    }
}

/// How four links side by side resist. By itself a strength map scales the compliance of the sweep.
pub trait LinkLaw<R: Real>: StrengthMap<R> {
    /// The multipliers of the corrections, over the lengths of the links, from those lengths and the sums of the
    /// inverse masses.
    #[inline(always)]
    fn multiplier(
        self,
        projection: &LinkProjection<R::Lanes>,
        group: &LinkGroup<R>,
        length_and_mobility: [R::Lanes; 2],
    ) -> R::Lanes {
        projection.multiplier(group, self, length_and_mobility)
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
        let [a, b] = group.ends.map(|ends| ends.map(|end| unsafe { points.get(end) }.lanes()));
        let push = projection.push(group, law, [a, b]);
        for lane in 0..4 {
            let [end_a, end_b] = group.ends.map(|end| end[lane]);
            let moved_a = a[lane] + a[lane].splat_last() * push[lane];
            let moved_b = b[lane] - b[lane].splat_last() * push[lane];
            // SAFETY: the caller's promise.
            unsafe {
                points.set(end_a, Row4(moved_a.to_array()));
                points.set(end_b, Row4(moved_b.to_array()));
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
    pub fn new<R: Real<Lanes = L>>(strength: &LinkStrength<R>) -> Self
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

    /// The multipliers of links that all have the compliance of the sweep, times a vertex map; see [`LinkLaw`].
    #[inline(always)]
    pub fn multiplier<R: Real<Lanes = L>, P: StrengthMap<R>>(
        &self,
        group: &LinkGroup<R>,
        map: P,
        [length, mobility]: [L; 2],
    ) -> L
    where
        L: Lanes<R>,
    {
        let c = length - L::from_array(group.rest_length) * self.rest_scale;
        let compliance = c.choose_by_sign(self.compliance[0], self.compliance[1]);
        let (share, compliance) = map.scale(c, self.share(c), compliance);
        let softness = compliance * L::from_array(group.slenderness);
        // For two pinned ends, and for zero length, the numerator or the difference is zero too.
        share * c / ((mobility + softness) * length + self.tiny)
    }

    /// The share of the error that a sweep removes, by the sign of `c`.
    #[inline(always)]
    pub fn share<R: Real<Lanes = L>>(&self, c: L) -> L
    where
        L: Lanes<R>,
    {
        c.choose_by_sign(self.share[0], self.share[1])
    }

    /// Factor on all rest lengths.
    #[inline(always)]
    pub fn rest_scale(&self) -> L {
        self.rest_scale
    }

    /// The vectors by which the first ends of four links move, over their inverse masses, in metres times kilograms; the
    /// second ends move the other way. `a` and `b` are the rows of the ends.
    #[inline(always)]
    pub fn push<R: Real<Lanes = L>, P: LinkLaw<R>>(
        &self,
        group: &LinkGroup<R>,
        law: P,
        [a, b]: [[L; 4]; 2],
    ) -> [L; 4]
    where
        L: Lanes<R>,
    {
        let [ax, ay, az, w_a] = L::transpose(a);
        let [bx, by, bz, w_b] = L::transpose(b);
        let [sx, sy, sz] = group.span.map(L::from_array);
        let (dx, dy, dz) = (sx + (bx - ax), sy + (by - ay), sz + (bz - az));
        let length = (dx * dx + dy * dy + dz * dz).sqrt();
        let lambda = law.multiplier(self, group, [length, w_a + w_b]);
        L::transpose([lambda * dx, lambda * dy, lambda * dz, L::splat(R::ZERO)])
    }
}
