//! Folds: joined edges that resist folding about each other (`bend`), and break at an angle (`bendBreakAngle`).
//!
//! A fold is a link whose vector is the bending vector of a hinge between two faces (Bergou et al. 2006, see
//! [`hinge`](crate::constraints::hinge)): the weights of its sides are those of the hinge, and the stiffness is that of a
//! plate. The length of the vector is `max_length` times the sine of half the angle between the faces.

use nalgebra::Vector3;

use crate::constraints::hinge::bending_weights;
use crate::contact::collider::ColliderState;
use crate::input::links::{ConstraintFrame, Fold, Link, LinkKind, LinkSide};
use crate::math::Real;
use crate::model::Model;
use crate::state::State;

use super::ends::{Ends, Prescribed, vector};
use super::lists::ConstraintLinks;

/// A link that resists folding between two faces. Of each face `sides` names the ends of its edge and another corner, in
/// the same order, and `places` says where they are in metres. It has a `share` of the whole stiffness, so that a quad can
/// have a fold with each of its far corners. `None` for faces without area, and for sides in space.
pub fn fold_link(
    sides: [LinkSide; 2],
    places: [[Vector3<f64>; 3]; 2],
    share: f64,
    holds: [u32; 2],
) -> Option<Link> {
    let [[a, b, c], [e, f, d]] = places;
    let edge = [(a + e) / 2.0, (b + f) / 2.0];
    let area = |[a, b, c]: [Vector3<f64>; 3]| (b - a).cross(&(c - a)).norm() / 2.0;
    let root = (area(places[0]) + area(places[1])).sqrt() / share.sqrt();
    let k = bending_weights([edge[0], edge[1], c, d])?.map(|weight| weight / root);
    let weights = [[k[0] / 2.0, k[1] / 2.0, k[2]], [-k[0] / 2.0, -k[1] / 2.0, -k[3]]];
    let terms = [edge[0], edge[1], c, d].into_iter().zip(k);
    let vector: Vector3<f64> = terms.clone().map(|(place, weight)| (place - edge[0]) * weight).sum();
    // Flat up to rounding counts as flat, as in the hinges of a mesh.
    let flat = 1e-6 * terms.map(|(place, weight)| weight.abs() * (place - edge[0]).norm()).sum::<f64>();
    let rest = if vector.norm() <= flat { 0.0 } else { vector.norm() };
    let max_length = 2.0 * (edge[1] - edge[0]).norm() / root;
    let [first, second] = [weighted(sides[0], weights[0])?, weighted(sides[1], weights[1])?];
    let kind = LinkKind::Fold(Fold { max_length, holds });
    (root > 0.0).then(|| Link { kind, ..Link::new([first, second], rest) })
}

fn weighted(side: LinkSide, weights: [f64; 3]) -> Option<LinkSide> {
    match side {
        LinkSide::Cloth { cloth, points, .. } => Some(LinkSide::Cloth { cloth, points, weights }),
        LinkSide::Collider { collider, points, .. } => Some(LinkSide::Collider { collider, points, weights }),
        LinkSide::Space(_) => None,
    }
}

impl<R: Real> ConstraintLinks<R> {
    /// Breaks the folds whose edges have come apart, and those that are folded from rest by more than the break angle, at
    /// a time of the frame. Whether any broke.
    pub(super) fn break_folds(
        &mut self,
        (model, colliders): (&Model<R>, &[ColliderState]),
        state: &State<R>,
        settings: &ConstraintFrame,
        time: f64,
    ) -> bool {
        let prescribed = Prescribed { colliders, frame: settings };
        // sin((θ - θ_rest) / 2), from the sines of both halves.
        let turn = |fold: Fold, length: f64, rest: f64| {
            let [sine, rest] = [length, rest].map(|length| fold.half_sine(length));
            let cosine = |sine: f64| (1.0 - sine * sine).sqrt();
            (sine * cosine(rest) - cosine(sine) * rest).abs()
        };
        let mut any = false;
        for (at, link) in self.links.iter().enumerate() {
            let Some(fold) = link.fold().filter(|_| !self.broken[at]) else { continue };
            let is_apart = fold.holds.iter().any(|&hold| self.broken.get(hold as usize) == Some(&true));
            let is_folded = settings.break_half_sine < 1.0 && {
                let ends = Ends::new(link, &model.cloths);
                let length = vector(link, &ends, state, prescribed, time).norm();
                turn(fold, length, link.rest) > settings.break_half_sine
            };
            if is_apart || is_folded {
                (self.broken[at], any) = (true, true);
            }
        }
        if any {
            self.folds.release(&self.broken);
        }
        any
    }
}
