//! What an nCloth has beyond links, in SI units: angles, deformation that stays, pressure, and resistances that count.

use nalgebra::Vector3;
use nucleus_core::{
    BendSolver, Bending, COUNT_PERIOD, ClothId, ClothLists, LinkOrder, PASCALS_PER_PRESSURE, PointId,
    Pressure, Surface,
};

use crate::animation::sin_cos_degrees;
use crate::attributes::{Choice, Key, n_base, n_cloth, nucleus};
use crate::graph::{Graph, NodeId};
use crate::mesh::{area, is_open};

use super::compiler::Compiler;
use super::past_state::{MANUAL, NO_ANGLE, NO_TENSION, tracks_volume, yields_bends, yields_stretch};
use super::program::EvaluationInterval;
use super::sources::ClothSource;
use super::units::CLASSIC;

/// `bendSolver: simple` and `flipTracking`.
const SIMPLE: Choice = Choice(0);
const FLIP_TRACKING: Choice = Choice(2);
/// `evaluationOrder: parallel`.
const PARALLEL: Choice = Choice(1);
/// `scalingRelation`.
const LINK: Choice = Choice(0);
const OBJECT_SPACE: Choice = Choice(1);
/// Pa·s for a `pressureDamping` of 1: it takes up a pressure of 1 at one volume in 1/24 s.
const DAMPING: f64 = PASCALS_PER_PRESSURE / 24.0;
/// Faces of the mesh for which Object Space means the same as Link: those of a polyPlane as Maya makes it.
const REFERENCE_FACES: f64 = 100.0;

/// The lists that a cloth needs beyond links; `lists` has the others.
pub(super) fn lists(graph: &Graph, cloth: NodeId, lists: ClothLists) -> ClothLists {
    use n_cloth::{
        BEND_ANGLE_DROPOFF, BEND_ANGLE_SCALE, BEND_SOLVER, DEFORM_RESISTANCE, PRESSURE, RIGIDITY,
        USE_POLYGON_SHELLS,
    };
    let node = graph.node(cloth);
    let used = |key: &Key<f64>| graph.is_ever_nonzero(cloth, key);
    let scaled = graph.changes(cloth, &BEND_ANGLE_SCALE) || node.get(&BEND_ANGLE_SCALE) != 1.0;
    let shape = used(&RIGIDITY) || used(&DEFORM_RESISTANCE);
    let pressure = tracks_volume(graph, cloth) || used(&PRESSURE);
    ClothLists {
        signed_bend: lists.bend && node.get(&BEND_SOLVER) != SIMPLE,
        bend_angles: lists.bend
            && (used(&BEND_ANGLE_DROPOFF)
                || scaled
                || yields_bends(graph, cloth)
                || graph.changes(cloth, &BEND_SOLVER)
                || node.get(&BEND_SOLVER) == FLIP_TRACKING),
        pressure,
        shape,
        shells: shape && node.get(&USE_POLYGON_SHELLS),
        plastic: lists.stretch && yields_stretch(graph, cloth),
        ..lists
    }
}

impl EvaluationInterval<'_> {
    /// How the hinges of a cloth measure their angles.
    pub(super) fn bending(&self, source: &ClothSource) -> Bending {
        let number = |key: &Key<f64>| self.to.get(source.node, key);
        let given = number(&n_cloth::RESTITUTION_ANGLE);
        let limit = if given < NO_ANGLE { given * source.scales.restitution_angle } else { given };
        Bending {
            angle_scale: number(&n_cloth::BEND_ANGLE_SCALE),
            angle_dropoff: number(&n_cloth::BEND_ANGLE_DROPOFF) * source.scales.angle_dropoff,
            solver: match self.to.get(source.node, &n_cloth::BEND_SOLVER) {
                SIMPLE => BendSolver::Simple,
                FLIP_TRACKING => BendSolver::FlipTracking,
                _ => BendSolver::Signed,
            },
            yield_sine: match limit < NO_ANGLE {
                // Beyond 180° half the angle has a smaller sine again: such a bend is never reached.
                true if limit < 180.0 => sin_cos_degrees(limit.max(0.0) / 2.0).0,
                _ => f64::INFINITY,
            },
            yield_half_angle: if given < NO_ANGLE { limit.to_radians() / 2.0 } else { f64::INFINITY },
        }
    }

    /// The strain at which links of a resistance give way: the tension of a link is its resistance times its strain.
    pub(super) fn yield_strain(&self, node: NodeId, resistance: f64) -> f64 {
        let tension = self.to.get(node, &n_cloth::RESTITUTION_TENSION);
        if tension >= NO_TENSION || resistance <= 0.0 { f64::INFINITY } else { tension.max(0.0) / resistance }
    }

    /// Pressure in pascals.
    pub(super) fn pressure(&self, node: NodeId) -> Pressure {
        let number = |key: &Key<f64>| self.to.get(node, key);
        let damping = number(&n_cloth::PRESSURE_DAMPING) * DAMPING;
        if self.to.get(node, &n_cloth::PRESSURE_METHOD) == MANUAL {
            let pascals = number(&n_cloth::PRESSURE) * PASCALS_PER_PRESSURE;
            return if pascals == 0.0 { Pressure::Off } else { Pressure::Manual { pascals, damping } };
        }
        Pressure::Gas {
            start: number(&n_cloth::START_PRESSURE),
            bulk: number(&n_cloth::INCOMPRESSIBILITY) * PASCALS_PER_PRESSURE,
            pump: number(&n_cloth::PUMP_RATE),
            tightness: number(&n_cloth::AIR_TIGHTNESS),
            damping,
            sealed: self.to.get(node, &n_cloth::SEAL_HOLES),
        }
    }

    /// A resistance as the solver takes it. Physical: as it is. Classic: a count, scaled as `scalingRelation` says and no
    /// higher than `maxIterations`.
    /// `minimal` limits it to one iteration in a substep.
    pub(super) fn resistance(&self, source: &ClothSource, value: f64, minimal: &Key<bool>) -> f64 {
        if self.to.get(self.nucleus.node, &nucleus::RESISTANCE_MODEL) != CLASSIC {
            return value;
        }
        let limit = self.to.get(source.node, &n_base::MAX_ITERATIONS).max(0) as f64;
        let count = (value * self.count_scale(source)).min(limit);
        if self.to.get(source.node, minimal) { count.min(self.substeps_per_count()) } else { count }
    }

    /// Substeps in the time that counts are given for.
    fn substeps_per_count(&self) -> f64 {
        let seconds = self.to.get(self.nucleus.node, &nucleus::TIME_SCALE) * self.seconds;
        self.to.get(self.nucleus.node, &nucleus::SUB_STEPS) as f64 * COUNT_PERIOD / seconds
    }

    /// Factor on the counts of a cloth in the Classic reading: `scalingRelation`. In Object Space the count grows with the
    /// number of faces, so that a finer mesh is no softer; in World Space it also goes with the inverse area of the object
    /// in m², so that a larger one is no stiffer.
    fn count_scale(&self, source: &ClothSource) -> f64 {
        let faces = source.faces as f64 / REFERENCE_FACES;
        match self.to.get(source.node, &n_cloth::SCALING_RELATION) {
            LINK => 1.0,
            OBJECT_SPACE => faces,
            _ => faces / source.area.max(f64::MIN_POSITIVE),
        }
    }
}

