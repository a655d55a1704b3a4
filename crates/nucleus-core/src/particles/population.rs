//! The living particles of one object: their numbers, ages and lifespans.

use nalgebra::Vector3;

use crate::bytes::{checkpoint_struct, encode_struct};
use crate::input::frame::Birth;
use crate::input::particles::{CollisionEvent, ParticleFacts, ParticleRamp, RampInput, RampTarget};
use crate::model::objects::{Cloth, Mass, point_masses};
use crate::output::{ContactState, Particle};

/// The rotation of a particle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rotation {
    /// The turn since its birth, as a unit quaternion x, y, z, w.
    pub orientation: [f64; 4],
    /// Angular velocity in rad/s.
    pub spin: [f64; 3],
}

impl Rotation {
    /// At rest, and not turned.
    pub const NONE: Self = Self { orientation: [0.0, 0.0, 0.0, 1.0], spin: [0.0; 3] };
}

encode_struct!([] Rotation { orientation: [f64; 4], spin: [f64; 3] });

/// What a particle begins its life with.
#[derive(Debug, Clone, Copy)]
pub struct Newborn {
    /// In seconds.
    pub age: f64,
    /// In seconds.
    pub lifespan: f64,
    /// In m/s.
    pub velocity: [f64; 3],
    /// Whether it begins in touch: one that a collision made does not collide there a second time.
    pub touches: bool,
}

/// A particle that an event adds.
#[derive(Debug, Clone, Copy)]
pub struct Spawn {
    /// Its object, by the index of its cloth.
    pub cloth: usize,
    /// In metres.
    pub position: Vector3<f64>,
    /// In m/s.
    pub velocity: Vector3<f64>,
    /// Of a part, the age in seconds of the whole at the start of the substep.
    pub age_of_whole: Option<f64>,
    /// In seconds.
    pub lifespan: f64,
}

/// The living particles of one object, in the order of birth, which is that of their rows.
#[derive(Debug, Clone)]
pub struct Population {
    /// The object, by the index of its cloth.
    cloth: usize,
    /// The largest number of particles.
    capacity: usize,
    /// The number of each particle, counted over all that ever lived.
    id: Vec<u64>,
    /// Time of birth in seconds, on the clock of `now`.
    born: Vec<f64>,
    /// Age of death in seconds; infinite for never.
    lifespan: Vec<f64>,
    /// In kilograms, without the ramp.
    mass: Vec<f64>,
    /// Velocity at the end of the last substep in m/s, and the change of it in that substep in m/s²; empty where no ramp
    /// reads the acceleration.
    last_velocity: Vec<[f64; 3]>,
    acceleration: Vec<f64>,
    /// Whether each particle has touched something ever since its last collision, and how often it has collided; empty without
    /// collision events.
    touches: Vec<bool>,
    collisions: Vec<u32>,
    /// Its collisions in this substep: the particle, and the number of its collision.
    pub(super) collided: Vec<(usize, u32)>,
    /// Factors by particle on the point field, the viscosity and the surface tension; empty without a ramp.
    field_factors: Vec<f32>,
    viscosity_factors: Vec<f32>,
    tension_factors: Vec<f32>,
    /// Rotation by particle; empty where they do not rotate.
    rotations: Vec<Rotation>,
    rotates: bool,
    /// Counts births and deaths: what is kept by row elsewhere belongs to one of its values.
    topology: u64,
    /// The number of the next particle.
    next_id: u64,
    /// Time since the start in seconds.
    now: f64,
    /// The time of the next death.
    next_death: f64,
    /// How many births of this frame have been considered.
    considered: usize,
    /// In kilograms: the mass of particles at birth.
    birth_mass: f64,
    /// Radius of the object in metres, which its ramp scales.
    radius: f64,
    /// Factors on attributes of each particle; that of the radius is the first.
    ramps: Vec<ParticleRamp>,
    /// What happens at collisions.
    events: Vec<CollisionEvent>,
}

checkpoint_struct!([] Population {
    columns: [],
    values: [id, born, lifespan, mass, last_velocity, acceleration, touches, collisions, rotations, next_id, now],
    parts: [],
    rebuilt: [
        collided, cloth, capacity, next_death, considered, birth_mass, radius, ramps, events, rotates, topology, field_factors, viscosity_factors,
        tension_factors
    ],
});

