//! The time step of a liquid: one or more time steps of the nucleus, as long as the particles allow.
//!
//! Links need many short time steps; a liquid of large particles needs few. Its pressure is solved for to an error of
//! density. In a time step in which gravity moves a particle by much less than that error, the pressure would follow errors
//! instead of the weight of the liquid: a pool of 20 m that is at rest gained 35 J/kg in one frame at 96 evaluations.
//!
//! External forces act at the start of a liquid's time step, for all of it. The density is that at its end, and the
//! particles move there at constant velocity, but for contact.

use std::cell::OnceCell;

use nalgebra::Vector3;

use crate::contact::material::ContactMaterial;
use crate::input::frame::{ClothFrame, FrameInput, Liquid};
use crate::math::{Real, Row4};
use crate::model::Model;
use crate::schedule::{Schedule, StepInterval};
use crate::state::State;

use super::kernel::REACH;

/// Distance that particles may move relative to each other, in rest distances: in any time step, and in one that is longer
/// than that of the nucleus. Particles move along straight lines in a time step, which costs angular momentum where the
/// liquid turns.
const MAX_PARTICLE_ADVANCE: f64 = 0.4;
const MAX_LONG_ADVANCE: f64 = 0.1;
/// The same of cloth relative to the liquid, in a time step that is longer than that of the nucleus: beyond a rest distance it
/// would be on the far side of the particles that it is to push.
const MAX_CLOTH_ADVANCE: f64 = 0.4;
/// The same by external forces alone from rest.
const MAX_FALL: f64 = 0.004;
/// Radians that capillary waves turn in a time step, whose wave number is one per rest distance. Surface tension is
/// explicit: by an estimate with twelve neighbours about a particle it is unstable from about 0.3 on.
const MAX_CAPILLARY_PHASE: f64 = 0.2;
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
    let longest = |(cloth, settings): (usize, &ClothFrame)| {
        let settings = settings.liquid.as_ref()?;
        Some(LiquidMotion { model, state, frame, cloth, settings }.longest_step(MAX_PARTICLE_ADVANCE))
    };
    liquids.filter_map(longest).map(|longest| h / longest).fold(1.0, f64::max)
}

/// A liquid in motion, which is a cloth by its index.
#[derive(Clone, Copy)]
pub struct LiquidMotion<'a, R: Real> {
    /// The objects.
    pub model: &'a Model<R>,
    /// Their positions and velocities.
    pub state: &'a State<R>,
    /// The attributes.
    pub frame: &'a FrameInput,
    /// The cloth.
    pub cloth: usize,
    /// Its attributes as a liquid.
    pub settings: &'a Liquid,
}

impl<R: Real> LiquidMotion<'_, R> {
    /// The number of its time steps in a frame that begins now.
    pub fn steps_in_frame(&self, schedule: &Schedule<R>) -> f64 {
        let splits = (schedule.h / self.longest_step(MAX_PARTICLE_ADVANCE)).ceil();
        if splits > 1.0 {
            return f64::from(schedule.substeps * schedule.steps) * splits;
        }
        let wanted = || self.wanted_step();
        let first = LiquidInterval::default().next(schedule, self.frame.duration, schedule.span(0), wanted);
        (self.frame.duration / first.starts).round()
    }

    /// The length in seconds that its time step should have.
    pub fn wanted_step(&self) -> f64 {
        let longest = self.longest_step(MAX_LONG_ADVANCE).min(self.frame.duration);
        longest.min(MAX_CLOTH_ADVANCE * self.settings.spacing / self.speed_of_cloth_within(longest))
    }

    /// Its longest time step in seconds, in which its particles move no farther than `advance` rest distances.
    fn longest_step(&self, advance: f64) -> f64 {
        let Self { model, state, frame, cloth, settings } = *self;
        let rows = model.cloths[cloth].points();
        let rows = rows.start as usize..rows.end as usize;
        let fastest = self.largest_speed(cloth, self.mean_velocity());
        let vector = |row: &Row4<R>| Vector3::from(row.xyz().map(R::to_f64));
        let fields = state.field.get(rows).unwrap_or_default().iter().map(vector);
        let field = fields.map(|field| field.norm_squared()).fold(0.0, f64::max).sqrt();
        let force = frame.cloths[cloth].local_force.norm() / model.cloths[cloth].point_mass;
        let at_rest = settings.longest_step_at_rest(frame.gravity.norm() + field + force);
        at_rest.min(advance * settings.spacing / fastest)
    }

    /// Largest speed of other cloth relative to the liquid, of cloth that it may touch within so many seconds.
    fn speed_of_cloth_within(&self, seconds: f64) -> f64 {
        let Self { model, frame, cloth, settings, .. } = *self;
        let own = OnceCell::new();
        let speed_if_near = |other: usize| {
            let pair = [&frame.cloths[cloth], &frame.cloths[other]];
            let material = ContactMaterial::<R>::for_cloths(pair, [1.0; 2], frame.layer_range)?;
            let ([low, high], mean) = *own.get_or_init(|| (self.bounds(cloth), self.mean_velocity()));
            let speed = self.largest_speed(other, mean);
            let margin = material.thickness + f64::from(REACH) * settings.spacing + speed * seconds;
            let [from, to] = self.bounds(other);
            (0..3)
                .all(|axis| low[axis] - margin <= to[axis] && from[axis] <= high[axis] + margin)
                .then_some(speed)
        };
        (0..model.cloths.len()).filter(|other| *other != cloth).filter_map(speed_if_near).fold(0.0, f64::max)
    }

    /// The mean velocity of the liquid.
    fn mean_velocity(&self) -> Vector3<f64> {
        let rows = self.model.cloths[self.cloth].points();
        let count = rows.len().max(1) as f64;
        rows.map(|row| self.velocity(row)).sum::<Vector3<f64>>() / count
    }

    /// The largest speed of a cloth, by its index, relative to a velocity.
    fn largest_speed(&self, cloth: usize, mean: Vector3<f64>) -> f64 {
        let squares = self.model.cloths[cloth].points().map(|row| (self.velocity(row) - mean).norm_squared());
        squares.fold(0.0, f64::max).sqrt()
    }

    fn velocity(&self, row: u32) -> Vector3<f64> {
        self.state.velocity[row as usize].xyz().map(R::to_f64).into()
    }

    /// The bounding box of a cloth, by its index.
    fn bounds(&self, cloth: usize) -> [Vector3<f64>; 2] {
        let places = self.model.cloths[cloth].points().map(|row| Vector3::from(self.state.position(row)));
        let none = [Vector3::repeat(f64::MAX), Vector3::repeat(f64::MIN)];
        places.fold(none, |[low, high], place| [low.inf(&place), high.sup(&place)])
    }
}
