//! Which connections a scene need not write, because reading makes them again.
//!
//! What a creation command has made is written in short (`inputMesh`, `components` ...) if doing the same again,
//! in the order of names, gives the same. Everything else is written as it is, connection by connection.

use std::collections::{BTreeMap, BTreeSet};

use crate::attributes::{dyn_base, n_base, n_particle, nucleus};
use crate::graph::{Connection, Creation, Graph, NodeId};

/// How a graph is written in short.
pub(super) struct ShortForm {
    /// Nodes whose connections are made again from a few names.
    creations: BTreeMap<NodeId, Creation>,
    /// Nodes that are made again with them.
    made: BTreeSet<NodeId>,
    clock: NodeId,
    /// Connections that have to be written, by their plugs.
    pub(super) by_hand: Vec<[String; 2]>,
    /// Whether a node has to say to which nucleus it belongs.
    names_nucleus: bool,
}

impl ShortForm {
    /// The shortest form that is found.
    pub(super) fn of(graph: &Graph) -> Self {
        let of_type = |id: NodeId| graph.creation(id).map(|creation| (id, creation));
        let mut creations: BTreeMap<NodeId, Creation> =
            graph.iter().filter_map(|(id, _)| of_type(id)).collect();
        loop {
            let (again, done) = again(graph, &creations);
            let mut odd = odd(graph, &again, &creations, &done);
            let short = Self::new(graph, creations, &again);
            odd.extend(short.particles_wired_by_hand(graph));
            if odd.is_empty() {
                return short;
            }
            creations = short.creations;
            creations.retain(|id, _| !odd.contains(id));
        }
    }

    fn new(graph: &Graph, creations: BTreeMap<NodeId, Creation>, again: &Graph) -> Self {
        let is_made = |id: NodeId| graph.node(id).created_by().is_some_and(|by| creations.contains_key(&by));
        let made = graph.iter().map(|(id, _)| id).filter(|id| is_made(*id)).collect();
        let known: BTreeSet<[String; 2]> = again.connections().map(|wire| plugs(again, wire)).collect();
        let all: BTreeSet<[String; 2]> = graph.connections().map(|wire| plugs(graph, wire)).collect();
        let names_nucleus = graph.of_type(&nucleus::NUCLEUS).count() > 1;
        Self {
            creations,
            made,
            clock: graph.clock(),
            by_hand: all.difference(&known).cloned().collect(),
            names_nucleus,
        }
    }

    /// Whether a node is written at all.
    pub(super) fn is_written(&self, id: NodeId) -> bool {
        !self.made.contains(&id) && id != self.clock
    }

    /// Whether a connection that has to be written begins or ends at a node of this name.
    pub(super) fn is_wired(&self, name: &str) -> bool {
        let mut plugs = self.by_hand.iter().flatten();
        plugs.any(|plug| plug.split('.').next() == Some(name))
    }

    /// Particles that reading does not join to a nucleus, because a connection by hand begins or ends at them.
    fn particles_wired_by_hand(&self, graph: &Graph) -> Vec<NodeId> {
        let is_particles = |id: NodeId| graph.node(id).node_type().is_a(&n_particle::N_PARTICLE);
        let joined = self.creations.keys().copied().filter(|&id| is_particles(id));
        joined.filter(|&id| self.is_wired(graph.node(id).name())).collect()
    }

    /// The node that an attribute names; as `joined` its nucleus, whether that has to be written or not.
    pub(super) fn names(&self, id: NodeId, attribute: &str) -> Option<NodeId> {
        match (self.creations.get(&id)?, attribute) {
            (Creation::Object { mesh, .. }, name) if name == n_base::INPUT_MESH.row.name => *mesh,
            (Creation::Object { nucleus, .. } | Creation::Constraint { nucleus, .. }, "nucleus") => {
                self.names_nucleus.then_some(*nucleus)
            }
            (Creation::Object { nucleus, .. }, "joined") => Some(*nucleus),
            (Creation::Effect { target }, name) if name == dyn_base::TARGET.row.name => Some(*target),
            _ => None,
        }
    }
}

/// A graph of the same names that is created anew, as reading does it: nodes in the order of names, then
/// objects, constraints and effects. Also those that could be created.
fn again(graph: &Graph, creations: &BTreeMap<NodeId, Creation>) -> (Graph, BTreeSet<NodeId>) {
    let is_made = |id: NodeId| graph.node(id).created_by().is_some_and(|by| creations.contains_key(&by));
    let mut nodes: Vec<_> = graph.iter().filter(|(id, _)| !is_made(*id)).collect();
    nodes.sort_by_key(|(_, node)| node.name());
    let (mut again, mut done) = (Graph::new(), BTreeSet::new());
    for (_, node) in &nodes {
        // The clock is there already.
        let _ = again.add(node.name(), node.node_type());
    }
    let there = |again: &Graph, id: NodeId| again.find(graph.node(id).name());
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
                Creation::Object { mesh, nucleus } => there(&again, *nucleus).map(|nucleus| {
                    let mesh = mesh.and_then(|mesh| there(&again, mesh));
                    Creation::Object { mesh, nucleus }
                }),
                Creation::Constraint { components, nucleus } => there(&again, *nucleus)
                    .map(|nucleus| Creation::Constraint { components: components.clone(), nucleus }),
                Creation::Effect { target } => {
                    there(&again, *target).map(|target| Creation::Effect { target })
                }
            };
            if let (Some(twin), Some(creation)) = (there(&again, *id), creation)
                && again.create(twin, &creation).is_ok()
            {
                done.insert(*id);
            }
        }
    }
    (again, done)
}

/// Nodes whose creation, done again, does not give what is there.
fn odd(
    graph: &Graph,
    again: &Graph,
    creations: &BTreeMap<NodeId, Creation>,
    done: &BTreeSet<NodeId>,
) -> BTreeSet<NodeId> {
    let there: BTreeSet<[String; 2]> = graph.connections().map(|wire| plugs(graph, wire)).collect();
    let mut odd = BTreeSet::new();
    for (&id, creation) in creations {
        let made = |graph: &Graph, by: &str| {
            let by = graph.find(by);
            graph
                .iter()
                .filter(|(_, node)| node.created_by().is_some() && node.created_by() == by)
                .map(|(id, _)| id)
                .collect::<Vec<_>>()
        };
        let name = graph.node(id).name();
        let Some(twin) = again.find(name) else { continue };
        let mut own = made(again, name);
        let same = own.len() == made(graph, name).len()
            && own.iter().all(|own| {
                let own = again.node(*own);
                graph.find(own.name()).map(|id| graph.node(id)).is_some_and(|other| {
                    other.created_by() == Some(id)
                        && other.node_type() == own.node_type()
                        && other.settings() == own.settings()
                        && other.parent().is_none()
                })
            });
        own.push(twin);
        let wires = own.iter().flat_map(|node| again.arriving(*node).chain(again.leaving(*node)));
        // A creation also gives its nucleus the clock, which the graph may have taken away.
        let clock = nucleus_of(creation).and_then(|id| again.find(graph.node(id).name())).into_iter();
        let clock =
            clock.flat_map(|nucleus| again.arriving(nucleus)).filter(|wire| wire.from.node == again.clock());
        let wired = wires.chain(clock).all(|wire| there.contains(&plugs(again, wire)));
        if !same || !wired || !done.contains(&id) {
            odd.insert(id);
        }
    }
    odd
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
