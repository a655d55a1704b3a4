//! The ten kinds of constraints: the values that Maya writes when it creates each, as defaults that a scene overrides.

use std::borrow::Cow;

use nucleus_core::Falloff;

use crate::attributes::{
    Attribute, Choice, FromValue, Key, Kind, NodeType, Ramp, RampPoint, Value, dynamic_constraint as con,
};
use crate::graph::{EvalContext, NodeId};

/// Kinds by their number in `constraintType`.
pub(super) const TRANSFORM: i32 = 0;
const POINT_TO_POINT: i32 = 1;
pub(super) const POINT_TO_SURFACE: i32 = 2;
pub(super) const SLIDE_ON_SURFACE: i32 = 3;
pub(super) const WELD_BORDERS: i32 = 4;
pub(super) const FORCE: i32 = 5;
pub(super) const MATCH: i32 = 6;
pub(super) const TEARABLE: i32 = 7;
pub(super) const DISABLE_COLLISION: i32 = 8;
pub(super) const EXCLUDE_PAIRS: i32 = 9;

/// Whether a kind is there to exclude collisions.
pub(super) fn excludes(kind: i32) -> bool {
    matches!(kind, DISABLE_COLLISION | EXCLUDE_PAIRS)
}

/// Whether links of a kind have lengths of their own.
pub(crate) fn has_lengths(kind: i32) -> bool {
    matches!(kind, POINT_TO_POINT | POINT_TO_SURFACE | MATCH)
}

/// `constraintRelation: objectToConstraint`.
pub(super) const TO_SPACE: i32 = 0;
/// `constraintMethod: weld`.
pub(super) const WELD: i32 = 0;
/// `connectionMethod: within max distance`.
pub(super) const WITHIN_MAX_DISTANCE: i32 = 1;
/// `connectionUpdate: per frame`.
pub(crate) const PER_FRAME: i32 = 1;

/// The values that each kind writes, where they differ from the defaults of the node. `type: transform` means pins
/// unless one of [`SOFT`] is given.
const WRITTEN: &[(i32, &str, f64)] = &[
    (TRANSFORM, "constraintRelation", 0.0),
    (1, "componentRelation", 1.0),
    (1, "connectionMethod", 2.0),
    (SLIDE_ON_SURFACE, "connectionUpdate", 1.0),
    (SLIDE_ON_SURFACE, "friction", 0.1),
    (SLIDE_ON_SURFACE, "strength", 0.02),
    (SLIDE_ON_SURFACE, "tangentStrength", 0.2),
    (SLIDE_ON_SURFACE, "localCollide", 1.0),
    (WELD_BORDERS, "componentRelation", 1.0),
    (WELD_BORDERS, "constraintMethod", 0.0),
    (WELD_BORDERS, "connectionMethod", 1.0),
    (WELD_BORDERS, "maxDistance", 0.05),
    (WELD_BORDERS, "connectWithinComponent", 1.0),
    (FORCE, "constraintRelation", 0.0),
    (FORCE, "strength", 0.0),
    (FORCE, "tangentStrength", 0.0),
    (FORCE, "force", 1.0),
    (FORCE, "dropoffDistance", 1.0),
    (MATCH, "strength", 0.8),
    (MATCH, "tangentStrength", 0.2),
    (MATCH, "restLengthScale", 0.0),
    (TEARABLE, "componentRelation", 1.0),
    (TEARABLE, "constraintMethod", 0.0),
    (TEARABLE, "connectionMethod", 1.0),
    (TEARABLE, "connectWithinComponent", 1.0),
    (TEARABLE, "glueStrength", 0.1),
    (TEARABLE, "maxDistance", 0.01),
    (DISABLE_COLLISION, "constraintRelation", 0.0),
    (DISABLE_COLLISION, "strength", 0.0),
    (DISABLE_COLLISION, "tangentStrength", 0.0),
    (DISABLE_COLLISION, "excludeCollisions", 1.0),
    (EXCLUDE_PAIRS, "componentRelation", 1.0),
    (EXCLUDE_PAIRS, "connectionMethod", 2.0),
    (EXCLUDE_PAIRS, "strength", 0.0),
    (EXCLUDE_PAIRS, "tangentStrength", 0.0),
    (EXCLUDE_PAIRS, "excludeCollisions", 1.0),
];

/// The defaults of an attribute of a constraint in the types that have their own, with the names of the types; none of other
/// nodes.
pub fn defaults_by_type(node_type: &'static NodeType, attribute: &Attribute) -> Vec<(String, Value)> {
    if !node_type.is_a(&con::DYNAMIC_CONSTRAINT) {
        return Vec::new();
    }
    let types = con::CONSTRAINT_TYPE.row.words();
    let of_type = |(kind, word): &(Choice, String)| Some((word.clone(), written_value(kind.0, attribute)?));
    types.iter().filter_map(of_type).collect()
}

