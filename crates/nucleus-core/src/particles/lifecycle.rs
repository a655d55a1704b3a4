//! Births and deaths in the solver's columns, at the end of each substep.

use std::ops::Range;

use nalgebra::Vector3;

use crate::constraints::link::pass::begin_links;
use crate::contact::system::ContactSystem;
use crate::contact::time_step::ContactCounters;
use crate::fields::update_fields_of;
use crate::input::frame::{Birth, ClothFrame, FrameInput};
use crate::input::validation::is_in_range;
use crate::input::{ClothId, PointId};
use crate::integrate::aerodynamics::{AirForces, Remaining};
use crate::math::{Real, Row4};
use crate::model::Model;
use crate::parallel::thread_pool::ThreadPool;
use crate::particles::birth_path::Obstacles;
use crate::particles::events::spawns_of_collisions;
use crate::particles::occupancy::OccupancyGrid;
use crate::particles::population::{Newborn, Population, Spawn};
use crate::particles::ramps::apply_ramps;
use crate::schedule::{PassTime, Schedule, TimeInterval};
use crate::solver::Solver;
use crate::state::State;
use crate::state::rows::number_after;

/// Removes the particles that have died in a substep, then adds those that were born in it, and those of collisions. The
/// substep is counted from 1. Returns whether links have followed particles or gone with them.
pub fn age_particles<R: Real>(
    solver: &mut Solver<R>,
    frame: &FrameInput,
    schedule: &Schedule<R>,
    substep: u32,
    counters: &mut ContactCounters,
) -> bool {
    let is_last = substep == schedule.substeps;
    let end = if is_last { 1.0 } else { f64::from(substep) / f64::from(schedule.substeps) };
    if solver.state.populations.is_empty() {
        return false;
    }
    let length = frame.duration / f64::from(schedule.substeps);
    let (spawned, refused) = spawns_of_collisions(solver);
    counters.births_refused += refused;
    for index in 0..solver.state.populations.len() {
        accelerate(solver, index, length);
        solver.state.populations[index].advance(length);
    }
    let mut links_changed = false;
    for index in 0..solver.state.populations.len() {
        let population = &mut solver.state.populations[index];
        let (cloth, before) = (population.cloth(), population.len());
        if let Some(kept) = population.remove_dead() {
            counters.deaths += (before - kept.len()) as u64;
            links_changed |= remove_rows(solver, cloth, &kept);
        }
        add_births(solver, index, frame, PassTime { at: end, length: schedule.h }, counters);
        add_spawned(solver, index, frame, (&spawned, PassTime { at: end, length }), counters);
    }
    apply_ramps(solver);
    if links_changed {
        let Solver { links, model, state, contact, .. } = solver;
        begin_links(links, model, state, contact, frame);
    }
    links_changed
}

/// Applies what a frame changes about living particles, and evaluates ramps.
pub fn begin_particles<R: Real>(solver: &mut Solver<R>, frame: &FrameInput) {
    if solver.state.populations.is_empty() {
        return;
    }
    for change in &frame.particle_changes {
        let State { populations, velocity, .. } = &mut solver.state;
        let of_cloth = |population: &&mut Population| population.cloth() == change.cloth.index();
        let Some(population) = populations.iter_mut().find(of_cloth) else { continue };
        if change.place >= population.len() {
            continue;
        }
        if let Some(lifespan) = change.lifespan.filter(|lifespan| !lifespan.is_nan()) {
            population.set_lifespan(change.place, lifespan);
        }
        let row = solver.model.cloths[change.cloth.index()].blocks.rows().start as usize + change.place;
        if let Some(given) = change.velocity.filter(is_in_range) {
            velocity[row] = Row4::new(given.into(), R::ZERO);
        }
    }
    apply_ramps(solver);
}

/// Measures the acceleration of particles over a substep of `length` seconds, where a ramp reads it.
fn accelerate<R: Real>(solver: &mut Solver<R>, index: usize, length: f64) {
    let State { populations, velocity, .. } = &mut solver.state;
    let population = &mut populations[index];
    if !population.reads_acceleration() {
        return;
    }
    let first = solver.model.cloths[population.cloth()].blocks.rows().start as usize;
    (0..population.len())
        .for_each(|at| population.accelerate(at, velocity[first + at].xyz().map(R::to_f64), length));
}