impl Population {
    /// Bytes of its columns.
    pub fn bytes(&self) -> usize {
        let numbers = [&self.born, &self.lifespan, &self.mass, &self.acceleration];
        let factors = [&self.field_factors, &self.viscosity_factors, &self.tension_factors];
        size_of_val(&self.id[..])
            + numbers.map(|column| size_of_val(&column[..])).iter().sum::<usize>()
            + factors.map(|column| size_of_val(&column[..])).iter().sum::<usize>()
            + size_of_val(&self.last_velocity[..])
            + size_of_val(&self.touches[..])
            + size_of_val(&self.collisions[..])
            + size_of_val(&self.rotations[..])
    }

    /// The particles of a cloth at the start; `None` where none are born or die.
    pub fn of(index: usize, cloth: &Cloth) -> Option<Self> {
        let particles = cloth.particles.as_ref()?;
        let points = cloth.surface.positions.len();
        let (Mass::PerPoint(mass) | Mass::PerArea(mass)) = cloth.mass;
        let mut population = Self {
            cloth: index,
            capacity: particles.capacity,
            id: match particles.ids.is_empty() {
                true => (0..points as u64).collect(),
                false => particles.ids.clone(),
            },
            born: particles.ages.iter().map(|age| -age).collect(),
            lifespan: particles.lifespans.clone(),
            mass: point_masses(cloth),
            last_velocity: Vec::new(),
            acceleration: Vec::new(),
            touches: Vec::new(),
            collisions: Vec::new(),
            collided: Vec::new(),
            rotations: Vec::new(),
            rotates: particles.rotates,
            topology: 0,
            field_factors: Vec::new(),
            viscosity_factors: Vec::new(),
            tension_factors: Vec::new(),
            next_id: particles.ids.iter().map(|id| id.saturating_add(1)).max().unwrap_or(points as u64),
            now: 0.0,
            next_death: f64::INFINITY,
            considered: 0,
            birth_mass: mass,
            radius: particles.radius,
            ramps: particles.ramps.clone(),
            events: particles.events.clone(),
        };
        population.born.resize(points, 0.0);
        population.lifespan.resize(points, f64::INFINITY);
        population.ramps.sort_by_key(|ramp| ramp.target != RampTarget::Radius);
        let velocity =
            |at: usize| cloth.start.velocities.get(at).map_or([0.0; 3], |&velocity| velocity.into());
        (0..points).for_each(|at| population.begin_columns(velocity(at), false));
        population.find_next_death();
        Some(population)
    }

    /// The object, by the index of its cloth.
    pub fn cloth(&self) -> usize {
        self.cloth
    }

    /// The number of living particles.
    pub fn len(&self) -> usize {
        self.id.len()
    }

    /// The largest number of particles.
    pub fn capacity(&self) -> usize {
        self.capacity
    }

    /// Whether it is full.
    pub fn is_full(&self) -> bool {
        self.len() >= self.capacity
    }

    /// The mass of each particle in kilograms.
    pub fn masses(&self) -> &[f64] {
        &self.mass
    }

    /// The mass of a particle at birth in kilograms.
    pub fn birth_mass(&self) -> f64 {
        self.birth_mass
    }

    /// The factors on attributes of each particle.
    pub fn ramps(&self) -> &[ParticleRamp] {
        &self.ramps
    }

    /// Whether its particles differ in their looks.
    pub fn has_looks(&self) -> bool {
        self.ramps.iter().any(|ramp| ramp.target == RampTarget::Radius || ramp.target.is_look())
    }

    /// The rotation of each particle; empty where they do not rotate.
    pub fn rotations(&self) -> &[Rotation] {
        &self.rotations
    }

    /// Replaces the rotation of each particle.
    pub fn set_rotations(&mut self, rotations: Vec<Rotation>) {
        debug_assert_eq!(rotations.len(), self.rotations.len());
        self.rotations = rotations;
    }

