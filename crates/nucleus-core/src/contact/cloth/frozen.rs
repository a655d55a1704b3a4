//! The last fallback of the safeguard: points that move by one translation in a time step, or are carried.
//!
//! A pair whose points have one motion passes no part of itself. Around a collider that turns, no two places have the same
//! motion; but its points move by an affine map, and an affine map of space passes nothing through anything. All that it
//! carries therefore moves by its map.

use nalgebra::Vector3;

use crate::contact::cloth::contact::{ClothContact, ClothStep};
use crate::contact::collider::affine_motion::AffineMotion;
use crate::math::{Real, Row4, add, sub};

/// How the safeguard holds a point in a time step. Who is carried carries others on, and is not returned to the start: where
/// both happened in turn, cloth between a moving collider and other cloth would not be separated.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Frozen {
    /// Not at all.
    #[default]
    Free,
    /// Where it was at the start of the step, moved by the mean motion of its island.
    WithIsland,
    /// With a pin, the ground, a face of a collider that deforms, or a point that these carry.
    Carried,
    /// With a collider of affine motion, by its index.
    With(u32),
}

impl<R: Real, const N: usize, const M: usize> ClothContact<R, N, M> {
    /// Gives all points of the two the mean motion of their island, or moves all with what carries one of them. `carriers` are the
    /// motions of the colliders.
    pub fn freeze(
        &mut self,
        step: &ClothStep<'_, R>,
        frozen: &mut [Frozen],
        carriers: &[Option<AffineMotion>],
    ) {
        let points = || self.ours.iter().chain(&self.theirs).copied();
        let held = |point: u32| frozen[point as usize];
        let with = points().map(held).find(|frozen| matches!(frozen, Frozen::With(_)));
        let carried = points().find(|&point| held(point) == Frozen::Carried);
        let motion = carried.map_or(self.drift(step), |point| sub(step.row(point).xyz(), step.start(point)));
        let of_others = if carried.is_some() { Frozen::Carried } else { Frozen::WithIsland };
        let state = with.unwrap_or(of_others);
        for point in points() {
            let carrier = match state {
                Frozen::With(collider) => carriers.get(collider as usize).and_then(Option::as_ref),
                _ => None,
            };
            let own = carrier.map_or(motion, |carrier| {
                let start = Vector3::from(step.start(point).map(R::to_f64));
                let place = Vector3::from(step.origins[point as usize]) + start;
                <[f64; 3]>::from(carrier.at(place)).map(R::from_f64)
            });
            let row = step.row(point);
            if row.0[3] > R::ZERO {
                let [x, y, z] = add(step.start(point), own);
                step.writer.place(point, Row4([x, y, z, row.0[3]]));
            }
            frozen[point as usize] = state;
        }
    }
}