/// Adds the particles of collision events in a substep that ends at `end` to an object.
fn add_spawned<R: Real>(
    solver: &mut Solver<R>,
    index: usize,
    frame: &FrameInput,
    (spawned, end): (&[Spawn], PassTime),
    counters: &mut ContactCounters,
) {
    let Solver { model, state, contact, pool, .. } = solver;
    let (cloth, mass) = (state.populations[index].cloth(), state.populations[index].birth_mass());
    let object = &mut model.cloths[cloth];
    let (first, row_of) = (object.points().end, object.blocks.rows().start);
    for spawn in spawned.iter().filter(|spawn| spawn.cloth == cloth) {
        let population = &mut state.populations[index];
        if population.is_full() {
            counters.births_refused += 1;
            continue;
        }
        counters.births += 1;
        let age = spawn.age_of_whole.map_or(0.0, |age| age + end.length);
        let (lifespan, velocity) = (spawn.lifespan, spawn.velocity.into());
        if population.add(Newborn { age, lifespan, velocity, touches: true }) {
            let row = row_of + population.len() as u32 - 1;
            state.put_particle(row as usize, spawn.position, spawn.velocity, mass);
        } else {
            counters.deaths += 1;
        }
    }
    let last = row_of + state.populations[index].len() as u32;
    if last > first {
        object.resize(state.populations[index].len());
        begin_contact_of(state, contact, cloth, first..last);
        begin_fields_of(model, state, cloth, first..last, (frame, end.at), pool);
    }
}

/// Fields act on new particles for the rest of the frame.
fn begin_fields_of<R: Real>(
    model: &Model<R>,
    state: &mut State<R>,
    cloth: usize,
    rows: Range<u32>,
    (frame, end): (&FrameInput, f64),
    pool: &ThreadPool,
) {
    if !frame.fields_per_substep {
        let interval = frame.duration * (1.0 - end).max(f64::EPSILON);
        update_fields_of((cloth, &model.cloths[cloth]), rows, state, frame, interval, pool);
    }
}

/// Adds the particles of an object that were born until `now`, in time steps of its length.
fn add_births<R: Real>(
    solver: &mut Solver<R>,
    index: usize,
    frame: &FrameInput,
    now: PassTime,
    counters: &mut ContactCounters,
) {
    let Solver { model, state, contact, .. } = &mut *solver;
    let PassTime { at: end, length: h } = now;
    let mut births = state.populations[index].due(&frame.births, end).peekable();
    if births.peek().is_none() {
        return;
    }
    let (cloth, mass) = (state.populations[index].cloth(), state.populations[index].birth_mass());
    let object = &model.cloths[cloth];
    let (first, row_of) = (object.points().end, object.blocks.rows().start);
    let flight = Flight::new(frame, &frame.cloths[cloth], [mass, object.point_mass], h);
    let flights = births.map(|birth| {
        let age = (end - birth.time) * frame.duration;
        (birth, age, flight.after(birth, age))
    });
    let flights: Vec<_> = flights.collect();
    let paths = flights.iter().map(|(birth, _, (position, _))| [birth.position, *position]);
    let paths = paths.filter(|path| path.iter().all(is_in_range));
    let living = object.points().map(|row| state.position(row).into());
    let mut occupancy = OccupancyGrid::of(&frame.cloths[cloth], living, corners(paths.clone().flatten()));
    let obstacles = Obstacles::new((&*model, &*state, contact), cloth, paths, end);
    for (birth, age, (mut position, mut velocity)) in flights {
        let population = &mut state.populations[index];
        let row = row_of + population.len() as u32;
        let path = [birth.position, position];
        let stop = || obstacles.stop((&*model, &*contact), row, path, birth.time);
        if let Some(place) = (!population.is_full()).then(stop).flatten() {
            (position, velocity) = (place, birth.velocity);
        }
        let is_refused = occupancy.as_ref().is_some_and(|occupancy| occupancy.refuses(position));
        let is_valid = is_in_range(&position) && is_in_range(&velocity) && !age.is_nan();
        if population.is_full() || !is_valid || is_refused {
            counters.births_refused += 1;
            continue;
        }
        if occupancy.as_ref().is_some_and(|occupancy| occupancy.prunes(position)) {
            counters.births_pruned += 1;
            continue;
        }
        counters.births += 1;
        let (lifespan, launched) = (birth.lifespan, velocity.into());
        match population.add(Newborn { age, lifespan, velocity: launched, touches: false }) {
            true => {
                if let Some(occupancy) = &mut occupancy {
                    occupancy.add(position);
                }
                let row = row_of + population.len() as u32 - 1;
                state.put_particle(row as usize, position, velocity, mass);
            }
            false => counters.deaths += 1,
        }
    }
    begin_newborn(solver, index, first, (frame, end));
}

/// Has the particles of a population from a row on, which are new, take part in contact and fields.
fn begin_newborn<R: Real>(
    solver: &mut Solver<R>,
    index: usize,
    first: u32,
    (frame, end): (&FrameInput, f64),
) {
    let Solver { model, state, contact, pool, .. } = solver;
    let (cloth, living) = (state.populations[index].cloth(), state.populations[index].len());
    let last = model.cloths[cloth].blocks.rows().start + living as u32;
    if last > first {
        model.cloths[cloth].resize(living);
        begin_contact_of(state, contact, cloth, first..last);
        begin_fields_of(model, state, cloth, first..last, (frame, end), pool);
    }
}

