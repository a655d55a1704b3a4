//! Liquids: particles with constant volume, viscosity and surface tension (position-based fluids: Macklin &
//! Müller 2013).
//!
//! A pass comes first in each time step of the liquid ([`time_step`]), on the predicted positions: neighbours, then
//! viscosity and surface tension, then density as a constraint. Contact follows, and corrections become velocities as those
//! of all constraints do. Inside, lengths are in rest distances, from where its first particle begins the frame.
//!
//! A liquid is set up again at the start of each frame, so a checkpoint stores nothing of it, and after births and
//! deaths. Within a frame it keeps the pressure of each particle, and the [excess] of density that the solver has left.
//!
//! | You want to know… | Read |
//! |---|---|
//! | the kernel, and that of a half-space | [`kernel`] |
//! | neighbour search | [`grid`], [`neighbours`], [`near`], [`pair`] |
//! | density, and the solver of pressure | [`density`] |
//! | particles that begin in one place | [`coincident`] |
//! | how fast an excess of density goes | [`excess`] |
//! | ground plane, colliders, cloth and other particles beside a liquid | `find_walls`, [`walls`], `wall_samples`, [`ball`] |
//! | viscosity and surface tension | [`viscosity`], `connected_bodies`, [`surface_tension`] |
//! | how long its time steps are | [`time_step`] |

pub mod ball;
pub mod coincident;
mod connected_bodies;
pub mod density;
pub mod excess;
mod find_walls;
pub mod grid;
pub mod kernel;
pub mod near;
pub mod neighbours;
pub mod pair;
pub mod step;
pub mod surface_tension;
pub mod time_step;
pub mod viscosity;
mod wall_samples;
pub mod walls;

use nalgebra::Vector3;

use crate::math::Real;
use crate::model::Model;
use crate::parallel::disjoint::DisjointSlice;
use crate::parallel::thread_pool::ThreadPool;
use crate::particles::population::Population;
use crate::schedule::{StepInterval, TimeStep};
use crate::state::State;

use density::{Accept, Density, Load};
use excess::Excess;
use find_walls::WallSearch;
use neighbours::{CHUNK, Neighbours, chunk_range};
use step::{LiquidScene, LiquidStep};
use surface_tension::SurfaceTension;
use time_step::{LiquidInterval, LiquidMotion};
use viscosity::Viscosity;
use walls::Walls;

/// Speed of sound in m/s of a liquid with an `incompressibility` of one half.
const SOFT_SOUND: f64 = 10.0;

/// State of a liquid within a frame.
#[derive(Debug, Default)]
pub struct LiquidSolver {
    neighbours: Neighbours,
    walls: Walls,
    density: Density,
    viscosity: Viscosity,
    surface_tension: SurfaceTension,
    /// Multiplier of each particle over the squared time step.
    pressure: Vec<f32>,
    excess: Excess,
    positions: Vec<[f32; 3]>,
    velocities: Vec<[f32; 4]>,
    loads: Vec<Load>,
    /// Factors on viscosity, in the sorted order; empty where they are 1.
    factors: Vec<f32>,
    /// Where lengths are taken from in this frame, in metres.
    origin: Vector3<f64>,
    density_error: f64,
    /// The births and deaths of its particles that the columns by particle follow.
    topology: u64,
    /// The time step that it is in; `None` for a cloth that is no liquid.
    interval: Option<LiquidInterval>,
}

impl LiquidSolver {
    /// Begins a frame.
    pub fn begin_frame(&mut self) {
        self.interval = None;
        self.pressure.clear();
        self.density_error = 0.0;
    }

    /// Begins a time step of the nucleus; nothing changes where the cloth, by its index, is no liquid.
    pub fn begin_step<R: Real>(
        &mut self,
        cloth: usize,
        model: &Model<R>,
        state: &State<R>,
        now: &TimeStep<'_, R>,
    ) {
        let TimeStep { frame, schedule, span, .. } = *now;
        let Some(settings) = &frame.cloths[cloth].liquid else { return };
        let motion = LiquidMotion { model, state, frame, cloth, settings };
        let wanted = || motion.wanted_step();
        let interval = self.interval.unwrap_or_default();
        self.interval = Some(interval.next(schedule, frame.duration, span, wanted));
    }

    /// For how many seconds external forces act on the cloth in this time step of the nucleus of `h` seconds.
    pub fn seconds_of_forces(&self, h: f64) -> f64 {
        self.interval.map_or(h, |interval| interval.starts)
    }

    /// Mean excess of density of its particles; 0 where there is no liquid.
    pub fn density_error(&self) -> f64 {
        self.density_error
    }
}

