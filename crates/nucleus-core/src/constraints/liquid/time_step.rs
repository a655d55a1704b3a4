//! The time step of a liquid: one or more time steps of the nucleus, as long as the particles allow.
//!
//! Links need many short time steps; a liquid of large particles needs few. Its pressure is solved for to an error of
//! density. In a time step in which gravity moves a particle by much less than that error, the pressure would follow errors
//! instead of the weight of the liquid: a pool of 20 m that is at rest gained 35 J/kg in one frame at 48 evaluations.
//!
//! External forces act at the start of a liquid's time step, for all of it. The density is that at its end, and the
//! particles move there at constant velocity, but for contact.

use nalgebra::Vector3;

use crate::contact::material::ContactMaterial;
use crate::input::frame::{FrameInput, Liquid};
use crate::math::Real;
use crate::model::Model;
use crate::schedule::{Schedule, StepInterval};
use crate::state::State;

use super::kernel::REACH;

/// Distance that particles may move relative to each other, in rest distances: in any time step, and in one that is longer
/// than that of the nucleus. Particles move along straight lines in a time step, which costs angular momentum where the
/// liquid turns.
const MAX_ADVANCE: f64 = 0.4;
const MAX_LONG_ADVANCE: f64 = 0.1;
/// The same by external forces alone from rest.
const MAX_FALL: f64 = 0.004;
/// Longest time step by surface tension, in periods over 2π of capillary waves as short as the rest distance. Surface
/// tension is explicit: with twelve neighbours about a particle it is unstable from about 0.3 on.
const MAX_CAPILLARY_PHASE: f64 = 0.2;
/// Distance to other cloth within which a liquid keeps the time step of the nucleus, beyond the reach of its kernel.
const CLOTH_MARGIN: f64 = 1.0;
/// Times closer than this, in shares of the frame, are the same.
const SAME_TIME: f64 = 1e-9;

impl Liquid {
    /// The longest time step of the liquid at rest in seconds, where external forces accelerate it by so many m/s².
    pub fn longest_step_at_rest(&self, acceleration: f64) -> f64 {
        let fall = acceleration / (MAX_FALL * self.spacing);
        let capillary = self.surface_tension / self.spacing.powi(3);
        1.0 / fall.sqrt().max(capillary.sqrt() / MAX_CAPILLARY_PHASE)
    }
}

/// The time step that a liquid is in.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct LiquidInterval {
    /// Length in seconds of a time step that starts with that of the nucleus; 0 where one goes on.
    pub starts: f64,
    /// Its end, in shares of the frame.
    pub end: f64,
}

impl LiquidInterval {
    /// The interval in the next time step of the nucleus, `span`; `wanted` gives the length that it should have,
    /// in seconds. It ends with a substep.
    pub fn next<R: Real>(
        self,
        schedule: &Schedule<R>,
        duration: f64,
        span: StepInterval,
        wanted: impl FnOnce() -> f64,
    ) -> Self {
        if span.from + SAME_TIME < self.end {
            return Self { starts: 0.0, ..self };
        }
        let h = schedule.h;
        let left = ((span.end_of_substep - span.from) * duration / h).round().max(1.0);
        let most = (wanted() / h + 1e-6).floor().clamp(1.0, left);
        // Equal parts of the substep, not a short one at its end.
        let steps = (left / (left / most).ceil()).ceil();
        Self { starts: steps * h, end: span.from + steps * (span.to - span.from) }
    }
}

/// The number of parts that a time step of `h` seconds is split into, so that no particle passes another unseen.
pub fn splits<R: Real>(model: &Model<R>, state: &State<R>, frame: &FrameInput, h: f64) -> f64 {
    let liquids = frame.cloths.iter().enumerate();
    let longest =
        |(cloth, settings): (usize, Liquid)| longest(model, state, frame, (cloth, &settings), MAX_ADVANCE);
    let parts = liquids.filter_map(|(cloth, settings)| Some((cloth, settings.liquid?))).map(longest);
    parts.map(|longest| h / longest).fold(1.0, f64::max)
}

