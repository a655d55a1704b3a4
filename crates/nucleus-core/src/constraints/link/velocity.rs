//! Forces, damping and drag along links, once per substep, on velocities.
//!
//! All act on both ends of a link, equal and opposite, so they keep momentum. `force` is a relative acceleration of the
//! two ends, which does not depend on their masses. `damp` takes from the relative velocity along the link, `motionDrag`
//! from all of it.

use nalgebra::Vector3;

use crate::contact::collider::ColliderState;
use crate::input::frame::{COUNT_PERIOD, FrameInput};
use crate::input::links::ConstraintFrame;
use crate::math::Real;
use crate::model::Model;
use crate::state::State;

use super::ends::{Ends, Prescribed, vector};
use super::lists::Links;

/// Share of the relative velocity that is taken in a substep of `length` seconds.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Taken {
    along: f64,
    all: f64,
}

impl Taken {
    fn new(settings: &ConstraintFrame, length: f64) -> Self {
        let rate = settings.damp.max(0.0) * length / COUNT_PERIOD;
        let drag = settings.motion_drag.clamp(0.0, 1.0);
        let all = drag * length / (drag * length + (1.0 - drag) * COUNT_PERIOD);
        // `all` has acted along the link too.
        Self { along: rate / (1.0 + rate) * (1.0 - all), all }
    }
}

/// Applies forces along links for a substep of `length` seconds that begins at `time` as a share of the frame.
pub fn apply_link_forces<R: Real>(
    links: &Links<R>,
    (model, colliders): (&Model<R>, &[ColliderState]),
    state: &mut State<R>,
    frame: &FrameInput,
    [time, length]: [f64; 2],
) {
    for (own, settings) in links.constraints.iter().zip(&frame.constraints) {
        let Some(force) = settings.force else { continue };
        let prescribed = Prescribed { colliders, frame: settings };
        for link in own.joining() {
            let ends = Ends::new(link, &model.cloths);
            let mobility = ends.mobility(&state.displacement);
            let d = vector(link, &ends, state, prescribed, time);
            let Some(along) = d.try_normalize(0.0).filter(|_| mobility > 0.0) else { continue };
            let change = force.acceleration * force.falloff.at(d.norm()) * length / mobility;
            let displacement = &state.displacement;
            let mass = |row: u32| displacement[row as usize].0[3].to_f64();
            ends.apply(mass, &mut state.velocity, along * -change);
        }
    }
}

/// Damps links at the end of a substep of `length` seconds, at `time` as a share of the frame.
pub fn damp_links<R: Real>(
    links: &Links<R>,
    (model, colliders): (&Model<R>, &[ColliderState]),
    state: &mut State<R>,
    frame: &FrameInput,
    [time, length]: [f64; 2],
) {
    for (own, settings) in links.constraints.iter().zip(&frame.constraints) {
        let taken = Taken::new(settings, length);
        if taken.along <= 0.0 && taken.all <= 0.0 {
            continue;
        }
        let prescribed = Prescribed { colliders, frame: settings };
        for link in own.joining() {
            let ends = Ends::new(link, &model.cloths);
            let mobility = ends.mobility(&state.displacement);
            if mobility <= 0.0 {
                continue;
            }
            let [before, after] = [0.0, 1.0].map(|time| prescribed.vector(link, time));
            let own_velocity =
                ends.sum(|row| Vector3::from(state.velocity[row as usize].xyz().map(R::to_f64)));
            let relative = own_velocity + (after - before) / frame.duration;
            let d = vector(link, &ends, state, prescribed, time);
            let along = d * (taken.along * relative.dot(&d) / d.norm_squared().max(1e-30));
            let change = (relative * taken.all + along) / mobility;
            let displacement = &state.displacement;
            let mass = |row: u32| displacement[row as usize].0[3].to_f64();
            ends.apply(mass, &mut state.velocity, -change);
        }
    }
}
