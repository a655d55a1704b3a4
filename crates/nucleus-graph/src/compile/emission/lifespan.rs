//! How long particles live (`lifespanMode`).

use crate::attributes::particle::{self, CONSTANT_LIFESPAN, LIFESPAN_PP_ONLY, LIVE_FOREVER, RANDOM_RANGE};
use crate::graph::{EvalContext, Graph, NodeId};

use super::random::Random;

/// The lifespans of particles that are born in an interval.
#[derive(Debug, Clone, Copy)]
pub(in crate::compile) struct Lifespan {
    /// In seconds; infinite for never.
    middle: f64,
    /// Width of the range about it, in seconds.
    range: f64,
    /// Whether `lifespanPP` holds that of each initial particle.
    is_listed: bool,
}

impl Lifespan {
    /// Those of an object at a time.
    pub(in crate::compile) fn new(particles: NodeId, moment: &EvalContext) -> Self {
        let middle = moment.get(particles, &particle::LIFESPAN);
        match moment.get(particles, &particle::LIFESPAN_MODE) {
            CONSTANT_LIFESPAN => Self { middle, range: 0.0, is_listed: false },
            RANDOM_RANGE => {
                Self { middle, range: moment.get(particles, &particle::LIFESPAN_RANDOM), is_listed: false }
            }
            mode => Self { middle: f64::INFINITY, range: 0.0, is_listed: mode == LIFESPAN_PP_ONLY },
        }
    }

    /// Whether `lifespanPP` holds that of each initial particle.
    pub(in crate::compile) fn is_listed(&self) -> bool {
        self.is_listed
    }

    /// The mean in seconds, and the width of the range about it.
    pub(in crate::compile) fn range(&self) -> [f64; 2] {
        [self.middle, self.range]
    }

    /// The lifespan of one particle in seconds, at least 0.
    pub(super) fn draw(&self, random: &mut Random) -> f64 {
        let away = random.next() - 0.5;
        let lifespan = self.middle + self.range * away;
        if lifespan > 0.0 { lifespan } else { 0.0 }
    }

    /// The lifespans of the particles at the start, in seconds.
    pub(in crate::compile) fn of_first(&self, points: usize, seed: u64) -> Vec<f64> {
        if self.middle == f64::INFINITY {
            return Vec::new();
        }
        (0..points as u64).map(|point| self.draw(&mut Random::new([seed, u64::MAX, point]))).collect()
    }
}

/// Whether particles of an object can ever die.
pub(in crate::compile) fn dies(graph: &Graph, particles: NodeId) -> bool {
    graph.changes(particles, &particle::LIFESPAN_MODE)
        || graph.at(0.0).get(particles, &particle::LIFESPAN_MODE) != LIVE_FOREVER
}

/// The longest lifespan over some frames, in seconds.
pub(super) fn longest(graph: &Graph, particles: NodeId, [first, last]: [i64; 2]) -> f64 {
    let at = |frame: i64| {
        let Lifespan { middle, range, .. } = Lifespan::new(particles, &graph.at(frame as f64));
        middle + range.abs() / 2.0
    };
    if graph.changes(particles, &particle::LIFESPAN)
        || graph.changes(particles, &particle::LIFESPAN_MODE)
        || graph.changes(particles, &particle::LIFESPAN_RANDOM)
    {
        return (first..=last).map(at).fold(0.0, f64::max);
    }
    at(first).max(0.0)
}
