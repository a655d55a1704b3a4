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
//! | how fast an excess of density goes | [`excess`] |
//! | ground plane, colliders, cloth and other particles beside a liquid | [`walls`], [`ball`] |
//! | viscosity and surface tension | [`viscosity`], [`surface_tension`] |
//! | how long its time steps are | [`time_step`] |

pub mod ball;
pub mod density;
pub mod excess;
pub mod grid;
pub mod kernel;
pub mod near;
pub mod neighbours;
pub mod pair;
pub mod surface_tension;
pub mod time_step;
pub mod viscosity;
pub mod walls;

use nalgebra::Vector3;

use crate::contact::material::ContactMaterial;
use crate::contact::system::ContactSystem;
use crate::input::frame::{FrameInput, Liquid};
use crate::math::Real;
use crate::model::Model;
use crate::parallel::disjoint::DisjointSlice;
use crate::parallel::thread_pool::ThreadPool;
use crate::particles::population::Population;
use crate::schedule::{StepInterval, TimeStep};
use crate::state::State;

use density::{Density, Load};
use excess::{Excess, Recovery};
use neighbours::{CHUNK, Neighbours, chunk_range};
use time_step::{LiquidInterval, LiquidMotion};
use viscosity::Viscosity;
use walls::{Corner, Material, Plane, Walls};

/// Least radius in rest distances of the ball of liquid that a particle of another object counts as.
const MIN_BALL: f32 = 0.05;
/// Radius of a ball of the volume of a cube, in sides of the cube: the third root of 3 / 4 pi.
const RADIUS_OF_CUBE: f64 = 0.620_350_490_899_400_1;
/// Speed of sound in m/s of a liquid with an `incompressibility` of one half.
const SOFT_SOUND: f64 = 10.0;

/// State of a liquid within a frame.
#[derive(Debug, Default)]
pub struct LiquidSolver {
    neighbours: Neighbours,
    walls: Walls,
    density: Density,
    viscosity: Viscosity,
    /// Multiplier of each particle over the squared time step.
    pressure: Vec<f32>,
    excess: Excess,
    positions: Vec<[f32; 3]>,
    velocities: Vec<[f32; 4]>,
    loads: Vec<Load>,
    /// Factors on viscosity and on surface tension, in the sorted order; empty where they are 1.
    factors: [Vec<f32>; 2],
    /// Where lengths are taken from in this frame, in metres.
    origin: Vector3<f64>,
    density_error: f64,
    /// The births and deaths of its particles that the columns by particle follow.
    topology: u64,
    /// The time step that it is in; `None` for a cloth that is no liquid.
    interval: Option<LiquidInterval>,
}

/// One time step of one liquid.
#[derive(Debug, Clone, Copy)]
struct LiquidStep {
    cloth: usize,
    settings: Liquid,
    origin: Vector3<f64>,
    /// Inverse mass of its first particle in 1/kg.
    inverse_mass: f64,
    /// Its length in seconds, and how much of it is after the time step of the nucleus in which it starts.
    h: f64,
    ahead: f64,
    span: StepInterval,
}

