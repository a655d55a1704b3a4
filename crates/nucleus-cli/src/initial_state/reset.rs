//! State that a run from a cache does not take over: links of constraints, plastic deformation and enclosed gas.

use nucleus_graph::attributes::dynamic_constraint::{
    CONNECTION_UPDATE, CONSTANT_REST_LENGTH, CONSTRAINT_TYPE, DYNAMIC_CONSTRAINT, ENABLE, GLUE_STRENGTH,
    REST_LENGTH_METHOD, REST_LENGTH_SCALE, STRENGTH,
};
use nucleus_graph::attributes::n_cloth::{N_CLOTH, PRESSURE_METHOD, RESTITUTION_ANGLE, RESTITUTION_TENSION};
use nucleus_graph::attributes::{Choice, Key};
use nucleus_graph::graph::{Graph, NodeId};

/// Types of constraints whose links have lengths of their own: point to point, point to surface, and match.
const WITH_LENGTHS: [Choice; 3] = [Choice(1), Choice(2), Choice(6)];
/// `connectionUpdate` of links that are formed anew in each frame.
const PER_FRAME: Choice = Choice(1);
/// `pressureMethod` of cloth without gas.
const MANUAL: Choice = Choice(0);
/// Maya's defaults, from which on no deformation stays.
const ELASTIC_TENSION: f64 = 1000.0;
const ELASTIC_ANGLE: f64 = 360.0;

/// The state of a scene that begins anew in a run from a cache, as parts of a sentence.
pub(super) fn lost_state(graph: &Graph) -> Vec<String> {
    let named = |text: &str, has: &dyn Fn(NodeId) -> bool| {
        let nodes = graph.iter().filter(|(id, _)| has(*id));
        let names: Vec<String> = nodes.map(|(_, node)| format!("`{}`", node.name())).collect();
        (!names.is_empty()).then(|| text.replace("{}", &names.join(", ")))
    };
    let lost = [
        named("broken links of {} hold again", &|id| is_enabled(graph, id) && breaks(graph, id)),
        named("rest lengths of {} are measured at the first frame", &|id| {
            is_enabled(graph, id) && measures_lengths(graph, id)
        }),
        named("{} has no plastic deformation", &|id| is_cloth(graph, id) && yields(graph, id)),
        named("{} has the gas of its start state", &|id| is_cloth(graph, id) && has_gas(graph, id)),
    ];
    lost.into_iter().flatten().collect()
}

fn is_enabled(graph: &Graph, id: NodeId) -> bool {
    let is_constraint = graph.node(id).node_type().is_a(&DYNAMIC_CONSTRAINT);
    is_constraint && (graph.changes(id, &ENABLE) || graph.node(id).get(&ENABLE))
}

fn is_cloth(graph: &Graph, id: NodeId) -> bool {
    graph.node(id).node_type().is_a(&N_CLOTH)
}

fn is_below(graph: &Graph, id: NodeId, key: &Key<f64>, limit: f64) -> bool {
    graph.changes(id, key) || graph.node(id).get(key) < limit
}

fn breaks(graph: &Graph, id: NodeId) -> bool {
    is_below(graph, id, &GLUE_STRENGTH, 1.0)
}

fn measures_lengths(graph: &Graph, id: NodeId) -> bool {
    let node = graph.node(id);
    let has_length = graph.is_ever_nonzero(id, &STRENGTH) && graph.is_ever_nonzero(id, &REST_LENGTH_SCALE);
    has_length
        && WITH_LENGTHS.contains(&node.get(&CONSTRAINT_TYPE))
        && node.get(&REST_LENGTH_METHOD) != CONSTANT_REST_LENGTH
        && node.get(&CONNECTION_UPDATE) != PER_FRAME
}

fn yields(graph: &Graph, id: NodeId) -> bool {
    is_below(graph, id, &RESTITUTION_TENSION, ELASTIC_TENSION)
        || is_below(graph, id, &RESTITUTION_ANGLE, ELASTIC_ANGLE)
}

fn has_gas(graph: &Graph, id: NodeId) -> bool {
    graph.changes(id, &PRESSURE_METHOD) || graph.node(id).get(&PRESSURE_METHOD) != MANUAL
}
