//! The value of an attribute at a frame: stored, keyed, or computed by the nodes that drive it.

use std::cell::{Cell, RefCell};
use std::collections::HashMap;
use std::rc::Rc;

use crate::scene::{MayaScene, NodeId, PlugRef, Quantity, Vector3, Wire};

use super::curve::MayaCurve;
use super::names;
use super::script::Script;

/// Longest chain of nodes that is followed; a longer one is a cycle.
pub(super) const MAX_DEPTH: u32 = 200;

/// A plug by its node and path, the component of a vector that is connected as a whole, and the bits of a frame.
type Wanted<'s> = (NodeId, &'s str, Option<usize>, u64);

/// Evaluates attributes of a scene.
pub struct Evaluator<'s> {
    /// The scene.
    pub scene: &'s MayaScene,
    curves: RefCell<HashMap<NodeId, Option<Rc<MayaCurve>>>>,
    scripts: RefCell<HashMap<NodeId, Rc<Result<Script, String>>>>,
    pub(super) constraints: RefCell<HashMap<(NodeId, u64), Option<names::Driven>>>,
    /// Values of the current evaluation: nodes that share inputs would double the work at each of them.
    known: RefCell<HashMap<Wanted<'s>, Option<f64>>>,
    depth: Cell<u32>,
}

impl<'s> Evaluator<'s> {
    /// For a scene.
    pub fn new(scene: &'s MayaScene) -> Self {
        let (curves, scripts, constraints) = (RefCell::default(), RefCell::default(), RefCell::default());
        Self { scene, curves, scripts, constraints, known: RefCell::default(), depth: Cell::new(0) }
    }

    /// The curve of an `animCurve` node.
    pub fn curve(&self, id: NodeId) -> Option<Rc<MayaCurve>> {
        let read = || MayaCurve::read(self.scene, id).map(Rc::new);
        self.curves.borrow_mut().entry(id).or_insert_with(read).clone()
    }

    /// The program of an `expression` node, or why it cannot be read.
    pub fn script(&self, id: NodeId) -> Rc<Result<Script, String>> {
        let read = || {
            let text = self.scene.string(id, &["ixp", "internalExpression"]).unwrap_or_default();
            Rc::new(Script::parse(&text))
        };
        self.scripts.borrow_mut().entry(id).or_insert_with(read).clone()
    }

    /// The value of an attribute at a frame, in the units of the file.
    pub fn number(&self, id: NodeId, names: &[&str], frame: f64) -> Option<f64> {
        match self.scene.source(id, names, None) {
            Some(wire) => self.output(wire.from, frame).or_else(|| self.scene.stored(id, names)),
            None => self.scene.stored(id, names),
        }
    }

    /// The same, or a default.
    pub fn number_or(&self, id: NodeId, names: &[&str], frame: f64, default: f64) -> f64 {
        self.number(id, names, frame).filter(|x| x.is_finite()).unwrap_or(default)
    }

    /// The value of a plug at a frame; `None` if its node computes it in a way that is not read.
    pub fn output(&self, plug: PlugRef, frame: f64) -> Option<f64> {
        self.once(plug, None, frame, || self.computed(plug, frame).filter(|x| x.is_finite()))
    }

    /// Computes a value one node further along a chain, at most once in an evaluation; `None` where the chain is too long.
    fn once(
        &self,
        plug: PlugRef,
        part: Option<usize>,
        frame: f64,
        work: impl FnOnce() -> Option<f64>,
    ) -> Option<f64> {
        let wanted = (plug.node, self.scene.path(plug).0, part, frame.to_bits());
        self.nested(|| {
            let known = self.known.borrow().get(&wanted).copied();
            known.unwrap_or_else(|| {
                let found = work();
                self.known.borrow_mut().insert(wanted, found);
                found
            })
        })
    }

    /// Follows a chain of nodes one further; `None` where it is too long.
    pub(super) fn nested<T>(&self, work: impl FnOnce() -> Option<T>) -> Option<T> {
        match self.depth.get() {
            0 => self.known.borrow_mut().clear(),
            depth if depth > MAX_DEPTH => return None,
            _ => {}
        }
        self.depth.set(self.depth.get() + 1);
        let found = work();
        self.depth.set(self.depth.get() - 1);
        found
    }