impl Compiler<'_> {
    /// The order in which the links of each cloth are solved; the constraints are compiled before.
    pub(super) fn order_links(&mut self) {
        let cloths: Vec<NodeId> = self.program.cloths.iter().map(|source| source.node).collect();
        for (cloth, id) in (0..).map(ClothId).zip(cloths) {
            if !self.scene.graph.node(id).node_type().is_a(&n_cloth::N_CLOTH) {
                continue;
            }
            let Some(order) = self.link_order(cloth, id) else { continue };
            if let Err(error) = self.program.model.set_link_order(cloth, order) {
                let place = self.scene.source.place(self.scene.graph.node(id).name());
                self.findings.error(&place, error.to_string());
            }
        }
    }

    /// The order of the links of a cloth; `None` for that of the colours.
    fn link_order(&mut self, cloth: ClothId, id: NodeId) -> Option<LinkOrder> {
        if self.start.get(id, &n_cloth::EVALUATION_ORDER) == PARALLEL {
            return Some(LinkOrder::Parallel);
        }
        if !self.start.get(id, &n_cloth::SORT_LINKS) {
            let model = self.start.get(self.program.node, &nucleus::RESISTANCE_MODEL);
            return (model == CLASSIC).then_some(LinkOrder::Mesh);
        }
        let held = self.program.attachments.iter().flat_map(|attachment| &attachment.points);
        let held: Vec<PointId> = held.filter(|held| held.cloth == cloth).map(|held| held.point).collect();
        if held.is_empty() {
            let name = self.scene.graph.node(id).name();
            let place = self.scene.source.place(&format!("{name}.sortLinks"));
            let message = format!("`sortLinks` of `{name}` has no effect: no constraint holds a point of it");
            self.findings.warning(&place, message);
        }
        Some(LinkOrder::Outwards(held))
    }

    /// Warns of pressure in a mesh that cannot hold it.
    pub(super) fn check_pressure(&mut self, cloth: NodeId, surface: &Surface) {
        let node = self.scene.graph.node(cloth);
        let is_manual = self.start.get(cloth, &n_cloth::PRESSURE_METHOD) == MANUAL;
        if is_manual && !self.scene.graph.is_ever_nonzero(cloth, &n_cloth::PRESSURE) {
            return;
        }
        let middle = surface.positions.iter().sum::<Vector3<f64>>() / surface.positions.len() as f64;
        let corners = |triangle: [u32; 3]| triangle.map(|k| surface.positions[k as usize] - middle);
        let volume: f64 =
            surface.faces.triangles().map(corners).map(|[a, b, c]| a.dot(&b.cross(&c)) / 6.0).sum();
        let area = area(&surface.faces, &surface.positions);
        // A sphere has 0.094.
        let is_flat = volume.abs() < 1e-4 * area.powf(1.5);
        let attribute = if is_manual { &n_cloth::PRESSURE.row } else { &n_cloth::PRESSURE_METHOD.row };
        let name = node.name();
        let (message, help) = match is_manual {
            true if is_open(&surface.faces) => (
                format!(
                    "`{name}` has open edges: pressure set by hand pushes its faces along their normals, and the whole of it \
                     away"
                ),
                "close the mesh, hold it by a constraint, or write `pressureMethod: volumeTrackingModel`, which seals holes",
            ),
            true if volume < 0.0 => (
                format!("the faces of `{name}` face inwards: a pressure above 0 turns it inside out"),
                "reverse its normals, or the sign of `pressure`",
            ),
            false if is_flat => (
                format!("`{name}` encloses no volume, so no air is held in it"),
                "use a closed mesh, or `pressureMethod: manualPressureSetting`",
            ),
            false if volume < 0.0 => (
                format!("the faces of `{name}` face inwards"),
                "its air is kept inside all the same; drag and push-out see it reversed",
            ),
            _ => return,
        };
        let place = self.scene.source.place(&format!("{name}.{}", attribute.name));
        self.findings.warning(&place, message).help(help);
    }
}
