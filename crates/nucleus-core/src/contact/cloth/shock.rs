//! Shock propagation (Guendelman, Bridson and Fedkiw 2003, *Nonconvex Rigid Bodies with Stacking*): what a collider bears
//! counts as immovable in the direction in which it is borne, and bears what rests on it.
//!
//! In a contact each side moves by its inverse mass. Of a heavy cloth on a light one the light one takes nearly all of a push,
//! the collider below returns it, and the heavy one sinks on: a sweep would have to be repeated about as often as the one is
//! heavier than the other. So a side that was borne in the last time step leaves the whole push to the other, which is borne from
//! then on: a step for each layer.
//!
//! The load does not get to the ground. Friction is proportional to it and so is what it has to hold, on a slope; but a heavy
//! cloth that is drawn over a light one does not take that along.

use crate::contact::cloth::contact::{ClothContact, ClothStep};
use crate::contact::cloth::contacts::ClothContacts;
use crate::contact::cloth::islands::grow_to_islands;
use crate::contact::system::{ContactPass, ContactSystem};
use crate::input::frame::FrameInput;
use crate::math::{Real, Row4, add, dot, scale, unit};
use crate::model::Model;
use crate::state::State;

/// Mass of a point, relative to that of another cloth, above which one sweep does not bear it.
const MASS_RATIO: f64 = 2.0;
/// Rigidity of a body that passes a load on to all of its points.
const LEAST_RIGIDITY: f64 = 1.0;
/// Cosine of the angle between a push and the direction from which a point is borne, up to which it does not move.
const LEAST_COSINE: f64 = 0.7;

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

/// Finds the islands of cloths in which a heavier one is near a lighter one.
pub fn find_shock<R: Real>(pass: &mut ContactPass<'_, R>) {
    let ContactSystem { cloth_contacts, has_shock, shock_mask, .. } = &mut *pass.contact;
    shock_mask.clear();
    let Some(ClothContacts { cache, materials, .. }) = cloth_contacts.as_ref().filter(|_| *has_shock) else {
        return;
    };
    shock_mask.resize(pass.model.cloths.len(), false);
    for [a, b] in cache.cloth_pairs(materials.len()).filter(|&pair| is_unequal(pass.model, pair)) {
        (shock_mask[a], shock_mask[b]) = (true, true);
    }
    if shock_mask.contains(&true) {
        grow_to_islands(cache, shock_mask);
    } else {
        shock_mask.clear();
    }
}

/// Rigid bodies that were borne anywhere in the last time step are borne as a whole.
pub fn bear_rigid_bodies<R: Real>(model: &Model<R>, state: &mut State<R>, frame: &FrameInput) {
    if state.support_before.is_empty() {
        return;
    }
    let rigid = |settings: &f64| *settings >= LEAST_RIGIDITY;
    for (cloth, settings) in model.cloths.iter().zip(&frame.cloths) {
        let points = cloth.points();
        let own = &mut state.support_before[points.start as usize..points.end as usize];
        let all = own.iter().map(|row| row.xyz()).fold([R::ZERO; 3], add);
        if let Some([x, y, z]) = unit(all, R::ZERO).filter(|_| rigid(&settings.rigidity)) {
            own.fill(Row4([x, y, z, R::ZERO]));
        }
    }
}

impl<R: Real, const N: usize, const M: usize> ClothContact<R, N, M> {
    /// Given the inverse masses of both sides, those in shock propagation: zero for a side that is borne, while the other is
    /// borne from now on.
    pub(super) fn on_borne_side(
        &self,
        step: &ClothStep<'_, R>,
        (ours, theirs): ([R; N], [R; M]),
        (b, c): &([R; N], [R; M]),
    ) -> ([R; N], [R; M]) {
        if !step.has_shock[self.cloths(step.materials.len())[0]] {
            return (ours, theirs);
        }
        let (up, down) = (self.normal, scale(self.normal, -R::ONE));
        match (is_borne(step, &self.ours, b, down), is_borne(step, &self.theirs, c, up)) {
            (true, false) => {
                self.theirs.iter().for_each(|&point| step.writer.bear(point, down));
                ([R::ZERO; N], theirs)
            }
            (false, true) => {
                self.ours.iter().for_each(|&point| step.writer.bear(point, up));
                (ours, [R::ZERO; M])
            }
            _ => (ours, theirs),
        }
    }
}

/// Whether all points at a contact were borne in about this direction.
fn is_borne<R: Real>(step: &ClothStep<'_, R>, points: &[u32], weights: &[R], direction: [R; 3]) -> bool {
    let least = R::from_f64(LEAST_COSINE);
    let mut pairs = points.iter().zip(weights);
    pairs.all(|(&point, &weight)| weight == R::ZERO || dot(step.writer.support(point), direction) >= least)
}
