//! Islands of cloths that are near each other, and the mean motion of each in a time step.
//!
//! What one island needs changes no bit of another.

use crate::contact::cloth::contacts::ClothContacts;
use crate::contact::material::ContactMaterial;
use crate::contact::system::ContactPass;
use crate::math::{Real, Row4, add, sub};
use crate::union_find::UnionFind;

/// Grows a mask of cloths until it holds whole islands.
pub fn grow_to_islands<R: Real>(contacts: &ClothContacts<R>, mask: &mut [bool]) {
    let mut islands = islands(Some(contacts), mask.len());
    let mut is_masked = vec![false; mask.len()];
    for cloth in (0..mask.len()).filter(|cloth| mask[*cloth]) {
        is_masked[islands.find(cloth as u32) as usize] = true;
    }
    for (cloth, mask) in mask.iter_mut().enumerate() {
        *mask = is_masked[islands.find(cloth as u32) as usize];
    }
}

/// Finds the mean motion of each island, by mass: the safeguard truncates motion relative to it, and freezes points in it.
/// Relative to space, it would brake cloth in flight. An island with a pinned point is at rest. One that may touch an obstacle
/// has none: what that does to a part of it would set all of it in motion.
pub fn find_drift<R: Real>(pass: &mut ContactPass<'_, R>) {
    let (means, is_alone) = (mean_motions(pass), alone(pass));
    pass.contact.drift.clear();
    pass.contact
        .drift
        .extend(means.into_iter().zip(is_alone).map(|(mean, is_alone)| is_alone.then_some(mean)));
}

/// Gives islands that have a drift the momentum back that truncation has taken from them or given to them. It changes velocities
/// and no position.
pub fn keep_momentum<R: Real>(pass: &mut ContactPass<'_, R>) {
    let means = mean_motions(pass);
    let ContactPass { model, state, contact, .. } = pass;
    for ((cloth, drift), mean) in model.cloths.iter().zip(&contact.drift).zip(means) {
        let Some(lost) = drift.map(|drift| sub(drift, mean)) else { continue };
        for row in cloth.points().map(|row| row as usize) {
            let [x, y, z] = sub(state.bearing_depenetration[row].xyz(), lost);
            state.bearing_depenetration[row] = Row4([x, y, z, R::ZERO]);
        }
    }
}

/// Whether each cloth is in an island that only its own cloths can push.
fn alone<R: Real>(pass: &ContactPass<'_, R>) -> Vec<bool> {
    let cloths = pass.model.cloths.len();
    let mut islands = islands(pass.contact.cloth_contacts.as_ref(), cloths);
    let mut is_alone = vec![true; cloths];
    for cloth in 0..cloths {
        is_alone[islands.find(cloth as u32) as usize] &= !is_near_obstacle(pass, cloth);
    }
    (0..cloths).map(|cloth| is_alone[islands.find(cloth as u32) as usize]).collect()
}

/// Whether a cloth may touch a collider or the ground in this time step, or cloth of another layer, which it moves without being
/// moved.
fn is_near_obstacle<R: Real>(pass: &ContactPass<'_, R>, cloth: usize) -> bool {
    let ContactPass { model, state, contact, .. } = pass;
    let lists = &contact.collider_contacts[contact.lists_of(cloth)];
    let is_low = |material: &ContactMaterial<R>| {
        let mut heights =
            model.cloths[cloth].points().filter_map(|row| contact.ground.height(state.position(row)));
        heights.any(|height| height < 2.0 * material.thickness)
    };
    let others = contact.cloth_contacts.iter().flat_map(|contacts| contacts.materials.row(cloth)).flatten();
    lists.iter().any(|list| list.len() > 0 || !list.depenetration.points.is_empty())
        || contact.ground_materials[cloth].as_ref().is_some_and(is_low)
        || others.into_iter().any(|material| material.mobility != [R::ONE; 2])
}

fn islands<R: Real>(contacts: Option<&ClothContacts<R>>, cloths: usize) -> UnionFind {
    let mut islands = UnionFind::new(cloths);
    if let Some(ClothContacts { cache, materials, .. }) = contacts {
        cache.cloth_pairs(materials).for_each(|[a, b]| islands.union(a as u32, b as u32));
    }
    islands
}

/// The mean motion in the time step of each cloth's island, in metres, without depenetration.
fn mean_motions<R: Real>(pass: &ContactPass<'_, R>) -> Vec<[R; 3]> {
    let ContactPass { model, state, contact, .. } = pass;
    let mut islands = islands(contact.cloth_contacts.as_ref(), model.cloths.len());
    // Mass, and its motion; infinite where a point is pinned.
    let mut sums = vec![[0.0f64; 4]; model.cloths.len()];
    for (index, cloth) in model.cloths.iter().enumerate() {
        let sum = &mut sums[islands.find(index as u32) as usize];
        for row in cloth.points().map(|row| row as usize) {
            let mass = 1.0 / state.displacement[row].0[3].to_f64();
            let without_velocity = [&state.start, &state.depenetration, &state.bearing_depenetration];
            let without_velocity =
                without_velocity.map(|column| column[row].xyz()).into_iter().fold([R::ZERO; 3], add);
            let moved = sub(state.displacement[row].xyz(), without_velocity).map(R::to_f64);
            (0..3).for_each(|axis| sum[axis] += mass * moved[axis]);
            sum[3] += mass;
        }
    }
    let mean = |cloth: usize| {
        let [x, y, z, mass] = sums[islands.find(cloth as u32) as usize];
        let has_mean = mass.is_finite() && mass > 0.0;
        [x, y, z].map(|moved| R::from_f64(if has_mean { moved / mass } else { 0.0 }))
    };
    (0..model.cloths.len()).map(mean).collect()
}
