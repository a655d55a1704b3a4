//! Values at a frame, pulled along connections: nothing is worked out that nobody asks for.
//!
//! An input holds what its source holds, read as what the input is: numbers, switches and words are one to
//! the other what they are in Maya. What has no source holds what is set on it.

use std::cell::RefCell;
use std::collections::{HashMap, HashSet};

use crate::animation::Affine;
use crate::attributes::{Attribute, FromValue, Key, Kind, Value, nucleus, time};

use super::node::{Node, NodeId};
use super::nodes::Graph;
use super::plug::{Connection, Plug};
use super::setting::{Setting, as_kind};

/// A graph at one frame.
pub struct Moment<'g> {
    graph: &'g Graph,
    frame: f64,
    placements: RefCell<HashMap<NodeId, Affine>>,
    pulled: RefCell<(HashSet<NodeId>, Vec<NodeId>)>,
}

impl Graph {
    /// The graph at a frame, which may be broken.
    pub fn at(&self, frame: f64) -> Moment<'_> {
        Moment { graph: self, frame, placements: RefCell::default(), pulled: RefCell::default() }
    }

    /// Whether an attribute ever changes, by keys of its own or of what feeds it.
    pub fn changes<T>(&self, node: NodeId, key: &Key<T>) -> bool {
        let changes = |node: NodeId, row: &Attribute| {
            self.node(node).set_or_preset(row.name).is_some_and(Setting::changes)
        };
        let row = self.node(node).node_type().attribute(key.row.name);
        row.is_some_and(|row| self.anywhere_above(node, row, &changes))
    }

    /// Whether anything is set on an attribute, here or by a preset, or connected to it.
    pub fn is_given<T>(&self, node: NodeId, key: &Key<T>) -> bool {
        self.is_given_by_name(node, key.row.name)
    }

    /// The same by long name.
    pub(crate) fn is_given_by_name(&self, node: NodeId, name: &str) -> bool {
        self.node(node).set_or_preset(name).is_some() || self.sources(node, name).next().is_some()
    }

    /// Whether a number can ever be other than zero.
    pub fn is_ever_nonzero<T>(&self, node: NodeId, key: &Key<T>) -> bool {
        let fed = self.sources(node, key.row.name).next().is_some();
        fed || self.node(node).is_ever_nonzero(key)
    }

    /// Whether something holds for an attribute or for any that feeds it. The clock always changes.
    fn anywhere_above(
        &self,
        node: NodeId,
        row: &'static Attribute,
        holds: &dyn Fn(NodeId, &Attribute) -> bool,
    ) -> bool {
        let mut open = vec![(node, row)];
        while let Some((node, row)) = open.pop() {
            if holds(node, row) || row == &time::OUT_TIME.row {
                return true;
            }
            open.extend(self.sources(node, row.name).map(|wire| (wire.from.node, wire.from.attribute)));
        }
        false
    }

    /// Connections that arrive at an attribute, or at parts of it.
    pub(super) fn sources(&self, node: NodeId, name: &str) -> impl Iterator<Item = &Connection> {
        self.arriving(node).filter(move |wire| wire.to.attribute.name == name)
    }
}

impl<'g> Moment<'g> {
    /// The frame.
    pub fn frame(&self) -> f64 {
        self.frame
    }

    /// The value of an attribute: its source's, else what is set, else the default of the nearest row.
    pub fn get<T: FromValue>(&self, node: NodeId, key: &Key<T>) -> T {
        self.note(node);
        let own = self.graph.node(node);
        if self.graph.sources(node, key.row.name).next().is_none() {
            return own.at(key, self.frame);
        }
        let value = own.node_type().attribute(key.row.name).and_then(|row| self.fed(own, node, row));
        value.as_ref().and_then(T::from_value).unwrap_or_else(|| own.at(key, self.frame))
    }