    fn computed(&self, plug: PlugRef, frame: f64) -> Option<f64> {
        let PlugRef { node, .. } = plug;
        let path = self.scene.path(plug);
        let last = path.last();
        let get = |names: &[&str], default: f64| self.number_or(node, names, frame, default);
        match self.scene.kind(node) {
            "time" => Some(frame),
            kind if kind.starts_with("animCurveT") => Some(self.curve(node)?.value_at(frame)),
            kind if kind.starts_with("animCurveU") => {
                let input = self.number(node, &["i", "input"], frame)?;
                Some(self.curve(node)?.value_at(input))
            }
            kind if is_conversion(kind) => Some(get(&["i", "input"], 0.0) * self.conversion(node)),
            "addDoubleLinear" => Some(get(&["i1", "input1"], 0.0) + get(&["i2", "input2"], 0.0)),
            "multDoubleLinear" => Some(get(&["i1", "input1"], 0.0) * get(&["i2", "input2"], 1.0)),
            "multiplyDivide" | "reverse" | "pairBlend" | "clamp" => {
                self.blended(node, last.name, part(last.name)?, frame)
            }
            "plusMinusAverage" if matches!(last.name, "o1" | "output1D") => {
                let terms = self.elements(node, &["i1", "input1D"], frame);
                let (sum, count) = (terms.iter().sum::<f64>(), terms.len().max(1) as f64);
                match self.scene.stored_or(node, &["op", "operation"], 1.0) as u8 {
                    2 => Some(2.0 * terms.first().copied().unwrap_or(0.0) - sum),
                    3 => Some(sum / count),
                    _ => Some(sum),
                }
            }
            "blendWeighted" => {
                let values = self.elements(node, &["i", "input"], frame);
                let weights = self.elements(node, &["w", "weight"], frame);
                let weight = |k: usize| weights.get(k).copied().unwrap_or(1.0);
                Some(values.iter().enumerate().map(|(k, x)| x * weight(k)).sum())
            }
            "expression" => {
                let script = self.script(node);
                let index = path.segments().find_map(|segment| segment.range)?.0;
                let named = |name: &str| self.named(node, name, frame);
                script.as_ref().as_ref().ok()?.output(index, &named).ok()
            }
            kind if names::is_constraint(kind) => match names::driven_by(last.name) {
                Some((of, part)) => Some(self.constrained(node, frame)?[of][part?]),
                None => self.number(node, &[last.name], frame),
            },
            // An attribute that is passed on: of a transform, a locator, a control.
            "transform" | "joint" | "locator" | "nucleus" | "nCloth" | "nRigid" | "nParticle"
            | "dynamicConstraint" | "camera" | "mesh" | "network" | "script" => {
                let names = [last.name];
                self.number(node, &names, frame).or_else(|| self.of_whole(plug, frame))
            }
            _ => None,
        }
    }

    /// The factor of a conversion, for values in the units of the scene: that of the file is for Maya's internal units.
    pub(super) fn conversion(&self, node: NodeId) -> f64 {
        let scene = self.scene;
        let internal = |plug: PlugRef| {
            scene.units.internal(Quantity::of(scene.kind(plug.node), scene.path(plug).last().name))
        };
        let is_output = |wire: &Wire| matches!(scene.path(wire.from).last().name, "o" | "output");
        let from = scene.source(node, &["i", "input"], None).map_or(1.0, |wire| internal(wire.from));
        let to = scene.leaving(node).find(is_output).map_or(1.0, |wire| internal(wire.to));
        scene.stored_or(node, &["cf", "conversionFactor"], 1.0) * from / to
    }

    /// One component of the output of a node that computes three from its inputs, each stored or connected by component or
    /// as a whole.
    fn blended(&self, node: NodeId, output: &str, part: usize, frame: f64) -> Option<f64> {
        let get = |vector: Vector3, default: f64| self.component(node, vector, part, default, frame);
        match self.scene.kind(node) {
            "multiplyDivide" => {
                let [a, b] = [get(names::FACTORS[0], 0.0), get(names::FACTORS[1], 1.0)];
                match self.scene.stored_or(node, &["op", "operation"], 1.0) as u8 {
                    0 => Some(a),
                    1 => Some(a * b),
                    2 => (b != 0.0).then_some(a / b),
                    _ => Some(libm::pow(a, b)),
                }
            }
            "reverse" => Some(1.0 - get(names::REVERSED, 0.0)),
            "pairBlend" => {
                let is_turn = output.starts_with("or") || output.starts_with("outRotate");
                let [a, b] = names::BLENDED[usize::from(is_turn)];
                let weight = self.number_or(node, &["w", "weight"], frame, 1.0);
                Some(get(a, 0.0) * (1.0 - weight) + get(b, 0.0) * weight)
            }
            "clamp" => {
                let [x, low, high] = names::CLAMPED.map(|vector| get(vector, 0.0));
                Some(x.max(low).min(high))
            }
            _ => None,
        }
    }

