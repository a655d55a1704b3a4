//! How far sweeps leave cloth stretched, estimated from its mesh, and the budget of a nucleus without `evaluations`.
//!
//! In a step of h seconds a sweep holds an edge no stiffer than about m / h², whatever its resistance is. An edge of length
//! d that carries N points of mass m at rest is therefore stretched by N g h² / d: the mass cancels, and a small mesh
//! needs short steps. Where cloth hangs by P pins, an edge beside them carries (points - P) / P points. Elsewhere an edge
//! carries at most half the cloth in a line, as over the edge of a table.

use nucleus_core::{COUNT_PERIOD, Cloth, FrameInput, PhysicalStiffness, PointId, ResistanceModel};

use crate::attributes::nucleus;
use crate::diagnostic::Findings;
use crate::graph::NodeId;
use crate::scene::document::Scene;

use super::program::{NucleusProgram, Program};

/// A cloth that hangs by pins.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hanging {
    /// Its points.
    pub points: usize,
    /// Those that are pinned.
    pub pins: usize,
    /// The budget.
    pub evaluations: f64,
    /// Estimated strain of the edges at the pins, at rest.
    pub strain: f64,
}

/// The strain that `autoEvaluations` aims at.
const WANTED: f64 = 0.01;
/// The most evaluations that it takes, per 1/24 s.
const MOST: f64 = 10_000.0;
/// A sweep need not hold an edge stiffer than so many times its own stiffness: it stretches by itself.
const STIFFER: f64 = 4.0;

/// The estimate for the `index`th cloth of a nucleus; `None` where sweeps are not what limits it.
pub fn hanging(index: usize, cloth: &Cloth, input: &FrameInput) -> Option<Hanging> {
    let ResistanceModel::Physical { evaluations } = input.resistance else { return None };
    let settings = input.cloths.get(index)?;
    let points = cloth.surface.positions.len();
    let pins = pins(index, input).len();
    if !cloth.lists.stretch || pins == 0 || settings.tethers.is_some() || !settings.feels_gravity {
        return None;
    }
    let step = COUNT_PERIOD / evaluations;
    let load = (points - pins) as f64 / pins as f64;
    let strain = load * input.gravity.norm() * step * step / mean_edge(cloth)?;
    Some(Hanging { points, pins, evaluations, strain })
}

/// The evaluations in 1/24 s that leave a cloth stretched by about 1 % at rest; `None` where nothing stretches it.
fn evaluations(index: usize, cloth: &Cloth, input: &FrameInput) -> Option<f64> {
    let settings = input.cloths.get(index)?;
    let (edge, gravity) = (mean_edge(cloth)?, input.gravity.norm());
    if !cloth.lists.stretch || !settings.feels_gravity || gravity == 0.0 || settings.is_driven {
        return None;
    }
    let points = cloth.surface.positions.len();
    let (pins, across) = (pins(index, input).len(), extent(cloth) / edge / 2.0);
    let at_pins =
        if pins > 0 && settings.tethers.is_none() { (points - pins) as f64 / pins as f64 } else { 0.0 };
    let step = (WANTED * edge / (at_pins.max(across) * gravity)).sqrt();
    let PhysicalStiffness { stretch, warp, weft, .. } = PhysicalStiffness::of(settings);
    let mass = cloth.point_masses().iter().sum::<f64>() / points as f64;
    let shortest = (mass / (STIFFER * stretch.max(warp).max(weft))).sqrt();
    Some(COUNT_PERIOD / step.max(shortest))
}

/// Raises the budget of each nucleus whose `evaluations` are not given to the next ten of what its cloths need.
pub(super) fn choose(scene: &Scene, program: &mut Program, findings: &mut Findings) {
    let graph = &scene.graph;
    let needed = |(own, input): (&NucleusProgram, FrameInput)| {
        let node = graph.node(own.node());
        let default = node.get(&nucleus::EVALUATIONS);
        let is_chosen = node.get(&nucleus::AUTO_EVALUATIONS)
            && !graph.is_given(own.node(), &nucleus::EVALUATIONS)
            && matches!(input.resistance, ResistanceModel::Physical { .. });
        let cloths = own.model().cloths().iter().enumerate().filter(|_| is_chosen);
        let each = cloths.filter_map(|(index, cloth)| evaluations(index, cloth, &input));
        let most = each.fold(default, f64::max);
        (most > default).then(|| ((most / 10.0 - 1e-9).ceil() * 10.0).min(MOST))
    };
    let budgets = program.nuclei().iter().zip(program.first_inputs()).map(needed).collect();
    for node in program.nuclei().iter().map(NucleusProgram::node) {
        warn_if_given_twice(scene, node, findings);
    }
    program.set_budgets(budgets);
}

fn warn_if_given_twice(scene: &Scene, node: NodeId, findings: &mut Findings) {
    let graph = &scene.graph;
    let is_asked =
        graph.is_given(node, &nucleus::AUTO_EVALUATIONS) && graph.node(node).get(&nucleus::AUTO_EVALUATIONS);
    if is_asked && graph.is_given(node, &nucleus::EVALUATIONS) {
        let name = graph.node(node).name();
        let place = scene.source.place(&format!("{name}.{}", nucleus::AUTO_EVALUATIONS.row.name));
        let message = format!("`autoEvaluations` of `{name}` has no effect: `evaluations` is given");
        findings.warning(&place, message).help("leave out one of them");
    }
}

/// The pinned points of a cloth, each once.
fn pins(index: usize, input: &FrameInput) -> Vec<PointId> {
    let own = input.pins.iter().filter(|pin| pin.cloth.index() == index);
    let mut pins: Vec<_> = own.map(|pin| pin.point).collect();
    pins.sort_unstable();
    pins.dedup();
    pins
}

/// Mean length of the sides of the faces in metres; `None` without faces.
fn mean_edge(cloth: &Cloth) -> Option<f64> {
    let place = |point: u32| cloth.surface.positions[point as usize];
    let sides = cloth.surface.faces.iter().flat_map(|face| face.iter().zip(face.iter().cycle().skip(1)));
    let lengths = sides.map(|(&a, &b)| (place(a) - place(b)).norm());
    let (sum, count) = lengths.fold((0.0, 0.0), |(sum, count), length| (sum + length, count + 1.0));
    (sum > 0.0).then(|| sum / count)
}

/// The longest side of the box round a cloth at rest, in metres.
fn extent(cloth: &Cloth) -> f64 {
    let along = |axis: usize| {
        let all = cloth.surface.positions.iter().map(|point| point[axis]);
        let (low, high) = all.fold((f64::MAX, f64::MIN), |(low, high), x| (low.min(x), high.max(x)));
        (high - low).max(0.0)
    };
    along(0).max(along(1)).max(along(2))
}
