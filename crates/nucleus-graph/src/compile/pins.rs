//! Transform constraints: which points they hold, and where they carry them.

use std::collections::BTreeSet;

use nalgebra::Vector3;
use nucleus_core::{ClothId, Pin, PointId};

use crate::attributes::{Choice, Component, Selection, dynamic_constraint, n_component, nucleus};
use crate::graph::{EvalContext, NodeId};

use super::frame::Stretch;
use super::objects::Compiler;
use super::program::Universe;

/// `constraintType: transform`.
const TRANSFORM: Choice = Choice(0);
/// `elements` of a component.
const LISTED: Choice = Choice(0);
const ALL: Choice = Choice(2);
/// `componentType` of a component.
const POINT: Choice = Choice(2);
const OBJECT: Choice = Choice(6);

/// What one constraint holds.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct PinSource {
    constraint: NodeId,
    points: Vec<HeldPoint>,
    /// Whether the constraint is ever carried anywhere.
    moves: bool,
}

#[derive(Debug, Clone, Copy, PartialEq)]
struct HeldPoint {
    cloth: ClothId,
    point: PointId,
    /// In metres.
    start: Vector3<f64>,
}

/// How constraints hold their points at the moment; for each constraint, once it has taken hold, where its
/// points are in its own space, in scene units.
#[derive(Debug, Clone, Default)]
pub(crate) struct Grips {
    pub(crate) held: Vec<Option<Vec<Vector3<f64>>>>,
}

impl Universe {
    /// Whether its constraints can hold so: none is there yet, or each holds all of its points or nothing.
    pub(crate) fn holds(&self, held: &[Option<Vec<Vector3<f64>>>]) -> bool {
        let fits = |(grip, source): (&Option<Vec<_>>, &PinSource)| {
            grip.as_ref().is_none_or(|grip| grip.len() == source.points.len())
        };
        held.is_empty() || (held.len() == self.pins.len() && held.iter().zip(&self.pins).all(fits))
    }
}

impl Compiler<'_> {
    /// What all transform constraints hold, in the order of their names.
    pub(super) fn pins(&mut self) -> Vec<PinSource> {
        let mut pins: Vec<PinSource> = Vec::new();
        let mut taken: BTreeSet<(ClothId, PointId)> = BTreeSet::new();
        for id in self.constraints() {
            self.check_points_named(id);
            let node = self.scene.graph.node(id);
            if self.start.get(id, &dynamic_constraint::CONSTRAINT_TYPE) != TRANSFORM {
                continue;
            }
            let points = self.held_points(id);
            let place = self.scene.source.place(node.name());
            if points.iter().any(|held| taken.contains(&(held.cloth, held.point))) {
                let message =
                    format!("`{}` takes hold of points that another constraint may hold", node.name());
                let warning = self.findings.warning(&place, message);
                warning.help("while both are enabled, the one whose name comes first holds them");
            }
            taken.extend(points.iter().map(|held| (held.cloth, held.point)));
            let placement = self.start.placement(id);
            let moves = self.scene.graph.moves(id);
            if moves && placement.linear.try_inverse().is_none() {
                self.findings.error(&place, format!("`{}` is scaled to nothing at the start", node.name()));
            }
            pins.push(PinSource { constraint: id, points, moves });
        }
        pins
    }

    /// The constraints of the nucleus, in the order of their names.
    fn constraints(&self) -> Vec<NodeId> {
        let graph = &self.scene.graph;
        let elements = graph.elements(self.whole.nucleus, &nucleus::INPUT_CURRENT);
        let mut constraints: Vec<NodeId> = elements.into_iter().map(|(_, plug)| plug.node).collect();
        constraints.sort_by_key(|id| graph.node(*id).name());
        constraints.dedup();
        constraints
    }

    /// Points that a constraint names have to be there.
    fn check_points_named(&mut self, constraint: NodeId) {
        let graph = &self.scene.graph;
        let node = graph.node(constraint);
        for (k, component) in node.get(&dynamic_constraint::COMPONENTS).iter().enumerate() {
            let Component { object, selection: Selection::Points { last, .. } } = component else { continue };
            let Some(cloth) = graph.find(object).and_then(|object| self.cloth_of(object)) else { continue };
            let points = self.whole.model.positions(cloth).len();
            if *last as usize >= points {
                let place = self.scene.source.place(&format!("{}.components[{k}]", node.name()));
                let error = self.findings.error(&place, format!("`{object}` has no point {last}"));
                error.help(format!("its points are numbered 0 to {}", points - 1));
            }
        }
    }

    /// Each point once, member by member.
    fn held_points(&mut self, constraint: NodeId) -> Vec<HeldPoint> {
        let graph = &self.scene.graph;
        let mut seen = BTreeSet::new();
        let mut held = Vec::new();
        for (_, member) in graph.elements(constraint, &dynamic_constraint::COMPONENT_IDS) {
            let Some(cloth) =
                graph.source(member.node, &n_component::OBJECT_ID).and_then(|id| self.cloth_of(id))
            else {
                continue;
            };
            for point in self.points_of(member.node, cloth) {
                if seen.insert((cloth, point)) {
                    let start = self.whole.model.positions(cloth)[point as usize];
                    held.push(HeldPoint { cloth, point: PointId(point), start });
                }
            }
        }
        held
    }

    /// The points of a component, as far as they are there.
    fn points_of(&mut self, member: NodeId, cloth: ClothId) -> Vec<u32> {
        let all = self.whole.model.positions(cloth).len() as u32;
        let node = self.scene.graph.node(member);
        let (kind, elements) = (node.get(&n_component::COMPONENT_TYPE), node.get(&n_component::ELEMENTS));
        if elements == ALL || kind == OBJECT {
            return (0..all).collect();
        }
        let name = node.name();
        if kind != POINT || elements != LISTED {
            let place = self.scene.source.place(name);
            self.findings.warning(&place, format!("only points can be held so far: `{name}` holds nothing"));
            return Vec::new();
        }
        let listed = node.get(&n_component::COMPONENT_INDICES);
        // Where the constraint names its points itself, that has been looked at.
        let missing = listed.iter().find(|&&point| point >= all).filter(|_| node.created_by().is_none());
        if let Some(point) = missing {
            let place = self.scene.source.place(&format!("{name}.componentIndices"));
            let error =
                self.findings.error(&place, format!("`{name}` lists point {point}, which is not there"));
            error.help(format!("the points are numbered 0 to {}", all - 1));
        }
        listed.into_iter().filter(|point| *point < all).collect()
    }
}

