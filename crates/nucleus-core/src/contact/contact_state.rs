//! The contact state of each point of a cloth at the end of a step. Computed only on request of an observer.

use nalgebra::Vector3;

use crate::contact::bvh::Aabb;
use crate::contact::cloth::contact::ClothContact;
use crate::contact::collider::contact::ColliderContact;
use crate::contact::collider::contacts::ColliderContacts;
use crate::contact::material::ContactMaterial;
use crate::contact::narrow_phase::shortest_line;
use crate::contact::pair_table::ContactMaterials;
use crate::contact::system::ContactSystem;
use crate::math::Real;
use crate::model::Model;
use crate::output::ContactState;
use crate::state::State;

/// Gap ratio up to which two elements are touching. Passes keep the full thickness along a plane; the constraint
/// sweeps after them and curved meshes add a little.
const TOUCHING_RATIO: f64 = 1.02;
/// Gap ratio below which a contact is compressed, for observers.
const COMPRESSED: f64 = 0.9;
/// Smallest weight at which the corner of an edge or a face takes part in a contact.
pub const MIN_WEIGHT: f64 = 0.25;

/// The highest state so far of each row of the solver.
struct HighestStates<'a> {
    states: &'a mut [ContactState],
    /// Gap ratio below which a contact is compressed.
    compressed: f64,
}

impl HighestStates<'_> {
    fn raise(&mut self, point: u32, to: ContactState) {
        let state = &mut self.states[point as usize];
        *state = (*state).max(to);
    }

    /// Raises a point by the ratio of its gap to its thickness.
    fn raise_by_gap(&mut self, point: u32, gap_ratio: f64) {
        if gap_ratio < self.compressed {
            self.raise(point, ContactState::Compressed);
        } else if gap_ratio < TOUCHING_RATIO {
            self.raise(point, ContactState::Touching);
        }
    }

    fn raise_all_by_gap<const N: usize>(&mut self, points: [u32; N], shares: [f64; N], gap_ratio: f64) {
        let parts = points.into_iter().zip(shares).filter(|&(_, share)| share >= MIN_WEIGHT);
        parts.for_each(|(point, _)| self.raise_by_gap(point, gap_ratio));
    }
}

/// Replaces `out` by the contact state of each point of every cloth, in the user's order.
pub fn list_contact_states<R: Real>(
    model: &Model<R>,
    state: &State<R>,
    contact: &ContactSystem<R>,
    out: &mut Vec<Vec<ContactState>>,
) {
    out.resize_with(model.cloths.len(), Vec::new);
    out.iter_mut().for_each(Vec::clear);
    let rows = seen_contact_states(model, state, contact);
    if rows.is_empty() {
        return;
    }
    for (model, out) in model.cloths.iter().zip(out) {
        let first = model.points().start;
        out.extend(model.places().iter().map(|&place| rows[(first + place) as usize]));
    }
}

/// The contact state of each row of the solver, as observers see it; empty where the scene can have no contact.
pub fn seen_contact_states<R: Real>(
    model: &Model<R>,
    state: &State<R>,
    contact: &ContactSystem<R>,
) -> Vec<ContactState> {
    // A restored solver has no contacts to compute them from before its first frame.
    contact.restored_states.clone().unwrap_or_else(|| {
        let mut rows = Vec::new();
        contact_states_of_rows(model, state, contact, COMPRESSED, &mut rows);
        rows
    })
}

/// Replaces `rows` by the contact state of each row of the solver, which is compressed below a ratio of its gap to its
/// thickness; empty where the scene can have no contact.
pub fn contact_states_of_rows<R: Real>(
    model: &Model<R>,
    state: &State<R>,
    contact: &ContactSystem<R>,
    compressed: f64,
    rows: &mut Vec<ContactState>,
) {
    rows.clear();
    let points = ContactPoints { model, state, contact };
    if points.can_have_contact() {
        rows.resize(state.anchor.len(), ContactState::Free);
        points.raise(&mut HighestStates { states: rows, compressed });
    }
}

/// The inputs of contact states.
struct ContactPoints<'a, R: Real> {
    model: &'a Model<R>,
    state: &'a State<R>,
    contact: &'a ContactSystem<R>,
}

