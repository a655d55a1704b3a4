//! Pairs that already were inside each other at the start, and what becomes of them.
//!
//! Such a tangle moves over the meshes: an edge leaves one face and enters the next. Nobody is to blame for that,
//! so events that carry a tangle on are told apart from those that begin one.

use std::collections::HashSet;

use crate::event::{Event, Overlapping, Pair};
use crate::world::{EdgeId, FaceId, World};

/// Edges inside faces since the start, each pair until it has come apart.
#[derive(Debug, Default)]
pub struct Tangle {
    inside: HashSet<(EdgeId, FaceId)>,
}

impl Tangle {
    /// What is inside each other at the start.
    pub fn new(start: &[Overlapping]) -> Self {
        Self { inside: start.iter().map(|found| (found.edge, found.face)).collect() }
    }

    /// Adds what is to be treated like that.
    pub fn add(&mut self, found: &[Overlapping]) {
        self.inside.extend(found.iter().map(|found| (found.edge, found.face)));
    }

    /// Pairs that have not come apart yet.
    pub fn len(&self) -> usize {
        self.inside.len()
    }

    /// Whether all have come apart.
    pub fn is_empty(&self) -> bool {
        self.inside.is_empty()
    }

    /// Takes out of `events` those that carry a tangle on, and returns where it may have come to.
    pub fn take(&self, world: &World, events: &mut Vec<Event>) -> Reach {
        let mut reach = Reach::default();
        if self.inside.is_empty() {
            return reach;
        }
        self.inside.iter().for_each(|&(edge, face)| reach.add(world, edge, face));
        // One motion may carry it over several elements, in an order that the list of events does not have.
        loop {
            let before = events.len();
            events.retain(|event| !reach.has(event.pair) || !reach.follow(world, event.pair));
            if events.len() == before {
                return reach;
            }
            reach.taken += (before - events.len()) as u64;
        }
    }

    /// Forgets what has come apart and takes up what is new, as far as the tangle reached.
    pub fn settle(&mut self, reach: &Reach, now: &[Overlapping]) {
        let pairs = now.iter().map(|found| (found.edge, found.face));
        self.inside = pairs.filter(|pair| reach.inside.contains(pair)).collect();
    }

    /// Whether a pair belongs to it.
    pub fn has(&self, found: &Overlapping) -> bool {
        self.inside.contains(&(found.edge, found.face))
    }
}

/// Where a tangle may have come to in one motion.
#[derive(Debug, Default)]
pub struct Reach {
    inside: HashSet<(EdgeId, FaceId)>,
    events: HashSet<Pair>,
    /// Events that carried it on.
    pub taken: u64,
}

impl Reach {
    /// An edge may be inside a face: it gets out over its ends or over the face's sides.
    fn add(&mut self, world: &World, edge: EdgeId, face: FaceId) {
        if !self.inside.insert((edge, face)) {
            return;
        }
        let ends = world.edges()[edge.0 as usize];
        self.events.extend(ends.map(|point| Pair::PointFace(point, face)));
        self.events.extend(world.sides(face).map(|side| Pair::EdgeEdge(edge.min(side), edge.max(side))));
    }

    fn has(&self, pair: Pair) -> bool {
        self.events.contains(&pair)
    }

    /// What an event leads to. Always true, for it has been taken.
    fn follow(&mut self, world: &World, pair: Pair) -> bool {
        match pair {
            Pair::PointFace(point, face) => {
                world.edges_at(point).for_each(|edge| self.add(world, edge, face))
            }
            Pair::EdgeEdge(a, b) => {
                world.faces_at(b).for_each(|face| self.add(world, a, face));
                world.faces_at(a).for_each(|face| self.add(world, b, face));
            }
        }
        true
    }
}
