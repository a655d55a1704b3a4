//! The short form of a graph: connections that a scene file leaves out, because reading makes them again.
//!
//! A node is written in short form (`inputMesh`, `components` ...) if its creation command, run again in the order of
//! names, gives the same connections and nodes. All other connections are written one by one.

use std::collections::{BTreeMap, BTreeSet};

use crate::attributes::{dyn_base, n_base, n_particle, nucleus};
use crate::graph::{Connection, Creation, Graph, NodeId, joins_a_nucleus};

/// The short form of a graph.
pub(super) struct ShortForm {
    /// Nodes in short form, with the arguments of their creation commands.
    creations: BTreeMap<NodeId, Creation>,
    /// Nodes that those creation commands make.
    created: BTreeSet<NodeId>,
    clock: NodeId,
    /// Connections to write, by their plugs.
    pub(super) explicit: Vec<[String; 2]>,
    /// Whether nodes have to name their nucleus.
    needs_nucleus_name: bool,
}

impl ShortForm {
    /// Starts with all nodes that have a creation, and takes out those that reading would connect differently, until
    /// none is left.
    pub(super) fn of(graph: &Graph) -> Self {
        let of_type = |id: NodeId| graph.creation(id).map(|creation| (id, creation));
        let mut creations: BTreeMap<NodeId, Creation> =
            graph.iter().filter_map(|(id, _)| of_type(id)).collect();
        loop {
            let (recreated, done) = recreate(graph, &creations);
            let mut different = different(graph, &recreated, &creations, &done);
            let short = Self::new(graph, creations, &recreated);
            different.extend(short.particles_joined_explicitly(graph));
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

    /// Whether a node is written: not the clock, nor a node that a creation command makes.
    pub(super) fn is_written(&self, id: NodeId) -> bool {
        !self.created.contains(&id) && id != self.clock
    }

    /// Whether an object of this name has an explicit connection with a nucleus.
    pub(super) fn joins_a_nucleus_explicitly(&self, name: &str) -> bool {
        let attributes = self.explicit.iter().flatten().filter_map(|plug| plug.split_once('.'));
        let mut own = attributes.filter(|(node, _)| *node == name);
        own.any(|(_, attribute)| joins_a_nucleus(attribute.split('[').next().unwrap_or_default()))
    }

    /// Particles in short form that an explicit connection joins to a nucleus: reading would make no other.
    fn particles_joined_explicitly(&self, graph: &Graph) -> Vec<NodeId> {
        let is_particles = |id: NodeId| graph.node(id).node_type().is_a(&n_particle::N_PARTICLE);
        let joined = self.creations.keys().copied().filter(|&id| is_particles(id));
        joined.filter(|&id| self.joins_a_nucleus_explicitly(graph.node(id).name())).collect()
    }

    /// Whether a node is an object in short form.
    pub(super) fn is_object(&self, id: NodeId) -> bool {
        matches!(self.creations.get(&id), Some(Creation::Object { .. }))
    }

    /// Whether a node has the connections of a creation command, but is not in short form.
    pub(super) fn is_connected_explicitly(&self, graph: &Graph, id: NodeId) -> bool {
        !self.creations.contains_key(&id) && graph.creation(id).is_some()
    }

    /// The node that an attribute names in short form.
    pub(super) fn named(&self, id: NodeId, attribute: &str) -> Option<NodeId> {
        match (self.creations.get(&id)?, attribute) {
            (Creation::Object { mesh, .. }, name) if name == n_base::INPUT_MESH.row.name => *mesh,
            (Creation::Object { nucleus, .. } | Creation::Constraint { nucleus, .. }, "nucleus") => {
                self.needs_nucleus_name.then_some(*nucleus)
            }
            (Creation::Effect { target }, name) if name == dyn_base::TARGET.row.name => Some(*target),
            _ => None,
        }
    }
}

/// A graph of the same nodes, connected as by reading: nodes in the order of names, then objects, constraints and
/// effects. Also returns the nodes whose creation succeeded.
fn recreate(graph: &Graph, creations: &BTreeMap<NodeId, Creation>) -> (Graph, BTreeSet<NodeId>) {
    let is_created = |id: NodeId| graph.node(id).created_by().is_some_and(|by| creations.contains_key(&by));
    let mut nodes: Vec<_> = graph.iter().filter(|(id, _)| !is_created(*id)).collect();
    nodes.sort_by_key(|(_, node)| node.name());
    let (mut recreated, mut done) = (Graph::new(), BTreeSet::new());
    for (_, node) in &nodes {
        // The clock is there already.
        let Ok(twin) = recreated.add(node.name(), node.node_type()) else { continue };
        // A nucleus with a time of its own is not connected to the clock.
        if node.node_type().is_a(&nucleus::NUCLEUS)
            && let Some(time) = node.setting(&nucleus::CURRENT_TIME)
        {
            let _ = recreated.set(twin, &nucleus::CURRENT_TIME.row, time.clone());
        }
    }
    let there = |recreated: &Graph, id: NodeId| recreated.find(graph.node(id).name());
    for (id, _) in &nodes {
        if let (Some(cloth), Some(mesh)) =
            (there(&recreated, *id), graph.rest_shape(*id).and_then(|mesh| there(&recreated, mesh)))
        {
            // The nodes are new, so nothing is connected yet.
            let _ = recreated.set_rest_shape(cloth, mesh);
        }
    }
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

/// Nodes whose recreation gives other connections or nodes than the graph has.
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
        // A creation also connects the clock to its nucleus, and the graph may lack that connection.
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

/// The nucleus of an object or a constraint.
fn nucleus_of(creation: &Creation) -> Option<NodeId> {
    match creation {
        Creation::Object { nucleus, .. } | Creation::Constraint { nucleus, .. } => Some(*nucleus),
        Creation::Effect { .. } => None,
    }
}

fn plugs(graph: &Graph, wire: &Connection) -> [String; 2] {
    [graph.describe(wire.from), graph.describe(wire.to)]
}
