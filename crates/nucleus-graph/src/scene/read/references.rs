//! References to nodes by name (`inputMesh`, `nucleus`, `target`, `parent`, objects of components), and the connections
//! that follow from them.

use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;

use crate::attributes::{
    Attribute, Component, ElementKind, NodeType, Selection, Which, dyn_base, dynamic_constraint, n_base,
    n_cloth, n_particle, nucleus, particle, surface_shape, transform,
};
use crate::compile::max_points;
use crate::diagnostic::{Findings, nearest};
use crate::graph::{Creation, Graph, NodeId};
use crate::memory;
use crate::scene::document::Source;

use super::connections::Connections;

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

/// Makes the connections of Maya's creation commands, in the order of names: objects first, then constraints, then
/// fields and emitters.
pub(super) fn connect(
    graph: &mut Graph,
    references: &References,
    connections: &Connections,
    source: &mut Source,
    findings: &mut Findings,
) {
    let resolved = resolve(graph, references, findings);
    set_parents(graph, references, &resolved, findings);
    set_blend_targets(graph, references, &resolved, source, findings);
    set_rest_shapes(graph, references, &resolved, findings);
    let mut resolver = Resolver {
        ends: connections.ends(graph),
        all: graph.of_type(&nucleus::NUCLEUS).map(|(id, _)| id).collect(),
        named: references.all.iter().map(|r| (r.node, r.row.name)).collect(),
        graph,
        references,
        resolved,
        source,
        findings,
        nuclei: BTreeMap::new(),
        reported_no_nucleus: false,
    };
    let nodes: Vec<(NodeId, &'static NodeType)> =
        resolver.graph.iter().map(|(id, node)| (id, node.node_type())).collect();
    let of = |base: &'static NodeType| nodes.iter().filter(move |(_, node_type)| node_type.is_a(base));
    of(&n_base::N_BASE).for_each(|&(id, node_type)| resolver.connect_object(id, node_type));
    of(&dynamic_constraint::DYNAMIC_CONSTRAINT).for_each(|&(id, _)| resolver.connect_constraint(id));
    of(&dyn_base::DYN_BASE).for_each(|&(id, _)| resolver.connect_effect(id));
}

/// Finds the referenced nodes, and refuses those of a wrong type.
fn resolve(
    graph: &Graph,
    references: &References,
    findings: &mut Findings,
) -> BTreeMap<(NodeId, &'static str), NodeId> {
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
fn set_parents(
    graph: &mut Graph,
    references: &References,
    resolved: &BTreeMap<(NodeId, &'static str), NodeId>,
    findings: &mut Findings,
) {
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
    resolved: &BTreeMap<(NodeId, &'static str), NodeId>,
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
fn set_rest_shapes(
    graph: &mut Graph,
    references: &References,
    resolved: &BTreeMap<(NodeId, &'static str), NodeId>,
    findings: &mut Findings,
) {
    for reference in references.all.iter().filter(|r| r.row == &n_cloth::REST_SHAPE_MESH.row) {
        let Some(&mesh) = resolved.get(&(reference.node, reference.row.name)) else { continue };
        if let Err(error) = graph.set_rest_shape(reference.node, mesh) {
            findings.error(&reference.span, error.to_string());
        }
    }
}

/// Connects nodes to their nuclei.
struct Resolver<'a> {
    graph: &'a mut Graph,
    references: &'a References,
    /// Attributes at the output ends of explicit connections, and those at the input ends.
    ends: [BTreeSet<(NodeId, &'static str)>; 2],
    /// Attributes that have a reference.
    named: BTreeSet<(NodeId, &'static str)>,
    /// All nuclei.
    all: Vec<NodeId>,
    resolved: BTreeMap<(NodeId, &'static str), NodeId>,
    source: &'a mut Source,
    findings: &'a mut Findings,
    /// The nucleus of each connected object.
    nuclei: BTreeMap<NodeId, NodeId>,
    /// Whether the lack of a nucleus has been reported.
    reported_no_nucleus: bool,
}

impl Resolver<'_> {
    fn connect_object(&mut self, id: NodeId, node_type: &'static NodeType) {
        let is_particles = node_type.is_a(&n_particle::N_PARTICLE);
        let mesh = self.resolved.get(&(id, n_base::INPUT_MESH.row.name)).copied();
        if mesh.is_none() && !is_particles {
            self.check_mesh(id);
        }
        if is_particles && self.is_left_unconnected(id) {
            return;
        }
        // A missing nucleus is reported even if the mesh has a mistake.
        let meant = self.named.contains(&(id, n_base::INPUT_MESH.row.name));
        if !is_particles && !meant && self.has_explicit_connections(id) {
            return;
        }
        let Some(nucleus) = self.nucleus_of(id) else { return };
        if mesh.is_some() || is_particles {
            self.nuclei.insert(id, nucleus);
            self.create(id, &Creation::Object { mesh: mesh.filter(|_| !is_particles), nucleus });
        }
    }

    /// Whether a node has explicit connections.
    fn has_explicit_connections(&self, id: NodeId) -> bool {
        self.ends.iter().any(|ends| ends.range((id, "")..).next().is_some_and(|(node, _)| *node == id))
    }

    /// Whether particles get no implicit connections: they have explicit ones, or no nucleus (`nucleus: ""`).
    fn is_left_unconnected(&self, id: NodeId) -> bool {
        let mut references = self.references.all.iter();
        self.has_explicit_connections(id)
            || references.any(|r| r.node == id && r.row.name == "nucleus" && r.name.is_empty())
    }

    fn connect_constraint(&mut self, id: NodeId) {
        let listed = self.graph.node(id).setting(&dynamic_constraint::COMPONENTS).is_some();
        if !listed && self.has_explicit_connections(id) {
            return;
        }
        check_components(self.graph, id, self.references, self.source, self.findings);
        if !listed {
            return;
        }
        let components = self.graph.node(id).get(&dynamic_constraint::COMPONENTS);
        let objects: Vec<NodeId> = components
            .iter()
            .filter_map(|component| self.graph.find(&component.object))
            .filter(|object| self.nuclei.contains_key(object))
            .collect();
        let object_nuclei: BTreeSet<NodeId> = objects.iter().map(|object| self.nuclei[object]).collect();
        let object_nuclei: Vec<NodeId> = object_nuclei.into_iter().collect();
        let given = self.named_nucleus(id);
        let nucleus = match (given, object_nuclei.as_slice()) {
            (Some(None), _) => return,
            (Some(Some(nucleus)), _) => nucleus,
            (None, &[only]) => only,
            (None, _) => match self.nucleus_of(id) {
                Some(nucleus) => nucleus,
                None => return,
            },
        };
        if !self.check_points(id, &components) {
            return;
        }
        if let Some(foreign) = objects.iter().find(|object| self.nuclei[*object] != nucleus) {
            self.refuse_foreign_object(id, nucleus, *foreign);
            return;
        }
        self.create(id, &Creation::Constraint { components, nucleus });
    }

    /// Whether the points of a constraint exist and fit into memory; reports those that do not. This comes before
    /// ranges are expanded to lists.
    fn check_points(&mut self, id: NodeId, components: &[Component]) -> bool {
        let before = self.findings.errors();
        for (k, component) in components.iter().enumerate() {
            let Component { object, selection: Selection::Elements(kind, Which::Range(first, last)) } =
                component
            else {
                continue;
            };
            let place = self.source.place(&format!("{}.components[{k}]", self.graph.node(id).name()));
            let Some(node) = self.graph.find(object) else { continue };
            let mesh = self.resolved.get(&(node, n_base::INPUT_MESH.row.name)).copied();
            let count = max_points(self.graph, self.source, node, mesh);
            if *kind == ElementKind::Point && count.is_some_and(|count| u64::from(*last) >= count) {
                self.findings.error(&place, format!("`{object}` has no point {last}")).help(match count {
                    Some(count @ 1..) => format!("its points are numbered 0 to {}", count - 1),
                    _ => "it has no points".to_owned(),
                });
                continue;
            }
            let count = u64::from(last - first) + 1;
            if let Err(refused) = self.source.budget_mut().claim(count.saturating_mul(memory::HELD_POINT)) {
                let error = self
                    .findings
                    .error(&place, format!("to constrain {count} {}s takes {refused}", kind.noun()));
                error.help(refused.help(&format!("constrain fewer {}s", kind.noun())));
            }
        }
        self.findings.errors() == before
    }

    fn connect_effect(&mut self, id: NodeId) {
        if let Some(&target) = self.resolved.get(&(id, dyn_base::TARGET.row.name)) {
            self.create(id, &Creation::Effect { target });
        }
    }

    fn create(&mut self, id: NodeId, creation: &Creation) {
        if let Err(error) = self.graph.create(id, creation) {
            self.findings.error(&self.source.place(self.graph.node(id).name()), error.to_string());
        }
    }

    /// The nucleus that a node names: `None` if it names none, `Some(None)` if the name is wrong.
    fn named_nucleus(&self, id: NodeId) -> Option<Option<NodeId>> {
        self.named.contains(&(id, "nucleus")).then(|| self.resolved.get(&(id, "nucleus")).copied())
    }

    /// The nucleus of a node: the one that it names, else the only one.
    fn nucleus_of(&mut self, id: NodeId) -> Option<NodeId> {
        if let Some(given) = self.named_nucleus(id) {
            return given;
        }
        let name = self.graph.node(id).name();
        let place = self.source.place(name);
        match self.all.as_slice() {
            &[only] => return Some(only),
            [] if self.references.names.values().all(Option::is_some) && !self.reported_no_nucleus => {
                self.reported_no_nucleus = true;
                let message = format!("there is no nucleus that `{name}` could belong to");
                self.findings.error(&place, message).help("add `\"nucleus1\": nucleus()`");
            }
            [] => {}
            several => {
                let names: Vec<String> =
                    several.iter().map(|id| format!("`{}`", self.graph.node(*id).name())).collect();
                let message = format!("`{name}` could belong to {}", names.join(" or "));
                let help = format!("say which: `nucleus: \"{}\"`", self.graph.node(several[0]).name());
                self.findings.error(&place, message).help(help);
            }
        }
        None
    }

    /// Refuses an object of another nucleus.
    fn refuse_foreign_object(&mut self, constraint: NodeId, nucleus: NodeId, foreign: NodeId) {
        let name = |id: NodeId| self.graph.node(id).name();
        let message = format!(
            "`{}` on `{}` constrains `{}` on `{}`",
            name(constraint),
            name(nucleus),
            name(foreign),
            name(self.nuclei[&foreign])
        );
        let place = self.source.place(&format!("{}.components", name(constraint)));
        self.findings.error(&place, message).help("a constraint and its objects need the same nucleus");
    }

    /// Cloth and colliders need a mesh.
    fn check_mesh(&mut self, id: NodeId) {
        let given = self.named.contains(&(id, n_base::INPUT_MESH.row.name));
        let name = self.graph.node(id).name();
        let place = self.source.place(name);
        // A value of the wrong form has been reported.
        let misread = self.source.place(&format!("{name}.{}", n_base::INPUT_MESH.row.name)) != place;
        if !given && !misread && !self.ends[1].contains(&(id, n_base::INPUT_MESH.row.name)) {
            let error = self.findings.error(&place, format!("`{name}` has no `inputMesh`"));
            error.help("add `inputMesh: \"...\"`, the name of a mesh node");
        }
    }
}

/// Refuses components of missing objects, and of nodes other than cloth, particles and colliders.
fn check_components(
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
