//! Which model a checkpoint belongs to: other points, faces or masses, another fingerprint.

use crate::math::Real;
use crate::model::ClothModel;
use crate::solver::Solver;

use super::seal::mixed;

impl<R: Real> Solver<R> {
    /// Of all points, faces and masses, in the solver's order. What a resistance is may change from frame to frame, and
    /// has no part in it.
    pub(super) fn fingerprint(&self) -> u64 {
        let of_cloth = |cloth: &ClothModel<R>| {
            let order = cloth.order.places().iter().map(|&place| u64::from(place));
            let rows = [cloth.stretch.len(), cloth.shear.len(), cloth.bend.len(), cloth.fold.len()];
            let lists = rows.map(|length| length as u64);
            let flags = [u64::from(cloth.damps), u64::from(cloth.turns), cloth.triangles.len() as u64];
            let boundary = words(&cloth.boundary.triangles);
            [cloth.blocks.len() as u64]
                .into_iter()
                .chain(order)
                .chain(lists)
                .chain(flags)
                .chain(boundary)
                .fold(SEED, mixed)
        };
        let cloths = self.cloths.iter().map(of_cloth);
        let colliders = self.colliders.iter().map(|collider| {
            words(&collider.boundary.triangles).chain([collider.positions.len() as u64]).fold(SEED, mixed)
        });
        let masses = self.state.inverse_mass.iter().map(|mass| mass.to_bits());
        let rows = [self.cloth_contacts.is_some() as u64, self.interval_bounds.len() as u64];
        cloths.chain([0]).chain(colliders).chain(masses).chain(rows).fold(SEED, mixed)
    }
}

const SEED: u64 = 0xcbf2_9ce4_8422_2325;

fn words(triangles: &[[u32; 3]]) -> impl Iterator<Item = u64> + '_ {
    triangles.iter().flatten().map(|&point| u64::from(point))
}
