//! Collision events: particles that emit, split or die when they collide (Maya's `event` command).
//!
//! A particle collides when something has pushed it in a time step and it has touched nothing since its last collision, so a
//! particle that rests or slides has collided once. What it emits begins at the end of the substep, where the particle
//! is then and with its velocity after the rebound: the surface that it met has moved on, and may have passed the place of
//! the collision.

use nalgebra::Vector3;

use crate::contact::contact_state::contact_states_of_rows;
use crate::input::particles::unit_random;
use crate::math::Real;
use crate::output::ContactState;
use crate::particles::population::{Population, Spawn};
use crate::solver::Solver;

/// Random draws of one collision.
struct Draws {
    key: [u64; 2],
}

impl Draws {
    fn next(&mut self) -> f64 {
        self.key[1] = self.key[1].wrapping_add(1);
        unit_random(self.key)
    }

    /// Passes over the draws of so many new particles about an axis.
    fn pass_over(&mut self, particles: u64, axis: &Vector3<f64>) {
        // Two for the direction, if there is an axis, and one for the lifespan.
        let each = if axis.try_normalize(0.0).is_some() { 3 } else { 1 };
        self.key[1] = self.key[1].wrapping_add(particles.wrapping_mul(each));
    }

    /// `most`, or a number from 1 to it.
    fn count(&mut self, most: u32, random: bool) -> u32 {
        if random && most > 0 { 1 + (self.next() * f64::from(most)) as u32 } else { most }
    }

    /// A direction within a share of 90° about another, evenly spread over the sphere.
    fn about(&mut self, axis: Vector3<f64>, spread: f64) -> Vector3<f64> {
        let Some(axis) = axis.try_normalize(0.0) else { return axis };
        let cos = 1.0 - self.next() * (1.0 - libm::cos(spread.clamp(0.0, 1.0) * std::f64::consts::FRAC_PI_2));
        let around = self.next() * std::f64::consts::TAU;
        let aside = if axis.x.abs() < 0.9 { Vector3::x() } else { Vector3::y() };
        let x = aside.cross(&axis).normalize();
        let y = axis.cross(&x);
        axis * cos + (x * libm::cos(around) + y * libm::sin(around)) * (1.0 - cos * cos).max(0.0).sqrt()
    }
}

/// Gap over thickness up to which what a particle touches has pushed it. One that is only near has not rebounded yet.
const PUSHED_RATIO: f64 = 1.001;

/// Lists the collisions of a time step that ends at `time`, a share of the frame.
pub fn find_collisions<R: Real>(solver: &mut Solver<R>, time: f64) {
    if solver.state.populations.iter().all(|population| population.events().is_empty()) {
        return;
    }
    solver.contact.set_time(time);
    let mut states = std::mem::take(&mut solver.contact.row_states);
    contact_states_of_rows(&solver.model, &solver.state, &solver.contact, PUSHED_RATIO, &mut states);
    let populations = &mut solver.state.populations;
    for population in populations.iter_mut().filter(|population| !population.events().is_empty()) {
        let first = solver.model.cloths[population.cloth()].blocks.rows().start as usize;
        for at in 0..population.len() {
            population.notice(at, states.get(first + at).copied().unwrap_or(ContactState::Free));
        }
    }
    solver.contact.row_states = states;
}

/// The new particles of the collisions in a substep, and how many more there would be if the capacity allowed it; marks the
/// particles that die of them.
pub fn spawns_of_collisions<R: Real>(solver: &mut Solver<R>) -> (Vec<Spawn>, u64) {
    let Solver { model, state, .. } = solver;
    let mut populations = std::mem::take(&mut state.populations);
    let mut spawns = Spawns {
        all: Vec::new(),
        refused: 0,
        capacity: RemainingCapacity::of(&populations, model.cloths.len()),
    };
    for population in &mut populations {
        let first = model.cloths[population.cloth()].blocks.rows().start;
        for (at, collision) in std::mem::take(&mut population.collided) {
            let row = first + at as u32;
            let place = Vector3::from(state.position(row));
            let velocity = Vector3::from(state.velocity[row as usize].xyz().map(R::to_f64));
            if !population.is_killed(at) {
                happen(population, at, collision, [place, velocity], &mut spawns);
            }
        }
    }
    state.populations = populations;
    (spawns.all, spawns.refused)
}

/// What collisions add.
struct Spawns {
    all: Vec<Spawn>,
    refused: u64,
    capacity: RemainingCapacity,
}

/// How many new particles each object can take up at the end of the substep, by the index of its cloth. None are made
/// beyond that: an event may ask for billions.
struct RemainingCapacity(Vec<usize>);

impl RemainingCapacity {
    /// The capacity before the events of a substep. All particles that live now may die of them.
    fn of(populations: &[Population], cloths: usize) -> Self {
        let mut capacity = vec![0; cloths];
        populations.iter().for_each(|population| capacity[population.cloth()] = population.capacity());
        Self(capacity)
    }

    /// How many of so many new particles an object can take up; none where it is no object of particles.
    fn take(&mut self, cloth: usize, wanted: u64) -> u64 {
        let Some(capacity) = self.0.get_mut(cloth) else { return 0 };
        let taken = wanted.min(*capacity as u64);
        *capacity -= taken as usize;
        taken
    }
}

/// Everything that happens at one collision of one particle.
fn happen(
    population: &mut Population,
    at: usize,
    collision: u32,
    [place, velocity]: [Vector3<f64>; 2],
    spawns: &mut Spawns,
) {
    let own = population.cloth();
    let facts = population.facts(at, 0.0);
    let mut dies = false;
    for (k, event) in (0u64..).zip(population.events()) {
        let mut draws = Draws { key: [facts.id ^ (k + 1) << 48, u64::from(collision) << 32] };
        if (event.count != 0 && event.count != collision) || draws.next() >= event.probability {
            continue;
        }
        dies |= event.die;
        let emitted = u64::from(draws.count(event.emit, event.random));
        let parts = u64::from(draws.count(event.split, event.random)).saturating_sub(1);
        for (cloth, wanted, whole) in [(event.target.index(), emitted, None), (own, parts, Some(facts))] {
            let made = spawns.capacity.take(cloth, wanted);
            for _ in 0..made {
                let direction = draws.about(velocity, event.spread);
                let drawn = (event.lifespan[0] + event.lifespan[1] * (draws.next() - 0.5)).max(0.0);
                spawns.all.push(Spawn {
                    cloth,
                    position: place,
                    velocity: direction * velocity.norm(),
                    age_of_whole: whole.map(|whole| whole.age),
                    lifespan: whole.map_or(drawn, |whole| whole.lifespan),
                });
            }
            draws.pass_over(wanted - made, &velocity);
            spawns.refused += wanted - made;
        }
    }
    if dies {
        population.kill(at);
    }
}
