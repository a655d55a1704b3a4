//! How much energy a run may have, told from what goes into it, not from what comes out.
//!
//! Energy comes into cloth from four sides: weight and forces do work along the way that the points go; a change of
//! an attribute may make what is stretched or bent hold more, and so may held points that are drawn apart; and whatever moves by
//! itself (wind, colliders, held points) pushes. In the frame of something that moves at u, it does no work. So if
//! weight, forces and changes have brought w joules to m kilograms, the root mean square speed is never above
//! √(2 w / m) + 2 u, whatever pushed how often, as long as nothing bounces.
//!
//! What links hold is not counted with what moves: an unfinished solve leaves them longer than their stiffness says, and
//! what that would hold has never been there.

use nalgebra::Vector3;
use nucleus_core::{ClothId, FrameInput, PointId, Real, Solver, StateView};

/// The account of a run's energy.
#[derive(Debug, Clone, Default)]
pub struct EnergyBudget {
    /// Mass of each point, cloth by cloth, in kilograms.
    masses: Vec<Vec<f64>>,
    /// Where each point was when the frame began, in metres.
    before: Vec<Vec<Vector3<f64>>>,
    /// What has been brought in so far, in joules.
    supplied: f64,
    /// What links hold as the frame begins, in joules.
    held: f64,
    /// Whether held points are on their way in this frame.
    pins_move: bool,
    /// The fastest that anything that moves by itself has moved so far, in m/s.
    driver_speed: f64,
    /// The input of the frame, for what is reckoned when it has ended.
    input: Option<FrameInput>,
}

/// The energy of a run at the end of a frame.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Energy {
    /// Root mean square speed in m/s.
    pub speed: f64,
    /// The energy of its motion, over what it may have.
    pub share: f64,
}

impl EnergyBudget {
    /// For a solver at its start, whose cloths have so many points each. `initial_energy` is what the start holds besides,
    /// in joules: a cloth that starts inside a collider is lifted out of it.
    pub fn new<R: Real>(solver: &Solver<R>, points: &[usize], initial_energy: f64) -> Self {
        let mass = |(cloth, &count): (usize, &usize)| {
            (0..count).map(|k| solver.mass(ClothId(cloth as u32), PointId(k as u32))).collect()
        };
        let masses: Vec<Vec<f64>> = points.iter().enumerate().map(mass).collect();
        let before = places(solver, &masses);
        Self { masses, before, supplied: initial_energy, ..Self::default() }
    }

    /// A frame is about to begin.
    pub fn begin<R: Real>(&mut self, solver: &Solver<R>, input: &FrameInput) {
        // Before the first frame everything is at rest, whatever the attributes.
        let held = self.input.as_ref().map_or(0.0, |input| solver.elastic_energy(input));
        self.held = solver.elastic_energy(input);
        self.supplied += (self.held - held).max(0.0);
        self.driver_speed = self.driver_speed.max(driver_speed(input, solver));
        self.before = places(solver, &self.masses);
        self.pins_move = input.pins.iter().any(|pin| pin.start != pin.end);
        self.input = Some(FrameInput { colliders: Vec::new(), pins: Vec::new(), ..input.clone() });
    }

    /// The frame has ended.
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
                let way = solver.point(id, point) - self.before[cloth][point];
                self.supplied += finite_or_zero((weight * m + settings.local_force).dot(&way));
                let speed = velocities[point].map(f64::from);
                moving += m * Vector3::from(speed).norm_squared() / 2.0;
                mass += m;
            }
        }
        if self.pins_move {
            self.supplied += finite_or_zero(solver.elastic_energy(input) - self.held).max(0.0);
        }
        let speed = (2.0 * moving / mass).sqrt();
        let may = (2.0 * self.supplied.max(0.0) / mass).sqrt() + 2.0 * self.driver_speed + ROUNDING;
        Energy { speed, share: (speed / may).powi(2) }
    }
}

/// Speeds below this are taken for rounding, in m/s.
const ROUNDING: f64 = 1e-3;

/// What the solver is to leave out brings nothing.
fn finite_or_zero(work: f64) -> f64 {
    if work.is_finite() { work } else { 0.0 }
}

fn places<R: Real>(solver: &Solver<R>, masses: &[Vec<f64>]) -> Vec<Vec<Vector3<f64>>> {
    let of = |(cloth, points): (usize, &Vec<f64>)| {
        (0..points.len()).map(|k| solver.point(ClothId(cloth as u32), k)).collect()
    };
    masses.iter().enumerate().map(of).collect()
}

/// The fastest of what moves by itself in a frame, in m/s: wind where there is air, colliders, held points.
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

/// How fast each collider's fastest point goes.
fn colliders<R: Real>(input: &FrameInput, solver: &Solver<R>) -> Vec<f64> {
    let mut before = Vec::new();
    let fastest = |(id, collider): (u32, &nucleus_core::ColliderFrame)| {
        solver.collider_positions(nucleus_core::ColliderId(id), 1.0, &mut before);
        let ways = collider.end.iter().zip(&before).map(|(end, start)| {
            let start = Vector3::from(start.map(f64::from));
            (end - start).norm() / input.duration
        });
        ways.filter(|speed| speed.is_finite()).fold(0.0, f64::max)
    };
    (0..).zip(&input.colliders).map(fastest).collect()
}
