//! Nodes that act on nothing because nothing connects them: a warning says which.

use std::collections::BTreeSet;

use crate::attributes::{
    Key, NodeType, air_field, drag_field, dynamic_constraint, field, gravity_field, n_base, n_particle,
    n_rigid, nucleus, particle, point_emitter, uniform_field, volume_axis_field, vortex_field,
};
use crate::compile::fields::away_from;
use crate::diagnostic::Findings;
use crate::graph::{Graph, NodeId, Plug};
use crate::scene::document::Scene;

/// Warns of fields, emitters and constraints that act on nothing, and of objects that no nucleus solves.
pub(super) fn warn_of_idle_nodes(scene: &Scene, broken: &BTreeSet<NodeId>, findings: &mut Findings) {
    let graph = &scene.graph;
    let mut warn = |id: NodeId, message: String, help: &str| {
        if !broken.contains(&id) {
            findings.warning(&scene.source.place(graph.node(id).name()), message).help(help);
        }
    };
    for (id, node) in graph.of_type(&field::FIELD) {
        let mut targets = graph.targets(id, &field::OUTPUT_FORCE).peekable();
        let name = node.name();
        if targets.peek().is_none() {
            let help = "name the objects it acts on: `target: \"cloth1\"`";
            warn(id, format!("`{name}` acts on nothing"), help);
        } else if targets.all(|to| graph.node(to.node).node_type().is_a(&n_rigid::N_RIGID)) {
            let help = "colliders follow their meshes; name cloth or particles";
            warn(id, format!("`{name}` acts on colliders only, which no force moves"), help);
        } else if let Some(key) = direction_of(node.node_type())
            && !graph.is_ever_nonzero(id, key)
            && !acts_without_direction(graph, id)
        {
            let help = format!("give it one: `{}: (0, 1, 0)`", key.row.name);
            warn(id, format!("`{name}` acts on nothing: its `{}` is zero", key.row.name), &help);
        } else if let Some((missing, help)) = missing_of(graph, id) {
            warn(id, format!("`{name}` acts on nothing: {missing}"), help);
        }
    }
    for (id, node) in graph.of_type(&n_base::N_BASE) {
        let mut solvers = graph.targets(id, &n_base::CURRENT_STATE);
        if !solvers.any(|to| graph.node(to.node).node_type().is_a(&nucleus::NUCLEUS)) {
            let help = match node.node_type().is_a(&n_particle::N_PARTICLE) {
                true => "take its connections out: then the nucleus of the scene solves it",
                false => {
                    "name its mesh as `inputMesh: \"...\"` instead of connecting it: then a nucleus solves it"
                }
            };
            warn(id, format!("`{}` is not solved: it is connected to no nucleus", node.name()), help);
        }
    }
    for (id, node) in graph.of_type(&point_emitter::POINT_EMITTER) {
        if !graph.targets(id, &point_emitter::OUTPUT).any(|to| is_particle_input(graph, to)) {
            let help = "name the particles: `target: \"nParticle1\"`";
            warn(id, format!("`{}` emits into no particles", node.name()), help);
        }
    }
    for (id, node) in graph.of_type(&dynamic_constraint::DYNAMIC_CONSTRAINT) {
        let is_listed = !node.get(&dynamic_constraint::COMPONENTS).is_empty();
        let has_parts = !graph.elements(id, &dynamic_constraint::COMPONENT_IDS).is_empty();
        if !is_listed && !has_parts {
            let help = "name the parts that it joins: `components: [\"cloth1.border\"]`";
            warn(id, format!("`{}` constrains nothing: it has no components", node.name()), help);
        } else if !is_listed && graph.targets(id, &dynamic_constraint::EVAL_CURRENT).next().is_none() {
            let help = "connect its `evalStart[0]` and `evalCurrent[0]` to `inputStart` and `inputCurrent` of a nucleus";
            warn(id, format!("`{}` constrains nothing: it has no nucleus", node.name()), help);
        }
    }
}

