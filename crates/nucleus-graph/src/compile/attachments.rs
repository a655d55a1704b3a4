//! Transform constraints: the points they hold, and the pins that move these points in a frame.

use std::collections::BTreeSet;

use nalgebra::Vector3;
use nucleus_core::{ClothId, Pin, PointId};

use crate::attributes::{Choice, Component, Selection, dynamic_constraint, n_component, nucleus};
use crate::graph::{EvalContext, NodeId};

use super::compiler::Compiler;
use super::program::{EvaluationInterval, NucleusProgram};
use super::sources::{AttachedPoint, AttachmentSource, EmitterState};

/// `constraintType: transform`.
const TRANSFORM: Choice = Choice(0);
/// `elements` of a component.
const LISTED: Choice = Choice(0);
const ALL: Choice = Choice(2);
/// `componentType` of a component.
const POINT: Choice = Choice(2);
const OBJECT: Choice = Choice(6);

/// What constraints and emitters keep from frame to frame. Attachment state of each constraint: positions of its points in constraint space, in scene units, or
/// `None` while it is disabled. If the constraint never moves, the positions are in world space, in metres.
#[derive(Debug, Clone, Default)]
pub(crate) struct AttachmentState {
    pub(crate) held: Vec<Option<Vec<Vector3<f64>>>>,
    /// What each emitter keeps from frame to frame.
    pub(crate) emitters: Vec<EmitterState>,
}

impl NucleusProgram {
    /// Whether a restored attachment state fits: it is empty, or each constraint holds all of its points or none.
    pub(crate) fn accepts_attachments(&self, held: &[Option<Vec<Vector3<f64>>>]) -> bool {
        let fits = |(held, source): (&Option<Vec<_>>, &AttachmentSource)| {
            held.as_ref().is_none_or(|held| held.len() == source.points.len())
        };
        held.is_empty()
            || (held.len() == self.attachments.len() && held.iter().zip(&self.attachments).all(fits))
    }
}

impl Compiler<'_> {
    /// All transform constraints, in the order of their names.
    pub(super) fn attachments(&mut self) -> Vec<AttachmentSource> {
        let mut attachments: Vec<AttachmentSource> = Vec::new();
        let mut taken: BTreeSet<(ClothId, PointId)> = BTreeSet::new();
        for id in self.constraints() {
            self.check_named_points(id);
            let node = self.scene.graph.node(id);
            if self.start.get(id, &dynamic_constraint::CONSTRAINT_TYPE) != TRANSFORM {
                continue;
            }
            let points = self.attached_points(id);
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
            attachments.push(AttachmentSource { constraint: id, points, moves });
        }
        attachments
    }

    /// The constraints of the nucleus, in the order of their names.
    fn constraints(&self) -> Vec<NodeId> {
        let graph = &self.scene.graph;
        let elements = graph.elements(self.program.node, &nucleus::INPUT_CURRENT);
        let mut constraints: Vec<NodeId> = elements.into_iter().map(|(_, plug)| plug.node).collect();
        constraints.sort_by_key(|id| graph.node(*id).name());
        constraints.dedup();
        constraints
    }

    /// Reports points that a constraint names and the cloth does not have.
    fn check_named_points(&mut self, constraint: NodeId) {
        let graph = &self.scene.graph;
        let node = graph.node(constraint);
        for (k, component) in node.get(&dynamic_constraint::COMPONENTS).iter().enumerate() {
            let Component { object, selection: Selection::Points { last, .. } } = component else { continue };
            let Some(cloth) = graph.find(object).and_then(|object| self.cloth_of(object)) else { continue };
            let points = self.program.model.positions(cloth).len();
            if *last as usize >= points {
                let place = self.scene.source.place(&format!("{}.components[{k}]", node.name()));
                let error = self.findings.error(&place, format!("`{object}` has no point {last}"));
                error.help(format!("its points are numbered 0 to {}", points - 1));
            }
        }
    }

    /// The points of a constraint, each once, in the order of its components.
    fn attached_points(&mut self, constraint: NodeId) -> Vec<AttachedPoint> {
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
                    let start = self.program.model.positions(cloth)[point as usize];
                    held.push(AttachedPoint { cloth, point: PointId(point), start });
                }
            }
        }
        held
    }

    /// The points of a component that exist.
    fn points_of(&mut self, member: NodeId, cloth: ClothId) -> Vec<u32> {
        let all = self.program.model.positions(cloth).len() as u32;
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
        // `check_named_points` covers components that the constraint's short form makes.
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

impl EvaluationInterval<'_> {
    /// The pins of this interval. A constraint that becomes enabled attaches its points where they are at the start of
    /// the interval: `position` in metres (N2.4-5).
    pub(super) fn pins(
        &self,
        attachments: &mut AttachmentState,
        position: &dyn Fn(ClothId, PointId) -> Vector3<f64>,
    ) -> Vec<Pin> {
        attachments.held.resize(self.nucleus.attachments.len(), None);
        let mut pins = Vec::new();
        let mut taken = BTreeSet::new();
        for (source, held) in self.nucleus.attachments.iter().zip(&mut attachments.held) {
            if !self.to.get(source.constraint, &dynamic_constraint::ENABLE) {
                *held = None;
                continue;
            }
            let held = held.get_or_insert_with(|| {
                let points = source.points.iter();
                let place = |point: &AttachedPoint| {
                    if self.is_first { point.start } else { position(point.cloth, point.point) }
                };
                self.to_constraint_space(source, points.map(place))
            });
            let [from, to] = [&self.from, &self.to].map(|moment| self.positions_at(source, moment, held));
            for ((point, start), end) in source.points.iter().zip(from).zip(to) {
                if taken.insert((point.cloth, point.point)) {
                    pins.push(Pin { cloth: point.cloth, point: point.point, start, end });
                }
            }
        }
        pins
    }

    /// Positions in constraint space, in scene units, from positions in metres; unchanged if the constraint never moves.
    fn to_constraint_space(
        &self,
        source: &AttachmentSource,
        points: impl Iterator<Item = Vector3<f64>>,
    ) -> Vec<Vector3<f64>> {
        if !source.moves {
            return points.collect();
        }
        let placement = self.from.placement(source.constraint);
        // With a scale of zero there is no inverse: all points move to the origin of the constraint.
        let inverse = placement.linear.try_inverse().unwrap_or_default();
        points.map(|point| inverse * (self.nucleus.units.scene_point(point) - placement.offset)).collect()
    }

    /// Positions of the attached points at a time, in metres.
    fn positions_at(
        &self,
        source: &AttachmentSource,
        moment: &EvalContext,
        held: &[Vector3<f64>],
    ) -> Vec<Vector3<f64>> {
        if !source.moves {
            return held.to_vec();
        }
        let placement = moment.placement(source.constraint);
        held.iter().map(|point| self.nucleus.units.point(placement.point(*point))).collect()
    }
}
