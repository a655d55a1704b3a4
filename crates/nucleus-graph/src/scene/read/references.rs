//! References to nodes by name (`inputMesh`, `nucleus`, `target`, `parent`, `blendTarget`, `restShapeMesh`).

use std::collections::BTreeMap;
use std::ops::Range;

use crate::attributes::{
    Attribute, NodeType, n_cloth, n_particle, nucleus, particle, surface_shape, transform,
};
use crate::diagnostic::{Findings, nearest};
use crate::graph::{Graph, NodeId};
use crate::scene::document::Source;

/// The names collected while nodes are read.
pub(super) struct References {
    /// All names of nodes in the file. `None` for nodes that could not be read.
    pub(super) names: BTreeMap<String, Option<NodeId>>,
    /// All references.
    pub(super) all: Vec<Reference>,
}

/// The name of a node as the value of an attribute.
pub(super) struct Reference {
    /// The node that has the attribute.
    pub(super) node: NodeId,
    /// The attribute.
    pub(super) row: &'static Attribute,
    /// The name.
    pub(super) name: String,
    /// The place of the name.
    pub(super) span: Range<usize>,
}

/// The nodes that references name, by the node and the name of the attribute.
pub(super) type Resolved = BTreeMap<(NodeId, &'static str), NodeId>;

/// Finds the referenced nodes, and sets parents, blend targets and rest shapes.
pub(super) fn resolve(
    graph: &mut Graph,
    references: &References,
    source: &Source,
    findings: &mut Findings,
) -> Resolved {
    let resolved = find(graph, references, findings);
    set_parents(graph, references, &resolved, findings);
    set_blend_targets(graph, references, &resolved, source, findings);
    set_rest_shapes(graph, references, &resolved, findings);
    resolved
}

/// Finds the referenced nodes, and refuses those of a wrong type.
fn find(graph: &Graph, references: &References, findings: &mut Findings) -> Resolved {
    let mut resolved = BTreeMap::new();
    for Reference { node, row, name, span } in &references.all {
        let is_particles = graph.node(*node).node_type().is_a(&n_particle::N_PARTICLE);
        if name.is_empty() && row.name == "nucleus" && is_particles {
            continue;
        }
        let (wanted, what): (&'static NodeType, _) = match row.name {
            "nucleus" => (&nucleus::NUCLEUS, "a nucleus"),
            "parent" => (&transform::TRANSFORM, "something that has a transform"),
            "target" => (&particle::PARTICLE, "an object"),
            _ => (&surface_shape::SURFACE_SHAPE, "a mesh"),
        };
        match references.names.get(name) {
            Some(&Some(target)) if graph.node(target).node_type().is_a(wanted) => {
                resolved.insert((*node, row.name), target);
            }
            Some(&Some(target)) => {
                let (owner, found) = (graph.node(*node).name(), graph.node(target).node_type().name);
                let message =
                    format!("`{}` of `{owner}` takes {what}, but `{name}` is of type {found}", row.name);
                findings.error(span, message);
            }
            // Reading the node has reported a mistake.
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

/// Sets the parents of nodes.
fn set_parents(graph: &mut Graph, references: &References, resolved: &Resolved, findings: &mut Findings) {
    for reference in &references.all {
        if reference.row == &transform::PARENT.row
            && let Some(&parent) = resolved.get(&(reference.node, reference.row.name))
            && let Err(error) = graph.set_parent(reference.node, parent)
        {
            findings.error(&reference.span, error.to_string());
        }
    }
}

/// Sets the blend targets of meshes. Warns of blends without a target.
fn set_blend_targets(
    graph: &mut Graph,
    references: &References,
    resolved: &Resolved,
    source: &Source,
    findings: &mut Findings,
) {
    for reference in references.all.iter().filter(|r| r.row == &surface_shape::BLEND_TARGET.row) {
        let Some(&target) = resolved.get(&(reference.node, reference.row.name)) else { continue };
        if let Err(error) = graph.blend_into(reference.node, target) {
            findings.error(&reference.span, error.to_string());
        }
    }
    for (id, node) in graph.of_type(&surface_shape::SURFACE_SHAPE) {
        let given = references.all.iter().any(|r| r.node == id && r.row == &surface_shape::BLEND_TARGET.row);
        if node.setting(&surface_shape::BLEND).is_some() && !given && graph.blend_target(id).is_none() {
            let place = source.place(&format!("{}.blend", node.name()));
            let warning = findings.warning(
                &place,
                format!("`blend` of `{}` does nothing: there is no `blendTarget`", node.name()),
            );
            warning.help("add `blendTarget: \"...\"`, a mesh of as many points");
        }
    }
}

/// Connects the rest shapes of cloths.
fn set_rest_shapes(graph: &mut Graph, references: &References, resolved: &Resolved, findings: &mut Findings) {
    for reference in references.all.iter().filter(|r| r.row == &n_cloth::REST_SHAPE_MESH.row) {
        let Some(&mesh) = resolved.get(&(reference.node, reference.row.name)) else { continue };
        if let Err(error) = graph.set_rest_shape(reference.node, mesh) {
            findings.error(&reference.span, error.to_string());
        }
    }
}
