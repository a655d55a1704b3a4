//! Rows of links: a distance between two combinations of points, four rows side by side.
//!
//! The distance vector of a link is d = Σ s_k x_k - target, where the weights s_k of the first side are positive and
//! those of the second negative. C = |d| - l is projected like a stretch row (Macklin et al. 2016, eq. 18); with l = 0 the
//! projection closes d in all three directions, which is a weld. Since the weights of two free sides add up to zero and
//! the correction is along d, linear and angular momentum are kept.

use crate::constraints::stretch::LinkStrength;
use crate::math::{Lanes, Real, Row4};
use crate::model::rows::Row;
use crate::parallel::disjoint::DisjointSlice;

/// No link: the lane is padding.
pub const NO_LINK: u32 = u32::MAX;

/// The lanes of a group whose links are broken.
pub fn broken_lanes(links: [u32; 4], broken: &[bool]) -> impl Iterator<Item = usize> + use<'_> {
    (0..4).filter(move |&lane| links[lane] != NO_LINK && broken[links[lane] as usize])
}

/// Four links of `N` free points side by side.
#[derive(Debug, Clone, Copy)]
pub struct CombinedGroup<R, const N: usize> {
    /// The points.
    pub points: [[u32; 4]; N],
    /// Their weights, positive on the first side.
    pub weights: [[R; 4]; N],
    /// How much each point is moved: its weight times the weight of the side that pushes it.
    pub push: [[R; 4]; N],
    /// Σ s_k anchor_k - target at the start of the frame, in metres: x, y, z.
    pub span: [[R; 4]; 3],
    /// Motion of -target in the frame, in metres.
    pub travel: [[R; 4]; 3],
    /// Length at rest in metres.
    pub rest: [R; 4],
    /// Distance that contact keeps between the sides in metres, up to which the link does not pull.
    pub contact_distance: [R; 4],
    /// Factor on the strength; 0 for a broken link.
    pub factor: [R; 4],
    /// The link of each lane, or [`NO_LINK`].
    pub link: [u32; 4],
}

/// Four vectors side by side: x, y, z. The impulses of a lane group in N·s.
pub type VectorGroup<R> = [[R; 4]; 3];

/// A link before it is laid out.
#[derive(Debug, Clone, Copy)]
pub struct CombinedRow<R, const N: usize> {
    /// The points.
    pub points: [u32; N],
    /// Their weights.
    pub weights: [R; N],
    /// How much each is moved.
    pub push: [R; N],
    /// Length at rest in metres.
    pub rest: R,
    /// The link.
    pub link: u32,
}

impl<R: Real, const N: usize> Row for CombinedRow<R, N> {
    type Group = CombinedGroup<R, N>;
    const POINTS: usize = N;

    fn point(&self, k: usize) -> u32 {
        self.points[k]
    }

    fn idle(padding_point: u32) -> Self {
        let zero = [R::ZERO; N];
        Self { points: [padding_point; N], weights: zero, push: zero, rest: R::ZERO, link: NO_LINK }
    }

    fn group(rows: [Self; 4]) -> CombinedGroup<R, N> {
        CombinedGroup {
            points: std::array::from_fn(|k| rows.map(|row| row.points[k])),
            weights: std::array::from_fn(|k| rows.map(|row| row.weights[k])),
            push: std::array::from_fn(|k| rows.map(|row| row.push[k])),
            span: [[R::ZERO; 4]; 3],
            travel: [[R::ZERO; 4]; 3],
            rest: rows.map(|row| row.rest),
            contact_distance: [R::ZERO; 4],
            factor: [R::ZERO; 4],
            link: rows.map(|row| row.link),
        }
    }
}

/// One sweep of the links of a constraint.
#[derive(Debug, Clone, Copy)]
pub struct LinkPass<R> {
    /// Share, compliance and rest length scale.
    pub strength: LinkStrength<R>,
    /// Whether factors divide the compliance (Physical); else they scale the share.
    pub is_physical: bool,
    /// The end of the time step, as a share of the frame.
    pub time: R,
    /// 1 / h in 1/s.
    pub per_step: R,
    /// Whether rows are swept from the last to the first.
    pub backward: bool,
}

/// Sweeps the links of `groups` once, and adds their impulses to `impulses` where there are any, one entry per group.
///
/// # Safety
/// The rows of a group share no point, and no other task of the loop touches the points or impulses of `groups`.
#[allow(unsafe_code)]
#[inline]
pub unsafe fn relax<R: Real, const N: usize>(
    points: DisjointSlice<'_, Row4<R>>,
    groups: &[CombinedGroup<R, N>],
    impulses: &mut [VectorGroup<R>],
    pass: &LinkPass<R>,
) {
    let splat = R::Lanes::splat;
    let (zero, one, tiny) = (splat(R::ZERO), splat(R::ONE), splat(R::MIN_DENOMINATOR));
    let LinkStrength { share, compliance, rest_scale } = pass.strength;
    let (share_above, share_below) = (splat(share.above), splat(share.below));
    let (compliance_above, compliance_below) = (splat(compliance.above), splat(compliance.below));
    let (rest_scale, time, per_step) = (splat(rest_scale), splat(pass.time), splat(pass.per_step));
    for k in 0..groups.len() {
        let at = if pass.backward { groups.len() - 1 - k } else { k };
        let group = &groups[at];
        let mut x = [[zero; 4]; N];
        let mut d: [R::Lanes; 3] = std::array::from_fn(|axis| {
            R::Lanes::from_array(group.span[axis]) + R::Lanes::from_array(group.travel[axis]) * time
        });
        let mut mobility = zero;
        for k in 0..N {
            // SAFETY: the caller's promise.
            x[k] = group.points[k].map(|point| unsafe { points.get(point) }.lanes());
            let [px, py, pz, w] = R::Lanes::transpose(x[k]);
            let weight = R::Lanes::from_array(group.weights[k]);
            d = [d[0] + weight * px, d[1] + weight * py, d[2] + weight * pz];
            mobility = mobility + w * weight * R::Lanes::from_array(group.push[k]);
        }
        let length = (d[0] * d[0] + d[1] * d[1] + d[2] * d[2]).sqrt();
        let rest = R::Lanes::from_array(group.rest) * rest_scale;
        let longest = rest.most(R::Lanes::from_array(group.contact_distance));
        let c = length - rest;
        let c = c.choose_by_sign((length - longest).most(zero), c);
        let factor = R::Lanes::from_array(group.factor);
        let softness = if pass.is_physical { factor } else { one };
        let compliance = c.choose_by_sign(compliance_above, compliance_below);
        let share = c.choose_by_sign(share_above, share_below) * factor;
        // Between pinned points there is no load. Broken links have the factor 0.
        let lambda = share * c / ((softness * mobility + compliance) * length + tiny);
        let lambda = mobility.choose_by_sign(lambda, zero);
        let moved = [lambda * d[0], lambda * d[1], lambda * d[2]];
        if let Some(impulse) = impulses.get_mut(at) {
            for axis in 0..3 {
                let sum = R::Lanes::from_array(impulse[axis]) + moved[axis] * per_step;
                impulse[axis] = sum.to_array();
            }
        }
        for k in 0..N {
            let push = R::Lanes::from_array(group.push[k]);
            let step = R::Lanes::transpose([moved[0] * push, moved[1] * push, moved[2] * push, zero]);
            for lane in 0..4 {
                let row = x[k][lane] - x[k][lane].splat_last() * step[lane];
                // SAFETY: the caller's promise.
                unsafe { points.set(group.points[k][lane], Row4(row.to_array())) };
            }
        }
    }
}
