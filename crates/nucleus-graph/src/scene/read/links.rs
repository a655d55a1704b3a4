//! Names that become connections: `inputMesh`, `nucleus`, `target`, `parent`, and the objects of components.

use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;

use crate::attributes::{
    Attribute, Choice, Component, NodeType, Selection, dyn_base, dynamic_constraint, n_base, n_cloth,
    n_particle, nucleus, particle, surface_shape, transform,
};
use crate::compile::max_points;
use crate::graph::{Creation, Graph, NodeId};
use crate::memory;
use crate::scene::findings::Findings;
use crate::scene::nearest;
use crate::scene::source::Source;

use super::wires::Wires;

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

/// Makes the connections that Maya's commands would make, in the order of names: objects first, then what is
/// put on them.
pub(super) fn connect(
    graph: &mut Graph,
    links: &Links,
    wires: &Wires,
    source: &mut Source,
    findings: &mut Findings,
) {
    let resolved = resolve(graph, links, findings);
    hang(graph, links, &resolved, findings);
    blend(graph, links, &resolved, source, findings);
    let mut joiner = Joiner {
        ends: wires.ends(graph),
        all: graph.of_type(&nucleus::NUCLEUS).map(|(id, _)| id).collect(),
        named: links.references.iter().map(|r| (r.node, r.row.name)).collect(),
        graph,
        links,
        resolved,
        source,
        findings,
        nuclei: BTreeMap::new(),
        alone: false,
    };
    let nodes: Vec<(NodeId, &'static NodeType)> =
        joiner.graph.iter().map(|(id, node)| (id, node.node_type())).collect();
    let of = |base: &'static NodeType| nodes.iter().filter(move |(_, node_type)| node_type.is_a(base));
    of(&n_base::N_BASE).for_each(|&(id, node_type)| joiner.object(id, node_type));
    of(&dynamic_constraint::DYNAMIC_CONSTRAINT).for_each(|&(id, _)| joiner.constraint(id));
    of(&dyn_base::DYN_BASE).for_each(|&(id, _)| joiner.effect(id));
}

/// Finds the nodes that are named, each of the type that is wanted there.
fn resolve(
    graph: &Graph,
    links: &Links,
    findings: &mut Findings,
) -> BTreeMap<(NodeId, &'static str), NodeId> {
    let mut resolved = BTreeMap::new();
    for Reference { node, row, name, span } in &links.references {
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

/// Hangs nodes from their parents.
fn hang(
    graph: &mut Graph,
    links: &Links,
    resolved: &BTreeMap<(NodeId, &'static str), NodeId>,
    findings: &mut Findings,
) {
    for reference in &links.references {
        if reference.row == &transform::PARENT.row
            && let Some(&parent) = resolved.get(&(reference.node, reference.row.name))
            && let Err(error) = graph.set_parent(reference.node, parent)
        {
            findings.error(&reference.span, error.to_string());
        }
    }
}

/// Tells meshes what they are blended into.
fn blend(
    graph: &mut Graph,
    links: &Links,
    resolved: &BTreeMap<(NodeId, &'static str), NodeId>,
    source: &Source,
    findings: &mut Findings,
) {
    for reference in links.references.iter().filter(|r| r.row == &surface_shape::BLEND_TARGET.row) {
        let Some(&target) = resolved.get(&(reference.node, reference.row.name)) else { continue };
        if let Err(error) = graph.blend_into(reference.node, target) {
            findings.error(&reference.span, error.to_string());
        }
    }
    for (id, node) in graph.of_type(&surface_shape::SURFACE_SHAPE) {
        let given =
            links.references.iter().any(|r| r.node == id && r.row == &surface_shape::BLEND_TARGET.row);
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

/// Joins nodes to their nuclei.
struct Joiner<'a> {
    graph: &'a mut Graph,
    links: &'a Links,
    /// Attributes that connections made by hand leave from, and those they arrive at.
    ends: [BTreeSet<(NodeId, &'static str)>; 2],
    /// Attributes that name a node.
    named: BTreeSet<(NodeId, &'static str)>,
    /// All nuclei.
    all: Vec<NodeId>,
    resolved: BTreeMap<(NodeId, &'static str), NodeId>,
    source: &'a mut Source,
    findings: &'a mut Findings,
    /// The nucleus of each object so far.
    nuclei: BTreeMap<NodeId, NodeId>,
    /// That there is no nucleus has been said.
    alone: bool,
}

impl Joiner<'_> {
    fn object(&mut self, id: NodeId, node_type: &'static NodeType) {
        let is_particles = node_type.is_a(&n_particle::N_PARTICLE);
        let mesh = self.resolved.get(&(id, n_base::INPUT_MESH.row.name)).copied();
        if mesh.is_none() && !is_particles {
            self.check_mesh(id);
        }
        if is_particles && self.is_left_alone(id) {
            return;
        }
        // Its mesh may be broken: whether there is a nucleus for it can be told all the same.
        let meant = self.named.contains(&(id, n_base::INPUT_MESH.row.name));
        if !is_particles && !meant && self.is_wired(id) {
            return;
        }
        let Some(nucleus) = self.nucleus_of(id) else { return };
        if mesh.is_some() || is_particles {
            self.nuclei.insert(id, nucleus);
            self.create(id, &Creation::Object { mesh: mesh.filter(|_| !is_particles), nucleus });
        }
    }

    /// Whether connections by hand begin or end at a node.
    fn is_wired(&self, id: NodeId) -> bool {
        self.ends.iter().any(|ends| ends.range((id, "")..).next().is_some_and(|(node, _)| *node == id))
    }

    /// Particles have no mesh that would say that they are to be joined: they are, unless they are connected
    /// by hand or belong to no nucleus, `nucleus: ""`.
    fn is_left_alone(&self, id: NodeId) -> bool {
        let mut references = self.links.references.iter();
        self.is_wired(id) || references.any(|r| r.node == id && r.row.name == "nucleus" && r.name.is_empty())
    }

    fn constraint(&mut self, id: NodeId) {
        check_type(self.graph, id, self.source, self.findings);
        let listed = self.graph.node(id).setting(&dynamic_constraint::COMPONENTS).is_some();
        if !listed && self.is_wired(id) {
            return;
        }
        check_components(self.graph, id, self.links, self.source, self.findings);
        if !listed {
            return;
        }
        let components = self.graph.node(id).get(&dynamic_constraint::COMPONENTS);
        let objects: Vec<NodeId> = components
            .iter()
            .filter_map(|component| self.graph.find(&component.object))
            .filter(|object| self.nuclei.contains_key(object))
            .collect();
        let theirs: BTreeSet<NodeId> = objects.iter().map(|object| self.nuclei[object]).collect();
        let theirs: Vec<NodeId> = theirs.into_iter().collect();
        let given = self.given(id);
        let nucleus = match (given, theirs.as_slice()) {
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
        if let Some(stranger) = objects.iter().find(|object| self.nuclei[*object] != nucleus) {
            self.refuse_stranger(id, nucleus, *stranger);
            return;
        }
        self.create(id, &Creation::Constraint { components, nucleus });
    }

    /// Whether the points that a constraint names can be there; says so if not. They are listed one by one afterwards, so a
    /// range is held against its object first.
    fn check_points(&mut self, id: NodeId, components: &[Component]) -> bool {
        let before = self.findings.errors();
        for (k, component) in components.iter().enumerate() {
            let Component { object, selection: Selection::Points { first, last } } = component else {
                continue;
            };
            let place = self.source.place(&format!("{}.components[{k}]", self.graph.node(id).name()));
            let Some(node) = self.graph.find(object) else { continue };
            let mesh = self.resolved.get(&(node, n_base::INPUT_MESH.row.name)).copied();
            let most = max_points(self.graph, self.source, node, mesh);
            if most.is_some_and(|most| u64::from(*last) >= most) {
                self.findings.error(&place, format!("`{object}` has no point {last}")).help(match most {
                    Some(most @ 1..) => format!("its points are numbered 0 to {}", most - 1),
                    _ => "it has no points".to_owned(),
                });
                continue;
            }
            let count = u64::from(last - first) + 1;
            if let Err(refused) = self.source.budget_mut().claim(count.saturating_mul(memory::HELD_POINT)) {
                let error = self.findings.error(&place, format!("to hold {count} points takes {refused}"));
                error.help(refused.help("hold fewer points"));
            }
        }
        self.findings.errors() == before
    }

    fn effect(&mut self, id: NodeId) {
        self.not_solved(id, "fields and emitters are");
        if let Some(&target) = self.resolved.get(&(id, dyn_base::TARGET.row.name)) {
            self.create(id, &Creation::Effect { target });
        }
    }

    fn create(&mut self, id: NodeId, creation: &Creation) {
        if let Err(error) = self.graph.create(id, creation) {
            self.findings.error(&self.source.place(self.graph.node(id).name()), error.to_string());
        }
    }

    fn not_solved(&mut self, id: NodeId, what: &str) {
        let name = self.graph.node(id).name();
        let message = format!("{what} not solved yet: `{name}` does nothing");
        self.findings.warning(&self.source.place(name), message);
    }

    /// The nucleus that is named for a node: nothing if none is, and nothing inside if it is not there.
    fn given(&self, id: NodeId) -> Option<Option<NodeId>> {
        self.named.contains(&(id, "nucleus")).then(|| self.resolved.get(&(id, "nucleus")).copied())
    }

    /// The nucleus that a node belongs to: the one that is named, or the only one.
    fn nucleus_of(&mut self, id: NodeId) -> Option<NodeId> {
        if let Some(given) = self.given(id) {
            return given;
        }
        let name = self.graph.node(id).name();
        let place = self.source.place(name);
        match self.all.as_slice() {
            &[only] => return Some(only),
            [] if self.links.names.values().all(Option::is_some) && !self.alone => {
                self.alone = true;
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

    /// Only what hangs on the same nucleus can be joined.
    fn refuse_stranger(&mut self, constraint: NodeId, nucleus: NodeId, stranger: NodeId) {
        let name = |id: NodeId| self.graph.node(id).name();
        let message = format!(
            "`{}` under `{}` takes hold of `{}` under `{}`",
            name(constraint),
            name(nucleus),
            name(stranger),
            name(self.nuclei[&stranger])
        );
        let place = self.source.place(&format!("{}.components", name(constraint)));
        self.findings.error(&place, message).help("only what belongs to the same nucleus acts on each other");
    }

    /// Cloth and colliders need a mesh.
    fn check_mesh(&mut self, id: NodeId) {
        let given = self.named.contains(&(id, n_base::INPUT_MESH.row.name));
        let name = self.graph.node(id).name();
        let place = self.source.place(name);
        // A value of the wrong type has been reported already.
        let misread = self.source.place(&format!("{name}.{}", n_base::INPUT_MESH.row.name)) != place;
        if !given && !misread && !self.ends[1].contains(&(id, n_base::INPUT_MESH.row.name)) {
            let error = self.findings.error(&place, format!("`{name}` has no `inputMesh`"));
            error.help("add `inputMesh: \"...\"`, the name of a mesh node");
        }
    }
}

/// Says so if constraints of a type do nothing yet.
fn check_type(graph: &Graph, constraint: NodeId, source: &Source, findings: &mut Findings) {
    let node = graph.node(constraint);
    if node.get(&dynamic_constraint::CONSTRAINT_TYPE) != Choice(0) {
        let name = node.name();
        let place = source.place(&format!("{name}.constraintType"));
        findings
            .warning(&place, format!("constraints of this type have no effect yet: `{name}` does nothing"));
    }
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
            Some(&Some(id)) if is_cloth(graph, id) || is_particles(graph, id) => {}
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

fn is_particles(graph: &Graph, node: NodeId) -> bool {
    graph.node(node).node_type().is_a(&n_particle::N_PARTICLE)
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
    let message =
        format!("only points of cloth and particles can be held, but `{object}` is of type {found}");
    let error = findings.error(place, message);
    let mut fed = graph.targets(id, &surface_shape::WORLD_MESH).map(|plug| plug.node);
    if let Some(cloth) = fed.find(|&node| is_cloth(graph, node)) {
        let meant = Component { object: graph.node(cloth).name().to_owned(), ..component.clone() };
        error.did_you_mean(Some(&meant.to_string()));
    }
}
