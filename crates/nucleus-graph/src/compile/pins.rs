//! Transform constraints: which points they hold, and where they carry them.

use std::collections::BTreeSet;

use nalgebra::Vector3;
use nucleus_core::{ClothId, Pin, PointId};

use crate::attributes::{Choice, Component, Selection, dynamic_constraint};
use crate::graph::NodeId;

use super::objects::Compiler;
use super::program::Program;

/// `constraintType: transform`.
const TRANSFORM: Choice = Choice(0);

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
    held: Vec<Option<Vec<Vector3<f64>>>>,
}

impl Compiler<'_> {
    /// Points that constraints name have to be there.
    pub(super) fn check_pinned_points(&mut self) {
        for (_, node) in self.scene.graph.of_type(&dynamic_constraint::DYNAMIC_CONSTRAINT) {
            for (k, component) in node.get(&dynamic_constraint::COMPONENTS).iter().enumerate() {
                let Some((_, cloth)) = self.cloth_named(&component.object) else { continue };
                let points = cloth.start.len();
                if let Selection::Points { last, .. } = component.selection
                    && last as usize >= points
                {
                    let place = self.scene.source.place(&format!("{}.components[{k}]", node.name()));
                    let Component { object, .. } = component;
                    let message = format!("`{object}` has no point {last}");
                    let error = self.findings.error(&place, message);
                    error.help(format!("its points are numbered 0 to {}", points - 1));
                }
            }
        }
    }

    /// What all transform constraints hold, in the order of their names.
    pub(super) fn pins(&mut self) -> Vec<PinSource> {
        let mut pins: Vec<PinSource> = Vec::new();
        let mut taken: BTreeSet<(ClothId, PointId)> = BTreeSet::new();
        for (id, node) in self.scene.graph.of_type(&dynamic_constraint::DYNAMIC_CONSTRAINT) {
            if node.get(&dynamic_constraint::CONSTRAINT_TYPE) != TRANSFORM {
                continue;
            }
            let points = self.held_points(&node.get(&dynamic_constraint::COMPONENTS));
            let place = self.scene.source.place(node.name());
            if points.iter().any(|held| taken.contains(&(held.cloth, held.point))) {
                let message =
                    format!("`{}` takes hold of points that another constraint may hold", node.name());
                let warning = self.findings.warning(&place, message);
                warning.help("while both are enabled, the one whose name comes first holds them");
            }
            taken.extend(points.iter().map(|held| (held.cloth, held.point)));
            let placement = self.scene.graph.placement(id, self.time.start as f64);
            let moves = self.scene.graph.moves(id);
            if moves && placement.linear.try_inverse().is_none() {
                self.findings.error(&place, format!("`{}` is scaled to nothing at the start", node.name()));
            }
            pins.push(PinSource { constraint: id, points, moves });
        }
        pins
    }

    /// Each point once, in the order in which they are named.
    fn held_points(&self, components: &[Component]) -> Vec<HeldPoint> {
        let mut seen = BTreeSet::new();
        let mut held = Vec::new();
        for component in components {
            let Some((cloth, source)) = self.cloth_named(&component.object) else { continue };
            let all = source.start.len() as u32;
            let range = match component.selection {
                Selection::Object | Selection::AllPoints => 0..all,
                Selection::Points { first, last } => first.min(all)..last.saturating_add(1).min(all),
            };
            for point in range.filter(|point| seen.insert((cloth, *point))) {
                let start = source.start[point as usize];
                held.push(HeldPoint { cloth, point: PointId(point), start });
            }
        }
        held
    }
}

impl Program {
    /// The pins of the frame that ends at `frame`. A constraint that is on and holds nothing yet takes hold
    /// of its points where they are when the frame begins: `position` in metres (N2.4-5).
    pub(super) fn pins(
        &self,
        frame: i64,
        grips: &mut Grips,
        position: &dyn Fn(ClothId, PointId) -> Vector3<f64>,
    ) -> Vec<Pin> {
        grips.held.resize(self.pins.len(), None);
        let mut pins = Vec::new();
        let mut taken = BTreeSet::new();
        for (source, grip) in self.pins.iter().zip(&mut grips.held) {
            if !self.graph.node(source.constraint).at(&dynamic_constraint::ENABLE, frame as f64) {
                *grip = None;
                continue;
            }
            let first_step = frame == self.time.start + 1;
            let grip = grip.get_or_insert_with(|| {
                let points = source.points.iter();
                let place =
                    |held: &HeldPoint| if first_step { held.start } else { position(held.cloth, held.point) };
                self.take_hold(source, frame - 1, points.map(place))
            });
            let [from, to] = [frame - 1, frame].map(|frame| self.carried(source, frame, grip));
            for ((held, start), end) in source.points.iter().zip(from).zip(to) {
                if taken.insert((held.cloth, held.point)) {
                    pins.push(Pin { cloth: held.cloth, point: held.point, start, end });
                }
            }
        }
        pins
    }

    /// Points in metres to points in the space of the constraint, or to scene units if it never moves.
    fn take_hold(
        &self,
        source: &PinSource,
        frame: i64,
        points: impl Iterator<Item = Vector3<f64>>,
    ) -> Vec<Vector3<f64>> {
        if !source.moves {
            return points.collect();
        }
        let placement = self.graph.placement(source.constraint, frame as f64);
        // Scaled to nothing, it has no space to keep points in: then they all come to where it is.
        let inverse = placement.linear.try_inverse().unwrap_or_default();
        points.map(|point| inverse * (self.units.scene_point(point) - placement.offset)).collect()
    }

    /// Where the constraint has its points at a frame, in metres.
    fn carried(&self, source: &PinSource, frame: i64, grip: &[Vector3<f64>]) -> Vec<Vector3<f64>> {
        if !source.moves {
            return grip.to_vec();
        }
        let placement = self.graph.placement(source.constraint, frame as f64);
        grip.iter().map(|point| self.units.point(placement.point(*point))).collect()
    }
}
