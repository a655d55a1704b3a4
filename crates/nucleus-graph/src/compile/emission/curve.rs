//! Emission from a curve: a polyline in the space of the emitter, in scene units.

use nalgebra::Vector3;

use crate::animation::sin_cos_degrees;
use crate::attributes::point_emitter;
use crate::compile::compiler::Compiler;
use crate::graph::{EvalContext, NodeId};

use super::random::Random;
use super::start::{Speed, Start, turned_to};

type Vec3 = Vector3<f64>;

impl Compiler<'_> {
    /// Checks the curve of an emitter; `None` after an error, which is reported.
    pub(super) fn emitting_curve(&mut self, emitter: NodeId) -> Option<()> {
        if length(&curve_of(emitter, &self.start)) > 0.0 {
            return Some(());
        }
        let name = self.scene.graph.node(emitter).name();
        let message = format!("`{name}` emits from a curve, and its `curvePoints` have no length");
        let place = self.scene.source.place(&format!("{name}.emitterType"));
        let error = self.findings.error(&place, message);
        error.help("give it two points or more: `curvePoints: [(0, 0, 0), (0, 1, 0)]`");
        None
    }
}

/// The points of the curve of an emitter in world space.
pub(super) fn curve_of(emitter: NodeId, moment: &EvalContext) -> Vec<Vec3> {
    let placement = moment.placement(emitter);
    let points = moment.get(emitter, &point_emitter::CURVE_POINTS);
    points.into_iter().map(|point| placement.point(point.into())).collect()
}

/// The length of a curve in scene units.
pub(super) fn length(curve: &[Vec3]) -> f64 {
    curve.windows(2).map(|pair| (pair[1] - pair[0]).norm()).sum()
}

/// A curve in an interval.
pub(super) struct CurveShape {
    /// World positions at both ends of the interval.
    ends: [Vec<Vec3>; 2],
    /// The length up to the end of each segment.
    sums: Vec<f64>,
    normal: f64,
    tangent: f64,
    distance: [f64; 2],
    speed: Speed,
}

impl CurveShape {
    pub(super) fn new(emitter: NodeId, [from, to]: [&EvalContext; 2]) -> Self {
        let ends = [curve_of(emitter, from), curve_of(emitter, to)];
        let sums = (2..=ends[1].len()).map(|points| length(&ends[1][..points])).collect();
        let get = |key| to.get(emitter, key);
        let least = get(&point_emitter::MIN_DISTANCE).max(0.0);
        Self {
            ends,
            sums,
            normal: get(&point_emitter::NORMAL_SPEED),
            tangent: get(&point_emitter::TANGENT_SPEED),
            distance: [least, get(&point_emitter::MAX_DISTANCE).max(least)],
            speed: Speed::new(emitter, to),
        }
    }

    /// The start of a particle, evenly spread over the length; `None` where there is none.
    pub(super) fn draw(&self, time: f64, seconds: f64, random: &mut Random) -> Option<Start> {
        let all = *self.sums.last().filter(|sum| **sum > 0.0)?;
        let drawn = random.next() * all;
        let segment = self.sums.partition_point(|sum| *sum <= drawn).min(self.sums.len() - 1);
        let share = random.next();
        let at = |points: &[Vec3]| points[segment] + (points[segment + 1] - points[segment]) * share;
        let [from, to] = [at(&self.ends[0]), at(&self.ends[1])];
        let [before, along] = self.ends.each_ref().map(|points| points[segment + 1] - points[segment]);
        let along = (before + (along - before) * time).try_normalize(0.0)?;
        let (sin, cos) = sin_cos_degrees(random.between(0.0, 360.0));
        let across = turned_to(along, Vec3::new(cos, sin, 0.0));
        let velocity = (across * self.normal + along * self.tangent) * self.speed.draw(random);
        let distance = random.between(self.distance[0], self.distance[1]);
        Some(Start {
            position: from + (to - from) * time + across * distance,
            velocity,
            carried: (to - from) / seconds,
        })
    }
}