/// What a field lacks that would let it act, and a remedy.
fn missing_of(graph: &Graph, id: NodeId) -> Option<(&'static str, &'static str)> {
    let node_type = graph.node(id).node_type();
    let is_zero = |key: &Key<f64>| !graph.is_ever_nonzero(id, key);
    let is_always = |key: &Key<bool>| !graph.changes(id, key) && graph.at(0.0).get(id, key);
    let never_positive =
        |key: &Key<f64>| is_zero(key) || (!graph.changes(id, key) && graph.at(0.0).get(id, key) < 0.0);
    if is_always(&field::USE_MAX_DISTANCE) && never_positive(&field::MAX_DISTANCE) {
        return Some((
            "its `maxDistance` is not above zero",
            "give `maxDistance`, or `useMaxDistance: false`",
        ));
    }
    if node_type.is_a(&air_field::AIR_FIELD) {
        let help = "`speed` is the rate at which objects take up its velocity: give it one, `speed: 1`";
        if is_zero(&air_field::SPEED) {
            return Some(("its `speed` is zero", help));
        }
        if is_always(&air_field::ENABLE_SPREAD) && never_positive(&air_field::SPREAD) {
            return Some((
                "its `spread` is zero",
                "give it an angle, `spread: 0.5`, or `enableSpread: false`",
            ));
        }
    }
    if node_type.is_a(&drag_field::DRAG_FIELD)
        && is_always(&drag_field::USE_DIRECTION)
        && !graph.is_ever_nonzero(id, &drag_field::DIRECTION)
    {
        return Some((
            "its `direction` is zero",
            "give it one: `direction: (0, 1, 0)`, or `useDirection: false`",
        ));
    }
    (node_type.is_a(&volume_axis_field::VOLUME_AXIS_FIELD) && !volume_axis_acts(graph, id))
        .then_some(("none of its speeds has an effect in its volume", "give one, such as `alongAxis: 1`"))
}

/// Whether any speed of a volume axis field is ever not zero, of those that its volume uses.
fn volume_axis_acts(graph: &Graph, id: NodeId) -> bool {
    use volume_axis_field::{
        ALONG_AXIS, AROUND_AXIS, AWAY_FROM_AXIS, AWAY_FROM_CENTER, DIRECTION, DIRECTIONAL_SPEED, TURBULENCE,
    };
    let acts = |key: &Key<f64>| graph.is_ever_nonzero(id, key);
    let changes = graph.changes(id, &field::VOLUME_SHAPE);
    let away = away_from(graph.at(0.0).get(id, &field::VOLUME_SHAPE));
    (acts(&AWAY_FROM_CENTER) && (changes || away.center))
        || (acts(&AWAY_FROM_AXIS) && (changes || away.axis))
        || acts(&ALONG_AXIS)
        || acts(&AROUND_AXIS)
        || acts(&TURBULENCE)
        || (acts(&DIRECTIONAL_SPEED) && graph.is_ever_nonzero(id, &DIRECTION))
}

/// The attribute without which a field has no direction.
fn direction_of(node_type: &'static NodeType) -> Option<&'static Key<[f64; 3]>> {
    let all = [
        (&gravity_field::GRAVITY_FIELD, &gravity_field::DIRECTION),
        (&uniform_field::UNIFORM_FIELD, &uniform_field::DIRECTION),
        (&air_field::AIR_FIELD, &air_field::DIRECTION),
        (&vortex_field::VORTEX_FIELD, &vortex_field::AXIS),
    ];
    all.into_iter().find(|(of, _)| node_type.is_a(of)).map(|(_, key)| key)
}

/// Whether a field acts even if its direction is zero: air that moves with its field, and air at rest, which slows what
/// moves in it unless it only accelerates.
fn acts_without_direction(graph: &Graph, id: NodeId) -> bool {
    let key = &air_field::COMPONENT_ONLY;
    graph.node(id).node_type().is_a(&air_field::AIR_FIELD)
        && (graph.is_ever_nonzero(id, &air_field::INHERIT_VELOCITY)
            || graph.changes(id, key)
            || !graph.at(0.0).get(id, key))
}

fn is_particle_input(graph: &Graph, to: Plug) -> bool {
    graph.node(to.node).node_type().is_a(&n_particle::N_PARTICLE)
        && to.attribute.name == particle::NEW_PARTICLES.row.name
}
