//! What depends on what: inside a node from its inputs to its outputs, and along connections between nodes.
//!
//! Maya's wiring is full of circles of nodes (a cloth feeds its nucleus, which feeds the cloth), but never of
//! plugs: what a nucleus hands back does not flow into what it is given.

use std::collections::HashSet;

use crate::attributes::{Attribute, NodeType, n_base, n_cloth, n_particle};

use super::node::NodeId;
use super::nodes::Graph;
use super::plug::Plug;

/// Plugs already seen, and those to go on from.
#[derive(Default)]
struct Front {
    seen: HashSet<(NodeId, &'static str, Option<u32>, Option<usize>)>,
    open: Vec<Plug>,
}

impl Front {
    fn add(&mut self, plug: Plug) {
        if self.seen.insert((plug.node, plug.attribute.name, plug.index, plug.part)) {
            self.open.push(plug);
        }
    }
}

impl Graph {
    /// Whether what comes out at `from` depends on what goes in at `to`. Looks from both ends at once, since
    /// one of them is nearly always short.
    pub(super) fn would_circle(&self, from: Plug, to: Plug) -> bool {
        let (mut down, mut up) = (Front::default(), Front::default());
        down.add(to);
        up.add(from);
        loop {
            let Some(plug) = down.open.pop() else { return false };
            if self.runs_into(plug, from) {
                return true;
            }
            self.below(plug).for_each(|next| down.add(next));
            let Some(plug) = up.open.pop() else { return false };
            if self.runs_into(to, plug) {
                return true;
            }
            self.above(plug).for_each(|next| up.add(next));
        }
    }

    /// Whether one plug is the other, or their node works the second out from the first.
    fn runs_into(&self, one: Plug, other: Plug) -> bool {
        let inside = || feeds(self.node(one.node).node_type(), one.attribute, other.attribute);
        one.overlaps(&other) || one.node == other.node && inside()
    }

    /// What a plug flows into directly.
    fn below(&self, plug: Plug) -> impl Iterator<Item = Plug> {
        let node_type = self.node(plug.node).node_type();
        self.leaving(plug.node).filter_map(move |connection| {
            if connection.from.overlaps(&plug) {
                Some(connection.to)
            } else if feeds(node_type, plug.attribute, connection.from.attribute) {
                Some(connection.from)
            } else {
                None
            }
        })
    }

    /// What flows into a plug directly.
    fn above(&self, plug: Plug) -> impl Iterator<Item = Plug> {
        let node_type = self.node(plug.node).node_type();
        self.arriving(plug.node).filter_map(move |connection| {
            if connection.to.overlaps(&plug) {
                Some(connection.from)
            } else if feeds(node_type, connection.to.attribute, plug.attribute) {
                Some(connection.to)
            } else {
                None
            }
        })
    }
}

/// Whether a node works an output out from an input. What can be connected on both sides only hands on what
/// it is given itself.
fn feeds(node_type: &'static NodeType, input: &Attribute, output: &Attribute) -> bool {
    if output.writable || !input.writable {
        return false;
    }
    if !node_type.is_a(&n_base::N_BASE) {
        return true;
    }
    let back = input.name == n_base::NEXT_STATE.row.name;
    match output.name {
        // What the nucleus is told does not wait for what it answers.
        "currentState" | "startState" => !back,
        name if name == n_cloth::OUTPUT_MESH.row.name || name == n_particle::OUT_MESH.row.name => {
            back || input.name == n_base::INPUT_MESH.row.name
        }
        name if name == n_cloth::OUTPUT_START_MESH.row.name => !back,
        // Everything else is as the evaluation before has left it.
        _ => false,
    }
}
