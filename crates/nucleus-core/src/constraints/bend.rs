//! Bending: faces that share an edge keep the angle between them, and quads stay flat.
//!
//! C(x) = |c| - |c_rest|, where c is the bending vector of a [`hinge`](super::hinge) (Bergou et al. 2006): zero where
//! the cloth is flat, else at right angles to it, with a length that grows with the angle. The vector is linear in the
//! positions, so it needs no angle, has no singular shape, and cannot rotate or translate the cloth. A hinge that is
//! bent at rest keeps the length of its vector. Far from flat a hinge is stiffer along c, so that its moment grows with
//! the angle.

use crate::math::{Lanes, Real, Row4};
use crate::parallel::disjoint::DisjointSlice;

use super::hinge::{HingeGroup, MIN_COSINE};
use super::strength_map::StrengthMap;

/// The strength of a sweep over hinges.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BendStrength<R> {
    /// The share of the error that a sweep removes, 0 to 1.
    pub share: R,
    /// 1 / (B h²), with the bending stiffness B in N·m and the time step h in seconds; 0 is rigid.
    pub compliance: R,
}

/// Sweeps the hinges of `groups` once, each group with its strength map.
///
/// # Safety
/// The rows of a group share no point, and no other task of the loop touches the points of `groups`.
#[allow(unsafe_code)]
#[inline]
pub unsafe fn relax<'a, R: Real, P: StrengthMap<R>, const N: usize>(
    points: DisjointSlice<'_, Row4<R>>,
    groups: impl Iterator<Item = (&'a HingeGroup<R, N>, P)>,
    strength: &BendStrength<R>,
) {
    let (share, compliance) = (R::Lanes::splat(strength.share), R::Lanes::splat(strength.compliance));
    let (zero, one, tiny) =
        (R::Lanes::splat(R::ZERO), R::Lanes::splat(R::ONE), R::Lanes::splat(R::MIN_DENOMINATOR));
    let least = R::Lanes::splat(R::from_f64(MIN_COSINE * MIN_COSINE));
    for (group, map) in groups {
        // SAFETY: the caller's promise.
        let x = group.points.map(|ends| ends.map(|point| unsafe { points.get(point) }.lanes()));
        let weights = group.weights.map(R::Lanes::from_array);
        let mut c = group.anchored.map(R::Lanes::from_array);
        let mut mobility = zero;
        for k in 0..N {
            let [px, py, pz, w] = R::Lanes::transpose(x[k]);
            let weight = weights[k];
            c = [c[0] + weight * px, c[1] + weight * py, c[2] + weight * pz];
            mobility = mobility + w * weight * weight;
        }
        let square = c[0] * c[0] + c[1] * c[1] + c[2] * c[2];
        let length = square.sqrt();
        // cos²(θ/2), bounded from below.
        let cosine = one - square * R::Lanes::from_array(group.inverse_square_max);
        let cosine = (cosine - least).choose_by_sign(cosine, least);
        let bent = one - R::Lanes::from_array(group.rest) / (length + tiny);
        let (share, compliance) = map.scale(bent, share, compliance);
        let lambda = share * bent / (mobility + compliance * cosine.sqrt() + tiny);
        let push = [lambda * c[0], lambda * c[1], lambda * c[2]];
        for k in 0..N {
            let weight = weights[k];
            let moves = R::Lanes::transpose([weight * push[0], weight * push[1], weight * push[2], zero]);
            for lane in 0..4 {
                let moved = x[k][lane] - x[k][lane].splat_last() * moves[lane];
                // SAFETY: the caller's promise.
                unsafe { points.set(group.points[k][lane], Row4(moved.to_array())) };
            }
        }
    }
}
