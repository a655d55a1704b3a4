//! Emitters: which particles are born in a frame, where, how fast, and for how long.
//!
//! A particle is born whenever the rate, summed over time, passes a whole number. The times of birth are therefore evenly
//! spaced within frames and across them. Everything random about a particle is a function of the seed and of its number
//! among those of its emitter, so the same seed gives the same bits, however the run is cut.
//!
//! | You want to know…                                | Read          |
//! |--------------------------------------------------|---------------|
//! | the times of birth, and the room for particles   | [`Emitter`]   |
//! | where and how fast, by type of emitter           | `shapes.rs`   |
//! | emission from the surface of a mesh              | `surface.rs`  |
//! | the texture of its rate                          | `rate_map.rs` |
//! | emission from a curve                            | `curve.rs`    |
//! | the start of a particle                          | `start.rs`    |
//! | lifespans                                        | `lifespan.rs` |
//! | random numbers                                   | `random.rs`   |

mod curve;
mod lifespan;
mod random;
mod rate_map;
mod shapes;
mod start;
mod surface;

use std::collections::VecDeque;

use nalgebra::Vector3;
use nucleus_core::{Birth, ClothId, InvalidInput};

use crate::animation::Affine;
use crate::attributes::{Choice, nucleus, particle, point_emitter};
use crate::graph::{EvalContext, Graph, NodeId};

use super::attachments::AttachmentState;
use super::compiler::Compiler;
use super::particle_expressions::add_invalid;
use super::program::EvaluationInterval;
use super::sources::{Emitter, EmitterState, EmittingMesh};

use curve::CurveShape;
pub(super) use lifespan::{Lifespan, dies};
use random::Random;
use shapes::{Launch, PointShape, VolumeShape};

/// `emitterType`.
const DIRECTIONAL: Choice = Choice(0);
const OMNI: Choice = Choice(1);
const SURFACE: Choice = Choice(2);
const CURVE: Choice = Choice(3);
/// `cycleEmission`: never.
const NO_CYCLE: Choice = Choice(0);

impl Compiler<'_> {
    /// The emitters of an object of particles, in the order of their connections.
    pub(super) fn emitters(&mut self, particles: NodeId, cloth: ClothId) -> Vec<Emitter> {
        let nodes = emitter_nodes(&self.scene.graph, particles);
        let mut emitters = Vec::new();
        for (place, node) in (0..).zip(nodes) {
            if self.broken.contains(&node) {
                continue;
            }
            let Some(mesh) = self.emitting_mesh(node) else { continue };
            emitters.push(Emitter { node, particles, cloth, mesh, place });
        }
        emitters
    }

    /// The mesh that an emitter emits from, if its type needs one; `None` after an error, which is reported.
    fn emitting_mesh(&mut self, emitter: NodeId) -> Option<Option<EmittingMesh>> {
        match self.start.get(emitter, &point_emitter::EMITTER_TYPE) {
            SURFACE => self.emitting_surface(emitter).map(Some),
            CURVE => self.emitting_curve(emitter).map(|()| None),
            _ => Some(None),
        }
    }

    /// The largest number of particles that an object can have at once: as its emitters and lifespans give it over the
    /// frames of the scene, and no more than `maxCount`.
    pub(super) fn room_for_particles(&self, node: NodeId, points: usize, emitters: &[Emitter]) -> u64 {
        let graph = &self.scene.graph;
        let time = self.scene.time;
        let (first, last) = (self.program.start, time.end.max(self.program.start));
        let lives = lifespan::longest(graph, node, [first, last]);
        let [mut window, mut length, mut born] = [0.0f64; 3];
        let mut frames: VecDeque<[f64; 2]> = VecDeque::new();
        for frame in first..last {
            let [from, to] = [frame, frame + 1].map(|frame| graph.at(frame as f64));
            let seconds = to.get(self.program.node, &nucleus::TIME_SCALE) / time.fps;
            let largest = |emitter: &Emitter| {
                let [a, b] = emitter.rates([&from, &to], seconds);
                a.max(b)
            };
            let count = emitters.iter().map(largest).sum::<f64>() * seconds;
            frames.push_back([count, seconds]);
            (window, length) = (window + count, length + seconds);
            // Those of the oldest frame may be alive until a life has passed since its end.
            while let Some(&[gone, of]) = frames.front()
                && length - of - seconds >= lives
            {
                frames.pop_front();
                (window, length) = (window - gone, length - of);
            }
            born = born.max(window);
        }
        // Rates may be keyed above their values at whole frames.
        let room = (born * 1.05).ceil() + emitters.len() as f64 + 1.0;
        let all = (points as u64).saturating_add(room as u64).checked_next_power_of_two().unwrap_or(u64::MAX);
        match self.start.get(node, &particle::MAX_COUNT) {
            limit if limit >= 0 => all.min((limit as u64).max(points as u64)).max(1),
            _ => all,
        }
    }
}

