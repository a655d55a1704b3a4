//! The fields that objects exert, in SI units: force fields of surfaces and of points, and what objects do to the wind.

use nucleus_core::{FieldSide, ForceField, PointField, WindField};

use crate::attributes::{Choice, Key, Ramp, n_base};
use crate::graph::NodeId;

use super::program::EvaluationInterval;

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
            falloff: Ramp::new(&ramp).samples(),
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
        // In metres, an acceleration does not depend on the unit of the scene. A distance in scene units is converted.
        let [strength, range] = if relative { [thickness, thickness * units.per_metre()] } else { [1.0; 2] };
        Some(PointField {
            magnitude: number(&n_base::POINT_FIELD_MAGNITUDE) * FIELD_ACCELERATION * strength,
            self_attract: number(&n_base::SELF_ATTRACT) * FIELD_ACCELERATION * strength,
            radius: thickness,
            distance: units.length(number(&n_base::POINT_FIELD_DISTANCE) * range),
            falloff: Ramp::new(&self.to.get(node, &n_base::POINT_FIELD_DROPOFF)).samples(),
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