/// The low and the high corner of the bounding box of some places.
fn corners(places: impl Iterator<Item = Vector3<f64>>) -> [Vector3<f64>; 2] {
    let empty = [Vector3::repeat(f64::INFINITY), Vector3::repeat(f64::NEG_INFINITY)];
    places.fold(empty, |[low, high], place| [low.inf(&place), high.sup(&place)])
}

/// New particles take part in contact from the next time step on.
fn begin_contact_of<R: Real>(
    state: &State<R>,
    contact: &mut ContactSystem<R>,
    cloth: usize,
    rows: Range<u32>,
) {
    contact.ground.set_anchors(rows.clone(), &state.anchor, &contact.pair_filter);
    rows.clone().for_each(|row| contact.invalidate_bounds(row as usize));
    contact.active_windows[cloth] = TimeInterval::EXPIRED;
    if let Some(contacts) = &mut contact.cloth_contacts {
        contacts.interval_start[rows.start as usize..rows.end as usize].fill(Row4::ZERO);
    }
}

/// Closes up the rows of an object; `kept` are the places of the particles that remain, which ascend. Returns whether the
/// object has links.
fn remove_rows<R: Real>(solver: &mut Solver<R>, cloth: usize, kept: &[u32]) -> bool {
    let Solver { model, state, contact, links, .. } = solver;
    let points = model.cloths[cloth].points();
    state.close_up_particles(&points, kept);
    model.cloths[cloth].resize(kept.len());
    renumber_contacts(contact, cloth, points.clone(), kept);
    let left = points.start..points.start + kept.len() as u32;
    contact.ground.set_anchors(left, &state.anchor, &contact.pair_filter);
    let number = |point: PointId| kept.binary_search(&point.0).ok().map(|at| PointId(at as u32));
    links.close_up(ClothId(cloth as u32), number, (&model.cloths, &model.colliders))
}

/// Follows the rows of an object that have moved. Contacts with colliders are searched anew; those among cloths keep their
/// friction anchors.
fn renumber_contacts<R: Real>(
    contact: &mut ContactSystem<R>,
    cloth: usize,
    before: Range<u32>,
    kept: &[u32],
) {
    let bounds = contact.bounds_violated.get_mut(before.start as usize..before.end as usize);
    bounds.unwrap_or_default().fill(true);
    contact.active_windows[cloth] = TimeInterval::EXPIRED;
    let number = |row: u32| number_after(row, &before, kept);
    let of_cloth = contact.lists_of(cloth);
    for list in &mut contact.collider_contacts[of_cloth] {
        list.clear();
        list.depenetration.renumber(number);
    }
    if let Some(contacts) = &mut contact.cloth_contacts {
        contacts.close_up(before, kept);
    }
}

/// Free flight of a new particle to the end of its substep.
struct Flight {
    /// In m/s².
    acceleration: Vector3<f64>,
    wind: Vector3<f64>,
    /// What remains after a time step.
    remaining: Remaining,
    /// Length of a time step in seconds.
    h: f64,
}

/// Drag that takes less than this share of a velocity in a time step is none.
const MIN_DRAG: f64 = 1e-9;

impl Flight {
    fn new(frame: &FrameInput, cloth: &ClothFrame, [mass, point_mass]: [f64; 2], h: f64) -> Self {
        let gravity = if cloth.feels_gravity { frame.gravity } else { Vector3::zeros() };
        let wind = if cloth.feels_wind { frame.wind } else { Vector3::zeros() } + cloth.local_wind;
        let air = AirForces::new(frame, cloth, point_mass, h);
        let remaining =
            air.map_or(Remaining { velocity: 1.0, kick: 1.0 }, |air| air.on_particles().remaining());
        Self { acceleration: gravity + cloth.local_force / mass, wind, remaining, h }
    }

    /// Position and velocity at an age within the substep.
    ///
    /// A time step of length h takes the velocity u through the air to f u + k h g, and moves by h times that. After n steps
    /// u = U + (u0 - U) f^n with U = h g k / (1 - f), and the travel is h (n U + (u0 - U) f (1 - f^n) / (1 - f)). A new particle
    /// takes age / h for n, so that its path is the same whenever in a step it is born.
    fn after(&self, birth: &Birth, age: f64) -> (Vector3<f64>, Vector3<f64>) {
        let Self { acceleration, wind, remaining: Remaining { velocity: f, kick }, h } = *self;
        if f > 1.0 - MIN_DRAG {
            let velocity = birth.velocity + acceleration * age;
            let travel = birth.velocity * age + acceleration * (age * (age + h) / 2.0);
            return (birth.position + travel, velocity);
        }
        let (steps, last) = (age / h, acceleration * (h * kick / (1.0 - f)));
        let share = libm::pow(f, steps);
        let apart = birth.velocity - wind - last;
        let travel = (last * steps + apart * (f * (1.0 - share) / (1.0 - f))) * h;
        (birth.position + wind * age + travel, wind + last + apart * share)
    }
}
