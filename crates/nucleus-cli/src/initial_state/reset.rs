//! State that a run from a cache does not take over: links of constraints, plastic deformation, enclosed gas, and the phase
//! of emitters.

use nucleus_graph::attributes::dynamic_constraint::{DYNAMIC_CONSTRAINT, ENABLE};
use nucleus_graph::attributes::n_cloth::N_CLOTH;
use nucleus_graph::attributes::point_emitter::{POINT_EMITTER, RATE};
use nucleus_graph::compile::past_state::{
    can_break, measures_lengths, tracks_volume, yields_bends, yields_stretch,
};
use nucleus_graph::graph::{Graph, NodeId};

/// The state of a scene that begins anew in a run from a cache, as parts of a sentence.
pub(super) fn lost_state(graph: &Graph, fps: f64) -> Vec<String> {
    let named = |text: &str, has: &dyn Fn(NodeId) -> bool| {
        let nodes = graph.iter().filter(|(id, _)| has(*id));
        let names: Vec<String> = nodes.map(|(_, node)| format!("`{}`", node.name())).collect();
        (!names.is_empty()).then(|| text.replace("{}", &names.join(", ")))
    };
    let lost = [
        named("broken links of {} hold again", &|id| is_enabled(graph, id) && can_break(graph, id)),
        named("rest lengths of {} are measured at the first frame", &|id| {
            is_enabled(graph, id) && measures_lengths(graph, id)
        }),
        named("{} has no plastic deformation", &|id| {
            is_cloth(graph, id) && (yields_stretch(graph, id) || yields_bends(graph, id))
        }),
        named("the time to the next birth from {} counts from the start", &|id| has_phase(graph, id, fps)),
        named("{} has the gas of its start state", &|id| is_cloth(graph, id) && tracks_volume(graph, id)),
    ];
    lost.into_iter().flatten().collect()
}

fn is_enabled(graph: &Graph, id: NodeId) -> bool {
    let is_constraint = graph.node(id).node_type().is_a(&DYNAMIC_CONSTRAINT);
    is_constraint && (graph.changes(id, &ENABLE) || graph.node(id).get(&ENABLE))
}

/// Whether a node emits particles at a rate that is not a whole number per frame: then one may be due within a frame.
fn has_phase(graph: &Graph, id: NodeId, fps: f64) -> bool {
    let is_emitter = graph.node(id).node_type().is_a(&POINT_EMITTER);
    is_emitter && (graph.changes(id, &RATE) || (graph.node(id).get(&RATE) / fps).fract() != 0.0)
}

fn is_cloth(graph: &Graph, id: NodeId) -> bool {
    graph.node(id).node_type().is_a(&N_CLOTH)
}
