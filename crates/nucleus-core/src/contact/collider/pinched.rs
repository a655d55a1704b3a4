//! Points that leave a collider while another collider or the ground is in their way.
//!
//! Such a point is pinched: it goes out no farther than there is clearance, and moves with what it touches. Pushed by both in
//! turn, it would gain speed, and be moved sideways (Baraff, Witkin and Kass 2003, *Untangling cloth*, §6, flypapering).

use nalgebra::Vector3;

use crate::contact::boundary::unit_normal;
use crate::contact::collider::lists::for_contacts_of;
use crate::contact::depenetration::Obstacle;
use crate::contact::ground::pass::for_ground_contacts;
use crate::contact::system::ContactPass;
use crate::math::Real;

/// Pushes the points of a cloth that are inside colliders outward, as far as there is clearance.
pub fn push_points_outward<R: Real>(pass: &mut ContactPass<'_, R>, cloth: usize, thickness_scale: f64) {
    let of_cloth = pass.contact.lists_of(cloth);
    if pass.contact.collider_contacts[of_cloth].iter().all(|list| list.depenetration.points.is_empty()) {
        return;
    }
    let mut obstacles = std::mem::take(&mut pass.contact.obstacles);
    find_obstacles(pass, cloth, thickness_scale, &mut obstacles);
    let model = pass.model;
    for_contacts_of(pass, cloth, |list, step, _, _| {
        let step = step.with_thickness_scale(thickness_scale);
        let others = |point: u32| {
            let first = obstacles.partition_point(|obstacle| obstacle.point < point);
            let of_point = obstacles[first..].iter().take_while(move |obstacle| obstacle.point == point);
            of_point.filter(|obstacle| obstacle.collider != Some(list.collider))
        };
        list.depenetration.push_outward(&model.colliders[list.collider], &step, |point, outward| {
            let towards =
                others(point).map(|obstacle| (obstacle.clearance.max(0.0), -obstacle.normal.dot(outward)));
            let clearances =
                towards.filter(|&(_, share)| share > 0.0).map(|(clearance, share)| clearance / share);
            clearances.fold(f64::INFINITY, f64::min)
        });
    });
    pass.contact.obstacles = obstacles;
}

/// Lists what is in the way of the points of a cloth that are inside any collider, sorted by point.
fn find_obstacles<R: Real>(
    pass: &mut ContactPass<'_, R>,
    cloth: usize,
    thickness_scale: f64,
    obstacles: &mut Vec<Obstacle>,
) {
    obstacles.clear();
    let model = pass.model;
    // The exits come first: every point inside is among them.
    for_contacts_of(pass, cloth, |list, step, _, _| {
        for &(point, face) in &list.depenetration.points {
            let corners = model.colliders[list.collider].boundary.triangles[face as usize];
            let normal = unit_normal(step.collider_positions(corners)[1]);
            obstacles.push(Obstacle { point, collider: Some(list.collider), normal, clearance: 0.0 });
        }
    });
    let exits = obstacles.len();
    obstacles.sort_unstable_by_key(|obstacle| obstacle.point);
    for_contacts_of(pass, cloth, |list, step, _, _| {
        let step = step.with_thickness_scale(thickness_scale);
        for contact in list.point_face.contacts() {
            let [point] = contact.points;
            let is_inside = obstacles[..exits].binary_search_by_key(&point, |exit| exit.point).is_ok();
            if is_inside && !list.depenetration.contains(point) {
                let clearance =
                    (contact.gaps_above_plane(&step)[1] - contact.rest_gap(&step, [R::ONE])).to_f64();
                let normal = Vector3::from(contact.normal.map(R::to_f64));
                obstacles.push(Obstacle { point, collider: Some(list.collider), normal, clearance });
            }
        }
    });
    for_ground_contacts(pass, thickness_scale, |of, ground, _, _| {
        for at in 0..if of == cloth { exits } else { 0 } {
            let point = obstacles[at].point;
            let normal = Vector3::from(ground.plane.normal().map(R::to_f64));
            obstacles.push(Obstacle {
                point,
                collider: None,
                normal,
                clearance: ground.clearance(point).to_f64(),
            });
        }
    });
    obstacles.sort_unstable_by_key(|obstacle| obstacle.point);
}