impl Stretch<'_> {
    /// The pins of this stretch of time. A constraint that is on and holds nothing yet takes hold of its
    /// points where they are when it begins: `position` in metres (N2.4-5).
    pub(super) fn pins(
        &self,
        grips: &mut Grips,
        position: &dyn Fn(ClothId, PointId) -> Vector3<f64>,
    ) -> Vec<Pin> {
        grips.held.resize(self.universe.pins.len(), None);
        let mut pins = Vec::new();
        let mut taken = BTreeSet::new();
        for (source, grip) in self.universe.pins.iter().zip(&mut grips.held) {
            if !self.to.get(source.constraint, &dynamic_constraint::ENABLE) {
                *grip = None;
                continue;
            }
            let grip = grip.get_or_insert_with(|| {
                let points = source.points.iter();
                let place = |held: &HeldPoint| {
                    if self.is_first { held.start } else { position(held.cloth, held.point) }
                };
                self.take_hold(source, points.map(place))
            });
            let [from, to] = [&self.from, &self.to].map(|moment| self.carried(source, moment, grip));
            for ((held, start), end) in source.points.iter().zip(from).zip(to) {
                if taken.insert((held.cloth, held.point)) {
                    pins.push(Pin { cloth: held.cloth, point: held.point, start, end });
                }
            }
        }
        pins
    }

    /// Points in metres to points in the space of the constraint, or as they are if it never moves.
    fn take_hold(&self, source: &PinSource, points: impl Iterator<Item = Vector3<f64>>) -> Vec<Vector3<f64>> {
        if !source.moves {
            return points.collect();
        }
        let placement = self.from.placement(source.constraint);
        // Scaled to nothing, it has no space to keep points in: then they all come to where it is.
        let inverse = placement.linear.try_inverse().unwrap_or_default();
        points.map(|point| inverse * (self.universe.units.scene_point(point) - placement.offset)).collect()
    }

    /// Where the constraint has its points at a moment, in metres.
    fn carried(&self, source: &PinSource, moment: &EvalContext, grip: &[Vector3<f64>]) -> Vec<Vector3<f64>> {
        if !source.moves {
            return grip.to_vec();
        }
        let placement = moment.placement(source.constraint);
        grip.iter().map(|point| self.universe.units.point(placement.point(*point))).collect()
    }
}
