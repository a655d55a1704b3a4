//! Bend: faces that share an edge keep the angle between them.
//!
//! The bending vector of a hinge is c = Σ K_i x_i over the edge's ends and the two opposite corners, with the
//! weights of Bergou et al. 2006, "A quadratic bending model for inextensible surfaces", §3: it is nought
//! where the hinge is flat, at right angles to the cloth, and as long as the hinge is bent. The energy
//! B/2 · 3/(A_0 + A_1) |c|² is that of a plate of bending stiffness B (N·m), whatever the mesh. Being linear
//! in the positions it needs no angle, has no singular shape, and cannot turn or shift the cloth (Σ K_i = 0).
//!
//! A hinge that is bent at rest keeps the length of its bending vector: |c| = |c_rest|.

use nalgebra::Vector3;

use crate::columns::Shared;
use crate::model::{Hinge, Row, triangle_area};
use crate::scalar::{Lanes, Real, Row4};
use crate::surface::Surface;

/// Four hinges side by side. 44 bytes a hinge in `f32`.
#[derive(Debug, Clone, Copy)]
pub struct HingeGroup<R> {
    /// The edge's ends, then the corners opposite.
    pub points: [[u32; 4]; 4],
    /// Weights of the first three points, scaled by √(3 / (A_0 + A_1)); the fourth makes the sum nought.
    pub weights: [[R; 4]; 3],
    /// The bending vector of the anchors. Set at the start of each frame.
    pub anchored: [[R; 4]; 3],
    /// Length of the bending vector at rest; nought where flat.
    pub rest: [R; 4],
}

/// A hinge between points of the solver, before it is laid out.
#[derive(Debug, Clone, Copy)]
pub struct HingeRow<R> {
    points: [u32; 4],
    weights: [R; 3],
    rest: R,
}

impl<R: Real> HingeRow<R> {
    /// The hinge as it is at rest in `surface`, between the solver's places of its points.
    /// Nothing for a hinge with a triangle of no area: it has no angle.
    pub fn new(surface: &Surface, hinge: &Hinge, place: impl Fn(u32) -> u32) -> Option<Self> {
        let [a, b, c, d] = hinge.points;
        let area = triangle_area(surface, [a, b, c]) + triangle_area(surface, [a, b, d]);
        let x = hinge.points.map(|point| surface.positions[point as usize]);
        let weights = bending_weights(x)?.map(|weight| weight * (3.0 / area).sqrt());
        let vector: Vector3<f64> = (0..4).map(|k| x[k] * weights[k]).sum();
        // What is flat to rounding is flat: 1e-6 of the vector of a right angle.
        let flat = 1e-6 * weights[0].abs() * (x[1] - x[0]).norm();
        let rest = if vector.norm() <= flat { 0.0 } else { vector.norm() };
        let [k0, k1, k2, _] = weights.map(R::from_f64);
        Some(Self { points: hinge.points.map(place), weights: [k0, k1, k2], rest: R::from_f64(rest) })
    }
}

/// Bergou's weights, from cotangents of the angles at the edge; nothing where an angle is degenerate.
fn bending_weights([x0, x1, x2, x3]: [Vector3<f64>; 4]) -> Option<[f64; 4]> {
    let cotangent = |u: Vector3<f64>, v: Vector3<f64>| u.dot(&v) / u.cross(&v).norm();
    let edge = x1 - x0;
    let at_0 = [cotangent(edge, x2 - x0), cotangent(edge, x3 - x0)];
    let at_1 = [cotangent(-edge, x2 - x1), cotangent(-edge, x3 - x1)];
    let weights = [at_1[0] + at_1[1], at_0[0] + at_0[1], -at_0[0] - at_1[0], -at_0[1] - at_1[1]];
    weights.iter().all(|weight| weight.is_finite()).then_some(weights)
}

impl<R: Real> Row for HingeRow<R> {
    type Group = HingeGroup<R>;
    const POINTS: usize = 4;

    fn point(&self, k: usize) -> u32 {
        self.points[k]
    }

    fn idle(stand_in: u32) -> Self {
        Self { points: [stand_in; 4], weights: [R::ZERO; 3], rest: R::ZERO }
    }

    fn group(rows: [Self; 4]) -> HingeGroup<R> {
        HingeGroup {
            points: [0, 1, 2, 3].map(|k| rows.map(|row| row.points[k])),
            weights: [0, 1, 2].map(|k| rows.map(|row| row.weights[k])),
            anchored: [[R::ZERO; 4]; 3],
            rest: rows.map(|row| row.rest),
        }
    }
}

impl<R: Real> HingeGroup<R> {
    /// Takes up where the anchors now are, in double precision.
    pub fn anchor(&mut self, anchors: &[[f64; 3]]) {
        for lane in 0..4 {
            let x = self.points.map(|point| anchors[point[lane] as usize]);
            for axis in 0..3 {
                // Relative to the fourth point, whose weight is minus the sum of the others.
                let term = |k: usize| self.weights[k][lane].to_f64() * (x[k][axis] - x[3][axis]);
                self.anchored[axis][lane] = R::from_f64(term(0) + term(1) + term(2));
            }
        }
    }
}

/// How strongly a sweep acts.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BendStrength<R> {
    /// The share of the error that is taken away, 0 to 1.
    pub share: R,
    /// 1 / (B h²), where h is the time the sweep stands for; 0 is rigid.
    pub compliance: R,
}

/// Sweeps the hinges of `groups` once.
///
/// # Safety
/// The rows of `groups` share no point within a group, and no other task of the phase touches their points.
#[allow(unsafe_code)]
#[inline]
pub unsafe fn relax<R: Real>(
    points: Shared<'_, Row4<R>>,
    groups: &[HingeGroup<R>],
    strength: &BendStrength<R>,
) {
    let (share, compliance) = (R::Lanes::splat(strength.share), R::Lanes::splat(strength.compliance));
    let (zero, one, tiny) = (R::Lanes::splat(R::ZERO), R::Lanes::splat(R::ONE), R::Lanes::splat(R::TINY));
    for group in groups {
        // SAFETY: the caller's promise.
        let x = group.points.map(|ends| ends.map(|point| unsafe { points.get(point) }.lanes()));
        let [t0, t1, t2, t3] = x.map(R::Lanes::transpose);
        let [k0, k1, k2] = group.weights.map(R::Lanes::from_array);
        let k3 = zero - (k0 + k1 + k2);
        let [a0, a1, a2] = group.anchored.map(R::Lanes::from_array);
        let sum = |axis: usize| k0 * t0[axis] + k1 * t1[axis] + k2 * t2[axis] + k3 * t3[axis];
        let c = [a0 + sum(0), a1 + sum(1), a2 + sum(2)];
        let length = (c[0] * c[0] + c[1] * c[1] + c[2] * c[2]).sqrt();
        let bent = one - R::Lanes::from_array(group.rest) / (length + tiny);
        let mobility = t0[3] * k0 * k0 + t1[3] * k1 * k1 + t2[3] * k2 * k2 + t3[3] * k3 * k3;
        let lambda = share * bent / (mobility + compliance + tiny);
        let push = [lambda * c[0], lambda * c[1], lambda * c[2]];
        for (k, weight) in [k0, k1, k2, k3].into_iter().enumerate() {
            let moves = R::Lanes::transpose([weight * push[0], weight * push[1], weight * push[2], zero]);
            for lane in 0..4 {
                let moved = x[k][lane] - x[k][lane].splat_last() * moves[lane];
                // SAFETY: the caller's promise.
                unsafe { points.set(group.points[k][lane], Row4(moved.to_array())) };
            }
        }
    }
}