/// The emitters connected to an object of particles.
pub(super) fn emitter_nodes(graph: &Graph, particles: NodeId) -> Vec<NodeId> {
    let wires = graph.elements(particles, &particle::NEW_PARTICLES).into_iter();
    let is_emitter = |node: &NodeId| graph.node(*node).node_type().is_a(&point_emitter::POINT_EMITTER);
    wires.map(|(_, plug)| plug.node).filter(is_emitter).collect()
}

impl Emitter {
    /// Particles per second.
    fn rate(&self, moment: &EvalContext) -> f64 {
        let rate = moment.get(self.node, &point_emitter::RATE).max(0.0);
        let detail = moment.get(self.particles, &particle::LEVEL_OF_DETAIL).clamp(0.0, 1.0);
        let size = match &self.mesh {
            _ if !moment.get(self.node, &point_emitter::SCALE_RATE_BY_OBJECT_SIZE) => 1.0,
            Some(mesh) => mesh.area(moment),
            None if moment.get(self.node, &point_emitter::EMITTER_TYPE) == CURVE => {
                curve::length(&curve::curve_of(self.node, moment))
            }
            None => 1.0,
        };
        rate * detail * size
    }

    /// Particles per second at both ends of an interval of so many seconds.
    fn rates(&self, ends: [&EvalContext; 2], seconds: f64) -> [f64; 2] {
        let scaled = ends[1].get(self.node, &point_emitter::SCALE_RATE_BY_SPEED);
        let speed = match scaled {
            true => {
                let [from, to] = ends.map(|moment| moment.placement(self.node).offset);
                (to - from).norm() / seconds
            }
            false => 1.0,
        };
        ends.map(|moment| self.rate(moment) * speed)
    }

    /// Whether the random numbers begin anew in an interval.
    fn cycles(&self, interval: &EvaluationInterval<'_>) -> bool {
        let to = &interval.to;
        let frames = to.get(self.node, &point_emitter::CYCLE_INTERVAL).max(1) as f64;
        let cycle =
            |moment: &EvalContext| ((moment.frame() - interval.nucleus.start() as f64) / frames).floor();
        to.get(self.node, &point_emitter::CYCLE_EMISSION) != NO_CYCLE && cycle(&interval.from) != cycle(to)
    }

    /// Where new particles come from in an interval.
    fn launch(&self, interval: &EvaluationInterval<'_>) -> Launch {
        let (from, to) = (&interval.from, &interval.to);
        match to.get(self.node, &point_emitter::EMITTER_TYPE) {
            kind @ (DIRECTIONAL | OMNI) => Launch::Point(PointShape::new(self.node, kind == OMNI, to)),
            SURFACE => match self.mesh.as_ref() {
                Some(mesh) => Launch::Surface(mesh.patches(self.node, [from, to])),
                None => Launch::Nothing,
            },
            CURVE => Launch::Curve(CurveShape::new(self.node, [from, to])),
            _ => Launch::Volume(VolumeShape::new(self.node, to)),
        }
    }
}

