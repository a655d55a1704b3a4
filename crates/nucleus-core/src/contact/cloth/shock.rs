//! Shock propagation (Guendelman, Bridson and Fedkiw 2003, *Nonconvex Rigid Bodies with Stacking*): what a collider bears
//! counts as immovable in the direction in which it is borne, and bears what rests on it.
//!
//! In a contact each side moves by its inverse mass. Of a heavy cloth on a light one the light one takes nearly all of a push,
//! the collider below returns it, and the heavy one sinks on: a sweep would have to be repeated about as often as the one is
//! heavier than the other. So a side that was borne in the last time step leaves the whole push to the other, which is borne from
//! then on: a step for each layer.
//!
//! The load does not get to the ground, so friction acts on a borne side only where it has to slip first: where what bears it has
//! less friction. Then it is moved by its mass, as everywhere.

use crate::contact::cloth::contact::{ClothContact, ClothStep};
use crate::contact::cloth::contacts::ClothContacts;
use crate::contact::cloth::islands::grow_to_islands;
use crate::contact::material::ContactMaterial;
use crate::contact::system::{ContactPass, ContactSystem};
use crate::input::frame::FrameInput;
use crate::math::{Real, dot, scale};
use crate::model::Model;

/// Mass of a point, relative to that of another cloth, above which one sweep does not bear it.
const MASS_RATIO: f64 = 2.0;
/// Cosine of the angle between a push and the direction from which a point is borne, up to which it does not move.
const LEAST_COSINE: f64 = 0.9;

/// Whether a cloth can lie on one that is so much lighter, above a collider or the ground.
pub fn has_shock<R: Real>(model: &Model<R>, contact: &ContactSystem<R>, frame: &FrameInput) -> bool {
    let Some(ClothContacts { materials, .. }) = &contact.cloth_contacts else { return false };
    let is_borne = frame.plane.is_some() || frame.colliders.iter().any(|collider| collider.collide);
    let cloths = model.cloths.len();
    let is_unequal = |at: usize| is_unequal(model, [at / cloths, at % cloths]);
    is_borne && (0..materials.len()).any(|at| materials[at].is_some() && is_unequal(at))
}

fn is_unequal<R: Real>(model: &Model<R>, cloths: [usize; 2]) -> bool {
    let [a, b] = cloths.map(|cloth| model.cloths[cloth].point_mass);
    a > b * MASS_RATIO || b > a * MASS_RATIO
}

/// Finds the islands of cloths in which a heavier one is near a lighter one. What bounces does not rest: a sheet on a borne one
/// that does not give way would gain energy.
pub fn find_shock<R: Real>(pass: &mut ContactPass<'_, R>) {
    let ContactSystem { cloth_contacts, has_shock, shock_mask, collider_materials, ground_materials, .. } =
        &mut *pass.contact;
    shock_mask.clear();
    let Some(ClothContacts { cache, materials, .. }) = cloth_contacts.as_ref().filter(|_| *has_shock) else {
        return;
    };
    shock_mask.resize(pass.model.cloths.len(), false);
    for [a, b] in cache.cloth_pairs(materials.len()).filter(|&pair| is_unequal(pass.model, pair)) {
        (shock_mask[a], shock_mask[b]) = (true, true);
    }
    if !shock_mask.contains(&true) {
        return shock_mask.clear();
    }
    grow_to_islands(cache, shock_mask);
    let (cloths, colliders) = (shock_mask.len(), collider_materials.len() / shock_mask.len());
    for (cloth, mark) in shock_mask.iter_mut().enumerate() {
        let among_cloths = materials[cloth * cloths..(cloth + 1) * cloths].iter().flatten();
        let with_colliders = collider_materials[cloth * colliders..(cloth + 1) * colliders].iter().flatten();
        let mut all = among_cloths.chain(with_colliders).chain(&ground_materials[cloth]);
        *mark &= !all.any(ContactMaterial::has_restitution);
    }
}

impl<R: Real, const N: usize, const M: usize> ClothContact<R, N, M> {
    /// Given the inverse masses of both sides, those of shock propagation for a push and for friction: zero for a side that is
    /// borne, while the other is borne from now on. Friction moves a borne side all the same where what bears it has less.
    pub(super) fn on_borne_side(
        &self,
        step: &ClothStep<'_, R>,
        (ours, theirs): ([R; N], [R; M]),
        (b, c): &([R; N], [R; M]),
        friction: R,
    ) -> [([R; N], [R; M]); 2] {
        let all = (ours, theirs);
        let cloths = self.cloths(step.materials.len());
        if step.shock_mask.is_empty() || cloths.iter().any(|&cloth| !step.shock_mask[cloth]) {
            return [all; 2];
        }
        let (up, down) = (self.normal, scale(self.normal, -R::ONE));
        let (without, grip) = match (grip(step, &self.ours, b, down), grip(step, &self.theirs, c, up)) {
            (Some(grip), None) => {
                self.theirs.iter().for_each(|&point| step.writer.bear(point, down, min(grip, friction)));
                (([R::ZERO; N], theirs), grip)
            }
            (None, Some(grip)) => {
                self.ours.iter().for_each(|&point| step.writer.bear(point, up, min(grip, friction)));
                ((ours, [R::ZERO; M]), grip)
            }
            _ => return [all; 2],
        };
        [without, if grip >= friction { without } else { all }]
    }
}

/// The least friction with what bore the points at a contact in about this direction; `None` where one was not borne.
fn grip<R: Real>(step: &ClothStep<'_, R>, points: &[u32], weights: &[R], direction: [R; 3]) -> Option<R> {
    let mut least = R::from_f64(f64::from(f32::MAX));
    for (&point, _) in points.iter().zip(weights).filter(|(_, weight)| **weight != R::ZERO) {
        let support = step.writer.support(point);
        if dot(support.xyz(), direction) < R::from_f64(LEAST_COSINE) {
            return None;
        }
        least = min(least, support.0[3]);
    }
    Some(least)
}

fn min<R: Real>(a: R, b: R) -> R {
    if b < a { b } else { a }
}
