//! Values and placements at a frame, pulled along connections: only plugs that are asked for are evaluated.
//!
//! A connected input has the value of its source, converted to the kind of the input as in Maya (numbers, switches
//! and words). An input without a source has the value of its setting.

use std::cell::RefCell;
use std::collections::{HashMap, HashSet};

use nalgebra::Vector3;

use crate::animation::{Affine, Transform};
use crate::attributes::{Attribute, FromValue, Key, Kind, Value, nucleus, time, transform};

use super::node::{Connection, Node, NodeId, Plug};
use super::nodes::Graph;
use super::setting::{Setting, as_kind};

/// Axes by Maya's index of `rotateOrder`: xyz, yzx, zxy, xzy, yxz, zyx.
const ORDERS: [[usize; 3]; 6] = [[0, 1, 2], [1, 2, 0], [2, 0, 1], [0, 2, 1], [1, 0, 2], [2, 1, 0]];

/// Evaluates a graph at one frame. Placements are cached.
pub struct EvalContext<'g> {
    graph: &'g Graph,
    frame: f64,
    placements: RefCell<HashMap<NodeId, Affine>>,
    /// The evaluated nodes, as a set and in order, where they are recorded.
    pulled: Option<RefCell<(HashSet<NodeId>, Vec<NodeId>)>>,
}

impl Graph {
    /// The graph at a frame; a fraction is a time between frames.
    pub fn at(&self, frame: f64) -> EvalContext<'_> {
        EvalContext { graph: self, frame, placements: RefCell::default(), pulled: None }
    }

    /// The same, with a record of the evaluated nodes.
    pub(crate) fn recorded_at(&self, frame: f64) -> EvalContext<'_> {
        EvalContext { pulled: Some(RefCell::default()), ..self.at(frame) }
    }

    /// Whether an attribute changes over time, by its own keys or those of a source.
    pub fn changes<T>(&self, node: NodeId, key: &Key<T>) -> bool {
        let changes = |node: NodeId, row: &Attribute| {
            self.node(node).set_or_preset(row.name).is_some_and(Setting::changes)
        };
        let row = self.node(node).node_type().attribute(key.row.name);
        row.is_some_and(|row| self.any_upstream(node, row, &changes))
    }

    /// Whether an attribute has a setting, from the node or its preset, or a connection.
    pub fn is_given<T>(&self, node: NodeId, key: &Key<T>) -> bool {
        self.is_given_by_name(node, key.row.name)
    }

    /// The same by long name.
    pub(crate) fn is_given_by_name(&self, node: NodeId, name: &'static str) -> bool {
        self.node(node).set_or_preset(name).is_some() || self.sources(node, name).next().is_some()
    }

    /// Whether a number can be nonzero at any frame.
    pub fn is_ever_nonzero<T>(&self, node: NodeId, key: &Key<T>) -> bool {
        let fed = self.sources(node, key.row.name).next().is_some();
        fed || self.node(node).is_ever_nonzero(key)
    }

    /// Whether a predicate holds for an attribute or any of its sources. The clock counts as a match.
    fn any_upstream(
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

    /// Connections to an attribute, its elements or its components: by element, then in the order of connecting.
    pub(super) fn sources(&self, node: NodeId, name: &'static str) -> impl Iterator<Item = &Connection> {
        self.arriving.of_attribute(node, name)
    }

    /// The transform from a node's space to world space at a frame. Lengths in scene units. For many nodes, call
    /// [`at`](Self::at) once.
    pub fn placement(&self, node: NodeId, frame: f64) -> Affine {
        self.at(frame).placement(node)
    }

    /// Whether the placement of a node changes over time, by its own transform or that of an ancestor.
    pub fn moves(&self, node: NodeId) -> bool {
        self.self_and_ancestors(node).any(|node| {
            self.changes(node, &transform::TRANSLATE)
                || self.changes(node, &transform::ROTATE)
                || self.changes(node, &transform::SCALE)
        })
    }

    /// Whether the size or the form of a node in the world changes over time, by its own scale or that of an ancestor.
    pub fn changes_size(&self, node: NodeId) -> bool {
        self.self_and_ancestors(node).any(|node| self.changes(node, &transform::SCALE))
    }
}

