//! State of objects and constraints that depends on their past, beyond positions and velocities: whether a node has it.

use crate::attributes::{Choice, Key, dynamic_constraint as con, n_cloth};
use crate::graph::{Graph, NodeId};

use super::constraints::kinds;

/// `restitutionTension` from which on nothing stays, and `restitutionAngle` in degrees: Maya's defaults.
pub(super) const NO_TENSION: f64 = 1000.0;
pub(super) const NO_ANGLE: f64 = 360.0;
/// `pressureMethod: manualPressureSetting`.
pub(super) const MANUAL: Choice = Choice(0);

/// Whether links of a constraint can break.
pub fn can_break(graph: &Graph, constraint: NodeId) -> bool {
    is_below(graph, constraint, &con::GLUE_STRENGTH, 1.0)
}

/// Whether links of a constraint have rest lengths that are measured when they form, at the start.
pub fn measures_lengths(graph: &Graph, constraint: NodeId) -> bool {
    let node = graph.node(constraint);
    let used = |key| graph.is_ever_nonzero(constraint, key);
    kinds::has_lengths(node.get(&con::CONSTRAINT_TYPE).0)
        && used(&con::STRENGTH)
        && used(&con::REST_LENGTH_SCALE)
        && node.get(&con::REST_LENGTH_METHOD) != con::CONSTANT_REST_LENGTH
        && node.get(&con::CONNECTION_UPDATE).0 != kinds::PER_FRAME
}

/// Whether stretch of a cloth can stay.
pub fn yields_stretch(graph: &Graph, cloth: NodeId) -> bool {
    is_below(graph, cloth, &n_cloth::RESTITUTION_TENSION, NO_TENSION)
}

/// Whether bends of a cloth can stay.
pub fn yields_bends(graph: &Graph, cloth: NodeId) -> bool {
    is_below(graph, cloth, &n_cloth::RESTITUTION_ANGLE, NO_ANGLE)
}

/// Whether a cloth encloses an amount of gas that lasts from frame to frame.
pub fn tracks_volume(graph: &Graph, cloth: NodeId) -> bool {
    let key = &n_cloth::PRESSURE_METHOD;
    graph.changes(cloth, key) || graph.node(cloth).get(key) != MANUAL
}

fn is_below(graph: &Graph, id: NodeId, key: &Key<f64>, limit: f64) -> bool {
    graph.changes(id, key) || graph.node(id).get(key) < limit
}
