//! Adaptive substepping: splits time steps while a moving collider is near a cloth, or fast cloth near a collider.
//!
//! A collider that moves farther in a time step than the cloth's faces are wide would jump over them. A collider
//! that takes cloth along faster than its links can follow would stretch it without limit. A liquid whose particles pass
//! each other in a time step would not see them.
//!
//! A Classic substep is long: a sheet that falls 3 cm onto a ball moves three edge lengths in 1/96 s. Its points stop in the
//! contact passes at the end of the step, those beside it do not, and the links between them, then several times too long,
//! throw points about. Split, each part of the step stretches a link by about its length at most.

use std::cell::OnceCell;

use nalgebra::Vector3;

use crate::constraints::liquid::time_step::splits as liquid_splits;
use crate::contact::collider::ColliderState;
use crate::contact::system::ContactSystem;
use crate::input::frame::{FrameInput, ResistanceModel};
use crate::math::Real;
use crate::model::{ClothModel, Model};
use crate::schedule::{Schedule, StepInterval};
use crate::state::State;

/// Distance that a collider may move in a time step, in edge lengths of the cloth; in Classic, relative to the cloth.
const MAX_COLLIDER_ADVANCE: f64 = 1.0;
/// Distance in a time step below which a collider never splits it, in edge lengths.
const MIN_COLLIDER_ADVANCE: f64 = 1.0 / 64.0;
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
    let is_classic = frame.resistance == ResistanceModel::Classic;
    for (index, cloth) in model.cloths.iter().enumerate() {
        let own = max_speed[index] * schedule.h;
        let (bounds, strain) = (OnceCell::new(), OnceCell::new());
        let rest_scale = frame.cloths[index].rest_length_scale;
        for (collider, material) in contact.collider_states.iter().zip(contact.collider_materials_of(index)) {
            let Some(material) = material else { continue };
            let travel = collider.max_travel * (span.to - span.from);
            let edges = travel / cloth.edge_length;
            let advance = if is_classic { (travel + own) / cloth.edge_length } else { edges };
            let (is_pushed, is_fast) = (edges > MIN_COLLIDER_ADVANCE, advance > MAX_COLLIDER_ADVANCE);
            // A cloth without edges is points, which nothing can jump over.
            let may_split = advance.is_finite() && (is_pushed || is_fast);
            let bounds = || bounds.get_or_init(|| bounds_of(cloth, state));
            if !may_split || !is_near(bounds(), collider, span, material.thickness + own) {
                continue;
            }
            splits = splits.max(advance / MAX_COLLIDER_ADVANCE);
            if is_pushed {
                let strain = strain.get_or_init(|| largest_strain(cloth, state, rest_scale));
                splits = splits.max((strain / STRAIN_LIMIT).min(MAX_STRAIN_SPLITS));
            }
        }
    }
    splits.max(liquid_splits(model, state, frame, schedule.h)).ceil().min(MAX_SPLITS) as u32
}

/// The largest strain of any link of a cloth.
fn largest_strain<R: Real>(cloth: &ClothModel<R>, state: &State<R>, rest_scale: f64) -> f64 {
    let rest_scale = R::from_f64(rest_scale);
    let groups = cloth.stretch.groups().iter();
    let strains = groups.flat_map(|group| group.strain(&state.displacement, rest_scale));
    strains.fold(R::ZERO, |most, strain| if strain > most { strain } else { most }).to_f64()
}

/// The bounding box of a cloth in metres.
fn bounds_of<R: Real>(cloth: &ClothModel<R>, state: &State<R>) -> [Vector3<f64>; 2] {
    let place = |row: u32| Vector3::from(state.position(row));
    let points = cloth.points();
    let first = place(points.start);
    points.fold([first, first], |[low, high], row| [low.inf(&place(row)), high.sup(&place(row))])
}

/// Whether a collider comes within so many metres of a cloth in a time step, by their bounding boxes.
fn is_near(cloth: &[Vector3<f64>; 2], collider: &ColliderState, span: StepInterval, within: f64) -> bool {
    let [from, to] = [span.from, span.to].map(|time| collider.bounds(time));
    let theirs = [from[0].inf(&to[0]), from[1].sup(&to[1])];
    (0..3).all(|k| cloth[0][k] - within <= theirs[1][k] && theirs[0][k] <= cloth[1][k] + within)
}
