//! Whether what was read names nothing that the model has not. Contacts are worked on without further looks at their
//! points, so every one of them is looked at here.

use crate::contact::cloth::Mutual;
use crate::contact::pairs::PairList;
use crate::contact::search::GROUP;
use crate::math::Real;
use crate::model::{ClothModel, ColliderModel};
use crate::solver::Solver;

impl<R: Real> Solver<R> {
    /// Whether all points, faces and groups that are named are there.
    pub(super) fn fits(&self) -> bool {
        let pairs = self
            .pairs
            .iter()
            .all(|list| pairs_fit(list, &self.cloths[list.cloth], &self.colliders[list.collider]));
        let mutual = self.mutual.as_ref().is_none_or(|mutual| mutual_fits(mutual, &self.cloths));
        pairs && mutual && self.collider_states.iter().all(super::is_sound)
    }
}

fn pairs_fit<R: Real>(list: &PairList<R>, cloth: &ClothModel<R>, collider: &ColliderModel) -> bool {
    let (groups, points) = (cloth.skin.groups(GROUP).count(), cloth.points());
    let is_ours = |ours: &[u32]| ours.iter().all(|point| points.contains(point));
    let is_theirs = |theirs: &[u32]| theirs.iter().all(|&point| (point as usize) < collider.positions.len());
    let fits = |group: u32, ours: &[u32], theirs: &[u32]| {
        (group as usize) < groups && is_ours(ours) && is_theirs(theirs)
    };
    let faces = collider.skin.triangles.len();
    list.point_face.iter().all(|pair| fits(pair.group, &pair.points, &pair.collider_points))
        && list.edge_edge.iter().all(|pair| fits(pair.group, &pair.points, &pair.collider_points))
        && list.face_point.iter().all(|pair| fits(pair.group, &pair.points, &pair.collider_points))
        && list.trapped.points.iter().all(|&(point, face)| is_ours(&[point]) && (face as usize) < faces)
        && is_ours(&list.trapped.suspects)
}

fn mutual_fits<R: Real>(mutual: &Mutual<R>, cloths: &[ClothModel<R>]) -> bool {
    let Mutual { terms, tangle, bodies, active, .. } = mutual;
    let rows = mutual.strayed.len();
    // Stand-ins are between the points of one cloth and those of the next.
    let mut is_point = vec![false; rows];
    cloths.iter().flat_map(ClothModel::points).for_each(|row| is_point[row as usize] = true);
    let are_points = |points: &[u32]| {
        points.iter().all(|&point| is_point.get(point as usize).is_some_and(|&is_point| is_point))
    };
    (terms.is_empty() || terms.len() == cloths.len() * cloths.len())
        && active.point_face.iter().all(|near| near.fits(are_points, terms.len()))
        && active.edge_edge.iter().all(|near| near.fits(are_points, terms.len()))
        && active.point_edge.iter().all(|near| near.fits(are_points, terms.len()))
        && active.point_point.iter().all(|near| near.fits(are_points, terms.len()))
        && tangle.crossings.iter().all(|crossing| {
            are_points(&crossing.edge) && are_points(&crossing.wings) && are_points(&crossing.face)
        })
        && bodies.tree.as_ref().is_none_or(|tree| tree.is_over(bodies.groups.len()))
}