    /// The orientations of its particles as unit quaternions x, y, z, w; none where they do not rotate.
    pub fn orientations(&self) -> impl Iterator<Item = [f32; 4]> + '_ {
        self.rotations.iter().map(|rotation| rotation.orientation.map(|x| x as f32))
    }

    /// A number that changes with every birth and death.
    pub fn topology(&self) -> u64 {
        self.topology
    }

    /// What happens at collisions.
    pub fn events(&self) -> &[CollisionEvent] {
        &self.events
    }

    /// What ramps read of a particle with this speed in m/s.
    pub fn facts(&self, at: usize, speed: f64) -> ParticleFacts {
        let facts = ParticleFacts {
            id: self.id[at],
            age: self.now - self.born[at],
            lifespan: self.lifespan[at],
            speed,
            acceleration: self.acceleration.get(at).copied().unwrap_or(0.0),
            radius: self.radius,
        };
        let scaled = self.ramps.first().filter(|ramp| ramp.target == RampTarget::Radius);
        ParticleFacts { radius: self.radius * scaled.map_or(1.0, |ramp| ramp.factor(&facts)), ..facts }
    }

    /// Factors by particle on its point field; empty where they are 1.
    pub fn field_factors(&self) -> &[f32] {
        &self.field_factors
    }

    /// Factors by particle on viscosity and on surface tension; empty where they are 1.
    pub fn liquid_factors(&self) -> [&[f32]; 2] {
        [&self.viscosity_factors, &self.tension_factors]
    }

    /// Sets the factor of a particle on an attribute that is read from here.
    pub fn set_factor(&mut self, target: RampTarget, at: usize, factor: f64) {
        let column = match target {
            RampTarget::PointField => &mut self.field_factors,
            RampTarget::Viscosity => &mut self.viscosity_factors,
            RampTarget::SurfaceTension => &mut self.tension_factors,
            _ => return,
        };
        column[at] = factor as f32;
    }

    /// Takes up the velocity of a particle at the end of a substep of this many seconds, where a ramp reads the
    /// acceleration.
    pub fn accelerate(&mut self, at: usize, velocity: [f64; 3], seconds: f64) {
        let Some(last) = self.last_velocity.get_mut(at) else { return };
        let change: [f64; 3] = std::array::from_fn(|axis| velocity[axis] - last[axis]);
        let square = change[0] * change[0] + change[1] * change[1] + change[2] * change[2];
        self.acceleration[at] = square.sqrt() / seconds;
        *last = velocity;
    }

    /// Whether a ramp reads the acceleration.
    pub fn reads_acceleration(&self) -> bool {
        self.ramps.iter().any(|ramp| ramp.input == RampInput::Acceleration)
    }

    /// Notices the contact state of a particle at the end of a time step, compressed where something has pushed it, and lists
    /// the collision if one begins.
    pub fn notice(&mut self, at: usize, state: ContactState) {
        let is_pushed = state > ContactState::Touching;
        let before = self.touches[at];
        self.touches[at] = is_pushed || before && state != ContactState::Free;
        if is_pushed && !before {
            self.collisions[at] = self.collisions[at].saturating_add(1);
            self.collided.push((at, self.collisions[at]));
        }
    }

    /// Whether a particle is to die at the next occasion.
    pub fn is_killed(&self, at: usize) -> bool {
        self.lifespan[at] <= 0.0
    }

    /// Lets a particle die at the next occasion.
    pub fn kill(&mut self, at: usize) {
        self.lifespan[at] = 0.0;
        self.next_death = f64::NEG_INFINITY;
    }

    /// Changes the lifespan of a particle, in seconds.
    pub fn set_lifespan(&mut self, at: usize, lifespan: f64) {
        self.lifespan[at] = lifespan;
        self.next_death = self.next_death.min(self.born[at] + lifespan);
    }

    /// Begins the columns of a particle that only some objects have.
    fn begin_columns(&mut self, velocity: [f64; 3], touches: bool) {
        if self.reads_acceleration() {
            self.last_velocity.push(velocity);
            self.acceleration.push(0.0);
        }
        if !self.events.is_empty() {
            self.touches.push(touches);
            self.collisions.push(0);
        }
        if self.rotates {
            self.rotations.push(Rotation::NONE);
        }
        for (target, column) in [
            (RampTarget::PointField, &mut self.field_factors),
            (RampTarget::Viscosity, &mut self.viscosity_factors),
            (RampTarget::SurfaceTension, &mut self.tension_factors),
        ] {
            if self.ramps.iter().any(|ramp| ramp.target == target) {
                column.push(1.0);
            }
        }
    }

    /// What an observer sees of each particle.
    pub fn particles(&self) -> impl Iterator<Item = Particle> + '_ {
        let columns = self.id.iter().zip(&self.born).zip(self.lifespan.iter().zip(&self.mass));
        columns.map(|((&id, born), (&lifespan, &mass))| Particle { id, age: self.now - born, lifespan, mass })
    }

    /// Begins a frame: none of its births has been considered.
    pub fn begin_frame(&mut self) {
        self.considered = 0;
    }

    /// The births of this object up to `share` of the frame that have not been considered.
    pub fn due<'f>(&mut self, births: &'f [Birth], share: f64) -> impl Iterator<Item = &'f Birth> + use<'f> {
        let (from, cloth) = (self.considered, self.cloth);
        self.considered += births[from..].partition_point(|birth| birth.time <= share);
        births[from..self.considered].iter().filter(move |birth| birth.cloth.index() == cloth)
    }

    /// Time passes.
    pub fn advance(&mut self, seconds: f64) {
        self.now += seconds;
    }

    /// Adds a particle. Returns false, with the particle counted, where it has died already.
    pub fn add(&mut self, newborn: Newborn) -> bool {
        let Newborn { age, lifespan, velocity, touches } = newborn;
        let id = self.next_id;
        self.next_id += 1;
        self.topology += 1;
        if age >= lifespan {
            return false;
        }
        let born = self.now - age;
        self.id.push(id);
        self.born.push(born);
        self.lifespan.push(lifespan);
        self.mass.push(self.birth_mass);
        self.begin_columns(velocity, touches);
        self.next_death = self.next_death.min(born + lifespan);
        true
    }

    /// Removes the particles whose time has come. Returns the places of those that remain; `None` if none died.
    pub fn remove_dead(&mut self) -> Option<Vec<u32>> {
        if self.now < self.next_death {
            return None;
        }
        let dies = |at: usize| self.now >= self.born[at] + self.lifespan[at];
        let kept: Vec<u32> = (0..self.len()).filter(|&at| !dies(at)).map(|at| at as u32).collect();
        self.topology += 1;
        self.keep(&kept);
        self.find_next_death();
        Some(kept)
    }

    /// Keeps the particles at these places, which ascend. It names every field, so that a new column does not compile until it
    /// is kept or named as none.
    fn keep(&mut self, kept: &[u32]) {
        let Self {
            id,
            born,
            lifespan,
            mass,
            last_velocity,
            acceleration,
            touches,
            collisions,
            rotations,
            field_factors,
            viscosity_factors,
            tension_factors,
            // Not by particle.
            cloth: _,
            capacity: _,
            collided: _,
            rotates: _,
            topology: _,
            next_id: _,
            now: _,
            next_death: _,
            considered: _,
            birth_mass: _,
            radius: _,
            ramps: _,
            events: _,
        } = self;
        keep(id, kept);
        [born, lifespan, mass, acceleration].into_iter().for_each(|column| keep(column, kept));
        keep(last_velocity, kept);
        keep(touches, kept);
        keep(collisions, kept);
        keep(rotations, kept);
        [field_factors, viscosity_factors, tension_factors].into_iter().for_each(|column| keep(column, kept));
    }

    /// Takes up columns that were restored; `None` where they are no population of this object.
    pub fn restored(&mut self) -> Option<()> {
        let lengths = [self.born.len(), self.lifespan.len(), self.mass.len()];
        let accelerated = if self.reads_acceleration() { self.len() } else { 0 };
        let colliding = if self.events.is_empty() { 0 } else { self.len() };
        for (target, column) in [
            (RampTarget::PointField, &mut self.field_factors),
            (RampTarget::Viscosity, &mut self.viscosity_factors),
            (RampTarget::SurfaceTension, &mut self.tension_factors),
        ] {
            let is_read = self.ramps.iter().any(|ramp| ramp.target == target);
            column.clear();
            column.resize(if is_read { self.id.len() } else { 0 }, 1.0);
        }
        let is_valid = lengths.iter().all(|&length| length == self.len())
            && [self.last_velocity.len(), self.acceleration.len()] == [accelerated; 2]
            && [self.touches.len(), self.collisions.len()] == [colliding; 2]
            && self.rotations.len() == if self.rotates { self.len() } else { 0 }
            && self.len() <= self.capacity
            && self.mass.iter().all(|&mass| mass > 0.0);
        self.find_next_death();
        is_valid.then_some(())
    }

    fn find_next_death(&mut self) {
        let deaths = self.born.iter().zip(&self.lifespan).map(|(born, lifespan)| born + lifespan);
        self.next_death = deaths.fold(f64::INFINITY, f64::min);
    }
}

/// Closes up a column: keeps the rows at these places, which ascend.
pub fn keep<T: Copy>(column: &mut Vec<T>, kept: &[u32]) {
    close_up(column, kept);
    column.truncate(kept.len());
}

/// Moves the rows at these places, which ascend, to the front; an empty column stays empty.
pub fn close_up<T: Copy>(column: &mut [T], kept: &[u32]) {
    if column.is_empty() {
        return;
    }
    let unmoved = kept.iter().zip(0..).take_while(|(from, to)| *from == to).count();
    (unmoved..kept.len()).for_each(|to| column[to] = column[kept[to] as usize]);
}