    /// The value of a name in an expression: the time, an input of its node, or an attribute of another.
    pub(super) fn named(&self, node: NodeId, name: &str, frame: f64) -> Option<f64> {
        match name {
            "frame" => return Some(frame),
            "time" => return Some(frame / self.scene.units.fps),
            _ => {}
        }
        let (other, path) = name.rsplit_once('.')?;
        if !other.is_empty() {
            return self.number(self.scene.find(other)?, &[path], frame);
        }
        let index =
            path.split_once('[').and_then(|(_, index)| index.trim_end_matches(']').parse::<u32>().ok());
        match self.scene.source(node, &["in", "input"], index) {
            Some(wire) => self.output(wire.from, frame),
            // Inputs that nothing drives hold their last value.
            None => self.scene.array(node, &["in", "input"], 1, &[])?.get(index? as usize).copied(),
        }
    }

    /// A component that is stored or connected as part of a whole: `tx` of `t`.
    fn of_whole(&self, plug: PlugRef, frame: f64) -> Option<f64> {
        let last = self.scene.path(plug).last().name;
        let (vector, default) = names::vector_of(last)?;
        let part = vector.parts.iter().position(|names| names.contains(&last))?;
        Some(self.component(plug.node, vector, part, default, frame))
    }

    /// The elements of an array at a frame: stored ones, and those that are driven.
    pub fn elements(&self, id: NodeId, names: &[&str], frame: f64) -> Vec<f64> {
        let mut all = self.scene.array(id, names, 1, &[]).unwrap_or_default();
        for (index, wire) in self.scene.sources(id, names) {
            let index = index as usize;
            if index >= all.len() && index < 1_000_000 {
                all.resize(index + 1, 0.0);
            }
            if let (Some(value), Some(element)) = (self.output(wire.from, frame), all.get_mut(index)) {
                *element = value;
            }
        }
        all
    }

    /// A vector at a frame, in the units of the file.
    pub fn vector(&self, id: NodeId, vector: Vector3, default: [f64; 3], frame: f64) -> [f64; 3] {
        let stored = self.scene.stored_vector(id, vector, default);
        [0, 1, 2].map(|part| self.driven_component(id, vector, part, frame).unwrap_or(stored[part]))
    }

    /// One component of a vector at a frame, in the units of the file.
    fn component(&self, id: NodeId, vector: Vector3, part: usize, default: f64, frame: f64) -> f64 {
        let stored = || self.scene.stored_vector(id, vector, [default; 3])[part];
        self.driven_component(id, vector, part, frame).unwrap_or_else(stored)
    }

    fn driven_component(&self, id: NodeId, vector: Vector3, part: usize, frame: f64) -> Option<f64> {
        if let Some(wire) = self.scene.source(id, vector.parts[part], None) {
            return self.output(wire.from, frame);
        }
        self.part_of(self.scene.source(id, vector.whole, None)?, part, frame)
    }

    /// One component of a vector that is connected as a whole.
    pub fn part_of(&self, wire: Wire, part: usize, frame: f64) -> Option<f64> {
        self.once(wire.from, Some(part), frame, || self.computed_part(wire.from, part, frame))
    }

    fn computed_part(&self, plug: PlugRef, part: usize, frame: f64) -> Option<f64> {
        let node = plug.node;
        let last = self.scene.path(plug).last().name;
        if names::is_constraint(self.scene.kind(node)) {
            return Some(self.constrained(node, frame)?[names::driven_by(last)?.0][part]);
        }
        if is_conversion(self.scene.kind(node)) {
            let input = self.scene.source(node, &["i", "input"], None)?;
            return Some(self.part_of(input, part, frame)? * self.conversion(node));
        }
        if matches!(self.scene.kind(node), "multiplyDivide" | "reverse" | "pairBlend" | "clamp") {
            return self.blended(node, last, part, frame);
        }
        let (vector, default) = names::vector_of_whole(last)?;
        if !matches!(self.scene.kind(node), "transform" | "joint") {
            return None;
        }
        Some(self.component(node, vector, part, default, frame))
    }
}

/// Whether Maya inserts such nodes between plugs of differing quantities: they only scale.
pub(super) fn is_conversion(kind: &str) -> bool {
    matches!(kind, "unitConversion" | "timeToUnitConversion" | "unitToTimeConversion")
}

/// The component that a name ends with: `ox`, `outputX`, `outTranslateY`, `outputG`.
fn part(name: &str) -> Option<usize> {
    match name.chars().next_back()?.to_ascii_lowercase() {
        'x' | 'r' => Some(0),
        'y' | 'g' => Some(1),
        'z' | 'b' => Some(2),
        _ => None,
    }
}
