//! The connections of Maya's creation commands: each object, constraint, field and emitter to its nucleus, mesh and target.

use std::collections::{BTreeMap, BTreeSet};

use crate::attributes::{NodeType, dyn_base, dynamic_constraint, n_base, n_particle, nucleus};
use crate::diagnostic::Findings;
use crate::graph::{Creation, Graph, NodeId, joins_a_nucleus};
use crate::scene::document::Source;

use super::components;
use super::connections::Connections;
use super::references::{self, References, Resolved};

/// Makes the connections of Maya's creation commands, in the order of names: objects first, then constraints, then
/// fields and emitters. Returns the nodes whose nucleus is not known, which has been reported.
pub(super) fn connect(
    graph: &mut Graph,
    references: &References,
    connections: &Connections,
    source: &mut Source,
    findings: &mut Findings,
) -> BTreeSet<NodeId> {
    let resolved = references::resolve(graph, references, source, findings);
    let mut creator = Creator {
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
        without_nucleus: BTreeSet::new(),
    };
    let nodes: Vec<(NodeId, &'static NodeType)> =
        creator.graph.iter().map(|(id, node)| (id, node.node_type())).collect();
    let of = |base: &'static NodeType| nodes.iter().filter(move |(_, node_type)| node_type.is_a(base));
    of(&n_base::N_BASE).for_each(|&(id, node_type)| creator.connect_object(id, node_type));
    of(&dynamic_constraint::DYNAMIC_CONSTRAINT).for_each(|&(id, _)| creator.connect_constraint(id));
    of(&dyn_base::DYN_BASE).for_each(|&(id, _)| creator.connect_effect(id));
    creator.without_nucleus
}

/// Connects nodes to their nuclei.
struct Creator<'a> {
    graph: &'a mut Graph,
    references: &'a References,
    /// Attributes at the output ends of explicit connections, and those at the input ends.
    ends: [BTreeSet<(NodeId, &'static str)>; 2],
    /// Attributes that have a reference.
    named: BTreeSet<(NodeId, &'static str)>,
    /// All nuclei.
    all: Vec<NodeId>,
    resolved: Resolved,
    source: &'a mut Source,
    findings: &'a mut Findings,
    /// The nucleus of each connected object.
    nuclei: BTreeMap<NodeId, NodeId>,
    /// Whether the lack of a nucleus has been reported.
    reported_no_nucleus: bool,
    /// Nodes whose nucleus is not known.
    without_nucleus: BTreeSet<NodeId>,
}

impl Creator<'_> {
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

    /// Whether particles get no implicit connections: they have explicit ones with a nucleus, or none (`nucleus: ""`).
    fn is_left_unconnected(&self, id: NodeId) -> bool {
        let mut references = self.references.all.iter();
        let of_node = |ends: &BTreeSet<(NodeId, &'static str)>| {
            let mut own = ends.range((id, "")..).take_while(|(node, _)| *node == id);
            own.any(|(_, attribute)| joins_a_nucleus(attribute))
        };
        self.ends.iter().any(of_node)
            || references.any(|r| r.node == id && r.row.name == "nucleus" && r.name.is_empty())
    }

    fn connect_constraint(&mut self, id: NodeId) {
        let listed = self.graph.node(id).setting(&dynamic_constraint::COMPONENTS).is_some();
        if !listed && self.has_explicit_connections(id) {
            return;
        }
        components::check(self.graph, id, self.references, self.source, self.findings);
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
        if !components::points_fit(self.graph, &self.resolved, id, self.source, self.findings) {
            return;
        }
        if let Some(foreign) = objects.iter().find(|object| self.nuclei[*object] != nucleus) {
            self.refuse_foreign_object(id, nucleus, *foreign);
            return;
        }
        self.create(id, &Creation::Constraint { components, nucleus });
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
        self.without_nucleus.insert(id);
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