    /// What carries points of a node into the world. Lengths in scene units.
    pub fn placement(&self, node: NodeId) -> Affine {
        let mut above = Vec::new();
        let mut known = Affine::identity();
        for ancestor in self.graph.and_ancestors(node) {
            if let Some(affine) = self.placements.borrow().get(&ancestor) {
                known = *affine;
                break;
            }
            above.push(ancestor);
        }
        for ancestor in above.into_iter().rev() {
            let own = self.transform(ancestor).affine();
            known = if self.graph.node(ancestor).parent().is_some() { own.under(&known) } else { own };
            self.placements.borrow_mut().insert(ancestor, known);
        }
        known
    }

    /// Nodes of which something was asked, in the order in which that began.
    pub fn pulled(&self) -> Vec<NodeId> {
        self.pulled.borrow().1.clone()
    }

    fn note(&self, node: NodeId) {
        let (seen, order) = &mut *self.pulled.borrow_mut();
        if seen.insert(node) {
            order.push(node);
        }
    }

    /// What an attribute holds, whatever it is: its source's, else its own; nothing for what is only connected.
    pub fn held<T>(&self, node: NodeId, key: &Key<T>) -> Option<Value> {
        self.note(node);
        let own = self.graph.node(node);
        let row = own.node_type().attribute(key.row.name)?;
        match self.graph.sources(node, row.name).next() {
            Some(_) => self.fed(own, node, row),
            None => own.value_at(row, self.frame),
        }
    }

    /// The value of an attribute that something is connected to.
    fn fed(&self, own: &Node, node: NodeId, row: &'static Attribute) -> Option<Value> {
        match row.kind {
            Kind::Bool | Kind::Int | Kind::Float | Kind::Texture | Kind::Choice(_) => {
                Some(as_kind(self.number(node, row, None), row))
            }
            Kind::Vector(_) => Some(Value::Vector([0, 1, 2].map(|part| self.number(node, row, Some(part))))),
            _ => {
                let mut last = Plug { node, attribute: row, index: None, part: None };
                while let Some(wire) = self.graph.sources(last.node, last.attribute.name).next() {
                    last = wire.from;
                }
                self.note(last.node);
                let held = self.graph.node(last.node).value_at(last.attribute, self.frame);
                held.filter(|value| row.kind.admits(value)).or_else(|| own.value_at(row, self.frame))
            }
        }
    }

    /// A number, or a part of a vector, from where its chain of connections begins.
    fn number(&self, node: NodeId, row: &'static Attribute, part: Option<usize>) -> f64 {
        let mut way = vec![(node, row, part)];
        let mut number = loop {
            let &(node, row, part) = &way[way.len() - 1];
            let feeds = |wire: &&Connection| wire.to.part.is_none() || wire.to.part == part;
            let Some(wire) = self.graph.sources(node, row.name).find(feeds) else {
                break self.own_number(node, row, part);
            };
            let from = wire.from;
            way.push((from.node, from.attribute, from.part.or(part.filter(|_| wire.to.part.is_none()))));
        };
        // On its way it is each time what the attribute can hold.
        for (_, row, _) in way.into_iter().rev() {
            number = match as_kind(number, row) {
                Value::Bool(on) => f64::from(u8::from(on)),
                Value::Int(x) => x as f64,
                Value::Choice(choice) => f64::from(choice.0),
                Value::Float(x) => x,
                _ => row.range.clamp(number),
            };
        }
        number
    }

    /// What an attribute without a source holds.
    fn own_number(&self, node: NodeId, row: &'static Attribute, part: Option<usize>) -> f64 {
        self.note(node);
        if row == &time::OUT_TIME.row {
            return self.frame;
        }
        let own = self.graph.node(node);
        if row == &nucleus::START_TIME.row {
            return own.at(&nucleus::START_FRAME, self.frame);
        }
        match (own.value_at(row, self.frame), part) {
            (Some(Value::Vector(vector)), Some(part)) => vector[part],
            (Some(Value::Float(x)), _) => x,
            (Some(Value::Int(x)), _) => x as f64,
            (Some(Value::Bool(on)), _) => f64::from(u8::from(on)),
            (Some(Value::Choice(choice)), _) => f64::from(choice.0),
            _ => 0.0,
        }
    }
}