impl LiquidStep {
    fn recovery(&self) -> Recovery {
        Recovery::new(self.h, self.settings.spacing)
    }
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

/// Inputs of a liquid from the scene.
#[derive(Clone, Copy)]
pub struct LiquidScene<'a, R: Real> {
    /// The objects.
    pub model: &'a Model<R>,
    /// Colliders and the ground plane in motion.
    pub contact: &'a ContactSystem<R>,
    /// The attributes.
    pub frame: &'a FrameInput,
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
        let LiquidScene { model: Model { cloths, colliders }, contact, frame } = scene;
        let Self { walls, positions, .. } = self;
        walls.clear();
        let own = &frame.cloths[step.cloth];
        let per_metre = 1.0 / step.settings.spacing;
        let place = |place: Vector3<f64>| -> [f32; 3] {
            let place = (place - step.origin) * per_metre;
            [place.x as f32, place.y as f32, place.z as f32]
        };
        let factors = &contact.material_maps.max_thickness_factor;
        // A liquid is one element: it is excluded from what all of its particles are.
        let excluded = contact.pair_filter.sides_of_all(cloths[step.cloth].points());
        if let Some(ground) = frame.plane.as_ref()
            && let Some(material) = ContactMaterial::<R>::for_ground(own, ground, factors[step.cloth])
            && let Some(plane) = contact.ground.in_step(step.span).filter(|_| !excluded.exclude_ground())
        {
            let first = cloths[step.cloth].points().start;
            let above = plane.height_now(first, state.displacement[first as usize].xyz()).to_f64();
            let normal = plane.normal().map(|x| x.to_f64());
            let height =
                above - Vector3::from(normal).dot(&(Vector3::from(state.position(first)) - step.origin));
            let normal = normal.map(|x| x as f32);
            let offset = (material.thickness * per_metre - 0.5).max(0.0) as f32;
            walls.plane = Some(Plane { normal, height: (height * per_metre) as f32, offset });
        }
        let bounds = grid::bounds(positions);
        let region = walls.new_region(bounds);
        for (at, model) in colliders.iter().enumerate() {
            let factors = contact.material_maps.max_thickness_factors(step.cloth, at);
            let theirs = &frame.colliders[at];
            let Some(material) = ContactMaterial::<R>::for_collider(own, theirs, factors, frame.layer_range)
            else {
                continue;
            };
            let material = Material { distance: (material.thickness * per_metre) as f32 };
            let collider = &contact.collider_states[at];
            let places =
                |triangle: &[u32; 3]| triangle.map(|point| place(collider.point(point, step.span.to)));
            let triangles = model.boundary.triangles.iter();
            let triangles =
                triangles.filter(|corners| !excluded.exclude_collider(at, &corners[..])).map(places);
            match (collider.moves, region) {
                (true, _) => triangles.for_each(|triangle| walls.cover(triangle, None, material, bounds)),
                (false, Some(region)) => {
                    triangles.for_each(|triangle| walls.cover_still(triangle, material, region));
                }
                (false, None) => {}
            }
        }
        if region.is_some() {
            walls.sort_still();
        }
        let at_end = |row: u32| {
            let velocity = Vector3::from(state.velocity[row as usize].xyz().map(R::to_f64));
            Vector3::from(state.position(row)) + velocity * step.ahead
        };
        for (other, model) in cloths.iter().enumerate().filter(|(other, _)| *other != step.cloth) {
            let factors = [factors[step.cloth], factors[other]];
            let pair = [own, &frame.cloths[other]];
            let Some(material) = ContactMaterial::<R>::for_cloths(pair, factors, frame.layer_range) else {
                continue;
            };
            let mobility = material.mobility[1].to_f64();
            let material = Material { distance: (material.thickness * per_metre) as f32 };
            let corner = |row: u32| {
                let inverse_mass =
                    state.displacement[row as usize].0[3].to_f64() * mobility / step.inverse_mass;
                Corner { row, inverse_mass: inverse_mass as f32, moved: [0.0; 3] }
            };
            if model.boundary.triangles.is_empty() {
                let radius = match &frame.cloths[other].liquid {
                    Some(liquid) => (RADIUS_OF_CUBE * liquid.spacing * per_metre) as f32,
                    // Up to where the liquid rests on it, which begins half a rest distance before its particles.
                    None => (material.distance - 0.5).max(MIN_BALL),
                };
                let rows = model.points().filter(|row| !excluded.exclude(&[*row]));
                rows.for_each(|row| walls.particle(place(at_end(row)), corner(row), radius, bounds));
                continue;
            }
            let first = walls.corners().len() as u32;
            for row in model.points() {
                walls.corner(corner(row));
            }
            for triangle in model.boundary.triangles.iter().filter(|rows| !excluded.exclude(&rows[..])) {
                let corners = triangle.map(|row| first + row - model.points().start);
                let triangle = triangle.map(|row| place(at_end(row)));
                walls.cover(triangle, Some(corners), material, bounds);
            }
        }
        walls.sort();
    }

    /// Computes the load of the pressure solver, after viscosity and surface tension.
    fn load<R: Real>(&mut self, first: u32, state: &State<R>, step: &LiquidStep, pool: &ThreadPool) {
        let Self { neighbours, density, viscosity, pressure, excess, velocities, loads, factors, .. } = self;
        let LiquidStep { settings, h, .. } = *step;
        let order = neighbours.grid.order();
        let by_particle = state.population_of(step.cloth).map_or([&[][..]; 2], Population::liquid_factors);
        for (factors, by_particle) in factors.iter_mut().zip(by_particle) {
            factors.clear();
            let known = order.iter().filter(|_| !by_particle.is_empty());
            factors.extend(known.map(|&particle| by_particle[particle as usize]));
        }
        let per_metre = 1.0 / settings.spacing;
        let squared = per_metre * per_metre;
        let is_viscous = settings.viscosity > 0.0;
        if is_viscous {
            velocities.clear();
            velocities.extend(order.iter().map(|&particle| {
                let velocity = state.velocity[(first + particle) as usize].xyz();
                let [x, y, z] = velocity.map(|x| (x.to_f64() * per_metre) as f32);
                [x, y, z, 0.0]
            }));
            let rate = (settings.viscosity * h * squared) as f32;
            viscosity.solve(neighbours, velocities, (&factors[0], rate), pool);
        }
        let tension = (settings.surface_tension * squared * per_metre) as f32;
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
                if is_viscous {
                    moved = std::array::from_fn(|axis| viscosity.change[at][axis] * h as f32);
                }
                if tension > 0.0 {
                    let pulled = surface_tension::acceleration(neighbours, chunk, k, &factors[1]);
                    (0..3).for_each(|axis| moved[axis] += pull * pulled[axis]);
                }
                let now = neighbours.sums[at][0] - 1.0;
                // SAFETY: the order holds each particle once.
                #[allow(unsafe_code)]
                let left = unsafe { excess.get(particle) };
                // What stays of the excess from before.
                let kept = match settings.incompressibility < 1.0 {
                    true => 0.0,
                    false => recovery.kept(now, left, before[particle as usize]),
                };
                // SAFETY: as above.
                #[allow(unsafe_code)]
                unsafe {
                    excess.set(particle, kept);
                }
                let inverse_mass = if is_free { 1.0 } else { 0.0 };
                loads[k] = Load { excess: now - kept, inverse_mass, moved: moved.map(|x| x * inverse_mass) };
                lambda[k] = pressure[particle as usize] * (h * h) as f32;
            }
        });
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
        density.solve(neighbours, loads, walls, compliance, pool);
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
            sum += f64::from((*left + compliance * density.lambda[at]).max(0.0));
        }
        for corner in walls.corners().iter().filter(|corner| corner.moved != [0.0; 3]) {
            let row = &mut displacement[corner.row as usize];
            (0..3).for_each(|axis| row.0[axis] += metres(corner.moved[axis]));
        }
        self.density_error = sum / loads.len().max(1) as f64;
    }
}