/// The value of an attribute that a kind writes; `None` where it has the default of the node.
pub(super) fn written_value(kind: i32, attribute: &Attribute) -> Option<Value> {
    let (_, _, value) = WRITTEN.iter().find(|(of, name, _)| *of == kind && *name == attribute.name)?;
    Some(match attribute.kind {
        Kind::Choice(_) => Value::Choice(Choice(*value as i32)),
        Kind::Bool => Value::Bool(*value != 0.0),
        _ => Value::Float(*value),
    })
}

/// Attributes that turn the pins of a transform constraint into springs, or add a force to them.
pub(super) const SOFT: &[&str] = &[
    "strength",
    "tangentStrength",
    "constraintMethod",
    "constraintRelation",
    "glueStrength",
    "glueStrengthScale",
    "restLengthMethod",
    "restLength",
    "restLengthScale",
    "force",
    "damp",
    "motionDrag",
    "strengthDropoff",
    "dropoff",
    "dropoffDistance",
];

/// The strength ramp of a force field: 1 at its centre, 0 at its distance.
const FALLING: &[RampPoint] = &[
    RampPoint { position: 0.0, value: 1.0, interpolation: Choice(1) },
    RampPoint { position: 1.0, value: 0.0, interpolation: Choice(1) },
];

/// A constraint node at a time: its values, with the defaults of its kind.
#[derive(Clone, Copy)]
pub(crate) struct Values<'a> {
    pub(super) at: &'a EvalContext<'a>,
    pub(super) node: NodeId,
    pub(super) kind: i32,
}

impl<'a> Values<'a> {
    pub(crate) fn new(at: &'a EvalContext<'a>, node: NodeId) -> Self {
        Self { at, node, kind: at.get(node, &con::CONSTRAINT_TYPE).0 }
    }

    /// Whether connections are made anew in every frame.
    pub(super) fn updates_per_frame(&self) -> bool {
        self.choice(&con::CONNECTION_UPDATE) == PER_FRAME
    }

    /// Whether links go on to the closest places of a surface.
    pub(super) fn slides(&self) -> bool {
        self.kind == SLIDE_ON_SURFACE || self.kind == POINT_TO_SURFACE && self.updates_per_frame()
    }

    fn written<T: FromValue>(&self, key: &Key<T>) -> Option<f64> {
        if self.at.graph().is_given(self.node, key) {
            return None;
        }
        let row = WRITTEN.iter().find(|(kind, name, _)| *kind == self.kind && *name == key.row.name);
        row.map(|(_, _, value)| *value)
    }

    pub(super) fn number(&self, key: &Key<f64>) -> f64 {
        self.written(key).unwrap_or_else(|| self.at.get(self.node, key))
    }

    pub(super) fn choice(&self, key: &Key<Choice>) -> i32 {
        self.written(key).map_or_else(|| self.at.get(self.node, key).0, |value| value as i32)
    }

    pub(super) fn toggle(&self, key: &Key<bool>) -> bool {
        self.written(key).map_or_else(|| self.at.get(self.node, key), |value| value != 0.0)
    }

    /// Whether an attribute ever has a value for which `holds` is true, as far as keys show.
    pub(super) fn ever(&self, key: &Key<f64>, holds: impl Fn(f64) -> bool) -> bool {
        self.at.graph().changes(self.node, key) || holds(self.number(key))
    }

    /// The ramp over the distance, with the distance in metres; `None` where it is 1 everywhere.
    pub(super) fn dropoff(&self, metres: impl Fn(f64) -> f64) -> Option<Falloff> {
        let ramp = self.strength_dropoff();
        let distance = self.number(&con::DROPOFF) * self.number(&con::DROPOFF_DISTANCE);
        let samples: [f64; Falloff::SAMPLES] = Ramp::new(&ramp).samples();
        let is_one = samples.iter().all(|sample| *sample == 1.0);
        (!is_one).then(|| Falloff { distance: metres(distance), samples })
    }

    /// The ramp over the distance; that of a force field falls.
    pub(super) fn strength_dropoff(&self) -> Cow<'static, [RampPoint]> {
        let given = self.at.graph().is_given(self.node, &con::STRENGTH_DROPOFF);
        match self.kind {
            FORCE if !given => Cow::Borrowed(FALLING),
            _ => self.at.get(self.node, &con::STRENGTH_DROPOFF),
        }
    }

    /// Whether the constraint pins points to its transform.
    pub(crate) fn pins(&self) -> bool {
        let graph = self.at.graph();
        self.kind == TRANSFORM && !SOFT.iter().any(|name| graph.is_given_by_name(self.node, name))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_written_value_is_of_an_attribute_that_exists() {
        let written = WRITTEN.iter().map(|(_, name, _)| *name).chain(SOFT.iter().copied());
        for name in written {
            assert!(con::DYNAMIC_CONSTRAINT.attribute(name).is_some(), "{name}");
        }
    }
}
