//! How far sweeps leave cloth stretched, estimated from its mesh, and the budget of a nucleus without `evaluations`.
//!
//! In a step of h seconds a sweep holds an edge no stiffer than about m / h², whatever its resistance is. An edge of length
//! d between points of mass m that carries N times that mass at rest is therefore stretched by N g h² / d: a small mesh
//! needs short steps. Where cloth hangs by P pins, each edge beside them carries a P-th of its mass; where the mass is
//! uniform that is (points - P) / P points, and in proportion more where particles lie in it, as water in a bag. Elsewhere
//! an edge carries at most half the cloth in a line, as over the edge of a table. Inflated cloth is in `inflation.rs`.

use nalgebra::Vector3;
use nucleus_core::{COUNT_PERIOD, Cloth, FrameInput, PhysicalStiffness, PointId, ResistanceModel};

use crate::attributes::nucleus;
use crate::diagnostic::Findings;
use crate::graph::NodeId;
use crate::scene::document::Scene;

pub use super::inflation::Inflated;
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
/// The most evaluations that it takes, per 1/24 s: 20 times the cost of the default. Where the estimate is larger, the
/// load is one that sweeps do not carry at any budget, and tethers do.
pub const MAX_BUDGET: f64 = 2_000.0;
/// A sweep need not hold an edge stiffer than so many times its own stiffness: it stretches by itself.
const STIFFER: f64 = 4.0;

/// The estimate for the `index`th cloth of a nucleus; `None` where sweeps are not what limits it.
pub fn hanging(index: usize, cloths: &[Cloth], input: &FrameInput) -> Option<Hanging> {
    let ResistanceModel::Physical { evaluations } = input.resistance else { return None };
    let (cloth, settings) = (cloths.get(index)?, input.cloths.get(index)?);
    let points = cloth.surface.positions.len();
    let pins = pins(index, input);
    if !cloth.lists.stretch || pins.is_empty() || settings.tethers.is_some() || !settings.feels_gravity {
        return None;
    }
    let step = COUNT_PERIOD / evaluations;
    let load = load_at_pins(cloth, &pins) * (1.0 + carried(index, cloths, input));
    let strain = load * input.gravity.norm() * step * step / mean_edge(cloth)?;
    Some(Hanging { points, pins: pins.len(), evaluations, strain })
}

/// The evaluations in 1/24 s that leave a cloth stretched by about 1 % at rest; `None` where nothing stretches it.
fn evaluations(
    index: usize,
    cloths: &[Cloth],
    input: &FrameInput,
    inflated: Option<Inflated>,
) -> Option<f64> {
    let (cloth, settings) = (cloths.get(index)?, input.cloths.get(index)?);
    if !cloth.lists.stretch || settings.is_driven {
        return None;
    }
    let pins = pins(index, input);
    let held = if settings.tethers.is_none() { &pins[..] } else { &[] };
    let weight = step_under_weight(index, cloths, input, held);
    let step = weight.into_iter().chain(inflated.map(|inflated| inflated.step(WANTED))).reduce(f64::min)?;
    let PhysicalStiffness { stretch, warp, weft, .. } = PhysicalStiffness::of(settings);
    let mass = cloth.point_masses().iter().sum::<f64>() / cloth.surface.positions.len() as f64;
    let lightest = mass / lightness(cloth, held).max(1.0);
    let shortest = (lightest / (STIFFER * stretch.max(warp).max(weft))).sqrt();
    Some(COUNT_PERIOD / step.max(shortest))
}

/// The time step in seconds that leaves a cloth stretched by about 1 % by its weight; `None` without weight.
fn step_under_weight(index: usize, cloths: &[Cloth], input: &FrameInput, held: &[PointId]) -> Option<f64> {
    let (cloth, gravity) = (&cloths[index], input.gravity.norm());
    if !input.cloths[index].feels_gravity || gravity == 0.0 {
        return None;
    }
    let edge = mean_edge(cloth)?;
    let across = extent(cloth) / edge / 2.0;
    let load = (load_at_pins(cloth, held) * (1.0 + carried(index, cloths, input))).max(across);
    Some((WANTED * edge / (load * gravity)).sqrt())
}

