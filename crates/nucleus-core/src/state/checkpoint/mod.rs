//! All that a solver carries from one frame into the next, as bytes: a solver that is made from them goes on with the
//! same bits as one that never stopped.
//!
//! | You want to know… | Read |
//! |---|---|
//! | how numbers, columns and lists become bytes | `item.rs` |
//! | what is kept of each struct, and what is made anew | `kept!` beside the struct, by the rules in `kept.rs` |
//! | the small values among them | `values.rs` |
//! | which model a checkpoint belongs to | `fingerprint.rs` |
//! | what keeps damaged bytes from doing harm | `fits.rs`, and the seal in `seal.rs` |
//!
//! **Invariant:** `kept!` and `item!` name every field of a struct. Whoever adds one, a multiplier, the age of a particle
//! or the place of a random stream, has to say what becomes of it, or it does not compile.

mod fingerprint;
mod fits;
mod item;
mod kept;
mod seal;
mod values;

pub(crate) use item::item;
pub use item::{Item, Reader};
pub(crate) use kept::{Kept, kept, load_column};
pub use seal::{RestoreError, sealed, unsealed};

use crate::contact::cloth::ClothContacts;
use crate::contact::collider::ColliderState;
use crate::contact::collider::contacts::ColliderContacts;
use crate::math::Real;
use crate::model::builder::ModelBuilder;
use crate::solver::Solver;
use crate::state::State;

/// What the bytes are; counted up whenever their layout changes.
const KIND: [u8; 8] = *b"solver 5";

impl<R: Real> Solver<R> {
    /// All that the next frame depends on, besides the model and what the frame brings.
    pub fn save(&self) -> Vec<u8> {
        R::save(self)
    }

    pub(crate) fn bytes(&self) -> Vec<u8> {
        let mut bytes = Vec::new();
        (R::SIZE as u8).put(&mut bytes);
        self.fingerprint().put(&mut bytes);
        Kept::save(self, &mut bytes);
        self.save_pairs(&mut bytes);
        sealed(KIND, &bytes)
    }

    /// Contacts of a cloth near a collider that moves are valid in this frame alone: all but its points inside colliders
    /// are searched anew in the next.
    fn save_pairs(&self, out: &mut Vec<u8>) {
        for list in &self.collider_contacts {
            let of_cloth =
                self.collider_contacts.iter().filter(|other| other.cloth == list.cloth && other.is_near);
            let is_valid =
                !of_cloth.map(|list| list.collider).any(|collider| self.collider_states[collider].moves);
            is_valid.put(out);
            list.is_near.put(out);
            if is_valid {
                list.save(out);
            } else {
                list.interval.put(out);
                list.depenetration.put(out);
            }
        }
    }

    fn load_pairs(&mut self, from: &mut Reader<'_>) -> Option<()> {
        for list in &mut self.collider_contacts {
            let is_valid = bool::take(from)?;
            list.is_near = Item::take(from)?;
            if is_valid {
                list.load(from)?;
            } else {
                list.interval = Item::take(from)?;
                list.depenetration = Item::take(from)?;
            }
        }
        Some(())
    }

    /// A solver that goes on from where one of the same model was saved, with the same bits. `threads` is the number of
    /// cores to use; it may be another.
    ///
    /// # Errors
    /// When the bytes are damaged, of another version, or of another model.
    pub fn restored(builder: ModelBuilder, threads: usize, bytes: &[u8]) -> Result<Self, RestoreError> {
        R::restore(builder, threads, bytes)
    }

    pub(crate) fn restore(builder: ModelBuilder, threads: usize, bytes: &[u8]) -> Result<Self, RestoreError> {
        let mut solver = Self::build(builder, threads);
        let mut from = Reader::new(unsealed(KIND, bytes)?);
        let scalar = u8::take(&mut from).ok_or(RestoreError::Damaged)?;
        if usize::from(scalar) != R::SIZE {
            return Err(RestoreError::Scalar { found: 8 * u32::from(scalar), wanted: 8 * R::SIZE as u32 });
        }
        if u64::take(&mut from).ok_or(RestoreError::Damaged)? != solver.fingerprint() {
            return Err(RestoreError::OtherModel);
        }
        let read = solver.load(&mut from).and_then(|()| solver.load_pairs(&mut from));
        read.filter(|()| from.is_at_end()).ok_or(RestoreError::Damaged)?;
        if !solver.fits() {
            return Err(RestoreError::Damaged);
        }
        solver.make_rest_anew();
        Ok(solver)
    }

    /// What follows from what was kept.
    fn make_rest_anew(&mut self) {
        for collider in &mut self.collider_states {
            let (start, end, now) = (collider.start.clone(), collider.end.clone(), collider.now);
            collider.begin_frame(&start, &end);
            collider.now = now;
        }
        self.collider_contacts.iter_mut().for_each(ColliderContacts::sort_by_point);
        if let Some(ClothContacts { elements, .. }) = &mut self.cloth_contacts {
            elements.refit();
        }
        self.anchor_rows();
    }
}

// Pairs are kept beside the rest, where they hold.
kept!([R: Real] Solver<R> {
    columns: [interval_bounds, bounds_violated],
    values: [collider_materials, ground_materials, touches],
    parts: [state, collider_states, cloth_contacts, ground],
    anew: [cloths, colliders, collider_contacts, candidate_intervals, active_windows, frame_travel, window_bounds, material_maps, pool],
});

kept!([R: Real] State<R> {
    columns: [anchor, displacement, velocity],
    values: [],
    parts: [],
    anew: [start, depenetration_by_collider, depenetration_by_cloth, step_length, predicted, normal, inverse_mass],
});

kept!([R: Real] ColliderContacts<R> {
    columns: [],
    values: [interval, point_face, edge_edge, face_point, depenetration],
    parts: [],
    anew: [cloth, collider, is_near, by_point, active, is_searched, searched_groups, tasks],
});

kept!([R: Real] ClothContacts<R> {
    columns: [bounds_violated, interval_start],
    values: [materials, interval],
    parts: [elements, trajectories, cache, untangling],
    anew: [buffers, frozen],
});

impl<R: Real> ColliderContacts<R> {
    /// Sets `by_point`.
    fn sort_by_point(&mut self) {
        let keys = (0..).zip(&self.point_face).map(|(index, pair)| u64::from(pair.points[0]) << 32 | index);
        self.by_point = keys.collect();
        self.by_point.sort_unstable();
    }
}

/// A collider's state is in good order if its places are.
fn is_sound(collider: &ColliderState) -> bool {
    let usable = |column: &[nalgebra::Vector3<f64>]| column.iter().all(crate::input::validation::is_usable);
    usable(&collider.start) && usable(&collider.end)
}
