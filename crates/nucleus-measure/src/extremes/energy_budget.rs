//! Upper bound of the kinetic energy of a run, from the energy supplied to it.
//!
//! Gravity and forces supply energy along the displacement of the points. A change of an attribute may raise elastic
//! energy, and so may pins that move apart. Drivers (wind, colliders, pins) push; in the frame of reference of a driver
//! that moves at u, it does no work. If gravity, forces and changes supply w joules to m kilograms, the root mean
//! square speed never exceeds √(2 w / m) + 2 u, independent of the number of pushes, as long as nothing bounces.
//!
//! Elastic energy does not count as motion: an unconverged solve leaves links longer than their stiffness implies, and
//! that energy was never supplied.

use nalgebra::Vector3;
use nucleus_core::{ClothId, FrameInput, PointId, Real, Solver, StateView};

/// Energy supplied to a run.
#[derive(Debug, Clone, Default)]
pub struct EnergyBudget {
    /// Mass of each point, cloth by cloth, in kilograms.
    masses: Vec<Vec<f64>>,
    /// Positions at the start of the frame, in metres.
    before: Vec<Vec<Vector3<f64>>>,
    /// Energy supplied so far, in joules.
    supplied: f64,
    /// Elastic energy at the start of the frame, in joules.
    held: f64,
    /// Whether pins move in this frame.
    pins_move: bool,
    /// Maximum speed of a driver so far, in m/s.
    driver_speed: f64,
    /// Input of the frame, for the end of the frame.
    input: Option<FrameInput>,
}

/// Motion at the end of a frame.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Energy {
    /// Root mean square speed in m/s.
    pub speed: f64,
    /// Kinetic energy over its upper bound.
    pub ratio: f64,
}

impl EnergyBudget {
    /// For a solver in its initial state, whose cloths have `points` points. `initial_energy` is the energy of that state in
    /// joules, besides potential and elastic energy: depenetration lifts a cloth that starts inside a collider.
    pub fn new<R: Real>(solver: &Solver<R>, points: &[usize], initial_energy: f64) -> Self {
        let mass = |(cloth, &count): (usize, &usize)| {
            (0..count).map(|k| solver.mass(ClothId(cloth as u32), PointId(k as u32))).collect()
        };
        let masses: Vec<Vec<f64>> = points.iter().enumerate().map(mass).collect();
        let before = places(solver, &masses);
        Self { masses, before, supplied: initial_energy, ..Self::default() }
    }

    /// Starts a frame.
    pub fn begin<R: Real>(&mut self, solver: &Solver<R>, input: &FrameInput) {
        // The initial state is unstrained, whatever the attributes.
        let held = self.input.as_ref().map_or(0.0, |input| solver.elastic_energy(input));
        self.held = solver.elastic_energy(input);
        self.supplied += (self.held - held).max(0.0);
        self.driver_speed = self.driver_speed.max(driver_speed(input, solver));
        self.before = places(solver, &self.masses);
        self.pins_move = input.pins.iter().any(|pin| pin.start != pin.end);
        self.input = Some(FrameInput { colliders: Vec::new(), pins: Vec::new(), ..input.clone() });
    }

    /// Ends a frame.
    pub fn end<R: Real>(&mut self, solver: &Solver<R>) -> Energy {
        let Some(input) = &self.input else { return Energy::default() };
        let (mut mass, mut moving) = (0.0, 0.0);
        let mut velocities = Vec::new();
        for (cloth, masses) in self.masses.iter().enumerate() {
            let id = ClothId(cloth as u32);
            let settings = &input.cloths[cloth];
            let weight = if settings.feels_gravity { input.gravity } else { Vector3::zeros() };
            solver.velocities(id, 1.0, &mut velocities);
            for (point, &m) in masses.iter().enumerate() {
                let displacement = solver.point(id, point) - self.before[cloth][point];
                self.supplied += finite_or_zero((weight * m + settings.local_force).dot(&displacement));
                let speed = velocities[point].map(f64::from);
                moving += m * Vector3::from(speed).norm_squared() / 2.0;
                mass += m;
            }
        }
        if self.pins_move {
            self.supplied += finite_or_zero(solver.elastic_energy(input) - self.held).max(0.0);
        }
        let speed = (2.0 * moving / mass).sqrt();
        let bound = (2.0 * self.supplied.max(0.0) / mass).sqrt() + 2.0 * self.driver_speed + ROUNDING;
        Energy { speed, ratio: (speed / bound).powi(2) }
    }
}

/// Tolerance of speeds for rounding, in m/s.
const ROUNDING: f64 = 1e-3;

/// Input that the solver ignores supplies no energy.
fn finite_or_zero(work: f64) -> f64 {
    if work.is_finite() { work } else { 0.0 }
}

fn places<R: Real>(solver: &Solver<R>, masses: &[Vec<f64>]) -> Vec<Vec<Vector3<f64>>> {
    let of = |(cloth, points): (usize, &Vec<f64>)| {
        (0..points.len()).map(|k| solver.point(ClothId(cloth as u32), k)).collect()
    };
    masses.iter().enumerate().map(of).collect()
}

/// Maximum speed of the drivers in a frame, in m/s: wind where there is air, colliders, pins.
fn driver_speed<R: Real>(input: &FrameInput, solver: &Solver<R>) -> f64 {
    let wind = |cloth: &nucleus_core::ClothFrame| {
        let solver = if cloth.feels_wind { input.wind } else { Vector3::zeros() };
        let felt = input.air_density > 0.0 && (cloth.drag > 0.0 || cloth.lift != 0.0);
        if felt { (solver + cloth.local_wind).norm() } else { 0.0 }
    };
    let winds = input.cloths.iter().map(wind);
    let pins = input.pins.iter().map(|pin| {
        let jump = pin.start - solver.point(pin.cloth, pin.point.index());
        ((pin.end - pin.start).norm() + jump.norm()) / input.duration
    });
    let finite = winds.chain(pins).filter(|speed| speed.is_finite());
    finite.chain(colliders(input, solver)).fold(0.0, f64::max)
}

/// Maximum speed of the points of each collider, in m/s.
fn colliders<R: Real>(input: &FrameInput, solver: &Solver<R>) -> Vec<f64> {
    let mut before = Vec::new();
    let fastest = |(id, collider): (u32, &nucleus_core::ColliderFrame)| {
        solver.collider_positions(nucleus_core::ColliderId(id), 1.0, &mut before);
        let speeds = collider.end.iter().zip(&before).map(|(end, start)| {
            let start = Vector3::from(start.map(f64::from));
            (end - start).norm() / input.duration
        });
        speeds.filter(|speed| speed.is_finite()).fold(0.0, f64::max)
    };
    (0..).zip(&input.colliders).map(fastest).collect()
}
