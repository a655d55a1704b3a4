//! Which connections a scene need not write, because reading makes them recreated.
//!
//! What a creation command has made is written in short (`inputMesh`, `components` ...) if doing the same recreated,
//! in the order of names, gives the same. Everything else is written as it is, connection by connection.

use std::collections::{BTreeMap, BTreeSet};

use crate::attributes::{dyn_base, n_base, n_particle, nucleus};
use crate::graph::{Connection, Creation, Graph, NodeId};

/// How a graph is written in short.
pub(super) struct ShortForm {
    /// Nodes whose connections are made recreated from a few names.
    creations: BTreeMap<NodeId, Creation>,
    /// Nodes that are made recreated with them.
    created: BTreeSet<NodeId>,
    clock: NodeId,
    /// Connections that have to be written, by their plugs.
    pub(super) explicit: Vec<[String; 2]>,
    /// Whether a node has to say to which nucleus it belongs.
    needs_nucleus_name: bool,
}

impl ShortForm {
    /// The shortest form that is found.
    pub(super) fn of(graph: &Graph) -> Self {
        let of_type = |id: NodeId| graph.creation(id).map(|creation| (id, creation));
        let mut creations: BTreeMap<NodeId, Creation> =
            graph.iter().filter_map(|(id, _)| of_type(id)).collect();
        loop {
            let (recreated, done) = recreate(graph, &creations);
            let mut different = different(graph, &recreated, &creations, &done);
            let short = Self::new(graph, creations, &recreated);
            different.extend(short.particles_with_explicit_connections(graph));
            if different.is_empty() {
                return short;
            }
            creations = short.creations;
            creations.retain(|id, _| !different.contains(id));
        }
    }

    fn new(graph: &Graph, creations: BTreeMap<NodeId, Creation>, recreated: &Graph) -> Self {
        let is_created =
            |id: NodeId| graph.node(id).created_by().is_some_and(|by| creations.contains_key(&by));
        let created = graph.iter().map(|(id, _)| id).filter(|id| is_created(*id)).collect();
        let known: BTreeSet<[String; 2]> =
            recreated.connections().map(|wire| plugs(recreated, wire)).collect();
        let all: BTreeSet<[String; 2]> = graph.connections().map(|wire| plugs(graph, wire)).collect();
        let needs_nucleus_name = graph.of_type(&nucleus::NUCLEUS).count() > 1;
        Self {
            creations,
            created,
            clock: graph.clock(),
            explicit: all.difference(&known).cloned().collect(),
            needs_nucleus_name,
        }
    }

    /// Whether a node is written at all.
    pub(super) fn is_written(&self, id: NodeId) -> bool {
        !self.created.contains(&id) && id != self.clock
    }

    /// Whether a connection that has to be written begins or ends at a node of this name.
    pub(super) fn has_explicit_connections(&self, name: &str) -> bool {
        let mut plugs = self.explicit.iter().flatten();
        plugs.any(|plug| plug.split('.').next() == Some(name))
    }

    /// Particles that reading does not join to a nucleus, because a connection by hand begins or ends at them.
    fn particles_with_explicit_connections(&self, graph: &Graph) -> Vec<NodeId> {
        let is_particles = |id: NodeId| graph.node(id).node_type().is_a(&n_particle::N_PARTICLE);
        let joined = self.creations.keys().copied().filter(|&id| is_particles(id));
        joined.filter(|&id| self.has_explicit_connections(graph.node(id).name())).collect()
    }

    /// The node that an attribute names; as `joined` its nucleus, whether that has to be written or not.
    pub(super) fn named(&self, id: NodeId, attribute: &str) -> Option<NodeId> {
        match (self.creations.get(&id)?, attribute) {
            (Creation::Object { mesh, .. }, name) if name == n_base::INPUT_MESH.row.name => *mesh,
            (Creation::Object { nucleus, .. } | Creation::Constraint { nucleus, .. }, "nucleus") => {
                self.needs_nucleus_name.then_some(*nucleus)
            }
            (Creation::Object { nucleus, .. }, "joined") => Some(*nucleus),
            (Creation::Effect { target }, name) if name == dyn_base::TARGET.row.name => Some(*target),
            _ => None,
        }
    }
}

