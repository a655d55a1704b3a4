//! Liquids: the rest distance of their particles, and how far these keep from each other and from walls.
//!
//! A particle of a liquid at rest stands for a cube whose edge is the rest distance. Density alone keeps particles apart, so
//! they collide as balls only where `selfCollide` is given; and a wall is at the face of the cube, so that a vessel holds
//! the volume of the particles that are poured into it, unless `collideWidthScale` is given.

use nalgebra::Vector3;
use nucleus_core::{COUNT_PERIOD, Liquid};

use crate::attributes::{Key, n_base, n_particle, nucleus};
use crate::graph::{EvalContext, Graph, NodeId};

use super::compiler::Compiler;
use super::program::EvaluationInterval;

/// Kinematic viscosity in m²/s at a `viscosity` of 1: about that of honey.
const HONEY: f64 = 0.01;
/// Surface tension over density in m³/s² at a `surfaceTension` of 1: its capillary length is 1 cm.
const CENTIMETRE_DROPS: f64 = 1e-3;
/// Distance of particles from a wall where `collideWidthScale` is not given, in rest distances.
const WALL_DISTANCE: f64 = 0.5;
/// Density of water in kg/m³, and that beyond which a liquid is warned of: no metal has it.
const WATER: f64 = 1000.0;
const MAX_DENSITY: f64 = 25_000.0;
/// Contact distance beyond which a liquid is warned of, as a multiple of the natural one.
const MAX_DISTANCE: f64 = 1.25;

/// Distance of the particles of a liquid at rest, in scene units: `restDensity` balls of the radius times `radiusScaleSPH`
/// overlap each point.
pub(super) fn rest_distance(at: &EvalContext<'_>, node: NodeId) -> f64 {
    let number = |key: &Key<f64>| at.get(node, key);
    let radius = number(&n_particle::RADIUS) * number(&n_particle::RADIUS_SCALE_SPH);
    let volume = 4.0 / 3.0 * std::f64::consts::PI / number(&n_particle::REST_DENSITY);
    // Newton's iteration for the cube root, the same bits on every machine; the volume is at most 4.2.
    radius * (0..32).fold(1.0, |root: f64, _| root - (root - volume / (root * root)) / 3.0)
}

/// The contact thickness of particles in scene units: the radius; that of a liquid, half the rest distance unless it is given.
pub(super) fn contact_radius(at: &EvalContext<'_>, node: NodeId) -> f64 {
    let (key, radius) = (&n_particle::COLLIDE_WIDTH_SCALE, at.get(node, &n_particle::RADIUS));
    match at.graph().is_given(node, key) {
        true => radius * at.get(node, key).max(0.0),
        false if is_liquid(at, node) => WALL_DISTANCE * rest_distance(at, node),
        false => radius,
    }
}

/// Whether an object collides with itself at a frame. A liquid does where `selfCollide` is given.
pub(crate) fn self_collides(at: &EvalContext<'_>, node: NodeId) -> bool {
    at.get(node, &n_base::SELF_COLLIDE)
        && (at.graph().is_given(node, &n_base::SELF_COLLIDE) || !is_liquid(at, node))
}

/// Whether particles collide with themselves at any frame.
pub(super) fn ever_self_collides(graph: &Graph, node: NodeId) -> bool {
    let is_given = graph.is_given(node, &n_base::SELF_COLLIDE);
    let is_always_liquid =
        || !graph.changes(node, &n_particle::ENABLE_SPH) && is_liquid(&graph.at(0.0), node);
    graph.is_ever_nonzero(node, &n_base::SELF_COLLIDE) && (is_given || !is_always_liquid())
}

pub(super) fn is_liquid(at: &EvalContext<'_>, node: NodeId) -> bool {
    let has_it = at.graph().node(node).node_type().attribute(n_particle::ENABLE_SPH.row.name).is_some();
    has_it && at.get(node, &n_particle::ENABLE_SPH)
}

impl EvaluationInterval<'_> {
    /// The liquid of a node in a frame, if it is one.
    pub(super) fn liquid(&self, node: NodeId) -> Option<Liquid> {
        if !self.to.get(node, &n_particle::ENABLE_SPH) {
            return None;
        }
        let number = |key: &Key<f64>| self.to.get(node, key);
        let viscosity = number(&n_particle::VISCOSITY);
        Some(Liquid {
            spacing: self.nucleus.units.length(rest_distance(&self.to, node)),
            incompressibility: number(&n_particle::INCOMPRESSIBILITY),
            viscosity: HONEY * viscosity * viscosity,
            surface_tension: CENTIMETRE_DROPS * number(&n_particle::SURFACE_TENSION),
        })
    }
}

