//! Adaptive substepping: splits time steps while a moving collider is near a cloth.
//!
//! A collider that moves farther in a time step than the cloth's faces are wide would jump over them. A collider
//! that takes cloth along faster than its links can follow would stretch it without limit. A liquid whose particles pass
//! each other in a time step would not see them.

use nalgebra::Vector3;

use crate::constraints::liquid;
use crate::contact::collider::ColliderState;
use crate::contact::system::ContactSystem;
use crate::input::frame::FrameInput;
use crate::math::Real;
use crate::model::{ClothModel, Model};
use crate::schedule::{Schedule, StepInterval};
use crate::state::State;

/// Distance that a collider may move in a time step, in edge lengths of the cloth.
const MAX_ADVANCE: f64 = 1.0;
/// Distance in a time step below which a collider never splits it, in edge lengths.
const MIN_ADVANCE: f64 = 1.0 / 64.0;
/// Strain of a link above which the step is split. A sweep makes a link no stiffer than m / 2h², however stiff
/// the cloth is: the load that it holds grows with the square of the number of splits.
const STRAIN_LIMIT: f64 = 0.25;
/// Splits of a time step, at most: for a fast collider, and for strain.
const MAX_SPLITS: f64 = 256.0;
const MAX_STRAIN_SPLITS: f64 = 8.0;

/// The number of parts a time step is split into.
pub fn splits<R: Real>(
    model: &Model<R>,
    state: &State<R>,
    contact: &ContactSystem<R>,
    frame: &FrameInput,
    schedule: &Schedule<R>,
    span: StepInterval,
    max_speed: &[f64],
) -> u32 {
    let mut splits = 1.0f64;
    for (at, collider) in contact.collider_states.iter().enumerate() {
        let advance = collider.max_travel * (span.to - span.from);
        if advance == 0.0 {
            continue;
        }
        for (index, cloth) in model.cloths.iter().enumerate() {
            let Some(material) = &contact.collider_materials_of(index)[at] else { continue };
            let edges = advance / cloth.edge_length;
            let room = material.thickness + max_speed[index] * schedule.h;
            // A cloth without edges is points, which nothing can jump over.
            if edges.is_finite() && edges > MIN_ADVANCE && is_near(cloth, state, collider, span, room) {
                let strain_splits = (largest_strain(cloth, state, frame.cloths[index].rest_length_scale)
                    / STRAIN_LIMIT)
                    .min(MAX_STRAIN_SPLITS);
                splits = splits.max(edges / MAX_ADVANCE).max(strain_splits);
            }
        }
    }
    splits.max(liquid::splits(model, state, frame, schedule.h)).ceil().min(MAX_SPLITS) as u32
}

/// The largest strain of any link of a cloth.
fn largest_strain<R: Real>(cloth: &ClothModel<R>, state: &State<R>, rest_scale: f64) -> f64 {
    let rest_scale = R::from_f64(rest_scale);
    let groups = cloth.stretch.groups().iter();
    let strains = groups.flat_map(|group| group.strain(&state.displacement, rest_scale));
    strains.fold(R::ZERO, |most, strain| if strain > most { strain } else { most }).to_f64()
}

/// Whether a collider comes near a cloth in a time step, by their bounding boxes.
fn is_near<R: Real>(
    cloth: &ClothModel<R>,
    state: &State<R>,
    collider: &ColliderState,
    span: StepInterval,
    room: f64,
) -> bool {
    let place = |row: u32| Vector3::from(state.position(row));
    let points = cloth.points();
    let first = place(points.start);
    let cloth = points.fold([first, first], |[low, high], row| [low.inf(&place(row)), high.sup(&place(row))]);
    let [from, to] = [span.from, span.to].map(|time| collider.bounds(time));
    let theirs = [from[0].inf(&to[0]), from[1].sup(&to[1])];
    (0..3).all(|k| cloth[0][k] - room <= theirs[1][k] && theirs[0][k] <= cloth[1][k] + room)
}