impl LiquidSolver {
    /// One pass over a liquid, which is a cloth by its index, in a time step of the nucleus of `h` seconds. Does nothing
    /// where the time step of the liquid goes on.
    pub fn relax<R: Real>(
        &mut self,
        cloth: usize,
        scene: LiquidScene<'_, R>,
        state: &mut State<R>,
        h: f64,
        span: StepInterval,
        pool: &ThreadPool,
    ) {
        let rows = scene.model.cloths[cloth].points();
        let Some(settings) = scene.frame.cloths[cloth].liquid.filter(|_| !rows.is_empty()) else { return };
        let Some(interval) = self.interval.filter(|interval| interval.starts > 0.0) else { return };
        // A birth and a death in one frame leave the number of particles as it is.
        let topology = state.population_of(cloth).map_or(0, Population::topology);
        let begins = self.pressure.len() != rows.len() || self.topology != topology;
        self.topology = topology;
        if begins {
            self.origin = Vector3::from(state.position(rows.start));
            self.walls.forget();
        }
        let inverse_mass = state.inverse_mass[rows.start as usize].to_f64();
        let (ahead, span) = (interval.starts - h, StepInterval { to: interval.end, ..span });
        let step = LiquidStep {
            cloth,
            settings,
            origin: self.origin,
            inverse_mass,
            h: interval.starts,
            ahead,
            span,
        };
        if begins {
            self.pressure.clear();
            self.pressure.resize(rows.len(), 0.0);
            self.viscosity.forget();
        }
        self.gather(scene, state, &step);
        self.find_walls(scene, state, &step);
        self.neighbours.find(&self.positions, &self.walls, pool);
        self.measure_excess(scene, state, &step, begins, pool);
        self.load(rows.start, state, &step, pool);
        self.solve(rows.start, state, &step, pool);
    }
}

impl LiquidSolver {
    /// Measures the excess of density before the time step, where the step must know it. That of a compressible liquid
    /// follows from its pressure.
    fn measure_excess<R: Real>(
        &mut self,
        scene: LiquidScene<'_, R>,
        state: &State<R>,
        step: &LiquidStep,
        begins: bool,
        pool: &ThreadPool,
    ) {
        let any = self.excess.choose(&self.neighbours, step.recovery(), begins);
        if any && step.settings.incompressibility >= 1.0 {
            let span = StepInterval { to: step.span.from, ..step.span };
            let start = LiquidStep { ahead: step.ahead - step.h, span, ..*step };
            self.gather(scene, state, &start);
            self.find_walls(scene, state, &start);
            self.excess.measure(&self.positions, &self.walls, pool);
            self.gather(scene, state, step);
            self.find_walls(scene, state, step);
        }
        if begins {
            self.excess.begin();
        }
    }

    /// Takes up the positions of the particles at the end of the time step, at constant velocity.
    fn gather<R: Real>(&mut self, scene: LiquidScene<'_, R>, state: &State<R>, step: &LiquidStep) {
        let (per_metre, ahead) = (1.0 / step.settings.spacing, R::from_f64(step.ahead));
        self.positions.clear();
        self.positions.extend(scene.model.cloths[step.cloth].points().map(|row| {
            let row = row as usize;
            let (moved, velocity) = (state.displacement[row].xyz(), state.velocity[row].xyz());
            std::array::from_fn(|axis| {
                let at = state.anchor[row][axis] - step.origin[axis];
                ((at + (moved[axis] + velocity[axis] * ahead).to_f64()) * per_metre) as f32
            })
        }));
    }

    /// Finds the walls near the liquid, at the end of the time step.
    fn find_walls<R: Real>(&mut self, scene: LiquidScene<'_, R>, state: &State<R>, step: &LiquidStep) {
        WallSearch::new(scene, state, step).find(&mut self.walls, grid::bounds(&self.positions));
    }