/// A graph of the same names that is created anew, as reading does it: nodes in the order of names, then
/// objects, constraints and effects. Also those that could be created.
fn recreate(graph: &Graph, creations: &BTreeMap<NodeId, Creation>) -> (Graph, BTreeSet<NodeId>) {
    let is_created = |id: NodeId| graph.node(id).created_by().is_some_and(|by| creations.contains_key(&by));
    let mut nodes: Vec<_> = graph.iter().filter(|(id, _)| !is_created(*id)).collect();
    nodes.sort_by_key(|(_, node)| node.name());
    let (mut recreated, mut done) = (Graph::new(), BTreeSet::new());
    for (_, node) in &nodes {
        // The clock is there already.
        let _ = recreated.add(node.name(), node.node_type());
    }
    let there = |recreated: &Graph, id: NodeId| recreated.find(graph.node(id).name());
    let stage = |creation: &Creation| match creation {
        Creation::Object { .. } => 0,
        Creation::Constraint { .. } => 1,
        Creation::Effect { .. } => 2,
    };
    for now in 0..3 {
        for (id, _) in &nodes {
            let Some(creation) = creations.get(id).filter(|creation| stage(creation) == now) else {
                continue;
            };
            let creation = match creation {
                Creation::Object { mesh, nucleus } => there(&recreated, *nucleus).map(|nucleus| {
                    let mesh = mesh.and_then(|mesh| there(&recreated, mesh));
                    Creation::Object { mesh, nucleus }
                }),
                Creation::Constraint { components, nucleus } => there(&recreated, *nucleus)
                    .map(|nucleus| Creation::Constraint { components: components.clone(), nucleus }),
                Creation::Effect { target } => {
                    there(&recreated, *target).map(|target| Creation::Effect { target })
                }
            };
            if let (Some(twin), Some(creation)) = (there(&recreated, *id), creation)
                && recreated.create(twin, &creation).is_ok()
            {
                done.insert(*id);
            }
        }
    }
    (recreated, done)
}

/// Nodes whose creation, done recreated, does not give what is there.
fn different(
    graph: &Graph,
    recreated: &Graph,
    creations: &BTreeMap<NodeId, Creation>,
    done: &BTreeSet<NodeId>,
) -> BTreeSet<NodeId> {
    let there: BTreeSet<[String; 2]> = graph.connections().map(|wire| plugs(graph, wire)).collect();
    let mut different = BTreeSet::new();
    for (&id, creation) in creations {
        let created_for = |graph: &Graph, by: &str| {
            let by = graph.find(by);
            graph
                .iter()
                .filter(|(_, node)| node.created_by().is_some() && node.created_by() == by)
                .map(|(id, _)| id)
                .collect::<Vec<_>>()
        };
        let name = graph.node(id).name();
        let Some(twin) = recreated.find(name) else { continue };
        let mut own = created_for(recreated, name);
        let same = own.len() == created_for(graph, name).len()
            && own.iter().all(|own| {
                let own = recreated.node(*own);
                graph.find(own.name()).map(|id| graph.node(id)).is_some_and(|other| {
                    other.created_by() == Some(id)
                        && other.node_type() == own.node_type()
                        && other.settings() == own.settings()
                        && other.parent().is_none()
                })
            });
        own.push(twin);
        let wires = own.iter().flat_map(|node| recreated.arriving(*node).chain(recreated.leaving(*node)));
        // A creation also gives its nucleus the clock, which the graph may have taken away.
        let clock = nucleus_of(creation).and_then(|id| recreated.find(graph.node(id).name())).into_iter();
        let clock = clock
            .flat_map(|nucleus| recreated.arriving(nucleus))
            .filter(|wire| wire.from.node == recreated.clock());
        let wired = wires.chain(clock).all(|wire| there.contains(&plugs(recreated, wire)));
        if !same || !wired || !done.contains(&id) {
            different.insert(id);
        }
    }
    different
}

/// The nucleus that an object or a constraint joins.
fn nucleus_of(creation: &Creation) -> Option<NodeId> {
    match creation {
        Creation::Object { nucleus, .. } | Creation::Constraint { nucleus, .. } => Some(*nucleus),
        Creation::Effect { .. } => None,
    }
}

fn plugs(graph: &Graph, wire: &Connection) -> [String; 2] {
    [graph.describe(wire.from), graph.describe(wire.to)]
}
