//! Forces along links, once per substep, and damping, on velocities; and drag, in each time step.
//!
//! All act on both ends of a link, equal and opposite, so they keep momentum. `force` is a relative acceleration of the
//! two ends, which does not depend on their masses. `damp` takes from the relative velocity along the link, `motionDrag`
//! from all of it: also from what forces have added in the time step, so that a drag of 1 locks.

use nalgebra::Vector3;

use crate::constraints::damp::DampTimes;
use crate::contact::collider::ColliderState;
use crate::input::frame::{COUNT_PERIOD, FrameInput};
use crate::input::links::Link;
use crate::math::Real;
use crate::model::Model;
use crate::schedule::{PassTime, Schedule};
use crate::state::State;

use super::ends::{Ends, Prescribed, vector};
use super::lists::Links;

/// Applies forces along links for a substep that begins at a time.
pub fn apply_link_forces<R: Real>(
    links: &Links<R>,
    (model, colliders): (&Model<R>, &[ColliderState]),
    state: &mut State<R>,
    frame: &FrameInput,
    PassTime { at: time, length }: PassTime,
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
            let masses = ends.inverse_masses(&state.displacement);
            ends.apply(&masses, &mut state.velocity, along * -change);
        }
    }
}

/// Damps the links that are due at the end of a time step of the schedule, counted from the start of the frame.
pub fn damp_links<R: Real>(
    links: &Links<R>,
    (model, colliders): (&Model<R>, &[ColliderState]),
    state: &mut State<R>,
    frame: &FrameInput,
    (schedule, step): (&Schedule<R>, u32),
) {
    let time = schedule.span(step).to;
    for (own, settings) in links.constraints.iter().zip(&frame.constraints) {
        let times = DampTimes::new(settings.damp, schedule, frame.resistance);
        let share = times.share(settings.damp);
        if share <= 0.0 || !times.is_due(schedule, step) {
            continue;
        }
        let prescribed = Prescribed { colliders, frame: settings };
        for link in own.joining() {
            let ends = Ends::new(link, &model.cloths);
            let mobility = ends.mobility(&state.displacement);
            if mobility <= 0.0 {
                continue;
            }
            let relative = relative_velocity(link, &ends, state, prescribed, frame.duration);
            let d = vector(link, &ends, state, prescribed, time);
            let along = d * (relative.dot(&d) / d.norm_squared().max(1e-30));
            let masses = ends.inverse_masses(&state.displacement);
            ends.apply(&masses, &mut state.velocity, along * -(share / mobility));
        }
    }
}

/// Slows the ends of links relative to each other, once a time step of `h` seconds has moved the points.
pub fn drag_links<R: Real>(
    links: &Links<R>,
    (model, colliders): (&Model<R>, &[ColliderState]),
    state: &mut State<R>,
    frame: &FrameInput,
    h: f64,
) {
    for (own, settings) in links.constraints.iter().zip(&frame.constraints) {
        let drag = settings.motion_drag.clamp(0.0, 1.0);
        if drag <= 0.0 {
            continue;
        }
        let taken = drag * h / (drag * h + (1.0 - drag) * COUNT_PERIOD);
        let prescribed = Prescribed { colliders, frame: settings };
        for link in own.joining() {
            let ends = Ends::new(link, &model.cloths);
            let mobility = ends.mobility(&state.displacement);
            if mobility <= 0.0 {
                continue;
            }
            let relative = relative_velocity(link, &ends, state, prescribed, frame.duration);
            let change = relative * -(taken / mobility);
            let masses = ends.inverse_masses(&state.displacement);
            ends.apply(&masses, &mut state.velocity, change);
            for column in [&mut state.displacement, &mut state.predicted] {
                ends.apply(&masses, column, change * h);
            }
        }
    }
}

/// The velocity of a link's first end relative to the second, in m/s.
fn relative_velocity<R: Real>(
    link: &Link,
    ends: &Ends,
    state: &State<R>,
    prescribed: Prescribed<'_>,
    duration: f64,
) -> Vector3<f64> {
    let [before, after] = [0.0, 1.0].map(|time| prescribed.vector(link, time));
    let own = ends.sum(|row| Vector3::from(state.velocity[row as usize].xyz().map(R::to_f64)));
    own + (after - before) / duration
}