/// The number of time steps of a liquid in a frame, as it is at the start of the frame.
pub fn steps_in_frame<R: Real>(
    model: &Model<R>,
    state: &State<R>,
    frame: &FrameInput,
    schedule: &Schedule<R>,
    cloth: usize,
    settings: &Liquid,
) -> f64 {
    let steps = f64::from(schedule.substeps * schedule.steps);
    let splits = (schedule.h / longest(model, state, frame, (cloth, settings), MAX_ADVANCE)).ceil();
    if splits > 1.0 || is_beside_cloth(model, state, frame, cloth, settings) {
        return steps * splits.max(1.0);
    }
    let wanted = || wanted(model, state, frame, cloth, settings);
    let first = LiquidInterval::default().next(schedule, frame.duration, schedule.span(0), wanted);
    (frame.duration / first.starts).round()
}

/// The length in seconds that a time step of a liquid should have.
pub fn wanted<R: Real>(
    model: &Model<R>,
    state: &State<R>,
    frame: &FrameInput,
    cloth: usize,
    settings: &Liquid,
) -> f64 {
    longest(model, state, frame, (cloth, settings), MAX_LONG_ADVANCE)
}

/// The longest time step of a liquid in seconds, in which its particles move no farther than `advance` rest distances.
fn longest<R: Real>(
    model: &Model<R>,
    state: &State<R>,
    frame: &FrameInput,
    (cloth, settings): (usize, &Liquid),
    advance: f64,
) -> f64 {
    let rows = model.cloths[cloth].points();
    let rows = rows.start as usize..rows.end as usize;
    let velocities = state.velocity[rows.clone()].iter().map(|row| Vector3::from(row.xyz().map(R::to_f64)));
    let mean = velocities.clone().sum::<Vector3<f64>>() / rows.len().max(1) as f64;
    let fastest = velocities.map(|velocity| (velocity - mean).norm_squared()).fold(0.0, f64::max).sqrt();
    let fields = state.field.get(rows).unwrap_or_default().iter();
    let field = fields.map(|row| Vector3::from(row.xyz().map(R::to_f64)).norm_squared()).fold(0.0, f64::max);
    let force = frame.cloths[cloth].local_force.norm() / model.cloths[cloth].point_mass;
    let at_rest = settings.longest_step_at_rest(frame.gravity.norm() + field.sqrt() + force);
    at_rest.min(advance * settings.spacing / fastest)
}

/// Whether other cloth is near a liquid that may collide with it. Its links do not wait for the liquid's next time step.
pub fn is_beside_cloth<R: Real>(
    model: &Model<R>,
    state: &State<R>,
    frame: &FrameInput,
    cloth: usize,
    settings: &Liquid,
) -> bool {
    let bounds = |cloth: usize| {
        let places = model.cloths[cloth].points().map(|row| Vector3::from(state.position(row)));
        places.fold([Vector3::repeat(f64::MAX), Vector3::repeat(f64::MIN)], |[low, high], place| {
            [low.inf(&place), high.sup(&place)]
        })
    };
    let own = std::cell::OnceCell::new();
    let is_near = |other: usize| {
        let pair = [&frame.cloths[cloth], &frame.cloths[other]];
        let Some(material) = ContactMaterial::<R>::for_cloths(pair, [1.0; 2], frame.layer_range) else {
            return false;
        };
        let room = material.thickness + (f64::from(REACH) + CLOTH_MARGIN) * settings.spacing;
        let (own, other): (&[Vector3<f64>; 2], _) = (own.get_or_init(|| bounds(cloth)), bounds(other));
        (0..3).all(|axis| own[0][axis] - room <= other[1][axis] && other[0][axis] <= own[1][axis] + room)
    };
    (0..model.cloths.len()).any(|other| other != cloth && is_near(other))
}
