//! Names that become connections: `inputMesh`, `nucleus`, `parent`, and the objects of components.

use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;

use crate::attributes::{
    Attribute, Choice, Component, NodeType, dynamic_constraint, n_base, n_cloth, nucleus, surface_shape,
    transform,
};
use crate::graph::{Graph, GraphError, NodeId};
use crate::scene::findings::Findings;
use crate::scene::nearest;
use crate::scene::source::Source;

/// What has been named while nodes were read.
pub(super) struct Links {
    /// All names in the file; without a node where it could not be read.
    pub(super) names: BTreeMap<String, Option<NodeId>>,
    /// Names given as values.
    pub(super) references: Vec<Reference>,
}

/// A name given as a value.
pub(super) struct Reference {
    /// The node it is given to.
    pub(super) node: NodeId,
    /// The attribute it is given to.
    pub(super) row: &'static Attribute,
    /// The name.
    pub(super) name: String,
    /// Where.
    pub(super) span: Range<usize>,
}

/// Makes all connections.
pub(super) fn connect(graph: &mut Graph, links: &Links, source: &Source, findings: &mut Findings) {
    let resolved = resolve(graph, links, findings);
    for reference in &links.references {
        if reference.row == &transform::PARENT.row
            && let Some(&parent) = resolved.get(&(reference.node, reference.row.name))
            && let Err(error) = graph.set_parent(reference.node, parent)
        {
            findings.error(&reference.span, error.to_string());
        }
    }
    let members: Vec<(NodeId, &'static NodeType)> = graph
        .iter()
        .filter(|(_, node)| node.node_type().is_a(&n_base::N_BASE) || is_constraint(node.node_type()))
        .map(|(id, node)| (id, node.node_type()))
        .collect();
    check_meshes(graph, &members, links, source, findings);
    let Some(nucleus) = only_nucleus(graph, &members, links, source, findings) else { return };
    let (constraints, objects): (Vec<_>, Vec<_>) = members.into_iter().partition(|(_, t)| is_constraint(t));
    for (object, node_type) in objects {
        let Some(&mesh) = resolved.get(&(object, n_base::INPUT_MESH.row.name)) else { continue };
        let made = if node_type.is_a(&n_cloth::N_CLOTH) {
            graph.create_cloth(object, mesh, nucleus)
        } else {
            graph.create_collider(object, mesh, nucleus)
        };
        report(made, object, graph, source, findings);
    }
    for (constraint, _) in constraints {
        check_components(graph, constraint, links, source, findings);
        let components = graph.node(constraint).get(&dynamic_constraint::COMPONENTS);
        let made = graph.create_constraint(constraint, &components, nucleus);
        report(made, constraint, graph, source, findings);
    }
}

fn is_constraint(node_type: &'static NodeType) -> bool {
    node_type.is_a(&dynamic_constraint::DYNAMIC_CONSTRAINT)
}

/// Finds the nodes that are named, each of the type that is wanted there.
fn resolve(
    graph: &Graph,
    links: &Links,
    findings: &mut Findings,
) -> BTreeMap<(NodeId, &'static str), NodeId> {
    let mut resolved = BTreeMap::new();
    for Reference { node, row, name, span } in &links.references {
        let (wanted, what): (&'static NodeType, _) = match row.name {
            "nucleus" => (&nucleus::NUCLEUS, "a nucleus"),
            "parent" => (&transform::TRANSFORM, "something that has a transform"),
            _ => (&surface_shape::SURFACE_SHAPE, "a mesh"),
        };
        match links.names.get(name) {
            Some(&Some(target)) if graph.node(target).node_type().is_a(wanted) => {
                resolved.insert((*node, row.name), target);
            }
            Some(&Some(target)) => {
                let (owner, found) = (graph.node(*node).name(), graph.node(target).node_type().name);
                let message =
                    format!("`{}` of `{owner}` takes {what}, but `{name}` is of type {found}", row.name);
                findings.error(span, message);
            }
            // It could not be read, and that has been said.
            Some(None) => {}
            None => {
                let fitting = graph.of_type(wanted).map(|(_, node)| node.name());
                let error = findings.error(span, format!("there is no node `{name}`"));
                error.did_you_mean(nearest(name, fitting));
            }
        }
    }
    resolved
}

/// Every object needs a mesh.
fn check_meshes(
    graph: &Graph,
    members: &[(NodeId, &'static NodeType)],
    links: &Links,
    source: &Source,
    findings: &mut Findings,
) {
    let given =
        |id| links.references.iter().any(|r| r.node == id && r.row.name == n_base::INPUT_MESH.row.name);
    for (id, node_type) in members {
        if node_type.is_a(&n_base::N_BASE) && !given(*id) {
            let name = graph.node(*id).name();
            let place = source.place(name);
            // A value of the wrong type has been reported already.
            if source.place(&format!("{name}.{}", n_base::INPUT_MESH.row.name)) == place {
                let error = findings.error(&place, format!("`{name}` has no `inputMesh`"));
                error.help("add `inputMesh: \"...\"`, the name of a mesh node");
            }
        }
    }
}

/// The nucleus that everything belongs to.
fn only_nucleus(
    graph: &Graph,
    members: &[(NodeId, &'static NodeType)],
    links: &Links,
    source: &Source,
    findings: &mut Findings,
) -> Option<NodeId> {
    let all: Vec<NodeId> = graph.of_type(&nucleus::NUCLEUS).map(|(id, _)| id).collect();
    let place = |id: NodeId| source.place(graph.node(id).name());
    match (all.as_slice(), members.first()) {
        (&[only], _) => return Some(only),
        ([], Some(&(member, _))) if links.names.values().all(Option::is_some) => {
            let name = graph.node(member).name();
            let error =
                findings.error(&place(member), format!("there is no nucleus that `{name}` could belong to"));
            error.help("add `\"nucleus1\": nucleus()`");
        }
        (&[first, ref others @ ..], _) => {
            for &other in others {
                let message = "a scene can have only one nucleus so far";
                findings.error(&place(other), message).note_at(&place(first), "the other one is here");
            }
        }
        _ => {}
    }
    None
}

/// What a constraint takes hold of has to be there and be cloth.
fn check_components(
    graph: &Graph,
    constraint: NodeId,
    links: &Links,
    source: &Source,
    findings: &mut Findings,
) {
    let node = graph.node(constraint);
    let name = node.name();
    let constraint_type = node.get(&dynamic_constraint::CONSTRAINT_TYPE);
    if constraint_type != Choice(0) {
        let place = source.place(&format!("{name}.constraintType"));
        findings
            .warning(&place, format!("constraints of this type have no effect yet: `{name}` does nothing"));
    }
    let components = node.get(&dynamic_constraint::COMPONENTS);
    let place = source.place(name);
    // One that could not be read has been reported already.
    if components.is_empty() && source.place(&format!("{name}.components")) == place {
        findings.warning(&place, format!("`{name}` does nothing: it has no `components`"));
    }
    let mut reported = BTreeSet::new();
    for (k, component) in components.iter().enumerate() {
        let object = component.object.as_str();
        let place = source.place(&format!("{name}.components[{k}]"));
        match links.names.get(object) {
            Some(&Some(id)) if is_cloth(graph, id) => {}
            // It could not be read, and that has been said.
            Some(None) => {}
            _ if !reported.insert(object) => {}
            Some(&Some(id)) => refuse_object(graph, id, component, &place, findings),
            None => {
                let cloths = graph.of_type(&n_cloth::N_CLOTH).map(|(_, node)| node.name());
                let near = nearest(object, cloths);
                findings.error(&place, format!("there is no node `{object}`")).did_you_mean(near);
            }
        }
    }
}

fn is_cloth(graph: &Graph, node: NodeId) -> bool {
    graph.node(node).node_type().is_a(&n_cloth::N_CLOTH)
}

/// Says that something is not cloth; if it is the mesh of a cloth, that was probably meant.
fn refuse_object(
    graph: &Graph,
    id: NodeId,
    component: &Component,
    place: &Range<usize>,
    findings: &mut Findings,
) {
    let (object, found) = (&component.object, graph.node(id).node_type().name);
    let message = format!("only points of cloth can be held, but `{object}` is of type {found}");
    let error = findings.error(place, message);
    let mut fed = graph.targets(id, &surface_shape::WORLD_MESH).map(|plug| plug.node);
    if let Some(cloth) = fed.find(|&node| is_cloth(graph, node)) {
        let meant = Component { object: graph.node(cloth).name().to_owned(), ..component.clone() };
        error.did_you_mean(Some(&meant.to_string()));
    }
}

fn report(
    made: Result<(), GraphError>,
    node: NodeId,
    graph: &Graph,
    source: &Source,
    findings: &mut Findings,
) {
    if let Err(error) = made {
        findings.error(&source.place(graph.node(node).name()), error.to_string());
    }
}
