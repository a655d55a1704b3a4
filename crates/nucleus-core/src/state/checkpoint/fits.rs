//! Whether what was read names nothing that the model has not. Contacts are worked on without further looks at their
//! points, so every one of them is looked at here.

use crate::contact::cloth::ClothContacts;
use crate::contact::collider::contacts::ColliderContacts;
use crate::contact::collider::query::GROUP_SIZE;
use crate::math::Real;
use crate::model::{ClothModel, ColliderModel};
use crate::solver::Solver;

impl<R: Real> Solver<R> {
    /// Whether all points, faces and groups that are named are there.
    pub(super) fn fits(&self) -> bool {
        let collider_contacts = self.collider_contacts.iter().all(|list| {
            collider_contacts_fit(list, &self.cloths[list.cloth], &self.colliders[list.collider])
        });
        let cloth_contacts =
            self.cloth_contacts.as_ref().is_none_or(|contacts| cloth_contacts_fit(contacts, &self.cloths));
        collider_contacts && cloth_contacts && self.collider_states.iter().all(super::is_sound)
    }
}

fn collider_contacts_fit<R: Real>(
    list: &ColliderContacts<R>,
    cloth: &ClothModel<R>,
    collider: &ColliderModel,
) -> bool {
    let (groups, points) = (cloth.boundary.groups(GROUP_SIZE).count(), cloth.points());
    let is_ours = |ours: &[u32]| ours.iter().all(|point| points.contains(point));
    let is_theirs = |theirs: &[u32]| theirs.iter().all(|&point| (point as usize) < collider.positions.len());
    let fits = |group: u32, ours: &[u32], theirs: &[u32]| {
        (group as usize) < groups && is_ours(ours) && is_theirs(theirs)
    };
    let faces = collider.boundary.triangles.len();
    list.point_face.iter().all(|contact| fits(contact.group, &contact.points, &contact.collider_points))
        && list.edge_edge.iter().all(|contact| fits(contact.group, &contact.points, &contact.collider_points))
        && list
            .face_point
            .iter()
            .all(|contact| fits(contact.group, &contact.points, &contact.collider_points))
        && list.depenetration.points.iter().all(|&(point, face)| is_ours(&[point]) && (face as usize) < faces)
        && is_ours(&list.depenetration.suspects)
}

fn cloth_contacts_fit<R: Real>(cloth_contacts: &ClothContacts<R>, cloths: &[ClothModel<R>]) -> bool {
    let ClothContacts { materials, untangling, elements, cache, .. } = cloth_contacts;
    let rows = cloth_contacts.bounds_violated.len();
    // Stand-ins are between the points of one cloth and those of the next.
    let mut is_point = vec![false; rows];
    cloths.iter().flat_map(ClothModel::points).for_each(|row| is_point[row as usize] = true);
    let are_points = |points: &[u32]| {
        points.iter().all(|&point| is_point.get(point as usize).is_some_and(|&is_point| is_point))
    };
    (materials.is_empty() || materials.len() == cloths.len() * cloths.len())
        && cache.point_face.iter().all(|contact| contact.is_valid(are_points, materials.len()))
        && cache.edge_edge.iter().all(|contact| contact.is_valid(are_points, materials.len()))
        && cache.point_edge.iter().all(|contact| contact.is_valid(are_points, materials.len()))
        && cache.point_point.iter().all(|contact| contact.is_valid(are_points, materials.len()))
        && untangling.intersections.iter().all(|intersection| {
            are_points(&intersection.edge)
                && are_points(&intersection.wings)
                && are_points(&intersection.face)
        })
        && elements.are_covered()
}
