//! Surfaces that face each other with cloth between them: of two colliders, of one that folds, or of one and the ground.

use crate::contact::clearance::NearSurface;
use crate::contact::collider::contact::ColliderContact;
use crate::contact::collider::lists::for_contacts_of;
use crate::contact::contact_state::MIN_WEIGHT;
use crate::contact::ground::pass::for_ground_contacts;
use crate::contact::system::ContactPass;
use crate::contact::time_step::ColliderStep;
use crate::math::Real;

/// Finds the clearance that the points of the cloths of a pass have between colliders and the ground, by their active contacts.
pub fn find_clearance<R: Real>(pass: &mut ContactPass<'_, R>) {
    let mut clearance = std::mem::take(&mut pass.contact.material_maps.clearance);
    clearance.find(pass.state.anchor.len(), |near| list_surfaces(pass, near));
    pass.contact.material_maps.clearance = clearance;
}

fn list_surfaces<R: Real>(pass: &mut ContactPass<'_, R>, near: &mut Vec<NearSurface<R>>) {
    let model = pass.model;
    for cloth in 0..model.cloths.len() {
        if !pass.contact.is_listed(cloth) {
            continue;
        }
        for_contacts_of(pass, cloth, |list, step, _, _| {
            add_surfaces(&list.point_face, &list.active.points.indices, &step, near);
            add_surfaces(&list.edge_edge, &list.active.edges.indices, &step, near);
            add_surfaces(&list.face_point, &list.active.faces.indices, &step, near);
        });
    }
    for_ground_contacts(pass, 1.0, |cloth, ground, _, _| {
        near.extend(model.cloths[cloth].points().filter_map(|point| ground.near_surface(point)));
    });
}

fn add_surfaces<R: Real, const N: usize, const M: usize>(
    contacts: &[ColliderContact<R, N, M>],
    active: &[u32],
    step: &ColliderStep<'_, R>,
    near: &mut Vec<NearSurface<R>>,
) {
    for contact in active.iter().map(|&at| &contacts[at as usize]) {
        let (gap, _) = contact.gaps(step.start_displacements(contact.points), step.shares[1]);
        let thickness = contact.rest_gap(step, contact.weights);
        let takes_part = |k: &usize| contact.weights[*k] >= R::from_f64(MIN_WEIGHT);
        for k in (0..N).filter(takes_part).filter(|_| gap < thickness) {
            near.push(NearSurface { point: contact.points[k], normal: contact.normal, gap, thickness });
        }
    }
}