impl<'g> EvalContext<'g> {
    /// The graph.
    pub(crate) fn graph(&self) -> &Graph {
        self.graph
    }

    /// The frame.
    pub fn frame(&self) -> f64 {
        self.frame
    }

    /// The value of an attribute: that of its source, else its setting, else the default of the nearest row.
    pub fn get<T: FromValue>(&self, node: NodeId, key: &Key<T>) -> T {
        self.mark_pulled(node);
        let own = self.graph.node(node);
        if self.graph.sources(node, key.row.name).next().is_none() {
            return own.at(key, self.frame);
        }
        let value =
            own.node_type().attribute(key.row.name).and_then(|row| self.value_from_source(own, node, row));
        value.as_ref().and_then(T::from_value).unwrap_or_else(|| own.at(key, self.frame))
    }

    /// The transform from a node's space to world space. Lengths in scene units.
    pub fn placement(&self, node: NodeId) -> Affine {
        let mut above = Vec::new();
        let mut known = Affine::identity();
        for ancestor in self.graph.self_and_ancestors(node) {
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

    fn transform(&self, node: NodeId) -> Transform {
        Transform {
            translate: Vector3::from(self.get(node, &transform::TRANSLATE)),
            rotate: Vector3::from(self.get(node, &transform::ROTATE)),
            order: ORDERS[self.get(node, &transform::ROTATE_ORDER).0.clamp(0, 5) as usize],
            scale: Vector3::from(self.get(node, &transform::SCALE)),
        }
    }

    /// The nodes evaluated so far, in the order of their first evaluation; none where they are not recorded.
    pub(crate) fn pulled(&self) -> Vec<NodeId> {
        self.pulled.as_ref().map(|pulled| pulled.borrow().1.clone()).unwrap_or_default()
    }

    fn mark_pulled(&self, node: NodeId) {
        let Some(pulled) = &self.pulled else { return };
        let (seen, order) = &mut *pulled.borrow_mut();
        if seen.insert(node) {
            order.push(node);
        }
    }

    /// The value of an attribute of any kind: that of its source, else its own. `None` for attributes that have
    /// no value and are only connected.
    pub fn held<T>(&self, node: NodeId, key: &Key<T>) -> Option<Value> {
        self.mark_pulled(node);
        let own = self.graph.node(node);
        let row = own.node_type().attribute(key.row.name)?;
        match self.graph.sources(node, row.name).next() {
            Some(_) => self.value_from_source(own, node, row),
            None => own.value_at(row, self.frame),
        }
    }

    /// The value of a connected attribute.
    fn value_from_source(&self, own: &Node, node: NodeId, row: &'static Attribute) -> Option<Value> {
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
                self.mark_pulled(last.node);
                let held = self.graph.node(last.node).value_at(last.attribute, self.frame);
                held.filter(|value| row.kind.admits(value)).or_else(|| own.value_at(row, self.frame))
            }
        }
    }

    /// A number, or a component of a vector, from the first plug of its chain of connections.
    fn number(&self, node: NodeId, row: &'static Attribute, part: Option<usize>) -> f64 {
        let mut path = vec![(node, row, part)];
        let mut number = loop {
            let &(node, row, part) = &path[path.len() - 1];
            let feeds = |wire: &&Connection| wire.to.part.is_none() || wire.to.part == part;
            let Some(wire) = self.graph.sources(node, row.name).find(feeds) else {
                break self.unconnected_number(node, row, part);
            };
            let from = wire.from;
            path.push((from.node, from.attribute, from.part.or(part.filter(|_| wire.to.part.is_none()))));
        };
        // Each attribute on the path converts the number to its own kind and range.
        for (_, row, _) in path.into_iter().rev() {
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

    /// The number of an attribute without a source.
    fn unconnected_number(&self, node: NodeId, row: &'static Attribute, part: Option<usize>) -> f64 {
        self.mark_pulled(node);
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