    /// Computes the load of the pressure solver, after viscosity and surface tension.
    fn load<R: Real>(&mut self, first: u32, state: &State<R>, step: &LiquidStep, pool: &ThreadPool) {
        let [thickens, pulls] =
            state.population_of(step.cloth).map_or([&[][..]; 2], Population::liquid_factors);
        if step.settings.viscosity > 0.0 {
            self.take_factors(thickens);
            self.apply_viscosity(first, state, step, pool);
        }
        if step.settings.surface_tension > 0.0 {
            self.surface_tension.find(&self.positions, pulls, pool);
        }
        let Self { neighbours, density, viscosity, surface_tension, pressure, excess, loads, .. } = self;
        let LiquidStep { settings, h, .. } = *step;
        let order = neighbours.grid.order();
        let per_metre = 1.0 / settings.spacing;
        let tension = (settings.surface_tension * (per_metre * per_metre) * per_metre) as f32;
        let pull = surface_tension::strength(tension) * (h * h) as f32;
        let recovery = step.recovery();
        density.lambda.resize(order.len(), 0.0);
        loads.resize(order.len(), Load::default());
        let (lambda, loads) = (DisjointSlice::new(&mut density.lambda), DisjointSlice::new(loads));
        let (excess, before) = (DisjointSlice::new(&mut excess.left), &excess.before[..]);
        pool.parallel_for(order.len().div_ceil(CHUNK as usize), |chunk| {
            let range = chunk_range(chunk, order.len());
            // SAFETY: chunks do not overlap.
            #[allow(unsafe_code)]
            let (lambda, loads) = unsafe { (lambda.run(range.clone()), loads.run(range.clone())) };
            for (k, at) in range.map(|at| at as usize).enumerate() {
                let particle = order[at];
                let is_free = state.displacement[(first + particle) as usize].0[3] > R::ZERO;
                let mut moved = [0.0f32; 3];
                if settings.viscosity > 0.0 {
                    moved = std::array::from_fn(|axis| viscosity.change[at][axis] * h as f32);
                }
                if tension > 0.0 {
                    let pulled = surface_tension.pull[particle as usize];
                    (0..3).for_each(|axis| moved[axis] += pull * pulled[axis]);
                }
                let now = neighbours.sums[at][0] - 1.0;
                // SAFETY: the order holds each particle once.
                #[allow(unsafe_code)]
                let kept = unsafe {
                    let kept = match settings.incompressibility < 1.0 {
                        true => 0.0,
                        false => recovery.kept(now, excess.get(particle), before[particle as usize]),
                    };
                    excess.set(particle, kept);
                    kept
                };
                let inverse_mass = if is_free { 1.0 } else { 0.0 };
                loads[k] = Load { excess: now - kept, inverse_mass, moved: moved.map(|x| x * inverse_mass) };
                lambda[k] = pressure[particle as usize] * (h * h) as f32;
            }
        });
    }

    /// Takes up the factors by particle on viscosity, in the sorted order.
    fn take_factors(&mut self, by_particle: &[f32]) {
        self.factors.clear();
        if !by_particle.is_empty() {
            let order = self.neighbours.grid.order();
            self.factors.extend(order.iter().map(|&particle| by_particle[particle as usize]));
        }
    }

    /// Solves for the change of velocity by viscosity.
    fn apply_viscosity<R: Real>(
        &mut self,
        first: u32,
        state: &State<R>,
        step: &LiquidStep,
        pool: &ThreadPool,
    ) {
        let Self { neighbours, viscosity, velocities, factors, .. } = self;
        let per_metre = 1.0 / step.settings.spacing;
        velocities.clear();
        velocities.extend(neighbours.grid.order().iter().map(|&particle| {
            let velocity = state.velocity[(first + particle) as usize].xyz();
            let [x, y, z] = velocity.map(|x| (x.to_f64() * per_metre) as f32);
            [x, y, z, 0.0]
        }));
        let rate = (step.settings.viscosity * step.h * (per_metre * per_metre)) as f32;
        viscosity.solve(neighbours, velocities, (factors, rate), pool);
    }

    /// Solves for the pressure, and moves the particles and the cloth beside them.
    fn solve<R: Real>(&mut self, first: u32, state: &mut State<R>, step: &LiquidStep, pool: &ThreadPool) {
        let Self { neighbours, walls, density, pressure, excess, loads, .. } = self;
        let LiquidStep { settings, h, ahead, .. } = *step;
        let softness = 1.0 - settings.incompressibility.clamp(0.0, 1.0);
        // The pressure over density is c² times the excess, with the speed of sound c.
        let sound = SOFT_SOUND * settings.incompressibility / softness.max(1e-9);
        let compliance = settings.spacing / (h * sound).max(1e-9);
        let compliance = if softness > 0.0 { (compliance * compliance).min(1e12) as f32 } else { 0.0 };
        let accept = if settings.surface_tension > 0.0 { Accept::Residual } else { Accept::Excess };
        density.solve(neighbours, loads, walls, (compliance, accept), pool);
        let displacement = &mut state.displacement;
        let in_step = (h - ahead) / h;
        let metres = |moved: f32| R::from_f64(f64::from(moved) * settings.spacing * in_step);
        let mut sum = 0.0f64;
        for (at, &particle) in neighbours.grid.order().iter().enumerate() {
            let row = &mut displacement[(first + particle) as usize];
            (0..3).for_each(|axis| row.0[axis] += metres(density.moved[at][axis]));
            let left = &mut excess.left[particle as usize];
            pressure[particle as usize] = density.lambda[at] / (h * h) as f32;
            *left += density.left(at);
            sum += f64::from((*left + density.yielded(at)).max(0.0));
        }
        for corner in walls.corners().iter().filter(|corner| corner.moved != [0.0; 3]) {
            let row = &mut displacement[corner.row as usize];
            (0..3).for_each(|axis| row.0[axis] += metres(corner.moved[axis]));
        }
        self.density_error = sum / loads.len().max(1) as f64;
    }
}
