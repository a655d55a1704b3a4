//! The living particles of one object: their numbers, ages and lifespans.

use crate::bytes::checkpoint_struct;
use crate::input::frame::Birth;
use crate::model::builder::{Cloth, Mass, point_masses};
use crate::output::ParticleAge;

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
    /// In kilograms.
    mass: Vec<f64>,
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
}

checkpoint_struct!([] Population {
    columns: [],
    values: [id, born, lifespan, mass, next_id, now],
    parts: [],
    rebuilt: [cloth, capacity, next_death, considered, birth_mass],
});

impl Population {
    /// Bytes of its columns.
    pub fn bytes(&self) -> usize {
        let [id, born, lifespan, mass] = [
            size_of_val(&self.id[..]),
            size_of_val(&self.born[..]),
            size_of_val(&self.lifespan[..]),
            size_of_val(&self.mass[..]),
        ];
        id + born + lifespan + mass
    }

    /// The particles of a cloth at the start; `None` where none are born or die.
    pub fn of(index: usize, cloth: &Cloth) -> Option<Self> {
        let particles = cloth.particles.as_ref()?;
        let points = cloth.surface.positions.len();
        let (Mass::PerPoint(mass) | Mass::PerArea(mass)) = cloth.mass;
        let mut population = Self {
            cloth: index,
            capacity: particles.capacity,
            id: (0..points as u64).collect(),
            born: vec![0.0; points],
            lifespan: particles.lifespans.clone(),
            mass: point_masses(cloth),
            next_id: points as u64,
            now: 0.0,
            next_death: f64::INFINITY,
            considered: 0,
            birth_mass: mass,
        };
        population.lifespan.resize(points, f64::INFINITY);
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

    /// Whether there is room for no more.
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

    /// Number, age and lifespan of each particle.
    pub fn ages(&self) -> impl Iterator<Item = ParticleAge> + '_ {
        let columns = self.id.iter().zip(&self.born).zip(&self.lifespan);
        columns.map(|((&id, born), &lifespan)| ParticleAge { id, age: self.now - born, lifespan })
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

    /// Adds a particle of this age. Returns false, with the particle counted, where it has died already.
    pub fn add(&mut self, age: f64, lifespan: f64) -> bool {
        let id = self.next_id;
        self.next_id += 1;
        if age >= lifespan {
            return false;
        }
        let born = self.now - age;
        self.id.push(id);
        self.born.push(born);
        self.lifespan.push(lifespan);
        self.mass.push(self.birth_mass);
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
        keep(&mut self.id, &kept);
        keep(&mut self.born, &kept);
        keep(&mut self.lifespan, &kept);
        keep(&mut self.mass, &kept);
        self.find_next_death();
        Some(kept)
    }

    /// Takes up columns that were restored; `None` where they are no population of this object.
    pub fn restored(&mut self) -> Option<()> {
        let lengths = [self.born.len(), self.lifespan.len(), self.mass.len()];
        let is_valid = lengths.iter().all(|&length| length == self.len())
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