impl EvaluationInterval<'_> {
    /// The particles that are born in the interval, in the order of their times; `seconds` is its length of solver time.
    pub(super) fn births(&self, kept: &mut AttachmentState, seconds: f64) -> Vec<Birth> {
        kept.emitters.resize(self.nucleus.emitters.len(), EmitterState::default());
        let mut births = Vec::new();
        for (emitter, at) in self.nucleus.emitters.iter().zip(0..) {
            let target = &self.nucleus.cloths[emitter.cloth.index()];
            if !self.plays(target) && !self.rests(target) {
                self.emit((emitter, at), kept, seconds, &mut births);
            }
        }
        self.recorded_births(&mut births);
        births.sort_by(|a, b| a.time.total_cmp(&b.time));
        births
    }

    /// Adds the births of an emitter, which is at this place among all.
    fn emit(
        &self,
        (emitter, at): (&Emitter, usize),
        kept: &mut AttachmentState,
        seconds: f64,
        births: &mut Vec<Birth>,
    ) {
        let state = &mut kept.emitters[at];
        let rates = emitter.rates([&self.from, &self.to], seconds).map(|rate| rate * seconds);
        if emitter.cycles(self) {
            state.emitted = 0;
        }
        let total = state.remainder + (rates[0] + rates[1]) / 2.0;
        // The sum of the shares of many intervals may miss a whole number by rounding.
        let count = (total + ROUNDING * total.abs().max(1.0)).floor();
        if count.is_nan() || count < 1.0 {
            state.remainder = if total.is_finite() { total } else { 0.0 };
            return;
        }
        let first = state.emitted;
        let remainder = std::mem::replace(&mut state.remainder, total - count);
        state.emitted = first.saturating_add(count as u64);
        let launch = emitter.launch(self);
        let flight = self.flight(emitter, seconds);
        let lifespan = Lifespan::new(emitter.particles, &self.to);
        // An object has no room for more.
        let has_room = self.to.get(emitter.particles, &particle::MAX_COUNT) != 0;
        let room = if has_room { self.nucleus.room_of(emitter.cloth) } else { 0 };
        let (earlier, mut numbers) = (births.len(), Vec::new());
        let made = (count as u64).min(room);
        kept.births_refused = kept.births_refused.saturating_add(count as u64 - made);
        for k in 0..made {
            let time = time_of(k as f64 + 1.0 - remainder, rates);
            let number = first.saturating_add(k);
            let random = Random::new([flight.seed, emitter.place, number]);
            let birth = flight.birth(emitter.cloth, time, &launch, random, &lifespan);
            // A rate map leaves out draws; the numbers of the others stay.
            numbers.extend(birth.as_ref().map(|_| number));
            births.extend(birth);
        }
        let invalid = self.create(emitter, &numbers, &mut births[earlier..]);
        add_invalid(&mut kept.invalid_results, invalid, InvalidInput::CreationExpression(emitter.cloth));
    }

    /// What all particles of an emitter share in the interval.
    fn flight(&self, emitter: &Emitter, seconds: f64) -> SharedFlight<'_> {
        let (from, to) = (self.from.placement(emitter.node), self.to.placement(emitter.node));
        SharedFlight {
            interval: self,
            placements: [from, to],
            seconds,
            inherit: self.to.get(emitter.particles, &particle::INHERIT_FACTOR),
            seed: self.to.get(emitter.particles, &particle::SEED) as u64,
            general_seed: self.to.get(emitter.particles, &particle::GENERAL_SEED) as u64,
        }
    }
}

/// A particle that is due this share of a particle after the end of an interval is born at its end.
const ROUNDING: f64 = 1e-9;

/// When the number of births reaches `births`, as a share of the interval; the rate goes linearly from the first to the
/// second, in particles per interval.
fn time_of(births: f64, [from, to]: [f64; 2]) -> f64 {
    let root = (from * from + 2.0 * (to - from) * births).max(0.0).sqrt();
    (2.0 * births / (from + root)).clamp(0.0, 1.0)
}

/// What all particles of an emitter share in an interval.
struct SharedFlight<'a> {
    interval: &'a EvaluationInterval<'a>,
    /// The placement of the emitter at both ends.
    placements: [Affine; 2],
    seconds: f64,
    inherit: f64,
    seed: u64,
    /// Seed of lifespans.
    general_seed: u64,
}

impl SharedFlight<'_> {
    fn birth(
        &self,
        cloth: ClothId,
        time: f64,
        launch: &Launch,
        mut random: Random,
        lifespan: &Lifespan,
    ) -> Option<Birth> {
        let units = self.interval.nucleus.units;
        let start = launch.draw(&self.placements, time, self.seconds, &mut random)?;
        let velocity: Vector3<f64> = start.velocity + start.carried * self.inherit;
        Some(Birth {
            cloth,
            time,
            position: units.point(start.position),
            velocity: units.point(velocity),
            lifespan: lifespan.draw(&mut random.with_seed(self.general_seed)),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn births_are_evenly_spaced_at_a_constant_rate_and_denser_as_it_grows() {
        let even: Vec<f64> = (1..=4).map(|k| time_of(f64::from(k), [4.0, 4.0])).collect();
        assert_eq!(even, [0.25, 0.5, 0.75, 1.0]);
        // From none to eight per interval: four births, the k-th at the square root of k / 4.
        let growing = (1..=4).map(|k| time_of(f64::from(k), [0.0, 8.0]));
        growing.zip(1..).for_each(|(time, k)| assert!((time * time - f64::from(k) / 4.0).abs() < 1e-12));
    }
}