impl<R: Real> ContactPoints<'_, R> {
    /// Whether this scene can have contact at all.
    fn can_have_contact(&self) -> bool {
        self.contact.ground.is_there()
            || !self.contact.collider_contacts.is_empty()
            || self.contact.cloth_contacts.is_some()
    }

    /// Raises every row to its contact state.
    fn raise(&self, states: &mut HighestStates<'_>) {
        self.set_ground_states(states);
        for list in &self.contact.collider_contacts {
            if self.contact.is_free[list.cloth] {
                self.set_free_states(list, states);
            }
            self.set_collider_states(list, states);
        }
        self.set_cloth_states(states);
    }

    fn set_ground_states(&self, states: &mut HighestStates<'_>) {
        let grounded = self.model.cloths.iter().zip(&self.contact.ground_materials);
        for (cloth, material) in grounded.filter_map(|(cloth, material)| Some((cloth, material.as_ref()?))) {
            let filter = &self.contact.pair_filter;
            for row in cloth.points().filter(|row| !filter.excludes_ground(*row)) {
                let thickness = self.rest_gap(material, [row], [R::ONE]);
                if let Some(height) = self.contact.ground.height(self.state.position(row)) {
                    states.raise_by_gap(row, height / thickness);
                }
            }
        }
    }

    fn set_collider_states(&self, list: &ColliderContacts<R>, states: &mut HighestStates<'_>) {
        let ColliderContacts { point_face, edge_edge, face_point, active, depenetration, .. } = list;
        depenetration.points.iter().for_each(|&(point, _)| states.raise(point, ContactState::Depenetrating));
        // The pair may not collide in this frame.
        let Some(Some(material)) = self.contact.collider_materials_of(list.cloth).get(list.collider) else {
            return;
        };
        let collider = list.collider;
        active
            .points
            .indices
            .iter()
            .for_each(|&k| self.set_collider_state(&point_face[k as usize], collider, material, states));
        active
            .edges
            .indices
            .iter()
            .for_each(|&k| self.set_collider_state(&edge_edge[k as usize], collider, material, states));
        active
            .faces
            .indices
            .iter()
            .for_each(|&k| self.set_collider_state(&face_point[k as usize], collider, material, states));
    }

    /// Free points have no list of contacts: their nearest faces are searched.
    fn set_free_states(&self, list: &ColliderContacts<R>, states: &mut HighestStates<'_>) {
        let Some(Some(material)) = self.contact.collider_materials_of(list.cloth).get(list.collider) else {
            return;
        };
        let (cloth, collider) = (&self.model.cloths[list.cloth], &self.model.colliders[list.collider]);
        let state = &self.contact.collider_states[list.collider];
        let (origin, range) = (state.origin(state.now), material.thickness * TOUCHING_RATIO);
        for row in cloth.points() {
            let place = Vector3::from(self.state.position(row)) - origin;
            state.bvh.query(&Aabb::new(place.add_scalar(-range), place.add_scalar(range)), |face| {
                let corners = collider.boundary.triangles[face as usize];
                if self.contact.pair_filter.excludes_collider(&[row], list.collider, &corners) {
                    return;
                }
                self.set_state([row], corners, list.collider, material, states);
            });
        }
    }

    fn set_collider_state<const N: usize, const M: usize>(
        &self,
        contact: &ColliderContact<R, N, M>,
        collider: usize,
        material: &ContactMaterial<R>,
        states: &mut HighestStates<'_>,
    ) {
        self.set_state(contact.points, contact.collider_points, collider, material, states);
    }

    fn set_state<const N: usize, const M: usize>(
        &self,
        points: [u32; N],
        collider_points: [u32; M],
        collider: usize,
        material: &ContactMaterial<R>,
        states: &mut HighestStates<'_>,
    ) {
        let state = &self.contact.collider_states[collider];
        let ours = points.map(|point| self.state.position(point));
        let theirs = collider_points.map(|point| state.point(point, state.now).into());
        let (_, (shares, weights), distance) = shortest_line::<f64, N, M>((ours, theirs));
        let maps = &self.contact.material_maps;
        let thickness =
            material.thickness_with_collider(maps, (points, shares), (collider, collider_points, weights));
        states.raise_all_by_gap(points, shares, distance / thickness);
    }

    /// The contact thickness of a cloth's element with a collider or the plane, in metres.
    fn rest_gap<const N: usize>(
        &self,
        material: &ContactMaterial<R>,
        points: [u32; N],
        shares: [R; N],
    ) -> f64 {
        let most = R::from_f64(material.thickness);
        material.thickness_at(&self.contact.material_maps, (points, [], &(shares, [])), most).to_f64()
    }

    fn set_cloth_states(&self, states: &mut HighestStates<'_>) {
        let Some(cloth_contacts) =
            self.contact.cloth_contacts.as_ref().filter(|cloth_contacts| cloth_contacts.is_enabled())
        else {
            return;
        };
        let cache = &cloth_contacts.cache;
        let materials = &cloth_contacts.materials;
        cache.point_face.iter().for_each(|contact| self.set_cloth_state(contact, materials, states));
        cache.edge_edge.iter().for_each(|contact| self.set_cloth_state(contact, materials, states));
        cache.point_edge.iter().for_each(|contact| self.set_cloth_state(contact, materials, states));
        cache.point_point.iter().for_each(|contact| self.set_cloth_state(contact, materials, states));
        for intersection in &cloth_contacts.untangling.intersections {
            let corners = intersection.edge.iter().chain(&intersection.face);
            corners.for_each(|&point| states.raise(point, ContactState::Intersecting));
        }
    }

    fn set_cloth_state<const N: usize, const M: usize>(
        &self,
        contact: &ClothContact<R, N, M>,
        materials: &ContactMaterials<R>,
        states: &mut HighestStates<'_>,
    ) {
        let place = |point: u32| self.state.position(point);
        let (_, (ours, theirs), distance) =
            shortest_line((contact.ours.map(place), contact.theirs.map(place)));
        let weights = (ours.map(R::from_f64), theirs.map(R::from_f64));
        let gap_ratio =
            distance / contact.thickness_at(materials, &self.contact.material_maps, &weights).to_f64();
        states.raise_all_by_gap(contact.ours, ours, gap_ratio);
        states.raise_all_by_gap(contact.theirs, theirs, gap_ratio);
    }
}