impl Compiler<'_> {
    /// Reports a liquid without a rest distance, and warns of one that contact keeps from it, at the first frame. `None`
    /// after an error.
    pub(super) fn check_liquid(&mut self, node: NodeId) -> Option<()> {
        if !is_liquid(&self.start, node) {
            return Some(());
        }
        let graph = &self.scene.graph;
        let name = graph.node(node).name();
        let rest = rest_distance(&self.start, node);
        if rest <= 0.0 {
            let message =
                format!("the liquid `{name}` has no rest distance: `radius` × `radiusScaleSPH` is 0");
            let error = self.findings.error(&self.place(node, &n_particle::RADIUS.row), message);
            error.help("give it a `radius` above 0");
            return None;
        }
        let width = contact_radius(&self.start, node);
        let apart = 2.0 * width * self.start.get(node, &n_particle::SELF_COLLIDE_WIDTH_SCALE).max(0.0);
        if self_collides(&self.start, node) && apart > MAX_DISTANCE * rest {
            let message = format!(
                "`selfCollide` keeps the particles of the liquid `{name}` {apart:.3} apart, but at rest they are {rest:.3} \
                 apart: it takes up to {:.0} times its volume",
                (apart / rest).powi(3)
            );
            let place = self.place(node, &n_base::SELF_COLLIDE.row);
            let help = "leave out `selfCollide`: the density of the liquid keeps its particles apart";
            self.findings.warning(&place, message).help(help);
        }
        if width > MAX_DISTANCE * WALL_DISTANCE * rest {
            let message = format!(
                "`collideWidthScale` keeps the liquid `{name}` {width:.3} away from walls, where half of its rest distance \
                 is {:.3}: it stands too high in a vessel",
                WALL_DISTANCE * rest
            );
            let place = self.place(node, &n_particle::COLLIDE_WIDTH_SCALE.row);
            let help =
                "leave out `collideWidthScale`: the liquid then touches walls with half of its rest distance";
            self.findings.warning(&place, message).help(help);
        }
        Some(())
    }

    /// Warns of a liquid that is heavier than any metal, at the first frame. `kilograms` is the mass of a particle.
    pub(super) fn warn_of_mass(&mut self, node: NodeId, kilograms: f64) {
        if !is_liquid(&self.start, node) {
            return;
        }
        let volume = self.program.units.length(rest_distance(&self.start, node)).powi(3);
        if kilograms <= MAX_DENSITY * volume {
            return;
        }
        let name = self.scene.graph.node(node).name();
        let message = format!("the liquid `{name}` weighs {:.0} kg/m³, and water 1000", kilograms / volume);
        let help =
            format!("write `pointMass: {:.2e}` for water: a particle stands for that volume", WATER * volume);
        self.findings.warning(&self.place(node, &n_particle::POINT_MASS.row), message).help(help);
    }

    /// Warns of a liquid that the air lets fall at a lower terminal speed than a fall over its own height gives, at the first
    /// frame. `kilograms` is the mass of a particle. A liquid without particles yet is as high as its rest distance.
    pub(super) fn warn_of_drag(&mut self, node: NodeId, places: &[Vector3<f64>], kilograms: f64) {
        let at = &self.start;
        if !is_liquid(at, node) || at.get(node, &n_particle::IGNORE_SOLVER_GRAVITY) {
            return;
        }
        let of_nucleus = |key: &Key<f64>| at.get(self.program.node, key);
        let gravity = of_nucleus(&nucleus::GRAVITY).abs();
        let rate =
            at.get(node, &n_particle::DRAG) * of_nucleus(&nucleus::AIR_DENSITY) / kilograms / COUNT_PERIOD;
        let down = Vector3::from(at.get(self.program.node, &nucleus::GRAVITY_DIRECTION));
        let Some(down) = down.try_normalize(0.0) else { return };
        let heights = places.iter().map(|place| down.dot(place));
        let [low, high] = heights.fold([f64::MAX, f64::MIN], |[a, b], y| [a.min(y), b.max(y)]);
        let height = self.program.units.length((high - low).max(rest_distance(at, node)));
        let (terminal, fall) = (gravity / rate, (2.0 * gravity * height).sqrt());
        if rate <= 0.0 || terminal >= fall {
            return;
        }
        let name = self.scene.graph.node(node).name();
        let message = format!(
            "`drag` lets the liquid `{name}` fall at no more than {terminal:.4} m/s: a fall over its own height of {height:.3} m \
             gives {fall:.2} m/s"
        );
        let help = "write `drag: 0`: the air hardly slows a liquid, and `viscosity` makes it thick";
        self.findings.warning(&self.place(node, &n_particle::DRAG.row), message).help(help);
    }
}
