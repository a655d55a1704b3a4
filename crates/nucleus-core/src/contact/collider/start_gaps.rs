//! Starts inside the contact thickness (Classic): the original keeps them, point by point.
//!
//! In recorded output a sheet that starts closer to a table than the contact thickness stays where it is. A point that is
//! lifted clear of the thickness comes back to rest at the full thickness; one that is lifted less sinks back below it.
//! Each point therefore has a gap to keep: that of the start, until it has once been farther away than the thickness.
//! A point that starts in the surface itself begins at the side that the surface's normal points to.
//!
//! Physical moves such points out to the thickness at 1 m/s instead: there a start does not change where cloth comes to
//! rest.

use nalgebra::Vector3;

use crate::contact::collider::contacts::ColliderContacts;
use crate::contact::kept_gaps::{clear, least};
use crate::contact::material::{ContactMaterial, MIN_THICKNESS};
use crate::contact::placed_surface::PlacedSurface;
use crate::contact::system::{ContactPass, ContactSystem};
use crate::contact::time_step::ColliderStepArgs;
use crate::input::frame::{FrameInput, ResistanceModel};
use crate::math::Real;
use crate::model::Model;
use crate::state::State;

type Point = Vector3<f64>;

/// Gap in metres of a point that starts in a surface: above rounding error, large enough for a certificate.
const START_GAP: f64 = 2.0 * MIN_THICKNESS;

/// Looks at the start of a Classic run, once. Anchors are at the start positions; those of points in a surface move off it.
pub fn record_start_gaps<R: Real>(
    model: &Model<R>,
    state: &mut State<R>,
    contact: &mut ContactSystem<R>,
    frame: &FrameInput,
) {
    let is_first = !std::mem::replace(&mut contact.material_maps.kept_gaps.has_begun, true);
    if !is_first || frame.resistance != ResistanceModel::Classic {
        return;
    }
    for at in 0..contact.collider_contacts.len() {
        let ColliderContacts { cloth, collider, .. } = contact.collider_contacts[at];
        let Some(material) = contact.collider_materials_of(cloth)[collider] else { continue };
        if !model.cloths[cloth].boundary.triangles.is_empty() {
            let start = &frame.colliders[collider].start;
            let resting = &model.colliders[collider].positions;
            let place = |point: u32| *start.get(point as usize).unwrap_or(&resting[point as usize]);
            let triangles = model.colliders[collider].boundary.triangles.clone();
            let surface = PlacedSurface::new(triangles, place);
            keep_gaps_to(&surface, model, state, contact, (cloth, &material));
        }
    }
}

fn keep_gaps_to<R: Real>(
    surface: &PlacedSurface,
    model: &Model<R>,
    state: &mut State<R>,
    contact: &mut ContactSystem<R>,
    (cloth, material): (usize, &ContactMaterial<R>),
) {
    let rows = state.anchor.len();
    for row in model.cloths[cloth].points() {
        let place = Point::from(state.anchor[row as usize]);
        let Some(nearest) = surface.nearest(place, material.thickness) else { continue };
        let is_pinned = state.displacement[row as usize].0[3] <= R::ZERO;
        if nearest.distance < START_GAP && !is_pinned {
            state.anchor[row as usize] = (nearest.point + nearest.normal * START_GAP).into();
        }
        let gap = nearest.distance.max(START_GAP);
        if gap < material.thickness {
            contact.material_maps.kept_gaps.lower(row, rows, gap);
        }
    }
}

/// Returns points to their thickness that were farther away at the start of the time step. Needs the active contacts of
/// the step.
pub fn release_cleared_points<R: Real>(pass: &mut ContactPass<'_, R>, cloth: usize) {
    if pass.contact.material_maps.kept_gaps.is_empty() {
        return;
    }
    let mut kept = std::mem::take(&mut pass.contact.material_maps.kept_gaps);
    let points = pass.model.cloths[cloth].points();
    let own = points.start as usize..points.end as usize;
    kept.lowest[own.clone()].fill(clear());
    let ContactPass { state, contact, .. } = pass;
    let of_cloth = contact.lists_of(cloth);
    let ContactSystem { collider_states, collider_contacts, collider_materials, material_maps, .. } =
        &**contact;
    let mut range = R::ZERO;
    for list in &collider_contacts[of_cloth] {
        let Some(material) = collider_materials[[cloth, list.collider]] else { continue };
        let (h, time) = (pass.schedule.h, pass.span.times());
        let args =
            ColliderStepArgs { material, material_maps, at: list.collider, h, time, interval: list.interval };
        let step = args.of(state, &collider_states[list.collider]);
        let thickness = R::from_f64(material.thickness);
        range = if range < thickness { thickness } else { range };
        for contact in list.active.points.indices.iter().map(|&at| &list.point_face[at as usize]) {
            let lowest = &mut kept.lowest[contact.points[0] as usize];
            *lowest = least(*lowest, contact.gaps_above_plane(&step)[0]);
        }
    }
    for (gap, lowest) in kept.gaps[own.clone()].iter_mut().zip(&kept.lowest[own]) {
        if *lowest >= range {
            *gap = clear();
        }
    }
    if kept.gaps.iter().all(|&gap| gap >= clear()) {
        (kept.gaps, kept.lowest) = (Vec::new(), Vec::new());
    }
    pass.contact.material_maps.kept_gaps = kept;
}
