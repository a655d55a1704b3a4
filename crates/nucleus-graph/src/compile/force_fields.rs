//! The fields that objects exert, in SI units: force fields of surfaces and of points, and what objects do to the wind.

use nucleus_core::{FieldSide, ForceField, PointField, WindField};

use crate::attributes::{Choice, Key, RampPoint, n_base};
use crate::graph::NodeId;

use super::program::EvaluationInterval;

/// Interpolations of ramps.
const STEP: Choice = Choice(0);
const LINEAR: Choice = Choice(1);
/// m/s² for a `fieldMagnitude` of 1.
pub(super) const FIELD_ACCELERATION: f64 = 10.0;

impl EvaluationInterval<'_> {
    /// The force field of an object. Its magnitude of 1 is an acceleration of 10 m/s² at the surface, about that of
    /// gravity. `scale` is a factor on it.
    pub(super) fn force_field(&self, node: NodeId, scale: f64) -> Option<ForceField> {
        let side = match self.to.get(node, &n_base::FORCE_FIELD) {
            Choice(1) => FieldSide::AlongNormal,
            Choice(2) => FieldSide::Single,
            Choice(3) => FieldSide::Double,
            _ => return None,
        };
        let ramp = self.to.get(node, &n_base::FIELD_SCALE);
        Some(ForceField {
            side,
            magnitude: self.to.get(node, &n_base::FIELD_MAGNITUDE) * FIELD_ACCELERATION * scale,
            distance: self.nucleus.units.length(self.to.get(node, &n_base::FIELD_DISTANCE)),
            falloff: samples(&ramp),
        })
    }

    /// The force fields round the points of an object of this thickness in metres.
    pub(super) fn point_field(&self, node: NodeId, thickness: f64) -> Option<PointField> {
        let number = |key: &Key<f64>| self.to.get(node, key);
        let relative = match self.to.get(node, &n_base::POINT_FORCE_FIELD) {
            Choice(1) => true,
            Choice(2) => false,
            _ => return None,
        };
        let units = self.nucleus.units;
        let scale = if relative { thickness * units.per_metre() } else { 1.0 };
        Some(PointField {
            magnitude: number(&n_base::POINT_FIELD_MAGNITUDE) * FIELD_ACCELERATION * scale,
            self_attract: number(&n_base::SELF_ATTRACT) * FIELD_ACCELERATION * scale,
            radius: thickness,
            distance: units.length(number(&n_base::POINT_FIELD_DISTANCE) * scale),
            falloff: samples(&self.to.get(node, &n_base::POINT_FIELD_DROPOFF)),
        })
    }

    /// What an object does to the wind that others feel.
    pub(super) fn wind_field(&self, node: NodeId) -> WindField {
        let number = |key: &Key<f64>| self.to.get(node, key);
        WindField {
            shadow_distance: self.nucleus.units.length(number(&n_base::WIND_SHADOW_DISTANCE)),
            shadow_diffusion: number(&n_base::WIND_SHADOW_DIFFUSION),
            self_shadow: false,
            push_distance: self.nucleus.units.length(number(&n_base::AIR_PUSH_DISTANCE)),
            push_vorticity: number(&n_base::AIR_PUSH_VORTICITY),
        }
    }
}

/// A ramp at evenly spaced positions.
fn samples(ramp: &[RampPoint]) -> [f64; ForceField::SAMPLES] {
    std::array::from_fn(|k| ramp_at(ramp, k as f64 / (ForceField::SAMPLES - 1) as f64))
}

/// A ramp at a position: before its first point and behind its last it is constant.
pub(super) fn ramp_at(ramp: &[RampPoint], position: f64) -> f64 {
    let mut points: Vec<RampPoint> = ramp.to_vec();
    points.sort_by(|a, b| a.position.total_cmp(&b.position));
    let next = points.partition_point(|point| point.position <= position);
    let (Some(a), b) = (points.get(next.wrapping_sub(1)).or(points.first()), points.get(next)) else {
        return 0.0;
    };
    let Some(b) = b.filter(|b| b.position > a.position && position > a.position) else { return a.value };
    let share = (position - a.position) / (b.position - a.position);
    let share = match a.interpolation {
        STEP => 0.0,
        LINEAR => share,
        // Smooth and spline: no overshoot.
        _ => share * share * (3.0 - 2.0 * share),
    };
    a.value + (b.value - a.value) * share
}
