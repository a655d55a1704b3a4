//! Components of dynamic constraints: their objects and points exist, and fit into memory.

use std::collections::BTreeSet;
use std::ops::Range;

use crate::attributes::{
    Component, ElementKind, Selection, Which, dynamic_constraint, n_base, n_cloth, surface_shape,
};
use crate::compile::max_points;
use crate::diagnostic::{Findings, nearest};
use crate::graph::{Graph, NodeId};
use crate::memory;
use crate::scene::document::Source;

use super::references::{References, Resolved};

/// Refuses components of missing objects, and of nodes other than cloth, particles and colliders.
pub(super) fn check(
    graph: &Graph,
    constraint: NodeId,
    references: &References,
    source: &Source,
    findings: &mut Findings,
) {
    let node = graph.node(constraint);
    let name = node.name();
    let components = node.get(&dynamic_constraint::COMPONENTS);
    let place = source.place(name);
    // A malformed component has been reported.
    if components.is_empty() && source.place(&format!("{name}.components")) == place {
        findings.warning(&place, format!("`{name}` does nothing: it has no `components`"));
    }
    let mut reported = BTreeSet::new();
    for (k, component) in components.iter().enumerate() {
        let object = component.object.as_str();
        let place = source.place(&format!("{name}.components[{k}]"));
        match references.names.get(object) {
            Some(&Some(id)) if is_object(graph, id) => {}
            // Reading the node has reported a mistake.
            Some(None) => {}
            _ if !reported.insert(object) => {}
            Some(&Some(id)) => refuse_object(graph, id, component, &place, findings),
            None => {
                let objects = graph.of_type(&n_base::N_BASE).map(|(_, node)| node.name());
                let near = nearest(object, objects);
                findings.error(&place, format!("there is no node `{object}`")).did_you_mean(near);
            }
        }
    }
}

/// Whether the points of a constraint exist and fit into memory; reports those that do not. This comes before
/// ranges are expanded to lists.
pub(super) fn points_fit(
    graph: &Graph,
    resolved: &Resolved,
    constraint: NodeId,
    source: &mut Source,
    findings: &mut Findings,
) -> bool {
    let before = findings.errors();
    let components = graph.node(constraint).get(&dynamic_constraint::COMPONENTS);
    for (k, component) in components.iter().enumerate() {
        let Component { object, selection: Selection::Elements(kind, Which::Range(first, last)) } = component
        else {
            continue;
        };
        let place = source.place(&format!("{}.components[{k}]", graph.node(constraint).name()));
        let Some(node) = graph.find(object) else { continue };
        let mesh = resolved.get(&(node, n_base::INPUT_MESH.row.name)).copied();
        let count = max_points(graph, source, node, mesh);
        if *kind == ElementKind::Point && count.is_some_and(|count| u64::from(*last) >= count) {
            findings.error(&place, format!("`{object}` has no point {last}")).help(match count {
                Some(count @ 1..) => format!("its points are numbered 0 to {}", count - 1),
                _ => "it has no points".to_owned(),
            });
            continue;
        }
        let count = u64::from(last - first) + 1;
        if let Err(refused) = source.budget_mut().claim(count.saturating_mul(memory::HELD_POINT)) {
            let error =
                findings.error(&place, format!("to constrain {count} {}s takes {refused}", kind.noun()));
            error.help(refused.help(&format!("constrain fewer {}s", kind.noun())));
        }
    }
    findings.errors() == before
}

fn is_cloth(graph: &Graph, node: NodeId) -> bool {
    graph.node(node).node_type().is_a(&n_cloth::N_CLOTH)
}

fn is_object(graph: &Graph, node: NodeId) -> bool {
    graph.node(node).node_type().is_a(&n_base::N_BASE)
}

/// Reports an object of a wrong type. Suggests the cloth if the object is its mesh.
fn refuse_object(
    graph: &Graph,
    id: NodeId,
    component: &Component,
    place: &Range<usize>,
    findings: &mut Findings,
) {
    let (object, found) = (&component.object, graph.node(id).node_type().name);
    let message = format!(
        "only parts of cloth, particles and colliders can be constrained, but `{object}` is of type {found}"
    );
    let error = findings.error(place, message);
    let mut fed = graph.targets(id, &surface_shape::WORLD_MESH).map(|plug| plug.node);
    if let Some(cloth) = fed.find(|&node| is_cloth(graph, node)) {
        let meant = Component { object: graph.node(cloth).name().to_owned(), ..component.clone() };
        error.did_you_mean(Some(&meant.to_string()));
    }
}