/// Raises the budget of each nucleus whose `evaluations` are not given to the next ten of what its cloths need.
pub(super) fn choose(scene: &Scene, built: &mut Program, findings: &mut Findings) {
    let (graph, program) = (&scene.graph, &*built);
    let needed = |(at, (own, input)): (usize, (&NucleusProgram, FrameInput))| {
        let node = graph.node(own.node());
        let default = node.get(&nucleus::EVALUATIONS);
        let is_chosen = node.get(&nucleus::AUTO_EVALUATIONS)
            && !graph.is_given(own.node(), &nucleus::EVALUATIONS)
            && matches!(input.resistance, ResistanceModel::Physical { .. });
        let cloths = own.model().cloths();
        let each = (0..cloths.len())
            .filter(|_| is_chosen)
            .filter_map(|index| evaluations(index, cloths, &input, Inflated::of(program, at, index, &input)));
        let most = each.fold(default, f64::max);
        (most > default).then(|| ((most / 10.0 - 1e-9).ceil() * 10.0).min(MAX_BUDGET))
    };
    let budgets = program.nuclei().iter().zip(program.first_inputs()).enumerate().map(needed).collect();
    for node in program.nuclei().iter().map(NucleusProgram::node) {
        warn_if_given_twice(scene, node, findings);
    }
    built.set_budgets(budgets);
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

/// What an edge beside a pin carries, over the mass of a point there; 0 without pins.
fn load_at_pins(cloth: &Cloth, pins: &[PointId]) -> f64 {
    let free = cloth.surface.positions.len() - pins.len();
    if pins.is_empty() { 0.0 } else { lightness(cloth, pins) * free as f64 / pins.len() as f64 }
}

/// The mass of the particles that start in the box round a cloth, which is what it holds if it hangs, over its own mass.
fn carried(index: usize, cloths: &[Cloth], input: &FrameInput) -> f64 {
    let cloth = &cloths[index];
    let mut bounds = [Vector3::repeat(f64::MAX), Vector3::repeat(f64::MIN)];
    for point in &cloth.surface.positions {
        bounds = [bounds[0].inf(point), bounds[1].sup(point)];
    }
    let is_inside =
        |point: &Vector3<f64>| (0..3).all(|k| bounds[0][k] <= point[k] && point[k] <= bounds[1][k]);
    let particles = cloths.iter().zip(&input.cloths).filter(|(other, settings)| {
        other.surface.faces.iter().next().is_none() && settings.collide && settings.feels_gravity
    });
    let held = particles.flat_map(|(other, _)| other.surface.positions.iter().zip(other.point_masses()));
    let held: f64 = held.filter(|(point, _)| is_inside(point)).map(|(_, mass)| mass).sum();
    let own: f64 = cloth.point_masses().iter().sum();
    if own > 0.0 && input.cloths[index].collide { held / own } else { 0.0 }
}

/// The mean mass of a point over that of the points beside the pins; 1 without pins. By faces, because a point of the
/// border has half the mass of its neighbours.
fn lightness(cloth: &Cloth, pins: &[PointId]) -> f64 {
    let is_held = |face: &[u32]| face.iter().any(|&point| pins.binary_search(&PointId(point)).is_ok());
    let (mut all, mut held) = (Mean::default(), Mean::default());
    for (face, mass) in cloth.surface.faces.iter().zip(face_masses(cloth)) {
        all.add(mass);
        if is_held(face) {
            held.add(mass);
        }
    }
    if held.sum > 0.0 { all.mean() / held.mean() } else { 1.0 }
}

#[derive(Default)]
struct Mean {
    sum: f64,
    count: f64,
}

impl Mean {
    fn add(&mut self, x: f64) {
        (self.sum, self.count) = (self.sum + x, self.count + 1.0);
    }

    fn mean(&self) -> f64 {
        self.sum / self.count
    }
}

/// The mass of each face: of each corner, its share in the mass of the point.
fn face_masses(cloth: &Cloth) -> impl Iterator<Item = f64> + '_ {
    let mut shares = cloth.point_masses();
    let mut faces = vec![0.0; shares.len()];
    cloth.surface.faces.corners().iter().for_each(|&point| faces[point as usize] += 1.0);
    shares.iter_mut().zip(&faces).for_each(|(mass, faces)| *mass /= f64::max(*faces, 1.0));
    cloth.surface.faces.iter().map(move |face| face.iter().map(|&point| shares[point as usize]).sum())
}

/// Mean length of the sides of the faces in metres; `None` without faces.
fn mean_edge(cloth: &Cloth) -> Option<f64> {
    let place = |point: u32| cloth.surface.positions[point as usize];
    let sides = cloth.surface.faces.iter().flat_map(|face| face.iter().zip(face.iter().cycle().skip(1)));
    let lengths = sides.map(|(&a, &b)| (place(a) - place(b)).norm());
    let mut mean = Mean::default();
    lengths.for_each(|length| mean.add(length));
    (mean.sum > 0.0).then(|| mean.mean())
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
