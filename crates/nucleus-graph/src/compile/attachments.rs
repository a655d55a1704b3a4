//! Pins of transform constraints: the points they hold, and the motion of these points in a frame.

use std::collections::BTreeSet;

use nalgebra::Vector3;
use nucleus_core::{ClothId, Pin, PointId, Sanitized};

use crate::attributes::dynamic_constraint;
use crate::graph::EvalContext;

use super::compiler::Compiler;
use super::constraints::kinds::Values;
use super::constraints::member::{Member, MemberObject};
use super::program::{EvaluationInterval, NucleusProgram};
use super::sources::{AttachedPoint, AttachmentSource, EmitterState};

/// What constraints and emitters keep from frame to frame.
///
/// Attachment state of each constraint: positions of its points in constraint space, in scene units, or
/// `None` while it is disabled. If the constraint never moves, the positions are in world space, in metres.
#[derive(Debug, Clone, Default)]
pub(crate) struct AttachmentState {
    pub(crate) held: Vec<Option<Vec<Vector3<f64>>>>,
    /// Whether each constraint of links has been formed and is enabled.
    pub(crate) formed: Vec<bool>,
    /// The state of each emitter from frame to frame.
    pub(crate) emitters: Vec<EmitterState>,
    /// Invalid results of expressions per particle since the last call of the solver. Checkpoints do not hold them.
    pub(crate) invalid_results: Sanitized,
    /// Births since the last call of the solver that the emitters did not make, as no object has room for them.
    pub(crate) births_refused: u64,
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
            if !Values::new(&self.start, id).pins() {
                continue;
            }
            let node = self.scene.graph.node(id);
            let members = self.members_of(id);
            let points = self.attached_points(&members);
            let place = self.scene.source.place(node.name());
            if points.is_empty() && !members.is_empty() {
                let message = format!("`{}` holds colliders only, which no constraint moves", node.name());
                let warning = self.findings.warning(&place, message);
                warning.help("colliders follow their meshes; name cloth or particles");
            }
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

    /// The points of a constraint, each once, in the order of its components.
    fn attached_points(&self, members: &[Member]) -> Vec<AttachedPoint> {
        let mut seen = BTreeSet::new();
        let mut held = Vec::new();
        for member in members {
            let MemberObject::Cloth(cloth) = member.object else { continue };
            for &point in member.elements.corners() {
                if seen.insert((cloth, point)) {
                    let start = self.program.model.positions(cloth)[point as usize];
                    held.push(AttachedPoint { cloth, point: PointId(point), start });
                }
            }
        }
        held
    }
}

impl EvaluationInterval<'_> {
    /// The pins of this interval. A constraint that becomes enabled attaches its points where they are at the start of
    /// the interval: `position` in metres (N2.4-5).
    pub(crate) fn pins(
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
        self.nucleus.units.placed(&placement, held)
    }
}
